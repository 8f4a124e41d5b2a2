#include "lobefit/fit/inference/noise_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lobefit/fit/metric/loss.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr std::size_t kNeighbours = 6, kMostSamples = 4000, kMostOfIncidence = 300, kFewest = 40,
                      kMostPredicted = 40000;

struct PseudoResidual {
  double level, mean, size;  // x_j, its counterpart of first order in the values, and |e_j|
};

// Weights of the linear prediction at `at` from its neighbours; they sum to 1. Directions on a line determine no slope
// across it: a ridge of 1e-6 on the slopes decides.
std::array<double, kNeighbours> PredictionWeights(const Vec3& at, const std::array<Vec3, kNeighbours>& neighbours) {
  const Vec3 first = Normalized(std::fabs(at.x) < 0.7 ? Cross(Vec3{1, 0, 0}, at) : Cross(Vec3{0, 1, 0}, at));
  const Vec3 second = Cross(at, first);
  std::array<double, kNeighbours> x = {}, y = {};
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t k = 0; k < kNeighbours; ++k) {
    x[k] = Dot(neighbours[k], first);
    y[k] = Dot(neighbours[k], second);
    mean_x += x[k] / kNeighbours;
    mean_y += y[k] / kNeighbours;
  }
  for (std::size_t k = 0; k < kNeighbours; ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
    yy += (y[k] - mean_y) * (y[k] - mean_y);
  }
  const double ridge = 1e-6 * (xx + yy);
  xx += ridge, yy += ridge;
  const double determinant = xx * yy - xy * xy;
  std::array<double, kNeighbours> weights = {};
  for (std::size_t k = 0; k < kNeighbours; ++k) {
    const double dx = x[k] - mean_x, dy = y[k] - mean_y;
    // The prediction at the origin, (0, 0) - mean away from the mean.
    const double slopes =
        determinant > 0 ? (mean_x * (yy * dx - xy * dy) + mean_y * (xx * dy - xy * dx)) / determinant : 0.0;
    weights[k] = 1.0 / kNeighbours - slopes;
  }
  return weights;
}

void AddIncidence(const Samples& samples, const std::vector<std::uint32_t>& members,
                  const std::vector<std::vector<double>>& f_r, std::vector<PseudoResidual>* pairs) {
  const std::size_t stride = (members.size() + kMostOfIncidence - 1) / kMostOfIncidence;
  std::vector<std::pair<double, std::uint32_t>> near;
  for (std::size_t j = 0; j < members.size(); j += stride) {
    const std::uint32_t at = members[j];
    near.clear();
    for (const std::uint32_t other : members) {
      const Vec3 gap = samples.wo(other) - samples.wo(at);
      if (other != at) near.emplace_back(Dot(gap, gap), other);
    }
    std::partial_sort(near.begin(), near.begin() + kNeighbours, near.end());
    std::array<Vec3, kNeighbours> directions = {};
    for (std::size_t k = 0; k < kNeighbours; ++k) directions[k] = samples.wo(near[k].second);
    const std::array<double, kNeighbours> a = PredictionWeights(samples.wo(at), directions);
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      const auto residual = [&](std::uint32_t i) { return (samples.values[c][i] - f_r[c][i]) * samples.wi_z[i]; };
      const double value = f_r[c][at] * samples.wi_z[at];
      double e = residual(at), squares = 1, level = value * value, mean = std::fabs(value);
      for (std::size_t k = 0; k < kNeighbours; ++k) {
        const std::uint32_t i = near[k].second;
        const double v = f_r[c][i] * samples.wi_z[i];
        e -= a[k] * residual(i);
        squares += a[k] * a[k];
        level += a[k] * a[k] * v * v;
        mean += a[k] * a[k] * std::fabs(v);
      }
      pairs->push_back({std::sqrt(level / squares), mean / squares, std::fabs(e) / std::sqrt(squares)});
    }
  }
}

