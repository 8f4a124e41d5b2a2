#include "lobefit/base/process/control_group.h"

#include <filesystem>

#include "tests/support/run_program.h"
#include <gtest/gtest.h>

#include "lobefit/base/process/parallel.h"

namespace lobefit {
namespace {

class ControlGroup : public ProgramTest {
 protected:
  void Put(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((folder_ / path).parent_path());
    WriteWholeFile(folder_ / path, text);
  }
  std::optional<double> Processors() const { return ControlGroupProcessors(folder_ / "root", folder_ / "self"); }
  std::optional<std::uint64_t> Memory() const { return ControlGroupMemory(folder_ / "root", folder_ / "self"); }
};

TEST_F(ControlGroup, TakesTheStrictestOfTheGroupsAbove) {
  Put("self", "0::/job/step\n");
  Put("root/job/cpu.max", "150000 100000\n");
  Put("root/job/memory.max", "1000000\n");
  Put("root/job/step/cpu.max", "max 100000\n");
  Put("root/job/step/memory.max", "max\n");
  EXPECT_EQ(Processors(), 1.5);
  EXPECT_EQ(Memory(), 1000000U);
  Put("root/job/step/cpu.max", "50000 100000\n");
  EXPECT_EQ(Processors(), 0.5);
}

TEST_F(ControlGroup, ReadsTheFirstVersionToo) {
  Put("self", "4:memory:/m\n2:cpu,cpuacct:/c\n0::/\n");
  Put("root/cpu/c/cpu.cfs_quota_us", "300000\n");
  Put("root/cpu/c/cpu.cfs_period_us", "100000\n");
  Put("root/memory/m/memory.limit_in_bytes", "2000000\n");
  Put("root/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_EQ(Processors(), 3);
  EXPECT_EQ(Memory(), 2000000U);
}

TEST_F(ControlGroup, IsNothingWhereThereIsNoLimit) {
  EXPECT_FALSE(Processors());
  EXPECT_FALSE(Memory());
  Put("self", "4:memory:/\n2:cpu:/\n");
  Put("root/cpu/cpu.cfs_quota_us", "-1\n");
  Put("root/cpu/cpu.cfs_period_us", "100000\n");
  Put("root/memory/memory.limit_in_bytes", "9223372036854771712\n");
  EXPECT_FALSE(Processors());
  EXPECT_FALSE(Memory());
}

TEST(HardwareThreadsTest, HonourSlurmsShare) {
  ASSERT_EQ(setenv("SLURM_CPUS_PER_TASK", "1", 1), 0);
  EXPECT_EQ(HardwareThreads(), 1);
  setenv("SLURM_CPUS_PER_TASK", "nonsense", 1);
  EXPECT_GE(HardwareThreads(), 1);
  unsetenv("SLURM_CPUS_PER_TASK");
}

}  // namespace
}  // namespace lobefit
