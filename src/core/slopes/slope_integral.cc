#include "lobefit/core/slopes/slope_integral.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/core/slopes/slope_vector.h"
#include "lobefit/math/quadrature.h"
#include "lobefit/math/special.h"

namespace lobefit {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// A number as an unevaluated sum, and the exact difference of two doubles in that form (Knuth).
struct Pair {
  double high, low;
};
Pair ExactDifference(double a, double b) {
  const double difference = a - b, part = difference - a;
  return {difference, (a - (difference - part)) - (b + part)};
}

// Twice the signed area of the triangle, relative error of a few eps however thin it is: differences and products with
// their errors.
double TwiceArea(const std::array<Vec2, 3>& p) {
  const Pair ax = ExactDifference(p[1].x, p[0].x), ay = ExactDifference(p[1].y, p[0].y);
  const Pair bx = ExactDifference(p[2].x, p[0].x), by = ExactDifference(p[2].y, p[0].y);
  const double first = ax.high * by.high, second = ay.high * bx.high;
  const double first_error = std::fma(ax.high, by.high, -first), second_error = std::fma(ay.high, bx.high, -second);
  const Pair main = ExactDifference(first, second);
  return main.high + (main.low + (first_error - second_error) + (ax.high * by.low + ax.low * by.high) -
                      (ay.high * bx.low + ay.low * bx.high));
}

// Everything that the forms below need of the edge from p along d, in slopes divided by alpha.
struct Edge {
  Edge(const Vec2& p, const Vec2& d) : begin(p), side(d) {
    const Vec2 end = p + d;
    cross = Cross2(p, d);
    n = std::sqrt(cross * cross + Dot2(d, d));
    angle = std::atan2(n, 1 + Dot2(p, end));
    q0 = 1 + Dot2(p, p);
    q1 = 1 + Dot2(end, end);
    f = n > 0 ? angle / n : 1 / q0;
  }
  // Integrals over t in [0, 1] of 1, t and 1 - t times 1 / (1 + |p + t d|^2)^2. With B + C t = n tan(phi) they are
  // trigonometric in the angle that the edge spans; no term of the first is negative and the others lose at most half a
  // digit.
  struct Moments {
    double all, towards_end, towards_begin;
  };
  Moments LineIntegrals() const {
    const double cubed = n * n * n;
    const double x = cubed > 0 ? XMinusSin(2 * angle) / (2 * cubed) : 2 / (3 * q0 * q0 * q0);
    const double ends = 1 / (q0 * q1);
    const Vec2 end = begin + side;
    return {ends + 0.5 * x * Dot2(side, side), 0.5 * (ends - x * Dot2(begin, side)),
            0.5 * (ends + x * Dot2(end, side))};
  }

  Vec2 begin, side;
  double cross, n, angle, q0, q1, f;
};

// A triangle in slopes divided by alpha. The sides are differences of the original vertices, scaled afterwards.
struct ScaledTriangle {
  std::array<Vec2, 3> vertex, side;
};

ScaledTriangle Scale(const std::array<Vec2, 3>& vertices, double alpha_x, double alpha_y) {
  ScaledTriangle t;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec2 d = vertices[(i + 1) % 3] - vertices[i];
    t.vertex[i] = {vertices[i].x / alpha_x, vertices[i].y / alpha_y};
    t.side[i] = {d.x / alpha_x, d.y / alpha_y};
  }
  return t;
}

// Radon's rule of degree 5 over the triangle: sum of weight * f(point); the weights add up to 1.
template <class F>
double SevenPoints(const ScaledTriangle& t, const F& f) {
  static const double root = std::sqrt(15.0);
  const Vec2 a = t.vertex[0], b = t.side[0], c = -1.0 * t.side[2];
  const auto at = [&](double s, double r) { return f(a + s * b + r * c); };
  double sum = 9.0 / 40 * at(1.0 / 3, 1.0 / 3);
  for (const double sign : {-1.0, 1.0}) {
    const double near = (6 + sign * root) / 21, weight = (155 + sign * root) / 1200;
    sum += weight * (at(near, near) + at(1 - 2 * near, near) + at(near, 1 - 2 * near));
  }
  return sum;
}

bool IsSmall(const ScaledTriangle& t) {
  double largest = 0, nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    largest = std::fmax(largest, std::fmax(std::fabs(t.side[i].x), std::fabs(t.side[i].y)));
    nearest = std::fmin(nearest, Dot2(t.vertex[i], t.vertex[i]));
  }
  return largest * largest < 0.02 * 0.02 * (1 + nearest);
}

double Density(const Vec2& p) {
  const double q = 1 + Dot2(p, p);
  return kInvPi / (q * q);
}

// int_0^1 s (integral over t of Density pi at vertex 0 + s (side 0 + t side 1)) ds: the mean over the triangle, all
// terms positive.
double ShrinkingEdge(const ScaledTriangle& t) {
  const Vec2 apex = t.vertex[0], to_edge = t.side[0] + 0.5 * t.side[1];
  const auto shrunk = [&](double s) {
    return std::array<double, 1>{s * Edge(apex + s * t.side[0], s * t.side[1]).LineIntegrals().all};
  };
  // Breaks around the place nearest to the origin, in steps of the width over which the density changes there.
  std::vector<double> breaks = {0, 1};
  const double length2 = Dot2(to_edge, to_edge);
  if (length2 > 0) {
    const double nearest = -Dot2(apex, to_edge) / length2;
    const Vec2 p = apex + nearest * to_edge;
    for (double step = std::sqrt((1 + Dot2(p, p)) / length2); step < 2 * (1 + std::fabs(nearest)); step *= 8) {
      for (const double s : {nearest - step, nearest, nearest + step}) {
        if (s > 0 && s < 1) breaks.push_back(s);
      }
    }
    std::sort(breaks.begin(), breaks.end());
  }
  return IntegrateAdaptive<1>(shrunk, breaks, {2e-14, 0, 500}).value[0];
}

