#include "lobefit/maps/engine/errors.h"

#include <cmath>

#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// x of the 3 x 3 (or smaller) system M x = b by elimination without pivots; M is near the identity.
void SolveSmall(int n, double M[kMostChannels][kMostChannels], double* x) {
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) {
      const double factor = M[i][j] / M[j][j];
      for (int k = j; k < n; ++k) M[i][k] -= factor * M[j][k];
      x[i] -= factor * x[j];
    }
  }
  for (int j = n - 1; j >= 0; --j) {
    for (int k = j + 1; k < n; ++k) x[j] -= M[j][k] * x[k];
    x[j] /= M[j][j];
  }
}

}  // namespace

MapErrors ErrorsOf(const MapModel& model, const TexelData& data, const MapPoint& point, const MapBounds& bounds,
                   double loss, TexelObjective* objective) {
  const int unknowns = model.Unknowns(), channels = model.channels;
  MapErrors errors;
  MapVector gradient = {};
  MapMatrix factor = {};
  std::array<bool, kMostUnknowns> held = {};
  for (const auto curvature : {TexelObjective::Curvature::kWhole, TexelObjective::Curvature::kClipped}) {
    objective->Derivatives(model, data, point, loss, curvature, &gradient, &factor);
    for (int j = 0; j < unknowns; ++j) held[j] = IsHeld(model, point, bounds, j, gradient[j]);
    errors.regular = Factorise(unknowns, held, &factor);
    if (errors.regular) break;
  }
  if (!errors.regular) return errors;
  MapMatrix inverse = {};
  for (int j = 0; j < unknowns; ++j) {
    MapVector unit = {};
    unit[j] = held[j] ? 0 : 1;
    SolveFactorised(unknowns, factor, &unit);
    inverse[j] = unit;
  }
  for (std::size_t l = 0; l < data.lights.count; ++l) {
    // A_l = J^T W J with W = w 1 + bend r r^T: without this light the solution moves by (A - A_l)^-1 J^T w r =
    // A^-1 J^T (1 - W J A^-1 J^T)^-1 w r.
    const double w = objective->weight()[l], bend = objective->bend()[l];
    double J[kMostChannels][kMostUnknowns], V[kMostChannels][kMostUnknowns], r[kMostChannels];
    for (int c = 0; c < channels; ++c) {
      r[c] = objective->residual(c)[l];
      for (int j = 0; j < unknowns; ++j) J[c][j] = held[j] ? 0 : objective->Jacobian(model, c, j, l);
      for (int k = 0; k < unknowns; ++k) {
        double sum = 0;
        for (int j = 0; j < model.Shape(); ++j) sum += inverse[k][j] * J[c][j];
        for (int a = 0; a < model.PerChannel(); ++a) {
          sum += inverse[k][model.DiffuseAt(c) + a] * J[c][model.DiffuseAt(c) + a];
        }
        V[c][k] = sum;
      }
    }
    double M[kMostChannels][kMostChannels], x[kMostChannels];
    for (int c = 0; c < channels; ++c) {
      double rows[kMostChannels];  // (J A^-1 J^T)[c]
      for (int e = 0; e < channels; ++e) {
        rows[e] = 0;
        for (int j = 0; j < unknowns; ++j) rows[e] += J[c][j] * V[e][j];
      }
      for (int e = 0; e < channels; ++e) M[c][e] = w * rows[e];
    }
    // Row c of W K is w K[c] + bend r_c (r^T K): add the second part.
    double rK[kMostChannels] = {};
    for (int e = 0; e < channels; ++e) {
      for (int c = 0; c < channels; ++c) rK[e] += w > 0 ? r[c] * M[c][e] / w : 0;
    }
    for (int c = 0; c < channels; ++c) {
      for (int e = 0; e < channels; ++e) M[c][e] = (c == e ? 1 : 0) - (M[c][e] + bend * r[c] * rK[e]);
      x[c] = w * r[c];
    }
    SolveSmall(channels, M, x);
    MapVector moved = {};
    for (int c = 0; c < channels; ++c) {
      for (int k = 0; k < unknowns; ++k) moved[k] += V[c][k] * x[c];
    }
    for (int j = 0; j < unknowns; ++j) {
      for (int k = 0; k <= j; ++k) errors.covariance[j][k] += moved[j] * moved[k];
    }
  }
  for (int j = 0; j < unknowns; ++j) {
    for (int k = 0; k <= j; ++k) {
      if (held[j] || held[k]) errors.covariance[j][k] = kNan;
      errors.covariance[k][j] = errors.covariance[j][k];
    }
  }
  return errors;
}

}  // namespace lobefit
