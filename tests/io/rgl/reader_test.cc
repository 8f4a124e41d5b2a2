#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/io/rgb_material.h"
#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/io/read.h"
#include "lobefit/io/rgl/angles.h"
#include "lobefit/io/rgl/brdf.h"
#include "lobefit/io/rgl/writer.h"
#include "lobefit/io/write.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

TEST(RglAngles, PublishedPoints) {
  EXPECT_NEAR(RglX(0.3), 0.437019, 5e-7);
  EXPECT_NEAR(RglY(1.0), 0.659155, 5e-7);
  EXPECT_NEAR(RglTheta(RglX(0.7)), 0.7, 1e-15);
  EXPECT_NEAR(RglPhi(RglY(-2.0)), -2.0, 1e-15);
}

// Lights about the mirror direction of viewers near the horizon, as a renderer evaluates them.
TEST(RglWriter, LobesUnderGrazingViewers) {
  for (const double alpha : {0.009, 0.05, 0.4}) {
    TestBrdf brdf;
    brdf.tilt = brdf.rotation = 0;
    brdf.alpha_x = brdf.alpha_y = alpha;
    const TemporaryFile file;
    RglWriteOptions options;
    options.isotropic = true;
    const BrdfFunction rgb = [&](const Vec3& wi, const Vec3& wo, double* values) {
      values[0] = values[1] = values[2] = brdf(wi, wo);
    };
    WriteRgl(rgb, {{"R", "G", "B"}, {}}, options, file.path());
    const FileBytes bytes(file.path());
    const RglBrdf written(file.path(), bytes.bytes());
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const double degrees : {75., 83., 86., 87., 88.}) {
      const Vec3 wo = FromSpherical(DegreesToRadians(degrees), 0);
      std::vector<double> errors;
      while (errors.size() < 4000) {
        // Half vectors that hold 90 % of the lobe's normals.
        const double u = 0.9 * uniform(random), slope = alpha * std::sqrt(u / (1 - u));
        const Vec3 wi = Reflect(wo, FromSpherical(std::atan(slope), 2 * kPi * uniform(random)));
        if (wi.z < std::cos(DegreesToRadians(88))) continue;
        double values[3];
        written.Evaluate(wi, wo, values);
        errors.push_back(std::fabs(values[0] / brdf(wi, wo) - 1));
      }
      std::sort(errors.begin(), errors.end());
      EXPECT_LT(errors[errors.size() / 2], 0.02) << alpha << ' ' << degrees;
      EXPECT_LT(errors[errors.size() * 9 / 10], 0.03) << alpha << ' ' << degrees;
      EXPECT_LT(errors[errors.size() * 99 / 100], 0.15) << alpha << ' ' << degrees;
    }
  }
}

// The lights about a viewer at the normal tell what an isotropic format leaves out.
TEST(RglReader, SaysThatAnIsotropicFileHoldsAnAnisotropicSample) {
  for (const double along : {1.0, 2.0}) {
    TestBrdf brdf;
    brdf.tilt = brdf.rotation = 0;
    brdf.alpha_x = 0.15;
    brdf.alpha_y = along * brdf.alpha_x;
    RglWriteOptions options;
    options.isotropic = true;
    options.polar_angles = 8;
    const TemporaryFile file;
    const BrdfFunction rgb = [&](const Vec3& wi, const Vec3& wo, double* values) {
      values[0] = values[1] = values[2] = brdf(wi, wo);
    };
    WriteRgl(rgb, {{"R", "G", "B"}, {}}, options, file.path());
    const Measurement m = ReadMeasurement(file.path());
    const bool said = std::any_of(m.remarks.begin(), m.remarks.end(), [](const std::string& remark) {
      return remark.find("the sample is anisotropic") != std::string::npos &&
             remark.find("most about azimuth 90 degrees") != std::string::npos;
    });
    EXPECT_EQ(said, along > 1) << along;
  }
}

