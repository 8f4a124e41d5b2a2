#include "lobefit/maps/engine/descent.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

constexpr int kMostIterations = 100;
// Of the cost, a light: below, values in single precision say nothing.
constexpr double kExact = 1e-20;

// A decrease below this part of the cost is near the minimum; a descent whose steps promise less than a tenth of what it
// is behind will not catch up.
constexpr double kNear = 0.2, kHopeless = 10;

// On the way to the same minimum.
bool IsSame(const MapPoint& a, const MapPoint& b) {
  return Dot(a.normal, b.normal) > 0.99999 && std::fabs(a.width[0] - b.width[0]) < 0.05 &&
         std::fabs(a.width[1] - b.width[1]) < 0.02 && std::fabs(a.width[2] - b.width[2]) < 0.05;
}

// Where unknown j stands, for those that have bounds. Null: the turns of the normal.
double* Place(const MapModel& model, MapPoint* point, int j) {
  if (j < 2) return nullptr;
  if (j < model.Shape()) return &point->width[j - 2];
  const int at = j - model.Shape(), channel = at / model.PerChannel();
  return at % model.PerChannel() == 0 ? &point->diffuse[channel] : &point->f0[channel];
}

void BoundsOf(const MapModel& model, const MapBounds& bounds, int j, double* low, double* high) {
  *low = -1e300, *high = 1e300;
  if (j < 2) return;
  if (j < model.Shape()) {
    // The middle one of three, b, says how the two widths lean.
    const bool logarithm = model.lobe == MapLobe::kGgx || j != 3;
    if (logarithm) *low = bounds.least_width, *high = bounds.most_width;
    if (!logarithm) *low = -1, *high = 1;
    return;
  }
  *low = 0;
  if ((j - model.Shape()) % model.PerChannel() == 1) *high = bounds.most_f0;
}

// The point after a step; a normal that would turn from the camera stays at the least n_z.
void Moved(const MapModel& model, const MapBounds& bounds, const MapPoint& from, const MapVector& step, MapPoint* to) {
  *to = from;
  const MapFrame frame = FrameOf(from.normal);
  to->normal = Normalized(frame.n + step[0] * frame.t + step[1] * frame.b);
  if (to->normal.z < bounds.least_normal_z) {
    const double flat = std::hypot(to->normal.x, to->normal.y), z = bounds.least_normal_z;
    const double keep = std::sqrt(1 - z * z) / flat;
    to->normal = {keep * to->normal.x, keep * to->normal.y, z};
  }
  for (int j = 2; j < model.Unknowns(); ++j) {
    double low, high;
    BoundsOf(model, bounds, j, &low, &high);
    double* place = Place(model, to, j);
    *place = std::clamp(*place + step[j], low, high);
  }
}

// The damped step, and the decrease that the quadratic promises. What would leave its bounds goes as far as they are, and
// the others follow. False where the damped matrix is not positive definite.
bool BoundedStep(const MapModel& model, const MapBounds& bounds, MapPoint point, const MapVector& gradient,
                 const MapMatrix& hessian, double damping, const std::array<bool, kMostUnknowns>& held, MapVector* step,
                 double* promised) {
  const int unknowns = model.Unknowns();
  std::array<bool, kMostUnknowns> fixed = held;
  MapVector known = {};  // steps of what is fixed
  for (int round = 0; round <= unknowns; ++round) {
    MapMatrix factor = hessian;
    for (int j = 0; j < unknowns; ++j) factor[j][j] += damping * hessian[j][j] + 1e-300;
    for (int j = 0; j < unknowns; ++j) {
      (*step)[j] = fixed[j] ? 0 : -gradient[j];
      for (int k = 0; !fixed[j] && k < unknowns; ++k) (*step)[j] -= hessian[j][k] * known[k];
    }
    if (!Factorise(unknowns, fixed, &factor)) return false;
    SolveFactorised(unknowns, factor, step);
    int leaving = -1;
    double most = 0;
    for (int j = 2; j < unknowns; ++j) {
      if (fixed[j]) {
        (*step)[j] = known[j];
        continue;
      }
      double low, high;
      BoundsOf(model, bounds, j, &low, &high);
      const double value = *Place(model, &point, j);
      const double beyond = std::max(low - (value + (*step)[j]), value + (*step)[j] - high);
      if (beyond > most) {
        most = beyond, leaving = j;
        known[j] = (*step)[j] < 0 ? low - value : high - value;
      }
    }
    if (leaving < 0) break;
    for (int j = 2; j < unknowns; ++j) known[j] = j == leaving || fixed[j] ? known[j] : 0;
    fixed[leaving] = true;
  }
  *promised = 0;
  for (int j = 0; j < unknowns; ++j) {
    double bent = 0;
    for (int k = 0; k < unknowns; ++k) bent += hessian[j][k] * (*step)[k];
    *promised -= (*step)[j] * (gradient[j] + 0.5 * bent);
  }
  return true;
}

}  // namespace

