// Deaths at random moments, and a disk that fills up: nothing is lost, nothing is there twice.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "tests/batch/batch_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace lobefit {
namespace {

using testing::HasSubstr;

using BatchKill = BatchTest;

TEST_F(BatchKill, FiftyKillsLoseNothing) {
  MakeFiles(60);
  MakeBrokenFiles();
  ASSERT_EQ(Shell("ls data/* > list").exit_code, 0);
  // No pipe: what is killed below is the program itself, not the shell that waits for it.
  const std::string batch = "lobefit batch - --recipe ggx --starts 200 < list --out ";
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(Shell(batch + "whole").exit_code, 4);
  // A twentieth of the whole at most: on a fast machine too most kills find work that is left.
  const auto whole = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - start);
  const int latest = std::clamp(static_cast<int>(whole.count() / 20), 10, 250);
  std::mt19937 random(12345);
  int killed = 0;
  for (int i = 0; i < 50; ++i) {
    // From before the list is read to well within the work.
    const int milliseconds = std::uniform_int_distribution<int>(5, latest)(random);
    const ProgramResult result = Shell(fmt::format(
        "exec {}killed >/dev/null & pid=$!; sleep 0.{:03}; kill -KILL $pid; wait $pid", batch, milliseconds));
    killed += result.exit_code == 137 ? 1 : 0;
  }
  EXPECT_GT(killed, 10);
  EXPECT_EQ(Shell(batch + "killed --retry-failed").exit_code, 4);
  EXPECT_TRUE(Same("whole/results.csv", "killed/results.csv"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "killed"))
    EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr(".lobefit-")));
}

TEST_F(BatchKill, ADiskThatFillsUpLosesNothing) {
  if (geteuid() != 0) GTEST_SKIP() << "mounting needs root";
  MakeFiles(60);
  const std::string batch = "lobefit batch data --recipe ggx --out ";
  ASSERT_EQ(Shell(batch + "whole").exit_code, 0);
  if (Shell("mkdir small; mount -t tmpfs -o size=160k none small").exit_code != 0)
    GTEST_SKIP() << "no tmpfs may be mounted";
  const ProgramResult full = Shell(batch + "small/out");
  const ProgramResult again = Shell(batch + "small/out");
  const ProgramResult grown = Shell("mount -o remount,size=20m small && " + batch + "small/out");
  const ProgramResult copied = Shell("cp -r small/out out; umount small");
  EXPECT_EQ(full.exit_code, 3) << full.err;
  EXPECT_THAT(full.err, HasSubstr("No space left"));
  EXPECT_EQ(again.exit_code, 3) << again.err;
  EXPECT_EQ(grown.exit_code, 0) << grown.err << grown.out;
  EXPECT_TRUE(Same("whole/results.csv", "out/results.csv"));
  EXPECT_EQ(copied.exit_code, 0);
}

TEST_F(BatchKill, APoisonFileIsSetAsideAtItsSecondDeath) {
  MakeFiles(3);
  // Lobes for half a million samples take long, and the limit on a process' time kills as the kernel does for want of
  // memory.
  ASSERT_EQ(Shell("lobefit synth \"$SOURCE\"/samples/satin_plastic.toml --layout visible-normals --samples 8000 "
                  "--theta-i 10,20,30,40,50,60,70 --phi-i 0,30,60,90,120,150,180,210,240,270 --noise 0.05 --digits 6 "
                  "--out data/large.csv")
                .exit_code,
            0);
  WriteWholeFile(folder_ / "list.csv",
                 "file,id,recipe\ndata/large.csv,poison,sel\ndata/m001.csv,,ggx\ndata/m002.csv,,ggx\n");
  const std::string batch = "(ulimit -t 2; exec lobefit batch list.csv --jobs 1 --threads 1 --out out)";
  EXPECT_EQ(Shell(batch).exit_code, 137);
  EXPECT_EQ(Shell("lobefit batch --out out --status").exit_code, 5);
  const ProgramResult second = Shell(batch);
  EXPECT_EQ(second.exit_code, 4) << second.err;
  const auto table = Table("out/results.csv");
  EXPECT_EQ(table.at("poison").at("status"), "crashed");
  EXPECT_THAT(table.at("poison").at("message"), HasSubstr("signal 9"));
  EXPECT_EQ(table.at("data/m001.csv").at("status"), "fitted");
  EXPECT_EQ(table.at("data/m002.csv").at("status"), "fitted");
  EXPECT_EQ(Shell(batch).exit_code, 4);
}

}  // namespace
}  // namespace lobefit
