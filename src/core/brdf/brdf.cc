#include "lobefit/core/brdf/brdf.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lobefit/core/brdf/lobe.h"

namespace lobefit {

Reflectance::Reflectance(const Model& model, const ParameterValues& values, std::size_t channels)
    : model_(model), channels_(channels), albedo_(channels, 0.0), coat_(CoatOf(model)) {
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
  if (HasCoat()) unit_diffuse_ = LambertBelowCoat(fresnel_[coat_][0][0], IsRefracted());
}

double Reflectance::DiffusePart(std::size_t channel, const Vec3& wi, const Vec3& wo, double facets) const {
  return directional_.empty() ? albedo_[channel] * facets : directional_[channel].Evaluate(wi, wo, nullptr);
}

double Reflectance::Channel(std::size_t channel, const double* specular, const double* cos_d, double diffuse,
                            const CoatPassage* passage) const {
  const auto part = [&](std::size_t lobe) {
    return specular[lobe] *
           FresnelFactor(model_.lobes[lobe].fresnel, fresnel_[lobe][channel].data(), cos_d[lobe], nullptr);
  };
  double f_r = diffuse;
  for (std::size_t lobe = 0; lobe < shapes_.size(); ++lobe) {
    if (lobe != coat_) f_r += part(lobe);
  }
  if (passage == nullptr) return f_r;
  const double tau = fresnel_[coat_][channel][1];
  return part(coat_) + passage->clear * std::exp(-tau * passage->path) * f_r;
}

void Reflectance::Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const {
  if (!(wi.z > 0 && wo.z > 0)) {
    std::fill_n(f_r, channels_, 0.0);
    return;
  }
  CoatPassage passage = {};
  if (HasCoat()) passage = PassThroughCoat(fresnel_[coat_][0][0], IsRefracted(), wi, wo);
  std::vector<double> specular(shapes_.size()), cos_d(shapes_.size());
  for (std::size_t lobe = 0; lobe < shapes_.size(); ++lobe) {
    const bool below = HasCoat() && lobe != coat_;
    specular[lobe] = SpecularLobe(below ? passage.inside_i : wi, below ? passage.inside_o : wo, model_.lobes[lobe],
                                  shapes_[lobe], &cos_d[lobe], nullptr);
  }
  const double facets = facets_ ? facets_->Evaluate(wi, wo, nullptr) : unit_diffuse_;
  for (std::size_t c = 0; c < channels_; ++c) {
    f_r[c] = Channel(c, specular.data(), cos_d.data(), DiffusePart(c, wi, wo, facets), HasCoat() ? &passage : nullptr);
  }
}

void Reflectance::Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const {
  const std::size_t count = directions.count, lobes = shapes_.size();
  std::vector<CoatPassage> passages;
  std::vector<double> inside[6];
  for (std::size_t i = 0; HasCoat() && i < count; ++i) {
    passages.push_back(PassThroughCoat(fresnel_[coat_][0][0], IsRefracted(),
                                       {directions.wi_x[i], directions.wi_y[i], directions.wi_z[i]},
                                       {directions.wo_x[i], directions.wo_y[i], directions.wo_z[i]}));
    const Vec3 &wi = passages[i].inside_i, &wo = passages[i].inside_o;
    const double all[6] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t k = 0; k < 6; ++k) inside[k].push_back(all[k]);
  }
  const DirectionArrays below = HasCoat() ? DirectionArrays{inside[0].data(),
                                                            inside[1].data(),
                                                            inside[2].data(),
                                                            inside[3].data(),
                                                            inside[4].data(),
                                                            inside[5].data(),
                                                            count}
                                          : directions;
  std::vector<std::vector<double>> specular(lobes, std::vector<double>(count)),
      cos_d(lobes, std::vector<double>(count));
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    SpecularLobe(lobe == coat_ ? directions : below, model_.lobes[lobe], shapes_[lobe], specular[lobe].data(),
                 cos_d[lobe].data(), nullptr);
  }
  std::vector<double> facets(count, unit_diffuse_);
  if (facets_) facets_->Evaluate(directions, facets.data(), nullptr);
  // In the order of Channel, a lobe of all directions at a time.
  f_r->resize(channels_);
  for (std::size_t c = 0; c < channels_; ++c) {
    std::vector<double>& sum = (*f_r)[c];
    sum.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      sum[i] = directional_.empty()
                   ? albedo_[c] * facets[i]
                   : directional_[c].Evaluate({directions.wi_x[i], directions.wi_y[i], directions.wi_z[i]},
                                              {directions.wo_x[i], directions.wo_y[i], directions.wo_z[i]}, nullptr);
    }
    const auto factor = [&](std::size_t lobe, std::size_t i) {
      return specular[lobe][i] *
             FresnelFactor(model_.lobes[lobe].fresnel, fresnel_[lobe][c].data(), cos_d[lobe][i], nullptr);
    };
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      for (std::size_t i = 0; lobe != coat_ && i < count; ++i) sum[i] += factor(lobe, i);
    }
    for (std::size_t i = 0; HasCoat() && i < count; ++i) {
      const double through = passages[i].clear * std::exp(-fresnel_[coat_][c][1] * passages[i].path);
      sum[i] = factor(coat_, i) + through * sum[i];
    }
  }
}

}  // namespace lobefit