std::vector<PseudoResidual> NeighbouringPairs(const Samples& samples, const Incidences& incidences,
                                              const std::vector<std::vector<double>>& f_r) {
  std::vector<std::vector<std::uint32_t>> members(incidences.wi.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    members[incidences.group[i]].push_back(static_cast<std::uint32_t>(i));
  std::erase_if(members, [](const std::vector<std::uint32_t>& m) { return m.size() <= kNeighbours; });
  std::size_t looked_at = 0;
  for (const auto& m : members) looked_at += std::min(m.size(), kMostOfIncidence);
  const std::size_t stride = (looked_at + kMostSamples - 1) / kMostSamples;
  std::vector<PseudoResidual> pairs;
  for (std::size_t g = 0; g < members.size(); g += stride) AddIncidence(samples, members[g], f_r, &pairs);
  return pairs;
}

// Pairs of readings of the same directions in the same file, which no model enters but for the level: (m1 - m2) /
// sqrt(2). Empty where there are few, or where more than half agree exactly, copies that tell of no noise.
std::vector<PseudoResidual> RepeatedPairs(const Samples& samples, const Incidences& incidences,
                                          const std::vector<std::vector<double>>& f_r) {
  constexpr std::size_t kFewestRepeats = 50;
  constexpr double kSame = 1e-9;
  const auto file = [&](std::uint32_t i) { return samples.file.empty() ? 0 : samples.file[i]; };
  std::vector<std::uint32_t> order(samples.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (incidences.group[a] != incidences.group[b]) return incidences.group[a] < incidences.group[b];
    if (file(a) != file(b)) return file(a) < file(b);
    return samples.wo_x[a] != samples.wo_x[b] ? samples.wo_x[a] < samples.wo_x[b] : samples.wo_y[a] < samples.wo_y[b];
  });
  std::vector<PseudoResidual> pairs;
  std::size_t found = 0, equal = 0;
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const std::uint32_t i = order[k], j = order[k + 1];
    if (incidences.group[i] != incidences.group[j] || file(i) != file(j)) continue;
    if (Norm(samples.wo(i) - samples.wo(j)) > kSame || Norm(samples.wi(i) - samples.wi(j)) > kSame) continue;
    ++found;
    ++k;  // a reading is of one pair
    for (std::size_t c = 0; c < f_r.size(); ++c) {
      const double v = f_r[c][i] * samples.wi_z[i], w = f_r[c][j] * samples.wi_z[j];
      const double gap = (samples.values[c][i] - samples.values[c][j]) * samples.wi_z[i];
      equal += gap == 0 ? 1 : 0;
      pairs.push_back(
          {std::sqrt(0.5 * (v * v + w * w)), 0.5 * (std::fabs(v) + std::fabs(w)), std::fabs(gap) / std::sqrt(2.0)});
    }
  }
  if (found < kFewestRepeats || 2 * equal > pairs.size()) pairs.clear();
  return pairs;
}

struct Bin {
  double level, mean, deviation;
  double log_deviation;
  double precision;  // of the deviation's logarithm, 1 / variance
};

std::vector<Bin> Bins(std::vector<PseudoResidual> pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const PseudoResidual& a, const PseudoResidual& b) {
    return a.level != b.level ? a.level < b.level : a.size < b.size;
  });
  const std::size_t count = std::clamp<std::size_t>(pairs.size() / 40, 4, 24);
  std::vector<Bin> bins;
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t begin = b * pairs.size() / count, end = (b + 1) * pairs.size() / count;
    std::vector<double> sizes;
    const auto members = static_cast<double>(end - begin);
    double square = 0, mean = 0;
    for (std::size_t i = begin; i < end; ++i) {
      sizes.push_back(pairs[i].size);
      square += pairs[i].level * pairs[i].level / members;
      mean += pairs[i].mean / members;
    }
    // The median of absolute values is 37 % efficient [Hampel 1974].
    const double deviation = RobustDeviation(&sizes);
    bins.push_back({std::sqrt(square), mean, deviation, std::log(deviation), 2 * 0.37 * members});
  }
  return bins;
}

// Sums over the bins: of Huber's loss of what a noise model leaves, and of its square in units of its variance.
struct BinMisfit {
  double loss = 0, chi_squared = 0;
};
BinMisfit MisfitOf(const std::vector<Bin>& bins, const NoiseModel& noise) {
  BinMisfit misfit;
  for (const Bin& bin : bins) {
    const double variance =
        noise.floor * noise.floor + noise.poisson * bin.mean + noise.relative * noise.relative * bin.level * bin.level;
    const double gap = bin.log_deviation - 0.5 * std::log(variance);
    const double rho = EvaluateLoss(Loss::kHuber, 0.3, gap * gap).rho;
    misfit.loss += rho;
    misfit.chi_squared += bin.precision * rho;
  }
  return misfit;
}

