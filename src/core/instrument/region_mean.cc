#include "lobefit/core/instrument/region_mean.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/slopes/slope_integral.h"

namespace lobefit {
namespace {

// Corners where an edge's image in the slope plane bends.
constexpr int kPiecesOfSide = 16, kPiecesOfHorizon = 16, kDiscCorners = 64;
// Points between a region's middle and its rim: two of each ring.
constexpr int kRings = 6;
constexpr double kGauss = 0.5773502691896258;

Vec3 Between(const Vec3& a, const Vec3& b, double share) { return Normalized((1 - share) * a + share * b); }

// Integral of w'.n over a spherical polygon [Lambert].
double CosineIntegral(const std::vector<Vec3>& corners, const Vec3& n) {
  double sum = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()], normal = Cross(a, b);
    const double sine = Norm(normal);
    if (sine > 0) sum += std::atan2(sine, Dot(a, b)) * Dot(normal, n) / sine;
  }
  return 0.5 * sum;
}

std::vector<Vec3> CornersAbout(const Vec3& w, const DirectionRegion& region) {
  constexpr double kUpright = 1e-9;
  const double sine = std::hypot(w.x, w.y);
  const Vec3 across = sine > kUpright ? Vec3{-w.y / sine, w.x / sine, 0} : Vec3{0, 1, 0}, along = Cross(across, w);
  std::vector<Vec3> corners;
  for (const std::array<double, 3>& by : region.corners)
    corners.push_back(Normalized(by[0] * w + by[1] * along + by[2] * across));
  return corners;
}

// The part above the horizon; the cut edge in pieces.
std::vector<Vec3> AboveHorizon(const std::vector<Vec3>& corners) {
  std::vector<Vec3> above;
  std::optional<std::size_t> leaves_at;  // place of the corner where the boundary goes below
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    if (a.z >= 0) above.push_back(a);
    if ((a.z >= 0) == (b.z >= 0)) continue;
    Vec3 crossing = Between(a, b, a.z / (a.z - b.z));
    crossing.z = 0;
    if (a.z >= 0) leaves_at = above.size();
    above.push_back(crossing);
  }
  if (!leaves_at) return above;
  const Vec3 from = above[*leaves_at], to = above[(*leaves_at + 1) % above.size()];
  std::vector<Vec3> pieces;
  for (int k = 1; k < kPiecesOfHorizon; ++k) pieces.push_back(Between(from, to, k / double{kPiecesOfHorizon}));
  above.insert(above.begin() + static_cast<std::ptrdiff_t>(*leaves_at) + 1, pieces.begin(), pieces.end());
  return above;
}

// Slopes of the half vectors of wi and the corners, in units in which the lobe is round and of width 1, and the
// integral of its distribution over their polygon.
double SlopeIntegral(const Vec3& wi, const std::vector<Vec3>& corners, const SlopeCoordinates& shape,
                     double* gradient) {
  const double a = std::exp(shape.v[2]), b = shape.v[3], c = std::exp(shape.v[4]);
  std::vector<Vec2> slopes;
  for (const Vec3& w : corners) {
    const Vec3 h = wi + w;
    const double x = (-h.x / h.z - shape.v[0]) / a;
    slopes.push_back({x, (-h.y / h.z - shape.v[1] - b * x) / c});
  }
  if (gradient == nullptr) return GgxPolygonIntegral(slopes, 1, 1);
  GgxPolygonGradient by;
  const double value = GgxPolygonIntegral(slopes, 1, 1, &by);
  std::fill(gradient, gradient + 5, 0.0);
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const Vec2 t = slopes[k], d = by.dvertices[k];
    gradient[0] += -d.x / a + d.y * b / (a * c);
    gradient[1] += -d.y / c;
    gradient[2] += -d.x * t.x + d.y * b * t.x / c;
    gradient[3] += -d.y * t.x / c;
    gradient[4] += -d.y * t.y;
  }
  return value;
}

// Where the lobe is high in a convex region: the mirror direction of its middle normal if it lies within, else the
// region's own middle.
Vec3 MiddleOf(const std::vector<Vec3>& corners, const Vec3& wi, const SlopeCoordinates& shape) {
  const Vec3 normal = Normalized(Vec3{-shape.v[0], -shape.v[1], 1}), mirror = 2 * Dot(normal, wi) * normal - wi;
  Vec3 sum = {0, 0, 0};
  bool left = true, right = true;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
    const double side = Dot(Cross(a, b), mirror);
    left = left && side >= 0;
    right = right && side <= 0;
    sum = sum + a;
  }
  return left || right ? mirror : Normalized(sum);
}

// Points between the middle of a convex region and its rim, denser towards the middle, with the area that each stands
// for; those above the horizon.
class RegionPoints {
 public:
  RegionPoints(const Vec3& wi, const std::vector<Vec3>& corners, const Vec3& middle) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3 a = corners[k] - middle, b = corners[(k + 1) % corners.size()] - middle, edge = 0.5 * (a + b);
      const double twice_area = Norm(Cross(a, b));
      for (int ring = 0; ring < kRings; ++ring) {
        const double low = ring * ring / double{kRings * kRings};
        const double high = (ring + 1) * (ring + 1) / double{kRings * kRings};
        for (const double node : {-kGauss, kGauss}) {
          const double t = 0.5 * (low + high) + 0.5 * (high - low) * node;
          Add(wi, Normalized(middle + t * edge), 0.5 * (high - low) * t * twice_area);
        }
      }
    }
  }
  std::size_t size() const { return area_.size(); }
  double area(std::size_t k) const { return area_[k]; }
  double cosine(std::size_t k) const { return at_[5][k]; }
  DirectionArrays pairs() const {
    return {at_[0].data(), at_[1].data(), at_[2].data(), at_[3].data(), at_[4].data(), at_[5].data(), size()};
  }
  VectorArrays normals() const { return {at_[6].data(), at_[7].data(), at_[8].data(), size()}; }

 private:
  void Add(const Vec3& wi, const Vec3& wo, double area) {
    if (!(wo.z > 0)) return;
    const Vec3 h = Normalized(wi + wo);
    const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, h.x, h.y, h.z};
    for (std::size_t f = 0; f < at_.size(); ++f) at_[f].push_back(all[f]);
    area_.push_back(area);
  }
  std::array<std::vector<double>, 9> at_;  // wi, wo, their half vector
  std::vector<double> area_;
};

