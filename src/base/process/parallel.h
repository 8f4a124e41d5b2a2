// Threads over independent pieces of work. Which thread takes which piece is not fixed: a caller that reduces must
// store one partial result a piece and add them in the pieces' order, so that 1 and 8 threads give the same bits.
#pragma once

#include <cstddef>
#include <functional>

namespace lobefit {

// Processors that this process may use: the least of affinity, control groups and SLURM_CPUS_PER_TASK; at least 1.
int HardwareThreads();

// Calls work(piece) once for each piece in [0, pieces), on at most `threads` threads (the caller is one of them). The
// first exception that a piece throws stops the rest and is thrown again here.
void ParallelFor(std::size_t pieces, int threads, const std::function<void(std::size_t)>& work);

// A pool of threads that stays alive between calls, for loops of well under a millisecond.
class ThreadPool {
 public:
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;
  // As ParallelFor. Not reentrant.
  void Run(std::size_t pieces, const std::function<void(std::size_t)>& work);

 private:
  struct State;
  State* state_;
};

}  // namespace lobefit
