#include "lobefit/maps/engine/objective.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobefit {
namespace {

double OrInfinite(double cost) { return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity(); }

}  // namespace

void BestAmplitudes(const AmplitudeSums& sums, const AmplitudeBounds& bounds, double* a, double* b) {
  const double det = sums.aa * sums.bb - sums.ab * sums.ab;
  const bool both = det > 1e-12 * sums.aa * sums.bb;
  const auto a_for = [&](double other) {
    return sums.aa > 0 ? std::max(0.0, (sums.ay - sums.ab * other) / sums.aa) : 0.0;
  };
  if (bounds.f0_held) {
    if (!bounds.diffuse_held) *a = a_for(*b);
    return;
  }
  if (bounds.diffuse_held) {
    *b = sums.bb > 0 ? std::clamp((sums.by - sums.ab * *a) / sums.bb, 0.0, bounds.most_f0) : 0;
    return;
  }
  *b = both ? (sums.by * sums.aa - sums.ay * sums.ab) / det : 0;
  *a = both ? (sums.ay * sums.bb - sums.by * sums.ab) / det : 0;
  if (both && *a < 0) *a = 0, *b = sums.by / sums.bb;
  *b = std::clamp(*b, 0.0, bounds.most_f0);
  if (!both || *b <= 0 || *b >= bounds.most_f0) *a = a_for(*b);
}

void TexelData::Resize(std::size_t padded) {
  lights.Resize(padded);
  for (LightVector& v : value) v.resize(lights.padded);
}

void TexelObjective::Resize(std::size_t padded) {
  shape_.Resize(padded);
  for (LightVector* a : {&weight_, &trial_weight_, &bend_}) a->resize(padded);
  for (LightVector& r : residual_) r.resize(padded);
  for (LightVector& r : row_) r.resize(padded);
  for (std::size_t c = 0; c < kMostChannels; ++c) rows_.residual[c] = residual_[c].data();
  for (std::size_t j = 0; j < kMostUnknowns; ++j) rows_.rows[j] = row_[j].data();
  rows_.weight = weight_.data(), rows_.bend = bend_.data();
}

void TexelObjective::Shape(const MapModel& model, const TexelData& data, const MapPoint& point, bool gradient) {
  const LightArrays& lights = data.lights;
  EvaluateShape(model.lobe, point, lights, gradient, &shape_);
  terms_.shape = model.Shape(), terms_.channels = model.channels, terms_.padded = lights.padded;
  terms_.cosine = shape_.cosine.data(), terms_.specular = shape_.specular.data();
  terms_.k = lights.k.data(), terms_.live = lights.live.data();
  for (std::size_t j = 0; j < terms_.dcosine.size(); ++j) terms_.dcosine[j] = shape_.dcosine[j].data();
  for (std::size_t j = 0; j < terms_.dspecular.size(); ++j) terms_.dspecular[j] = shape_.dspecular[j].data();
  for (std::size_t c = 0; c < kMostChannels; ++c) {
    terms_.values[c] = data.value[c].data();
    terms_.amplitudes[c] = {0, 0, model.lobe == MapLobe::kNone ? 0 : 1 / data.scale};
  }
}

void TexelObjective::TakeAmplitudes(const MapModel& model, const MapPoint& point) {
  for (std::size_t c = 0; c < kMostChannels; ++c) {
    terms_.amplitudes[c].diffuse = point.diffuse[c];
    // Without Schlick's term k is 0.
    terms_.amplitudes[c].f0 = model.lobe == MapLobe::kNone ? 0 : point.f0[c];
  }
}

double TexelObjective::Cost(const MapModel& model, const TexelData& data, const MapPoint& point, double loss) {
  Shape(model, data, point, false);
  TakeAmplitudes(model, point);
  terms_.loss = loss;
  return OrInfinite(CostOf(terms_));
}

void TexelObjective::TakeBestAmplitudes(const MapModel& model, const LightVector& weight, const AmplitudeBounds& bounds,
                                        MapPoint* point) {
  AmplitudeSums sums[kMostChannels] = {};
  SumAmplitudes(terms_, weight.data(), sums);
  for (std::size_t c = 0; c < static_cast<std::size_t>(model.channels); ++c) {
    BestAmplitudes(sums[c], bounds, &point->diffuse[c], &point->f0[c]);
  }
  TakeAmplitudes(model, *point);
}

double TexelObjective::CostOfShape(const MapModel& model, const TexelData& data, const LightVector& weight, double loss,
                                   const AmplitudeBounds& bounds, MapPoint* point) {
  Shape(model, data, *point, false);
  terms_.loss = loss;
  TakeBestAmplitudes(model, weight, bounds, point);
  return OrInfinite(CostOf(terms_));
}

double TexelObjective::CostOfStart(const MapModel& model, const TexelData& data, double loss,
                                   const AmplitudeBounds& bounds, MapPoint* point) {
  Shape(model, data, *point, false);
  terms_.loss = loss;
  TakeBestAmplitudes(model, data.lights.live, bounds, point);
  WeightsOf(terms_, trial_weight_.data());
  TakeBestAmplitudes(model, trial_weight_, bounds, point);
  return OrInfinite(CostOf(terms_));
}

void TexelObjective::WeightsOfLast(LightVector* weight) const { WeightsOf(terms_, weight->data()); }

double TexelObjective::Derivatives(const MapModel& model, const TexelData& data, const MapPoint& point, double loss,
                                   Curvature curvature, MapVector* gradient, MapMatrix* hessian) {
  Shape(model, data, point, true);
  TakeAmplitudes(model, point);
  terms_.loss = loss;
  const double cost = RowsOf(terms_, curvature, rows_, gradient->data());
  const int unknowns = model.Unknowns();
  for (int j = 0; j < unknowns; ++j) (*hessian)[j].fill(0);
  // The loss's part, bend (J^T r)(J^T r)^T, then each channel's w J^T J.
  if (curvature != Curvature::kNone) AddGram(bend_.data(), rows_.rows.data(), unknowns, terms_.padded, hessian);
  AddSquares(terms_, weight_.data(), hessian);
  for (int j = 0; j < unknowns; ++j) {
    for (int k = 0; k < j; ++k) (*hessian)[k][j] = (*hessian)[j][k];
  }
  return OrInfinite(cost);
}

std::array<const double*, kMostUnknowns> TexelObjective::Moves(const MapModel& model, const TexelData& data,
                                                               const MapMatrix& inverse) {
  terms_.padded = data.lights.padded;
  MovesOf(terms_, rows_, inverse, rows_.rows.data());
  std::array<const double*, kMostUnknowns> moved = {};
  for (int j = 0; j < model.Unknowns(); ++j) moved[j] = row_[static_cast<std::size_t>(j)].data();
  return moved;
}

std::array<const double*, 2> TexelObjective::Pulls(const TexelData& data, const MapMatrix& inverse) {
  terms_.padded = data.lights.padded;
  PullsOf(terms_, rows_, inverse, rows_.rows.data());
  return {row_[0].data(), row_[1].data()};
}

}  // namespace lobefit
