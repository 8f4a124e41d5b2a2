#include "lobefit/fit/search/starts.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "lobefit/fit/search/descent.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// A factor of 1.6 to 2 between neighbours: from any lobe the nearest is well within the basin of its minimum.
constexpr double kAlphas[] = {0.005, 0.01, 0.02, 0.04, 0.08, 0.15, 0.25, 0.4, 0.65};
// Polished surfaces bend within the width of an instrument.
constexpr double kPolishedAlphas[] = {0.0002, 0.0005, 0.0012, 0.0025};
constexpr double kMirror = 5e-4;  // narrower than the cells of any table
constexpr double kAspect = 4;     // alpha_x / alpha_y of the anisotropic candidates
// With more channels candidates are ranked by some of them first, and so many times the wanted ones by all: the ranking
// of 100 shapes by 800 channels took two fifths of a fit.
constexpr std::size_t kFewChannels = 96, kChannelsOfRanking = 32, kPromising = 3;

// Where the density of normals peaks: mean half vector of the samples with the highest f_r cos_theta_i cos_theta_o
// (about D F G).
Vec3 PeakNormal(const Samples& samples) {
  std::vector<double> density(samples.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (const std::vector<double>& values : samples.values) density[i] += values[i];
    density[i] *= samples.wi_z[i] * samples.wo_z[i];
  }
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t top = std::max<std::size_t>(1, samples.size() / 100);
  std::partial_sort(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(top), order.end(),
      [&](std::size_t a, std::size_t b) { return density[a] != density[b] ? density[a] > density[b] : a < b; });
  Vec3 sum = {0, 0, 0};
  for (std::size_t k = 0; k < top; ++k) {
    const std::size_t i = order[k];
    sum = sum + std::max(density[i], 1e-300) * HalfVector(samples.wi(i), samples.wo(i));
  }
  return Normalized(sum);
}

// Candidates with the entries that the recipe gives a start for replaced by it; repeated candidates are dropped.
std::vector<Ellipsoid> WithGivenStarts(std::vector<Ellipsoid> candidates, const Recipe& recipe, std::size_t lobe) {
  std::vector<Ellipsoid> distinct;
  for (Ellipsoid& shape : candidates) {
    double* entries[] = {&shape.alpha_x, &shape.alpha_y, &shape.theta_x, &shape.theta_y, &shape.theta_z};
    for (std::size_t i = 0; i < 5; ++i) {
      const std::vector<double>& start = recipe.parameters[FirstParameter(recipe.model, lobe) + i].start;
      if (!start.empty()) *entries[i] = start[0];
    }
    if (IsRound(recipe.model.lobes[lobe].ndf)) shape.alpha_y = shape.alpha_x;
    const bool seen = std::any_of(distinct.begin(), distinct.end(), [&](const Ellipsoid& other) {
      return other.alpha_x == shape.alpha_x && other.alpha_y == shape.alpha_y && other.theta_x == shape.theta_x &&
             other.theta_y == shape.theta_y && other.theta_z == shape.theta_z;
    });
    if (!seen) distinct.push_back(shape);
  }
  return distinct;
}

}  // namespace

std::vector<std::size_t> StratifiedSubsample(std::size_t samples, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> indices;
  if (samples <= count) {
    indices.resize(samples);
    std::iota(indices.begin(), indices.end(), std::size_t{0});
    return indices;
  }
  std::mt19937_64 random(seed);
  const double run = static_cast<double>(samples) / static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double place = static_cast<double>(random() >> 11U) * 0x1p-53;
    indices.push_back(std::min(samples - 1, static_cast<std::size_t>((static_cast<double>(k) + place) * run)));
  }
  return indices;
}

std::vector<double> LinearisedWeights(const Samples& samples, Metric metric, const NoiseModel& noise) {
  std::vector<double> weight(samples.size()), value(samples.size());
  double mean = 0;
  for (const std::vector<double>& values : samples.values) {
    for (std::size_t i = 0; i < samples.size(); ++i) mean += std::fabs(values[i] * samples.wi_z[i]);
  }
  mean /= static_cast<double>(samples.size() * samples.values.size());
  // Keeps the slope of the cube root and of the relative error finite at zero.
  const double floor = 1e-3 * mean + 1e-300;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double v = 0;
    for (const std::vector<double>& values : samples.values) v += values[i] * samples.wi_z[i];
    v = std::max(v / static_cast<double>(samples.values.size()), floor);
    value[i] = v;
  }
  const std::vector<double> one(samples.size(), 1.0);
  InverseSlopes(TransformOf(metric, noise), value.data(), one.data(), value.size(), weight.data());
  for (std::size_t i = 0; i < samples.size(); ++i)
    weight[i] = (samples.weight.empty() ? 1.0 : samples.weight[i]) / (weight[i] * weight[i]);
  const SigmaWeights sigma(samples, metric, noise);
  if (sigma.empty()) return weight;
  const std::vector<double> stated = sigma.AtReadings();
  for (std::size_t i = 0; i < samples.size(); ++i) weight[i] *= stated[i];
  return weight;
}

