#include "lobefit/validate/experiment.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/inference/noise_bias.h"
#include "lobefit/fit/inference/outlier_pull.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/math/vec.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/measurement/prepare/pool.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {
namespace {

// Streams of one trial's seed.
enum TrialStream : std::uint64_t { kMaterial = 100, kNoise = 101, kTurnedNoise = 102 };

std::vector<Ellipsoid> Shapes(const Truth& truth) {
  std::vector<Ellipsoid> shapes;
  for (std::size_t l = 0; l < truth.model.lobes.size(); ++l) {
    const std::vector<double>* v = &truth.values[FirstParameter(truth.model, l)];
    shapes.push_back({v[0][0], v[1][0], v[2][0], v[3][0], v[4][0]});
  }
  return shapes;
}

// The cost function of the fit at the true parameters; with gains of 1.
double CostAt(const Truth& truth, const Experiment& experiment, const Measurement& measurement) {
  Recipe recipe = experiment.recipe;
  for (std::size_t i = 0; i < recipe.parameters.size(); ++i) recipe.parameters[i].start = truth.values[i];
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(measurement.samples, recipe);
  std::vector<double> u = layout.FromShapes(Shapes(truth));
  if (recipe.instrument.alignment) {
    u[layout.first_angle()] = experiment.noise.misalignment_x;
    u[layout.first_angle() + 1] = experiment.noise.misalignment_y;
  }
  // Half angles are differences from the recipe's.
  std::size_t next = layout.first_half_angle();
  if (recipe.instrument.source_prior) u[next++] = experiment.noise.source - recipe.aperture().source;
  if (recipe.instrument.detector_prior) u[next] = experiment.noise.aperture - recipe.aperture().detector;
  ThreadPool alone(1);
  return problem.Sum(layout.ToKernel(u.data()), false, &alone).sum_rho / 2;
}

// The light and the detector go where they went before: in the frame of a sample turned by half, to the other side. So
// seen, the stage is crooked the other way.
Measurement TurnedMeasurement(const Experiment& experiment, const Truth& truth, Noise noise, std::uint64_t seed) {
  DirectionList directions = experiment.directions;
  for (std::vector<Vec3>* list : {&directions.wi, &directions.wo}) {
    for (Vec3& w : *list) w = {-w.x, -w.y, w.z};
  }
  noise.misalignment_x = -noise.misalignment_x;
  noise.misalignment_y = -noise.misalignment_y;
  Measurement measurement =
      Synthesise(directions, ChannelsNamed(truth.channels), BrdfOf(truth), noise, seed, SmallestAlpha(truth));
  measurement.samples.sample_azimuth.assign(measurement.samples.size(), kPi);
  return measurement;
}

// What every trial measures before its noise, where all measure one material in one way: the means over both discs take
// longer than ten fits.
std::optional<Measurement> CommonTruth(const Experiment& experiment) {
  if (experiment.range || experiment.noise.misalignment > 0) return std::nullopt;
  const Truth& truth = experiment.truth;
  return TrueMeasurement(experiment.directions, ChannelsNamed(truth.channels), BrdfOf(truth), experiment.noise,
                         SmallestAlpha(truth));
}

Measurement MeasurementOf(const Experiment& experiment, const Truth& truth, std::uint64_t seed,
                          const std::optional<Measurement>& common) {
  const std::uint64_t first = StreamSeed(seed, kNoise);
  const Noise noise = DrawnNoise(experiment.noise, first);
  Measurement measurement = common ? *common
                                   : TrueMeasurement(experiment.directions, ChannelsNamed(truth.channels),
                                                     BrdfOf(truth), noise, SmallestAlpha(truth));
  AddNoise(noise, first, &measurement);
  if (experiment.turned) {
    measurement = Pool(
        {std::move(measurement), TurnedMeasurement(experiment, truth, noise, StreamSeed(seed, kTurnedNoise))}, false);
  }
  measurement.isotropic = experiment.isotropic;
  measurement.source = "synthetic";
  return measurement;
}

}  // namespace

namespace {

std::vector<double> KnotsOf(const Lobe& lobe) {
  const std::shared_ptr<const ProfileGrid>& grid = GridOf(lobe);
  return grid == nullptr ? std::vector<double>{} : grid->spline()->knots();
}

// Largest relative difference of the fitted parameters that have an error: of the lobes' ellipses in slope space, of
// all others against the larger of 1 and the truth.
double DifferenceFrom(const Truth& truth, const Material& material) {
  double largest = SlopeDifference(truth, material.Values());
  const std::vector<Parameter> parameters = Parameters(truth.model);
  std::vector<bool> of_ellipse(parameters.size());
  for (std::size_t l = 0; l < truth.model.lobes.size(); ++l)
    std::fill_n(of_ellipse.begin() + static_cast<std::ptrdiff_t>(FirstParameter(truth.model, l)), kEllipseParameters,
                true);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FittedParameter& fitted = material.parameters[i];
    for (std::size_t c = 0; c < fitted.values.size() && !of_ellipse[i]; ++c) {
      const double expected = truth.values[i][c];
      if (!std::isnan(fitted.standard_error[c]))
        largest = std::max(largest, std::fabs(fitted.values[c] - expected) / std::max(1.0, std::fabs(expected)));
    }
  }
  return largest;
}

}  // namespace

