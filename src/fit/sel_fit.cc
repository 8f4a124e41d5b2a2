#include "lobefit/fit/sel_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/parallel.h"
#include "lobefit/base/progress.h"
#include "lobefit/core/reflectance.h"
#include "lobefit/fit/prediction.h"
#include "lobefit/fit/problem.h"
#include "lobefit/fit/sel_envelope.h"
#include "lobefit/fit/sel_slice.h"
#include "lobefit/fit/starts.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/synthesis.h"

namespace lobefit {
namespace {

// Samples of one incident direction that are fitted; a bound is made of all.
constexpr std::size_t kFittedSamples = 600;
constexpr int kSweeps = 2;

struct Node {
  Vec3 wi;
  SelSamples samples, fitted;
  SelSliceFit fit;
  double variance = 0;
  std::vector<std::size_t> neighbours;
  std::size_t depth = 0;
};

std::vector<Node> MakeNodes(const Measurement& measurement, const Recipe& recipe) {
  const Incidences incidences = GroupByIncidence(measurement);
  const Samples& samples = measurement.samples;
  std::vector<std::vector<std::size_t>> members(incidences.wi.size());
  for (std::size_t i = 0; i < samples.size(); ++i) members[incidences.group[i]].push_back(i);
  const std::size_t needed = SelFreeParameters(recipe.sel->lobes, samples.values.size());
  std::vector<Node> nodes;
  for (std::size_t g = 0; g < members.size(); ++g) {
    if (members[g].size() * samples.values.size() < needed) continue;
    Node node;
    node.wi = incidences.wi[g];
    node.samples.f_r.resize(samples.values.size());
    for (const std::size_t i : members[g]) {
      node.samples.v.push_back(MirrorFrame(samples.wi(i)) * samples.wo(i));
      node.samples.cos_i.push_back(samples.wi_z[i]);
      node.samples.cos_o.push_back(samples.wo_z[i]);
      node.samples.weight.push_back(SampleWeight(recipe.metric, recipe.weighting, true, samples, i));
      for (std::size_t c = 0; c < samples.values.size(); ++c) node.samples.f_r[c].push_back(samples.values[c][i]);
    }
    const double sum = [&] {
      double total = 0;
      for (const double w : node.samples.weight) total += w;
      return total;
    }();
    // Mean 1, so that pulls weigh the same under every weighting. Along the normal the sines of ngan and low-log
    // vanish.
    for (double& w : node.samples.weight) w = sum > 0 ? w * static_cast<double>(node.samples.size()) / sum : 1.0;
    node.fitted = node.samples.Subset(StratifiedSubsample(node.samples.size(), kFittedSamples, 1));
    nodes.push_back(std::move(node));
  }
  if (nodes.empty()) {
    throw InputError(fmt::format(
        "{}: recipe '{}' needs {} values at one incident direction, and none of the {} has as many; take fewer lobes",
        measurement.source, recipe.name, needed, members.size()));
  }
  return nodes;
}

// Prim's tree of nearest neighbours, from the direction nearest to the normal.
void JoinNeighbours(std::vector<Node>* nodes) {
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
    Node& node = (*nodes)[next];
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

// One slice again, pulled by its neighbours: from its own lobes and from each neighbour's.
SelSliceFit Refit(const std::vector<Node>& nodes, std::size_t k, const SelSliceOptions& options, double drift) {
  const Node& node = nodes[k];
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

// Raises amplitudes and constants until no sample lies above the table as it is evaluated. Slices interpolated between
// neighbours, and samples a little off the mean direction of their group, can leave some above.
void RaiseAboveSamples(const Measurement& measurement, ThreadPool* pool, Material* material) {
  constexpr double kMargin = 1 + 1e-9;
  const Samples& samples = measurement.samples;
  SelTable& table = *material->sel;
  const auto raise = [](double factor, SelSlice* slice) {
    for (std::vector<double>& amplitude : slice->amplitude) {
      for (double& a : amplitude) a *= factor;
    }
    for (double& constant : slice->constant) constant *= factor;
  };
  for (int round = 0; round < 8; ++round) {
    const std::vector<std::vector<double>> f_r = Predict(*material, samples, pool);
    std::vector<double> factor(table.slices.size(), 1.0);
    double worst = 1;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      double ratio = 1;
      for (std::size_t c = 0; c < f_r.size(); ++c) {
        if (samples.values[c][i] > 0) ratio = std::max(ratio, kMargin * samples.values[c][i] / f_r[c][i]);
      }
      if (ratio <= 1) continue;
      worst = std::max(worst, ratio);
      // The slice nearest to the sample's incident direction.
      const double theta = PolarAngle(samples.wi(i)), phi = Azimuth(samples.wi(i));
      std::size_t nearest = 0;
      double best = -2;
      for (std::size_t s = 0; s < table.slices.size(); ++s) {
        const Vec3 at = FromSpherical(table.slices[s].theta_i, table.isotropic ? phi : table.slices[s].phi_i);
        const double cosine = Dot(at, FromSpherical(theta, phi));
        if (cosine > best) {
          best = cosine;
          nearest = s;
        }
      }
      factor[nearest] = std::max(factor[nearest], ratio);
    }
    if (worst <= 1) return;
    // The last round raises all slices alike, which cannot leave a sample above.
    for (std::size_t s = 0; s < table.slices.size(); ++s) raise(round < 6 ? factor[s] : worst, &table.slices[s]);
  }
}

void Describe(const Recipe& recipe, const Measurement& measurement, const std::vector<Node>& nodes, ThreadPool* pool,
              Material* material) {
  material->channels = measurement.channels.names;
  material->wavelengths_nm = measurement.channels.wavelengths_nm;
  material->model.diffuse = Diffuse::kNone;
  const std::vector<std::vector<double>> f_r = Predict(*material, measurement.samples, pool);
  material->errors = ErrorsUnderAllMetrics(recipe.weighting, measurement.samples, f_r, pool);
  material->cost = SumSquares(recipe.metric, recipe.weighting, true, measurement.samples, f_r).MeanSquare() *
                   static_cast<double>(measurement.samples.size() * f_r.size()) / 2;
  std::size_t unfinished = 0;
  for (const Node& node : nodes) {
    unfinished += node.fit.converged ? 0 : 1;
    material->termination.iterations += node.fit.iterations;
  }
  material->termination.converged = unfinished == 0;
  material->termination.determined = true;
  material->termination.message =
      unfinished == 0 ? "every incident direction converged"
                      : fmt::format("{} of {} incident directions did not converge", unfinished, nodes.size());
  material->remarks = measurement.remarks;
  const std::size_t groups = GroupByIncidence(measurement).wi.size();
  if (groups > nodes.size()) {
    material->remarks.push_back(
        fmt::format("{} of {} incident directions have fewer values than {} lobes have parameters and are left to "
                    "interpolation between the others",
                    groups - nodes.size(), groups, recipe.sel->lobes));
  }
  material->samples_used = measurement.samples.size();
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    if (measurement.set_aside[reason] > 0)
      material->set_aside[std::string(Key(reason))] = measurement.set_aside[reason];
  }
  material->source = {measurement.source, measurement.sha256, measurement.format, measurement.conventions};
  material->recipe_name = recipe.name;
  material->recipe_reason = recipe.reason;
  material->metric = NameOf(MetricChoices(), recipe.metric);
  material->weighting = NameOf(WeightingChoices(), recipe.weighting);
  material->loss = NameOf(LossChoices(), recipe.loss);
  material->theta_max_deg = RadiansToDegrees(recipe.theta_max);
}

}  // namespace

Material FitSel(const Recipe& wanted, const FitOptions& options, Measurement* measurement) {
  const auto start_time = std::chrono::steady_clock::now();
  Material material;
  material.samples_read = measurement->samples.size() + measurement->set_aside.total();
  Recipe recipe = wanted;
  recipe.weighting = EffectiveWeighting(wanted.weighting, measurement->samples);
  SetAsideForRecipe(recipe, measurement);
  if (recipe.weighting == Weighting::kSolidAngle && measurement->samples.solid_angle.empty())
    Problem(measurement->samples, recipe);  // says what is missing
  const SelRecipe& sel = *recipe.sel;
  std::vector<Node> nodes = MakeNodes(*measurement, recipe);
  JoinNeighbours(&nodes);
  SelSliceOptions slice_options;
  slice_options.metric = recipe.metric;
  slice_options.quantity = sel.quantity;
  ThreadPool pool(std::max(1, options.threads));
  Progress progress("fitting lobes", nodes.size() * (1 + kSweeps + (sel.bound ? 1 : 0)));

  pool.Run(nodes.size(), [&](std::size_t k) {
    Node& node = nodes[k];
    const double theta = PolarAngle(node.wi);
    node.fit = SearchSelSlice(node.fitted, theta, sel.lobes, slice_options);
    node.fit.slice.theta_i = theta;
    node.fit.slice.phi_i = measurement->isotropic ? 0.0 : Azimuth(node.wi);
    node.variance = node.fit.sum_squares / static_cast<double>(node.fitted.size() * node.fitted.channels());
    progress.Advance();
  });
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const std::size_t parity : {std::size_t{0}, std::size_t{1}}) {
      std::vector<std::size_t> turn;
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (nodes[k].depth % 2 == parity) turn.push_back(k);
      }
      std::vector<SelSliceFit> fits(turn.size());
      pool.Run(turn.size(), [&](std::size_t j) {
        fits[j] = Refit(nodes, turn[j], slice_options, sel.drift);
        progress.Advance();
      });
      for (std::size_t j = 0; j < turn.size(); ++j) nodes[turn[j]].fit = fits[j];
    }
  }
  if (sel.bound) {
    pool.Run(nodes.size(), [&](std::size_t k) {
      nodes[k].fit.slice = BoundSelSlice(nodes[k].samples, sel.quantity, nodes[k].fit.slice);
      progress.Advance();
    });
  }

  material.sel = SelTable{sel.quantity, measurement->isotropic, sel.bound, {}};
  for (const Node& node : nodes) material.sel->slices.push_back(node.fit.slice);
  material.channels = measurement->channels.names;
  if (sel.bound) RaiseAboveSamples(*measurement, &pool, &material);
  Describe(recipe, *measurement, nodes, &pool, &material);
  material.timings_s = {{"read", 0.0}, {"report", 0.0}};
  material.timings_s["fit"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time).count();
  return material;
}

