#include "lobefit/batch/run/records.h"

#include <filesystem>
#include <fstream>

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/batch/run/journal.h"

namespace lobefit {
namespace {

DoneRecord Done(const std::string& id, TaskStatus status, double at, const std::string& key = "k") {
  DoneRecord done;
  done.id = id;
  done.key = key;
  done.settings = "s";
  done.status = status;
  done.at = at;
  done.stamps = {{5, 1234567890123456789, 3}, {6, 0, 4}};
  done.message = "a \"quoted\" ,\"row\":{ message";
  if (status == TaskStatus::kFitted) done.row = R"({"verdict":null,"alpha_x":0.125})";
  return done;
}

class RecordsTest : public ProgramTest {
 protected:
  std::filesystem::path Segments() const { return folder_ / "segments"; }
  std::filesystem::path OnlySegment() const { return std::filesystem::directory_iterator(Segments())->path(); }
};

TEST_F(RecordsTest, ComeBackAsTheyWereWritten) {
  {
    Journal journal(Segments());
    journal.Append(ToLine(StartRecord{"a/\xC3\xA4", 1, 0}));
    journal.Commit(ToLine(Done("a/\xC3\xA4", TaskStatus::kFitted, 2)), {});
    journal.Commit(ToLine(Done("b", TaskStatus::kFailed, 3)), {});
  }
  const Records records = ReadRecords(folder_, 2);
  ASSERT_EQ(records.segments.size(), 1U);
  EXPECT_EQ(records.segments[0].lines_lost, 0U);
  ASSERT_EQ(records.done.size(), 2U);
  EXPECT_EQ(records.done[0].id, "a/\xC3\xA4");
  RowReader rows(records);
  EXPECT_EQ(rows.Read(records.done[0]), R"({"verdict":null,"alpha_x":0.125})");
  EXPECT_EQ(rows.Read(records.done[1]), "");
  EXPECT_EQ(records.done[0].message, "a \"quoted\" ,\"row\":{ message");
  EXPECT_THAT(records.done[0].stamps, testing::ElementsAre(FileStamp{5, 1234567890123456789, 3}, FileStamp{6, 0, 4}));
  EXPECT_EQ(NameOf(records.done[1].status), "failed");
}

TEST_F(RecordsTest, ALineIsThereAfterItsFilesAndBothTogether) {
  Journal journal(Segments());
  for (int i = 0; i < 200; ++i) {
    const std::string id = std::to_string(i);
    FileGroup files;
    files.Add(folder_ / id, id);
    journal.Commit(ToLine(Done(id, TaskStatus::kFitted, i)), std::move(files));
    const Records records = ReadRecords(folder_, 1);
    // A whole group at most is on its way.
    EXPECT_GE(records.done.size() + 64, static_cast<std::size_t>(i + 1));
    for (const DoneRecord& done : records.done) ASSERT_EQ(ReadWholeFile(folder_ / done.id), done.id);
  }
  journal.Close();
  EXPECT_EQ(ReadRecords(folder_, 1).done.size(), 200U);
}

TEST_F(RecordsTest, AFileThatCannotBePlacedLeavesNoLineAndIsSaid) {
  Journal journal(Segments());
  FileGroup files;
  files.Add(folder_ / "taken", "x");
  std::filesystem::create_directories(folder_ / "taken");
  journal.Commit(ToLine(Done("a", TaskStatus::kFitted, 1)), std::move(files));
  EXPECT_THROW(journal.Close(), OutputError);
  EXPECT_TRUE(ReadRecords(folder_, 1).done.empty());
}

TEST_F(RecordsTest, AFailureOfAGroupEndsTheNextCommit) {
  Journal journal(Segments());
  FileGroup files;
  files.Add(folder_ / "taken", "x");
  std::filesystem::create_directories(folder_ / "taken");
  journal.Commit(ToLine(Done("a", TaskStatus::kFitted, 1)), std::move(files));
  const auto commit_more = [&] {
    for (int i = 0; i < 1000; ++i) journal.Commit(ToLine(Done("b", TaskStatus::kFitted, 1)), {});
  };
  EXPECT_THROW(commit_more(), OutputError);
}

TEST_F(RecordsTest, ALineWithoutFilesIsThereAtOnce) {
  Journal journal(Segments());
  journal.Commit(ToLine(Done("a", TaskStatus::kFailed, 1)), {});
  EXPECT_EQ(ReadRecords(folder_, 1).done.size(), 1U);
}

TEST_F(RecordsTest, APictureBelongsToTheNextLine) {
  DoneRecord with = Done("a", TaskStatus::kFitted, 1), without = Done("b", TaskStatus::kFitted, 1);
  with.picture = "iVBOR+/=";
  with.picture_is_measured = true;
  EXPECT_EQ(DoneFromLine(ToLine(with)).picture, with.picture);
  EXPECT_EQ(DoneFromLine(ToLine(with)).row, with.row);
  {
    Journal journal(Segments());
    journal.Commit(ToLine(with), {});
    journal.Commit(ToLine(without), {});
  }
  const std::string whole = ReadWholeFile(OnlySegment());
  for (const bool cut : {false, true}) {
    // A picture that lost its end is none, and no line of another task.
    if (cut) WriteWholeFile(OnlySegment(), std::string(whole).replace(whole.find("+/=\"}"), 5, ""));
    const Records records = ReadRecords(folder_, 1);
    RowReader reader(records);
    ASSERT_EQ(records.done.size(), 2U);
    EXPECT_EQ(reader.ReadPicture(records.done[0]), cut ? "" : "iVBOR+/=");
    EXPECT_EQ(reader.ReadPicture(records.done[1]), "");
    EXPECT_EQ(reader.Read(records.done[0]), with.row);
    EXPECT_EQ(records.segments[0].lines_lost, cut ? 1U : 0U);
    EXPECT_TRUE(cut || records.done[0].picture_is_measured);
  }
}

TEST_F(RecordsTest, ReadsLongSegmentsInPieces) {
  std::filesystem::create_directories(Segments());
  std::string text;
  constexpr int kCount = 12000;  // 9 MB
  for (int i = 0; i < kCount; ++i) {
    DoneRecord done = Done(std::to_string(i), TaskStatus::kFitted, i);
    done.row =
        "{\"x\":" + std::to_string(i) + ",\"y\":\"" + std::string(static_cast<std::size_t>(i % 997), 'y') + "\"}";
    done.picture = "picture" + std::to_string(i);
    text += ToLine(done) + "\n";
  }
  // Blank lines, which are passed over, bring the end of a piece of 4 MB between a picture and its task.
  constexpr std::size_t kPiece = 1 << 22;
  const std::size_t place = text.rfind("{\"done\"", kPiece);
  text.insert(0, kPiece - place, '\n');
  WriteWholeFile(Segments() / "long.jsonl", text);
  const Records records = ReadRecords(folder_, 3);
  ASSERT_EQ(records.done.size(), static_cast<std::size_t>(kCount));
  EXPECT_EQ(records.segments[0].lines_lost, 0U);
  RowReader reader(records);
  for (int i = 0; i < kCount; i += 7) {
    const DoneRecord& done = records.done[static_cast<std::size_t>(i)];
    EXPECT_EQ(done.id, std::to_string(i));
    EXPECT_TRUE(reader.Read(done).starts_with("{\"x\":" + done.id + ","));
  }
  for (const DoneRecord& done : records.done) ASSERT_EQ(reader.ReadPicture(done), "picture" + done.id);
}

TEST_F(RecordsTest, WritesNoFileWithoutALine) {
  { const Journal journal(Segments()); }
  EXPECT_FALSE(std::filesystem::exists(Segments()));
}

TEST_F(RecordsTest, EachJournalHasAFileOfItsOwn) {
  {
    Journal a(Segments()), b(Segments());
    EXPECT_NE(a.name(), b.name());
    a.Commit(ToLine(Done("a", TaskStatus::kFitted, 1)), {});
    b.Commit(ToLine(Done("b", TaskStatus::kFitted, 1)), {});
  }
  EXPECT_EQ(ReadRecords(folder_, 1).segments.size(), 2U);
}

TEST_F(RecordsTest, PassesOverLinesThatWereCutShort) {
  {
    Journal journal(Segments());
    for (int i = 0; i < 5; ++i) journal.Commit(ToLine(Done("t" + std::to_string(i), TaskStatus::kFitted, i)), {});
  }
  const std::string whole = ReadWholeFile(OnlySegment());
  std::size_t seen = 0;
  for (std::size_t length = 0; length <= whole.size(); length += 7) {
    WriteWholeFile(OnlySegment(), whole.substr(0, length));
    const Records records = ReadRecords(folder_, 1);
    // Whatever is left of the last line: the others count, and nothing else does.
    const auto lines =
        static_cast<std::size_t>(std::count(whole.begin(), whole.begin() + static_cast<long>(length), '\n'));
    EXPECT_LE(records.done.size(), lines == 0 ? 0 : lines);
    EXPECT_GE(records.done.size() + 1, lines);
    seen = std::max(seen, records.done.size());
  }
  EXPECT_GE(seen, 4U);
}

TEST_F(RecordsTest, TasksOfAProcessThatIsGoneCountAsDeaths) {
  {
    Journal journal(Segments());
    journal.Append(ToLine(StartRecord{"done", 1, 0}));
    journal.Append(ToLine(StartRecord{"begun", 2, 0}));
    journal.Commit(ToLine(Done("done", TaskStatus::kFailed, 3)), {});
    // This process still runs.
    EXPECT_TRUE(ReadRecords(folder_, 1).deaths.empty());
  }
  std::string text = ReadWholeFile(OnlySegment());
  const std::size_t at = text.find("\"start_ticks\":") + 14;
  WriteWholeFile(OnlySegment(), text.insert(at, "1"));
  const Records records = ReadRecords(folder_, 1);
  ASSERT_EQ(records.deaths.size(), 1U);
  EXPECT_EQ(records.deaths.at("begun")[0].at, 2);
}

TEST_F(RecordsTest, ATaskThatItsProcessOutlivedIsNoDeath) {
  std::filesystem::create_directories(Segments());
  WriteWholeFile(Segments() / "x.jsonl",
                 ToLine(StartRecord{"a", 1, 0}) + "\n" + ToLine(StartRecord{"b", 1, 0}) + "\n" + EndedLine("a") + "\n");
  const Records records = ReadRecords(folder_, 1);
  EXPECT_TRUE(records.done.empty());
  EXPECT_EQ(records.deaths.size(), 1U);
  EXPECT_TRUE(records.deaths.contains("b"));
}

TEST_F(RecordsTest, TheBestOfOneKeyCountsElseTheLast) {
  std::filesystem::create_directories(Segments());
  const auto latest = [&](const std::vector<DoneRecord>& lines) {
    std::string text;
    for (const DoneRecord& line : lines) text += ToLine(line) + "\n";
    WriteWholeFile(Segments() / "x.jsonl", text);
    const Records records = ReadRecords(folder_, 1);
    const DoneRecord* done = LatestDone(records, {{"a", "s"}}).at("a");
    return std::make_pair(done->status, done->at);
  };
  const TaskStatus fitted = TaskStatus::kFitted, failed = TaskStatus::kFailed, crashed = TaskStatus::kCrashed;
  EXPECT_EQ(latest({Done("a", fitted, 1), Done("a", crashed, 2)}), std::make_pair(fitted, 1.0));
  EXPECT_EQ(latest({Done("a", crashed, 2), Done("a", failed, 1)}), std::make_pair(failed, 1.0));
  EXPECT_EQ(latest({Done("a", failed, 1), Done("a", failed, 2)}), std::make_pair(failed, 2.0));
  EXPECT_EQ(latest({Done("a", fitted, 1), Done("a", failed, 2, "other")}), std::make_pair(failed, 2.0));
}

TEST_F(RecordsTest, OtherSettingsAndUnknownTasksAreLeftOut) {
  std::filesystem::create_directories(Segments());
  WriteWholeFile(Segments() / "x.jsonl", ToLine(Done("a", TaskStatus::kFitted, 1)) + "\n");
  const Records records = ReadRecords(folder_, 1);
  EXPECT_TRUE(LatestDone(records, {{"a", "t"}}).empty());
  EXPECT_TRUE(LatestDone(records, {{"b", "s"}}).empty());
}

TEST(Writers, AreRecognised) {
  const Writer here = ThisProcess();
  EXPECT_TRUE(IsRunning(here));
  Writer other = here;
  other.start_ticks += 1;
  EXPECT_FALSE(IsRunning(other));
  other = here;
  other.space = "before the last boot";
  EXPECT_FALSE(IsRunning(other));
  other = here;
  other.host = "elsewhere";
  EXPECT_FALSE(IsRunning(other));
}

// Where nobody asks how it ended, as in containers without an init, a process keeps its entry after its death.
TEST(Writers, OneThatIsDeadAndNotWaitedForDoesNotRun) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const std::uint64_t ticks = ThisProcess().start_ticks;
    _exit(write(ends[1], &ticks, sizeof ticks) == sizeof ticks ? 0 : 1);
  }
  Writer dead = ThisProcess();
  dead.pid = child;
  ASSERT_EQ(read(ends[0], &dead.start_ticks, sizeof dead.start_ticks), static_cast<ssize_t>(sizeof dead.start_ticks));
  siginfo_t how;
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(child), &how, WEXITED | WNOWAIT), 0);
  EXPECT_FALSE(IsRunning(dead));
  waitpid(child, nullptr, 0);
  close(ends[0]);
  close(ends[1]);
}

TEST_F(RecordsTest, SaysWhereNothingCanBeWritten) {
  WriteWholeFile(folder_ / "file", "");
  Journal journal(folder_ / "file" / "segments");
  EXPECT_THROW(journal.Append("{}"), OutputError);
}

}  // namespace
}  // namespace lobefit