bool IsSameModel(const Model& a, const Model& b) {
  if (a.lobes.size() != b.lobes.size() || a.diffuse != b.diffuse) return false;
  for (std::size_t l = 0; l < a.lobes.size(); ++l) {
    if (a.lobes[l].ndf != b.lobes[l].ndf || a.lobes[l].masking != b.lobes[l].masking ||
        a.lobes[l].fresnel != b.lobes[l].fresnel || a.lobes[l].metal != b.lobes[l].metal ||
        a.lobes[l].direction != b.lobes[l].direction || KnotsOf(a.lobes[l]) != KnotsOf(b.lobes[l])) {
      return false;
    }
  }
  return true;
}

Trial CompareWithTruth(const Experiment& experiment, const Truth& truth, Measurement measurement) {
  Trial trial;
  trial.done = true;
  const auto start = std::chrono::steady_clock::now();
  try {
    const Material material = Fit(experiment.recipe, experiment.fit, &measurement);
    trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const bool same = IsSameModel(material.model, truth.model);
    const ParameterValues values = material.Values();
    // Names decide which numbers belong together where the models differ.
    const ParameterValues aligned = AlignedWith(same ? values : truth.values, truth);
    const std::vector<Entry> true_entries = Entries(truth.model, truth.channels);
    for (const Entry& entry : Entries(material.model, material.channels)) {
      const FittedParameter& fitted = material.parameters[entry.parameter];
      trial.value.push_back(fitted.values[entry.channel] / entry.factor);
      trial.standard_error.push_back(fitted.standard_error[entry.channel] / entry.factor);
      trial.standard_error_clustered.push_back(fitted.standard_error_clustered[entry.channel] / entry.factor);
      trial.freedom.push_back(fitted.freedom[entry.channel]);
      trial.independent_freedom.push_back(
          fitted.independent_freedom.empty() ? INFINITY : fitted.independent_freedom[entry.channel]);
      trial.free.push_back(fitted.free);
      trial.at_bound.push_back(fitted.at_bound);
      trial.truth.push_back(kNan);
      for (const Entry& other : true_entries) {
        if (other.name == entry.name) trial.truth.back() = aligned[other.parameter][other.channel] / entry.factor;
      }
    }
    trial.converged = material.termination.converged;
    trial.determined = material.termination.determined;
    trial.degenerate = material.degenerate;
    trial.cost = material.cost;
    trial.minima = material.minima.size();
    trial.misfit = material.misfit && material.misfit->flagged;
    trial.biased = std::any_of(material.remarks.begin(), material.remarks.end(),
                               [](const std::string& remark) { return IsBiasRemark(remark) || IsPullRemark(remark); });
    trial.samples = measurement.samples.size();
    trial.incidences = GroupByIncidence(measurement).wi.size();
    // A fit that chose another metric, or estimated the noise that its own needs, minimised another cost; where the
    // sample stood was drawn.
    const bool comparable = same && experiment.noise.misalignment == 0 && !experiment.turned &&
                            material.metric == NameOf(MetricChoices(), experiment.recipe.metric) &&
                            RowOf(experiment.recipe.metric).curve != Curve::kAsinh;
    trial.cost_at_truth = comparable ? CostAt(truth, experiment, measurement) : kNan;
    trial.difference = same ? DifferenceFrom(truth, material) : kNan;
  } catch (const InputError& error) {
    trial.error = error.what();
  }
  return trial;
}

namespace {

Trial RunTrialFrom(const std::optional<Measurement>& common, const Experiment& experiment, std::size_t index) {
  const std::uint64_t seed = StreamSeed(experiment.seed, index);
  Truth truth = experiment.truth;
  if (experiment.range) {
    RandomNumbers random(StreamSeed(seed, kMaterial));
    truth = DrawMaterial(*experiment.range, truth, &random);
  }
  return CompareWithTruth(experiment, truth, MeasurementOf(experiment, truth, seed, common));
}

}  // namespace

Trial RunTrial(const Experiment& experiment, std::size_t index) {
  return RunTrialFrom(std::nullopt, experiment, index);
}

void RunTrials(const Experiment& experiment, const std::vector<std::size_t>& indices, int threads,
               const std::function<void(std::size_t index, Trial trial)>& done, const std::atomic<bool>& stop) {
  if (indices.empty() || stop) return;
  const std::optional<Measurement> common = CommonTruth(experiment);
  ParallelFor(indices.size(), threads, [&](std::size_t k) {
    if (!stop) done(indices[k], RunTrialFrom(common, experiment, indices[k]));
  });
}

std::vector<Trial> RunTrials(const Experiment& experiment, std::size_t count, int threads,
                             const std::function<void()>& advance, const std::atomic<bool>& stop) {
  std::vector<Trial> trials(count);
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto done = [&](std::size_t index, Trial trial) {
    trials[index] = std::move(trial);
    if (advance) advance();
  };
  RunTrials(experiment, all, threads, done, stop);
  return trials;
}

}  // namespace lobefit
