#include "lobefit/core/instrument/ellipsoid_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

// D, f_r and f_r cos_i cos_o, each with its five derivatives.
constexpr std::size_t kEach = 1 + kEllipsoidParameters, kAll = 3 * kEach;
using Sums = std::array<double, kAll>;

void Add(double weight, const Sums& from, Sums* to) {
  for (std::size_t k = 0; k < kAll; ++k) (*to)[k] += weight * from[k];
}

Sums AtPoint(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi) {
  Sums s;
  s[0] = EllipsoidD(ellipsoid, Normalized(wo + wi), &s[1]);
  double fr[7];
  s[kEach] = EllipsoidConductorBrdf(ellipsoid, index, wo, wi, Masking::kSmithSeparable, fr);
  std::copy(fr, fr + kEllipsoidParameters, &s[kEach + 1]);
  for (std::size_t k = 0; k < kEach; ++k) s[2 * kEach + k] = wi.z * wo.z * s[kEach + k];
  return s;
}

// The cone of half vectors of a disc in the frame where the lobe is a cosine lobe: w is in it where w^T P^-1 w < 0.
struct LobeCone {
  Mat3 to_lobe, from_lobe;  // A^-T and A^T
  double det;               // |A|
  Mat3 P;
  Vec3 axis, across[2];  // `across`: the principal axes of the opening
};

Mat3 OuterSum(const Vec3& b1, const Vec3& b2, const Vec3& b3, double w1, double w2, double w3) {
  const auto row = [&](double x1, double x2, double x3) { return (w3 * x3) * b3 + (w2 * x2) * b2 + (-w1 * x1) * b1; };
  return {{row(b1.x, b2.x, b3.x), row(b1.y, b2.y, b3.y), row(b1.z, b2.z, b3.z)}};
}

// The eigenvector of the one negative eigenvalue: Newton from a bound below it, then a column of the adjugate. `det` is
// given, as its terms cancel.
Vec3 NegativeAxis(const Mat3& m, double det, const Vec3& inside, double below) {
  const Vec3 &x = m.row[0], &y = m.row[1], &z = m.row[2];
  const double a = x.x + y.y + z.z;
  const double b = (x.x * y.y - x.y * x.y) + (x.x * z.z - x.z * x.z) + (y.y * z.z - y.z * y.z);
  double nu = below;
  for (int step = 0; step < 40; ++step) {
    const double rise = (((nu - a) * nu + b) * nu - det) / ((3 * nu - 2 * a) * nu + b);
    nu -= rise;
    if (std::fabs(rise) <= 1e-14 * std::fabs(nu)) break;
  }
  const Vec3 r0 = x - Vec3{nu, 0, 0}, r1 = y - Vec3{0, nu, 0}, r2 = z - Vec3{0, 0, nu};
  return Normalized(Vec3{Dot(Cross(r1, r2), inside), Dot(Cross(r2, r0), inside), Dot(Cross(r0, r1), inside)});
}

