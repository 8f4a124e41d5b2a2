#include "lobefit/report/page.h"

#include <algorithm>
#include <filesystem>
#include <limits>

#include "tests/report/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/report/report.h"

namespace lobefit {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> IdsOf(const Material& material, const Measurement& measurement) {
  std::vector<std::string> ids;
  const ReportData data(material, measurement, 2);
  DrawPage(data, 1, std::make_shared<Fonts>(), &ids);
  return ids;
}

TEST(Page, AFullTableFillsEveryPanel) {
  const Material material = test::MakeMaterial(3, true);
  EXPECT_EQ(IdsOf(material, test::Measure(material, test::TablePairs(), 0.03, true)).size(), PanelMakers().size());
}

TEST(Page, AnInPlaneMeasurementHasNoMaps) {
  const Material material = test::MakeMaterial(1, false);
  const std::vector<std::string> ids =
      IdsOf(material, test::Measure(material, test::GoniometerPairs(false), 0.03, false));
  for (const char* absent : {"maps", "burley"}) EXPECT_THAT(ids, Not(Contains(absent)));
  for (const char* present : {"curves", "parameters", "quality", "ndf", "residuals", "energy", "correlation"})
    EXPECT_THAT(ids, Contains(present));
}

TEST(Page, AnAnisotropicMeasurementHasMapsButNoIsotropicPictures) {
  const Material material = test::MakeMaterial(3, false);
  const std::vector<std::string> ids =
      IdsOf(material, test::Measure(material, test::GoniometerPairs(true), 0.03, false));
  EXPECT_THAT(ids, Contains("maps"));
  EXPECT_THAT(ids, Not(Contains("burley")));
}

TEST(Page, OneSampleLeavesTheNumbers) {
  const Material material = test::MakeMaterial(1, true);
  const Measurement measurement =
      test::Measure(material, {{test::AtDegrees(30, 0), test::AtDegrees(30, 180)}}, 0, false);
  const std::vector<std::string> ids = IdsOf(material, measurement);
  EXPECT_THAT(ids, Not(Contains("curves")));
  EXPECT_THAT(ids, Not(Contains("residuals")));
  EXPECT_THAT(ids, Contains("parameters"));
}

TEST(Page, WithoutCovarianceThereIsNoMatrix) {
  Material material = test::MakeMaterial(1, true);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0, false);
  std::fill(material.covariance.begin(), material.covariance.end(), std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(IdsOf(material, measurement), Not(Contains("correlation")));
  material.covariance.clear();
  EXPECT_THAT(IdsOf(material, measurement), Not(Contains("correlation")));
}

TEST(Page, DrawsValuesThatNoLogarithmTakes) {
  const Material material = test::MakeMaterial(3, true);
  Measurement measurement = test::Measure(material, test::TablePairs(), 0.03, true);
  for (std::size_t i = 0; i < measurement.samples.size(); i += 3)
    measurement.samples.values[i % 3][i] = i % 2 == 0 ? 0 : -0.1;
  EXPECT_THAT(IdsOf(material, measurement), Contains("curves"));
  for (auto& channel : measurement.samples.values) std::fill(channel.begin(), channel.end(), -1.0);
  EXPECT_THAT(IdsOf(material, measurement), Contains("parameters"));
}

TEST(Page, SpectralAndTwoLobesAndWarnings) {
  Material material = test::MakeMaterial(31, false);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(true), 0.03, false);
  material.model.lobes.push_back({Ndf::kGgx, Masking::kSmithHeight, Fresnel::kNone});
  const std::vector<FittedParameter> lobe(material.parameters.begin(), material.parameters.begin() + 6);
  material.parameters.insert(material.parameters.begin() + 6, lobe.begin(), lobe.end());
  material.degenerate = {"alpha_x and scale of the second lobe cannot be told apart"};
  material.termination = {false, false, "no progress", 3};
  EXPECT_THAT(IdsOf(material, measurement), Contains("parameters"));
}

TEST(Page, IsTheSameWithOneAndManyThreads) {
  const Material material = test::MakeMaterial(3, true);
  const Measurement measurement = test::Measure(material, test::TablePairs(), 0.03, true);
  const auto fonts = std::make_shared<Fonts>();
  const Canvas one = DrawPage(ReportData(material, measurement, 1), 1, fonts),
               many = DrawPage(ReportData(material, measurement, 5), 1, fonts);
  EXPECT_EQ(cv::norm(one.pixels(), many.pixels(), cv::NORM_INF), 0);
}

TEST(WriteReportPng, RefusesWhatDoesNotBelongTogether) {
  const Material material = test::MakeMaterial(3, true);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "refused.report.png";
  Measurement measurement = test::Measure(test::MakeMaterial(1, true), test::GoniometerPairs(false), 0, false);
  try {
    WriteReportPng(material, measurement, path);
    FAIL() << "other channels were accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("channels"));
  }
  measurement.samples.Resize(0);
  EXPECT_THROW(WriteReportPng(test::MakeMaterial(1, true), measurement, path), InputError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(WriteReportPng, WritesAPngOrNothing) {
  const Material material = test::MakeMaterial(1, true);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0.02, false);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "one.report.png";
  WriteReportPng(material, measurement, path, {.threads = 2, .scale = 1, .font_folders = {}});
  EXPECT_EQ(MappedFile(path).bytes().substr(1, 3), "PNG");
  EXPECT_THROW(WriteReportPng(material, measurement, "/nonexistent/folder/x.png"), OutputError);
}

}  // namespace
}  // namespace lobefit
