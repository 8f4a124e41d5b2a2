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

// cost = sum over lights of c^2 / 2 ln(1 + |r|^2 / c^2), Cauchy's loss of the light's residuals r in all channels
// together, so that a cast shadow or a highlight of something else is one outlier.
class TexelObjective {
 public:
  void Resize(std::size_t padded);
  // Infinite where it is no number.
  double Cost(const MapModel& model, const TexelData& data, const MapPoint& point, double loss);
  // How the loss bends the second derivatives: clipped so that the matrix has no negative curvature (for a descent), or
  // as it is (for errors).
  enum class Curvature { kClipped, kWhole };
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
  double Residuals(const MapModel& model, const TexelData& data, const MapPoint& point, double loss, bool gradient);

  ShapeArrays shape_;
  std::vector<double> residual_[kMostChannels], square_, weight_, bend_;
  std::vector<double> lobe_, carried_;  // (1 - k) specular; k / scale
  std::vector<double> jacobian_[kMostChannels][kMostShape], rows_[kMostUnknowns];
};

}  // namespace lobefit
