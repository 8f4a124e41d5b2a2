// Synthetic measurements of a known model, for tests of fits and reports.
#pragma once

#include <vector>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {

struct SyntheticCase {
  Model model;
  ParameterValues values;
  std::vector<std::string> channels = {"R", "G", "B"};
};

// One lobe and a Lambertian part; angles in degrees.
inline SyntheticCase OneLobe(Ndf ndf, double alpha_x, double alpha_y, double theta_x_deg, double theta_y_deg,
                             double theta_z_deg, std::vector<double> f0 = {0.7, 0.6, 0.5},
                             std::vector<double> diffuse = {0.1, 0.05, 0.02}) {
  SyntheticCase synthetic;
  synthetic.model.lobes = {Lobe{ndf, Masking::kSmithSeparable, Fresnel::kSchlick}};
  synthetic.values = {{alpha_x},
                      {alpha_y},
                      {DegreesToRadians(theta_x_deg)},
                      {DegreesToRadians(theta_y_deg)},
                      {DegreesToRadians(theta_z_deg)},
                      f0,
                      diffuse};
  synthetic.channels.resize(f0.size());
  return synthetic;
}

// 12 incident directions at 3 azimuths unless said otherwise.
inline GoniometerLayout StandardLayout() {
  GoniometerLayout layout;
  for (const double degrees : {5., 15., 25., 30., 35., 40., 45., 50., 55., 60., 65., 70.})
    layout.polar_angles.push_back(DegreesToRadians(degrees));
  for (const double degrees : {0., 60., 120.}) layout.azimuths.push_back(DegreesToRadians(degrees));
  layout.detector_step = DegreesToRadians(15);
  return layout;
}

inline Measurement Synthetic(const SyntheticCase& synthetic, const GoniometerLayout& layout, double noise,
                             std::uint64_t seed) {
  const Reflectance reflectance(synthetic.model, synthetic.values, synthetic.channels.size());
  Measurement measurement = Synthesise(
      Goniometer(layout), {synthetic.channels, {}},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, {noise, 0}, seed);
  measurement.source = "synthetic";
  return measurement;
}

}  // namespace lobefit
