#include "lobefit/fit/kernel/coat_stage.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/coat.h"
#include "lobefit/fit/kernel/block_arrays.h"

namespace lobefit {
namespace {

DirectionalDiffuse InterfaceOf(double ior) {
  const double parameters[] = {ior, 1};
  return DirectionalDiffuse(Diffuse::kInterfaced, parameters);
}

// Of a lobe 0.01 wide off by 1e-9 of the derivative; rounding adds 1e-11.
constexpr double kIndexStep = 2e-6;

Vec3 DirectionIn(const DirectionArrays& directions, std::size_t i) {
  return {directions.wi_x[i], directions.wi_y[i], directions.wi_z[i]};
}
Vec3 DirectionOut(const DirectionArrays& directions, std::size_t i) {
  return {directions.wo_x[i], directions.wo_y[i], directions.wo_z[i]};
}

}  // namespace

std::size_t CoatOf(const KernelModel& model) {
  std::size_t l = 0;
  while (l < model.lobes.size() && !IsCoat(model.lobes[l].kind.fresnel)) ++l;
  return l;
}

CoatStage::CoatStage(const KernelModel& model, std::size_t coat, bool gradient)
    : model_(model),
      coat_(coat),
      ior_(model.lobes[coat].fresnel[0]),
      refracted_(model.lobes[coat].kind.fresnel == Fresnel::kCoatRefracted),
      gradient_(gradient),
      interface_(InterfaceOf(ior_)),
      arrays_((gradient ? 3 : 1) * model.channels * kBlock),
      clear_(kBlock),
      path_(kBlock),
      dlog_clear_(kBlock),
      dpath_(kBlock) {
  lambert_ = LambertBelowCoat(ior_, refracted_, &dlambert_dior_);
  for (std::vector<double>& array : inside_) array.resize(refracted_ ? kBlock : 0);
  if (!refracted_ || !gradient) return;
  below_.channels = model.channels;
  below_.transform = model.transform;
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    if (l != coat) below_.lobes.push_back(model.lobes[l]);
  }
}

std::size_t CoatStage::Place(std::size_t c, std::size_t k) const { return ((gradient_ ? 3 * c : c) + k) * kBlock; }

double CoatStage::Tau(std::size_t c) const { return model_.lobes[coat_].fresnel[2 * c + 1]; }

DirectionArrays CoatStage::Enter(const DirectionArrays& outside) {
  count_ = outside.count;
  if (refracted_ && gradient_ && !below_.lobes.empty()) DifferenceIndex(outside);
  std::fill(clear_.begin(), clear_.end(), 0.0);
  std::fill(path_.begin(), path_.end(), 2.0);
  // T_i T_o and the derivative of its logarithm by the SIMD path of the interfaced part.
  interface_.EvaluateInterfaced(outside.wi_z, outside.wo_z, count_, clear_.data(), dlog_clear_.data());
  for (std::size_t i = 0; i < count_; ++i) {
    clear_[i] /= lambert_;
    dlog_clear_[i] -= dlambert_dior_ / lambert_;
  }
  if (!refracted_) return outside;
  for (std::size_t i = 0; i < count_; ++i) {
    Vec3 dwi, dwo;
    const Vec3 wi = Refracted(DirectionIn(outside, i), ior_, &dwi),
               wo = Refracted(DirectionOut(outside, i), ior_, &dwo);
    path_[i] = 1 / wi.z + 1 / wo.z;
    dpath_[i] = -dwi.z / (wi.z * wi.z) - dwo.z / (wo.z * wo.z);
    const double all[6] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t k = 0; k < 6; ++k) inside_[k][i] = all[k];
  }
  return {inside_[0].data(),
          inside_[1].data(),
          inside_[2].data(),
          inside_[3].data(),
          inside_[4].data(),
          inside_[5].data(),
          count_};
}

void CoatStage::Cover(std::size_t c, std::size_t padded, double* f) {
  const double tau = Tau(c), albedo = model_.diffuse.empty() ? 0 : model_.diffuse[c];
  double* through = arrays_.data() + Place(c, 0);
  for (std::size_t i = 0; i < padded; ++i) through[i] = clear_[i] * std::exp(-tau * path_[i]);
  if (gradient_) {
    double *by_ior = arrays_.data() + Place(c, 1), *by_tau = arrays_.data() + Place(c, 2);
    std::fill_n(by_ior, padded, 0.0);
    std::fill_n(by_tau, padded, 0.0);
    for (std::size_t i = 0; i < count_; ++i) {
      const double lobes = by_ior_.empty() ? 0 : by_ior_[c][i];
      by_ior[i] = through[i] * (f[i] * (dlog_clear_[i] - tau * dpath_[i]) + albedo * dlambert_dior_ + lobes);
      by_tau[i] = -path_[i] * through[i] * f[i];
    }
  }
  for (std::size_t i = 0; i < padded; ++i) f[i] *= through[i];
}

void CoatStage::DifferenceIndex(const DirectionArrays& outside) {
  KernelSamples samples = {};
  samples.count = count_;
  for (std::size_t k = 0; k < 6; ++k) samples.direction[k] = inside_[k].data();
  std::vector<std::vector<double>> f[2];
  // No index is below 1.
  const double step[2] = {std::min(kIndexStep, ior_ - 1), kIndexStep};
  for (std::size_t side = 0; side < 2; ++side) {
    const double ior = side == 0 ? ior_ - step[0] : ior_ + step[1];
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec3 wi = Refracted(DirectionIn(outside, i), ior), wo = Refracted(DirectionOut(outside, i), ior);
      const double all[6] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (std::size_t k = 0; k < 6; ++k) inside_[k][i] = all[k];
    }
    ModelValues(samples, below_, 0, count_, &f[side]);
  }
  by_ior_ = std::move(f[1]);
  for (std::size_t c = 0; c < by_ior_.size(); ++c) {
    for (std::size_t i = 0; i < count_; ++i) by_ior_[c][i] = (by_ior_[c][i] - f[0][c][i]) / (step[0] + step[1]);
  }
}

}  // namespace lobefit
