#include "lobefit/fit/sel/sampling.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/sel/sel_table.h"
#include "lobefit/math/directions.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

struct Traits {
  bool isotropic = true;
  double narrowest = 1;  // width
};

Traits TraitsOf(const Material& material) {
  Traits traits;
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) {
    const FittedParameter* p = &material.parameters[FirstParameter(material.model, l)];
    traits.narrowest = std::min({traits.narrowest, p[0].values[0], p[1].values[0]});
    traits.isotropic =
        traits.isotropic && p[0].values[0] == p[1].values[0] && p[2].values[0] == 0 && p[3].values[0] == 0;
  }
  return traits;
}

// Viewers of one light, given in degrees.
void AddViewers(int theta_deg, int phi_deg, double narrowest, DirectionList* directions) {
  const double limit = std::cos(DegreesToRadians(85));
  const Vec3 wi = FromSpherical(DegreesToRadians(theta_deg), DegreesToRadians(phi_deg));
  const Mat3 to_world = Transposed(MirrorFrame(wi));
  const auto add = [&](const Vec3& wo) {
    if (wo.z > limit) directions->Add(wi, wo);
  };
  add(to_world * Vec3{0, 0, 1});
  constexpr int kRings = 16, kSpokes = 16;
  for (int ring = 0; ring < kRings; ++ring) {
    // Radii from a tenth of the lobe's half width (about twice alpha in wo) to a right angle.
    const double low = std::log(0.2 * narrowest), high = std::log(1.0);
    const double radius = 2 * std::atan(std::exp(low + (high - low) * ring / (kRings - 1)));
    for (int spoke = 0; spoke < kSpokes; ++spoke)
      add(to_world * FromSpherical(radius, 2 * kPi * (spoke + 0.5 * (ring % 2)) / kSpokes));
  }
  for (int theta_o = 0; theta_o <= 80; theta_o += 10) {
    for (int phi_o = 0; phi_o < (theta_o == 0 ? 10 : 360); phi_o += 20)
      add(FromSpherical(DegreesToRadians(theta_o), DegreesToRadians(phi_o + phi_deg)));
  }
}

}  // namespace

Measurement SampleForSel(const Material& material) {
  const Reflectance reflectance(material.model, material.Values(), material.channels.size());
  const Traits traits = TraitsOf(material);
  DirectionList directions;
  for (int theta = 0; theta <= 80; theta += 10) {
    for (int phi = 0; phi < (traits.isotropic || theta == 0 ? 1 : 360); phi += 45)
      AddViewers(theta, phi, traits.narrowest, &directions);
  }
  Measurement measurement = Synthesise(
      directions, {material.channels, material.wavelengths_nm},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, {}, 1);
  measurement.isotropic = traits.isotropic;
  measurement.format = "material";
  return measurement;
}

}  // namespace lobefit
