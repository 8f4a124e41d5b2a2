// Every panel against a stored picture. An intended change: `cmake --build BUILD --target golden_regenerate`, look at
// the pictures, commit them.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "tests/report/synthetic.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>
#include <png.h>

#include "lobefit/measurement/prepare/exclusion.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/figures/coverage.h"
#include "lobefit/report/panels/page.h"

namespace lobefit {
namespace {

// A golden image holds where, after averaging 2 x 2 pixels, at most this share of them differs by more than kVisible
// levels, and all of them differ by kMean on average. Other versions of FreeType and OpenCV move edges by fractions of
// a pixel; a label that is gone, a curve that moves by two pixels or a colour that changes is beyond both.
constexpr double kMostDifferent = 0.004, kMean = 0.6;
constexpr int kVisible = 40;

cv::Mat ReadPng(const std::filesystem::path& path) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return {};
  image.format = PNG_FORMAT_RGB;
  cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3);
  png_image_finish_read(&image, nullptr, pixels.data, static_cast<png_int_32>(pixels.step), nullptr);
  return pixels;
}

struct Difference {
  double mean = 0, different = 0;
};

Difference Compare(const cv::Mat& a, const cv::Mat& b) {
  Difference difference;
  int count = 0;
  for (int y = 0; y + 1 < a.rows; y += 2) {
    for (int x = 0; x + 1 < a.cols; x += 2) {
      int most = 0;
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
          sum += a.at<cv::Vec3b>(y + dy, x + dx)[c] - b.at<cv::Vec3b>(y + dy, x + dx)[c];
        }
        most = std::max(most, std::abs(sum) / 4);
      }
      difference.mean += most;
      difference.different += most > kVisible ? 1 : 0;
      ++count;
    }
  }
  difference.mean /= count;
  difference.different /= count;
  return difference;
}

struct Case {
  std::string name;
  Material material;
  Measurement measurement;
};

// A material as a fit through an instrument leaves it.
Material SeenThroughAnInstrument() {
  Material material = test::MakeMaterial(1, false);
  InstrumentUsed instrument;
  instrument.detector = DegreesToRadians(4);
  instrument.mean = "flux";
  instrument.drift = {0.03, true};
  for (const double degrees : {10., 30., 50., 70.})
    instrument.gains.push_back({DegreesToRadians(degrees), 0, 1 + 0.05 * std::sin(degrees), 0.01});
  const double tenth = DegreesToRadians(0.1);
  instrument.alignment = {{"e_x", tenth, tenth, 2 * tenth, 0.5}, {"e_y", -tenth, 2 * tenth, 2 * tenth, 0.9}};
  instrument.alignment_correlation = 0.6;
  instrument.azimuths = {0};
  instrument.told_from_tilt = false;
  instrument.offset = {{0.0012, 0.0003}};
  material.instrument = instrument;
  return material;
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  const auto add = [&cases](const std::string& name, std::size_t channels, bool isotropic, const test::Pairs& pairs,
                            bool table) {
    const Material material = test::MakeMaterial(channels, isotropic);
    cases.push_back({name, material, test::Measure(material, pairs, 0.05, table)});
  };
  add("table_rgb", 3, true, test::TablePairs(), true);
  add("goniometer_rgb", 3, false, test::GoniometerPairs(true), false);
  add("in_plane_mono", 1, false, test::GoniometerPairs(false), false);
  const Material seen = SeenThroughAnInstrument();
  cases.push_back({"instrument", seen, test::Measure(seen, test::GoniometerPairs(false), 0.05, false)});
  return cases;
}

