// The parallel loops of the program: items are worked on in any order, results are consumed in item order; and what one item does may
// be shared with threads that have no item of their own.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace blockrand::base {

/// Number of worker threads for `jobs` as given by the user: 0 means one per core that this process may use.
int worker_count(int jobs);

/// What items of a loop weigh, in any unit.
struct ItemLoad {
  std::function<std::size_t(std::size_t)> of = {};  ///< empty: nothing
  std::size_t most = 0;
};

/// Calls `work(i)` for i in [0, count) on `workers` threads and `consume(i)` for each, one at a time and in increasing
/// order of i, after its work is done. At most `in_flight` items (at least 1) are between the start of their work and
/// the end of their consumption, which bounds memory.
///
/// \param load  how heavy items are: what is worked on at a time weighs at most `load.most` together, or is one item alone. Threads
///              that wait for that help with what is shared.
///
/// Work starts in increasing order of i. `consume` runs on whichever thread is free: the calling thread or a worker.
/// Exceptions end the loop as they would end a serial one: everything below the lowest i whose work or consumption
/// throws is consumed, nothing from it on, and that exception is rethrown after all running items have ended.
void ordered_parallel(std::size_t count, int workers, std::size_t in_flight,
                      const std::function<void(std::size_t)>& work, const std::function<void(std::size_t)>& consume,
                      const ItemLoad& load = {});

/// Calls `work(i)` for i in [0, count), in any order, and ends when all have ended. Within the work or consumption of an
/// ordered_parallel() its threads that have nothing left to start help, so that a quarter of one tile does not run on one core;
/// elsewhere the calling thread does all. May be nested. An exception is rethrown here, that of the lowest i; what was not
/// begun by then is left out.
void share(std::size_t count, const std::function<void(std::size_t)>& work);

/// How many threads could work on what is shared now or before long, at least 1: for dividing work. It says nothing of a moment later, so that no
/// result may depend on it.
std::size_t sharing_threads();

/// [0, count) cut into stretches for share(), in order, none empty: one where no other thread is free.
/// \return  where each begins, and `count`
std::vector<std::size_t> stretches_to_share(std::size_t count);

}  // namespace blockrand::base
