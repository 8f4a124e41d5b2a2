// The shader texts: compiled by glslangValidator, and evaluated in a browser's WebGL 2 against the fit. Skipped where
// the tool is not installed.
#include <array>
#include <filesystem>
#include <random>

#include "tests/export/browser.h"
#include "tests/export/materials.h"
#include "tests/support/shapes.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/targets/brdf_explorer/write.h"
#include "lobefit/export/targets/glsl/write.h"
#include "lobefit/export/targets/osl/write.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

struct ShaderCase {
  const char* name;
  SyntheticCase (*material)();
};
std::ostream& operator<<(std::ostream& out, const ShaderCase& c) { return out << c.name; }

SyntheticCase Spectral() {
  SyntheticCase synthetic = OneLobe(Ndf::kEllipsoid, 0.3, 0.1, 4, 5, 10, {0.5, 0.6, 0.7, 0.8}, {0.1, 0.1, 0.1, 0.1});
  synthetic.channels = {"450nm", "500nm", "550nm", "600nm"};
  return synthetic;
}
SyntheticCase Narrow() {
  SyntheticCase synthetic = OneLobe(Ndf::kEllipsoid, 0.02, 0.005, 3, -4, 70);
  synthetic.model.lobes[0].masking = Masking::kSmithHeight;
  return synthetic;
}

// The terms that the other cases do not have: Beckmann, every masking, exact Fresnel terms.
SyntheticCase Beckmann(Masking masking, Fresnel fresnel) {
  SyntheticCase synthetic = OneLobe(Ndf::kBeckmannAnisotropic, 0.4, 0.15, 0, 0, 20);
  synthetic.model.lobes[0].masking = masking;
  synthetic.model.lobes[0].fresnel = fresnel;
  if (fresnel == Fresnel::kConductor) {
    synthetic.values[5] = {0.2, 0.9, 1.4};
    synthetic.values.insert(synthetic.values.begin() + 6, {3.9, 2.4, 0.5});
  } else if (fresnel == Fresnel::kDielectric) {
    synthetic.values[5] = {1.5, 1.33, 2};
  }
  return synthetic;
}
SyntheticCase BeckmannMetal() { return Beckmann(Masking::kSmithHeightDirection, Fresnel::kConductor); }
SyntheticCase BeckmannGlass() { return Beckmann(Masking::kVCavity, Fresnel::kDielectric); }
SyntheticCase BeckmannKelemen() { return Beckmann(Masking::kKelemen, Fresnel::kNone); }
SyntheticCase GgxSchlickSmith() {
  SyntheticCase synthetic = test::Turned();
  synthetic.model.lobes[0].masking = Masking::kSchlickSmith;
  return synthetic;
}
SyntheticCase GgxImplicit() {
  SyntheticCase synthetic = test::Turned();
  synthetic.model.lobes[0].masking = Masking::kImplicit;
  return synthetic;
}

// Profiles, Student's, tinted and free Fresnel terms, diffuse parts of two directions, lobes about the back direction.
SyntheticCase Made(const std::vector<Lobe>& lobes, Diffuse diffuse, const ParameterValues& values) {
  SyntheticCase synthetic;
  synthetic.model.lobes = lobes;
  synthetic.model.diffuse = diffuse;
  synthetic.values = values;
  return synthetic;
}
const std::vector<double> kCurve0 = {0.9, 1, 0.8}, kCurve1 = {0.8, 0.7, 0.5}, kCurve2 = {0.3, 0.2, 0.1},
                          kCurve3 = {0.1, 0.3, 0.2}, kCurve4 = {0.6, 0.1, 0.05}, kCurve5 = {0.4, 0.2, 0.1};
