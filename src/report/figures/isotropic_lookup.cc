#include "lobefit/report/figures/isotropic_lookup.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Cells along each coordinate; phi_d matters least.
constexpr std::array<std::size_t, 3> kCells = {90, 60, 12};
constexpr float kPhiScale = 0.35F;
// In units of the whole range of theta_d: about five degrees, or the distance of two rows of a sparse table.
constexpr float kReach = 0.085F;

struct Coordinates {
  double h, d, phi;  // each in [0, 1]
};

Coordinates CoordinatesOf(const HalfDifference& angles) {
  const double phi = std::fabs(std::remainder(angles.phi_d, kPi));  // [0, pi / 2]
  return {std::sqrt(std::min(1.0, angles.theta_h / (kPi / 2))), std::min(1.0, angles.theta_d / (kPi / 2)),
          phi / (kPi / 2)};
}

ScatterPoint PointOf(const Coordinates& c) {
  return {static_cast<float>(c.h), static_cast<float>(c.d), kPhiScale * static_cast<float>(c.phi), 0};
}

std::size_t Cell(double t, std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(t * static_cast<double>(count)));
}

}  // namespace

IsotropicLookup::IsotropicLookup(const Measurement& measurement) : channels_(measurement.channels.size()) {
  const Samples& samples = measurement.samples;
  const std::size_t cells = kCells[0] * kCells[1] * kCells[2], width = 3 + channels_;
  std::vector<float> sums(cells * width);
  std::vector<std::uint32_t> counts(cells);
  // A million samples fill the cells many times over.
  constexpr std::size_t kTaken = 500000;
  const std::size_t step = 1 + samples.size() / kTaken;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    // Samples of a table lie on the bounds of cells: not by the faster formula, which would move them about by
    // rounding.
    const Coordinates c = CoordinatesOf(ToHalfDifference(samples.wi(i), samples.wo(i)));
    const std::size_t cell =
        (Cell(c.h, kCells[0]) * kCells[1] + Cell(c.d, kCells[1])) * kCells[2] + Cell(c.phi, kCells[2]);
    float* sum = &sums[cell * width];
    sum[0] += static_cast<float>(c.h), sum[1] += static_cast<float>(c.d), sum[2] += static_cast<float>(c.phi);
    for (std::size_t k = 0; k < channels_; ++k) sum[3 + k] += static_cast<float>(samples.values[k][i]);
    ++counts[cell];
  }
  std::vector<ScatterPoint> points;
  point_of_cell_.resize(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    if (counts[cell] == 0) continue;
    point_of_cell_[cell] = static_cast<std::uint32_t>(points.size() + 1);
    const float* sum = &sums[cell * width];
    const float share = 1.0F / static_cast<float>(counts[cell]);
    points.push_back({sum[0] * share, sum[1] * share, kPhiScale * sum[2] * share, 0});
    for (std::size_t k = 0; k < channels_; ++k) values_.push_back(sum[3 + k] * share);
  }
  tree_ = std::make_unique<ScatterTree>(std::move(points), 3);
}

bool IsotropicLookup::FindInFullCells(double h, double d, double phi, double* f_r) const {
  const std::array<double, 3> at = {h, d, phi};
  std::array<std::size_t, 3> low = {};
  std::array<double, 3> fraction = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const double centres = static_cast<double>(kCells[k]) * at[k] - 0.5;
    const double clamped = std::clamp(centres, 0.0, static_cast<double>(kCells[k] - 1));
    low[k] = std::min(static_cast<std::size_t>(clamped), kCells[k] - 2);
    fraction[k] = clamped - static_cast<double>(low[k]);
  }
  std::array<std::uint32_t, 8> points = {};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const std::size_t cell =
        ((low[0] + (corner & 1)) * kCells[1] + low[1] + (corner >> 1 & 1)) * kCells[2] + low[2] + (corner >> 2 & 1);
    points[corner] = point_of_cell_[cell];
    if (points[corner] == 0) return false;
  }
  std::fill(f_r, f_r + channels_, 0.0);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    for (std::size_t k = 0; k < 3; ++k) weight *= (corner >> k & 1) != 0 ? fraction[k] : 1 - fraction[k];
    for (std::size_t c = 0; c < channels_; ++c)
      f_r[c] += weight * static_cast<double>(values_[(points[corner] - 1) * channels_ + c]);
  }
  return true;
}

bool IsotropicLookup::Find(const Vec3& wi, const Vec3& wo, double* f_r) const {
  const Coordinates at = CoordinatesOf(ToFoldedHalfDifference(wi, wo));
  if (!std::isfinite(at.h + at.d + at.phi)) return false;  // opposite directions have no half vector
  if (FindInFullCells(at.h, at.d, at.phi, f_r)) return true;
  std::array<ScatterTree::Neighbour, ScatterTree::kMost> found;
  const int have = tree_->Nearest(PointOf(at), 6, &found);
  if (have == 0 || found[0].distance2 > kReach * kReach) return false;
  std::fill(f_r, f_r + channels_, 0.0);
  double total = 0;
  for (int k = 0; k < have; ++k) {
    const ScatterTree::Neighbour& near = found[static_cast<std::size_t>(k)];
    const double weight = 1 / (static_cast<double>(near.distance2) + 1e-6);
    total += weight;
    for (std::size_t c = 0; c < channels_; ++c)
      f_r[c] += weight * static_cast<double>(values_[near.index * channels_ + c]);
  }
  for (std::size_t c = 0; c < channels_; ++c) f_r[c] /= total;
  return true;
}

}  // namespace lobefit
