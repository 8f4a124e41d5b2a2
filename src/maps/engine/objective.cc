#include "lobefit/maps/engine/objective.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/maps/engine/kernels.h"

namespace lobefit {
namespace {

// Sum of ln(1 + x_l) >= 0 with one logarithm a few terms: e -> e + x + e x is the product less 1, exact near 0.
double SumOfLog1p(const std::vector<double>& x, double factor, std::size_t padded) {
  constexpr std::size_t kFlush = 32;
  double sum = 0;
  for (std::size_t begin = 0; begin < padded; begin += kFlush) {
    double lanes[LightArrays::kLanes] = {};
    for (std::size_t l = begin; l < std::min(padded, begin + kFlush); l += LightArrays::kLanes) {
      for (std::size_t lane = 0; lane < LightArrays::kLanes; ++lane) {
        const double t = factor * x[l + lane];
        lanes[lane] += t + lanes[lane] * t;
      }
    }
    for (const double lane : lanes) sum += std::log1p(lane);
  }
  return sum;
}

Amplitudes AmplitudesOf(const MapModel& model, const TexelData& data, const MapPoint& point, int channel) {
  const auto c = static_cast<std::size_t>(channel);
  // Without Schlick's term k is 0.
  if (model.lobe == MapLobe::kNone) return {point.diffuse[c], 0, 0};
  return {point.diffuse[c], point.f0[c], 1 / data.scale};
}

}  // namespace

void BestAmplitudes(const AmplitudeSums& sums, double most_b, double* a, double* b) {
  const double det = sums.aa * sums.bb - sums.ab * sums.ab;
  const bool both = det > 1e-12 * sums.aa * sums.bb;
  const auto a_for = [&](double other) {
    return sums.aa > 0 ? std::max(0.0, (sums.ay - sums.ab * other) / sums.aa) : 0.0;
  };
  *b = both ? (sums.by * sums.aa - sums.ay * sums.ab) / det : 0;
  *a = both ? (sums.ay * sums.bb - sums.by * sums.ab) / det : 0;
  if (both && *a < 0) *a = 0, *b = sums.by / sums.bb;
  *b = std::clamp(*b, 0.0, most_b);
  if (!both || *b <= 0 || *b >= most_b) *a = a_for(*b);
}

void TexelData::Resize(std::size_t padded) {
  lights.Resize(padded);
  for (std::vector<double>& v : value) v.resize(padded);
}

void TexelObjective::Resize(std::size_t padded) {
  shape_.Resize(padded);
  for (std::vector<double>* a : {&square_, &weight_, &bend_, &lobe_, &carried_, &weighted_, &zero_}) a->resize(padded);
  for (std::vector<double>& r : residual_) r.resize(padded);
  for (std::vector<double>& r : rows_) r.resize(padded);
  for (auto& channel : jacobian_) {
    for (std::vector<double>& j : channel) j.resize(padded);
  }
}

void TexelObjective::Shape(const MapModel& model, const TexelData& data, const MapPoint& point, bool gradient) {
  const LightArrays& lights = data.lights;
  EvaluateShape(model.lobe, point, lights, gradient, &shape_);
  for (std::size_t l = 0; model.lobe != MapLobe::kNone && l < lights.padded; ++l) {
    lobe_[l] = (1 - lights.k[l]) * shape_.specular[l];
    carried_[l] = lights.k[l] / data.scale;
  }
}

double TexelObjective::Residuals(const MapModel& model, const TexelData& data, const MapPoint& point, double loss) {
  const LightArrays& lights = data.lights;
  const bool lobe = model.lobe != MapLobe::kNone;
  std::fill(square_.begin(), square_.begin() + static_cast<std::ptrdiff_t>(lights.padded), 0.0);
  for (int c = 0; c < model.channels; ++c) {
    AddResiduals(AmplitudesOf(model, data, point, c), shape_.cosine.data(),
                 lobe ? shape_.specular.data() : zero_.data(), lights.k.data(), lights.live.data(),
                 data.value[c].data(), lights.padded, residual_[c].data(), square_.data());
  }
  const double cost = 0.5 * loss * loss * SumOfLog1p(square_, 1 / (loss * loss), lights.padded);
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

double TexelObjective::Cost(const MapModel& model, const TexelData& data, const MapPoint& point, double loss) {
  Shape(model, data, point, false);
  return Residuals(model, data, point, loss);
}

void TexelObjective::Reweigh(const TexelData& data, double loss) {
  const double inverse = 1 / (loss * loss);
  for (std::size_t l = 0; l < data.lights.padded; ++l) weight_[l] = data.lights.live[l] / (1 + square_[l] * inverse);
}

double TexelObjective::CostOfShape(const MapModel& model, const TexelData& data, double loss, double most_f0,
                                   MapPoint* point) {
  Shape(model, data, *point, false);
  const std::size_t padded = data.lights.padded;
  const bool lobe = model.lobe != MapLobe::kNone;
  const double *w = weight_.data(), *A = shape_.cosine.data(), *B = lobe_.data();
  // Sums of w A and w B with A, B and the values, from which what Schlick's term adds whatever f0 is, is taken.
  AmplitudeSums sums[kMostChannels] = {};
  for (int a = 0; a < model.PerChannel(); ++a) {
    double* scaled = weighted_.data();
    Multiply(w, a == 0 ? A : B, padded, scaled);
    double carried = 0, products[2 + kMostChannels];
    const double* with[2 + kMostChannels] = {A, lobe ? B : A};
    for (int c = 0; c < model.channels; ++c) with[2 + c] = data.value[c].data();
    DotProducts(scaled, with, 2 + model.channels, padded, products);
    if (lobe && model.schlick) {
      for (std::size_t l = 0; l < padded; ++l) square_[l] = carried_[l] * shape_.specular[l];
      const double* one = square_.data();  // filled anew by Residuals
      DotProducts(scaled, &one, 1, padded, &carried);
    }
    for (int c = 0; c < model.channels; ++c) {
      if (a == 0) sums[c].aa = products[0], sums[c].ab = lobe ? products[1] : 0, sums[c].ay = products[2 + c] - carried;
      if (a == 1) sums[c].bb = products[1], sums[c].by = products[2 + c] - carried;
    }
  }
  for (int c = 0; c < model.channels; ++c) BestAmplitudes(sums[c], most_f0, &point->diffuse[c], &point->f0[c]);
  return Residuals(model, data, *point, loss);
}

double TexelObjective::Derivatives(const MapModel& model, const TexelData& data, const MapPoint& point, double loss,
                                   Curvature curvature, MapVector* gradient, MapMatrix* hessian) {
  Shape(model, data, point, true);
  const double cost = Residuals(model, data, point, loss);
  const LightArrays& lights = data.lights;
  const std::size_t padded = lights.padded;
  const bool lobe = model.lobe != MapLobe::kNone;
  const int shape = model.Shape(), unknowns = model.Unknowns(), channels = model.channels;
  constexpr double kLeast = 0.05;  // of the weight that curvature along the residual keeps where it is clipped
  for (std::size_t l = 0; l < padded; ++l) {
    const double w = lights.live[l] / (1 + square_[l] / (loss * loss));
    weight_[l] = w;
    const double whole = -2 * w * w / (loss * loss);
    bend_[l] = curvature == Curvature::kWhole  ? whole
               : curvature == Curvature::kNone ? 0
                                               : std::max(whole, -(1 - kLeast) * w / (square_[l] + 1e-300));
  }
  for (int j = 0; j < shape; ++j) {
    std::vector<double>& v = rows_[j];
    std::fill(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(padded), 0.0);
    for (int c = 0; c < channels; ++c) {
      AddColumn(AmplitudesOf(model, data, point, c), j < 2 ? shape_.dcosine[j].data() : zero_.data(),
                lobe ? shape_.dspecular[j].data() : zero_.data(), lights.k.data(), residual_[c].data(), padded,
                jacobian_[c][j].data(), v.data());
    }
  }
  for (int c = 0; c < channels; ++c) {
    Multiply(residual_[c].data(), shape_.cosine.data(), padded, rows_[model.DiffuseAt(c)].data());
    if (lobe) Multiply(residual_[c].data(), lobe_.data(), padded, rows_[model.F0At(c)].data());
  }
  // The loss's part, bend (J^T r)(J^T r)^T, then each channel's w J^T J: amplitudes are the same functions in all.
  const double* rows[kMostUnknowns];
  for (int j = 0; j < unknowns; ++j) rows[j] = rows_[j].data();
  DotProducts(weight_.data(), rows, unknowns, padded, gradient->data());
  double* scaled = weighted_.data();
  const auto weigh = [&](const double* by, const double* what) { Multiply(by, what, padded, scaled); };
  const bool bent = curvature != Curvature::kNone;
  for (int j = 0; j < unknowns; ++j) {
    std::fill((*hessian)[j].begin(), (*hessian)[j].end(), 0.0);
    if (!bent) continue;
    weigh(bend_.data(), rows[j]);
    DotProducts(scaled, rows, j + 1, padded, (*hessian)[j].data());
  }
  const double* amplitudes[2] = {shape_.cosine.data(), lobe_.data()};
  const int per_channel = model.PerChannel();
  double products[kMostShape + 2];
  for (int a = 0; a < per_channel; ++a) {
    weigh(weight_.data(), amplitudes[a]);
    DotProducts(scaled, amplitudes, a + 1, padded, products);
    for (int c = 0; c < channels; ++c) {
      for (int b = 0; b <= a; ++b) (*hessian)[model.DiffuseAt(c) + a][model.DiffuseAt(c) + b] += products[b];
    }
  }
  for (int c = 0; c < channels; ++c) {
    const double* columns[kMostShape + 2];
    for (int j = 0; j < shape; ++j) {
      weigh(weight_.data(), jacobian_[c][j].data());
      for (int k = 0; k <= j; ++k) columns[k] = jacobian_[c][k].data();
      for (int a = 0; a < per_channel; ++a) columns[j + 1 + a] = amplitudes[a];
      DotProducts(scaled, columns, j + 1 + per_channel, padded, products);
      for (int k = 0; k <= j; ++k) (*hessian)[j][k] += products[k];
      for (int a = 0; a < per_channel; ++a) (*hessian)[model.DiffuseAt(c) + a][j] += products[j + 1 + a];
    }
  }
  for (int j = 0; j < unknowns; ++j) {
    for (int k = 0; k < j; ++k) (*hessian)[k][j] = (*hessian)[j][k];
  }
  return cost;
}

double TexelObjective::Jacobian(const MapModel& model, int channel, int unknown, std::size_t light) const {
  if (unknown < model.Shape()) return jacobian_[channel][unknown][light];
  if (unknown == model.DiffuseAt(channel)) return shape_.cosine[light];
  if (model.lobe != MapLobe::kNone && unknown == model.F0At(channel)) return lobe_[light];
  return 0;
}

}  // namespace lobefit