SyntheticCase TiltedProfile() {
  return Made({{Ndf::kProfileEllipsoid, Masking::kSmithSeparable, Fresnel::kCurve}}, Diffuse::kInterfaced,
              {{0.3},
               {0.12},
               {0.05},
               {-0.08},
               {0.4},
               {-0.6},
               {0.8},
               {0.3},
               {-0.9},
               {-0.5},
               {-0.4},
               kCurve0,
               kCurve1,
               kCurve2,
               kCurve3,
               kCurve4,
               kCurve5,
               {1.5, 1.5, 1.5},
               {0.3, 0.2, 0.1}});
}
// As good as Beckmann's: exponents that rise steeply.
SyntheticCase SteepProfile() {
  return Made({{Ndf::kProfile, Masking::kSmithUnclamped, Fresnel::kSchlickF82}}, Diffuse::kOrenNayar,
              {{0.4},
               {0.4},
               {0},
               {0},
               {0},
               {-0.6},
               {2},
               {9},
               {30},
               {26},
               {30},
               {0.9, 0.6, 0.3},
               {0.4, 0.7, 1.1},
               {0.8, 0.8, 0.8},
               {0.6, 0.4, 0.9}});
}
SyntheticCase StudentOverGlass() {
  SyntheticCase synthetic =
      Made({{Ndf::kStudentEllipsoid, Masking::kSmithHeight, Fresnel::kDielectric}}, Diffuse::kInterfaced,
           {{0.4}, {0.1}, {0.02}, {0.06}, {-0.9}, {1.6}, {1.5, 1.33, 2}, {1.02, 1.5, 2.8}, {0.6, 0.4, 0.9}});
  return synthetic;
}
SyntheticCase LightStudent() {
  return Made({{Ndf::kStudentAnisotropic, Masking::kSmithHeightDirection, Fresnel::kSchlick}}, Diffuse::kNone,
              {{0.2}, {0.08}, {0}, {0}, {1.1}, {12}, {0.9, 0.5, 0.1}});
}
SyntheticCase StudentSchlickSmith() {
  SyntheticCase synthetic = LightStudent();
  synthetic.model.lobes[0].masking = Masking::kSchlickSmith;
  return synthetic;
}
SyntheticCase NarrowProfile() {
  SyntheticCase synthetic = TiltedProfile();
  synthetic.values[0] = {0.02};
  synthetic.values[1] = {0.008};
  synthetic.model.lobes[0].grid = GridWithKnots({0, 0.25, 0.5, 0.75, 1, 1.5, 2, 4});
  synthetic.values.insert(synthetic.values.begin() + 11, {0.3});
  return synthetic;
}
SyntheticCase Retro() {
  return Made({{Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kSchlick},
               {Ndf::kProfileAnisotropic, Masking::kSmithSeparable, Fresnel::kNone, "", LobeDirection::kRetro},
               {Ndf::kGgx, Masking::kSmithHeight, Fresnel::kSchlickF82, "", LobeDirection::kRetro}},
              Diffuse::kLambert, {{0.3},         {0.3},          {0},   {0},    {0},    {0.05, 0.05, 0.05},
                                  {0.2},         {0.1},          {0},   {0},    {0.5},  {0.4},
                                  {-0.2},        {-0.2},         {0.1}, {-0.1}, {-0.3}, {0.2, 0.3, 0.1},
                                  {0.1},         {0.1},          {0},   {0},    {0},    {0.3, 0.2, 0.1},
                                  {0.5, 0.9, 1}, {0.1, 0.2, 0.3}});
}
// The scatter of a polished surface beside a lobe of facets.
SyntheticCase Scatter() {
  return Made({{Ndf::kAbgAnisotropic, Masking::kNone, Fresnel::kNone}, {Ndf::kGgx}}, Diffuse::kLambert,
              {{0.02},
               {0.01},
               {0},
               {0},
               {0.4},
               {1.6},
               {0.9, 0.6, 0.3},
               {0.3},
               {0.3},
               {0},
               {0},
               {0},
               {0.1, 0.2, 0.05},
               {0.1, 0.2, 0.3}});
}
// A coloured coat that refracts, over an ellipsoid, a retro lobe and a Lambertian part.
SyntheticCase Coated() {
  return Made({{Ndf::kEllipsoid, Masking::kSmithSeparable, Fresnel::kSchlick},
               {Ndf::kGgx, Masking::kSmithHeight, Fresnel::kCoatRefracted},
               {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kNone, "", LobeDirection::kRetro}},
              Diffuse::kLambert, {{0.3}, {0.12}, {0.05}, {-0.08}, {0.4},           {0.9, 0.6, 0.3}, {0.1},
                                  {0.1}, {0},    {0},    {0},     {1.6, 1.6, 1.6}, {0.1, 0.3, 0.6}, {0.2},
                                  {0.2}, {0},    {0},    {0},     {0.1, 0.2, 0.3}, {0.5, 0.3, 0.9}});
}
SyntheticCase SpectralCoat() {
  SyntheticCase synthetic = Coated();
  synthetic.model.lobes[1].fresnel = Fresnel::kCoatLayered;
  synthetic.channels = {"450nm", "500nm", "550nm", "600nm"};
  const std::vector<Parameter> parameters = Parameters(synthetic.model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (parameters[p].per_channel) synthetic.values[p].push_back(synthetic.values[p][0]);
  }
  return synthetic;
}
SyntheticCase SpectralProfile() {
  SyntheticCase synthetic = TiltedProfile();
  synthetic.channels = {"450nm", "500nm", "550nm", "600nm"};
  const std::vector<Parameter> parameters = Parameters(synthetic.model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (parameters[p].per_channel) synthetic.values[p].push_back(0.9 * synthetic.values[p][0] + 0.1);
  }
  return synthetic;
}

