#include "lobefit/core/brdf/brdf.h"

#include <stdexcept>

#include "lobefit/core/brdf/lobe.h"

namespace lobefit {

Reflectance::Reflectance(const Model& model, const ParameterValues& values, std::size_t channels)
    : model_(model), channels_(channels), diffuse_(channels, 0.0) {
  const std::vector<Parameter> parameters = Parameters(model);
  if (values.size() != parameters.size()) throw std::invalid_argument("Reflectance: wrong number of parameters");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].size() != (parameters[i].per_channel ? channels : 1)) {
      throw std::invalid_argument("Reflectance: wrong number of values of " + parameters[i].name);
    }
  }
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    const std::size_t at = FirstParameter(model, lobe);
    const Ellipsoid ellipsoid = {values[at][0], values[at + 1][0], values[at + 2][0], values[at + 3][0],
                                 values[at + 4][0]};
    shapes_.push_back(SlopeCoordinatesFromEllipsoid(ellipsoid));
    fresnel_.emplace_back(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < FresnelParameters(model.lobes[lobe].fresnel); ++k)
        fresnel_.back()[c].push_back(values[at + kShapeParameters + k][c]);
    }
  }
  if (model.diffuse != Diffuse::kNone) diffuse_ = values.back();
  if (model.diffuse == Diffuse::kMicrofacet) facets_ = std::make_shared<DiffuseFacets>(model.lobes[0], shapes_[0]);
}

double Reflectance::Channel(std::size_t channel, const double* specular, const double* cos_d, double diffuse) const {
  double f_r = diffuse_[channel] * diffuse;
  for (std::size_t lobe = 0; lobe < shapes_.size(); ++lobe) {
    f_r += specular[lobe] *
           FresnelFactor(model_.lobes[lobe].fresnel, fresnel_[lobe][channel].data(), cos_d[lobe], nullptr);
  }
  return f_r;
}

void Reflectance::Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const {
  const bool visible = wi.z > 0 && wo.z > 0;
  std::vector<double> specular(shapes_.size()), cos_d(shapes_.size());
  for (std::size_t lobe = 0; visible && lobe < shapes_.size(); ++lobe)
    specular[lobe] = SpecularLobe(wi, wo, model_.lobes[lobe], shapes_[lobe], &cos_d[lobe], nullptr);
  const double diffuse = visible && facets_ ? facets_->Evaluate(wi, wo, nullptr) : kInvPi;
  for (std::size_t c = 0; c < channels_; ++c)
    f_r[c] = visible ? Channel(c, specular.data(), cos_d.data(), diffuse) : 0.0;
}

void Reflectance::Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const {
  const std::size_t count = directions.count, lobes = shapes_.size();
  std::vector<std::vector<double>> specular(lobes, std::vector<double>(count)),
      cos_d(lobes, std::vector<double>(count));
  for (std::size_t lobe = 0; lobe < lobes; ++lobe)
    SpecularLobe(directions, model_.lobes[lobe], shapes_[lobe], specular[lobe].data(), cos_d[lobe].data(), nullptr);
  std::vector<double> diffuse(count, kInvPi);
  if (facets_) facets_->Evaluate(directions, diffuse.data(), nullptr);
  f_r->assign(channels_, std::vector<double>(count));
  std::vector<double> s(lobes), d(lobes);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      s[lobe] = specular[lobe][i];
      d[lobe] = cos_d[lobe][i];
    }
    for (std::size_t c = 0; c < channels_; ++c) (*f_r)[c][i] = Channel(c, s.data(), d.data(), diffuse[i]);
  }
}

}  // namespace lobefit
