#include "lobefit/core/instrument/aperture.h"

#include <algorithm>
#include <cmath>

#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr int kMostNodes = 40;

}  // namespace

double DiscTau(double half_angle) {
  const double s = std::sin(0.5 * half_angle);
  return 2 * s * s;
}

double DetectorShare(const Aperture& aperture) {
  const double s = DiscTau(aperture.source), d = DiscTau(aperture.detector);
  return d / (s + d);
}

std::vector<DiscNode> DiscNodes(const Aperture& aperture, int n) {
  const double s = DiscTau(aperture.source), d = DiscTau(aperture.detector);
  if (s == 0 || d == 0) return {{s + d, 1.0}};
  std::vector<DiscNode> nodes;
  for (int k = 1; k <= n; ++k) {
    const double t = k * kPi / (n + 1), sine = std::sin(t);
    nodes.push_back({s + d + 2 * std::sqrt(s * d) * std::cos(t), 2 * sine * sine / (n + 1)});
  }
  return nodes;
}

double RelativeDiscWidth(double half_angle, double alpha, double cos_d) { return half_angle / (2 * alpha * cos_d); }

int DiscNodeCount(const Aperture& aperture, double alpha, double cos_d) {
  const double smaller = std::min(aperture.source, aperture.detector);
  if (smaller == 0) return 1;
  const double n = std::ceil(2 + 2.4 * RelativeDiscWidth(smaller, alpha, cos_d));
  return n < kMostNodes ? static_cast<int>(n) : kMostNodes;
}

const std::vector<DiscPoint>& SevenDiscPoints() {
  static const std::vector<DiscPoint> points = [] {
    std::vector<DiscPoint> all = {{0, 0, 0.25}};
    for (int k = 0; k < 6; ++k) {
      const double radius = std::sqrt(2.0 / 3), phi = k * kPi / 3;
      all.push_back({radius * std::cos(phi), radius * std::sin(phi), 0.125});
    }
    return all;
  }();
  return points;
}

std::vector<DiscPoint> DiscRings(int rings, int azimuths) {
  const QuadratureRule rule = GaussLegendre(rings);
  std::vector<DiscPoint> points;
  for (int r = 0; r < rings; ++r) {
    const std::size_t at = static_cast<std::size_t>(r);
    const double radius = std::sqrt(0.5 * (1 + rule.nodes[at]));
    for (int k = 0; k < azimuths; ++k) {
      const double phi = 2 * kPi * (k + (r % 2) * 0.5) / azimuths;
      points.push_back({radius * std::cos(phi), radius * std::sin(phi), 0.5 * rule.weights[at] / azimuths});
    }
  }
  return points;
}

PairFrame FrameOf(const DirectionPair& pair) {
  constexpr double kSame = 1e-6;  // below it the azimuth about h no longer matters: its effect is the square of this
  const Vec3 sum = pair.wi + pair.wo, difference = pair.wi - pair.wo;
  PairFrame frame;
  frame.h = Normalized(sum);
  frame.h2 = 0.5 * Dot(sum, sum);
  const Vec3 axis = std::fabs(frame.h.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 along = Norm(difference) > kSame ? difference : Cross(frame.h, axis);
  frame.e2 = Normalized(along - Dot(frame.h, along) * frame.h);
  frame.e3 = Cross(frame.h, frame.e2);
  return frame;
}

void SetDiscMultiples(const DiscPoint& point, double chord, double multiples[3]) {
  const double along = chord * point.p, across = chord * point.q, chord2 = along * along + across * across;
  const double stretch = std::sqrt(1 - 0.25 * chord2);
  multiples[0] = 1 - 0.5 * chord2;
  multiples[1] = stretch * along;
  multiples[2] = stretch * across;
}

}  // namespace lobefit
