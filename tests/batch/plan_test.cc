// What is done, what is to do, and what becomes of tasks that kill their process.
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/batch/run/journal.h"
#include "lobefit/batch/run/run.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PlanTest : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    for (const char* id : {"a", "b", "c", "d"}) {
      WriteWholeFile(folder_ / id, std::string("content of ") + id);
      list_.tasks.push_back({id, id, folder_ / id, 10, {}, "settings", {}, ""});
    }
    // Long enough ago that the stamps are to be trusted.
    for (const Task& task : list_.tasks)
      std::filesystem::last_write_time(task.path,
                                       std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  }

  Plan MakePlanHere() const { return MakePlan(list_, ReadRecords(out_, 1), options_, out_); }

  // Runs with `work`, which gives each task its status; returns the ids that ran, in order.
  std::vector<std::string> Run(const std::function<TaskStatus(const Task&)>& work) {
    std::mutex mutex;
    std::vector<std::string> ran;
    RunPlan(
        MakePlanHere(), options_, out_, stop_,
        [&](const Task& task, int) {
          const TaskStatus status = work(task);
          const std::lock_guard<std::mutex> lock(mutex);
          if (status == TaskStatus::kFailed) throw InputError(task.path.string() + ": is broken");
          MakeFolder(out_ / "documents");
          WriteWholeFile(ResultPath(out_, task.id, ".material.json"), "document");
          return Outcome{status, 0, "", "{\"x\":1}", 8, Sha256Hex(ReadWholeFile(task.path)), {}};
        },
        [&](const DoneRecord& done) {
          const std::lock_guard<std::mutex> lock(mutex);
          ran.push_back(done.id);
          rows_[done.id] = done.row;
          last_[done.id] = done;
        });
    return ran;
  }
  // A journal of a process that began a task and died.
  void Die(const std::string& id, double at) {
    std::filesystem::create_directories(out_ / "segments");
    WriteWholeFile(out_ / "segments" / ("dead" + std::to_string(deaths_++) + ".jsonl"),
                   "{\"segment\":1,\"host\":\"" + ThisProcess().host +
                       "\",\"pid\":1,\"start_ticks\":1,\"space\":\"before\"}\n" + ToLine(StartRecord{id, at, 0}) +
                       "\n");
  }

  WorkList list_;
  RunOptions options_ = {{1, 1, 1 << 30}, {}, false};
  std::filesystem::path out_;
  std::atomic<bool> stop_{false};
  std::map<std::string, DoneRecord> last_;
  std::map<std::string, std::string> rows_;
  int deaths_ = 0;

  PlanTest() = default;
  void Prepare() { out_ = folder_ / "out"; }
};

const auto kAllFit = [](const Task&) { return TaskStatus::kFitted; };

TEST_F(PlanTest, DoesWhatIsMissingAndNothingTwice) {
  Prepare();
  EXPECT_THAT(Run(kAllFit), ElementsAre("a", "b", "c", "d"));
  EXPECT_THAT(Run(kAllFit), testing::IsEmpty());
  std::filesystem::remove(ResultPath(out_, "b", ".material.json"));
  WriteWholeFile(ResultPath(out_, "c", ".material.json"), "");
  EXPECT_THAT(Run(kAllFit), ElementsAre("b", "c"));
}

TEST_F(PlanTest, DoesAFileAgainWhoseContentChanged) {
  Prepare();
  Run(kAllFit);
  // The same content with another time is the same.
  std::filesystem::last_write_time(folder_ / "a", std::filesystem::file_time_type::clock::now());
  WriteWholeFile(folder_ / "b", "content of B");
  EXPECT_EQ(MakePlanHere().counts.changed, 1U);
  EXPECT_THAT(Run(kAllFit), ElementsAre("b"));
}

