#include "lobefit/measurement/interpolation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "lobefit/base/process/parallel.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// f_r varies faster along the half vector than along the difference vector.
constexpr double kHalfVectorScale = 3;
constexpr std::size_t kUnknowns = 5;
constexpr std::size_t kNeighbours = 12;
// Points of a leaf of the tree, searched one by one.
constexpr std::size_t kLeaf = 8;

// The rotation that takes `h` to +z by the shortest way, applied to w.
Vec3 ToFrameOf(const Vec3& h, const Vec3& w) {
  const double a = h.x * w.x + h.y * w.y;
  const double scale = a / (1 + h.z) + w.z;
  return {w.x - h.x * scale, w.y - h.y * scale, a + h.z * w.z};
}

using Matrix = std::array<std::array<double, kUnknowns>, kUnknowns>;

// Cholesky factor of the lower triangle, in place; false where the matrix is not positive definite.
bool Factor(Matrix* matrix, std::size_t n) {
  Matrix& a = *matrix;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    if (!(a[j][j] > 0)) return false;
    a[j][j] = std::sqrt(a[j][j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
  return true;
}

// The solution of L L^T x = b.
std::array<double, kUnknowns> Solve(const Matrix& l, std::size_t n, std::array<double, kUnknowns> b) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= l[i][k] * b[k];
    b[i] /= l[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= l[k][i] * b[k];
    b[i] /= l[i][i];
  }
  return b;
}

}  // namespace

class Interpolator::Nearby {
 public:
  double farthest() const {
    return size_ < kNeighbours ? std::numeric_limits<double>::infinity() : at_[size_ - 1].squared_distance;
  }
  std::size_t size() const { return size_; }
  const Neighbour& operator[](std::size_t i) const { return at_[i]; }

  void Offer(const Neighbour& neighbour) {
    if (!(neighbour.squared_distance < farthest())) return;
    if (size_ < kNeighbours) ++size_;
    std::size_t i = size_ - 1;
    for (; i > 0 && at_[i - 1].squared_distance > neighbour.squared_distance; --i) at_[i] = at_[i - 1];
    at_[i] = neighbour;
  }

 private:
  std::array<Neighbour, kNeighbours> at_;
  std::size_t size_ = 0;
};

Interpolator::Interpolator(const Measurement& measurement)
    : isotropic_(measurement.isotropic),
      dimension_(measurement.isotropic ? 3 : 4),
      channels_(measurement.samples.values.size()) {
  const Samples& samples = measurement.samples;
  std::vector<Point> points(samples.size());
  samples_.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    points[i] = PointOf(samples.wi(i), samples.wo(i));
    samples_[i] = i;
  }
  Build(0, samples.size(), 0, points);
  points_.resize(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) points_[i] = points[samples_[i]];
  values_.resize(samples.size() * channels_);
  logarithms_.resize(values_.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (std::size_t c = 0; c < channels_; ++c) {
      const double value = samples.values[c][samples_[i]];
      values_[i * channels_ + c] = value;
      logarithms_[i * channels_ + c] = value > 0 ? std::log(value) : 0.0;
    }
  }
}

Interpolator::Point Interpolator::PointOf(const Vec3& wi, const Vec3& wo) const {
  const Vec3 h = HalfVector(wi, wo);
  if (!isotropic_) {
    const Vec3 d = ToFrameOf(h, wi);
    return {kHalfVectorScale * h.x, kHalfVectorScale * h.y, d.x, d.y};
  }
  const double sin_h = std::hypot(h.x, h.y);
  const double c = sin_h > 0 ? h.x / sin_h : 1.0, s = sin_h > 0 ? h.y / sin_h : 0.0;
  const Vec3 turned = {c * wi.x + s * wi.y, -s * wi.x + c * wi.y, wi.z};
  return {kHalfVectorScale * sin_h, h.z * turned.x - sin_h * turned.z, std::fabs(turned.y), 0};
}