// Sums over points of a region, with their derivatives by the slope coordinates, `stride` apart; null: none.
struct Sum {
  double value = 0, gradient[5] = {};
  void Add(double weight, double f, const double* df, std::size_t stride) {
    value += weight * f;
    for (std::size_t j = 0; df != nullptr && j < 5; ++j) gradient[j] += weight * df[j * stride];
  }
};

}  // namespace

DirectionRegion DiscRegion(double half_angle) {
  // The rim's radius in the plane of an equal-area map, and further out by what the polygon lacks.
  const double step = 2 * kPi / kDiscCorners, radius = half_angle * std::sqrt(step / std::sin(step));
  DirectionRegion region;
  for (int k = 0; k < kDiscCorners; ++k) {
    const double phi = (k + 0.5) * step;
    region.corners.push_back({std::cos(radius), std::sin(radius) * std::cos(phi), std::sin(radius) * std::sin(phi)});
  }
  region.cosine = kPi * std::sin(half_angle) * std::sin(half_angle);
  return region;
}

DirectionRegion RectangleRegion(double along, double across) {
  const double x = std::tan(along), y = std::tan(across);
  const Vec2 corners[] = {{x, y}, {-x, y}, {-x, -y}, {x, -y}};
  DirectionRegion region;
  std::vector<Vec3> flat;
  for (std::size_t side = 0; side < 4; ++side) {
    const Vec2 &from = corners[side], &to = corners[(side + 1) % 4];
    flat.push_back(Normalized(Vec3{from.x, from.y, 1}));
    for (int k = 0; k < kPiecesOfSide; ++k) {
      const double share = k / double{kPiecesOfSide};
      region.corners.push_back({1, (1 - share) * from.x + share * to.x, (1 - share) * from.y + share * to.y});
    }
  }
  region.cosine = CosineIntegral(flat, {0, 0, 1});
  return region;
}

double ConstantMean(const Vec3& w, const DirectionRegion& region) {
  return CosineIntegral(AboveHorizon(CornersAbout(w, region)), {0, 0, 1}) / (region.cosine * w.z);
}

double GgxRegionMean(const Vec3& wi, const Vec3& wo, const SlopeCoordinates& shape, Masking masking,
                     const DirectionRegion& region, FresnelArgument kind, double* argument, double gradient[5],
                     double argument_gradient[5]) {
  const bool derivatives = gradient != nullptr;
  const std::vector<Vec3> corners = AboveHorizon(CornersAbout(wo, region));
  *argument = 0;
  if (corners.size() < 3) {
    for (int j = 0; derivatives && j < 5; ++j) gradient[j] = argument_gradient[j] = 0;
    return 0;
  }
  double by_integral[5];
  const double integral = SlopeIntegral(wi, corners, shape, derivatives ? by_integral : nullptr);
  const RegionPoints points(wi, corners, MiddleOf(corners, wi, shape));
  const std::size_t n = points.size();
  std::vector<double> specular(n), cos_d(n), D(n), dspecular(derivatives ? 5 * n : 0), dD(derivatives ? 5 * n : 0);
  GgxLobe(points.pairs(), shape, masking, specular.data(), cos_d.data(), derivatives ? dspecular.data() : nullptr);
  GgxD(points.normals(), shape, D.data(), derivatives ? dD.data() : nullptr);
  // D cos_h / (4 i.h), whose integral is that of the slopes; D G2 / 4; the same times the Fresnel argument.
  Sum slopes, term, moment;
  for (std::size_t k = 0; k < n; ++k) {
    const double x = 1 - cos_d[k], q = kind == FresnelArgument::kCosine ? cos_d[k] : x * x * (x * x) * x;
    const double area = points.area(k), flux = area * points.cosine(k);
    const double *df = derivatives ? &dspecular[k] : nullptr, *d = derivatives ? &dD[k] : nullptr;
    slopes.Add(area * points.normals().z[k] / (4 * cos_d[k]), D[k], d, n);
    term.Add(flux, specular[k], df, n);
    moment.Add(flux * q, specular[k], df, n);
  }
  if (term.value > 0) *argument = moment.value / term.value;
  // Nothing of the lobe is seen.
  if (!(slopes.value > 0 && term.value > 0)) {
    for (int j = 0; derivatives && j < 5; ++j) gradient[j] = argument_gradient[j] = 0;
    return 0;
  }
  const double scale = 1 / (region.cosine * wo.z), ratio = term.value / slopes.value;
  for (int j = 0; derivatives && j < 5; ++j) {
    gradient[j] =
        scale * (by_integral[j] * ratio + integral * (term.gradient[j] - ratio * slopes.gradient[j]) / slopes.value);
    argument_gradient[j] = (moment.gradient[j] - *argument * term.gradient[j]) / term.value;
  }
  return scale * integral * ratio;
}

}  // namespace lobefit
