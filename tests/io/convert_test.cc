#include <algorithm>
#include <cmath>

#include "tests/support/temporary_file.h"
#include "tests/support/test_brdf.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/read.h"
#include "lobefit/io/write.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/interpolation.h"
#include "lobefit/synthesis/synthesis.h"

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

// From one azimuth of the light a table of all azimuths would be extrapolated all round: refused, unless the sample is
// isotropic by its owner's word.
TEST(Convert, TablesOfAllAzimuthsFromOneAreRefusedOrIsotropic) {
  TestBrdf brdf;
  brdf.alpha_x = brdf.alpha_y = 0.4;
  brdf.tilt = brdf.rotation = 0;
  GoniometerLayout layout;
  for (int theta = 0; theta <= 75; theta += 15) layout.polar_angles.push_back(DegreesToRadians(theta));
  layout.azimuths = {0.5};
  layout.detector_step = DegreesToRadians(6);
  const BrdfFunction grey = [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = brdf(wi, wo); };
  Measurement m = Synthesise(Goniometer(layout), {{"Y"}, {}}, grey, {}, 1);
  WriteOptions options;
  options.tensor_tree_log2 = 4;
  for (const char* name : {"rgl", "tensor-tree"}) {
    const TemporaryFile file;
    m.isotropic = false;
    try {
      Convert({&m, nullptr, m.channels, false}, FindWriteFormat(name, "x"), options, file.path());
      FAIL() << name;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find("--isotropic"), std::string::npos);
    }
    EXPECT_FALSE(std::filesystem::exists(file.path()));
    m.isotropic = true;
    Convert({&m, nullptr, m.channels, true}, FindWriteFormat(name, "x"), options, file.path());
    // At an azimuth where nothing was measured.
    const Measurement back = ReadMeasurement(file.path());
    const BrdfFunction table = Interpolate(back);
    double value[3] = {};
    const Vec3 wi = FromSpherical(0.5, 2.5), wo = FromSpherical(0.4, 5.2);
    table(wi, wo, value);
    EXPECT_NEAR(value[0] / brdf(wi, wo), 1, 0.1) << name;
  }
}

// One azimuth of the light does for an isotropic surface, if the viewers leave the plane.
TEST(Convert, MerlTableFromOneAzimuth) {
  TestBrdf brdf;
  brdf.alpha_x = brdf.alpha_y = 0.4;
  brdf.tilt = brdf.rotation = 0;
  GoniometerLayout layout;
  for (int theta = 0; theta <= 75; theta += 15) layout.polar_angles.push_back(DegreesToRadians(theta));
  layout.azimuths = {0.5};
  layout.detector_step = DegreesToRadians(6);
  const BrdfFunction grey = [&](const Vec3& wi, const Vec3& wo, double* values) { values[0] = brdf(wi, wo); };
  Measurement m = Synthesise(Goniometer(layout), {{"Y"}, {}}, grey, {}, 1);
  const TemporaryFile file;
  const WriteFormat& merl = FindWriteFormat("merl", "x");
  const Conversion conversion = Convert({&m, nullptr, m.channels, false}, merl, {}, file.path());
  EXPECT_EQ(std::filesystem::file_size(file.path()), 34992012U);
  const Measurement table = ReadMeasurement(file.path());
  std::vector<double> errors;
  for (std::size_t i = 0; i < table.samples.size(); i += 97) {
    const Vec3 wi = table.samples.wi(i), wo = table.samples.wo(i);
    if (wi.z > 0.3 && wo.z > 0.3) errors.push_back(std::fabs(table.samples.values[0][i] / brdf(wi, wo) - 1));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.03);

  std::vector<std::uint8_t> in_plane(m.samples.size());
  for (std::size_t i = 0; i < m.samples.size(); ++i)
    in_plane[i] = std::fabs(m.samples.wo_y[i] * std::cos(0.5) - m.samples.wo_x[i] * std::sin(0.5)) < 1e-3 ? 1 : 0;
  m.samples.Keep(in_plane);
  try {
    Convert({&m, nullptr, m.channels, false}, merl, {}, file.path());
    FAIL() << "a table from one plane";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("lies within 10 degrees of a sample; by theta_d"), std::string::npos)
        << error.what();
  }
}

TEST(Convert, FormatsByNameAndByExtension) {
  EXPECT_STREQ(FindWriteFormat(std::nullopt, "a/b.BSDF").name, "rgl");
  EXPECT_STREQ(FindWriteFormat("tensor-tree", "x.y").name, "tensor-tree");
  EXPECT_THROW(FindWriteFormat(std::nullopt, "x.unknown"), UsageError);
  EXPECT_THROW(FindWriteFormat("jpeg", "x.csv"), UsageError);
}

