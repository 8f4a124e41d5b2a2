// The live page: what stands in the file, and, where Chromium is installed, what it does in a browser.
#include "lobefit/report/web/html.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/report/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/base64.h"
#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/report/figures/page.h"
#include "lobefit/report/report.h"
#include "lobefit/report/web/text.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(WebText, EscapesWhatWouldEndItsElement) {
  EXPECT_EQ(JsonString("a\"b\\</script>\n"), "\"a\\u0022b\\u005c\\u003c/script\\u003e\\u000a\"");
  EXPECT_EQ(HtmlText("<b> & \"c\""), "&lt;b&gt; &amp; &quot;c&quot;");
  EXPECT_EQ(JsonString("\xff\xce\xb8"), "\"\xEF\xBF\xBDθ\"");
  EXPECT_EQ(JsonNumber(std::nan("")), "null");
  EXPECT_EQ(JsonNumber(0.1234567, 4), "0.1235");
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

class HtmlPage : public testing::TestWithParam<PageCase> {
 protected:
  void SetUp() override {
    const PageCase& c = GetParam();
    Material material = c.material != nullptr ? c.material(c.channels) : test::MakeMaterial(c.channels, c.isotropic);
    material.source.file = "odd <name> & \"more\".csv";
    const Measurement measurement =
        test::Measure(material, c.table ? test::TablePairs() : test::GoniometerPairs(c.out_of_plane), 0.05, c.table);
    path_ = std::filesystem::path(testing::TempDir()) / (std::string("page_") + c.name + ".report.html");
    WriteReportHtml(material, measurement, path_, {.threads = 2, .scale = 1, .font_folders = {}});
  }

  // The page's own account of a visit with `hash`, or "" without a browser.
  std::string Visit(const std::string& hash) const {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0) return "";
    const std::filesystem::path profile = path_.string() + hash.substr(1) + ".profile";
    const std::string command = Join({"timeout 300 chromium --headless=new --no-sandbox --use-angle=swiftshader "
                                      "--enable-unsafe-swiftshader --disable-quic --no-first-run",
                                      "--disable-background-networking --disable-component-update --disable-sync "
                                      "--virtual-time-budget=10000 --user-data-dir='" +
                                          profile.string() + "'",
                                      "--dump-dom 'file://" + path_.string() + hash + "' 2>/dev/null"},
                                     " ");
    std::string dom;
    std::FILE* pipe = popen(command.c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) dom.push_back(static_cast<char>(c));
    pclose(pipe);
    std::error_code ignored;
    std::filesystem::remove_all(profile, ignored);
    const std::string mark = "<pre id=\"result\">";
    const std::size_t begin = dom.find(mark);
    return begin == std::string::npos
               ? "no result"
               : dom.substr(begin + mark.size(), dom.find("</pre>", begin) - begin - mark.size());
  }

  std::filesystem::path path_;
};

double NumberAfter(const std::string& json, const std::string& key) {
  std::smatch match;
  if (!std::regex_search(json, match, std::regex("\"" + key + "\":([-+.0-9eE]+)"))) return std::nan("");
  return ParseDouble(match[1].str()).value_or(std::nan(""));
}

TEST_P(HtmlPage, IsOneSmallFileThatNamesNoOther) {
  const MappedFile file(path_);
  const std::string html(file.bytes());
  EXPECT_LT(html.size(), 3000000U);
  for (const char* remote : {"http://", "https://", "@import", "src=\"/", "href=\"/", "fetch(", "XMLHttpRequest"})
    EXPECT_THAT(html, Not(HasSubstr(remote)));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html, HasSubstr("odd &lt;name&gt; &amp; &quot;more&quot;.csv"));
  EXPECT_THAT(html, HasSubstr("<img alt=\"In-plane curves: "));
}

TEST_P(HtmlPage, LivesInABrowser) {
  const std::string result = Visit("#selftest");
  if (result.empty()) GTEST_SKIP() << "Chromium is not installed";
  EXPECT_THAT(result, HasSubstr("\"webgl\":true"));
  EXPECT_EQ(NumberAfter(result, "requests"), 0) << result;
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
  const bool facets = GetParam().material != nullptr;
  EXPECT_LE(NumberAfter(result, "modelWorst"), facets ? 0.02 : 1e-3) << result;
  // Every control has a name that a screen reader says.
  EXPECT_EQ(NumberAfter(result, "unnamed"), 0) << result;
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, HtmlPage,
    testing::Values(PageCase{"table_rgb", 3, true, true, true}, PageCase{"goniometer_spectral", 12, false, false, true},
                    PageCase{"in_plane_mono", 1, false, false, false},
                    PageCase{"two_beckmann_lobes_over_facets", 3, false, false, true, TwoBeckmannLobesOverFacets},
                    PageCase{"spectral_conductor_over_facets", 5, false, false, false, TiltedConductorOverFacets}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

class HtmlPageWithoutWebGl : public HtmlPage {};

TEST_P(HtmlPageWithoutWebGl, KeepsPicturesAndSlices) {
  const std::string result = Visit("#nogl");
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
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "not_live.html";
  WriteReportHtml(material, measurement, path, {.threads = 2, .scale = 1, .font_folders = {}});
  const std::string html(MappedFile(path).bytes());
  EXPECT_THAT(html, HasSubstr("<img alt=\"In-plane curves: "));
  EXPECT_THAT(html, HasSubstr("shown in pictures only"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">alpha_x</th>"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("id=\"sliders\"")));
}

}  // namespace
}  // namespace lobefit