struct Errors {
  double median, percentile_90;
};

// Relative errors of the file as a renderer evaluates it, at random pairs of directions within 75 and 80 degrees; the
// viewers' azimuths between two angles.
Errors ErrorsOf(const RglBrdf& file, const TestBrdf& brdf, double low = 0, double high = 2 * kPi) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto direction = [&](double limit, double from, double to) {
    const double z = 1 - uniform(random) * (1 - std::cos(limit));
    return FromSpherical(std::acos(z), from + (to - from) * uniform(random));
  };
  std::vector<double> errors;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 wo = direction(DegreesToRadians(75), low, high), wi = direction(DegreesToRadians(80), 0, 2 * kPi);
    double values[3];
    file.Evaluate(wi, wo, values);
    errors.push_back(std::fabs(values[0] / brdf(wi, wo) - 1));
    EXPECT_NEAR(values[2] / values[0], 0.25, 1e-5);
  }
  std::sort(errors.begin(), errors.end());
  return {errors[errors.size() / 2], errors[errors.size() * 9 / 10]};
}

TEST(Rgl, ATiltedMaterialComesBackAsARendererSeesIt) {
  const TestBrdf brdf;
  const TemporaryFile file;
  WriteRgl(Rgb(brdf), kThreeChannels, {}, file.path());
  const FileBytes mapped(file.path());
  const Errors errors = ErrorsOf(RglBrdf(file.path(), mapped.bytes()), brdf);
  RecordProperty("median", std::to_string(errors.median));
  RecordProperty("percentile_90", std::to_string(errors.percentile_90));
  EXPECT_LT(errors.median, 0.006);
  EXPECT_LT(errors.percentile_90, 0.025);
}

// On the nodes that the file lists there is no interpolation: only the rounding of float32 angles and values.
TEST(Rgl, SamplesStandOnTheirNodes) {
  const TestBrdf brdf;
  const TemporaryFile file;
  RglWriteOptions options;
  options.azimuths = 8;
  options.polar_angles = 6;
  options.density_size = 32;
  options.table_size = 16;
  WriteRgl(Rgb(brdf), kThreeChannels, options, file.path());
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_EQ(m.format, "rgl");
  EXPECT_FALSE(m.isotropic);
  EXPECT_EQ(m.samples.size() + m.set_aside.total(), 9U * 6 * 16 * 16);
  EXPECT_GT(m.samples.size(), 5000U);
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    const double expected = brdf(m.samples.wi(i), m.samples.wo(i));
    ASSERT_NEAR(m.samples.values[1][i] / (expected / 2), 1, 2e-4) << i;
  }
}

// The solid angles turn a sum over the samples of one viewer into an integral: the albedo.
TEST(Rgl, SolidAnglesIntegrate) {
  TestBrdf brdf;
  brdf.tilt = 0;
  const TemporaryFile file;
  RglWriteOptions options;
  options.azimuths = 4;
  options.polar_angles = 3;
  options.density_size = 128;
  options.table_size = 128;
  WriteRgl(Rgb(brdf), kThreeChannels, options, file.path());
  const Measurement m = ReadMeasurement(file.path());
  double sum = 0, norm = 0;
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    if (RadiansToDegrees(PolarAngle(m.samples.wo(i))) > 60) continue;
    sum += m.samples.solid_angle[i] * m.samples.wi_z[i] * m.samples.values[0][i];
    norm += m.samples.solid_angle[i] * m.samples.wi_z[i] / kPi;
  }
  // Quadrature over the same viewers: normal direction and 44.35 degrees, in the file's own weights.
  double exact = 0, viewers = 0;
  for (const auto& [theta_deg, low, high] : {std::array{0.0, 0.0, 22.175}, std::array{44.35, 22.175, 66.525}}) {
    const double share = std::cos(DegreesToRadians(low)) - std::cos(DegreesToRadians(high));
    for (int p = 0; p < 4; ++p) {
      const Vec3 wo = FromSpherical(DegreesToRadians(theta_deg), -kPi + p * kPi / 2);
      double albedo = 0;
      constexpr int kN = 200;
      for (int a = 0; a < kN; ++a) {
        for (int b = 0; b < kN; ++b) {
          const double cos2 = (a + 0.5) / kN;
          const Vec3 wi = FromSpherical(std::acos(std::sqrt(cos2)), (b + 0.5) / kN * 2 * kPi);
          albedo += kPi / (kN * kN) * brdf(wi, wo);
        }
      }
      exact += share * albedo;
      viewers += share;
    }
  }
  EXPECT_NEAR(sum / norm / (exact / viewers), 1, 0.02);
}