bool IsHeld(const MapModel& model, const MapPoint& point, const MapBounds& bounds, int j, double derivative) {
  if (j < 2) return bounds.normal_held;
  if (j < model.Shape() && bounds.width_held) return true;
  double low, high;
  BoundsOf(model, bounds, j, &low, &high);
  MapPoint copy = point;
  const double value = *Place(model, &copy, j);
  return (value <= low && derivative >= 0) || (value >= high && derivative <= 0);
}

bool Factorise(int unknowns, const std::array<bool, kMostUnknowns>& held, MapMatrix* matrix) {
  MapMatrix& m = *matrix;
  for (int j = 0; j < unknowns; ++j) {
    if (held[j]) {
      for (int k = 0; k < unknowns; ++k) m[j][k] = m[k][j] = 0;
      m[j][j] = 1;
    }
  }
  for (int j = 0; j < unknowns; ++j) {
    for (int k = 0; k < j; ++k) {
      double sum = m[j][k];
      for (int i = 0; i < k; ++i) sum -= m[j][i] * m[k][i];
      m[j][k] = sum / m[k][k];
    }
    double pivot = m[j][j];
    const double before = pivot;
    for (int i = 0; i < j; ++i) pivot -= m[j][i] * m[j][i];
    if (!(pivot > 1e-13 * before)) return false;
    m[j][j] = std::sqrt(pivot);
  }
  return true;
}

void SolveFactorised(int unknowns, const MapMatrix& factor, MapVector* x) {
  for (int j = 0; j < unknowns; ++j) {
    for (int i = 0; i < j; ++i) (*x)[j] -= factor[j][i] * (*x)[i];
    (*x)[j] /= factor[j][j];
  }
  for (int j = unknowns - 1; j >= 0; --j) {
    for (int i = j + 1; i < unknowns; ++i) (*x)[j] -= factor[i][j] * (*x)[i];
    (*x)[j] /= factor[j][j];
  }
}

MapDescent Descend(const MapModel& model, const TexelData& data, const MapPoint& start, const MapBounds& bounds,
                   double loss, TexelObjective* objective, double tolerance, const MapDescent* known) {
  const int unknowns = model.Unknowns();
  const double exact = kExact * static_cast<double>(data.lights.count);
  MapDescent at = {start, 0, false, 0};
  MapVector gradient = {};
  MapMatrix hessian = {};
  double damping = 1e-4;
  bool near = false;
  while (at.iterations < kMostIterations) {
    at.cost = objective->Derivatives(model, data, at.point, loss,
                                     near ? TexelObjective::Curvature::kClipped : TexelObjective::Curvature::kNone,
                                     &gradient, &hessian);
    if (known != nullptr && IsSame(at.point, known->point)) return at;
    std::array<bool, kMostUnknowns> held = {};
    for (int j = 0; j < unknowns; ++j) held[j] = IsHeld(model, at.point, bounds, j, gradient[j]);
    bool moved = false;
    for (; !moved && at.iterations < kMostIterations; ++at.iterations) {
      MapVector step;
      double promised;
      if (!BoundedStep(model, bounds, at.point, gradient, hessian, damping, held, &step, &promised)) {
        damping = std::max(10 * damping, 1e-9);
        if (damping > 1e12) return at;
        continue;
      }
      if (promised <= tolerance * at.cost * (damping < 1e-2 ? 1 : 1e-2) || promised <= exact) {
        at.converged = true;
        return at;
      }
      if (known != nullptr && near && damping < 1e-2 && at.cost - kHopeless * promised > known->cost) return at;
      // A normal turns by at most half a radian a step: beyond, the tangents are no measure.
      const double turn = std::hypot(step[0], step[1]);
      if (turn > 0.5) step[0] *= 0.5 / turn, step[1] *= 0.5 / turn;
      MapPoint next;
      Moved(model, bounds, at.point, step, &next);
      const double cost = near ? objective->Cost(model, data, next, loss)
                               : objective->CostOfShape(model, data, loss, bounds.most_f0, &next);
      if (cost < at.cost) {
        const double quality = (at.cost - cost) / promised;
        damping = quality > 0.75 ? damping * 0.1 : quality < 0.25 ? damping * 4 : damping;
        damping = std::max(damping, 1e-12);
        near = at.cost - cost < kNear * at.cost;
        at.point = next;
        at.cost = cost;
        moved = true;
      } else {
        damping = std::max(10 * damping, 1e-9);
        if (damping > 1e12) return at;
      }
    }
  }
  return at;
}

}  // namespace lobefit
