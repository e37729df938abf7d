#include "pipeline/base/parallel.h"

#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace blockrand::base {
namespace {

class Loop {
 public:
  Loop(std::size_t count, std::size_t in_flight, const std::function<void(std::size_t)>& work,
       const std::function<void(std::size_t)>& consume)
      : end_(count), in_flight_(in_flight), done_(in_flight), work_(work), consume_(consume) {}

  /// What every thread does until there is nothing left to start or to consume.
  void run() {
    std::unique_lock lock(mutex_);
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
      } else if (started_ < end_ && started_ < consumed_ + in_flight_) {
        const std::size_t i = started_++;
        call(lock, work_, i);
        if (i < end_) done_[i % in_flight_] = true;
        changed_.notify_all();
      } else {
        changed_.wait(lock);
      }
    }
  }

  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
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
  bool consuming_ = false;
  std::vector<char> done_;  ///< item i, while in flight, at i % in_flight_
  std::exception_ptr error_;
  const std::function<void(std::size_t)>& work_;
  const std::function<void(std::size_t)>& consume_;
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
                      const std::function<void(std::size_t)>& work, const std::function<void(std::size_t)>& consume) {
  if (count == 0) return;
  in_flight = std::clamp<std::size_t>(in_flight, 1, count);
  if (workers <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      work(i);
      consume(i);
    }
    return;
  }
  Loop loop(count, in_flight, work, consume);
  std::vector<std::thread> threads;
  const std::size_t helpers = std::min<std::size_t>(static_cast<std::size_t>(workers), in_flight) - 1;
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

}  // namespace blockrand::base
