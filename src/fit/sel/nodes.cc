#include "lobefit/fit/sel/nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/sigma_weights.h"
#include "lobefit/fit/search/starts.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

// Samples of one incident direction that are fitted; a bound is made of all.
constexpr std::size_t kFittedSamples = 600;

SelSamples SamplesOf(const Samples& samples, const std::vector<std::size_t>& members, const Recipe& recipe) {
  SelSamples gathered;
  gathered.f_r.resize(samples.values.size());
  for (const std::size_t i : members) {
    gathered.v.push_back(MirrorFrame(samples.wi(i)) * samples.wo(i));
    gathered.cos_i.push_back(samples.wi_z[i]);
    gathered.cos_o.push_back(samples.wo_z[i]);
    gathered.weight.push_back(SampleWeight(recipe.metric, recipe.weighting, true, samples, i));
    for (std::size_t c = 0; c < samples.values.size(); ++c) gathered.f_r[c].push_back(samples.values[c][i]);
  }
  const Samples own = samples.sigma.empty() ? Samples() : samples.Subset(members);
  if (const SigmaWeights sigma(own, recipe.metric, recipe.noise); !sigma.empty()) {
    const std::vector<double> stated = sigma.AtReadings();
    for (std::size_t i = 0; i < gathered.size(); ++i) gathered.weight[i] *= stated[i];
  }
  // Mean 1, so that pulls weigh the same under every weighting. Along the normal the sines of ngan and low-log vanish.
  const double sum = std::accumulate(gathered.weight.begin(), gathered.weight.end(), 0.0);
  for (double& w : gathered.weight) w = sum > 0 ? w * static_cast<double>(gathered.size()) / sum : 1.0;
  return gathered;
}

// One slice again, pulled by its neighbours: from its own lobes and from each neighbour's.
SelSliceFit Refit(const std::vector<SelNode>& nodes, std::size_t k, const SelSliceOptions& options, double drift) {
  const SelNode& node = nodes[k];
  std::vector<SelPull> pulls;
  for (const std::size_t other : node.neighbours) {
    const double angle = std::acos(std::clamp(Dot(node.wi, nodes[other].wi), -1.0, 1.0));
    const double scale = drift * std::max(angle, 1e-3);
    pulls.push_back({&nodes[other].fit.slice.lobes, node.variance / (scale * scale)});
  }
  SelSliceFit best = FitSelSlice(node.fitted, node.fit.slice, options, pulls);
  for (const std::size_t other : node.neighbours) {
    SelSlice start = nodes[other].fit.slice;
    start.theta_i = node.fit.slice.theta_i;
    start.phi_i = node.fit.slice.phi_i;
    const SelSliceFit trial = FitSelSlice(node.fitted, start, options, pulls);
    if (trial.objective < best.objective * (1 - 1e-6)) best = trial;
  }
  return best;
}

}  // namespace

std::vector<SelNode> MakeSelNodes(const Measurement& measurement, const Recipe& recipe) {
  const Incidences incidences = GroupByDirection(measurement, Beam::kLight);
  const Samples& samples = measurement.samples;
  std::vector<std::vector<std::size_t>> members(incidences.wi.size());
  for (std::size_t i = 0; i < samples.size(); ++i) members[incidences.group[i]].push_back(i);
  const std::size_t needed = SelFreeParameters(recipe.sel->lobes, samples.values.size());
  std::vector<SelNode> nodes;
  for (std::size_t g = 0; g < members.size(); ++g) {
    if (members[g].size() * samples.values.size() < needed) continue;
    SelNode node;
    node.wi = incidences.wi[g];
    node.samples = SamplesOf(samples, members[g], recipe);
    const std::size_t wanted = measurement.isotropic ? kFittedSamples / 2 : kFittedSamples;
    node.fitted = node.samples.Subset(StratifiedSubsample(node.samples.size(), wanted, 1));
    if (measurement.isotropic) {
      // Tables over half and difference angles have one side of the plane of incidence only, and a lobe would lean to
      // it: it has nothing to fit on the other.
      node.samples = node.samples.WithMirrorImages();
      node.fitted = node.fitted.WithMirrorImages();
    }
    nodes.push_back(std::move(node));
  }
  if (nodes.empty()) {
    throw InputError(fmt::format(
        "{}: recipe '{}' needs {} values at one incident direction, and none of the {} has as many; take fewer lobes",
        measurement.source, recipe.name, needed, members.size()));
  }
  return nodes;
}

void JoinNeighbours(std::vector<SelNode>* nodes) {
  const std::size_t n = nodes->size();
  std::vector<double> nearest(n, -2);  // cosine of the angle to the tree
  std::vector<std::size_t> parent(n, 0);
  std::vector<bool> joined(n, false);
  for (std::size_t step = 0; step < n; ++step) {
    std::size_t next = n;
    for (std::size_t k = 0; k < n; ++k) {
      if (!joined[k] && (next == n || nearest[k] > nearest[next])) next = k;
    }
    joined[next] = true;
    SelNode& node = (*nodes)[next];
    if (step > 0) {
      node.depth = (*nodes)[parent[next]].depth + 1;
      node.neighbours.push_back(parent[next]);
      (*nodes)[parent[next]].neighbours.push_back(next);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const double cosine = Dot(node.wi, (*nodes)[k].wi);
      if (!joined[k] && cosine > nearest[k]) {
        nearest[k] = cosine;
        parent[k] = next;
      }
    }
  }
}

void SweepSelNodes(const SelSliceOptions& options, double drift, ThreadPool* pool, Progress* progress,
                   std::vector<SelNode>* nodes) {
  for (const std::size_t parity : {std::size_t{0}, std::size_t{1}}) {
    std::vector<std::size_t> turn;
    for (std::size_t k = 0; k < nodes->size(); ++k) {
      if ((*nodes)[k].depth % 2 == parity) turn.push_back(k);
    }
    std::vector<SelSliceFit> fits(turn.size());
    pool->Run(turn.size(), [&](std::size_t j) {
      fits[j] = Refit(*nodes, turn[j], options, drift);
      progress->Advance();
    });
    for (std::size_t j = 0; j < turn.size(); ++j) (*nodes)[turn[j]].fit = fits[j];
  }
}

}  // namespace lobefit