TEST(Golden, Panels) {
  const auto fonts = std::make_shared<Fonts>();
  if (!fonts->has_outlines())
    GTEST_SKIP() << "DejaVu fonts are not installed: the stored pictures were drawn with them";
  const bool regenerate = std::getenv("LOBEFIT_REGENERATE_GOLDEN") != nullptr;
  const std::filesystem::path folder = test::SourceDir() / "tests" / "golden";
  int compared = 0;
  for (const Case& c : Cases()) {
    const ReportData data(c.material, c.measurement, 2);
    for (const PanelMaker maker : PanelMakers()) {
      const std::optional<Panel> panel = maker(data);
      if (!panel) continue;
      // What every measurement shows alike is stored once.
      if (c.name != "table_rgb" && (panel->id == "quality" || panel->id == "energy" || panel->id == "correlation"))
        continue;
      if (c.name == "instrument" && panel->id != "instrument" && panel->id != "curves") continue;
      // Wide panels are pictures more than text: half the size keeps the repository small.
      const Canvas canvas = DrawPanelAlone(*panel, panel->wide ? 820 : 420, panel->wide ? 0.5 : 1, fonts);
      const std::filesystem::path path = folder / (c.name + "_" + panel->id + ".png");
      if (regenerate) {
        WritePng(canvas.pixels(), 0, path);
        continue;
      }
      const cv::Mat expected = ReadPng(path);
      ASSERT_FALSE(expected.empty()) << path << " is missing";
      ASSERT_EQ(expected.size(), canvas.pixels().size()) << path;
      const Difference difference = Compare(canvas.pixels(), expected);
      const bool holds = difference.mean <= kMean && difference.different <= kMostDifferent;
      const std::filesystem::path drawn =
          std::filesystem::path(testing::TempDir()) / ("golden_" + path.filename().string());
      if (!holds) WritePng(canvas.pixels(), 0, drawn);
      EXPECT_TRUE(holds) << path << ": mean difference " << difference.mean << " (at most " << kMean
                         << "), share that differs visibly " << difference.different << " (at most " << kMostDifferent
                         << "); drawn: " << drawn;
      ++compared;
    }
  }
  if (!regenerate) {
    EXPECT_GE(compared, 15);
  }
}

// The picture of `lobefit info --png`, with what zones and marks left out.
TEST(Golden, Coverage) {
  if (!Fonts().has_outlines()) GTEST_SKIP() << "DejaVu fonts are not installed: the stored picture was drawn with them";
  Measurement measurement = test::Measure(test::MakeMaterial(1, false), test::GoniometerPairs(true), 0.05, false);
  measurement.source = "coverage.csv";
  measurement.format = "csv";
  for (std::size_t i = 5; i < measurement.samples.size(); i += 97)
    measurement.LeaveOut(measurement.samples.wi(i), measurement.samples.wo(i), LeftOutReason::kNoValue);
  Apply(ParseExclusions("specular:10,retro:12,theta-o>70"), &measurement);
  const std::filesystem::path path = test::SourceDir() / "tests" / "golden" / "coverage.png";
  const TemporaryFile drawn;
  const bool regenerate = std::getenv("LOBEFIT_REGENERATE_GOLDEN") != nullptr;
  WriteCoveragePng(measurement, regenerate ? path : drawn.path(), {.threads = 1, .scale = 1, .font_folders = {}});
  if (regenerate) return;
  const cv::Mat expected = ReadPng(path), found = ReadPng(drawn.path());
  ASSERT_FALSE(expected.empty()) << path << " is missing";
  ASSERT_EQ(expected.size(), found.size());
  const Difference difference = Compare(found, expected);
  EXPECT_LE(difference.mean, kMean);
  EXPECT_LE(difference.different, kMostDifferent);
}

TEST(Golden, TheComparisonSeesAShiftOfTwoPixelsAndALostLabel) {
  const Material material = test::MakeMaterial(3, true);
  const Measurement measurement = test::Measure(material, test::TablePairs(), 0.05, true);
  const ReportData data(material, measurement, 1);
  const auto fonts = std::make_shared<Fonts>();
  const std::optional<Panel> panel = CurvesPanel(data);
  ASSERT_TRUE(panel);
  const Canvas canvas = DrawPanelAlone(*panel, 820, 1, fonts);
  cv::Mat shifted = canvas.pixels().clone();
  canvas.pixels()(cv::Rect(0, 0, shifted.cols - 2, shifted.rows))
      .copyTo(shifted(cv::Rect(2, 0, shifted.cols - 2, shifted.rows)));
  EXPECT_GT(Compare(shifted, canvas.pixels()).different, kMostDifferent);
  EXPECT_EQ(Compare(canvas.pixels(), canvas.pixels()).mean, 0);
}

}  // namespace
}  // namespace lobefit
