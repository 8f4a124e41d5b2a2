#include "lobefit/base/process/parallel.h"

#include <atomic>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "lobefit/base/process/threads.h"

namespace lobefit {
namespace {

TEST(ThreadPool, VisitsEachPieceOnceOnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 8}) {
    ThreadPool pool(threads);
    for (int round = 0; round < 50; ++round) {
      std::vector<std::atomic<int>> visits(97);
      pool.Run(visits.size(), [&](std::size_t piece) { ++visits[piece]; });
      for (const std::atomic<int>& count : visits) EXPECT_EQ(count, 1);
    }
  }
}

TEST(ThreadPool, HandsOnAnExceptionAndStaysUsable) {
  ThreadPool pool(4);
  EXPECT_THROW(pool.Run(100,
                        [](std::size_t piece) {
                          if (piece == 13) throw std::runtime_error("13");
                        }),
               std::runtime_error);
  std::atomic<int> count = 0;
  pool.Run(10, [&](std::size_t) { ++count; });
  EXPECT_EQ(count, 10);
}

TEST(HardwareThreads, AreLimitedByTheProgram) {
  LimitThreads(1);
  EXPECT_EQ(HardwareThreads(), 1);
  LimitThreads(0);
  EXPECT_GE(HardwareThreads(), 1);
}

}  // namespace
}  // namespace lobefit