// What a text is asked in each pixel.
constexpr const char* kCall = "vec3 pixel(vec4 a, vec4 b) { return f_of(a.xyz, b.xyz); }\n";

// The same call for glsl of any channels.
std::string MainOf(const FittedBrdf& fit) {
  const std::size_t channels = fit.material().channels.size();
  return fit.IsRgbOrGrey() ? "vec3 f_of(vec3 wi, vec3 wo) { return lobefit_f_r(wi, wo); }\n"
                           : fmt::format(
                                 "vec3 f_of(vec3 wi, vec3 wo) {{ float f[{}]; lobefit_f_r(wi, wo, f); return "
                                 "vec3(f[0], f[1], f[{}]); }}\n",
                                 channels, channels - 1);
}

const ShaderCase kShaderCases[] = {{"tilted", test::Tilted},
                                   {"two_lobes", test::TwoLobes},
                                   {"spectral", Spectral},
                                   {"narrow", Narrow},
                                   {"beckmann_metal", BeckmannMetal},
                                   {"beckmann_glass", BeckmannGlass},
                                   {"beckmann_kelemen", BeckmannKelemen},
                                   {"schlick_smith", GgxSchlickSmith},
                                   {"implicit", GgxImplicit},
                                   {"tilted_profile", TiltedProfile},
                                   {"steep_profile", SteepProfile},
                                   {"narrow_profile", NarrowProfile},
                                   {"student_over_glass", StudentOverGlass},
                                   {"light_student", LightStudent},
                                   {"student_schlick_smith", StudentSchlickSmith},
                                   {"retro", Retro},
                                   {"scatter", Scatter},
                                   {"spectral_profile", SpectralProfile},
                                   {"coated", Coated},
                                   {"spectral_coat", SpectralCoat}};

class Shaders : public testing::TestWithParam<ShaderCase> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / (std::string("shader_") + GetParam().name);
    std::filesystem::create_directories(folder_);
    Material material = test::MaterialOf(GetParam().material());
    if (material.channels.size() == 4) material.wavelengths_nm = {450, 500, 550, 600};
    fit_ = std::make_unique<FittedBrdf>(material);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Validate(const std::string& text) const { return test::Validate(text, folder_); }

  std::filesystem::path folder_;
  std::unique_ptr<FittedBrdf> fit_;
};