Ellipsoid PeakAxis(const Samples& samples, Ndf ndf, double plane_azimuth) {
  const Vec3 peak = PeakNormal(samples);
  if (!IsInPlane(ndf)) return {1, 1, std::asin(std::clamp(peak.y, -1.0, 1.0)), std::atan2(-peak.x, peak.z), 0};
  const double along = peak.x * std::cos(plane_azimuth) + peak.y * std::sin(plane_azimuth);
  return {1, 1, 0, std::atan2(-along, peak.z), -plane_azimuth};
}

std::vector<Ellipsoid> CandidateShapes(const Samples& samples, Ndf ndf, double plane_azimuth) {
  std::vector<Ellipsoid> tilts = {{1, 1, 0, 0, IsInPlane(ndf) ? -plane_azimuth : 0.0}};
  if (IsTilted(ndf)) tilts.push_back(PeakAxis(samples, ndf, plane_azimuth));
  std::vector<double> alphas(std::begin(kAlphas), std::end(kAlphas));
  if (FamilyOf(ndf) == Family::kAbg)
    alphas.insert(alphas.begin(), std::begin(kPolishedAlphas), std::end(kPolishedAlphas));
  std::vector<Ellipsoid> shapes;
  for (const Ellipsoid& tilt : tilts) {
    for (const double alpha : alphas) {
      Ellipsoid shape = tilt;
      shape.alpha_x = shape.alpha_y = alpha;
      shapes.push_back(shape);
      if (IsRound(ndf)) continue;
      for (const double degrees : {0.0, 45.0, 90.0, -45.0}) {
        shape.alpha_x = std::min(1.0, alpha * std::sqrt(kAspect));
        shape.alpha_y = alpha / std::sqrt(kAspect);
        shape.theta_z = DegreesToRadians(degrees);
        shapes.push_back(shape);
      }
    }
  }
  return shapes;
}

double StepLinear(const Problem& problem, const Layout& layout, std::vector<double>* u, ThreadPool* pool) {
  ArrowMatrix hessian;
  Eigen::VectorXd gradient;
  KernelModel kernel = layout.ToKernel(u->data());
  const std::size_t dropped = layout.DropShapes(&kernel);
  const KernelSums sums = problem.Sum(kernel, true, pool);
  layout.Gather(sums, &hessian, &gradient, dropped);
  const double cost = sums.sum_rho / 2;
  if (layout.size() == layout.shape_size() || !hessian.AllFinite() || !gradient.allFinite()) return cost;
  Eigen::VectorXd low = Eigen::VectorXd::Zero(gradient.size()), high = low;  // shapes stay
  for (std::size_t k = layout.shape_size(); k < layout.size(); ++k) {
    low(static_cast<Eigen::Index>(k)) = layout.coordinates()[k].low - (*u)[k];
    high(static_cast<Eigen::Index>(k)) = layout.coordinates()[k].high - (*u)[k];
  }
  const Eigen::VectorXd step = BoundedStep(hessian, gradient, low, high);
  for (std::size_t k = layout.shape_size(); k < layout.size(); ++k) {
    (*u)[k] = std::clamp((*u)[k] + step(static_cast<Eigen::Index>(k)), layout.coordinates()[k].low,
                         layout.coordinates()[k].high);
  }
  return cost;
}

