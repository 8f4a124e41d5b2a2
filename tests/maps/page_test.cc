// The page of maps: what stands in the file, and, where Chromium is installed, what it does in a browser.
#include <utility>

#include "tests/maps/texels.h"
#include "tests/support/browser_page.h"
#include "tests/support/folder_test.h"
#include "tests/support/paths.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/text/base64.h"
#include "lobefit/maps/report/tiles.h"
#include "lobefit/maps/report/web/html.h"
#include "lobefit/plot/color.h"

namespace lobefit {
namespace {

using testing::HasSubstr;
using testing::Not;

class MapsPageTest : public FolderTest, public testing::WithParamInterface<MapLobe> {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    hills_ = MakeHills(24, GetParam());
    StackSynthesis synthesis;
    synthesis.lights = DomeLights(8, 65 * kPi / 180);
    WriteStack(hills_.maps, synthesis, folder_ / "s");
    stack_ = OpenStack(folder_ / "s", {});
    // A texel outside, one without a normal, one whose width is not known.
    const auto plane = [&](const char* name) { return PlaneIndex(hills_.maps.planes, MapPart::kParameters, name); };
    hills_.maps.rows.values.back()[5] = kMapOutside;
    for (const char* name : {"normal.x", "normal.y", "normal.z"}) hills_.maps.rows.values[plane(name)][100] = NAN;
    hills_.maps.rows.values[plane(GetParam() == MapLobe::kGgx ? "alpha" : "alpha_x")][200] = NAN;
    page_.title = "odd <name> & \"more\"";
    page_.fallback = MedianFallback(hills_.maps);
    page_.lights = JudgeLights(hills_.maps, stack_, {3}, page_.fallback).lights;
    html_ = MapsHtml(hills_.maps, stack_, page_);
  }

  // The program's own picture under a light with the page's exposure.
  nlohmann::json Truth(const Vec3& light, double exposure) {
    Relighting relighting(hills_.maps, {{light}, {}}, true, page_.fallback);
    std::string bytes;
    for (std::size_t t = 0; t < 24 * 24; ++t) {
      double values[3];
      relighting.Texel(t, values, 1);
      const Rgb c = std::isnan(values[0]) ? Rgb{} : ToScreen({values[0], values[1], values[2]}, exposure);
      for (const std::uint8_t v : {c.r, c.g, c.b}) bytes.push_back(static_cast<char>(v));
    }
    return {{"light", {light.x, light.y, light.z}}, {"picture", Base64(bytes)}};
  }

  Hills hills_;
  Stack stack_;
  MapsPage page_;
  std::string html_;
};
// The shader has one formula for both; the round lobe is its special case.
INSTANTIATE_TEST_SUITE_P(Lobes, MapsPageTest, testing::Values(MapLobe::kGgxAnisotropic));

TEST_P(MapsPageTest, IsOneFileThatNamesNoOther) {
  for (const char* remote : {"http://", "https://", "@import", "src=\"/", "href=\"/", "fetch(", "unsafe-inline", "{{"})
    EXPECT_THAT(html_, Not(HasSubstr(remote)));
  EXPECT_THAT(html_, HasSubstr("default-src 'none'"));
  EXPECT_THAT(html_, HasSubstr("odd &lt;name&gt; &amp; &quot;more&quot;"));
  EXPECT_THAT(html_, HasSubstr("<img alt=\"Normal: x right: red, y up: green, z to the camera: blue\""));
  EXPECT_THAT(html_, HasSubstr("<tr><th scope=\"row\">left out</th><td>1</td>"));
  EXPECT_THAT(html_, HasSubstr("<tr><th scope=\"row\">fitted</th><td>575</td><td>100.0 %</td></tr>"));
}

TEST_P(MapsPageTest, PhotographsStandBesideTheirFit) {
  // With clusters there is one tile more before them.
  Maps clustered = hills_.maps;
  clustered.planes.push_back({MapPart::kQuality, "cluster", MapType::kFloat});
  clustered.rows.values.push_back(clustered.rows.values.back());
  for (const Maps* maps : {&std::as_const(hills_.maps), &std::as_const(clustered)}) {
    const std::vector<Tile> tiles = ReportTiles(*maps, stack_, page_);
    std::size_t pairs = 0;
    for (std::size_t k = 0; k + 1 < tiles.size(); ++k) {
      if (!tiles[k].title.starts_with("Photograph")) continue;
      ++pairs;
      EXPECT_THAT(tiles[k + 1].title, testing::StartsWith("Fit"));
      EXPECT_LT(k % kTileColumns, static_cast<std::size_t>(kTileColumns - 1));
    }
    EXPECT_EQ(pairs, 2U);
  }
}

TEST_P(MapsPageTest, RelightsInABrowserAsTheProgramDoes) {
  const std::string mark = "application/json\">";
  const std::size_t begin = html_.find(mark) + mark.size();
  const nlohmann::json data = nlohmann::json::parse(html_.substr(begin, html_.find("</script>", begin) - begin));
  EXPECT_EQ(data["first"], 3);  // the light that was left out
  const double exposure = data["exposure"].get<double>();
  const nlohmann::json truth = {Truth(Normalized(Vec3{0.5, 0.3, 1}), exposure),
                                Truth(Normalized(Vec3{-1, 0.2, 0.4}), exposure)};
  const std::string script = std::string(FileBytes(test::SourceDir() / "tests/maps/page_selftest.js").bytes());
  const std::string result = test::VisitPage(html_, "const truth = " + truth.dump() + ";\n" + script, folder_ / "page");
  if (result.empty()) GTEST_SKIP() << "Chromium is not installed";
  EXPECT_THAT(result, HasSubstr("\"webgl\":true"));
  EXPECT_THAT(result, HasSubstr("\"failure\":\"\""));
  EXPECT_THAT(result, HasSubstr("\"violations\":[]"));
  EXPECT_EQ(test::NumberAfter(result, "requests"), 0) << result;
  EXPECT_EQ(test::NumberAfter(result, "unnamed"), 0) << result;
  // Half precision of the maps, single of the shader.
  EXPECT_LE(test::NumberAfter(result, "relitWorst"), 4) << result;
  EXPECT_LE(test::NumberAfter(result, "relitMean"), 0.3) << result;
  EXPECT_GE(test::NumberAfter(result, "lit"), 0.5) << result;
  EXPECT_THAT(result, HasSubstr("\"photographFollows\":true"));
  EXPECT_NEAR(test::NumberAfter(result, "draggedX"), 0.8, 0.02) << result;
  EXPECT_THAT(result, HasSubstr("\"chosen\":\"\""));
  EXPECT_THAT(result, HasSubstr("\"exposureDarkens\":true"));
}

}  // namespace
}  // namespace lobefit