Interpolator::Point Interpolator::Exchanged(const Point& p) const {
  return isotropic_ ? Point{p[0], -p[1], p[2], 0} : Point{p[0], p[1], -p[2], -p[3]};
}

void Interpolator::Build(std::size_t begin, std::size_t end, std::size_t axis, const std::vector<Point>& points) {
  if (end - begin <= kLeaf) return;
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t i) { return samples_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end),
                   [&](std::size_t a, std::size_t b) { return points[a][axis] < points[b][axis]; });
  const std::size_t next = axis + 1 == dimension_ ? 0 : axis + 1;
  Build(begin, middle, next, points);
  Build(middle + 1, end, next, points);
}

void Interpolator::Search(std::size_t begin, std::size_t end, std::size_t axis, const Point& target, bool exchanged,
                          Nearby* nearby) const {
  const auto offer = [&](std::size_t place) {
    const Point& point = points_[place];
    double squared = 0;
    for (std::size_t k = 0; k < 4; ++k) squared += (point[k] - target[k]) * (point[k] - target[k]);
    nearby->Offer({squared, place, exchanged});
  };
  if (end - begin <= kLeaf) {
    for (std::size_t place = begin; place < end; ++place) offer(place);
    return;
  }
  const std::size_t middle = (begin + end) / 2, next = axis + 1 == dimension_ ? 0 : axis + 1;
  const double offset = target[axis] - points_[middle][axis];
  offer(middle);
  if (offset < 0) {
    Search(begin, middle, next, target, exchanged, nearby);
    if (offset * offset < nearby->farthest()) Search(middle + 1, end, next, target, exchanged, nearby);
  } else {
    Search(middle + 1, end, next, target, exchanged, nearby);
    if (offset * offset < nearby->farthest()) Search(begin, middle, next, target, exchanged, nearby);
  }
}

std::optional<std::size_t> Interpolator::Nearest(const Vec3& wi, const Vec3& wo, double within) const {
  Nearby nearby;
  Search(0, points_.size(), 0, PointOf(wi, wo), false, &nearby);
  if (nearby.size() == 0 || nearby[0].squared_distance > within * within) return std::nullopt;
  return samples_[nearby[0].place];
}

void Interpolator::Evaluate(const Vec3& wi, const Vec3& wo, double* values) const {
  const Point target = PointOf(wi, wo), exchanged = Exchanged(target);
  Nearby nearby;
  Search(0, points_.size(), 0, target, false, &nearby);
  Search(0, points_.size(), 0, exchanged, true, &nearby);
  const std::size_t count = nearby.size();
  const double farthest = std::sqrt(nearby[count - 1].squared_distance);

  // Normal equations of value = b0 + b . (point - target), centred at the target: b0 is the answer.
  const std::size_t n = dimension_ + 1;
  std::array<std::array<double, kUnknowns>, kUnknowns> normal = {};
  std::array<std::array<double, kUnknowns>, kNeighbours> rows;
  std::array<double, kNeighbours> weights;
  for (std::size_t i = 0; i < count; ++i) {
    const double distance = std::sqrt(nearby[i].squared_distance);
    const double fade = farthest > 0 ? 1 - 0.999 * distance / farthest : 1.0;
    weights[i] = fade * fade / (nearby[i].squared_distance + 1e-14);
    const Point& point = points_[nearby[i].place];
    const Point& centre = nearby[i].exchanged ? exchanged : target;
    rows[i] = {1, 0, 0, 0, 0};
    for (std::size_t k = 0; k < dimension_; ++k) rows[i][k + 1] = point[k] - centre[k];
    if (nearby[i].exchanged) Flip(&rows[i]);
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b <= a; ++b) normal[a][b] += weights[i] * rows[i][a] * rows[i][b];
    }
  }
  // Where the neighbours do not span all directions (a plane of incidence), the slope across them is 0. The diagonal is
  // of the order of the number of neighbours, since weights fall with the squared distance.
  constexpr double kRidge = 0.01;
  for (std::size_t a = 1; a < n; ++a) normal[a][a] += kRidge;
  const double weight_sum = normal[0][0];
  const bool solvable = Factor(&normal, n);

  // b0 is linear in the values, with the same factors for all channels: w_i row_i . (N^-1 e_0).
  std::array<double, kNeighbours> factors;
  const std::array<double, kUnknowns> first =
      solvable ? Solve(normal, n, {1}) : std::array<double, kUnknowns>{1 / weight_sum};
  for (std::size_t i = 0; i < count; ++i) {
    factors[i] = 0;
    for (std::size_t a = 0; a < n; ++a) factors[i] += rows[i][a] * first[a];
    factors[i] *= weights[i];
  }
  constexpr std::size_t kPart = 16;  // channels at a time
  for (std::size_t begin = 0; begin < channels_; begin += kPart) {
    const std::size_t part = std::min(kPart, channels_ - begin);
    std::array<double, kPart> low, high, linear = {}, logarithmic = {};
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < count; ++i) {
      const double* const value = &values_[nearby[i].place * channels_ + begin];
      const double* const logarithm = &logarithms_[nearby[i].place * channels_ + begin];
      for (std::size_t c = 0; c < part; ++c) {
        low[c] = std::min(low[c], value[c]);
        high[c] = std::max(high[c], value[c]);
        linear[c] += factors[i] * value[c];
        logarithmic[c] += factors[i] * logarithm[c];
      }
    }
    for (std::size_t c = 0; c < part; ++c) {
      values[begin + c] = low[c] > 0 ? std::clamp(std::exp(logarithmic[c]), low[c] / 2, high[c] * 2)
                                     : std::clamp(linear[c], low[c], high[c]);
    }
  }
}

