// The same list on a laptop and on two nodes of a real Slurm, one of which loses its power.
#include <chrono>
#include <thread>

#include "tests/batch/batch_test.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lobefit {
namespace {

using testing::HasSubstr;

class BatchOnSlurm : public BatchTest {
 protected:
  ProgramResult Cluster(const std::string& words) const {
    return Shell("\"$SOURCE\"/tests/batch/slurm_cluster " + words);
  }
  // A command that finds the cluster.
  ProgramResult On(const std::string& command) const {
    return Shell("export SLURM_CONF=$PWD/slurm/slurm.conf; " + command);
  }
  bool WaitFor(const std::string& command, int seconds) const {
    for (int i = 0; i < 5 * seconds; ++i) {
      if (On(command).exit_code == 0) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    return false;
  }
  void TearDown() override {
    Cluster("down \"$PWD/slurm\"");
    BatchTest::TearDown();
  }
};

TEST_F(BatchOnSlurm, ALostNodeLosesNothingAndTheTableIsTheSame) {
  if (const ProgramResult up = Cluster("up \"$PWD/slurm\""); up.exit_code == 77) GTEST_SKIP() << up.out << up.err;
  MakeFiles(40);
  MakeBrokenFiles();
  std::string manifest = "file,lab\n";
  for (int i = 0; i < 40; ++i) manifest += fmt::format("data/m{:03}.csv,{}\n", i, i % 3);
  for (const char* name : {"empty", "text", "row"}) manifest += fmt::format("data/broken_{}.csv,broken\n", name);
  manifest += "data/none.csv,missing\n";
  WriteWholeFile(folder_ / "list.csv", manifest);
  const std::string batch = "lobefit batch list.csv --recipe ellipsoid --starts 2000 --out ";
  ASSERT_EQ(Shell(batch + "laptop").exit_code, 4);

  const ProgramResult sent = On(batch + "cluster --engine slurm --shards 4 --submit");
  ASSERT_EQ(sent.exit_code, 0) << sent.err;
  EXPECT_THAT(sent.out, HasSubstr("4 shards"));
  // In the middle of the work of both nodes the power of one is cut.
  ASSERT_TRUE(WaitFor("test $(cat cluster/segments/* 2>/dev/null | grep -c '\"done\":') -ge 3", 60))
      << On("squeue; sinfo; tail -n 3 slurm/*.log; cat cluster/slurm/*").out;
  EXPECT_EQ(Cluster("cut \"$PWD/slurm\" 1").exit_code, 0);
  EXPECT_EQ(On("scontrol update nodename=n1 state=down reason=power").exit_code, 0);
  EXPECT_TRUE(WaitFor("scontrol show job | grep -q 'Restarts=1'", 60)) << "no element was requeued";
  EXPECT_EQ(Cluster("join \"$PWD/slurm\" 1").exit_code, 0);
  ASSERT_TRUE(WaitFor("test -z \"$(squeue -h)\"", 240))
      << On("squeue; sinfo; tail -n 5 slurm/*.log; cat cluster/slurm/*").out;

  const auto table = Table("cluster/results.csv");
  EXPECT_EQ(table.size(), 44U) << On("cat cluster/slurm/*").out;
  EXPECT_EQ(Shell("lobefit batch --out cluster --status").exit_code, 4);
  EXPECT_TRUE(Same("laptop/results.csv", "cluster/results.csv"))
      << Shell("diff laptop/results.csv cluster/results.csv | head").out;
  // What died with the node was begun again.
  EXPECT_THAT(ReadWholeFile(folder_ / "cluster/runs.csv"), HasSubstr(",died,"));

  // Trials of a validation on the same nodes; times of fits differ.
  const std::string validate =
      "lobefit validate $SOURCE/samples/brushed_metal.toml --theta-i 10,50 --phi-i 0,90 --detector-step 20 --noise "
      "0.05 "
      "--trials 30 ";
  ASSERT_EQ(On(validate + "--out trials --engine slurm --shards 3 --submit").exit_code, 0);
  ASSERT_TRUE(WaitFor("test -s \"$(ls trials/slurm/collect_*.txt)\" && test -z \"$(squeue -h)\"", 120))
      << On("squeue; sinfo; cat trials/slurm/*").out;
  const std::string table_of = " | grep -A20 '^wrong minimum'";
  EXPECT_EQ(Shell("cat trials/slurm/collect_*.txt" + table_of).out, Shell(validate + table_of).out);
}

}  // namespace
}  // namespace lobefit
