#include "lobefit/core/reflectance.h"

#include <stdexcept>

namespace lobefit {
namespace {

double Power5(double x) {
  const double x2 = x * x;
  return x2 * x2 * x;
}

}  // namespace

Reflectance::Reflectance(const Model& model, const ParameterValues& values, std::size_t channels)
    : model_(model), channels_(channels), diffuse_(channels, 0.0) {
  const std::vector<Parameter> parameters = Parameters(model);
  if (values.size() != parameters.size()) throw std::invalid_argument("Reflectance: wrong number of parameters");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].size() != (parameters[i].per_channel ? channels : 1)) {
      throw std::invalid_argument("Reflectance: wrong number of values of " + parameters[i].name);
    }
  }
  std::size_t at = 0;
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    const Ellipsoid ellipsoid = {values[at][0], values[at + 1][0], values[at + 2][0], values[at + 3][0],
                                 values[at + 4][0]};
    shapes_.push_back(SlopeCoordinatesFromEllipsoid(ellipsoid));
    amplitude_.push_back(values[at + 5]);
    at += 6;
  }
  if (model.diffuse == Diffuse::kLambert) diffuse_ = values[at];
}

double Reflectance::Channel(std::size_t channel, const double* specular, const double* schlick) const {
  double f_r = diffuse_[channel] * kInvPi;
  for (std::size_t lobe = 0; lobe < shapes_.size(); ++lobe) {
    const double a = amplitude_[lobe][channel];
    f_r += specular[lobe] * (model_.lobes[lobe].fresnel == Fresnel::kSchlick ? a + (1 - a) * schlick[lobe] : a);
  }
  return f_r;
}

void Reflectance::Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const {
  const bool visible = wi.z > 0 && wo.z > 0;
  std::vector<double> specular(shapes_.size()), schlick(shapes_.size());
  for (std::size_t lobe = 0; visible && lobe < shapes_.size(); ++lobe) {
    double cos_d = 0;
    specular[lobe] = GgxLobe(wi, wo, shapes_[lobe], model_.lobes[lobe].masking, &cos_d, nullptr);
    schlick[lobe] = Power5(1 - cos_d);
  }
  for (std::size_t c = 0; c < channels_; ++c) f_r[c] = visible ? Channel(c, specular.data(), schlick.data()) : 0.0;
}

void Reflectance::Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const {
  const std::size_t count = directions.count, lobes = shapes_.size();
  std::vector<std::vector<double>> specular(lobes, std::vector<double>(count)),
      cos_d(lobes, std::vector<double>(count));
  for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
    GgxLobe(directions, shapes_[lobe], model_.lobes[lobe].masking, specular[lobe].data(), cos_d[lobe].data(), nullptr);
  }
  f_r->assign(channels_, std::vector<double>(count));
  std::vector<double> s(lobes), schlick(lobes);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t lobe = 0; lobe < lobes; ++lobe) {
      s[lobe] = specular[lobe][i];
      schlick[lobe] = Power5(1 - cos_d[lobe][i]);
    }
    for (std::size_t c = 0; c < channels_; ++c) (*f_r)[c][i] = Channel(c, s.data(), schlick.data());
  }
}

}  // namespace lobefit
