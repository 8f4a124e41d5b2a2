#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>

#include "tests/batch/batch_test.h"
#include "tests/support/schema.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lobefit {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using BatchVerb = BatchTest;

TEST_F(BatchVerb, FitsAFolderAndGoesOn) {
  MakeFiles(5);
  ProgramResult result = Shell("lobefit batch data --out out");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("fitted m003.csv\n"), HasSubstr("Tasks:   5 listed, 5 fitted\n")));
  const auto table = Table("out/results.csv");
  ASSERT_EQ(table.size(), 5U);
  EXPECT_EQ(table.at("m000.csv").at("status"), "fitted");
  EXPECT_EQ(table.at("m000.csv").at("file"), "m000.csv");
  EXPECT_EQ(table.at("m000.csv").at("sha256").size(), 64U);
  for (const char* column :
       {"verdict", "typical_error", "noise", "key", "recipe", "error.log", "f0[R].stderr_clustered"})
    EXPECT_TRUE(table.at("m000.csv").contains(column)) << column;
  EXPECT_TRUE(FollowsSchema(ReadWholeFile(folder_ / "out/documents/m004.csv.material.json")));
  for (const char* file : {"index.html", "runs.csv", "results.jsonl"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  EXPECT_THAT(ReadWholeFile(folder_ / "out/index.html"), HasSubstr("{\"measured\":false,\"png\":\"iVBORw0KGgo"));
  const std::string before = ReadWholeFile(folder_ / "out/results.csv");
  result = Shell("lobefit batch data --out out");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, Not(HasSubstr("fitted m003.csv")));
  EXPECT_EQ(ReadWholeFile(folder_ / "out/results.csv"), before);
}

TEST_F(BatchVerb, GivesTheNumbersOfFit) {
  MakeFiles(1);
  ASSERT_EQ(Shell("lobefit batch data --recipe ggx --theta-max 70 --out out").exit_code, 0);
  const ProgramResult fit = Shell("lobefit fit data/m000.csv --recipe ggx --theta-max 70 --json --no-report");
  const nlohmann::json alone = nlohmann::json::parse(fit.out),
                       batch = nlohmann::json::parse(ReadWholeFile(folder_ / "out/documents/m000.csv.material.json"));
  EXPECT_EQ(alone["parameters"], batch["parameters"]);
  EXPECT_EQ(alone["covariance"], batch["covariance"]);
  EXPECT_EQ(batch["command"], "lobefit fit m000.csv --recipe ggx --theta-max 70");
  EXPECT_EQ(std::stod(Table("out/results.csv").at("m000.csv").at("alpha_x")),
            alone["parameters"]["alpha_x"]["value"].get<double>());
}

TEST_F(BatchVerb, FailuresAreRowsAndExitCode4) {
  MakeFiles(2);
  MakeBrokenFiles();
  const ProgramResult result = Shell("lobefit batch data/*.csv none.csv --out out");
  EXPECT_EQ(result.exit_code, 3) << "a name that is not there is an error of the command";
  EXPECT_THAT(result.err, HasSubstr("none.csv: is not there"));
  const ProgramResult listed = Shell("(ls data/*; echo none.csv) | lobefit batch - --out out");
  EXPECT_EQ(listed.exit_code, 4) << listed.err;
  const auto table = Table("out/results.csv");
  EXPECT_EQ(table.size(), 6U);
  EXPECT_EQ(table.at("data/broken_row.csv").at("status"), "failed");
  EXPECT_THAT(table.at("data/broken_row.csv").at("message"),
              AllOf(HasSubstr("data/broken_row.csv"), HasSubstr("line 2")));
  EXPECT_THAT(table.at("none.csv").at("message"), Not(HasSubstr(folder_.string())));
  EXPECT_EQ(Shell("lobefit batch --out out --status").exit_code, 4);
}