TEST_P(Shaders, CompileForGlAndForWebGl) {
  if (!test::Installed("glslangValidator")) GTEST_SKIP() << "glslangValidator is not installed";
  const std::string text = GlslText(*fit_, "a 2nd--one", {"a comment"}) + MainOf(*fit_);
  const std::string main = "in vec3 a; in vec3 b; out vec4 c;\nvoid main() { c = vec4(f_of(a, b), 1.0); }\n";
  for (const char* version : {"#version 300 es\nprecision highp float;\n", "#version 330\n", "#version 410\n"}) {
    EXPECT_THAT(Validate(version + text + main), testing::Not(HasSubstr("ERROR"))) << version;
  }
  // The test can fail.
  EXPECT_THAT(Validate("#version 330\n" + text + "void main() { undefined(); }\n"), HasSubstr("ERROR"));
}

TEST_P(Shaders, BrdfExplorerFileCompiles) {
  if (!test::Installed("glslangValidator")) GTEST_SKIP() << "glslangValidator is not installed";
  if (!fit_->IsRgbOrGrey()) return;
  const std::string file = BrdfExplorerText(*fit_, {"a comment"});
  // As the program reads it: the first line is "analytic", then lines that begin with # go.
  EXPECT_TRUE(file.starts_with("analytic\n")) << file.substr(0, 20);
  std::string uniforms, shader;
  LineReader lines(file);
  std::string_view line;
  bool in_parameters = false, in_shader = false;
  while (lines.Next(&line)) {
    if (Trim(line).starts_with("#")) continue;
    if (line == "::end parameters") in_parameters = false;
    if (line == "::end shader") in_shader = false;
    if (in_parameters) {
      const std::vector<std::string_view> words = SplitBlanks(line);
      ASSERT_EQ(words.size(), 5U) << line;
      uniforms += fmt::format("uniform {} {};\n", words[0] == "color" ? "vec3" : "float", words[1]);
      for (std::size_t k = 2; k < 5; ++k) EXPECT_TRUE(ParseDouble(words[k]).has_value()) << line;
    }
    if (in_shader) shader += std::string(line) + "\n";
    if (line == "::begin parameters") in_parameters = true;
    if (line == "::begin shader") in_shader = true;
  }
  EXPECT_THAT(Validate("#version 410\n" + uniforms + shader +
                       "in vec3 a; in vec3 b; out vec4 c;\nvoid main() { c = vec4(BRDF(a, b, vec3(0.0, 0.0, 1.0), "
                       "vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)), 1.0); }\n"),
              testing::Not(HasSubstr("ERROR")));
}

// The glsl of a fit and, where that holds it, BRDF Explorer's.
std::vector<std::string> BrowserTexts(const FittedBrdf& fit) {
  std::string explorer_body, explorer_uniforms;
  if (fit.IsRgbOrGrey()) {
    // The sliders at their defaults, as constants.
    const std::string text = BrdfExplorerText(fit, {});
    LineReader again(text);
    std::string_view line;
    bool in_parameters = false, in_shader = false;
    while (again.Next(&line)) {
      if (line.starts_with("::end")) in_parameters = in_shader = false;
      if (in_parameters) {
        const std::vector<std::string_view> w = SplitBlanks(line);
        explorer_uniforms += w[0] == "color"
                                 ? fmt::format("const vec3 {} = vec3({}, {}, {});\n", w[1], w[2], w[3], w[4])
                                 : fmt::format("const float {} = {};\n", w[1], w[4]);
      }
      if (in_shader) explorer_body += std::string(line) + "\n";
      if (line == "::begin parameters") in_parameters = true;
      if (line == "::begin shader") in_shader = true;
    }
    explorer_body +=
        "vec3 f_of(vec3 wi, vec3 wo) { return BRDF(wi, wo, vec3(0.0, 0.0, 1.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, "
        "0.0)); }\n";
  }
  std::vector<std::string> texts = {GlslText(fit, "one", {}) + MainOf(fit) + kCall};
  if (!explorer_body.empty()) texts.push_back(explorer_uniforms + explorer_body + kCall);
  return texts;
}

