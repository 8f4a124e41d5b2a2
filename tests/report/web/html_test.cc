// The live page: what stands in the file, and, where Chromium is installed, what it does in a browser.
#include "lobefit/report/web/html.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/report/synthetic.h"
#include "tests/support/browser_page.h"
#include "tests/support/paths.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/base64.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/color.h"
#include "lobefit/report/panels/page.h"
#include "lobefit/report/panels/sphere.h"
#include "lobefit/report/report.h"
#include "lobefit/report/web/template.h"

namespace lobefit {
namespace {

using test::NumberAfter;
using test::OutputOf;
using testing::HasSubstr;
using testing::Not;

TEST(FillTemplate, ReplacesOnceAndKeepsSections) {
  EXPECT_EQ(
      FillTemplate("a {{x}}{{#s}} b {{x}}{{/s}}{{#t}} c {{y}}{{/t}}.", {{"x", "{{y}}"}}, {{"s", true}, {"t", false}}),
      "a {{y}} b {{y}}.");
  EXPECT_THROW(FillTemplate("{{x}}", {}, {}), std::logic_error);
  EXPECT_THROW(FillTemplate("{{#s}}", {}, {{"s", true}}), std::logic_error);
}

TEST(Base64, OfRfc4648) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  for (const char* text : {"", "f", "fo", "foo", "foob"}) EXPECT_EQ(FromBase64(Base64(text)), text);
  for (const char* text : {"Z", "Zg=", "Z===", "Zg==Zg==", "Z!=="}) EXPECT_EQ(FromBase64(text), std::nullopt) << text;
}

struct PageCase {
  const char* name;
  std::size_t channels;
  bool isotropic, table, out_of_plane;
  Material (*material)(std::size_t channels) = nullptr;  // null: test::MakeMaterial
  bool hostile = false;
};

std::ostream& operator<<(std::ostream& out, const PageCase& c) { return out << c.name; }

// The material of `model` with a value for each parameter, one number or one a channel.
Material WithModel(const Model& model, const ParameterValues& values, std::size_t channels) {
  Material material = test::MakeMaterial(channels, false);
  material.model = model;
  material.parameters.clear();
  material.covariance.clear();
  material.covariance_names.clear();
  const std::vector<Parameter> parameters = Parameters(model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    FittedParameter fitted;
    fitted.values = values.at(p);
    fitted.free = parameters[p].free;
    if (parameters[p].per_channel) fitted.values.resize(channels, fitted.values.back());
    fitted.standard_error.assign(fitted.values.size(), 0.01);
    fitted.standard_error_clustered.assign(fitted.values.size(), 0.02);
    material.parameters.push_back(fitted);
  }
  return material;
}

Material TwoBeckmannLobesOverFacets(std::size_t channels) {
  Model model;
  model.lobes = {{Ndf::kBeckmannOffCenter, Masking::kSmithHeightDirection, Fresnel::kDielectric},
                 {Ndf::kBeckmann, Masking::kVCavity, Fresnel::kNone}};
  model.diffuse = Diffuse::kMicrofacet;
  return WithModel(model,
                   {{0.35},
                    {0.2},
                    {0.05},
                    {-0.08},
                    {0.4},
                    {1.5, 1.6, 1.8},
                    {0.5},
                    {0.5},
                    {0},
                    {0},
                    {0},
                    {0.1, 0.05, 0.02},
                    {0.6, 0.3, 0.1}},
                   channels);
}

Material TiltedConductorOverFacets(std::size_t channels) {
  Model model;
  model.lobes = {{Ndf::kEllipsoid, Masking::kSmithHeight, Fresnel::kConductor}};
  model.diffuse = Diffuse::kMicrofacet;
  return WithModel(
      model, {{0.4}, {0.15}, {0.03}, {0.06}, {-0.7}, {0.2, 0.9, 1.4, 1.5, 1.5}, {3.9, 2.4, 1.9, 1.8, 1.7}, {0.3, 0.2}},
      channels);
}

// A tilted profile with a free Fresnel curve, Student's with an edge tint and a retro lobe over an interfaced part.
Material ProfileStudentAndRetro(std::size_t channels) {
  Model model;
  model.lobes = {{Ndf::kProfileEllipsoid, Masking::kSmithSeparable, Fresnel::kCurve},
                 {Ndf::kStudentAnisotropic, Masking::kSmithHeight, Fresnel::kSchlickF82},
                 {Ndf::kProfile, Masking::kSmithSeparable, Fresnel::kNone, "", LobeDirection::kRetro}};
  model.diffuse = Diffuse::kInterfaced;
  return WithModel(model,
                   {{0.3},
                    {0.15},
                    {0.05},
                    {-0.08},
                    {0.4},
                    {-0.6},
                    {0.8},
                    {0.3},
                    {-0.9},
                    {-0.5},
                    {-0.4},
                    {0.9},
                    {0.8},
                    {0.3},
                    {0.2},
                    {0.1},
                    {0.3, 0.2, 0.1},
                    {0.4},
                    {0.2},
                    {0},
                    {0},
                    {-0.5},
                    {1.7},
                    {0.3, 0.2, 0.1},
                    {0.5, 0.8, 1},
                    {0.3},
                    {0.3},
                    {0},
                    {0},
                    {0},
                    {1},
                    {5},
                    {12},
                    {9},
                    {8},
                    {20},
                    {0.1, 0.2, 0.3},
                    {1.5},
                    {0.4, 0.3, 0.2}},
                   channels);
}

// A coat that refracts, over a tilted lobe and a Lambertian part.
Material Coated(std::size_t channels) {
  Model model;
  model.lobes = {{Ndf::kEllipsoid, Masking::kSmithSeparable, Fresnel::kSchlick},
                 {Ndf::kGgx, Masking::kSmithHeight, Fresnel::kCoatRefracted}};
  return WithModel(model,
                   {{0.4},
                    {0.2},
                    {0.05},
                    {-0.08},
                    {0.4},
                    {0.9, 0.6, 0.3},
                    {0.15},
                    {0.15},
                    {0},
                    {0},
                    {0},
                    {1.6},
                    {0.1, 0.3},
                    {0.5, 0.3, 0.9}},
                   channels);
}

Material StudentOverOrenNayar(std::size_t channels) {
  Model model;
  model.lobes = {{Ndf::kStudent, Masking::kSmithHeightDirection, Fresnel::kSchlick}};
  model.diffuse = Diffuse::kOrenNayar;
  return WithModel(model, {{0.4}, {0.4}, {0}, {0}, {0}, {6}, {0.3, 0.2, 0.1, 0.1}, {0.7}, {0.5, 0.3, 0.9, 0.2}},
                   channels);
}

// The scatter of a polished surface beside a lobe of facets.
Material Scatter(std::size_t channels) {
  Model model;
  model.lobes = {{Ndf::kAbg, Masking::kNone, Fresnel::kNone}, {Ndf::kGgx}};
  return WithModel(model,
                   {{0.05},
                    {0.05},
                    {0},
                    {0},
                    {0},
                    {1.6},
                    {0.8, 0.5, 0.3},
                    {0.4},
                    {0.4},
                    {0},
                    {0},
                    {0},
                    {0.1, 0.2, 0.1},
                    {0.2, 0.1, 0.3}},
                   channels);
}

// What the page is to show and to compute, for its test of itself.
std::string TruthJson(const ReportData& data) {
  constexpr int kSize = 40;
  const ChannelColor to_color(data.measurement.channels);
  const auto light = [&](int size) {
    return LightSphere(Shown(data.fitted), to_color, data.channels(), LitRows(size));
  };
  const double exposure = SphereExposure(light(128));
  std::string bytes;
  for (const auto& color : light(kSize).color) {
    const Rgb c = ToScreen(color, exposure);
    for (const std::uint8_t v : {c.r, c.g, c.b}) bytes.push_back(static_cast<char>(v));
  }
  nlohmann::json check = nlohmann::json::array();
  std::vector<double> f_r(data.channels());
  for (int k = 0; k < 24; ++k) {
    const Vec3 wi = FromSpherical(0.06 * k, 1.1 * k), wo = FromSpherical(1.4 - 0.055 * k, 2.3 * k + 1);
    data.fitted.Evaluate(wi, wo, f_r.data());
    check.push_back({{wi.x, wi.y, wi.z}, {wo.x, wo.y, wo.z}, f_r});
  }
  return nlohmann::json{{"reference", {{"size", kSize}, {"data", Base64(bytes)}}}, {"check", check}}.dump();
}

class HtmlPage : public testing::TestWithParam<PageCase> {
 protected:
  void SetUp() override {
    const PageCase& c = GetParam();
    Material material = c.material != nullptr ? c.material(c.channels) : test::MakeMaterial(c.channels, c.isotropic);
    material.source.file = "odd <name> & \"more\".csv";
    Measurement measurement =
        test::Measure(material, c.table ? test::TablePairs() : test::GoniometerPairs(c.out_of_plane), 0.05, c.table);
    if (c.hostile) {
      // What a measurement file can call its channels, its sample and itself.
      const std::vector<std::string> names = {
          "<img src=x onerror=\"document.title='RAN'\">", "</script><script>alert(1)</script>",
          "<svg onload=alert(2)> & ' \" \\ \n {{title}} \xff " + std::string(10000, 'n')};
      material.channels = measurement.channels.names = names;
      material.source.file = measurement.source = names[0] + names[1] + names[2];
      material.recipe_name = material.recipe_reason = names[1];
      material.remarks = names;
    }
    path_ = TemporaryPath(std::string(c.name) + ".report.html");
    WriteReportHtml(material, measurement, path_, {.threads = 2, .scale = 1, .font_folders = {}});
    truth_ = TruthJson(ReportData(material, measurement, 2));
  }
  void TearDown() override { std::filesystem::remove(path_); }