TEST(Rgl, IsotropicFilesHaveOneAzimuth) {
  TestBrdf brdf;
  brdf.alpha_y = brdf.alpha_x = 0.2;
  brdf.tilt = 0;
  const TemporaryFile file;
  RglWriteOptions options;
  options.isotropic = true;
  WriteRgl(Rgb(brdf), kThreeChannels, options, file.path());
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_TRUE(m.isotropic);
  const FileBytes mapped(file.path());
  const Errors errors = ErrorsOf(RglBrdf(file.path(), mapped.bytes()), brdf);
  EXPECT_LT(errors.median, 0.004);
  EXPECT_LT(errors.percentile_90, 0.02);
}

// The fields of a file that the writer made, `file` holds their bytes.
std::vector<TensorOutput> FieldsOf(const TensorFile& file) {
  std::vector<TensorOutput> fields;
  for (const auto& [name, type, ndim] : {std::tuple{"phi_i", TensorType::kFloat32, 1},
                                         {"theta_i", TensorType::kFloat32, 1},
                                         {"ndf", TensorType::kFloat32, 2},
                                         {"sigma", TensorType::kFloat32, 2},
                                         {"vndf", TensorType::kFloat32, 4},
                                         {"rgb", TensorType::kFloat32, 5},
                                         {"jacobian", TensorType::kUint8, 1}}) {
    const TensorField& field = file.Get(name, type, static_cast<std::size_t>(ndim));
    fields.push_back({name, type, field.shape, field.bytes});
  }
  return fields;
}

std::string Written(const std::vector<TensorOutput>& fields) {
  std::ostringstream out;
  WriteTensorFile(out, fields);
  return out.str();
}

// The file with only its first `azimuths` azimuths.
std::string Cut(const std::filesystem::path& path, std::uint64_t azimuths) {
  const FileBytes mapped(path);
  const TensorFile file(path, mapped.bytes());
  std::vector<TensorOutput> fields = FieldsOf(file);
  for (TensorOutput& output : fields) {
    if (output.name != "phi_i" && output.name != "vndf" && output.name != "rgb") continue;
    output.bytes = output.bytes.substr(0, output.bytes.size() / output.shape[0] * azimuths);
    output.shape[0] = azimuths;
  }
  return Written(fields);
}