TEST_F(BatchVerb, ManifestsBringOptionsIdsAndColumns) {
  MakeFiles(2);
  WriteWholeFile(folder_ / "mine.toml", "[[lobe]]\nndf = \"beckmann\"\n");
  WriteWholeFile(folder_ / "list.csv",
                 "file,id,recipe,theta-max,lab\ndata/m000.csv,one,mine.toml,,\"A, "
                 "B\"\ndata/m000.csv,two,,60,C\ndata/m001.csv,,,,\n");
  std::filesystem::create_directories(folder_ / "elsewhere");
  const ProgramResult result = Shell("cd elsewhere; lobefit batch ../list.csv --recipe ggx --out ../out");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto table = Table("out/results.csv");
  EXPECT_EQ(table.at("one").at("lab"), "A, B");
  EXPECT_THAT(table.at("one").at("model"), HasSubstr("beckmann"));
  EXPECT_THAT(table.at("two").at("model"), HasSubstr("ggx"));
  EXPECT_NE(table.at("two").at("samples_used"), table.at("data/m001.csv").at("samples_used"));
}

// One file an incidence, as a goniometer leaves them.
TEST_F(BatchVerb, ASeriesIsOneTask) {
  const std::string whole = ReadWholeFile(std::filesystem::path(test::SourceDir()) / "samples" / "satin_plastic.csv");
  std::filesystem::create_directories(folder_ / "blue");
  std::map<std::string, std::string> parts;
  std::istringstream lines(whole);
  std::string head, line;
  while (std::getline(lines, line)) {
    if (line.empty() || line[0] == '#' || line[0] > '9') {
      head += line + "\n";
    } else {
      parts[line.substr(0, line.find(','))] += line + "\n";
    }
  }
  ASSERT_GT(parts.size(), 2U);
  for (const auto& [incidence, rows] : parts)
    WriteWholeFile(folder_ / "blue" / ("i" + incidence + ".csv"), head + rows);
  WriteWholeFile(folder_ / "list.csv", "file,lab\nblue,A\nblue/i*.csv,B\n\"none/x1.csv;none/x2.csv\",C\n");
  EXPECT_EQ(Shell("lobefit batch list.csv --recipe ggx --out out").exit_code, 3) << "the rows are the same files";
  WriteWholeFile(folder_ / "list.csv", "file,lab\nblue,A\n\"none/x1.csv;none/x2.csv\",C\n");
  const ProgramResult result = Shell("lobefit batch list.csv --recipe ggx --out out");
  EXPECT_EQ(result.exit_code, 4) << result.err;
  auto table = Table("out/results.csv");
  ASSERT_EQ(table.size(), 2U);
  EXPECT_EQ(table.at("none/x").at("status"), "failed");
  EXPECT_THAT(table.at("none/x").at("message"), AllOf(HasSubstr("none/x1.csv"), Not(HasSubstr(folder_.string()))));
  ASSERT_EQ(Shell("lobefit fit blue --recipe ggx --no-report --name fit").exit_code, 0);
  const nlohmann::json alone = nlohmann::json::parse(ReadWholeFile(folder_ / "fit.material.json")),
                       batch = nlohmann::json::parse(ReadWholeFile(folder_ / "out/documents/blue.material.json"));
  EXPECT_EQ(alone["parameters"], batch["parameters"]);
  EXPECT_EQ(alone["source"]["sha256"], batch["source"]["sha256"]);
  // Any of the files decides; the same ones give the same.
  EXPECT_THAT(Shell("lobefit batch list.csv --recipe ggx --out out --dry-run").out, HasSubstr("2 done, 0 to do"));
  EXPECT_EQ(Shell("echo blue | lobefit batch - --recipe ggx --out listed").exit_code, 0);
  EXPECT_EQ(Table("listed/results.csv").at("blue").at("sha256"), batch["source"]["sha256"]);
  EXPECT_THAT(Shell("printf 'a\\0b\\0' | lobefit batch - --out none").err, HasSubstr("line 1: holds a zero byte"));
  EXPECT_THAT(Shell("mkdir empty; echo empty | lobefit batch - --out none").err,
              HasSubstr("line 1: 'empty' is a folder without measurement files"));
  std::filesystem::remove(folder_ / "blue" / ("i" + parts.begin()->first + ".csv"));
  EXPECT_THAT(Shell("lobefit batch list.csv --recipe ggx --out out --dry-run").out, HasSubstr("1 done, 1 to do"));
  WriteWholeFile(folder_ / "blue" / "notes.txt", "hello");
  const std::string rest = "blue/i" + std::next(parts.begin())->first + ".csv";
  WriteWholeFile(folder_ / rest, ReadWholeFile(folder_ / rest) + "\n");
  EXPECT_THAT(Shell("echo blue | lobefit batch - --recipe ggx --out listed --dry-run").out,
              HasSubstr("0 done, 1 to do"));
}

