#include "lobefit/renderer/fitted_brdf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/ellipsoid/ellipsoid_symmetry.h"
#include "lobefit/math/directions.h"

namespace lobefit {

bool IsRgbOrGrey(const Channels& channels) {
  return channels.names == std::vector<std::string>{"R", "G", "B"} ||
         (channels.size() == 1 && channels.wavelengths_nm.empty());
}

FittedBrdf::FittedBrdf(Material material)
    : material_(std::move(material)),
      reflectance_(
          std::make_shared<const Reflectance>(material_.model, material_.Values(), material_.channels.size())) {
  for (std::size_t l = 0; l < material_.model.lobes.size(); ++l) {
    const FittedParameter* shape = &material_.parameters[FirstParameter(material_.model, l)];
    const Ellipsoid ellipsoid = CanonicalEllipsoid(
        {shape[0].values[0], shape[1].values[0], shape[2].values[0], shape[3].values[0], shape[4].values[0]});
    const Mat3 frame = EllipsoidRotation(ellipsoid);
    FittedLobe lobe;
    lobe.choices = material_.model.lobes[l];
    lobe.retro = lobe.choices.direction == LobeDirection::kRetro;
    lobe.widths = {ellipsoid.alpha_x, ellipsoid.alpha_y};
    lobe.anisotropic = ellipsoid.alpha_x - ellipsoid.alpha_y > 1e-9 * ellipsoid.alpha_x;
    lobe.axis = frame.row[2];
    lobe.tilt = PolarAngle(lobe.axis);
    // The tangent in the surface whose part across the axis is along the ellipsoid's first axis.
    const Vec3 along = frame.row[0] - (frame.row[0].z / lobe.axis.z) * lobe.axis;
    lobe.rotation = lobe.anisotropic ? std::atan2(along.y, along.x) : 0.0;
    // A line has no direction: (-pi/2, pi/2].
    if (lobe.rotation > kPi / 2) lobe.rotation -= kPi;
    if (lobe.rotation <= -kPi / 2) lobe.rotation += kPi;
    lobes_.push_back(lobe);
  }
  diffuse_.assign(material_.channels.size(), 0.0);
  if (material_.model.diffuse != Diffuse::kNone) diffuse_ = material_.parameters.back().values;
}

BrdfFunction FittedBrdf::function() const {
  return [reflectance = reflectance_](const Vec3& wi, const Vec3& wo, double* values) {
    reflectance->Evaluate(wi, wo, values);
  };
}

double FittedBrdf::Fresnel(std::size_t lobe, std::size_t channel, double cos_d) const {
  const lobefit::Fresnel fresnel = lobes_[lobe].choices.fresnel;
  const std::size_t first = FirstFresnel(material_.model, lobe);
  std::array<double, kMaxFresnelParameters> parameters = {};
  for (std::size_t k = 0; k < FresnelParameters(fresnel); ++k) {
    parameters[k] = material_.parameters[first + k].values[channel];
  }
  return FresnelFactor(fresnel, parameters.data(), cos_d, nullptr);
}

bool FittedBrdf::IsTilted() const {
  return std::any_of(lobes_.begin(), lobes_.end(), [](const FittedLobe& lobe) { return lobe.tilt > 1e-6; });
}

bool FittedBrdf::IsAnisotropic() const {
  return std::any_of(lobes_.begin(), lobes_.end(), [](const FittedLobe& lobe) { return lobe.anisotropic; });
}

bool FittedBrdf::HasOnlyGgx() const {
  return std::all_of(lobes_.begin(), lobes_.end(),
                     [](const FittedLobe& lobe) { return FamilyOf(lobe.choices.ndf) == Family::kGgx; });
}

bool FittedBrdf::HasDiffuse() const {
  return std::any_of(diffuse_.begin(), diffuse_.end(), [](double albedo) { return albedo != 0; });
}

}  // namespace lobefit