// The mask has a bit a node, the most significant of a byte first; those of nodes that no light reaches tell which
// value means reliable.
TEST(Rgl, TheMaskOfReliableNodes) {
  const TestBrdf brdf;
  const TemporaryFile plain;
  RglWriteOptions options;
  options.azimuths = 2;
  options.polar_angles = 4;
  options.density_size = options.table_size = 8;
  WriteRgl(Rgb(brdf), kThreeChannels, options, plain.path());
  const Measurement all = ReadMeasurement(plain.path());
  const FileBytes mapped(plain.path());
  const TensorFile file(plain.path(), mapped.bytes());
  std::vector<TensorOutput> fields = FieldsOf(file);
  const std::vector<std::uint64_t> shape = file.Get("rgb", TensorType::kFloat32, 5).shape;
  const std::uint64_t nodes = shape[0] * shape[1] * shape[3] * shape[4];
  // Every sample is reliable but two, at places that no other order of the bits has.
  const std::size_t bad = 21, worse = all.samples.size() / 2;
  for (const bool set_is_reliable : {true, false}) {
    std::string mask(nodes / 8, set_is_reliable ? '\0' : '\xff');
    for (std::size_t i = 0; i < all.samples.size(); ++i) {
      if (i == bad || i == worse) continue;
      const std::uint32_t node = all.samples.origin[i];
      mask[node / 8] = static_cast<char>(mask[node / 8] ^ (0x80 >> (node % 8)));
    }
    fields.push_back({"valid", TensorType::kUint8, {nodes / 8}, mask});
    const TemporaryFile masked(Written(fields));
    fields.pop_back();
    const Measurement m = ReadMeasurement(masked.path());
    std::vector<std::uint32_t> expected = all.samples.origin;
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(worse));
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(bad));
    EXPECT_EQ(m.samples.origin, expected) << set_is_reliable;
    EXPECT_EQ(m.conventions.at("rgl-valid"),
              set_is_reliable ? "set bits are reliable (recognised)" : "set bits are unreliable (recognised)");
  }
}

// The file with other values in the first column of each slice, where the half vector is the normal: row r of 16 has
// (0.5 + r / 15) times its value.
std::string SpreadAtNormal(const std::filesystem::path& path) {
  const FileBytes mapped(path);
  std::string bytes(mapped.bytes());
  const TensorFile file(path, mapped.bytes());
  const TensorField& field = file.Get("rgb", TensorType::kFloat32, 5);
  const auto begin = static_cast<std::size_t>(field.bytes.data() - mapped.bytes().data());
  const std::size_t side = field.shape[4];
  for (std::size_t at = 0; at < field.count; at += side) {
    float value = 0;
    std::memcpy(&value, bytes.data() + begin + 4 * at, 4);
    value *= 0.5F + static_cast<float>(at / side % side) / static_cast<float>(side - 1);
    std::memcpy(bytes.data() + begin + 4 * at, &value, 4);
  }
  return bytes;
}

TEST(Rgl, TheMeanIsTakenWhereTheHalfVectorIsTheNormal) {
  TestBrdf brdf;
  brdf.alpha_y = brdf.alpha_x = 0.2;
  brdf.tilt = 0;
  RglWriteOptions options;
  options.isotropic = true;
  options.polar_angles = 6;
  options.table_size = 16;
  const TemporaryFile plain, table;
  WriteRgl(Rgb(brdf), kThreeChannels, options, plain.path());
  const TemporaryFile spread(SpreadAtNormal(plain.path()));
  const Measurement m = ReadMeasurement(spread.path());
  std::size_t at_normal = 0;
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    if (HalfVector(m.samples.wi(i), m.samples.wo(i)).z < 1 - 1e-12) continue;
    ++at_normal;
    EXPECT_NEAR(m.samples.values[0][i] / brdf(m.samples.wi(i), m.samples.wo(i)), 1, 1e-3);
  }
  EXPECT_EQ(at_normal, 6U);
  EXPECT_GE(m.set_aside[SetAsideReason::kDuplicate], 6U * 15);
  // Nothing speaks against a table without the sample's azimuth, however the rows of that column differ.
  Convert({&m, TabulatedBrdf(spread.path(), m).brdf, m.channels, m.isotropic}, FindWriteFormat("merl", "x"), {},
          table.path());
  EXPECT_EQ(ReadMeasurement(table.path()).format, "merl");
}

