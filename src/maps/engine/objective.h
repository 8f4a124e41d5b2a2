// The cost of a texel, its gradient and its matrix of second derivatives.
#pragma once

#include "lobefit/maps/engine/kernels.h"
#include "lobefit/maps/engine/shape.h"

namespace lobefit {

// The values of the lights that a texel uses, in units of its scale: value[channel][light], padded with 0.
struct TexelData {
  LightArrays lights;
  std::array<LightVector, kMostChannels> value;
  double scale = 1;
  void Resize(std::size_t padded);
};

// What of a texel's amplitudes is held, and the largest f0, in its unit.
struct AmplitudeBounds {
  bool diffuse_held = false, f0_held = false;
  double most_f0 = 0;
};

// a >= 0 and 0 <= b <= most_f0 that minimise sum w (a A + b B - y)^2; what is held stays.
void BestAmplitudes(const AmplitudeSums& sums, const AmplitudeBounds& bounds, double* a, double* b);

// cost = sum over lights of c^2 / 2 ln(1 + |r|^2 / c^2), Cauchy's loss of the light's residuals r in all channels
// together, so that a cast shadow or a highlight of something else is one outlier.
class TexelObjective {
 public:
  void Resize(std::size_t padded);
  // Infinite where it is no number.
  double Cost(const MapModel& model, const TexelData& data, const MapPoint& point, double loss);
  // The same where the amplitudes are not those of the point but, within their bounds, the best for its shape under
  // `weight` of the lights; they are stored in the point. With the weights of the last call of Derivatives, long curved
  // valleys between width and f0 are so left at one step.
  double CostOfShape(const MapModel& model, const TexelData& data, const LightVector& weight, double loss,
                     const AmplitudeBounds& bounds, MapPoint* point);
  // Likewise under weights of 1, and again under those that the loss gives that answer: what it cannot meet, as a cast
  // shadow, weighs less.
  double CostOfStart(const MapModel& model, const TexelData& data, double loss, const AmplitudeBounds& bounds,
                     MapPoint* point);
  // The loss's weights at the last call of these.
  void WeightsOfLast(LightVector* weight) const;
  double Derivatives(const MapModel& model, const TexelData& data, const MapPoint& point, double loss,
                     Curvature curvature, MapVector* gradient, MapMatrix* hessian);

  // Of the last call of Derivatives, over the padded lights: residuals, weight of the loss.
  const LightVector& residual(int channel) const { return residual_[static_cast<std::size_t>(channel)]; }
  const LightVector& weight() const { return weight_; }
  // moved[j][l] of kernels.h, after a call of Derivatives for the same data; as many rows as unknowns, which stay those
  // of this object.
  std::array<const double*, kMostUnknowns> Moves(const MapModel& model, const TexelData& data,
                                                 const MapMatrix& inverse);
  // The first two rows of PullsOf, likewise, in place of Moves.
  std::array<const double*, 2> Pulls(const TexelData& data, const MapMatrix& inverse);

 private:
  void Shape(const MapModel& model, const TexelData& data, const MapPoint& point, bool gradient);
  void TakeAmplitudes(const MapModel& model, const MapPoint& point);
  // For the shape of the last call of Shape.
  void TakeBestAmplitudes(const MapModel& model, const LightVector& weight, const AmplitudeBounds& bounds,
                          MapPoint* point);

  ShapeArrays shape_;
  LightTerms terms_;
  RowArrays rows_;
  std::array<LightVector, kMostChannels> residual_;
  LightVector weight_, trial_weight_, bend_;
  std::array<LightVector, kMostUnknowns> row_;
};

}  // namespace lobefit
