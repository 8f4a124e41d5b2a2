#include "lobefit/batch/run/schedule.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/batch/run/memory_limit.h"

namespace lobefit {
namespace {

using namespace std::chrono_literals;

// What ran with how many threads, in the order of beginning, and the most that ran at once.
struct Trace {
  std::mutex mutex;
  std::vector<std::pair<std::size_t, int>> begun;
  std::uint64_t memory = 0, most_memory = 0;
  int running = 0, most_running = 0;
  // The first tasks wait until so many run at once, however slow the machine is to begin them.
  int together = 0;
  std::condition_variable met;
};

void RunTraced(const std::vector<std::uint64_t>& memory, const ScheduleLimits& limits, Trace* trace,
               const std::atomic<bool>& stop = false) {
  RunScheduled(memory, limits, stop, [&](std::size_t i, int threads) {
    {
      std::unique_lock<std::mutex> lock(trace->mutex);
      trace->begun.emplace_back(i, threads);
      trace->most_memory = std::max(trace->most_memory, trace->memory += memory[i]);
      trace->most_running = std::max(trace->most_running, ++trace->running);
      trace->met.notify_all();
      trace->met.wait_for(lock, 30s, [&] { return trace->most_running >= trace->together; });
    }
    std::this_thread::sleep_for(5ms);
    const std::lock_guard<std::mutex> lock(trace->mutex);
    trace->memory -= memory[i];
    --trace->running;
  });
}

TEST(Schedule, RunsEachOnceAndTheLastOnAllThreads) {
  Trace trace;
  trace.together = 4;
  RunTraced(std::vector<std::uint64_t>(9, 1), {4, 8, 100}, &trace);
  ASSERT_EQ(trace.begun.size(), 9U);
  EXPECT_EQ(trace.most_running, 4);
  std::sort(trace.begun.begin(), trace.begun.end());
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(trace.begun[i].first, i);
    // Four at once share eight threads; the last three, two and one have more each.
    EXPECT_EQ(trace.begun[i].second, i < 6 ? 2 : i == 6 ? 2 : i == 7 ? 4 : 8);
  }
}

TEST(Schedule, KeepsToItsMemory) {
  Trace trace;
  RunTraced({60, 50, 40, 10, 10, 200}, {4, 4, 100}, &trace);
  EXPECT_EQ(trace.begun.size(), 6U);
  // The one of 200 runs alone.
  EXPECT_EQ(trace.most_memory, 200U);
  Trace small;
  RunTraced({60, 50, 40, 10, 10}, {4, 4, 100}, &small);
  EXPECT_LE(small.most_memory, 100U);
}

TEST(Schedule, StopsWhereItIsToldTo) {
  Trace trace;
  std::atomic<bool> stop = true;
  RunTraced({1, 1}, {1, 1, 100}, &trace, stop);
  EXPECT_TRUE(trace.begun.empty());
  std::atomic<int> ran{0};
  const std::atomic<bool> go_on{false};
  EXPECT_THROW(RunScheduled(std::vector<std::uint64_t>(100, 1), {2, 2, 100}, go_on,
                            [&](std::size_t, int) {
                              if (++ran == 3) throw std::runtime_error("full");
                              // Time for the other thread to leave its task.
                              std::this_thread::sleep_for(std::chrono::milliseconds(20));
                            }),
               std::runtime_error);
  EXPECT_LT(ran, 50);
}

TEST(MemoryLimit, IsReadStrictly) {
  EXPECT_EQ(ParseMemory("500M"), 500U << 20);
  EXPECT_EQ(ParseMemory("1.5g"), 3ULL << 29);
  for (const char* text : {"", "5", "G", "-1G", "4GB", "0M", "nanG", "1K"})
    EXPECT_THROW(ParseMemory(text), UsageError) << text;
  EXPECT_GT(AvailableMemory(), 1U << 20);
}

}  // namespace
}  // namespace lobefit
