// Noise-free recovery of random materials from default starts: how many are found to 1e-6 and 1e-8, and which are not.
//   bench_recovery TRIALS DETECTOR_STEP_DEG [METRIC]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "tests/support/synthetic.h"
#include <fmt/format.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/fit.h"

namespace lobefit {
namespace {

// Alphas from 0.02 to 0.8 with a ratio of at most 8, tilt up to 15 degrees in any direction.
SyntheticCase RandomTruth(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const double alpha_x = 0.02 * std::pow(40, unit(random));
  const double alpha_y = std::max(0.02, alpha_x * std::pow(8, -unit(random)));
  const double tilt = 15 * std::sqrt(unit(random)), azimuth = 2 * kPi * unit(random);
  const auto three = [&](double low, double high) {
    std::vector<double> values;
    for (int c = 0; c < 3; ++c) values.push_back(low + (high - low) * unit(random));
    return values;
  };
  SyntheticCase truth = OneLobe(Ndf::kEllipsoid, alpha_x, alpha_y, tilt * std::cos(azimuth), tilt * std::sin(azimuth),
                                180 * unit(random) - 90);
  truth.values[5] = three(0.03, 0.95);
  truth.values[6] = three(0.0, 0.5);
  return truth;
}

struct Outcome {
  double error = 0;  // largest relative difference of slope widths, f0 and diffuse; of slopes to the widths
  bool trusted = false;
  double cost = 0;
};

Outcome Try(const SyntheticCase& truth, double step_deg, Metric metric) {
  GoniometerLayout layout = StandardLayout();
  layout.detector_step = DegreesToRadians(step_deg);
  Measurement measurement = Synthetic(truth, layout, 0, 1);
  Recipe recipe = AutomaticRecipe(TraitsOf(measurement));
  recipe.metric = metric;
  const Material material = Fit(recipe, {}, &measurement);
  const auto shape = [](const ParameterValues& v) {
    return OffCenterFromEllipsoid({v[0][0], v[1][0], v[2][0], v[3][0], v[4][0]});
  };
  const OffCenter found = shape(material.Values()), expected = shape(truth.values);
  const double width_x = std::sqrt(expected.q11), width_y = std::sqrt(expected.q22);
  Outcome outcome;
  const auto compare = [&](double a, double b, double scale) {
    outcome.error = std::max(outcome.error, std::fabs(a - b) / scale);
  };
  compare(found.slope_x, expected.slope_x, width_x);
  compare(found.slope_y, expected.slope_y, width_y);
  compare(found.q11, expected.q11, expected.q11);
  compare(found.q22, expected.q22, expected.q22);
  compare(found.q12, expected.q12, width_x * width_y);
  for (std::size_t c = 0; c < 3; ++c) {
    compare(material.parameters[5].values[c], truth.values[5][c], truth.values[5][c]);
    compare(material.parameters[6].values[c], truth.values[6][c], std::max(0.01, truth.values[6][c]));
  }
  outcome.trusted = material.termination.converged && material.termination.determined;
  outcome.cost = material.cost;
  return outcome;
}

void Run(int trials, double step_deg, Metric metric) {
  std::vector<Outcome> outcomes(static_cast<std::size_t>(trials));
  ThreadPool pool(HardwareThreads());
  pool.Run(outcomes.size(), [&](std::size_t k) { outcomes[k] = Try(RandomTruth(k), step_deg, metric); });
  int within_6 = 0, within_8 = 0, wrong = 0;
  for (std::size_t k = 0; k < outcomes.size(); ++k) {
    const Outcome& o = outcomes[k];
    within_6 += o.error <= 1e-6 ? 1 : 0;
    within_8 += o.error <= 1e-8 ? 1 : 0;
    wrong += o.error > 1e-6 && o.trusted ? 1 : 0;
    if (o.error <= 1e-8) continue;
    const ParameterValues v = RandomTruth(k).values;
    fmt::print("{}: error {:.1e}, cost {:.1e}, {}; alpha {:.3f} {:.3f}, tilt {:.1f}, f0 {:.2f} {:.2f} {:.2f}\n", k,
               o.error, o.cost, o.trusted ? "trusted" : "not trusted", v[0][0], v[1][0],
               RadiansToDegrees(std::hypot(v[2][0], v[3][0])), v[5][0], v[5][1], v[5][2]);
  }
  fmt::print("{} of {} to 1e-6, {} to 1e-8; {} wrong but reported as converged\n", within_6, trials, within_8, wrong);
}

int Main(int argc, char** argv) {
  const Choice<Metric>* metric = Find(MetricChoices(), argc > 3 ? argv[3] : "cube-root");
  if (argc < 3 || metric == nullptr) {
    std::fprintf(stderr, "usage: bench_recovery TRIALS DETECTOR_STEP_DEG [METRIC]\n");
    return 2;
  }
  Run(std::atoi(argv[1]), std::atof(argv[2]), metric->value);
  return 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) { return lobefit::Main(argc, argv); }