// Pattern search in the logarithms of the terms that are not 0.
NoiseModel Descend(const std::vector<Bin>& bins, NoiseModel at) {
  double best = MisfitOf(bins, at).loss;
  for (double step = 0.5; step > 1e-3;) {
    bool moved = false;
    for (double NoiseModel::*term : {&NoiseModel::floor, &NoiseModel::relative, &NoiseModel::poisson}) {
      if (at.*term == 0) continue;
      for (const double sign : {1.0, -1.0}) {
        NoiseModel tried = at;
        tried.*term *= std::exp(sign * step);
        const double misfit = MisfitOf(bins, tried).loss;
        if (!(misfit < best)) continue;
        best = misfit;
        at = tried;
        moved = true;
      }
    }
    if (!moved) step /= 2;
  }
  return at;
}

// With a term of counting noise, where the bins ask for one.
NoiseModel WithPoisson(const std::vector<Bin>& bins, const NoiseModel& without) {
  // Three standard deviations, and no small part of what is left: smooth misfit looks like a little of every term.
  constexpr double kLeastGain = 9, kMostLeft = 0.5;
  // From where neither floor nor share of the value is all of the noise.
  NoiseModel start = without;
  const Bin& middle = bins[bins.size() / 2];
  start.poisson = middle.deviation * middle.deviation / std::max(middle.mean, 1e-300);
  start.floor *= 0.5;
  start.relative *= 0.5;
  const NoiseModel with = Descend(bins, start);
  const double before = MisfitOf(bins, without).chi_squared, after = MisfitOf(bins, with).chi_squared;
  return before - after > kLeastGain && after < kMostLeft * before ? with : without;
}

}  // namespace

std::optional<NoiseModel> EstimateNoise(const Samples& samples, const Incidences& incidences,
                                        const std::vector<std::vector<double>>& f_r) {
  std::vector<PseudoResidual> pairs = RepeatedPairs(samples, incidences, f_r);
  if (pairs.empty()) pairs = NeighbouringPairs(samples, incidences, f_r);
  if (pairs.size() < kFewest) return std::nullopt;
  std::vector<Bin> bins = Bins(std::move(pairs));
  double highest = 0;
  for (const Bin& bin : bins) highest = std::max({highest, bin.level, bin.deviation});
  // Less than that is rounding.
  const double rounding = 1e-9 * highest;
  std::erase_if(bins, [&](const Bin& bin) { return !(bin.deviation > rounding); });
  if (bins.size() < 3) return std::nullopt;
  // From the ends: the floor from the darkest bin, the relative noise from the brightest.
  const NoiseModel start = {bins.front().deviation, bins.back().deviation / std::max(bins.back().level, rounding)};
  return WithPoisson(bins, Descend(bins, start));
}

NoiseSubset SubsetForNoise(const Samples& samples, const Incidences& incidences) {
  std::vector<std::uint32_t> members(incidences.wi.size(), 0);
  for (const std::uint32_t group : incidences.group) ++members[group];
  std::size_t total = 0;
  for (const std::uint32_t count : members) total += count > kNeighbours ? count : 0;
  const std::size_t stride = (total + kMostPredicted - 1) / kMostPredicted;
  NoiseSubset subset;
  std::size_t seen = 0;
  constexpr std::uint32_t kLeftOut = 0xffffffff;
  std::vector<std::uint32_t> number(members.size(), kLeftOut);
  for (std::size_t g = 0; g < members.size(); ++g) {
    if (members[g] <= kNeighbours || seen++ % stride != 0) continue;
    number[g] = static_cast<std::uint32_t>(subset.incidences.wi.size());
    subset.incidences.wi.push_back(incidences.wi[g]);
  }
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < incidences.group.size(); ++i) {
    if (number[incidences.group[i]] == kLeftOut) continue;
    indices.push_back(i);
    subset.incidences.group.push_back(number[incidences.group[i]]);
  }
  subset.samples = samples.Subset(indices);
  return subset;
}

}  // namespace lobefit
