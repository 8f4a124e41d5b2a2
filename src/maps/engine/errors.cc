#include "lobefit/maps/engine/errors.h"

#include <cmath>

#include "lobefit/maps/engine/factor.h"
#include "lobefit/math/vec.h"

namespace lobefit {
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
  const auto moved = objective->Moves(model, data, InverseOf(unknowns, held, factor));
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