// A file of a laboratory and what each target keeps of it beside the values.
TEST(Convert, CarriesCommentsAndUncertaintiesOrSaysNot) {
  const TemporaryFile file(
      "Operator: N.N.\n# Sample: A1, polished\n# detector: 1.5\n# Polarization: s\n"
      "theta_i,phi_i,theta_o,phi_o,R,G,B,sigma,Time\n30,0,45,180,1,2,3,0.1,12:00\n30,0,20,0,4,5,6,0.2,12:01\n"
      "# lamp was replaced\n30,0,20,180,4,5,6,0.4,12:02\n");
  const Measurement m = ReadMeasurement(file.path());
  const std::vector<std::string> comments = {"Sample: A1, polished", "Polarization: s", "Operator: N.N.",
                                             "lamp was replaced"};
  EXPECT_EQ(m.comments, comments);
  const WriteSource source = {&m, nullptr, m.channels, false};
  const auto says = [](const Conversion& conversion, std::string_view part) {
    return std::any_of(conversion.losses.begin(), conversion.losses.end(),
                       [&](const std::string& loss) { return loss.find(part) != std::string::npos; });
  };
  for (const char* name : {"csv", "alta"}) {
    const TemporaryFile written;
    const Conversion conversion = Convert(source, FindWriteFormat(name, written.path()), {}, written.path());
    const Measurement back = ReadMeasurement(written.path());
    EXPECT_EQ(back.comments, comments) << name;
    ASSERT_EQ(back.samples.sigma.size(), 3U) << name;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back.samples.sigma[i], m.samples.sigma[i], 1e-15) << name;
    EXPECT_FALSE(says(conversion, "comment lines")) << name;
    EXPECT_FALSE(says(conversion, "standard deviations")) << name;
    EXPECT_TRUE(says(conversion, "columns are not written: Time")) << name;
    EXPECT_EQ(says(conversion, "of the instrument"), std::string_view(name) == "alta");
    EXPECT_NEAR(back.instrument.detector.value_or(0), std::string_view(name) == "csv" ? DegreesToRadians(1.5) : 0,
                1e-15);
  }
  const TemporaryFile image;
  const Conversion exr = Convert(source, FindWriteFormat("exr", image.path()), {}, image.path());
  EXPECT_TRUE(says(exr, "4 comment lines of the file are not written"));
  // All in the plane of incidence, and the slice across it.
  EXPECT_TRUE(says(exr, "0 of 3 samples lie within 2 degrees of what the image holds"));
  EXPECT_TRUE(says(exr, "the standard deviations of the samples are not written"));
  const TemporaryFile mountain;
  const Conversion text = Convert(source, FindWriteFormat("mountain", mountain.path()), {}, mountain.path());
  EXPECT_TRUE(says(text, "the standard deviations of the samples are not written"));
  EXPECT_EQ(ReadMeasurement(mountain.path()).comments.size(), comments.size() + 1) << "with the sample's name";
}

// Weights are confidence intervals of ALTA, in ratio.
TEST(Convert, WeightsGoToAltaAndBack) {
  const TemporaryFile file("theta_i,phi_i,theta_o,phi_o,f,weight\n30,0,45,180,1,2\n30,0,20,0,4,1\n");
  const Measurement m = ReadMeasurement(file.path());
  const TemporaryFile written;
  Convert({&m, nullptr, m.channels, false}, FindWriteFormat("alta", written.path()), {}, written.path());
  const Measurement back = ReadMeasurement(written.path());
  ASSERT_EQ(back.samples.weight.size(), 2U);
  EXPECT_NEAR(back.samples.weight[0] / back.samples.weight[1], 2, 1e-12);
}

// A comment of one format that is a key of another must not act in it.
TEST(Convert, CommentsDoNotBecomeKeys) {
  const TemporaryFile alta(
      "#ALTA HEADER BEGIN\n# exclude: value<100\n# value-scale: %\n# made by N.N.\n#DIM 4 1\n#PARAM_IN "
      "SPHERICAL_TL_PL_TV_PV\n#PARAM_OUT INV_STERADIAN\n#ALTA HEADER END\n0.5 0 0.7 3.1 2\n");
  const Measurement m = ReadMeasurement(alta.path());
  EXPECT_EQ(m.comments, (std::vector<std::string>{"exclude: value<100", "value-scale: %", "made by N.N."}));
  const TemporaryFile csv;
  Convert({&m, nullptr, m.channels, false}, FindWriteFormat("csv", csv.path()), {}, csv.path());
  const Measurement back = ReadMeasurement(csv.path());
  ASSERT_EQ(back.samples.size(), 1U);
  EXPECT_EQ(back.samples.values[0][0], 2);
  EXPECT_EQ(back.comments, m.comments);
}

}  // namespace
}  // namespace lobefit