TEST_F(PlanTest, AFailureIsAResultUntilItIsRetried) {
  Prepare();
  const auto one_fails = [](const Task& task) { return task.id == "b" ? TaskStatus::kFailed : TaskStatus::kFitted; };
  Run(one_fails);
  EXPECT_EQ(last_["b"].status, TaskStatus::kFailed);
  EXPECT_EQ(last_["b"].exit_code, kExitInput);
  // The message is the same on every machine.
  EXPECT_EQ(last_["b"].message, "b: is broken");
  EXPECT_THAT(Run(kAllFit), testing::IsEmpty());
  options_.retry_failed = true;
  EXPECT_THAT(Run(kAllFit), ElementsAre("b"));
  EXPECT_THAT(Run(kAllFit), testing::IsEmpty());
}

TEST_F(PlanTest, ShardsShareTheWorkAndMayChangeInTheMiddle) {
  Prepare();
  options_.shard = {2, 3};
  EXPECT_THAT(Run(kAllFit), ElementsAre("b"));
  options_.shard = {1, 2};
  EXPECT_THAT(Run(kAllFit), ElementsAre("a", "c"));
  options_.shard = {};
  EXPECT_THAT(Run(kAllFit), ElementsAre("d"));
}

TEST_F(PlanTest, ATaskWhoseProcessDiedRunsLastAndAlone) {
  Prepare();
  Die("a", 1);
  const pid_t here = getpid();
  EXPECT_THAT(Run([&](const Task& task) {
                EXPECT_EQ(getpid() == here, task.id != "a");
                return TaskStatus::kFitted;
              }),
              ElementsAre("b", "c", "d", "a"));
  EXPECT_EQ(rows_["a"], "{\"x\":1}");
  EXPECT_EQ(last_["a"].sha256, Sha256Hex("content of a"));
  EXPECT_THAT(Run(kAllFit), testing::IsEmpty());
}

TEST_F(PlanTest, APoisonFileIsSetAsideAtItsSecondDeath) {
  Prepare();
  Die("a", 1);
  const auto poison = [](const Task& task) {
    if (task.id == "a") raise(SIGKILL);
    return TaskStatus::kFitted;
  };
  EXPECT_THAT(Run(poison), ElementsAre("b", "c", "d", "a"));
  EXPECT_EQ(last_["a"].status, TaskStatus::kCrashed);
  EXPECT_THAT(last_["a"].message, HasSubstr("signal 9"));
  EXPECT_THAT(Run(poison), testing::IsEmpty());
  // Tried again it gets its two lives back: this process survives it, or it would not be here.
  options_.retry_failed = true;
  EXPECT_EQ(MakePlanHere().usual.size(), 1U);
}

TEST_F(PlanTest, TwoDeathsAreEnoughWhoeverDied) {
  Prepare();
  Die("a", 1);
  Die("a", 2);
  Run(kAllFit);
  EXPECT_EQ(last_["a"].status, TaskStatus::kCrashed);
  EXPECT_THAT(last_["a"].message, HasSubstr("--retry-failed"));
  EXPECT_EQ(last_["b"].status, TaskStatus::kFitted);
}

TEST_F(PlanTest, AFailureOfTheChildIsAFailure) {
  Prepare();
  Die("a", 1);
  Run([](const Task& task) { return task.id == "a" ? TaskStatus::kFailed : TaskStatus::kFitted; });
  EXPECT_EQ(last_["a"].status, TaskStatus::kFailed);
  EXPECT_EQ(last_["a"].message, "a: is broken");
}

TEST_F(PlanTest, StopsBetweenTasksAndGoesOn) {
  Prepare();
  EXPECT_THAT(Run([&](const Task& task) {
                if (task.id == "b") stop_ = true;
                return TaskStatus::kFitted;
              }),
              ElementsAre("a", "b"));
  stop_ = false;
  EXPECT_THAT(Run(kAllFit), ElementsAre("c", "d"));
}

TEST_F(PlanTest, ADiskThatIsFullEndsTheBatchAndIsNoResult) {
  Prepare();
  EXPECT_THROW(Run([](const Task& task) -> TaskStatus {
                 if (task.id == "b") throw OutputError("no space");
                 return TaskStatus::kFitted;
               }),
               OutputError);
  EXPECT_THAT(Run(kAllFit), ElementsAre("b", "c", "d"));
}

}  // namespace
}  // namespace lobefit
