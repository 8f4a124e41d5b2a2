#include "lobefit/export/targets/target.h"

#include <array>

namespace lobefit {

const char* NameOf(Feature feature) {
  switch (feature) {
    case Feature::kShape:
      return "shape";
    case Feature::kRotation:
      return "rotation";
    case Feature::kTilt:
      return "tilt";
    case Feature::kNormal:
      return "normal";
    case Feature::kMasking:
      return "masking";
    case Feature::kFresnel:
      return "Fresnel";
    case Feature::kDiffuse:
      return "diffuse";
    case Feature::kCoat:
      return "coat";
    case Feature::kSecondLobe:
      return "second lobe";
    case Feature::kChannels:
      return "channels";
    case Feature::kLobes:
      return "lobes";
    case Feature::kInterpolation:
      return "interpolation";
    case Feature::kBound:
      break;
  }
  return "upper bound of the samples";
}

BrdfFunction InChannelsOf(const FittedBrdf& fit, const BrdfFunction& rgb) {
  if (!fit.IsGrey()) return rgb;
  return [rgb](const Vec3& wi, const Vec3& wo, double* values) {
    std::array<double, 3> all = {};
    rgb(wi, wo, all.data());
    values[0] = all[0];
  };
}

}  // namespace lobefit
