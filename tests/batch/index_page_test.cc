#include "lobefit/batch/index/index_page.h"

#include <cmath>

#include "tests/support/browser_page.h"
#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/batch/results/result_row.h"

namespace lobefit {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::UnorderedElementsAre;

nlohmann::json DataOf(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

// What a percent-encoded link names.
std::string Decoded(const std::string& link) {
  std::string name;
  for (std::size_t i = 0; i < link.size(); ++i) {
    const bool escaped = link[i] == '%' && i + 2 < link.size();
    name += escaped ? static_cast<char>(std::stoi(link.substr(i + 1, 2), nullptr, 16)) : link[i];
    i += escaped ? 2 : 0;
  }
  return name;
}

class IndexPageTest : public ProgramTest {
 protected:
  static constexpr const char* kRow =
      R"({"verdict":null,"alpha_x":0.12345678,"alpha_x.stderr":0.001,"alpha_x.stderr_clustered":0.002,"alpha_x.clustered_freedom":10})";
  // `count` fitted tasks and a failed one with a hostile name and message.
  void Fill(std::size_t count) {
    list_.extra_columns = {"<b>lab"};
    for (std::size_t i = 0; i < count; ++i) Add("m" + std::to_string(i), TaskStatus::kFitted);
    Add("</script><img src=x onerror=alert(1)>", TaskStatus::kFailed);
    records_.segments.resize(1);
  }
  void Add(const std::string& id, TaskStatus status, const std::string& row = kRow) {
    list_.tasks.push_back({id, id, id, 1, {}, "s", {"<i>"}, ""});
    DoneRecord done;
    done.id = id;
    done.settings = "s";
    done.status = status;
    done.message = status == TaskStatus::kFailed ? "</script><script>alert(2)</script>" : "";
    done.document_bytes = status == TaskStatus::kFailed ? 0 : 1;
    if (status != TaskStatus::kFailed) done.row = row;
    records_.done.push_back(done);
  }
  std::string Page(const IndexOptions& options) const {
    return IndexPage(MakeTable(list_, records_, 1), folder_, options);
  }
  WorkList list_;
  Records records_;
};

TEST_F(IndexPageTest, HoldsRowsIntervalsAndPictures) {
  Fill(2);
  records_.done[1].picture = "cGljdHVyZQ==";
  records_.done[1].picture_is_measured = true;
  const nlohmann::json data = DataOf(Page({"batch"}));
  EXPECT_EQ(data["totals"]["fitted"], 2);
  EXPECT_EQ(data["totals"]["failed"], 1);
  ASSERT_EQ(data["rows"].size(), 3U);
  std::size_t alpha = 0;
  while (data["columns"][alpha]["name"] != "alpha_x") ++alpha;
  EXPECT_EQ(data["rows"][1][alpha], 0.123457);
  // The quantile of Student's t with 10 degrees of freedom is 2.228139.
  EXPECT_EQ(data["errors"][std::to_string(alpha)][1], 0.00445628);
  EXPECT_EQ(data["pictures"][1], nullptr);
  // No row has a verdict.
  for (const auto& column : data["columns"]) EXPECT_NE(column["name"], "verdict");
  EXPECT_EQ(data["pictures"][2]["measured"], true);
}

// A reflectance that one material of many has would leave the picture of two columns empty.
TEST_F(IndexPageTest, DrawsWhatMostRowsHave) {
  const auto row = [](const std::string& more) {
    return R"({"verdict":"close","typical_error":3,"alpha_x":0.2,"alpha_x.stderr":0.001)" + more + "}";
  };
  const std::string with_f0 = R"(,"f0[Y]":0.5,"f0[Y].stderr":0.01)";
  Add("a", TaskStatus::kFitted, row(with_f0));
  for (const char* id : {"b", "c"}) Add(id, TaskStatus::kFitted, row(""));
  records_.segments.resize(1);
  EXPECT_EQ(DataOf(Page({}))["scatter_y"], "typical_error");
  Add("d", TaskStatus::kFitted, row(with_f0));
  EXPECT_EQ(DataOf(Page({}))["scatter_y"], "f0[Y]");
}

TEST_F(IndexPageTest, TextOfStrangersIsNoMarkup) {
  Fill(1);
  const std::string page = Page({"<title>"});
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<title><title>")));
  // Only the page's own script runs.
  EXPECT_THAT(page, HasSubstr("script-src 'sha256-"));
  EXPECT_EQ(DataOf(page)["rows"][0][0], "</script><img src=x onerror=alert(1)>");
}

TEST_F(IndexPageTest, NamesStayTextWhateverTheyLookLike) {
  list_.extra_columns = {"lab"};
  records_.segments.resize(1);
  for (const char* id : {"10", "1e5", "inf", "nan"}) Add(id, TaskStatus::kFitted, R"({"alpha_x":0.5})");
  for (Task& task : list_.tasks) task.extra = {"nan"};
  const nlohmann::json data = DataOf(Page({"batch"}));
  std::size_t lab = 0;
  while (data["columns"][lab]["name"] != "lab") ++lab;
  EXPECT_EQ(data["columns"][0]["text"], true);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(data["rows"][i][0], list_.tasks[i].id);
    EXPECT_EQ(data["rows"][i][lab], "nan");
  }
}

TEST_F(IndexPageTest, SortsFiltersAndDrawsInABrowser) {
  list_.extra_columns = {"kind"};
  records_.segments.resize(1);
  struct Made {
    std::string id, kind;
    double alpha, f0, alpha_error, f0_error;
  };
  const std::vector<Made> made = {{"9", "wide", 0.3, 0.04, 0.01, 0.002},
                                  {"10", "narrow", 0.1, 0.5, 0.02, 0},
                                  {"nan", "narrow", 0.2, 0.9, 0, 0},
                                  {"a b/\xC3\xBC#?&<i>.csv", "wide", 0.9, 0.05, 0.02, 0.001},
                                  {"zero", "narrow", 0, 0.3, 0, 0}};
  for (const Made& m : made) {
    nlohmann::json row = {
        {"recipe", "ggx"}, {"alpha_x", m.alpha}, {"f0", m.f0}, {"alpha_x.stderr", nullptr}, {"f0.stderr", nullptr}};
    if (m.alpha_error > 0) row["alpha_x.stderr"] = m.alpha_error;
    if (m.f0_error > 0) row["f0.stderr"] = m.f0_error;
    Add(m.id, TaskStatus::kFitted, row.dump());
    list_.tasks.back().extra = {m.kind};
    records_.done.back().picture = "cGljdHVyZQ==";
    const std::filesystem::path document = ResultPath(folder_, m.id, ".material.json");
    std::filesystem::create_directories(document.parent_path());
    WriteWholeFile(document, "{}");
  }
  Add("</script><img src=x onerror=alert(1)>", TaskStatus::kFailed);
  WriteWholeFile(ResultPath(folder_, made[0].id, ".report.html"), "<p>");
  const std::string script = std::string(FileBytes(test::SourceDir() / "tests/batch/index_selftest.js").bytes());
  const std::string text = test::VisitPage(Page({"batch & <more>"}), script, folder_ / "index");
  if (text.empty()) GTEST_SKIP() << "Chromium is not installed";
  const nlohmann::json result = nlohmann::json::parse(text, nullptr, false);
  ASSERT_TRUE(result.is_object()) << text;
  EXPECT_THAT(result["errors"], SizeIs(0)) << text;
  EXPECT_THAT(result["violations"], SizeIs(0)) << text;
  EXPECT_EQ(result["requests"], 0);
  EXPECT_EQ(result["unnamed"], 0);
  EXPECT_EQ(result["page"], "batch & <more>");

  using Names = std::vector<std::string>;
  const Names at_first = result["atFirst"];
  EXPECT_THAT(at_first, SizeIs(6));
  EXPECT_LT(std::find(at_first.begin(), at_first.end(), "9"), std::find(at_first.begin(), at_first.end(), "10"));
  const std::string odd = made[3].id, failed = "</script><img src=x onerror=alert(1)>";
  EXPECT_EQ(result["byAlpha"].get<Names>(), (Names{"zero", "10", "nan", "9", odd, failed}));
  EXPECT_EQ(result["byAlphaDown"].get<Names>(), (Names{odd, "9", "nan", "10", "zero", failed}));
  EXPECT_EQ(result["sortIs"], "alpha_x");
  EXPECT_EQ(result["ascends"], "ascending");
  EXPECT_EQ(result["descends"], "descending");
  EXPECT_EQ(result["focusStays"], true);
  std::size_t reports = 0;
  for (const std::string link : result["links"]) {
    EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / Decoded(link))) << link;
    reports += link.ends_with(".report.html") ? 1 : 0;
  }
  EXPECT_THAT(result["links"], SizeIs(5 + 5 + 1));
  EXPECT_EQ(reports, 2U);  // of gallery and table

  // Dots and bars stand where the numbers are, on one scale.
  const Names order = result["galleryAtFirst"];
  ASSERT_THAT(order, SizeIs(5));
  std::vector<Made> drawn;
  for (const std::string& id : order)
    drawn.push_back(*std::find_if(made.begin(), made.end(), [&](const Made& m) { return m.id == id; }));
  using Places = std::vector<std::vector<double>>;
  const Places dots = result["dots"], bars = result["bars"], logs = result["logDots"];
  ASSERT_EQ(dots.size(), 5U);
  const double x_scale = (dots[1][0] - dots[0][0]) / (drawn[1].alpha - drawn[0].alpha),
               y_scale = (dots[1][1] - dots[0][1]) / (drawn[1].f0 - drawn[0].f0);
  EXPECT_GT(x_scale, 100);
  EXPECT_LT(y_scale, -100);
  constexpr double kNormal = 1.959964;
  std::size_t bar = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(dots[i][0], dots[0][0] + x_scale * (drawn[i].alpha - drawn[0].alpha), 1e-6);
    EXPECT_NEAR(dots[i][1], dots[0][1] + y_scale * (drawn[i].f0 - drawn[0].f0), 1e-6);
    if (drawn[i].alpha_error > 0) {
      ASSERT_LT(bar, bars.size());
      EXPECT_NEAR(bars[bar][1] - bars[bar][0], 2 * kNormal * drawn[i].alpha_error * x_scale, 1e-2);
      EXPECT_NEAR(bars[bar][0] + bars[bar][1], 2 * dots[i][0], 1e-6);
      EXPECT_EQ(bars[bar++][2], dots[i][1]);
    }
    if (drawn[i].f0_error > 0) {
      ASSERT_LT(bar, bars.size());
      EXPECT_NEAR(bars[bar][3] - bars[bar][2], 2 * kNormal * drawn[i].f0_error * y_scale, 1e-2);
      EXPECT_EQ(bars[bar++][0], dots[i][0]);
    }
  }
  EXPECT_EQ(bar, bars.size());
  // "zero" has no place on a scale of logarithms.
  std::erase_if(drawn, [](const Made& m) { return m.alpha == 0; });
  ASSERT_EQ(logs.size(), 4U);
  const double log_scale = (logs[1][0] - logs[0][0]) / std::log(drawn[1].alpha / drawn[0].alpha);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(logs[i][0], logs[0][0] + log_scale * std::log(drawn[i].alpha / drawn[0].alpha), 1e-6);
  EXPECT_THAT(result["chosen"], ElementsAre(order[1]));
  EXPECT_THAT(result["title"].get<std::string>(), testing::StartsWith(order[1] + ": "));

  EXPECT_THAT(result["filtered"].get<Names>(), UnorderedElementsAre("9", odd));
  EXPECT_EQ(result["count"], "2 of 6");
  EXPECT_EQ(result["dotsFiltered"], 2);
  EXPECT_EQ(result["galleryFiltered"], 2);
  EXPECT_EQ(result["none"], 0);
  EXPECT_EQ(result["again"], 6);
}

TEST_F(IndexPageTest, LongBatchesKeepTheirFailures) {
  Fill(50);
  const nlohmann::json data = DataOf(Page({"batch", 10, 5}));
  EXPECT_EQ(data["rows"].size(), 10U);
  EXPECT_EQ(data["rows"][0][0], "</script><img src=x onerror=alert(1)>");
  EXPECT_EQ(data["totals"]["fitted"], 50);
}

}  // namespace
}  // namespace lobefit
