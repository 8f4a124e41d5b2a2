// What an instrument reads of a fitted surface, against quadrature over the discs that knows nothing of lobes.
#include "lobefit/fit/objective/reading.h"

#include <cmath>

#include "tests/support/checked_fit.h"
#include "tests/support/synthetic.h"
#include <gtest/gtest.h>

#include "lobefit/fit/fit.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/math/directions.h"
#include "lobefit/synthesis/instrument.h"

namespace lobefit {
namespace {

Material MaterialOf(const SyntheticCase& truth) {
  Material material;
  material.model = truth.model;
  material.channels = truth.channels;
  for (const std::vector<double>& values : truth.values)
    material.parameters.push_back({values, {}, {}, {}, {}, true, false});
  return material;
}

Material BrushedMaterial() {
  return MaterialOf(OneLobe(Ndf::kEllipsoid, 0.35, 0.11, 0, 3, 25, {0.7, 0.4}, {0.02, 0.1}));
}

BrdfFunction SurfaceOf(const Material& material) {
  const auto reflectance = std::make_shared<Reflectance>(material.model, material.Values(), material.channels.size());
  return [reflectance](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance->Evaluate(wi, wo, f_r); };
}

std::vector<double> Read(const Reading& reading, const Vec3& wi, const Vec3& wo, double azimuth) {
  std::vector<std::vector<double>> values;
  reading.Evaluate({&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z, 1}, &azimuth, &values);
  return {values[0][0], values[1][0]};
}

TEST(Reading, IsTheSurfaceThroughDiscsAlignmentGainAndOffset) {
  Material material = BrushedMaterial();
  InstrumentUsed instrument;
  instrument.source = DegreesToRadians(0.5);
  instrument.detector = DegreesToRadians(2);
  instrument.mean = "flux";
  const double e_x = DegreesToRadians(0.8), e_y = DegreesToRadians(-0.5);
  instrument.alignment = {{"e_x", e_x, 0, 0, 0}, {"e_y", e_y, 0, 0, 0}};
  instrument.azimuths = {0};
  instrument.gains = {{DegreesToRadians(60), 0, 0.9, 0}, {DegreesToRadians(30), DegreesToRadians(40), 1.1, 0}};
  instrument.offset = {{0.01, 0}, {0.02, 0}};
  material.instrument = instrument;
  const Reading reading(material, Beam::kLight), without_gains(material, std::nullopt);
  const BrdfFunction seen = WithAperture(WithMisalignment(SurfaceOf(material), e_x, e_y, 2),
                                         {instrument.source, instrument.detector, ApertureMean::kFlux}, 2, 0.1);
  const Vec3 lights[] = {FromSpherical(DegreesToRadians(60), 0),
                         FromSpherical(DegreesToRadians(30.1), DegreesToRadians(40)),
                         FromSpherical(DegreesToRadians(30), DegreesToRadians(50))};
  const double gains[] = {0.9, 1.1, 1};
  const Vec3 wo = FromSpherical(DegreesToRadians(35), DegreesToRadians(200));
  for (std::size_t k = 0; k < 3; ++k) {
    double expected[2];
    seen(lights[k], wo, expected);
    const std::vector<double> with = Read(reading, lights[k], wo, 0), plain = Read(without_gains, lights[k], wo, 0);
    for (std::size_t c = 0; c < 2; ++c) {
      const double offset = instrument.offset[c].value / lights[k].z;
      // The cosines of the discs' rim are those of the sample's frame: 1e-3 at 0.8 degrees.
      EXPECT_NEAR(with[c], gains[k] * expected[c] + offset, 2e-3 * expected[c]) << k;
      EXPECT_NEAR(plain[c], expected[c] + offset, 2e-3 * expected[c]) << k;
    }
  }
}

// A sample that is crooked on its stage and then turned by half leans the other way in its own frame.
TEST(Reading, TurnsAreToldByTheSamplesAzimuth) {
  Material material = BrushedMaterial();
  InstrumentUsed instrument;
  instrument.mean = "flux";
  const double e_x = DegreesToRadians(1);
  instrument.alignment = {{"e_x", e_x, 0, 0, 0}, {"e_y", 0, 0, 0, 0}, {"e_z[2]", 0, 0, 0, 0}};
  instrument.azimuths = {0, kPi};
  material.instrument = instrument;
  const Reading reading(material, Beam::kLight);
  const Vec3 wi = FromSpherical(0.5, 0.3), wo = FromSpherical(0.6, 3.5);
  for (const auto& [azimuth, angle] : {std::pair{0.0, e_x}, {kPi, -e_x}}) {
    double expected[2];
    WithMisalignment(SurfaceOf(material), angle, 0, 2)(wi, wo, expected);
    EXPECT_NEAR(Read(reading, wi, wo, azimuth)[0], expected[0], 1e-10 * expected[0]) << azimuth;
  }
}

// What stands in pictures is what the fit minimised.
TEST(Reading, OfAFitHasItsError) {
  const SyntheticCase truth = OneLobe(Ndf::kEllipsoid, 0.3, 0.06, 0, 0, 25, {0.7}, {0.02});
  GoniometerLayout layout;
  for (const double degrees : {15., 35., 55.}) layout.polar_angles.push_back(DegreesToRadians(degrees));
  layout.azimuths = {0, DegreesToRadians(60)};
  layout.detector_step = DegreesToRadians(10);
  Noise noise;
  noise.aperture = DegreesToRadians(3);
  noise.multiplicative = 0.02;
  noise.drift = 0.05;
  Measurement measurement =
      Synthesise(Goniometer(layout), {truth.channels, {}}, SurfaceOf(MaterialOf(truth)), noise, 3);
  measurement.source = "synthetic";
  Recipe recipe = DefaultRecipe(truth.model, "reading");
  recipe.metric = Metric::kRelative;
  recipe.instrument.detector = noise.aperture;
  recipe.instrument.drift = DriftRecipe{};
  const Material fitted = CheckedFit(recipe, {}, &measurement);
  const Samples& s = measurement.samples;
  std::vector<std::vector<double>> readings;
  Reading(fitted, measurement.listed_side)
      .Evaluate({s.wi_x.data(), s.wi_y.data(), s.wi_z.data(), s.wo_x.data(), s.wo_y.data(), s.wo_z.data(), s.size()},
                nullptr, &readings);
  const double rms = std::sqrt(SumSquares(Metric::kRelative, {}, Weighting::kCells, false, s, readings).MeanSquare());
  double stated = 0;
  for (const MetricError& error : fitted.errors) stated = error.metric == "relative" ? error.rms : stated;
  EXPECT_NEAR(rms, stated, 1e-6 * stated);
  EXPECT_LT(rms, 0.025);
}

}  // namespace
}  // namespace lobefit