// 64 pairs of directions, for each text one pixel a pair in floating point. One page for all materials: the browser
// takes seconds to start.
TEST(ShadersInABrowser, GiveTheFitsValues) {
  if (!test::Installed("chromium")) GTEST_SKIP() << "Chromium is not installed";
  constexpr int kPairs = 64;
  std::vector<Vec3> wi, wo;
  ShapeGenerator directions(11);
  while (wi.size() < kPairs) {
    const Vec3 i = directions.Upper(), o = wi.size() % 4 == 0 ? Vec3{-i.x, -i.y, i.z} : directions.Upper();
    if (i.z < 0.02 || o.z < 0.02) continue;
    wi.push_back(i);
    wo.push_back(o);
  }
  std::vector<std::array<test::Texel, 2>> pairs;
  for (std::size_t k = 0; k < kPairs; ++k) pairs.push_back({test::Texel{wi[k], 0}, test::Texel{wo[k], 0}});
  std::vector<std::string> texts;
  std::vector<const ShaderCase*> cases;  // of each text
  for (const ShaderCase& shader : kShaderCases) {
    for (std::string& text : BrowserTexts(FittedBrdf(test::MaterialOf(shader.material())))) {
      texts.push_back(std::move(text));
      cases.push_back(&shader);
    }
  }
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "shaders_in_a_browser";
  std::filesystem::create_directories(folder);
  const std::vector<std::vector<double>> rows = test::EvaluateInBrowser(texts, pairs, folder);
  std::filesystem::remove_all(folder);
  ASSERT_EQ(rows.size(), texts.size());
  for (std::size_t text = 0; text < texts.size(); ++text) {
    const FittedBrdf fit(test::MaterialOf(cases[text]->material()));
    const std::size_t channels = fit.material().channels.size();
    const std::vector<double>& values = rows[text];
    ASSERT_EQ(values.size(), 4U * kPairs);
    for (std::size_t k = 0; k < kPairs; ++k) {
      std::vector<double> wanted(channels);
      fit.function()(wi[k], wo[k], wanted.data());
      for (std::size_t c = 0; c < 3; ++c) {
        const double expected = wanted[channels == 1 ? 0 : c == 2 ? channels - 1 : c];
        const double found = values[4 * k + c];
        // Single precision: a direction has 6e-8, which a lobe of width alpha sees 1/alpha times as large.
        const double tolerance = 1e-4 + 1e-6 / fit.lobes()[0].widths.alpha_2;
        EXPECT_NEAR(found / expected, 1, tolerance)
            << cases[text]->name << ", text " << text << ", pair " << k << ", channel " << c;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Materials, Shaders, testing::ValuesIn(kShaderCases),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// Two materials in one shader, and the first by the short name.
TEST(GlslText, TwoFilesMakeOneShader) {
  if (!test::Installed("glslangValidator")) GTEST_SKIP() << "glslangValidator is not installed";
  const FittedBrdf one(test::MaterialOf(test::Tilted())), two(test::MaterialOf(test::TwoLobes()));
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "two_files";
  std::filesystem::create_directories(folder);
  const std::string main =
      "in vec3 a; in vec3 b; out vec4 c;\nvoid main() { c = vec4(lobefit_f_r(a, b) + lobefit_one_f_r(a, b) + "
      "lobefit_m_2_two_f_r(a, b), 1.0); }\n";
  const std::string text = GlslText(one, "one", {}) + GlslText(two, "2  two", {}) + main;
  for (const char* version : {"#version 300 es\nprecision highp float;\n", "#version 330\n"}) {
    EXPECT_THAT(test::Validate(version + text, folder), testing::Not(HasSubstr("ERROR"))) << version;
  }
  std::filesystem::remove_all(folder);
}

TEST(OslText, IsTheSameTextWithItsOwnNames) {
  const FittedBrdf fit(test::MaterialOf(test::Tilted()));
  const std::string text = OslText(fit, "2 red-metal", {"a comment"});
  EXPECT_TRUE(text.starts_with("// a comment\n"));
  EXPECT_EQ(text.find("vec3"), std::string::npos);
  EXPECT_THAT(text, HasSubstr("vector lobefit_f_r(vector wi, vector wo) {"));
  EXPECT_THAT(text, HasSubstr("shader m_2_red_metal("));
  EXPECT_THAT(text, HasSubstr("output color f_r = 0"));
}

}  // namespace
}  // namespace lobefit
