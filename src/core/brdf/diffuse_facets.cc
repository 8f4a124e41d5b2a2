#include "lobefit/core/brdf/diffuse_facets.h"

#include <cmath>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr int kRadii = 24, kAngles = 48;
constexpr double kBeckmannEnd = 6;  // exp(-36) is left out

}  // namespace

DiffuseFacets::DiffuseFacets(const Lobe& lobe, const SlopeCoordinates& shape)
    : distribution_(DistributionOf(lobe, shape, &jacobian_)),
      shadowing_(ShadowingOf(lobe.masking, shape)),
      a_(std::exp(shape.v[2])),
      c_(std::exp(shape.v[4])) {
  static const QuadratureRule rule = GaussLegendre(kRadii);
  const bool ggx = FamilyOf(lobe.ndf) == Family::kGgx;
  for (int i = 0; i < kRadii; ++i) {
    const double x = 0.5 * (1 + rule.nodes[static_cast<std::size_t>(i)]);
    const double w = 0.5 * rule.weights[static_cast<std::size_t>(i)] / kAngles;
    double radius = 0, share = 0;  // share: P22 r dr dphi of the node, over the circle
    if (ggx) {
      const double t = 0.5 * kPi * x;
      radius = std::tan(t);
      share = w * 0.5 * kPi * std::sin(2 * t);
    } else {
      radius = kBeckmannEnd * x;
      share = w * kBeckmannEnd * 2 * radius * std::exp(-radius * radius);
    }
    for (int k = 0; k < kAngles; ++k) {
      const double phi = 2 * kPi * (k + 0.5 * (i % 2)) / kAngles;
      const double ux = radius * std::cos(phi), uy = radius * std::sin(phi);
      const double sx = shape.v[0] + a_ * ux, sy = shape.v[1] + shape.v[3] * ux + c_ * uy;
      unit_x_.push_back(ux);
      unit_y_.push_back(uy);
      s_x_.push_back(sx);
      s_y_.push_back(sy);
      weight_.push_back(share / std::sqrt(1 + sx * sx + sy * sy));
    }
  }
}

double DiffuseFacets::Evaluate(const Vec3& wi, const Vec3& wo, double gradient[5]) const {
  // Sums of the integrand and of its derivatives by the slope, alone and times the place in the unit disc.
  double K = 0, by_x = 0, by_y = 0, by_x_ux = 0, by_y_ux = 0, by_y_uy = 0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double along_o = wo.z - s_x_[i] * wo.x - s_y_[i] * wo.y, along_i = wi.z - s_x_[i] * wi.x - s_y_[i] * wi.y;
    if (along_o <= 0 || along_i <= 0) continue;
    const double product = along_o * along_i * weight_[i];
    K += product;
    if (gradient == nullptr) continue;
    const double fall = product / (1 + s_x_[i] * s_x_[i] + s_y_[i] * s_y_[i]);
    const double d_x = -weight_[i] * (wo.x * along_i + wi.x * along_o) - fall * s_x_[i];
    const double d_y = -weight_[i] * (wo.y * along_i + wi.y * along_o) - fall * s_y_[i];
    by_x += d_x;
    by_y += d_y;
    by_x_ux += d_x * unit_x_[i];
    by_y_ux += d_y * unit_x_[i];
    by_y_uy += d_y * unit_y_[i];
  }
  double dG2[kMaxDistributionParameters];
  const Vec3 wh = Normalized(wi + wo);
  const double G2 = MaskingShadowingG2(*distribution_, shadowing_, wo, wi, wh, gradient != nullptr ? dG2 : nullptr);
  const double scale = kInvPi / (wo.z * wi.z);
  if (gradient != nullptr) {
    const double dK[5] = {by_x, by_y, a_ * by_x_ux, by_y_ux, c_ * by_y_uy};
    for (std::size_t j = 0; j < 5; ++j) {
      double sum = G2 * dK[j];
      for (int k = 0; k < distribution_->parameters(); ++k)
        sum += K * dG2[k] * jacobian_[5 * static_cast<std::size_t>(k) + j];
      gradient[j] = scale * sum;
    }
  }
  return scale * G2 * K;
}

void DiffuseFacets::Evaluate(const DirectionArrays& directions, double* value, double* gradient) const {
  const DirectionArrays& d = directions;
  for (std::size_t i = 0; i < d.count; ++i) {
    double by_shape[5];
    value[i] = Evaluate({d.wi_x[i], d.wi_y[i], d.wi_z[i]}, {d.wo_x[i], d.wo_y[i], d.wo_z[i]},
                        gradient != nullptr ? by_shape : nullptr);
    for (std::size_t j = 0; gradient != nullptr && j < 5; ++j) gradient[j * d.count + i] = by_shape[j];
  }
}

}  // namespace lobefit