  static std::filesystem::path TemporaryPath(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / ("page_" + std::to_string(getpid()) + "_" + name);
  }

  std::string Html() const { return std::string(FileBytes(path_).bytes()); }

  // The page's own account of itself, or "" without a browser.
  std::string Visit(const std::string& flags) const {
    const std::string script(FileBytes(test::SourceDir() / "tests/report/web/page_selftest.js").bytes());
    return test::VisitPage(Html(), "const truth = " + truth_ + ";\n" + script, path_, flags);
  }

  std::filesystem::path path_;
  std::string truth_;
};

TEST_P(HtmlPage, IsOneSmallFileThatNamesNoOther) {
  const std::string html = Html();
  EXPECT_LT(html.size(), 3000000U);
  for (const char* remote : {"http://", "https://", "@import", "src=\"/", "href=\"/", "fetch(", "XMLHttpRequest"})
    EXPECT_THAT(html, Not(HasSubstr(remote)));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, Not(HasSubstr("unsafe-inline")));
  for (const char* hook : {"selftest", "innerHTML", "{{"}) EXPECT_THAT(html, Not(HasSubstr(hook)));
  EXPECT_THAT(html, HasSubstr("odd &lt;name&gt; &amp; &quot;more&quot;.csv"));
  EXPECT_THAT(html, HasSubstr("<img alt=\"In-plane curves: "));
}