LobeCone MakeCone(const Ellipsoid& e, const DirectionPair& pair, double tau) {
  const Mat3 r = EllipsoidRotation(e);
  LobeCone cone;
  cone.to_lobe = {{(1 / e.alpha_x) * r.row[0], (1 / e.alpha_y) * r.row[1], r.row[2]}};
  cone.from_lobe = Transposed(Mat3{{e.alpha_x * r.row[0], e.alpha_y * r.row[1], r.row[2]}});
  cone.det = e.alpha_x * e.alpha_y;
  const PairFrame frame = FrameOf(pair);
  const Vec3 b1 = cone.to_lobe * frame.h, b2 = cone.to_lobe * frame.e2, b3 = cone.to_lobe * frame.e3;
  const double kappa = frame.h2 - tau;
  cone.P = OuterSum(b1, b2, b3, 1 / tau, 1 / (2 - tau), 1 / kappa);
  const double det = -1 / (tau * (2 - tau) * kappa * cone.det * cone.det);
  cone.axis = NegativeAxis(cone.P, det, b1, -Dot(b1, b1) / tau);
  const Vec3 other = std::fabs(cone.axis.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 s = Normalized(Cross(cone.axis, other)), t = Cross(cone.axis, s);
  const double turn = 0.5 * std::atan2(2 * Dot(s, cone.P * t), Dot(s, cone.P * s) - Dot(t, cone.P * t));
  cone.across[0] = std::cos(turn) * s + std::sin(turn) * t;
  cone.across[1] = std::cos(turn) * t - std::sin(turn) * s;
  return cone;
}

// A ray of the cone: azimuth about its axis and what it weighs, the sum being 2 pi.
struct Ray {
  double psi, weight;
};

// The argument in [low, high] at which `state` changes from what it is at `low`.
template <class State>
double ChangeBetween(double low, double high, const State& state) {
  const bool first = state(low);
  for (int step = 0; step < 60 && high - low > 1e-15 * std::fabs(high); ++step) {
    const double middle = 0.5 * (low + high);
    (state(middle) == first ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Equal steps, or where the masking's clamp ends within the disc, whose rim then has two states, Gauss-Legendre panels
// between the ends: what is summed has a kink there.
template <class State>
std::vector<Ray> Rays(int azimuths, const State& at_rim) {
  constexpr int kLooks = 96, kPanels = 4;
  std::vector<double> ends;
  for (int k = 0; k < kLooks; ++k) {
    const double low = 2 * kPi * k / kLooks, high = 2 * kPi * (k + 1) / kLooks;
    if (at_rim(low) != at_rim(high)) ends.push_back(ChangeBetween(low, high, at_rim));
  }
  std::vector<Ray> rays;
  if (ends.empty()) {
    for (int k = 0; k < azimuths; ++k) rays.push_back({2 * kPi * (k + 0.5) / azimuths, 2 * kPi / azimuths});
    return rays;
  }
  const QuadratureRule rule = GaussLegendre(std::max(8, azimuths / 4));
  ends.push_back(ends.front() + 2 * kPi);
  for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
    const double half = 0.5 * (ends[e + 1] - ends[e]) / kPanels;
    for (int panel = 0; panel < kPanels; ++panel) {
      for (std::size_t q = 0; q < rule.nodes.size(); ++q)
        rays.push_back({ends[e] + half * (2 * panel + 1 + rule.nodes[q]), half * rule.weights[q]});
    }
  }
  return rays;
}

// The integral over the disc of `tau` about `moving`, divided by its solid angle; `evaluate` takes the moved direction,
// `clamped` says of one whether its masking is.
template <class Evaluate, class Clamped>
Sums OverDisc(const LobeCone& cone, const Vec3& fixed, double tau, int rings, int azimuths, const Evaluate& evaluate,
              const Clamped& clamped) {
  const QuadratureRule rule = GaussLegendre(rings);
  const double inside = -Dot(cone.axis, cone.P * cone.axis);
  const double open[2] = {std::sqrt(Dot(cone.across[0], cone.P * cone.across[0]) / inside),
                          std::sqrt(Dot(cone.across[1], cone.P * cone.across[1]) / inside)};
  // Equal steps of psi are those on the ellipse that the cone cuts from a plane across its axis.
  const auto rim = [&](double psi) { return Vec2{open[0] * std::cos(psi), open[1] * std::sin(psi)}; };
  const auto normal = [&](const Vec2& at, double theta) {
    const double tangent = std::hypot(at.x, at.y);
    const Vec3 outward = (at.x / tangent) * cone.across[0] + (at.y / tangent) * cone.across[1];
    return cone.from_lobe * (std::cos(theta) * cone.axis + std::sin(theta) * outward);
  };
  const auto moved = [&](const Vec3& m) {
    const Vec3 h = Normalized(m);
    return Normalized(2 * Dot(fixed, h) * h - fixed);
  };
  const auto angle_of = [](const Vec2& at) { return std::atan(std::hypot(at.x, at.y)); };
  const auto state_at = [&](const Vec2& at, double theta) { return clamped(moved(normal(at, theta))); };
  Sums sums = {};
  for (const Ray& ray : Rays(azimuths, [&](double psi) { return state_at(rim(psi), angle_of(rim(psi))); })) {
    const Vec2 at = rim(ray.psi);
    const double angle = angle_of(at), azimuth_weight = ray.weight * open[0] * open[1] / (at.x * at.x + at.y * at.y);
    std::vector<double> ends = {0, angle};
    if (state_at(at, 0) != state_at(at, angle))
      ends.insert(ends.begin() + 1, ChangeBetween(0, angle, [&](double theta) { return state_at(at, theta); }));
    for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
      const double half = 0.5 * (ends[e + 1] - ends[e]);
      for (std::size_t q = 0; q < rule.nodes.size(); ++q) {
        const double theta = ends[e] + half * (1 + rule.nodes[q]);
        const Vec3 m = normal(at, theta);
        const double length = Norm(m);
        // d h = |A| / |A^T w|^3 dw, d wo = 4 (wi . h) dh.
        const double weight = azimuth_weight * half * rule.weights[q] * std::sin(theta) * cone.det /
                              (length * length * length) * 4 * Dot(fixed, m) / length;
        Add(weight / (2 * kPi * tau), evaluate(moved(m)), &sums);
      }
    }
  }
  return sums;
}

// Largest change of a value, or of a derivative relative to the largest derivative of the same value.
double Change(const Sums& a, const Sums& b) {
  double worst = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    double largest = 0, difference = 0;
    for (std::size_t k = 1; k < kEach; ++k) {
      largest = std::max(largest, std::fabs(b[v * kEach + k]));
      difference = std::max(difference, std::fabs(a[v * kEach + k] - b[v * kEach + k]));
    }
    if (b[v * kEach] > 0) worst = std::max(worst, std::fabs(a[v * kEach] / b[v * kEach] - 1));
    if (largest > 0) worst = std::max(worst, 0.01 * difference / largest);
  }
  return worst;
}

// `refine` makes the sums at level 0, 1, ...: until two agree.
template <class Refine>
Sums Converged(const Refine& refine, int most_levels, double precision) {
  Sums last = refine(0);
  for (int level = 1; level < most_levels; ++level) {
    const Sums next = refine(level);
    const bool done = Change(last, next) <= precision;
    last = next;
    if (done) break;
  }
  return last;
}

struct Problem {
  Ellipsoid ellipsoid;
  ConductorIndex index;
};

// Whether G1 of the direction that moves is cut at 1.
bool IsClamped(const Problem& problem, const Vec3& moved, const Vec3& fixed, bool detector) {
  if (!(moved.z > 0 && fixed.z > 0)) return false;
  BrdfFactors factors;
  EllipsoidConductorBrdf(problem.ellipsoid, problem.index, detector ? moved : fixed, detector ? fixed : moved,
                         Masking::kSmithSeparable, nullptr, &factors);
  return detector ? factors.clamped_o : factors.clamped_i;
}

// One disc, the detector's if `detector`, about a pair.
Sums OneDisc(const Problem& problem, const DirectionPair& pair, double tau, bool detector, int most_levels,
             double precision) {
  const auto at = [&](const Vec3& wo, const Vec3& wi) { return AtPoint(problem.ellipsoid, problem.index, wo, wi); };
  if (tau == 0) return at(pair.wo, pair.wi);
  const LobeCone cone = MakeCone(problem.ellipsoid, pair, tau);
  const Vec3& fixed = detector ? pair.wi : pair.wo;
  return Converged(
      [&](int level) {
        return OverDisc(
            cone, fixed, tau, 8 << level, 24 << level,
            [&](const Vec3& moved) { return detector ? at(moved, fixed) : at(fixed, moved); },
            [&](const Vec3& moved) { return IsClamped(problem, moved, fixed, detector); });
      },
      most_levels, precision);
}

}  // namespace

