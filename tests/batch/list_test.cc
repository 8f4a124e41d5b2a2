// Manifests, inputs, stored lists, shards.
#include <filesystem>

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/batch/list/inputs.h"
#include "lobefit/batch/list/manifest.h"
#include "lobefit/batch/list/series.h"
#include "lobefit/batch/list/shard.h"
#include "lobefit/batch/list/work_list.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Throws;
using testing::ThrowsMessage;

const ManifestNames kNames = {{"recipe", "theta-max"}, {"recipe"}, {"out"}, {"status", "verdict"}};
constexpr const char* kCsv = "theta_i,phi_i,theta_o,phi_o,value\n20,0,20,180,0.5\n30,0,30,180,0.5\n";

WorkList Parse(const std::string& text) { return ParseManifest(text, "/data/list.csv", kNames); }

TEST(Manifest, TakesIdsOptionsAndOtherColumns) {
  const WorkList list = Parse("operator,file,theta-max,id\nAnn,a/x.csv,70,first\n\"Bo, C\",../y.csv,,\n");
  ASSERT_EQ(list.tasks.size(), 2U);
  EXPECT_EQ(list.tasks[0].id, "first");
  EXPECT_EQ(list.tasks[0].path, "/data/a/x.csv");
  EXPECT_THAT(list.tasks[0].options, ElementsAre(testing::Pair("theta-max", "70")));
  EXPECT_EQ(list.tasks[1].id, "y.csv");
  EXPECT_EQ(list.tasks[1].path, "/y.csv");
  EXPECT_TRUE(list.tasks[1].options.empty());
  EXPECT_THAT(list.extra_columns, ElementsAre("operator"));
  EXPECT_THAT(list.tasks[1].extra, ElementsAre("Bo, C"));
  EXPECT_EQ(list.tasks[1].place, "/data/list.csv, line 3");
}

TEST(Manifest, RefusesWithLineAndCure) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "is empty; a manifest has a header"},
      {"file\n", "lists no file"},
      {"id,recipe\na,ggx\n", "line 1: a manifest needs the column 'file'; its columns are id, recipe"},
      {"file,file\na,b\n", "line 1: column 'file' is there twice"},
      {"file,,x\na,b,c\n", "line 1: column 2 has no name"},
      {"file,out\na,b\n", "give --out on the command line"},
      {"file,status\na,b\n", "column 'status' is one of the results' own; rename it"},
      {"file,x\na,b\nc\n", "line 3: has 1 fields, the header has 2"},
      {"file,x\n,b\n", "line 2: names no file"},
      {"file\n..\n", "line 2: '..' holds no beginning that the results can be named by; give the row an id"},
      {"file\na.csv;b.csv\n", "line 2: 'a.csv;b.csv' holds no beginning"},
      {"file\nx1.csv;x2.csv;x1.csv\n", "line 2: 'x1.csv' is named twice"},
      {"file,id\nscan_*.csv,a\n", "line 2: 'scan_*.csv' matches no file"}};
  for (const auto& [text, message] : cases)
    EXPECT_THAT([text = text] { Parse(text); }, ThrowsMessage<InputError>(HasSubstr(message))) << text;
}

// A pattern of half a million folders took gigabytes and did not end.
TEST(Manifest, NamesAreNoLongerThanFilesMayHave) {
  std::string pattern = "file\na";
  for (int k = 0; k < 3000; ++k) pattern += "/*";
  EXPECT_THAT([&] { Parse(pattern + "\n"); }, ThrowsMessage<InputError>(HasSubstr("has 6001 bytes")));
  // A list of names may be longer.
  std::string list = "file,id\n";
  for (int k = 0; k < 1000; ++k) list += "scan_" + std::to_string(k) + ".csv;";
  EXPECT_EQ(Parse(list + ",a\n").tasks.at(0).members.size(), 1000U);
}

TEST(Manifest, SeriesAreNamedByWhatTheirNamesShare) {
  const std::pair<const char*, const char*> cases[] = {
      {"blue/scan_*.csv", "blue/scan"},     {"blue/*.csv", "blue"},
      {"blue/10.csv; blue/20.csv", "blue"}, {"a/x_1.csv:theta_i=1;a/x_2.csv:theta_i=2", "a/x"},
      {"scan.csv:theta_i=30", "scan.csv"},  {"*.csv", ""}};
  for (const auto& [cell, id] : cases) EXPECT_EQ(SeriesId(cell), id) << cell;
}