// The integral of Density over the triangle; `twice_area`, with sign, is known better than from the scaled sides.
double UnitIntegral(const ScaledTriangle& t, double twice_area) {
  if (twice_area == 0) return 0;
  if (IsSmall(t)) return 0.5 * std::fabs(twice_area) * SevenPoints(t, Density);
  const Edge e0(t.vertex[0], t.side[0]), e1(t.vertex[1], t.side[1]), e2(t.vertex[2], t.side[2]);
  const double plain = std::fabs(e0.cross) * e0.f + std::fabs(e1.cross) * e1.f + std::fabs(e2.cross) * e2.f;
  // In differences the large part, the area, is exact; huge triangles are better off with the plain sum.
  const double sum = e0.f * std::fabs(twice_area) <= plain
                         ? e0.f * twice_area + e1.cross * (e1.f - e0.f) + e2.cross * (e2.f - e0.f)
                         : e0.cross * e0.f + e1.cross * e1.f + e2.cross * e2.f;
  if (2 * kEps * plain < 1e-13 * std::fabs(sum)) return std::fabs(sum) / (2 * kPi);
  return std::fabs(twice_area) * kInvPi * ShrinkingEdge(t);
}

// Adds the derivatives of the counter-clockwise integral of the unit distribution by the vertices (in scaled slopes):
// an edge's vertex sweeps density times outward normal times its share of the edge.
void AddVertexDerivatives(const Edge& edge, double sign, Vec2* begin, Vec2* end) {
  const Edge::Moments moments = edge.LineIntegrals();
  const Vec2 normal = {sign * kInvPi * edge.side.y, -sign * kInvPi * edge.side.x};
  *begin = *begin + moments.towards_begin * normal;
  *end = *end + moments.towards_end * normal;
}

// The triangle with its orientation: `sign` is +1 for counter-clockwise (and for no area), else -1.
double SignedIntegral(const std::array<Vec2, 3>& vertices, double alpha_x, double alpha_y, double* sign,
                      GgxTriangleGradient* gradient) {
  const ScaledTriangle t = Scale(vertices, alpha_x, alpha_y);
  const double area = TwiceArea(vertices) / (alpha_x * alpha_y);
  *sign = area < 0 ? -1 : 1;
  const double integral = UnitIntegral(t, area);
  if (gradient == nullptr) return integral;
  std::array<Vec2, 3> d = {};
  for (std::size_t i = 0; i < 3; ++i) {
    AddVertexDerivatives(Edge(t.vertex[i], t.side[i]), *sign, &d[i], &d[(i + 1) % 3]);
  }
  double by_x = 0, by_y = 0;
  if (IsSmall(t)) {
    // dI/dalpha_x = -1/alpha_x int (Density + X dDensity/dX): over the area, since the boundary terms of a small
    // triangle cancel.
    const auto weighted = [](const Vec2& p, double c) { return Density(p) * (1 - 4 * c * c / (1 + Dot2(p, p))); };
    by_x = -0.5 * std::fabs(area) * SevenPoints(t, [&](const Vec2& p) { return weighted(p, p.x); });
    by_y = -0.5 * std::fabs(area) * SevenPoints(t, [&](const Vec2& p) { return weighted(p, p.y); });
  } else {
    for (std::size_t i = 0; i < 3; ++i) {
      by_x -= t.vertex[i].x * d[i].x;
      by_y -= t.vertex[i].y * d[i].y;
    }
  }
  gradient->dalpha_x = by_x / alpha_x;
  gradient->dalpha_y = by_y / alpha_y;
  for (std::size_t i = 0; i < 3; ++i) gradient->dvertices[i] = {d[i].x / alpha_x, d[i].y / alpha_y};
  return integral;
}

}  // namespace

double GgxSlopeDensity(const Vec2& s, double alpha_x, double alpha_y) {
  return Density({s.x / alpha_x, s.y / alpha_y}) / (alpha_x * alpha_y);
}

double GgxTriangleIntegral(const std::array<Vec2, 3>& vertices, double alpha_x, double alpha_y,
                           GgxTriangleGradient* gradient) {
  double sign = 1;
  return SignedIntegral(vertices, alpha_x, alpha_y, &sign, gradient);
}

double GgxPolygonIntegral(const std::vector<Vec2>& vertices, double alpha_x, double alpha_y,
                          GgxPolygonGradient* gradient) {
  double sum = 0;
  if (gradient != nullptr) *gradient = {0, 0, std::vector<Vec2>(vertices.size(), Vec2{0, 0})};
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
    GgxTriangleGradient part;
    double sign = 1;
    const double integral = SignedIntegral({vertices[0], vertices[i], vertices[i + 1]}, alpha_x, alpha_y, &sign,
                                           gradient != nullptr ? &part : nullptr);
    sum += sign * integral;
    if (gradient == nullptr) continue;
    gradient->dalpha_x += sign * part.dalpha_x;
    gradient->dalpha_y += sign * part.dalpha_y;
    const std::array<std::size_t, 3> index = {0, i, i + 1};
    for (std::size_t j = 0; j < 3; ++j) {
      gradient->dvertices[index[j]] = gradient->dvertices[index[j]] + sign * part.dvertices[j];
    }
  }
  if (sum < 0) {
    sum = -sum;
    if (gradient != nullptr) {
      gradient->dalpha_x = -gradient->dalpha_x;
      gradient->dalpha_y = -gradient->dalpha_y;
      for (Vec2& d : gradient->dvertices) d = -1.0 * d;
    }
  }
  return sum;
}

}  // namespace lobefit
