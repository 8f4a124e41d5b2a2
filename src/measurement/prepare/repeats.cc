#include "lobefit/measurement/prepare/repeats.h"

#include <cmath>
#include <utility>
#include <vector>

#include "lobefit/measurement/pair_index.h"
#include "lobefit/measurement/prepare/noise.h"

namespace lobefit {
namespace {

constexpr double kPooledRepetitions = 4;

// Samples of each pair, in the order of their first occurrence.
std::vector<std::vector<std::size_t>> GroupPairs(const Samples& samples) {
  std::vector<std::vector<std::size_t>> groups;
  PairIndex index(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t group = index.FindOrAdd(samples.wi(i), samples.wo(i));
    if (group == groups.size()) groups.emplace_back();
    groups[group].push_back(i);
  }
  return groups;
}

// Mean of a group and sum of squared deviations, both averaged over the channels.
struct Moments {
  double mean = 0, squares = 0;
};
Moments MomentsOf(const Samples& samples, const std::vector<std::size_t>& group) {
  Moments moments;
  const double channels = static_cast<double>(samples.values.size()), count = static_cast<double>(group.size());
  for (const std::vector<double>& values : samples.values) {
    double mean = 0;
    for (const std::size_t i : group) mean += values[i] / count;
    for (const std::size_t i : group) moments.squares += (values[i] - mean) * (values[i] - mean) / channels;
    moments.mean += mean / channels;
  }
  return moments;
}

}  // namespace

Repeats MergeRepeated(Measurement* measurement) {
  Samples& samples = measurement->samples;
  const std::vector<std::vector<std::size_t>> groups = GroupPairs(samples);
  Repeats repeats;
  if (groups.size() == samples.size()) return repeats;

  std::vector<Moments> moments;
  double relative_squares = 0, freedom = 0;
  for (const std::vector<std::size_t>& group : groups) {
    moments.push_back(MomentsOf(samples, group));
    if (group.size() < 2) continue;
    ++repeats.pairs;
    repeats.samples += group.size();
    const double mean = moments.back().mean;
    if (mean != 0) relative_squares += moments.back().squares / (mean * mean);
    freedom += static_cast<double>(group.size() - 1);
  }
  const double pooled = relative_squares / freedom;
  repeats.relative_spread = std::sqrt(pooled);

  std::vector<std::size_t> firsts;
  std::vector<double> sigma;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<std::size_t>& group = groups[g];
    const std::size_t first = group[0];
    const double count = static_cast<double>(group.size());
    for (std::vector<double>& values : samples.values) {
      double mean = 0;
      for (const std::size_t i : group) mean += values[i] / count;
      values[first] = mean;
    }
    if (!samples.weight.empty()) {
      double mean = 0;
      for (const std::size_t i : group) mean += samples.weight[i] / count;
      samples.weight[first] = mean;
    }
    firsts.push_back(first);
    const double prior = kPooledRepetitions * pooled * moments[g].mean * moments[g].mean;
    sigma.push_back(std::sqrt((prior + moments[g].squares) / (kPooledRepetitions + count - 1) / count));
  }
  samples = samples.Subset(firsts);
  AddSigma(sigma, &measurement->samples);
  return repeats;
}

}  // namespace lobefit
