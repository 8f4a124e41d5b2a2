#include "lobefit/batch/results/results.h"

#include <sstream>

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/batch/list/csv_text.h"
#include "lobefit/batch/results/result_row.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

WorkList List() {
  WorkList list;
  list.extra_columns = {"lab"};
  for (const char* id : {"c", "a", "b"}) list.tasks.push_back({id, id, id, 1, {}, "s", {std::string("lab ") + id}, ""});
  return list;
}

DoneRecord Done(const std::string& id, TaskStatus status, std::string_view row) {
  DoneRecord done;
  done.id = id;
  done.key = "k" + id;
  done.settings = "s";
  done.status = status;
  done.row = row;
  return done;
}

TEST(Results, ColumnsAreOfAllRowsAndRowsById) {
  const WorkList list = List();
  Records records;
  records.segments.resize(1);
  records.done = {Done("c", TaskStatus::kFitted, R"({"verdict":"good","f0[R]":0.5,"f0[R].stderr":null})"),
                  Done("a", TaskStatus::kFailed, ""),
                  Done("b", TaskStatus::kFitted, R"({"verdict":null,"alpha_x":0.25})")};
  const ResultTable table = MakeTable(list, records, 2);
  EXPECT_EQ(table.ExitCode(), kExitFit);
  std::ostringstream file;
  WriteCsv(table, 2, file);
  const std::string csv = file.str();
  CsvRecords reader(csv, "");
  std::vector<std::string> columns, row;
  ASSERT_TRUE(reader.Next(&columns));
  EXPECT_THAT(std::vector<std::string>(columns.begin(), columns.begin() + 8),
              ElementsAre("id", "file", "lab", "status", "verdict", "message", "sha256", "key"));
  EXPECT_THAT(std::vector<std::string>(columns.end() - 3, columns.end()),
              ElementsAre("alpha_x", "f0[R]", "f0[R].stderr"));
  std::vector<std::string> ids;
  while (reader.Next(&row)) {
    ids.push_back(row[0]);
    EXPECT_EQ(row[2], "lab " + row[0]);
    if (row[0] == "b") {
      EXPECT_EQ(row[columns.size() - 3], "0.25");
    } else if (row[0] == "c") {
      EXPECT_EQ(row[4], "good");
    }
  }
  EXPECT_THAT(ids, ElementsAre("a", "b", "c"));
  std::stringstream lines;
  WriteJsonLines(table, 2, lines);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(nlohmann::json::parse(line)["result"], nullptr);
  std::getline(lines, line);
  EXPECT_EQ(nlohmann::json::parse(line)["result"]["alpha_x"], 0.25);
  EXPECT_EQ(nlohmann::json::parse(line)["lab"], "lab b");
}

TEST(Results, ColumnsOfTheListStayBesideResultsOfTheirName) {
  WorkList list = List();
  list.extra_columns = {"alpha_x", "lab", "listed.alpha_x"};
  for (Task& task : list.tasks) task.extra = {"0.3", "x", "y"};
  Records records;
  records.segments.resize(1);
  records.done = {Done("a", TaskStatus::kFitted, R"({"alpha_x":0.25})")};
  const ResultTable table = MakeTable(list, records, 1);
  EXPECT_THAT(std::vector<std::string>(table.columns.begin(), table.columns.begin() + 6),
              ElementsAre("id", "file", "listed.listed.alpha_x", "lab", "listed.alpha_x", "status"));
  RowTexts texts(table);
  const std::vector<std::string>& row = texts.Of(table.rows[0]);
  EXPECT_EQ(table.columns.back(), "alpha_x");
  EXPECT_EQ(row.back(), "0.25");
  EXPECT_EQ(row[2], "0.3");
  EXPECT_THAT(ReservedColumns(), testing::Contains("result"));
}

TEST(Results, ExitCodeSaysWhatIsLeft) {
  const WorkList list = List();
  Records records;
  records.segments.resize(1);
  records.done = {Done("a", TaskStatus::kFitted, ""), Done("b", TaskStatus::kFitted, "")};
  EXPECT_EQ(MakeTable(list, records, 1).ExitCode(), kExitMissing);
  records.done.push_back(Done("c", TaskStatus::kFitted, ""));
  EXPECT_EQ(MakeTable(list, records, 1).ExitCode(), kExitDone);
  records.done.back().status = TaskStatus::kDoubtful;
  EXPECT_EQ(MakeTable(list, records, 1).ExitCode(), kExitFit);
}

TEST(Results, RunsHoldWhatDoesNotCountToo) {
  const WorkList list = List();
  Records records;
  records.segments = {{"host-1-00", "host", false, "", 0}};
  DoneRecord first = Done("a", TaskStatus::kFailed, ""), second = Done("a", TaskStatus::kFitted, "");
  first.at = 1700000000.5;
  second.at = 1700000002;
  records.done = {first, second};
  records.deaths["b"] = {{"b", 1700000001, 0}};
  std::ostringstream file;
  WriteRuns(MakeTable(list, records, 1), file);
  EXPECT_EQ(file.str(),
            "id,status,counts,begun,seconds,threads,peak_mb,host,segment\n"
            "a,failed,no,2023-11-14T22:13:20.500Z,0.000000,1,0.0,host,host-1-00\n"
            "b,died,no,2023-11-14T22:13:21.000Z,,,,host,host-1-00\n"
            "a,fitted,yes,2023-11-14T22:13:22.000Z,0.000000,1,0.0,host,host-1-00\n");
}

}  // namespace
}  // namespace lobefit