TEST(Manifest, IsToldFromAMeasurement) {
  EXPECT_TRUE(LooksLikeManifest("id,file\n", kNames));
  EXPECT_TRUE(LooksLikeManifest("x,recipe\r\n", kNames));
  EXPECT_FALSE(LooksLikeManifest(kCsv, kNames));
  EXPECT_FALSE(LooksLikeManifest("", kNames));
}

TEST(Manifest, IdIsTheRelativePath) {
  EXPECT_EQ(IdOf("a/b.csv"), "a/b.csv");
  EXPECT_EQ(IdOf("./a//b.csv"), "a/b.csv");
  EXPECT_EQ(IdOf("../../a/b.csv"), "a/b.csv");
  EXPECT_EQ(IdOf("/data/b.csv"), "data/b.csv");
}

class InputsTest : public ProgramTest {
 protected:
  void Put(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    WriteWholeFile(folder_ / name, text);
  }
  Inputs Gather(const std::vector<std::string>& names, const OptionWords& common = {}) const {
    std::vector<std::string> inputs;
    for (const std::string& name : names) inputs.push_back((folder_ / name).string());
    return GatherInputs(inputs, common, kNames, folder_ / "out", {});
  }
};

TEST_F(InputsTest, SearchesFoldersByContent) {
  Put("data/b.txt", kCsv);
  Put("data/sub/a.dat", std::string(kCsv) + "40,0,40,180,0.5\n");
  Put("data/notes.md", "hello");
  Put("data/.hidden.csv", kCsv);
  Put("data/.git/c.csv", kCsv);
  // Of other columns, and prose with commas.
  Put("data/normals.csv", "column,row,height\n1,2,3\n");
  Put("data/LICENSE", "Permission is granted, free of charge,\nto 1, 2 or more persons\n");
  // Prose with a table of what was measured, and prose that speaks of angles.
  Put("data/conditions", "Measured in May.\n\n| theta_i | theta_o | file |\n|---|---|---|\n| 10 | 20 | a.csv |\n");
  Put("data/about.txt", "The angles theta_i, theta_o of the first file are\ngiven in degrees, of the others in rad\n");
  // What a detector gave is no BRDF, but may have been meant.
  Put("data/signal.csv", "theta_i,theta_o,signal\n10,20,1\n");
  // Cut off, and packed and cut off: they are listed, and will fail.
  Put("data/names.csv", "theta_i,phi_i,theta_o,phi_o,value\n");
  Put("data/sub/cut.csv.gz", "\x1f\x8b\x08");
  const Inputs inputs = Gather({"data"});
  ASSERT_EQ(inputs.list.tasks.size(), 5U);
  EXPECT_EQ(inputs.list.tasks[0].id, "sub/a.dat");  // the bigger one
  EXPECT_EQ(inputs.list.tasks[1].id, "b.txt");
  EXPECT_EQ(inputs.list.tasks[2].id, "names.csv");
  EXPECT_EQ(inputs.list.tasks[3].id, "signal.csv");
  EXPECT_EQ(inputs.list.tasks[4].id, "sub/cut.csv.gz");
  EXPECT_EQ(inputs.skipped, 5U);
  ASSERT_EQ(inputs.some_skipped.size(), 5U);
  EXPECT_TRUE(inputs.some_skipped[1].ends_with("about.txt"));
  EXPECT_TRUE(inputs.some_skipped[2].ends_with("conditions"));
}

