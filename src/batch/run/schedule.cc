#include "lobefit/batch/run/schedule.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace lobefit {
namespace {

class Schedule {
 public:
  Schedule(const std::vector<std::uint64_t>& memory, const ScheduleLimits& limits, const std::atomic<bool>& stop,
           const std::function<void(std::size_t, int)>& work)
      : memory_(memory), limits_(limits), stop_(stop), work_(work) {}

  void Loop() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (next_ < memory_.size() && !stop_ && !error_) {
      const std::uint64_t needed = memory_[next_];
      if (used_ > 0 && used_ + needed > limits_.memory) {
        freed_.wait(lock);
        continue;
      }
      const std::size_t task = next_++;
      const std::size_t left = memory_.size() - task;  // with this one
      const int threads = left < static_cast<std::size_t>(limits_.jobs)
                              ? std::max(1, limits_.threads / static_cast<int>(left))
                              : std::max(1, limits_.threads / limits_.jobs);
      used_ += needed;
      lock.unlock();
      std::exception_ptr error;
      try {
        work_(task, threads);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error && !error_) error_ = error;
      used_ -= needed;
      freed_.notify_all();
    }
    // Those that wait for memory see that there is nothing left.
    freed_.notify_all();
  }
  std::exception_ptr error() const { return error_; }

 private:
  const std::vector<std::uint64_t>& memory_;
  const ScheduleLimits& limits_;
  const std::atomic<bool>& stop_;
  const std::function<void(std::size_t, int)>& work_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::size_t next_ = 0;
  std::uint64_t used_ = 0;
  std::exception_ptr error_;
};

}  // namespace

void RunScheduled(const std::vector<std::uint64_t>& memory, const ScheduleLimits& limits, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t, int)>& work) {
  Schedule schedule(memory, limits, stop, work);
  const std::size_t jobs = std::min(memory.size(), static_cast<std::size_t>(std::max(1, limits.jobs)));
  std::vector<std::thread> workers;
  for (std::size_t i = 1; i < jobs; ++i) workers.emplace_back([&] { schedule.Loop(); });
  schedule.Loop();
  for (std::thread& worker : workers) worker.join();
  if (schedule.error()) std::rethrow_exception(schedule.error());
}

}  // namespace lobefit