namespace {

// Candidate shapes of all lobes together.
std::vector<std::vector<Ellipsoid>> CandidateTuples(const Recipe& recipe, const Layout& layout,
                                                    const Samples& samples) {
  std::vector<std::vector<Ellipsoid>> tuples = {{}};
  for (std::size_t l = 0; l < recipe.model.lobes.size(); ++l) {
    std::vector<std::vector<Ellipsoid>> longer;
    std::vector<Ellipsoid> shapes = CandidateShapes(samples, recipe.model.lobes[l].ndf, recipe.plane_azimuth);
    // Of several lobes one with Schlick's edge may have to vanish, which it does as a mirror only.
    if (recipe.model.lobes.size() > 1) shapes.push_back({kMirror, kMirror, 0, 0, 0});
    const std::vector<Ellipsoid> candidates = WithGivenStarts(shapes, recipe, l);
    for (const std::vector<Ellipsoid>& tuple : tuples) {
      for (const Ellipsoid& shape : candidates) {
        // Of interchangeable lobes narrower ones first; and of several lobes only isotropic candidates
        // are combined.
        const bool given = !recipe.parameters[FirstParameter(recipe.model, l)].start.empty();
        const bool same = l > 0 && layout.AreInterchangeable(l - 1, l);
        if (!given && !tuple.empty() &&
            (same ? shape.alpha_x <= tuple.back().alpha_x : shape.alpha_x == tuple.back().alpha_x))
          continue;
        if (!given && recipe.model.lobes.size() > 1 && shape.alpha_x != shape.alpha_y) continue;
        longer.push_back(tuple);
        longer.back().push_back(shape);
      }
    }
    tuples = longer;
  }
  return tuples;
}

// The candidates in their order, with their linear parameters solved for.
std::vector<Start> Solved(const Problem& problem, const Layout& layout, const Samples& samples,
                          const std::vector<std::vector<Ellipsoid>>& tuples, ThreadPool* pool) {
  const Recipe& recipe = layout.recipe();
  // Amplitudes first under the metric linearised about the measured values, where one step is exact; then under the
  // metric itself.
  Samples weighted = samples;
  weighted.sigma.clear();  // they are in the weights
  weighted.weight = LinearisedWeights(samples, recipe.metric, recipe.noise);
  Recipe linear = recipe;
  linear.metric = Metric::kCosineL2;
  linear.loss = Loss::kNone;
  const Layout linear_layout(linear, std::vector<std::string>(layout.channels()));
  const Problem linear_problem(weighted, linear);
  std::vector<Start> starts(tuples.size());
  pool->Run(tuples.size(), [&](std::size_t k) {
    ThreadPool alone(1);
    std::vector<double> u = layout.FromShapes(tuples[k]);
    StepLinear(linear_problem, linear_layout, &u, &alone);
    starts[k].u = u;
    starts[k].cost = StepLinear(problem, layout, &u, &alone);
    // The step may overshoot under a compressive metric: keep the better of the two.
    const double after = problem.Sum(layout.ToKernel(u.data()), false, &alone).sum_rho / 2;
    if (after < starts[k].cost) starts[k] = {u, after};
  });
  return starts;
}

// The part of a recipe that speaks of these channels.
Recipe OfChannels(const Recipe& recipe, const std::vector<std::size_t>& channels) {
  Recipe part = recipe;
  for (ParameterRecipe& entry : part.parameters) {
    for (std::vector<double>* values : {&entry.start, &entry.fixed}) {
      if (values->size() <= 1) continue;
      std::vector<double> some;
      for (const std::size_t c : channels) some.push_back((*values)[std::min(c, values->size() - 1)]);
      *values = std::move(some);
    }
  }
  return part;
}

// The `most` candidates that suit some of the channels best, in their order. What tells shapes apart is common to the
// channels: of hundreds a few tell them as well.
std::vector<std::vector<Ellipsoid>> Promising(const Layout& layout, const Samples& samples, std::size_t most,
                                              std::vector<std::vector<Ellipsoid>> tuples, ThreadPool* pool) {
  std::vector<std::size_t> channels;
  for (std::size_t k = 0; k < kChannelsOfRanking; ++k)
    channels.push_back((2 * k + 1) * layout.channels() / (2 * kChannelsOfRanking));
  const Recipe recipe = OfChannels(layout.recipe(), channels);
  Samples part = samples;
  part.values.clear();
  for (const std::size_t c : channels) part.values.push_back(samples.values[c]);
  const std::vector<Start> starts =
      Solved(Problem(part, recipe), Layout(recipe, std::vector<std::string>(channels.size())), part, tuples, pool);
  std::vector<std::size_t> order(tuples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto cost = [&](std::size_t k) { return std::isfinite(starts[k].cost) ? starts[k].cost : INFINITY; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cost(a) < cost(b); });
  order.resize(std::min(order.size(), most));
  std::sort(order.begin(), order.end());
  std::vector<std::vector<Ellipsoid>> best;
  for (const std::size_t k : order) best.push_back(std::move(tuples[k]));
  return best;
}

}  // namespace

std::vector<Start> RankedStarts(const Problem& problem, const Layout& layout, const Samples& samples,
                                std::size_t wanted, ThreadPool* pool) {
  std::vector<std::vector<Ellipsoid>> tuples = CandidateTuples(layout.recipe(), layout, samples);
  const std::size_t promising = kPromising * std::max<std::size_t>(wanted, 1);
  if (layout.channels() > kFewChannels && tuples.size() > promising)
    tuples = Promising(layout, samples, promising, std::move(tuples), pool);
  std::vector<Start> starts = Solved(problem, layout, samples, tuples, pool);
  std::erase_if(starts, [](const Start& start) { return !std::isfinite(start.cost); });
  std::stable_sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.cost < b.cost; });
  return starts;
}

}  // namespace lobefit