TEST_F(BatchVerb, RefusesBadInputBeforeAnythingRuns) {
  MakeFiles(2);
  const auto refused = [&](const std::string& manifest, const std::string& options, int code,
                           const std::string& message) {
    WriteWholeFile(folder_ / "list.csv", manifest);
    const ProgramResult result = Shell("lobefit batch list.csv --out out " + options);
    EXPECT_EQ(result.exit_code, code) << manifest << options;
    EXPECT_THAT(result.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << message;
  };
  refused("", "", 3, "list.csv: is empty");
  refused("file\n", "", 3, "list.csv: lists no file");
  refused("id,lab\na,b\n", "", 3, "needs the column 'file'");
  refused("file\ndata/m000.csv\ndata/m000.csv\n", "", 3,
          "list.csv, line 3: 'data/m000.csv' is listed already (list.csv, line 2)");
  refused("file,recipe\ndata/m000.csv,gxx\n", "", 3, "list.csv, line 2: recipe 'gxx'");
  refused("file,theta-max\ndata/m000.csv,700\n", "", 2, "list.csv, line 2");
  refused("file,angle-unit\ndata/m000.csv,turns\n", "", 2, "list.csv, line 2: --angle-unit turns");
  refused("file\ndata/m000.csv\n", "--shard 3/2", 2, "--shard 3/2");
  refused("file\ndata/m000.csv\n", "--memory lots", 2, "--memory lots");
  refused("file\ndata/m000.csv\n", "--engine slurm --shards 2", 2, "at most one shard a task");
  refused("file\ndata/m000.csv\n", "--submit", 2, "belong to --engine slurm");
  refused("file\ndata/m000.csv\n", "--format pdf", 2, "--format 'pdf'");
  EXPECT_EQ(Shell("lobefit batch --out out").exit_code, 2);
  EXPECT_EQ(Shell("lobefit batch --out out --collect").exit_code, 2);
  EXPECT_EQ(Shell("touch file; lobefit batch data --out file/out").exit_code, 3);
}

TEST_F(BatchVerb, AnOutOfAnotherBatchIsRefused) {
  MakeFiles(2);
  ASSERT_EQ(Shell("lobefit batch data/m000.csv --out out --recipe ggx").exit_code, 0);
  ProgramResult result = Shell("lobefit batch data/m001.csv --out out --recipe ggx");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("'data/m000.csv'"), HasSubstr("choose another --out")));
  result = Shell("lobefit batch data/m000.csv --out out --recipe ellipsoid");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--recipe ellipsoid"), HasSubstr("--recipe ggx")));
  // One that grows is the same batch.
  result = Shell("lobefit batch data/m000.csv data/m001.csv --out out --recipe ggx");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, Not(HasSubstr("fitted data/m000.csv")));
  EXPECT_EQ(Table("out/results.csv").size(), 2U);
}

TEST_F(BatchVerb, ShardsOneJobAndManyJobsGiveTheSameBytes) {
  MakeFiles(7);
  MakeBrokenFiles();
  const std::string list = "ls data/* | lobefit batch - --out ";
  EXPECT_EQ(Shell(list + "one --jobs 1 --threads 1").exit_code, 4);
  EXPECT_EQ(Shell(list + "many --jobs 3 --threads 4").exit_code, 4);
  EXPECT_EQ(Shell(list + "shards --shard 2/3").exit_code, 0);
  EXPECT_EQ(Shell("lobefit batch --out shards --status").exit_code, 5);
  // The number of shards changes in the middle, and two processes do the same.
  EXPECT_EQ(Shell("lobefit batch --out shards --shard 1/2 & lobefit batch --out shards --shard 1/2 & wait").exit_code,
            0);
  EXPECT_EQ(Shell("lobefit batch --out shards --shard 2/2").exit_code, 0);
  EXPECT_EQ(Shell("lobefit batch --out shards --collect").exit_code, 4);
  EXPECT_TRUE(Same("one/results.csv", "many/results.csv"));
  EXPECT_TRUE(Same("one/results.csv", "shards/results.csv"));
  EXPECT_TRUE(Same("one/results.jsonl", "shards/results.jsonl"));
}

