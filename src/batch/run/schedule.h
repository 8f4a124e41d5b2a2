// Which task runs when, on how many threads, within a limit of memory.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace lobefit {

struct ScheduleLimits {
  int jobs = 1;              // tasks at once
  int threads = 1;           // of all of them together
  std::uint64_t memory = 0;  // bytes, of all of them together
};

// Calls work(i, threads) once for each i in the order of `memory` (bytes that task i may need; the biggest are to come
// first), `jobs` at a time. As long as more tasks wait than jobs run, each has one thread; the last ones share all. A
// task begins only where its memory is free, or nothing else runs. Once `stop` is set none begins any more. The first
// exception of a task stops the rest in the same way and is thrown when those that run have ended.
void RunScheduled(const std::vector<std::uint64_t>& memory, const ScheduleLimits& limits, const std::atomic<bool>& stop,
                  const std::function<void(std::size_t, int)>& work);

}  // namespace lobefit
