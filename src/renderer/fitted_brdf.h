// A fitted material as exporters see it: its function of directions, and each lobe in the words of renderers.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/material/material.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/renderer/roughness.h"

namespace lobefit {

// R, G, B, or one channel that is no wavelength: what renderers' text formats hold.
bool IsRgbOrGrey(const Channels& channels);

// A specular lobe: widths along its own axes, and where those axes lie.
struct FittedLobe {
  Lobe choices;
  Widths widths;
  Vec3 axis = {0, 0, 1};     // normal of the tilted frame, the third axis of the ellipsoid
  double tilt = 0;           // angle between that and the surface normal, radians
  double rotation = 0;       // azimuth of the tangent whose projection across `axis` is the axis of alpha_1, radians
  bool retro = false;        // about the back direction, which most renderers do not have
  bool anisotropic = false;  // alpha_1 and alpha_2 differ by more than 1e-9 of themselves
};

class FittedBrdf {
 public:
  explicit FittedBrdf(Material material);

  const Material& material() const { return material_; }
  const Reflectance& reflectance() const { return *reflectance_; }
  Channels channels() const { return {material_.channels, material_.wavelengths_nm}; }
  // f_r; owns what it needs.
  BrdfFunction function() const;

  const std::vector<FittedLobe>& lobes() const { return lobes_; }
  // Fresnel factor of a lobe in a channel at the cosine of the angle to the micro normal (the whole factor where the
  // model has a scale in place of F).
  double Fresnel(std::size_t lobe, std::size_t channel, double cos_d) const;
  // Albedo of the diffuse part, one a channel.
  const std::vector<double>& diffuse() const { return diffuse_; }

  bool IsTilted() const;       // a lobe leans by more than 1e-6 rad
  bool IsAnisotropic() const;  // a lobe has two widths
  bool IsIsotropic() const { return !IsTilted() && !IsAnisotropic(); }
  bool HasOnlyGgx() const;
  bool HasDiffuse() const;
  bool IsRgbOrGrey() const { return lobefit::IsRgbOrGrey(channels()); }
  bool IsGrey() const { return material_.channels.size() == 1 && material_.wavelengths_nm.empty(); }

 private:
  Material material_;
  std::shared_ptr<const Reflectance> reflectance_;
  std::vector<FittedLobe> lobes_;
  std::vector<double> diffuse_;
};

}  // namespace lobefit