TEST_F(BatchVerb, DryRunAndStatusWriteNothing) {
  MakeFiles(2);
  const ProgramResult result = Shell("lobefit batch data --out out --dry-run");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, AllOf(HasSubstr("fit m000.csv ("), HasSubstr("2 listed, 0 done, 2 to do")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
  ASSERT_EQ(Shell("lobefit batch data --out out --shard 1/2").exit_code, 0);
  const ProgramResult status = Shell("lobefit batch --out out --status --json");
  EXPECT_EQ(status.exit_code, 5);
  const nlohmann::json json = nlohmann::json::parse(status.out);
  EXPECT_EQ(json["fitted"], 1);
  EXPECT_EQ(json["missing"].size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/results.csv"));
}

TEST_F(BatchVerb, ReportsAreDrawnWhereAskedFor) {
  MakeFiles(1);
  std::string csv = "theta_i,phi_i,theta_o,phi_o,value\n";
  for (int i = 0; i < 12; ++i) csv += "20,0," + std::to_string(20 + 1e-5 * i) + ",180,0.5\n";
  WriteWholeFile(folder_ / "data" / "one.csv", csv);
  EXPECT_EQ(Shell("lobefit batch data --recipe ggx --out out --reports failed --format png").exit_code, 4);
  EXPECT_EQ(Table("out/results.csv").at("one.csv").at("status"), "doubtful");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/documents/one.csv.report.png"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/documents/m000.csv.report.png"));
}

TEST_F(BatchVerb, SigtermFinishesAndExits5) {
  MakeFiles(30);
  const ProgramResult result = Shell(
      "lobefit batch data --out out --starts 3000 --jobs 1 & pid=$!\n"
      "while ! grep -qs '\"done\"' out/segments/*; do sleep 0.02; done; kill -TERM $pid; wait $pid; echo code $?");
  EXPECT_THAT(result.out, HasSubstr("code 5"));
  EXPECT_THAT(result.err, HasSubstr("the same command goes on"));
  // Nothing is left half done.
  EXPECT_EQ(Shell("test $(grep -c '\"start\":' out/segments/*) = $(grep -c '\"done\":' out/segments/*)").exit_code, 0);
  EXPECT_THAT(Shell("lobefit batch --out out --status").out, HasSubstr("missing: "));
}

TEST_F(BatchVerb, MakesAScriptForSlurm) {
  MakeFiles(3);
  const ProgramResult result = Shell("lobefit batch data --out 'o u t' --engine slurm --shards 2 --threads 4");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string script = ReadWholeFile(folder_ / "o u t" / "array.sbatch");
  for (const char* line : {"#SBATCH --array=1-2\n", "#SBATCH --requeue\n", "#SBATCH --cpus-per-task=4\n",
                           "--shard \"$SLURM_ARRAY_TASK_ID/2\"\n", "--dependency=\"afterany:"})
    EXPECT_THAT(script, HasSubstr(line));
  EXPECT_EQ(Shell("sh -n 'o u t/array.sbatch'").exit_code, 0);
  // What an element runs.
  EXPECT_EQ(Shell("SLURM_ARRAY_TASK_ID=2 sh 'o u t/array.sbatch'").exit_code, 0);
  EXPECT_EQ(Shell("SLURM_ARRAY_TASK_ID=1 sh 'o u t/array.sbatch'").exit_code, 0);
  EXPECT_EQ(Shell("lobefit batch --out 'o u t' --status").exit_code, 0);
  EXPECT_EQ(
      Shell("PATH=$(dirname $(command -v lobefit)) lobefit batch --out 'o u t' --engine slurm --submit").exit_code, 2);
}

}  // namespace
}  // namespace lobefit
