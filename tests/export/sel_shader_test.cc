// Tables of squared ellipsoidal lobes as shader text: compiled by glslangValidator, values and bounds in a browser's
// WebGL 2 against the C++. Skipped where the tool is not installed.
#include <array>
#include <cmath>
#include <filesystem>

#include "tests/export/browser.h"
#include "tests/support/shapes.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/core/sel/sel_bound.h"
#include "lobefit/export/targets/sel/glsl.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

SelSlice Slice(double theta_deg, double phi_deg, std::size_t lobes, std::size_t channels) {
  SelSlice slice;
  slice.theta_i = DegreesToRadians(theta_deg);
  slice.phi_i = DegreesToRadians(phi_deg);
  for (std::size_t l = 0; l < lobes; ++l) {
    const auto n = static_cast<double>(l);
    slice.lobes.push_back({0.12 + 0.25 * n + 0.001 * theta_deg, 0.07 + 0.2 * n, 0.003 * theta_deg, 0.05 - 0.02 * n,
                           0.4 + 0.01 * phi_deg});
    slice.amplitude.emplace_back();
    for (std::size_t c = 0; c < channels; ++c) {
      slice.amplitude.back().push_back((1 + 0.02 * theta_deg) / (1 + 4 * n) + 0.1 * static_cast<double>(c));
    }
  }
  for (std::size_t c = 0; c < channels; ++c) slice.constant.push_back(0.05 + 0.01 * static_cast<double>(c));
  return slice;
}

struct TableCase {
  const char* name;
  SelTable table;
  Channels channels;
};
std::ostream& operator<<(std::ostream& out, const TableCase& c) { return out << c.name; }

TableCase IsotropicTable() {
  SelTable table = {SelQuantity::kBrdf, true, false, {}};
  for (const double theta : {0., 15., 30., 45., 60., 75.}) table.slices.push_back(Slice(theta, 0, 2, 3));
  return {"isotropic", table, {{"R", "G", "B"}, {}}};
}
// One slice along the normal, whose lobes keep to the surface's axes; rings of different azimuths, one of a single one.
TableCase AnisotropicTable() {
  SelTable table = {SelQuantity::kBrdfCosineO, false, false, {Slice(0, 30, 1, 1)}};
  for (const double phi : {10., 80., 200.}) table.slices.push_back(Slice(25, phi, 1, 1));
  table.slices.push_back(Slice(45, -70, 1, 1));
  for (const double phi : {-170., -20., 60., 120.}) table.slices.push_back(Slice(60, phi, 1, 1));
  return {"anisotropic", table, {{"Y"}, {}}};
}
TableCase SpectralTable() {
  SelTable table = {SelQuantity::kBrdf, false, true, {}};
  for (const double phi : {0., 90., 180., 270.}) table.slices.push_back(Slice(40, phi, 3, 4));
  return {"spectral", table, {{"450nm", "500nm", "550nm", "600nm"}, {450, 500, 550, 600}}};
}
TableCase NarrowTable() {
  TableCase narrow = IsotropicTable();
  narrow.name = "narrow";
  for (SelSlice& slice : narrow.table.slices) slice.lobes[0] = {0.012, 0.004, 0.01, 0.002, -0.6};
  return narrow;
}

