// A program outside the project: synthesise, fit, compare.
#include <cmath>
#include <cstdio>

#include <lobefit/core/brdf/brdf.h>
#include <lobefit/fit/fit.h>
#include <lobefit/synthesis/synthesis.h>

int main() {
  lobefit::Model model;
  model.lobes = {lobefit::Lobe{}};
  const lobefit::ParameterValues truth = {{0.3}, {0.15}, {0.0}, {0.05}, {0.4}, {0.8}, {0.1}};
  const lobefit::Reflectance reflectance(model, truth, 1);
  lobefit::GoniometerLayout layout;
  layout.polar_angles = {0.2, 0.6, 1.0};
  layout.azimuths = {0.0, 1.0};
  lobefit::Measurement measurement = lobefit::Synthesise(
      lobefit::Goniometer(layout), {{"Y"}, {}},
      [&](const lobefit::Vec3& wi, const lobefit::Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, {}, 1);
  const lobefit::Material material =
      lobefit::Fit(lobefit::AutomaticRecipe(lobefit::TraitsOf(measurement)), {}, &measurement);
  std::printf("alpha_x %.9f\n", material.parameters[0].values[0]);
  return std::fabs(material.parameters[0].values[0] - 0.3) < 1e-8 ? 0 : 1;
}
