#include "tests/support/temporary_file.h"
#include "tests/support/test_brdf.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/write.h"
#include "lobefit/measurement/synthesis.h"

namespace lobefit {
namespace {

Measurement Measure(const TestBrdf& brdf) {
  GoniometerLayout layout;
  for (int theta = 0; theta <= 75; theta += 15) layout.polar_angles.push_back(DegreesToRadians(theta));
  for (int phi = 0; phi < 360; phi += 30) layout.azimuths.push_back(DegreesToRadians(phi));
  layout.detector_step = DegreesToRadians(6);
  const BrdfFunction rgb = [&](const Vec3& wi, const Vec3& wo, double* values) {
    values[0] = brdf(wi, wo);
    values[1] = values[0] / 2;
    values[2] = values[0] / 4;
  };
  Measurement m = Synthesise(Goniometer(layout), {{"R", "G", "B"}, {}}, rgb, {}, 1);
  m.source = "made.csv";
  return m;
}

// From rows of a goniometer to every format that takes them, and back.
TEST(Convert, EveryFormatReportsWhatItLost) {
  TestBrdf brdf;
  brdf.alpha_x = 0.3;
  brdf.alpha_y = 0.4;
  const Measurement m = Measure(brdf);
  const WriteSource source = {&m, nullptr, m.channels, false};
  const std::map<std::string, double> most_median = {
      {"csv", 1e-12}, {"alta", 1e-12}, {"rgl", 0.02}, {"tensor-tree", 0.08}, {"exr", 1e-5}};
  WriteOptions options;
  options.tensor_tree_log2 = 4;
  options.exr_size = 64;
  options.rgl.azimuths = 16;
  options.rgl.polar_angles = 12;
  for (const WriteFormat& format : WriteFormats()) {
    const TemporaryFile file;
    const std::string name = format.name;
    if (name == "merl") {
      EXPECT_THROW(Convert(source, format, options, file.path()), UsageError);
      continue;
    }
    const Conversion conversion = Convert(source, format, options, file.path());
    ASSERT_FALSE(conversion.losses.empty()) << name;
    if (name == "mountain") {
      EXPECT_EQ(conversion.files.size(), 61U);  // the normal once, five polar angles x twelve azimuths
      for (const auto& path : conversion.files) std::filesystem::remove(path);
      continue;
    }
    EXPECT_LT(conversion.difference.median, most_median.at(name)) << name;
    EXPECT_GT(conversion.difference.compared, 1000U) << name;
  }
}

TEST(Convert, FormatsByNameAndByExtension) {
  EXPECT_STREQ(FindWriteFormat(std::nullopt, "a/b.BSDF").name, "rgl");
  EXPECT_STREQ(FindWriteFormat("tensor-tree", "x.y").name, "tensor-tree");
  EXPECT_THROW(FindWriteFormat(std::nullopt, "x.unknown"), UsageError);
  EXPECT_THROW(FindWriteFormat("jpeg", "x.csv"), UsageError);
}

}  // namespace
}  // namespace lobefit
