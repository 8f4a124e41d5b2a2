// A measurement as a function of any pair of directions: for resampling to the grids of file formats and for pictures.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// Moving least squares over the nearest samples: a linear function of half vector and difference vector is fitted to ln
// f_r (to f_r where a neighbour is not positive), with weights that grow without bound towards a sample, so that
// samples are met exactly. Reciprocity is used: a sample stands for its exchanged pair too. Beyond the samples the
// value is held within a factor of 2 of the neighbours'.
class Interpolator {
 public:
  // Keeps a copy of the values. Domain: at least one sample.
  explicit Interpolator(const Measurement& measurement);

  std::size_t channels() const { return channels_; }
  // f_r at unit directions above the horizon, one value a channel. Safe from several threads.
  void Evaluate(const Vec3& wi, const Vec3& wo, double* values) const;
  // The sample nearest to a pair of directions (not to its exchanged pair), where it is nearer than about `within`
  // radians.
  std::optional<std::size_t> Nearest(const Vec3& wi, const Vec3& wo, double within) const;

 private:
  // Half vector in the tangent plane, then difference vector; an isotropic measurement uses the first three.
  using Point = std::array<double, 4>;
  struct Neighbour {
    double squared_distance;
    std::size_t place;  // in points_
    bool exchanged;
  };
  // The nearest points so far, sorted by distance.
  class Nearby;

  Point PointOf(const Vec3& wi, const Vec3& wo) const;
  Point Exchanged(const Point& point) const;
  // The row of a sample that stands for its exchanged pair: its difference vector points the other way.
  void Flip(std::array<double, 5>* row) const;
  void Build(std::size_t begin, std::size_t end, std::size_t axis, const std::vector<Point>& points);
  void Search(std::size_t begin, std::size_t end, std::size_t axis, const Point& target, bool exchanged,
              Nearby* nearby) const;

  bool isotropic_;
  std::size_t dimension_, channels_;
  std::vector<Point> points_;                // in the order of the tree: the median of a range is its root
  std::vector<std::size_t> samples_;         // sample of each point
  std::vector<double> values_, logarithms_;  // [place][channel]; the logarithm of a value <= 0 is not used
};

// The same as a BrdfFunction that owns its data.
BrdfFunction Interpolate(const Measurement& measurement);

// How far a function is from a measurement, at the measurement's samples and over all channels: |difference| relative
// to the sample's value, or to 1e-3 of its channel's largest where that is more.
struct Difference {
  double median = 0, percentile_90 = 0, maximum = 0;
  std::size_t compared = 0;
};
// Compares at most `most` samples, evenly spread.
Difference CompareWith(const Measurement& measurement, const BrdfFunction& brdf, std::size_t most = 100000);

}  // namespace lobefit