Material FitRecipe(const Recipe& recipe, const FitOptions& options, Measurement* measurement) {
  return recipe.sel ? FitSel(recipe, options, measurement) : Fit(recipe, options, measurement);
}

Measurement SampleForSel(const Material& material) {
  const Reflectance reflectance(material.model, material.Values(), material.channels.size());
  bool isotropic = true;
  double narrowest = 1;
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) {
    const std::vector<FittedParameter>& p = material.parameters;
    const std::size_t at = FirstParameter(material.model, l);
    narrowest = std::min({narrowest, p[at].values[0], p[at + 1].values[0]});
    isotropic =
        isotropic && p[at].values[0] == p[at + 1].values[0] && p[at + 2].values[0] == 0 && p[at + 3].values[0] == 0;
  }
  DirectionList directions;
  const double limit = std::cos(DegreesToRadians(85));
  for (int theta = 0; theta <= 80; theta += 10) {
    for (int phi = 0; phi < (isotropic || theta == 0 ? 1 : 360); phi += 45) {
      const Vec3 wi = FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi));
      const Mat3 to_world = Transposed(MirrorFrame(wi));
      const auto add = [&](const Vec3& wo) {
        if (wo.z <= limit) return;
        directions.wi.push_back(wi);
        directions.wo.push_back(wo);
      };
      add(to_world * Vec3{0, 0, 1});
      constexpr int kRings = 16, kSpokes = 16;
      for (int ring = 0; ring < kRings; ++ring) {
        // Radii from a tenth of the lobe's half width (about twice alpha in wo) to a right angle.
        const double low = std::log(0.2 * narrowest), high = std::log(1.0);
        const double radius = 2 * std::atan(std::exp(low + (high - low) * ring / (kRings - 1)));
        for (int spoke = 0; spoke < kSpokes; ++spoke)
          add(to_world * FromSpherical(radius, 2 * kPi * (spoke + 0.5 * (ring % 2)) / kSpokes));
      }
      for (int theta_o = 0; theta_o <= 80; theta_o += 10) {
        for (int phi_o = 0; phi_o < (theta_o == 0 ? 10 : 360); phi_o += 20)
          add(FromSpherical(DegreesToRadians(theta_o), DegreesToRadians(phi_o + phi)));
      }
    }
  }
  Measurement measurement = Synthesise(
      directions, {material.channels, material.wavelengths_nm},
      [&](const Vec3& wi, const Vec3& wo, double* f_r) { reflectance.Evaluate(wi, wo, f_r); }, {}, 1);
  measurement.isotropic = isotropic;
  measurement.format = "material";
  return measurement;
}

}  // namespace lobefit
