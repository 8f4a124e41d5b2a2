#include "lobefit/maps/clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

constexpr int kStarts = 10, kMostRounds = 100;
// Of a logarithm: differences below are no difference of material.
constexpr double kLeastUnit = 0.05;
// Albedos below this part of the median are as dark as it.
constexpr double kDarkest = 1e-3;
constexpr std::uint64_t kSeed = 1;

double SquaredDistance(const Features& a, const Features& b, const Features& unit) {
  double sum = 0, known = 0;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    const double difference = (a[k] - b[k]) / unit[k];
    if (std::isnan(difference)) continue;
    sum += difference * difference, known += 1;
  }
  return known > 0 ? sum / known : 0;
}

Features Units(const std::vector<Features>& texels) {
  Features unit;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    std::vector<double> known;
    for (const Features& f : texels) {
      if (!std::isnan(f[k])) known.push_back(f[k]);
    }
    std::sort(known.begin(), known.end());
    const double range = known.empty() ? 0 : known[known.size() * 3 / 4] - known[known.size() / 4];
    unit[k] = std::max(range, kLeastUnit);
  }
  return unit;
}

struct Parting {
  Clusters clusters;
  std::vector<std::size_t> sizes;
  double cost = std::numeric_limits<double>::infinity();
};

std::vector<Features> FirstCenters(const std::vector<Features>& texels, const Features& unit, std::size_t count,
                                   RandomNumbers* random) {
  std::vector<Features> centers;
  std::vector<double> nearest(texels.size(), std::numeric_limits<double>::infinity());
  const auto at = [&](double share, double total) {
    std::size_t t = 0;
    double sum = 0;
    for (; t + 1 < texels.size(); ++t) {
      sum += centers.empty() ? 1 : nearest[t];
      if (sum > share * total) break;
    }
    return t;
  };
  double total = static_cast<double>(texels.size());
  while (centers.size() < count && total > 0) {
    centers.push_back(texels[at(random->Uniform(), total)]);
    total = 0;
    for (std::size_t t = 0; t < texels.size(); ++t) {
      nearest[t] = std::min(nearest[t], SquaredDistance(texels[t], centers.back(), unit));
      total += nearest[t];
    }
  }
  return centers;
}

// Moves the centers to the means of what is nearest to them; those of nothing go.
double Round(const std::vector<Features>& texels, Parting* parting) {
  Clusters& clusters = parting->clusters;
  const std::size_t count = clusters.centers.size();
  std::vector<Features> sums(count, Features{}), known(count, Features{});
  std::vector<std::size_t> sizes(count);
  double cost = 0;
  for (const Features& f : texels) {
    const std::size_t c = clusters.Nearest(f);
    cost += SquaredDistance(f, clusters.centers[c], clusters.unit);
    ++sizes[c];
    for (std::size_t k = 0; k < kFeatures; ++k) {
      if (!std::isnan(f[k])) sums[c][k] += f[k], known[c][k] += 1;
    }
  }
  clusters.centers.clear(), parting->sizes.clear();
  for (std::size_t c = 0; c < count; ++c) {
    if (sizes[c] == 0) continue;
    Features center;
    for (std::size_t k = 0; k < kFeatures; ++k) center[k] = known[c][k] > 0 ? sums[c][k] / known[c][k] : kNan;
    clusters.centers.push_back(center), parting->sizes.push_back(sizes[c]);
  }
  return cost;
}

}  // namespace

Features FeaturesOf(const TexelFit& fit, int channels) {
  Features features;
  features.fill(kNan);
  double f0 = 0, brightest = 0;
  for (int c = 0; c < channels; ++c) brightest = std::max(brightest, fit.diffuse[c]);
  for (int c = 0; c < channels; ++c) {
    f0 += fit.f0[c] / channels;
    features[static_cast<std::size_t>(c)] = std::log(std::max(fit.diffuse[c], kDarkest * brightest));
  }
  for (double& f : features) f = std::isfinite(f) ? f : kNan;
  if (f0 > 0) features[kMostChannels] = std::log(f0);
  if (fit.alpha_x > 0) features[kMostChannels + 1] = 0.5 * std::log(fit.alpha_x * fit.alpha_y);
  return features;
}

std::size_t Clusters::Nearest(const Features& features) const {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < centers.size(); ++c) {
    const double distance = SquaredDistance(features, centers[c], unit);
    if (distance < least) least = distance, nearest = c;
  }
  return nearest;
}

Clusters FindClusters(const std::vector<Features>& texels, std::size_t count) {
  Parting best;
  if (texels.empty()) return best.clusters;
  const Features unit = Units(texels);
  for (int start = 0; start < kStarts; ++start) {
    RandomNumbers random(StreamSeed(kSeed, static_cast<std::uint64_t>(start)));
    Parting parting;
    parting.clusters = {FirstCenters(texels, unit, count, &random), unit};
    for (int round = 0; round < kMostRounds; ++round) {
      const double cost = Round(texels, &parting);
      const bool done = !(cost < parting.cost);
      parting.cost = std::min(cost, parting.cost);
      if (done) break;
    }
    if (parting.cost < best.cost) best = parting;
  }
  std::vector<std::size_t> order(best.sizes.size());
  for (std::size_t c = 0; c < order.size(); ++c) order[c] = c;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return best.sizes[a] > best.sizes[b]; });
  Clusters clusters = {{}, unit};
  for (const std::size_t c : order) clusters.centers.push_back(best.clusters.centers[c]);
  return clusters;
}

}  // namespace lobefit