// Beside nodes below the horizon, and beyond the last viewer, a table says nothing: a MERL table made from it is marked
// there, in place of values over a cosine that goes to zero.
TEST(Rgl, MerlTablesMarkWhatWasNotMeasured) {
  TestBrdf brdf;
  brdf.alpha_y = brdf.alpha_x = 0.4;
  brdf.tilt = 0;
  RglWriteOptions options;
  options.isotropic = true;
  options.polar_angles = 6;
  options.table_size = 16;
  const TemporaryFile table, merl;
  WriteRgl(Rgb(brdf), kThreeChannels, options, table.path());
  const Measurement m = ReadMeasurement(table.path());
  const TabulatedFunction function = TabulatedBrdf(table.path(), m);
  double last = 0;
  for (std::size_t i = 0; i < m.samples.size(); ++i) last = std::max(last, PolarAngle(m.samples.wo(i)));
  const Vec3 wi = FromSpherical(0.5, 0), beyond = FromSpherical(0.5 * (last + kPi / 2), kPi);
  EXPECT_TRUE(function.covers(wi, FromSpherical(0.4, 2)));
  EXPECT_FALSE(function.covers(wi, beyond));
  EXPECT_FALSE(function.covers(FromSpherical(kPi / 2 - 1e-3, 0), FromSpherical(0.4, 2)));

  const Conversion conversion = Convert({&m, function.brdf, m.channels, m.isotropic, function.covers},
                                        FindWriteFormat("merl", "x"), {}, merl.path());
  const Measurement cells = ReadMeasurement(merl.path());
  EXPECT_GT(cells.set_aside[SetAsideReason::kHole], 1000U);
  EXPECT_GT(cells.samples.size(), 900'000U);
  EXPECT_TRUE(std::any_of(conversion.losses.begin(), conversion.losses.end(), [](const std::string& loss) {
    return loss.find("cells above the horizon are marked as not measured") != std::string::npos;
  }));
  double largest_sample = 0, largest_cell = 0;
  for (const double value : m.samples.values[0]) largest_sample = std::max(largest_sample, value);
  for (const double value : cells.samples.values[0]) largest_cell = std::max(largest_cell, value);
  EXPECT_LT(largest_cell, 3 * largest_sample);
}

// Narrow lobes seen close to the horizon, where they change most from one viewer to the next.
TEST(Rgl, GrazingViewersSeeNarrowLobes) {
  TestBrdf brdf;
  brdf.alpha_y = brdf.alpha_x = 0.03;
  brdf.tilt = 0;
  const TemporaryFile file;
  RglWriteOptions options;
  options.isotropic = true;
  WriteRgl(Rgb(brdf), kThreeChannels, options, file.path());
  const FileBytes mapped(file.path());
  const RglBrdf table(file.path(), mapped.bytes());
  for (const double theta_deg : {50.0, 75.0, 80.0, 84.0, 86.0}) {
    const Vec3 wo = FromSpherical(DegreesToRadians(theta_deg), 0.3);
    std::vector<double> errors;
    for (int k = 0; k < 500; ++k) {
      // Half vectors within the lobe.
      const double slope = 0.03 * std::sqrt(k / 500.0 / (1 - 0.9 * k / 500.0)), phi = 2.39996 * k;
      const Vec3 wh = Normalized(Vec3{-slope * std::cos(phi), -slope * std::sin(phi), 1}), wi = Reflect(wo, wh);
      if (wi.z < std::cos(DegreesToRadians(88))) continue;
      double values[3];
      table.Evaluate(wi, wo, values);
      errors.push_back(std::fabs(values[0] / brdf(wi, wo) - 1));
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() / 2], 0.05) << theta_deg;
    EXPECT_LT(errors[errors.size() * 9 / 10], 0.2) << theta_deg;
  }
}

