// A model with its parameters filled in: what reports draw, synthesis samples and exporters tabulate.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/brdf/diffuse_facets.h"
#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/brdf/model.h"

namespace lobefit {

// f_r = diffuse part + sum over lobes of F D G2 / (4 cos_theta_i cos_theta_o) [Walter eq 4-6], model.h; below a coat as
// coat.h has it.
class Reflectance {
 public:
  // `values` in the order of Parameters(model), inside units (radians). Throws std::invalid_argument where their number
  // or the number of channels does not fit.
  Reflectance(const Model& model, const ParameterValues& values, std::size_t channels);

  std::size_t channels() const { return channels_; }

  // f_r[c], 1/sr, for unit directions away from the surface; 0 where one of them is at or below the horizon.
  void Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const;

  // The same for arrays of directions, all above the horizon: f_r[c][i]. Same bits as Evaluate.
  void Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const;

  // One a lobe: the ellipses, and all of the shapes.
  const std::vector<SlopeCoordinates>& lobe_shapes() const { return ellipses_; }
  const std::vector<LobeShape>& shapes() const { return shapes_; }

 private:
  // `diffuse`: f_r of the diffuse part. `passage`: null without a coat.
  double Channel(std::size_t channel, const double* specular, const double* cos_d, double diffuse,
                 const CoatPassage* passage) const;
  // `facets`: of albedo 1, where there are some.
  bool HasCoat() const { return coat_ < shapes_.size(); }
  bool IsRefracted() const { return model_.lobes[coat_].fresnel == Fresnel::kCoatRefracted; }
  double DiffusePart(std::size_t channel, const Vec3& wi, const Vec3& wo, double facets) const;

  Model model_;
  std::size_t channels_;
  std::vector<SlopeCoordinates> ellipses_;
  std::vector<LobeShape> shapes_;
  std::vector<std::vector<std::vector<double>>> fresnel_;  // parameters, [lobe][channel]
  std::vector<double> albedo_;                             // [channel]; zero without a diffuse part
  std::vector<DirectionalDiffuse> directional_;            // [channel]; empty where the kind is none of these
  std::shared_ptr<const DiffuseFacets> facets_;            // null: none
  std::size_t coat_;                                       // CoatOf(model)
  double unit_diffuse_ = kInvPi;                           // f_r of a Lambertian part of albedo 1
};

}  // namespace lobefit