TEST_P(HtmlPage, LivesInABrowser) {
  const std::string result = Visit("");
  if (result.empty()) GTEST_SKIP() << "Chromium is not installed";
  EXPECT_THAT(result, HasSubstr("\"webgl\":true"));
  EXPECT_EQ(NumberAfter(result, "requests"), 0) << result;
  EXPECT_EQ(NumberAfter(result, "dialogs"), 0) << result;
  EXPECT_EQ(NumberAfter(result, "elements"), 0) << result;
  EXPECT_THAT(result, HasSubstr("\"violations\":[]"));
  // The fitted sphere against the program's own picture: 2 % of the range.
  EXPECT_LE(NumberAfter(result, "sphereWorst"), 0.02) << result;
  EXPECT_GE(NumberAfter(result, "differsFromBackground"), 0.5) << result;
  EXPECT_GE(NumberAfter(result, "sliderChanges"), 0.02) << result;
  EXPECT_THAT(result, HasSubstr("\"resetRestores\":true"));
  EXPECT_THAT(result, HasSubstr("\"sliceFollows\":true"));
  EXPECT_THAT(result, HasSubstr("\"scaleFollows\":true"));
  EXPECT_THAT(result, HasSubstr("\"sliderMovesSlice\":true"));
  EXPECT_THAT(result, HasSubstr("\"lightChanges\":true"));
  EXPECT_THAT(result, HasSubstr("measured"));
  // The shader, in single precision, against values of the program. Facets are summed by a coarser rule.
  const bool facets =
      GetParam().material == TwoBeckmannLobesOverFacets || GetParam().material == TiltedConductorOverFacets;
  EXPECT_LE(NumberAfter(result, "modelWorst"), facets ? 0.02 : 1e-3) << result;
  // Every control has a name that a screen reader says.
  EXPECT_EQ(NumberAfter(result, "unnamed"), 0) << result;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, HtmlPage,
    testing::Values(PageCase{"table_rgb", 3, true, true, true}, PageCase{"goniometer_spectral", 12, false, false, true},
                    PageCase{"in_plane_mono", 1, false, false, false},
                    PageCase{"two_beckmann_lobes_over_facets", 3, false, false, true, TwoBeckmannLobesOverFacets},
                    PageCase{"spectral_conductor_over_facets", 5, false, false, false, TiltedConductorOverFacets},
                    PageCase{"scatter", 3, false, false, true, Scatter},
                    PageCase{"profile_student_and_retro", 3, false, false, true, ProfileStudentAndRetro},
                    PageCase{"spectral_student_over_oren_nayar", 4, false, false, true, StudentOverOrenNayar},
                    PageCase{"coated", 3, false, false, true, Coated}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

class HostilePage : public HtmlPage {};

TEST_P(HostilePage, IsTextAndNothingElse) {
  const std::string html = Html();
  for (const char* live : {"<img src=x", "<svg onload", "</script><script>alert", "\xff"})
    EXPECT_THAT(html, Not(HasSubstr(live)));
  const std::string result = Visit("");
  if (result.empty()) GTEST_SKIP() << "Chromium is not installed";
  EXPECT_THAT(result, HasSubstr("\"webgl\":true"));
  EXPECT_EQ(NumberAfter(result, "requests"), 0) << result;
  EXPECT_EQ(NumberAfter(result, "dialogs"), 0) << result;
  EXPECT_EQ(NumberAfter(result, "elements"), 0) << result;
  EXPECT_THAT(result, HasSubstr("\"violations\":[]"));
  EXPECT_THAT(result, Not(HasSubstr("\"title\":\"RAN")));
  EXPECT_LE(NumberAfter(result, "modelWorst"), 1e-3) << result;
}

TEST_P(HostilePage, HasAShaderThatCompiles) {
  if (std::system("command -v glslangValidator >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "glslangValidator is not installed";
  const std::string html = Html(), mark = "<script id=\"shader\" type=\"text/plain\">";
  const std::size_t begin = html.find(mark) + mark.size();
  const std::filesystem::path shader = path_.string() + ".frag";
  WriteFileAtomically(shader, html.substr(begin, html.find("</script>", begin) - begin));
  EXPECT_THAT(OutputOf("glslangValidator '" + shader.string() + "' 2>&1 || true"), Not(HasSubstr("ERROR")));
  std::filesystem::remove(shader);
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostilePage, testing::Values(PageCase{"hostile", 3, true, true, true, nullptr, true}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

class HtmlPageWithoutWebGl : public HtmlPage {};

TEST_P(HtmlPageWithoutWebGl, KeepsPicturesAndSlices) {
  const std::string result = Visit("--disable-3d-apis");
  if (result.empty()) GTEST_SKIP() << "Chromium is not installed";
  EXPECT_THAT(result, HasSubstr("\"webgl\":false"));
  EXPECT_THAT(result, HasSubstr("\"sliceFollows\":true"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, HtmlPageWithoutWebGl, testing::Values(PageCase{"table_rgb_plain", 3, true, true, true}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(HtmlPageOfAModelThatIsNotLive, HoldsPicturesOnly) {
  Material material = test::MakeMaterial(1, false);
  const Measurement measurement = test::Measure(material, test::GoniometerPairs(true), 0.05, false);
  material.model.lobes[0].ndf = Ndf::kKagiwadaKalaba;
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("not_live_" + std::to_string(getpid()) + ".html");
  WriteReportHtml(material, measurement, path, {.threads = 2, .scale = 1, .font_folders = {}});
  const std::string html(FileBytes(path).bytes());
  EXPECT_THAT(html, HasSubstr("<img alt=\"In-plane curves: "));
  EXPECT_THAT(html, HasSubstr("shown in pictures only"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">alpha_x</th>"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("id=\"sliders\"")));
}

}  // namespace
}  // namespace lobefit