void Interpolator::Flip(std::array<double, 5>* row) const {
  if (isotropic_) {
    (*row)[2] = -(*row)[2];
  } else {
    (*row)[3] = -(*row)[3];
    (*row)[4] = -(*row)[4];
  }
}

BrdfFunction Interpolate(const Measurement& measurement) {
  const auto interpolator = std::make_shared<const Interpolator>(measurement);
  return [interpolator](const Vec3& wi, const Vec3& wo, double* values) { interpolator->Evaluate(wi, wo, values); };
}

// Samples that one thread takes at a time.
constexpr std::size_t kPiece = 256;

Difference CompareWith(const Measurement& measurement, const BrdfFunction& brdf, std::size_t most) {
  const Samples& samples = measurement.samples;
  const std::size_t channels = measurement.channels.size();
  std::vector<double> scale(channels, 0.0);
  for (std::size_t c = 0; c < channels; ++c) {
    for (const double value : samples.values[c]) scale[c] = std::max(scale[c], 1e-3 * std::fabs(value));
  }
  const std::size_t step = std::max<std::size_t>(1, samples.size() / std::max<std::size_t>(1, most));
  const std::size_t count = (samples.size() + step - 1) / step;
  std::vector<double> differences(count * channels, -1.0);  // negative: nothing to relate to
  ParallelFor((count + kPiece - 1) / kPiece, HardwareThreads(), [&](std::size_t piece) {
    std::vector<double> values(channels);
    for (std::size_t k = piece * kPiece; k < std::min(count, (piece + 1) * kPiece); ++k) {
      const std::size_t i = k * step;
      brdf(samples.wi(i), samples.wo(i), values.data());
      for (std::size_t c = 0; c < channels; ++c) {
        const double reference = samples.values[c][i];
        const double relative_to = std::max(std::fabs(reference), scale[c]);
        if (relative_to > 0) differences[k * channels + c] = std::fabs(values[c] - reference) / relative_to;
      }
    }
  });
  std::erase_if(differences, [](double difference) { return difference < 0; });
  Difference result;
  result.compared = differences.size();
  if (differences.empty()) return result;
  std::sort(differences.begin(), differences.end());
  result.median = differences[differences.size() / 2];
  result.percentile_90 = differences[differences.size() * 9 / 10];
  result.maximum = differences.back();
  return result;
}

}  // namespace lobefit