// A surface that a half turn leaves as it is may store half of the viewers, phi in [-pi, 0]; one with two mirror planes
// a quarter, phi in [-pi, -pi/2]. Viewers outside follow from those inside. A table of the whole circle gives other
// values there by up to 2 %, since its nodes lie elsewhere on the lobe: both are held against the truth.
TEST(Rgl, ReducedFilesStandForTheWholeCircle) {
  TestBrdf brdf;
  brdf.tilt = brdf.rotation = 0;
  const TemporaryFile file;
  RglWriteOptions options;
  options.azimuths = 8;
  options.polar_angles = 12;
  WriteRgl(Rgb(brdf), kThreeChannels, options, file.path());
  const FileBytes mapped(file.path());
  const RglBrdf whole(file.path(), mapped.bytes());
  for (const auto& [azimuths, reduction] : {std::pair<std::uint64_t, const char*>{5, "2"}, {3, "4"}}) {
    const std::string bytes = Cut(file.path(), azimuths);
    const RglBrdf reduced("reduced", bytes);
    for (int i = 0; i < 500; ++i) {
      const Vec3 wi = FromSpherical(0.1 + 1.2 * std::fmod(i * 0.618, 1.0), i * 2.4);
      const double theta_o = 0.05 + 1.2 * std::fmod(i * 0.414, 1.0);
      const double phi_o = -kPi + (kPi / (azimuths == 5 ? 1 : 2)) * std::fmod(i * 0.732, 1.0);
      const Vec3 wo = FromSpherical(theta_o, phi_o);
      double inside[3], outside[3];
      whole.Evaluate(wi, wo, inside);
      reduced.Evaluate(wi, wo, outside);
      ASSERT_EQ(inside[0], outside[0]) << i;
      reduced.Evaluate({-wi.x, -wi.y, wi.z}, {-wo.x, -wo.y, wo.z}, outside);
      ASSERT_EQ(inside[0], outside[0]) << i;
      if (azimuths == 5) continue;
      reduced.Evaluate({-wi.x, wi.y, wi.z}, {-wo.x, wo.y, wo.z}, outside);
      ASSERT_EQ(inside[0], outside[0]) << i;
      reduced.Evaluate({wi.x, -wi.y, wi.z}, {wo.x, -wo.y, wo.z}, outside);
      ASSERT_EQ(inside[0], outside[0]) << i;
    }
    // The nodes of a quarter lie better or worse than those of another: as good as what is stored.
    const Errors errors = ErrorsOf(reduced, brdf),
                 errors_whole = ErrorsOf(whole, brdf, -kPi, azimuths == 5 ? 0 : -kPi / 2);
    EXPECT_LT(errors.median, 1.2 * errors_whole.median) << reduction;
    EXPECT_LT(errors.percentile_90, 1.2 * errors_whole.percentile_90) << reduction;

    const Measurement m = ReadMeasurement(TemporaryFile(bytes).path());
    EXPECT_EQ(m.conventions.at("rgl-reduction"), reduction);
    EXPECT_FALSE(m.isotropic);
    for (std::size_t i = 0; i < m.samples.size(); i += 11) {
      ASSERT_NEAR(m.samples.values[0][i] / brdf(m.samples.wi(i), m.samples.wo(i)), 1, 2e-4);
    }
  }
}

TEST(Rgl, SpectralFilesKeepTheirWavelengths) {
  const TestBrdf brdf;
  const TemporaryFile file;
  RglWriteOptions options;
  options.azimuths = 4;
  options.polar_angles = 3;
  options.table_size = 8;
  const BrdfFunction spectral = [&](const Vec3& wi, const Vec3& wo, double* values) {
    values[0] = brdf(wi, wo);
    values[1] = 2 * values[0];
  };
  WriteRgl(spectral, {{"450nm", "650.5nm"}, {450, 650.5}}, options, file.path());
  const Measurement m = ReadMeasurement(file.path());
  EXPECT_EQ(m.channels.names, (std::vector<std::string>{"450nm", "650.5nm"}));
  for (std::size_t i = 0; i < m.samples.size(); ++i) {
    EXPECT_NEAR(m.samples.values[1][i] / m.samples.values[0][i], 2, 1e-5);
  }
  options.kind = RglKind::kRgb;
  EXPECT_THROW(WriteRgl(spectral, {{"450nm", "650.5nm"}, {450, 650.5}}, options, file.path()), UsageError);
}

}  // namespace
}  // namespace lobefit
