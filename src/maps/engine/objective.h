// The cost of a texel, its gradient and its matrix of second derivatives.
#pragma once

#include <array>
#include <vector>

#include "lobefit/maps/engine/lights.h"
#include "lobefit/maps/engine/model.h"
#include "lobefit/maps/engine/shape.h"

namespace lobefit {

using MapVector = std::array<double, kMostUnknowns>;
using MapMatrix = std::array<std::array<double, kMostUnknowns>, kMostUnknowns>;

// The values of the lights that a texel uses, in units of its scale: value[channel][light], padded with 0.
struct TexelData {
  LightArrays lights;
  std::vector<double> value[kMostChannels];
  double scale = 1;
  void Resize(std::size_t padded);
};

// Weighed sums over lights of the products of two functions a, b and of values y.
struct AmplitudeSums {
  double aa, ab, bb, ay, by;
};
// a >= 0 and 0 <= b <= most_b that minimise sum (a A + b B - y)^2.
void BestAmplitudes(const AmplitudeSums& sums, double most_b, double* a, double* b);

// cost = sum over lights of c^2 / 2 ln(1 + |r|^2 / c^2), Cauchy's loss of the light's residuals r in all channels
// together, so that a cast shadow or a highlight of something else is one outlier.
class TexelObjective {
 public:
  void Resize(std::size_t padded);
  // Infinite where it is no number.
  double Cost(const MapModel& model, const TexelData& data, const MapPoint& point, double loss);
  // The same where the amplitudes are not those of the point but, within 0 and most_f0, the best for its shape under the
  // weights of the last call of Derivatives; they are stored in the point. Long curved valleys between width and f0 are
  // so left at one step.
  double CostOfShape(const MapModel& model, const TexelData& data, double loss, double most_f0, MapPoint* point);
  // Weights of 1 for CostOfShape, as before the first call of Derivatives.
  void ForgetWeights(const TexelData& data) { weight_ = data.lights.live; }
  // Those of the loss at the residuals of the last cost.
  void Reweigh(const TexelData& data, double loss);
  // How the loss bends the second derivatives: not at all, so that the quadratic lies above the cost of a linear model
  // (far from the minimum); clipped so that the matrix has no negative curvature (near it); or as it is (for errors).
  enum class Curvature { kNone, kClipped, kWhole };
  double Derivatives(const MapModel& model, const TexelData& data, const MapPoint& point, double loss,
                     Curvature curvature, MapVector* gradient, MapMatrix* hessian);

  // Of the last call of Derivatives, over the padded lights: residuals, weight of the loss, coefficient of (J^T r)(J^T
  // r)^T, and J^T r by unknowns.
  const std::vector<double>& residual(int channel) const { return residual_[channel]; }
  const std::vector<double>& weight() const { return weight_; }
  const std::vector<double>& bend() const { return bend_; }
  const std::vector<double>& row(int unknown) const { return rows_[unknown]; }
  // d residual[channel] / d unknown.
  double Jacobian(const MapModel& model, int channel, int unknown, std::size_t light) const;

 private:
  void Shape(const MapModel& model, const TexelData& data, const MapPoint& point, bool gradient);
  double Residuals(const MapModel& model, const TexelData& data, const MapPoint& point, double loss);

  ShapeArrays shape_;
  std::vector<double> residual_[kMostChannels], square_, weight_, bend_;
  std::vector<double> lobe_, carried_;  // (1 - k) specular; k / scale
  std::vector<double> jacobian_[kMostChannels][kMostShape], rows_[kMostUnknowns], weighted_, zero_;
};

}  // namespace lobefit
