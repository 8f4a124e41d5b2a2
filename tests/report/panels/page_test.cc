#include "lobefit/report/panels/page.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "tests/report/synthetic.h"
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
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

// All but those of tables of lobes, of profiles and of an instrument.
TEST(Page, AFullTableFillsEveryPanel) {
  const Material material = test::MakeMaterial(3, true);
  EXPECT_EQ(IdsOf(material, test::Measure(material, test::TablePairs(), 0.03, true)).size(), PanelMakers().size() - 3);
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

// One more figure, beside GGX of the same widths.
TEST(Page, AProfileIsDrawn) {
  Material material = test::MakeMaterial(1, false);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(false), 0.03, false);
  EXPECT_THAT(IdsOf(material, measurement), Not(Contains("profile")));
  EXPECT_THAT(IdsOf(material, measurement), Contains("fresnel"));
  FittedParameter gamma;
  gamma.values = gamma.freedom = {3.0};
  gamma.standard_error = gamma.standard_error_clustered = {0.1};
  material.model.lobes[0].ndf = Ndf::kStudentEllipsoid;
  material.parameters.insert(material.parameters.begin() + 5, gamma);
  EXPECT_THAT(IdsOf(material, measurement), Contains("profile"));
}

TEST(Page, OneSampleIsRefused) {
  const Material material = test::MakeMaterial(1, true);
  const Measurement measurement =
      test::Measure(material, {{test::AtDegrees(30, 0), test::AtDegrees(30, 180)}}, 0, false);
  EXPECT_THROW(IdsOf(material, measurement), InputError);
}

TEST(Page, TwoSamplesLeaveTheNumbers) {
  const Material material = test::MakeMaterial(1, true);
  const Measurement measurement = test::Measure(
      material,
      {{test::AtDegrees(30, 0), test::AtDegrees(30, 180)}, {test::AtDegrees(30, 0), test::AtDegrees(35, 180)}}, 0,
      false);
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
  EXPECT_EQ(FileBytes(path).bytes().substr(1, 3), "PNG");
  EXPECT_THROW(WriteReportPng(material, measurement, "/nonexistent/folder/x.png"), OutputError);
}

TEST(WriteReportExr, HoldsTheMapsOrSaysThatThereAreNone) {
  const Material material = test::MakeMaterial(3, true);
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "maps.report.exr";
  WriteReportExr(material, test::Measure(material, test::TablePairs(), 0.02, true), path);
  Imf::MultiPartInputFile file(path.c_str());
  ASSERT_GE(file.parts(), 3);
  bool found_slices = false;
  for (int k = 0; k < file.parts(); ++k) {
    const Imf::Header& header = file.header(k);
    found_slices |= header.name() == "half_difference.phi_d_90";
    const Imath::Box2i window = header.dataWindow();
    const int width = window.max.x + 1, height = window.max.y + 1;
    std::vector<float> measured(static_cast<std::size_t>(width * height)), fitted = measured, ratio = measured;
    Imf::FrameBuffer buffer;
    for (auto& [name, values] : {std::pair{"measured", &measured}, {"fitted", &fitted}, {"log_ratio", &ratio}}) {
      buffer.insert(name, Imf::Slice(Imf::FLOAT, static_cast<char*>(static_cast<void*>(values->data())), sizeof(float),
                                     sizeof(float) * static_cast<std::size_t>(width)));
    }
    Imf::InputPart part(file, k);
    part.setFrameBuffer(buffer);
    part.readPixels(0, height - 1);
    int known = 0, close = 0;
    for (std::size_t i = 0; i < measured.size(); ++i) {
      if (std::isnan(measured[i]) || std::isnan(fitted[i])) continue;
      ++known;
      close += std::fabs(ratio[i]) < 0.1F ? 1 : 0;
    }
    EXPECT_GT(known, width * height / 4) << header.name();
    EXPECT_GT(close, known * 9 / 10) << header.name();
  }
  EXPECT_TRUE(found_slices);
  const Material mono = test::MakeMaterial(1, true);
  EXPECT_THROW(WriteReportExr(mono, test::Measure(mono, test::GoniometerPairs(false), 0, false), path), OutputError);
}

TEST(ModelWords, NameCoatsAndBackDirections) {
  Model model = {{{Ndf::kGgx}, {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered}}, Diffuse::kLambert};
  EXPECT_THAT(ModelWords(model), testing::HasSubstr("coat over the others, isotropic GGX"));
  model.lobes[1] = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kNone, "", LobeDirection::kRetro};
  EXPECT_THAT(ModelWords(model), testing::HasSubstr("+  about the back direction, isotropic GGX"));
}

}  // namespace
}  // namespace lobefit