class SelShaders : public testing::TestWithParam<TableCase> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("sel_shader_") + GetParam().name);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  const SelTable& table() const { return GetParam().table; }
  std::string BoundName() const {
    return table().quantity == SelQuantity::kBrdf ? "lobefit_f_r_bound" : "lobefit_f_r_cos_bound";
  }
  // The text with f_of and bound_of as vec3, of the first two channels and the last.
  std::string Text() const {
    const std::size_t n = GetParam().channels.size();
    std::string text = SelGlslText(reflectance_, GetParam().channels, "one", {"a comment"});
    for (const auto& [name, function, parameters, arguments] :
         {std::array<std::string, 4>{"f_of", "lobefit_f_r", "vec3 wi, vec3 wo", "wi, wo"},
          {"bound_of", BoundName(), "vec3 wi, vec3 axis, float angle", "wi, axis, angle"}}) {
      text += n == 4 ? fmt::format("vec3 {}({}) {{ float x[4]; {}({}, x); return vec3(x[0], x[1], x[3]); }}\n", name,
                                   parameters, function, arguments)
                     : fmt::format("vec3 {}({}) {{ return {}({}); }}\n", name, parameters, function, arguments);
    }
    return text;
  }
  static std::size_t ChannelAt(std::size_t channels, std::size_t column) {
    return channels == 1 ? 0 : column == 2 ? channels - 1 : column;
  }

  SelReflectance reflectance_{GetParam().table};
  std::filesystem::path folder_;
};

TEST_P(SelShaders, CompileForGlAndForWebGl) {
  if (!test::Installed("glslangValidator")) GTEST_SKIP() << "glslangValidator is not installed";
  const std::string main =
      "in vec3 a; in vec3 b; out vec4 c;\nvoid main() { c = vec4(f_of(a, b) + bound_of(a, b, 0.1), 1.0); }\n";
  for (const char* version : {"#version 300 es\nprecision highp float;\n", "#version 330\n", "#version 410\n"}) {
    EXPECT_THAT(test::Validate(version + Text() + main, folder_), testing::Not(HasSubstr("ERROR"))) << version;
  }
}

TEST_P(SelShaders, GiveTheTablesValuesInABrowser) {
  if (!test::Installed("chromium")) GTEST_SKIP() << "Chromium is not installed";
  const std::size_t channels = GetParam().channels.size();
  ShapeGenerator random(3);
  std::vector<std::array<test::Texel, 2>> pairs;
  while (pairs.size() < 400) {
    const Vec3 wi = random.Upper(), wo = pairs.size() % 4 == 0 ? Vec3{-wi.x, -wi.y, wi.z} : random.Upper();
    if (wi.z < 0.02 || wo.z < 0.02) continue;
    pairs.push_back({test::Texel{wi, 0}, test::Texel{wo, 0}});
  }
  // Slices themselves, and the normal.
  for (const SelSlice& slice : table().slices) {
    pairs.push_back({test::Texel{FromSpherical(slice.theta_i, slice.phi_i), 0}, test::Texel{random.Upper(), 0}});
  }
  pairs.push_back({test::Texel{{0, 0, 1}, 0}, test::Texel{Normalized(Vec3{0.1, 0.2, 1}), 0}});
  // Below the horizon.
  pairs.push_back({test::Texel{{0.6, 0, 0.8}, 0}, test::Texel{{0, 0.6, -0.8}, 0}});
  const std::vector<std::vector<double>> rows =
      test::EvaluateInBrowser({Text() + "vec3 pixel(vec4 a, vec4 b) { return f_of(a.xyz, b.xyz); }\n"}, pairs, folder_);
  ASSERT_EQ(rows.size(), 1U);
  ASSERT_EQ(rows[0].size(), 4 * pairs.size());
  double narrowest = 1;
  for (const SelSlice& slice : table().slices) narrowest = std::min(narrowest, slice.lobes[0].alpha_y);
  std::vector<double> expected(channels);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    reflectance_.Evaluate(pairs[k][0].xyz, pairs[k][1].xyz, expected.data());
    for (std::size_t column = 0; column < 3; ++column) {
      const double value = expected[ChannelAt(channels, column)];
      // Single precision: a direction has 6e-8, which a lobe of width alpha sees 1/alpha times as large.
      EXPECT_NEAR(rows[0][4 * k + column], value, (1e-4 + 1e-6 / narrowest) * value) << "pair " << k;
    }
  }
}

