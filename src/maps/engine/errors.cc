#include "lobefit/maps/engine/errors.h"

#include <cmath>

#include "lobefit/maps/engine/factor.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// Chosen by how the doubt sorts texels of synthetic stacks (`bench_maps doubts`): the surest half is 0.756 of all, with
// half the variance smooth 0.779, with none 0.765; bumps down to a third as wide change 0.002.
constexpr double kSmoothShare = 0.25;

// Evenly over the hemisphere, by the golden angle.
BumpCenters Centers() {
  BumpCenters centers;
  const double turn = kPi * (3 - std::sqrt(5.0));
  for (std::size_t g = 0; g < centers.size(); ++g) {
    const auto at = static_cast<double>(g);
    const double z = 1 - (at + 0.5) / static_cast<double>(centers.size()), flat = std::sqrt(1 - z * z);
    centers[g] = {flat * std::cos(at * turn), flat * std::sin(at * turn), z};
  }
  return centers;
}

}  // namespace

double DoubtOf(const TexelData& data, const MapMatrix& inverse, int channels, TexelObjective* objective) {
  double squares = 0, predicted = 0;
  for (std::size_t l = 0; l < data.lights.count; ++l) {
    double rr = 0, yy = 0;
    for (int c = 0; c < channels; ++c) {
      const double r = objective->residual(c)[l], y = r + data.value[static_cast<std::size_t>(c)][l];
      rr += r * r, yy += y * y;
    }
    squares += objective->weight()[l] * rr, predicted += objective->weight()[l] * yy;
  }
  const auto pull = objective->Pulls(data, inverse);
  static const BumpCenters kCenters = Centers();
  return std::sqrt(squares / predicted * SmoothSquares(kCenters, kSmoothShare, data.lights, pull[0], pull[1]));
}

MapErrors ErrorsOf(const MapModel& model, const TexelData& data, const MapPoint& point, const MapBounds& bounds,
                   double loss, TexelObjective* objective) {
  const int unknowns = model.Unknowns();
  MapErrors errors;
  MapVector gradient = {};
  MapMatrix factor = {};
  std::array<bool, kMostUnknowns> held = {};
  for (const auto curvature : {Curvature::kWhole, Curvature::kClipped}) {
    objective->Derivatives(model, data, point, loss, curvature, &gradient, &factor);
    held = HeldUnknowns(model, point, bounds, gradient);
    errors.regular = Factorise(unknowns, held, &factor);
    if (errors.regular) break;
  }
  if (!errors.regular) return errors;
  // A_l = J^T W J with W = w 1 + bend r r^T: without this light the solution moves by (A - A_l)^-1 J^T w r =
  // A^-1 J^T (1 - W J A^-1 J^T)^-1 w r, and by A^-1 J^T w r where its own pull on the solution is left in its residual.
  const MapMatrix inverse = InverseOf(unknowns, held, factor);
  errors.doubt = held[0] || held[1] ? kNan : DoubtOf(data, inverse, model.channels, objective);
  const auto moved = objective->Moves(model, data, inverse);
  AddGram(data.lights.live.data(), moved.data(), unknowns, data.lights.padded, &errors.covariance);
  for (int j = 0; j < unknowns; ++j) {
    for (int k = 0; k <= j; ++k) {
      if (held[j] || held[k]) errors.covariance[j][k] = kNan;
      errors.covariance[k][j] = errors.covariance[j][k];
    }
  }
  return errors;
}

}  // namespace lobefit
