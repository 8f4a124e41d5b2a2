#include "lobefit/core/brdf/brdf.h"

#include <stdexcept>

#include "lobefit/core/brdf/lobe.h"

namespace lobefit {

Reflectance::Reflectance(const Model& model, const ParameterValues& values, std::size_t channels)
    : model_(model), channels_(channels), albedo_(channels, 0.0) {
  const std::vector<Parameter> parameters = Parameters(model);
  if (values.size() != parameters.size()) throw std::invalid_argument("Reflectance: wrong number of parameters");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].size() != (parameters[i].per_channel ? channels : 1)) {
      throw std::invalid_argument("Reflectance: wrong number of values of " + parameters[i].name);
    }
  }
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    shapes_.push_back(ShapeAt(model.lobes[lobe], &values[FirstParameter(model, lobe)]));
    ellipses_.push_back(shapes_.back().slope);
    fresnel_.emplace_back(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < FresnelParameters(model.lobes[lobe].fresnel); ++k)
        fresnel_.back()[c].push_back(values[FirstFresnel(model, lobe) + k][c]);
    }
  }
  if (model.diffuse != Diffuse::kNone) albedo_ = values.back();
  if (model.diffuse == Diffuse::kMicrofacet) facets_ = std::make_shared<DiffuseFacets>(model.lobes[0], ellipses_[0]);
  for (std::size_t c = 0; IsDirectional(model.diffuse) && c < channels; ++c) {
    const double parameters_of_channel[] = {values[values.size() - 2][c], values.back()[c]};
    directional_.emplace_back(model.diffuse, parameters_of_channel);
  }
}

double Reflectance::DiffusePart(std::size_t channel, const Vec3& wi, const Vec3& wo, double facets) const {
  return directional_.empty() ? albedo_[channel] * facets : directional_[channel].Evaluate(wi, wo, nullptr);
}

double Reflectance::Channel(std::size_t channel, const double* specular, const double* cos_d, double diffuse) const {
  double f_r = diffuse;
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
  const double facets = visible && facets_ ? facets_->Evaluate(wi, wo, nullptr) : kInvPi;
  for (std::size_t c = 0; c < channels_; ++c)
    f_r[c] = visible ? Channel(c, specular.data(), cos_d.data(), DiffusePart(c, wi, wo, facets)) : 0.0;
}

void Reflectance::Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const {
  const std::size_t count = directions.count, lobes = shapes_.size();
  std::vector<std::vector<double>> specular(lobes, std::vector<double>(count)),
      cos_d(lobes, std::vector<double>(count));
  for (std::size_t lobe = 0; lobe < lobes; ++lobe)
    SpecularLobe(directions, model_.lobes[lobe], shapes_[lobe], specular[lobe].data(), cos_d[lobe].data(), nullptr);
  std::vector<double> facets(count, kInvPi);
  if (facets_) facets_->Evaluate(directions, facets.data(), nullptr);
  f_r->assign(channels_, std::vector<double>(count));
  std::vector<double> s(lobes), d(lobes);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      s[lobe] = specular[lobe][i];
      d[lobe] = cos_d[lobe][i];
    }
    const Vec3 wi = {directions.wi_x[i], directions.wi_y[i], directions.wi_z[i]};
    const Vec3 wo = {directions.wo_x[i], directions.wo_y[i], directions.wo_z[i]};
    for (std::size_t c = 0; c < channels_; ++c)
      (*f_r)[c][i] = Channel(c, s.data(), d.data(), DiffusePart(c, wi, wo, facets[i]));
  }
}

}  // namespace lobefit