// Not below any value of the cone, and near the sum of the lobes' least bounds.
TEST_P(SelShaders, BoundConesInABrowser) {
  if (!test::Installed("chromium")) GTEST_SKIP() << "Chromium is not installed";
  const std::size_t channels = GetParam().channels.size();
  ShapeGenerator random(5);
  std::vector<std::array<test::Texel, 2>> cones;
  for (int k = 0; cones.size() < 300; ++k) {
    const Vec3 wi = random.Upper(), mirror = {-wi.x, -wi.y, wi.z};
    const double half_angle = std::pow(10, random.Uniform(-3, 0.2));
    // Far from the lobes and near them.
    const Vec3 axis = k % 2 == 0 ? random.Upper() : Normalized(mirror + 0.3 * random.Upper());
    if (wi.z > 0.05) cones.push_back({test::Texel{wi, 0}, test::Texel{axis, half_angle}});
  }
  cones.push_back({test::Texel{{0, 0, 1}, 0}, test::Texel{{1, 0, 0}, 3.2}});
  const std::vector<std::vector<double>> rows = test::EvaluateInBrowser(
      {Text() + "vec3 pixel(vec4 a, vec4 b) { return bound_of(a.xyz, b.xyz, b.w); }\n"}, cones, folder_);
  ASSERT_EQ(rows.size(), 1U);
  ASSERT_EQ(rows[0].size(), 4 * cones.size());
  std::vector<double> value(channels);
  double loosest = 0;
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const Vec3 wi = cones[k][0].xyz, axis = cones[k][1].xyz;
    const double half_angle = cones[k][1].w;
    const SelSlice slice = reflectance_.At(wi);
    const Vec3 mirror = {-wi.x, -wi.y, wi.z};
    std::vector<double> most(channels, 0.0), least_bound = slice.constant;
    const Vec3 e1 = Normalized(Cross(axis, std::fabs(axis.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
    const Vec3 e2 = Cross(axis, e1);
    for (int i = 0; i < 3000; ++i) {
      // The rim, the inside, and directions near the mirror direction that lie in the cone.
      const double psi = random.Uniform(0, 2 * kPi), angle = half_angle * (i % 3 == 0 ? 1 : random.Uniform(0, 1));
      Vec3 wo = std::cos(angle) * axis + std::sin(angle) * (std::cos(psi) * e1 + std::sin(psi) * e2);
      if (i % 3 == 2) wo = Normalized(mirror + random.Uniform(0, 0.3) * random.Upper());
      if (wo.z <= 0 || std::acos(std::clamp(Dot(wo, axis), -1.0, 1.0)) > half_angle * (1 + 1e-9)) continue;
      reflectance_.Evaluate(wi, wo, value.data());
      const double cosine = table().quantity == SelQuantity::kBrdf ? 1 : wo.z;
      for (std::size_t c = 0; c < channels; ++c) most[c] = std::max(most[c], cosine * value[c]);
    }
    for (std::size_t l = 0; l < slice.lobes.size(); ++l) {
      const SelLobeInFrame lobe(slice.lobes[l]);
      const double bound = SelBoundOverCone(slice.lobes[l].alpha_x, slice.lobes[l].alpha_y, {0, 0, 0},
                                            lobe.axes() * (MirrorFrame(wi) * axis), half_angle)
                               .bound;
      for (std::size_t c = 0; c < channels; ++c) least_bound[c] += bound * slice.amplitude[l][c];
    }
    for (std::size_t column = 0; column < 3; ++column) {
      const std::size_t c = ChannelAt(channels, column);
      const double found = rows[0][4 * k + column];
      EXPECT_GE(found, most[c]) << "cone " << k << ", half angle " << half_angle;
      loosest = std::max(loosest, found / least_bound[c]);
      EXPECT_LE(found, 1.03 * least_bound[c]) << "cone " << k << ", half angle " << half_angle;
    }
  }
  RecordProperty("loosest", std::to_string(loosest));
}

INSTANTIATE_TEST_SUITE_P(Tables, SelShaders,
                         testing::Values(IsotropicTable(), AnisotropicTable(), SpectralTable(), NarrowTable()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace lobefit