TEST_F(InputsTest, NamesThatCannotBeWrittenDownAreRefused) {
  Put("data/a.csv", kCsv);
  Put("data/b\xFC.csv", kCsv);  // Latin-1
  try {
    Gather({"data"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("is not UTF-8"));
    EXPECT_THAT(error.what(), testing::HasSubstr("b?.csv"));
  }
  std::filesystem::rename(folder_ / "data/b\xFC.csv", folder_ / "data/b\xC3\xBC.csv");
  EXPECT_EQ(Gather({"data"}).list.tasks.size(), 2U);
}

TEST_F(InputsTest, LinksThatLeadNowhereAreSkippedAndCounted) {
  Put("data/a.csv", kCsv);
  std::filesystem::create_symlink("loop", folder_ / "data/loop");
  std::filesystem::create_symlink("gone.csv", folder_ / "data/dangling.csv");
  const Inputs inputs = Gather({"data"});
  EXPECT_EQ(inputs.list.tasks.size(), 1U);
  EXPECT_EQ(inputs.skipped, 2U);
}

TEST_F(InputsTest, AListWithOtherSeparatorsIsRefusedAsOne) {
  Put("semicolons.csv", "file;recipe\na.csv;ggx\n");
  Put("tabs.csv", "id\tfile\nx\ta.csv\n");
  Put("measurement.csv", "theta_i;phi_i;theta_o;phi_o;value;file\n20;0;20;180;0.5;7\n");
  for (const char* name : {"semicolons.csv", "tabs.csv"})
    EXPECT_THAT([&] { Gather({name}); }, ThrowsMessage<InputError>(HasSubstr("write commas between the columns")));
  EXPECT_EQ(Gather({"measurement.csv"}).list.tasks.size(), 1U);
}

TEST_F(InputsTest, ARowMayBeASeries) {
  for (const char* name : {"s[1]/scan_2.csv", "s[1]/scan_10.csv", "s[1]/other.csv", "s[1]/notes.md", "a;b.csv"})
    Put(name, std::string(name).ends_with("md") ? "hello" : kCsv);
  const auto members = [&](const std::string& cell) {
    Put("list.csv", "file,id\n\"" + cell + "\",x\n");
    const Inputs inputs = Gather({"list.csv"});
    const Task& task = inputs.list.tasks.at(0);
    EXPECT_EQ(task.path, task.members.empty() ? folder_ / cell : folder_);
    const std::uint64_t files = std::max<std::size_t>(1, task.members.size());
    EXPECT_EQ(task.bytes, files * std::string(kCsv).size());
    return task.members;
  };
  EXPECT_THAT(members("s[1]"), ElementsAre("s[1]/other.csv", "s[1]/scan_10.csv", "s[1]/scan_2.csv"));
  EXPECT_THAT(members("s[[]1]/scan_*"), ElementsAre("s[1]/scan_10.csv", "s[1]/scan_2.csv"));
  EXPECT_THAT(members("s[1]/scan_2.csv:theta_i=5; s[1]/other.csv"),
              ElementsAre("s[1]/scan_2.csv:theta_i=5", "s[1]/other.csv"));
  EXPECT_THAT(members("a;b.csv"), ElementsAre());
  Put("list.csv", "file,id\ns[1]/scan_2.csv:theta_i=5,x\n");
  Inputs one = Gather({"list.csv"});
  Put("list.csv", "file,id\ns[1]/scan_2.csv:theta_i=6,x\n");
  Inputs other = Gather({"list.csv"});
  for (Inputs* inputs : {&one, &other}) SetSettings([](const OptionWords&) { return "s"; }, &inputs->list);
  EXPECT_NE(one.list.tasks[0].settings, other.list.tasks[0].settings);
  StoreWorkList(one.list, folder_ / "out");
  EXPECT_EQ(ReadWorkList(folder_ / "out").tasks[0].members, one.list.tasks[0].members);
  EXPECT_THROW(StoreWorkList(other.list, folder_ / "out"), UsageError);
}

TEST_F(InputsTest, LeavesItsOwnResultsOut) {
  Put("a.csv", kCsv);
  Put("out/documents/copy.csv", kCsv);
  const Inputs inputs = GatherInputs({folder_.string()}, {}, kNames, folder_ / "out", {});
  EXPECT_EQ(inputs.list.tasks.size(), 1U);
}

TEST_F(InputsTest, RefusesEqualIdsAndFilesWithBothPlaces) {
  Put("a/x.csv", kCsv);
  Put("b/x.csv", kCsv);
  EXPECT_THAT(
      [&] {
        Gather({"a", "b"});
      },
      ThrowsMessage<InputError>(
          testing::AllOf(HasSubstr("a/x.csv"), HasSubstr("b/x.csv"), HasSubstr("the id 'x.csv'"))));
  Put("list.csv", "file,id\na/x.csv,one\nb/x.csv,two\na/x.csv,three\n");
  EXPECT_THAT(
      [&] { Gather({"list.csv"}); },
      ThrowsMessage<InputError>(testing::AllOf(HasSubstr("line 4"), HasSubstr("line 2"), HasSubstr("listed already"))));
  // With other options it is another task.
  Put("list.csv", "file,id,recipe\na/x.csv,one,ggx\na/x.csv,three,ellipsoid\n");
  EXPECT_EQ(Gather({"list.csv"}, {{"recipe", "auto"}, {"theta-max", "60"}}).list.tasks[0].options.at("theta-max"),
            "60");
}

TEST_F(InputsTest, RefusesIdsThatAreNoRelativePath) {
  Put("x.csv", kCsv);
  for (const char* id : {"../x", "/x", "a//b", "a/", "a/./b"}) {
    Put("list.csv", std::string("file,id\nx.csv,") + id + "\n");
    EXPECT_THAT([&] { Gather({"list.csv"}); }, ThrowsMessage<InputError>(HasSubstr("is no relative path"))) << id;
  }
  Put("list.csv", "file,id\nx.csv," + std::string(201, 'a') + "\n");
  EXPECT_THAT([&] { Gather({"list.csv"}); }, Throws<InputError>());
}

TEST_F(InputsTest, RefusesAnIdInTheWayOfAnothersResults) {
  Put("x.csv", kCsv);
  Put("y.csv", kCsv);
  Put("list.csv", "file,id\nx.csv,a.material.json/b/c\ny.csv,a\n");
  EXPECT_THAT([&] { Gather({"list.csv"}); },
              ThrowsMessage<InputError>(testing::AllOf(HasSubstr("line 2"), HasSubstr("'a' ("), HasSubstr("line 3"))));
  Put("list.csv", "file,id\nx.csv,a/b\ny.csv,a\n");
  EXPECT_EQ(Gather({"list.csv"}).list.tasks.size(), 2U);
}

TEST_F(InputsTest, RefusesNamesThatAreNotThereAndEmptyFolders) {
  EXPECT_THAT([&] { Gather({"none"}); }, ThrowsMessage<InputError>(HasSubstr("is not there")));
  std::filesystem::create_directories(folder_ / "empty");
  EXPECT_THAT([&] { Gather({"empty"}); }, ThrowsMessage<InputError>(HasSubstr("nothing to fit")));
  Put("empty.csv", "");
  EXPECT_THAT([&] { Gather({"empty.csv"}); }, ThrowsMessage<InputError>(HasSubstr("is empty; a manifest has")));
}

TEST_F(InputsTest, StoredListMayGrowButNotChange) {
  Put("a.csv", kCsv);
  Put("b.csv", kCsv);
  const auto listed = [&](const std::vector<std::string>& names, const std::string& settings) {
    Inputs inputs = Gather(names);
    SetSettings([&](const OptionWords&) { return settings; }, &inputs.list);
    return inputs.list;
  };
  const std::filesystem::path out = folder_ / "out";
  StoreWorkList(listed({"a.csv"}, "s"), out);
  StoreWorkList(listed({"a.csv", "b.csv"}, "s"), out);
  const WorkList stored = ReadWorkList(out);
  ASSERT_EQ(stored.tasks.size(), 2U);
  EXPECT_EQ(stored.tasks[1].path, folder_ / "b.csv");
  EXPECT_THAT([&] { StoreWorkList(listed({"b.csv"}, "s"), out); },
              ThrowsMessage<UsageError>(
                  testing::AllOf(HasSubstr("another list"), HasSubstr("a.csv"), HasSubstr("choose another --out"))));
  EXPECT_THAT(
      [&] {
        StoreWorkList(listed({"a.csv", "b.csv"}, "t"), out);
      },
      ThrowsMessage<UsageError>(HasSubstr("is listed with no options")));
  EXPECT_EQ(ReadWorkList(out).tasks.size(), 2U);
}

TEST_F(InputsTest, StoredListOfAnotherVersionIsRefused) {
  Put("out/worklist.jsonl", "{\"format\":\"lobefit work list\",\"version\":\"0.0.1\",\"extra_columns\":[]}\n");
  EXPECT_THAT([&] { ReadWorkList(folder_ / "out"); }, ThrowsMessage<InputError>(HasSubstr("is of version 0.0.1")));
  Put("out/worklist.jsonl", "no json\n");
  EXPECT_THAT([&] { ReadWorkList(folder_ / "out"); }, ThrowsMessage<InputError>(HasSubstr("line 1: is not a line")));
}

TEST(Shards, PartitionTheWork) {
  for (const std::size_t count : {1U, 3U, 7U}) {
    std::size_t end = 0;
    std::vector<int> held(20, 0);
    for (std::size_t i = 1; i <= count; ++i) {
      const Shard shard = {i, count};
      EXPECT_EQ(shard.Range(20).first, end);
      end = shard.Range(20).second;
      for (std::size_t k = 0; k < held.size(); ++k) held[k] += shard.Holds(k) ? 1 : 0;
    }
    EXPECT_EQ(end, 20U);
    EXPECT_THAT(held, testing::Each(1));
  }
}

TEST(Shards, RefusesWhatIsOutOfRange) {
  EXPECT_EQ(ParseShard("3/8").index, 3U);
  for (const char* text : {"0/8", "9/8", "3", "a/b", "1/0", "-1/2", "1/2/3", "", "1/100001"})
    EXPECT_THAT([text] { ParseShard(text); }, ThrowsMessage<UsageError>(HasSubstr("3/8"))) << text;
}

}  // namespace
}  // namespace lobefit
