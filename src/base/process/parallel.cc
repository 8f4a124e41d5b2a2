#include "lobefit/base/process/parallel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <sched.h>

#include "lobefit/base/process/control_group.h"
#include "lobefit/base/process/threads.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

struct ThreadPool::State {
  std::mutex mutex;
  std::condition_variable start, done;
  std::vector<std::thread> workers;
  const std::function<void(std::size_t)>* work = nullptr;
  std::size_t pieces = 0;
  std::atomic<std::size_t> next{0};
  std::size_t generation = 0;
  std::size_t busy = 0;
  bool quit = false;
  std::exception_ptr error;

  void Drain() {
    try {
      for (std::size_t piece = next++; piece < pieces; piece = next++) (*work)(piece);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      if (!error) error = std::current_exception();
      next = pieces;
    }
  }

  void Loop() {
    std::size_t seen = 0;
    std::unique_lock<std::mutex> lock(mutex);
    while (true) {
      start.wait(lock, [&] { return quit || generation != seen; });
      if (quit) return;
      seen = generation;
      lock.unlock();
      Drain();
      lock.lock();
      if (--busy == 0) done.notify_one();
    }
  }
};

namespace {

std::atomic<int> most_threads = 0;

}  // namespace

void LimitThreads(int most) { most_threads = most; }

int HardwareThreads() {
  cpu_set_t set;
  CPU_ZERO(&set);
  double threads = std::max(1U, std::thread::hardware_concurrency());
  if (sched_getaffinity(0, sizeof(set), &set) == 0) threads = CPU_COUNT(&set);
  if (const std::optional<double> quota = ControlGroupProcessors()) threads = std::min(threads, std::ceil(*quota));
  // Slurm without control groups lets a job see every processor of its node.
  const char* slurm = std::getenv("SLURM_CPUS_PER_TASK");
  const std::optional<long long> share = slurm != nullptr ? ParseInteger(slurm) : std::nullopt;
  if (share && *share > 0) threads = std::min(threads, static_cast<double>(*share));
  const int most = most_threads;
  return std::max(1, most > 0 ? std::min(most, static_cast<int>(threads)) : static_cast<int>(threads));
}

ThreadPool::ThreadPool(int threads) : state_(new State) {
  try {
    for (int i = 1; i < threads; ++i) state_->workers.emplace_back([this] { state_->Loop(); });
  } catch (const std::exception&) {
    // A limit on threads: those that are there do the work.
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->quit = true;
  }
  state_->start.notify_all();
  for (std::thread& worker : state_->workers) worker.join();
  delete state_;
}

int ThreadPool::threads() const { return static_cast<int>(state_->workers.size()) + 1; }

void ThreadPool::Run(std::size_t pieces, const std::function<void(std::size_t)>& work) {
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    state_->work = &work;
    state_->pieces = pieces;
    state_->next = 0;
    state_->busy = state_->workers.size();
    state_->error = nullptr;
    ++state_->generation;
  }
  state_->start.notify_all();
  state_->Drain();
  std::unique_lock<std::mutex> lock(state_->mutex);
  state_->done.wait(lock, [&] { return state_->busy == 0; });
  if (state_->error) std::rethrow_exception(state_->error);
}

void ParallelFor(std::size_t pieces, int threads, const std::function<void(std::size_t)>& work) {
  const std::size_t used = std::min(pieces, static_cast<std::size_t>(std::max(1, threads)));
  ThreadPool pool(static_cast<int>(used));
  pool.Run(pieces, work);
}

}  // namespace lobefit
