#include "pipeline/base/parallel.h"

#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace blockrand::base {
namespace {

/// Work of one item that others may take part in.
class Shared {
 public:
  Shared(std::size_t count, const std::function<void(std::size_t)>& work) : end_(count), work_(work) {}

  bool has_work() const { return next_ < end_; }
  bool at_work() const { return running_ > 0; }

  /// One item, if there is one left. \param lock  of the loop; free while it works
  void take(std::unique_lock<std::mutex>& lock) {
    const std::size_t i = next_++;
    ++running_;
    lock.unlock();
    std::exception_ptr error;
    try {
      work_(i);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    --running_;
    if (error && i < failed_) {
      failed_ = i, error_ = error;
      end_ = std::min(end_, i);  // items start in order: all below have begun
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::size_t end_, next_ = 0, running_ = 0, failed_ = ~std::size_t{0};
  std::exception_ptr error_;
  const std::function<void(std::size_t)>& work_;
};

class Loop;
thread_local Loop* loop_of_thread = nullptr;

class Loop {
 public:
  Loop(std::size_t count, std::size_t in_flight, const std::function<void(std::size_t)>& work,
       const std::function<void(std::size_t)>& consume, const ItemLoad& load)
      : end_(count), in_flight_(in_flight), done_(in_flight), work_(work), consume_(consume), load_(load) {}

  /// What every thread does until there is nothing left to start or to consume.
  void run() {
    Loop* const outer = std::exchange(loop_of_thread, this);
    std::unique_lock lock(mutex_);
    ++threads_;
    while (consumed_ < end_) {
      if (!consuming_ && done_[consumed_ % in_flight_]) {
        // Consumption goes before new work: it frees a slot.
        consuming_ = true;
        const std::size_t i = consumed_;
        done_[i % in_flight_] = false;
        call(lock, consume_, i);
        consuming_ = false;
        if (i < end_) ++consumed_;
        changed_.notify_all();
      } else if (started_ < end_ && started_ < consumed_ + in_flight_ && is_light_enough(started_)) {
        const std::size_t i = started_++;
        ++running_, running_load_ += load_of(i);
        call(lock, work_, i);
        --running_, running_load_ -= load_of(i);
        if (i < end_) done_[i % in_flight_] = true;
        changed_.notify_all();
      } else if (Shared* const shared = shared_work()) {
        shared->take(lock);
        changed_.notify_all();
      } else {
        ++waiting_;
        changed_.wait(lock);
        --waiting_;
      }
    }
    loop_of_thread = outer;
  }

  /// \throws what `work` throws
  void share(std::size_t count, const std::function<void(std::size_t)>& work) {
    Shared shared(count, work);
    std::unique_lock lock(mutex_);
    shared_.push_back(&shared);
    changed_.notify_all();
    while (shared.has_work()) shared.take(lock);
    // While others end it, this thread does not take up anything else: it would come back late.
    while (shared.at_work()) changed_.wait(lock);
    std::erase(shared_, &shared);
    lock.unlock();
    shared.rethrow();
  }

  std::size_t sharing_threads() {
    const std::unique_lock lock(mutex_);
    // Where all items have begun, those at work on other items will be free before long.
    return started_ < end_ ? waiting_ + 1 : std::max(threads_, waiting_ + 1);
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::size_t load_of(std::size_t i) const { return load_.of ? load_.of(i) : 0; }
  bool is_light_enough(std::size_t i) const { return running_ == 0 || running_load_ + load_of(i) <= load_.most; }

  Shared* shared_work() const {
    // The newest first: what was shared within another's work holds that up.
    for (auto s = shared_.rbegin(); s != shared_.rend(); ++s)
      if ((*s)->has_work()) return *s;
    return nullptr;
  }

  void call(std::unique_lock<std::mutex>& lock, const std::function<void(std::size_t)>& function, std::size_t i) {
    lock.unlock();
    std::exception_ptr error;
    try {
      function(i);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    // Work starts in order, so every item below a failed one has been started and will be consumed: the lowest failure
    // wins whatever the timing was.
    if (error && i < end_) {
      end_ = i;
      error_ = error;
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t end_;  ///< nothing from here on is started or consumed
  std::size_t in_flight_, started_ = 0, consumed_ = 0;
  std::size_t running_ = 0, running_load_ = 0;  ///< items that are worked on
  bool consuming_ = false;
  std::vector<char> done_;  ///< item i, while in flight, at i % in_flight_
  std::exception_ptr error_;
  const std::function<void(std::size_t)>& work_;
  const std::function<void(std::size_t)>& consume_;
  const ItemLoad& load_;
  std::vector<Shared*> shared_;  ///< in the order in which they were begun
  std::size_t threads_ = 0;      ///< that take part
  std::size_t waiting_ = 0;      ///< of them, those that have nothing to do
};

}  // namespace

int worker_count(int jobs) {
  if (jobs > 0) return jobs;
  // The affinity mask knows about taskset, cpusets and most batch systems; hardware_concurrency may not.
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0) return CPU_COUNT(&set);
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

void ordered_parallel(std::size_t count, int workers, std::size_t in_flight,
                      const std::function<void(std::size_t)>& work, const std::function<void(std::size_t)>& consume,
                      const ItemLoad& load) {
  if (count == 0) return;
  in_flight = std::clamp<std::size_t>(in_flight, 1, count);
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      work(i);
      consume(i);
    }
    return;
  }
  Loop loop(count, in_flight, work, consume, load);
  std::vector<std::thread> threads;
  const std::size_t helpers = static_cast<std::size_t>(workers) - 1;
  threads.reserve(helpers);
  try {
    for (std::size_t t = 0; t < helpers; ++t) threads.emplace_back([&loop] { loop.run(); });
  } catch (const std::system_error&) {
    // The system gives no more threads: those that run do the whole work.
  }
  loop.run();
  for (std::thread& t : threads) t.join();
  loop.rethrow();
}

void share(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (loop_of_thread != nullptr && count > 1) return loop_of_thread->share(count, work);
  for (std::size_t i = 0; i < count; ++i) work(i);
}

std::vector<std::size_t> stretches_to_share(std::size_t count) {
  // Some more than threads: they are of unequal weight.
  constexpr std::size_t kOfEach = 3;
  const std::size_t threads = sharing_threads();
  const std::size_t number = threads > 1 ? std::min(count, kOfEach * threads) : std::min<std::size_t>(count, 1);
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < number; ++i) begins.push_back(i * count / number);
  begins.push_back(count);
  return begins;
}

std::size_t sharing_threads() { return loop_of_thread != nullptr ? loop_of_thread->sharing_threads() : 1; }

}  // namespace blockrand::base