EllipsoidMeans QuadratureMeans(const Ellipsoid& ellipsoid, const ConductorIndex& index, const Vec3& wo, const Vec3& wi,
                               const Aperture& aperture) {
  const Problem problem = {ellipsoid, index};
  const double s = DiscTau(aperture.source), d = DiscTau(aperture.detector);
  const bool detector_is_larger = d >= s;
  const double smaller = std::min(s, d), larger = std::max(s, d);
  Sums sums;
  if (smaller == 0) {
    sums = OneDisc(problem, {wi, wo}, larger, detector_is_larger, 6, 1e-13);
  } else {
    const double chord = std::sqrt(2 * smaller);
    const Vec3 e3 = FrameOf({wi, wo}).e3;
    const Vec3& about = detector_is_larger ? wi : wo;
    const Vec3 along = Cross(e3, about);
    sums = Converged(
        [&](int level) {
          Sums all = {};
          for (const DiscPoint& point : DiscRings(5 << level, 12 << level)) {
            double by[3];
            SetDiscMultiples(point, chord, by);
            const Vec3 moved = by[0] * about + by[1] * along + by[2] * e3;
            const DirectionPair pair = detector_is_larger ? DirectionPair{moved, wo} : DirectionPair{wi, moved};
            Add(point.weight, OneDisc(problem, pair, larger, detector_is_larger, 3, 1e-12), &all);
          }
          return all;
        },
        3, 1e-12);
  }
  const double cosines = wi.z * wo.z * (1 - 0.5 * s) * (1 - 0.5 * d);
  EllipsoidMeans means;
  for (std::size_t k = 0; k < kEach; ++k) {
    double* to[3] = {k == 0 ? &means.D.value : &means.D.gradient[k - 1],
                     k == 0 ? &means.fr.value : &means.fr.gradient[k - 1],
                     k == 0 ? &means.flux.value : &means.flux.gradient[k - 1]};
    *to[0] = sums[k];
    *to[1] = sums[kEach + k];
    *to[2] = sums[2 * kEach + k] / cosines;
  }
  return means;
}

}  // namespace lobefit
