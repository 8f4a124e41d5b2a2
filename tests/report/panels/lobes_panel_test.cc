// Reports of tables of squared ellipsoidal lobes.
#include <cmath>

#include "tests/report/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/report/panels/page.h"
#include "lobefit/report/web/html.h"

namespace lobefit {
namespace {

// A lobe that grows narrower and brighter with the incidence.
Material LobesOf(bool isotropic) {
  Material material;
  material.model.diffuse = Diffuse::kNone;
  material.channels = test::ChannelNames(3);
  material.sel = SelTable{SelQuantity::kBrdf, isotropic, false, {}};
  for (const double theta : {10., 30., 50., 70.}) {
    for (const double phi : {0., 90.}) {
      if (isotropic && phi > 0) continue;
      material.sel->slices.push_back({DegreesToRadians(theta),
                                      DegreesToRadians(phi),
                                      {{0.3 - 0.002 * theta, 0.2, 0.05, 0, 0.1}},
                                      {{1 + 0.05 * theta, 1, 0.8}},
                                      {0.1, 0.1, 0.05}});
    }
  }
  material.errors = {{"log", 0.01}};
  material.metric = "log";
  material.termination = {true, true, "every incident direction converged", 9};
  return material;
}

Measurement MeasureLobes(const Material& material, bool maps, double noise) {
  const SelReflectance table(*material.sel);
  Measurement measurement = test::Measure(test::MakeMaterial(3, true), test::GoniometerPairs(maps), 0, false);
  test::Noise random(noise);
  Samples& samples = measurement.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double f_r[3];
    table.Evaluate(samples.wi(i), samples.wo(i), f_r);
    for (std::size_t c = 0; c < 3; ++c) samples.values[c][i] = f_r[c] * random.Factor();
  }
  measurement.isotropic = material.sel->isotropic;
  return measurement;
}

TEST(LobesPanel, ReportsOfTablesHaveTheLobesAndNoPanelOfModels) {
  for (const bool isotropic : {true, false}) {
    const Material material = LobesOf(isotropic);
    const Measurement measurement = MeasureLobes(material, true, 0.02);
    std::vector<std::string> ids;
    const ReportData data(material, measurement, 2);
    DrawPage(data, 1, std::make_shared<Fonts>(), &ids);
    for (const char* present : {"curves", "lobes", "quality", "maps", "residuals"}) {
      EXPECT_THAT(ids, testing::Contains(present));
    }
    for (const char* absent : {"parameters", "ndf", "energy", "correlation", "sphere"}) {
      EXPECT_THAT(ids, testing::Not(testing::Contains(absent)));
    }
  }
}

TEST(LobesPanel, FittedValuesAreThoseOfTheTable) {
  const Material material = LobesOf(false);
  const Measurement measurement = MeasureLobes(material, true, 0);
  const ReportData data(material, measurement, 2);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < measurement.samples.size(); ++i) {
      ASSERT_NEAR(data.fitted_values[c][i] / measurement.samples.values[c][i], 1, 1e-6) << i;
    }
  }
}

TEST(LobesPanel, ThePageHasPicturesOnly) {
  const Material material = LobesOf(true);
  const Measurement measurement = MeasureLobes(material, false, 0.02);
  const ReportData data(material, measurement, 2);
  const std::string html = ReportHtml(data, MakePanels(data), std::make_shared<Fonts>());
  EXPECT_THAT(html, testing::HasSubstr("<figure id=\"lobes\">"));
  EXPECT_THAT(html, testing::HasSubstr("squared ellipsoidal lobes for each incident direction"));
  EXPECT_THAT(html, testing::Not(testing::HasSubstr("<canvas")));
}

}  // namespace
}  // namespace lobefit
