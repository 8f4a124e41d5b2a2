#include "lobefit/export/targets/target.h"

#include <array>

namespace lobefit {

BrdfFunction InChannelsOf(const FittedBrdf& fit, const BrdfFunction& rgb) {
  if (fit.material().channels.size() >= 3) return rgb;
  return [rgb](const Vec3& wi, const Vec3& wo, double* values) {
    std::array<double, 3> all = {};
    rgb(wi, wo, all.data());
    values[0] = all[0];
  };
}

}  // namespace lobefit
