#include "lobefit/batch/index/index_page.h"

#include "tests/support/run_program.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/batch/results/result_row.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::Not;

nlohmann::json DataOf(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
}

class IndexPageTest : public ProgramTest {
 protected:
  // `count` fitted tasks and a failed one with a hostile name and message.
  void Fill(std::size_t count) {
    list_.extra_columns = {"<b>lab"};
    for (std::size_t i = 0; i < count; ++i) Add("m" + std::to_string(i), TaskStatus::kFitted);
    Add("</script><img src=x onerror=alert(1)>", TaskStatus::kFailed);
    records_.segments.resize(1);
  }
  void Add(const std::string& id, TaskStatus status) {
    list_.tasks.push_back({id, id, id, 1, {}, "s", {"<i>"}, ""});
    DoneRecord done;
    done.id = id;
    done.settings = "s";
    done.status = status;
    done.message = status == TaskStatus::kFailed ? "</script><script>alert(2)</script>" : "";
    done.document_bytes = status == TaskStatus::kFailed ? 0 : 1;
    if (status != TaskStatus::kFailed)
      done.row =
          R"({"verdict":null,"alpha_x":0.12345678,"alpha_x.stderr":0.001,"alpha_x.stderr_clustered":0.002,"alpha_x.clustered_freedom":10})";
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

TEST_F(IndexPageTest, LongBatchesKeepTheirFailures) {
  Fill(50);
  const nlohmann::json data = DataOf(Page({"batch", 10, 5}));
  EXPECT_EQ(data["rows"].size(), 10U);
  EXPECT_EQ(data["rows"][0][0], "</script><img src=x onerror=alert(1)>");
  EXPECT_EQ(data["totals"]["fitted"], 50);
}

}  // namespace
}  // namespace lobefit
