#include "lobefit/maps/engine/descent.h"

#include <algorithm>
#include <cmath>

#include "lobefit/maps/engine/factor.h"

namespace lobefit {
namespace {

constexpr int kMostIterations = 100;
// Of the cost, a light: below, values in single precision say nothing.
constexpr double kExact = 1e-20;

// Of the mean of ln(1 + |r|^2 / c^2) over the lights.
constexpr double kRough = 0.25;
// Below this mean, a point lies in the valley of an end that is known where the cost half way to it lies below the mean
// of both; at 0.25 twice as many of cat's texels ended in a higher minimum.
constexpr double kSmooth = 0.2;
// A decrease below this part of the cost is near the minimum, of one that is rough the second; a descent whose steps
// promise less than `kTrusted` of the cost, and less than a third of what it is behind, will not catch up.
constexpr double kNear = 0.2, kNearOfRough = 1e-4, kTrusted = 0.2, kHopeless = 3;
// Of a rough one: the same as above left 0.46 % of the texels of DiLiGenT's cat in a higher minimum, these 0.08 %, and
// 30 instead of 100 left 0.10 %.
constexpr double kTrustedOfRough = 0.05, kHopelessOfRough = 100;
// Below this ratio of what a step did to what it promised, the quadratic says nothing about it.
constexpr double kFarBeyond = -8;
// A step that promises less than this part of the cost stays in its valley.
constexpr double kClose = 1e-3;
// Where a step promised less than this part of the cost and kept it, what remains is a small part of that.
constexpr double kLastStep = 1e-7;
// Of the cosine between a step and what the gradient changed by beyond what was known.
constexpr double kLeastSecant = 1e-3;
// Of the damping after a step that was refused.
constexpr double kLeastRefused = 1e-3;

// On the way to the same minimum.
bool IsSame(const MapPoint& a, const MapPoint& b) {
  return Dot(a.normal, b.normal) > 0.99999 && std::fabs(a.slope[0] - b.slope[0]) < 0.005 &&
         std::fabs(a.slope[1] - b.slope[1]) < 0.005 && std::fabs(a.width[0] - b.width[0]) < 0.05 &&
         std::fabs(a.width[1] - b.width[1]) < 0.02 && std::fabs(a.width[2] - b.width[2]) < 0.05;
}

// Half way between two shapes.
MapPoint Between(const MapPoint& a, const MapPoint& b) {
  MapPoint middle = a;
  middle.normal = Normalized(a.normal + b.normal);
  for (std::size_t j = 0; j < middle.slope.size(); ++j) middle.slope[j] = 0.5 * (a.slope[j] + b.slope[j]);
  for (std::size_t j = 0; j < middle.width.size(); ++j) middle.width[j] = 0.5 * (a.width[j] + b.width[j]);
  return middle;
}

// Of lights whose ln(1 + |r|^2 / c^2) is 1.
double CostOfWidth(double loss, std::size_t lights) { return 0.5 * loss * loss * static_cast<double>(lights); }

// Where the unknowns stand and may stand; the turns of the normal are 0 and free.
struct Place {
  MapVector value, low, high;
};

Place PlaceOf(const MapModel& model, const MapPoint& point, const MapBounds& bounds) {
  Place place;
  place.value.fill(0), place.low.fill(-1e300), place.high.fill(1e300);
  for (int j = 0; j < 2 && !model.TurnsNormal(); ++j) {
    place.value[j] = point.slope[j], place.low[j] = -bounds.most_slope, place.high[j] = bounds.most_slope;
  }
  for (int j = 2; j < model.Shape(); ++j) {
    place.value[j] = point.width[j - 2];
    // The middle one of three, b, says how the two widths lean.
    const bool logarithm = model.lobe == MapLobe::kGgx || j != 3;
    place.low[j] = logarithm ? bounds.least_width : -1, place.high[j] = logarithm ? bounds.most_width : 1;
  }
  for (int c = 0; c < model.channels; ++c) {
    place.value[model.DiffuseAt(c)] = point.diffuse[c], place.low[model.DiffuseAt(c)] = 0;
    if (model.lobe == MapLobe::kNone) continue;
    place.value[model.F0At(c)] = point.f0[c];
    place.low[model.F0At(c)] = 0, place.high[model.F0At(c)] = bounds.amplitudes.most_f0;
  }
  return place;
}

// The point after a step; a normal that would turn from the camera stays at the least n_z.
MapPoint Moved(const MapModel& model, const MapBounds& bounds, const MapPoint& from, const Place& place,
               const MapVector& step) {
  MapPoint to = from;
  const auto moved = [&](int j) { return std::clamp(place.value[j] + step[j], place.low[j], place.high[j]); };
  if (!model.TurnsNormal()) {
    to.slope = {moved(0), moved(1)};
  } else if (!bounds.normal_held) {
    const MapFrame frame = FrameOf(from.normal);
    to.normal = Normalized(frame.n + step[0] * frame.t + step[1] * frame.b);
  }
  if (!bounds.normal_held && to.normal.z < bounds.least_normal_z) {
    const double flat = std::hypot(to.normal.x, to.normal.y), z = bounds.least_normal_z;
    const double keep = std::sqrt(1 - z * z) / flat;
    to.normal = {keep * to.normal.x, keep * to.normal.y, z};
  }
  for (int j = 2; j < model.Shape(); ++j) to.width[j - 2] = moved(j);
  for (int c = 0; c < model.channels; ++c) {
    to.diffuse[c] = moved(model.DiffuseAt(c));
    if (model.lobe != MapLobe::kNone) to.f0[c] = moved(model.F0At(c));
  }
  return to;
}

std::array<bool, kMostUnknowns> HeldAt(const MapModel& model, const Place& place, const MapBounds& bounds,
                                       const MapVector& gradient) {
  std::array<bool, kMostUnknowns> held = {};
  const auto hold = [&](int j, bool from_elsewhere) {
    held[j] = from_elsewhere || (place.value[j] <= place.low[j] && gradient[j] >= 0) ||
              (place.value[j] >= place.high[j] && gradient[j] <= 0);
  };
  for (int j = 0; j < 2; ++j) hold(j, model.TurnsNormal() ? bounds.normal_held : bounds.slope_held);
  for (int j = 2; j < model.Shape(); ++j) hold(j, bounds.width_held);
  for (int c = 0; c < model.channels; ++c) {
    hold(model.DiffuseAt(c), bounds.amplitudes.diffuse_held);
    if (model.lobe != MapLobe::kNone) hold(model.F0At(c), bounds.amplitudes.f0_held);
  }
  return held;
}

// The decrease that the quadratic promises for a step.
double Promised(int unknowns, const MapVector& gradient, const MapMatrix& hessian, const MapVector& step) {
  double promised = 0;
  for (int j = 0; j < unknowns; ++j) {
    double bent = 0;
    for (int k = 0; k < unknowns; ++k) bent += hessian[j][k] * step[k];
    promised -= step[j] * (gradient[j] + 0.5 * bent);
  }
  return promised;
}

// The same where the step solves (H + damping diag H) step = -gradient, and is 0 where it does not.
double PromisedFree(int unknowns, const MapVector& gradient, const MapMatrix& hessian, double damping,
                    const MapVector& step) {
  double promised = 0;
  for (int j = 0; j < unknowns; ++j) promised += 0.5 * step[j] * (damping * hessian[j][j] * step[j] - gradient[j]);
  return promised;
}

// The damped step, and the decrease that the quadratic promises. What would leave its bounds goes as far as they are,
// and the others follow. False where the damped matrix is not positive definite.
bool BoundedStep(int unknowns, const Place& place, const MapVector& gradient, const MapMatrix& hessian, double damping,
                 const std::array<bool, kMostUnknowns>& held, MapVector* step, double* promised) {
  std::array<bool, kMostUnknowns> fixed = held;
  MapVector known = {};  // steps of what is fixed
  for (int round = 0; round <= unknowns; ++round) {
    MapMatrix factor = hessian;
    for (int j = 0; j < unknowns; ++j) {
      factor[j][j] += damping * hessian[j][j] + 1e-300;
      (*step)[j] = fixed[j] ? 0 : -gradient[j];
      for (int k = 0; round > 0 && !fixed[j] && k < unknowns; ++k) (*step)[j] -= hessian[j][k] * known[k];
    }
    if (!Factorise(unknowns, fixed, &factor)) return false;
    SolveFactorised(unknowns, factor, step);
    int leaving = -1;
    double most = 0;
    for (int j = 0; j < unknowns; ++j) {
      if (fixed[j]) {
        (*step)[j] = known[j];
        continue;
      }
      const double value = place.value[j] + (*step)[j];
      const double beyond = std::max(place.low[j] - value, value - place.high[j]);
      if (beyond > most) {
        most = beyond, leaving = j;
        known[j] = ((*step)[j] < 0 ? place.low[j] : place.high[j]) - place.value[j];
      }
    }
    if (leaving < 0) {
      *promised = round == 0 ? PromisedFree(unknowns, gradient, hessian, damping, *step)
                             : Promised(unknowns, gradient, hessian, *step);
      return true;
    }
    for (int j = 0; j < unknowns; ++j) known[j] = j == leaving || fixed[j] ? known[j] : 0;
    fixed[leaving] = true;
  }
  *promised = Promised(unknowns, gradient, hessian, *step);
  return true;
}

// The matrix leaves out the model's own second derivatives: `secant` gathers them from the changes of the gradient over
// the steps, each of rank one [symmetric rank one, Conn, Gould and Toint 1991; structured as Dennis, Gay and Welsch
// 1981].
void UpdateSecant(int unknowns, const std::array<bool, kMostUnknowns>& held, const MapVector& step,
                  const MapVector& before, const MapVector& gradient, const MapMatrix& hessian, MapMatrix* secant) {
  MapVector missing = {};
  double along = 0, whole = 0, size = 0;
  for (int j = 0; j < unknowns; ++j) {
    if (held[j]) continue;
    double bent = 0, known = 0;
    for (int k = 0; k < unknowns; ++k) {
      if (held[k]) continue;
      bent += hessian[j][k] * step[k], known += (*secant)[j][k] * step[k];
    }
    missing[j] = gradient[j] - before[j] - bent - known;
    along += missing[j] * step[j], whole += bent * step[j];
    size += missing[j] * missing[j] / hessian[j][j];
  }
  // Near 0 the quotient says nothing.
  if (!(std::fabs(along) > kLeastSecant * std::sqrt(whole * size))) return;
  for (int j = 0; j < unknowns; ++j) {
    for (int k = 0; k < unknowns; ++k) (*secant)[j][k] += missing[j] * missing[k] / along;
  }
}

}  // namespace

bool IsRough(double cost, double loss, std::size_t lights) { return cost > kRough * CostOfWidth(loss, lights); }

int FreeUnknowns(const MapModel& model, const MapBounds& bounds) {
  const int turns = (model.TurnsNormal() ? bounds.normal_held : bounds.slope_held) ? 0 : 2;
  const int widths = bounds.width_held ? 0 : model.Shape() - 2;
  const int amplitudes =
      (bounds.amplitudes.diffuse_held ? 0 : 1) + (model.lobe == MapLobe::kNone || bounds.amplitudes.f0_held ? 0 : 1);
  return turns + widths + model.channels * amplitudes;
}

std::array<bool, kMostUnknowns> HeldUnknowns(const MapModel& model, const MapPoint& point, const MapBounds& bounds,
                                             const MapVector& gradient) {
  return HeldAt(model, PlaceOf(model, point, bounds), bounds, gradient);
}

MapDescent Descend(const MapModel& model, const TexelData& data, const MapPoint& start, const MapBounds& bounds,
                   double loss, TexelObjective* objective, double tolerance, const MapDescent* known) {
  const int unknowns = model.Unknowns();
  const double exact = kExact * static_cast<double>(data.lights.count);
  MapDescent at = {start, 0, false, 0};
  MapVector gradient = {}, next_gradient = {}, before = {}, step = {};
  // Turned about, not copied.
  MapMatrix matrices[2] = {}, secant = {}, with_secant = {};
  MapMatrix *hessian = &matrices[0], *next_hessian = &matrices[1];
  bool has_secant = false;
  double damping = 1e-4;
  bool near = false, was_near = false, known_here = false;
  while (at.iterations < kMostIterations) {
    if (!known_here) {
      at.cost = objective->Derivatives(model, data, at.point, loss, near ? Curvature::kClipped : Curvature::kNone,
                                       &gradient, hessian);
    }
    if (known != nullptr && IsSame(at.point, known->point)) return at;
    if (known != nullptr && known->converged && known->cost < kSmooth * CostOfWidth(loss, data.lights.count)) {
      MapPoint middle = Between(at.point, known->point);
      const double cost = objective->CostOfShape(model, data, objective->weight(), loss, bounds.amplitudes, &middle);
      if (cost > known->cost && cost < 0.5 * (known->cost + at.cost)) return at;
    }
    const Place place = PlaceOf(model, at.point, bounds);
    const std::array<bool, kMostUnknowns> held = HeldAt(model, place, bounds, gradient);
    if (was_near) UpdateSecant(unknowns, held, step, before, gradient, *hessian, &secant);
    if (!was_near && has_secant) secant = {};
    has_secant = was_near;
    bool corrected = has_secant;
    for (int j = 0; corrected && j < unknowns; ++j) {
      for (int k = 0; k < unknowns; ++k) with_secant[j][k] = (*hessian)[j][k] + secant[j][k];
    }
    bool moved = false;
    for (; !moved && at.iterations < kMostIterations; ++at.iterations) {
      double promised;
      if (!BoundedStep(unknowns, place, gradient, corrected ? with_secant : *hessian, damping, held, &step,
                       &promised)) {
        if (corrected) {
          corrected = false;
          continue;
        }
        damping = std::max(10 * damping, 1e-9);
        if (damping > 1e12) return at;
        continue;
      }
      if (promised <= tolerance * at.cost * (damping < 1e-2 ? 1 : 1e-2) || promised <= exact) {
        at.converged = true;
        return at;
      }
      const bool rough = IsRough(at.cost, loss, data.lights.count);
      if (known != nullptr && promised < (rough ? kTrustedOfRough : kTrusted) * at.cost && damping < 1e-2 &&
          at.cost - (rough ? kHopelessOfRough : kHopeless) * promised > known->cost)
        return at;
      // A normal turns by at most half a radian a step: beyond, the tangents are no measure.
      const double turn = std::hypot(step[0], step[1]);
      if (turn > 0.5) step[0] *= 0.5 / turn, step[1] *= 0.5 / turn;
      MapPoint next;
      double cost;
      const auto attempt = [&] {
        next = Moved(model, bounds, at.point, place, step);
        // Near the minimum nearly all steps are taken: their derivatives come with the cost.
        cost = near ? objective->Derivatives(model, data, next, loss, Curvature::kClipped, &next_gradient, next_hessian)
                    : objective->CostOfShape(model, data, objective->weight(), loss, bounds.amplitudes, &next);
        return (at.cost - cost) / promised;
      };
      double quality = attempt();
      if (quality <= 0 && quality > kFarBeyond && near && promised < kClose * at.cost) {
        // The parabola through cost, slope and this cost has its minimum before.
        for (int j = 0; j < unknowns; ++j) step[j] /= 2 - quality;
        quality = attempt();
        ++at.iterations;
        damping = std::max(damping, 1e-4);
      }
      if (cost < at.cost) {
        damping = quality > 0.75 ? damping * 0.1 : quality < 0.25 ? damping * 4 : damping;
        damping = std::max(damping, 1e-12);
        was_near = near && promised < kClose * at.cost;
        before = gradient;
        const double near_below = IsRough(cost, loss, data.lights.count) ? kNearOfRough : kNear;
        const bool is_near = at.cost - cost < near_below * at.cost;
        known_here = near && is_near;
        near = is_near;
        if (known_here) gradient = next_gradient, std::swap(hessian, next_hessian);
        at.point = next;
        at.cost = cost;
        moved = true;
        if (was_near && promised <= kLastStep * at.cost && quality > 0.5 && quality < 1.5) {
          at.converged = true;
          return at;
        }
      } else {
        damping = std::max(10 * damping, kLeastRefused);
        corrected = false;
        if (damping > 1e12) return at;
      }
    }
  }
  return at;
}

}  // namespace lobefit
