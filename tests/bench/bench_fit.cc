// Whole fits, in one run: against one AutoDiffCostFunction a sample with the same model, start and end; growth of time
// and memory with the number of samples; two lobes; very many small fits. Prints a table in Markdown.
//   bench_fit [--quick] [growth|channels|autodiff|small|two-lobes]...
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/ndf/slope_ndf.h"
#include "lobefit/fit/fit.h"
#include "lobefit/fit/fit_many.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Peak resident memory so far, MB.
double PeakMemory() {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with("VmHWM:")) return std::strtod(line.c_str() + 6, nullptr) / 1024;
  }
  return 0;
}

struct Truth {
  Model model;
  ParameterValues values;
};

Truth OneLobeTruth(Ndf ndf) {
  return {{{Lobe{ndf}}, Diffuse::kLambert},
          IsRound(ndf) ? ParameterValues{{0.2}, {0.2}, {0}, {0}, {0}, {0.6, 0.5, 0.4}, {0.1, 0.2, 0.05}}
                       : ParameterValues{{0.3}, {0.12}, {0.03}, {-0.05}, {0.4}, {0.6, 0.5, 0.4}, {0.1, 0.2, 0.05}}};
}
Truth TwoLobeTruth() {
  return {{{Lobe{Ndf::kGgx}, Lobe{Ndf::kGgx}}, Diffuse::kLambert},
          {{0.04},
           {0.04},
           {0},
           {0},
           {0},
           {0.05, 0.05, 0.05},
           {0.35},
           {0.35},
           {0},
           {0},
           {0},
           {0.3, 0.2, 0.1},
           {0.1, 0.2, 0.05}}};
}

// From here on the peak is counted anew.
void ForgetPeakMemory() { std::ofstream("/proc/self/clear_refs") << "5"; }

// 200 incident directions within 80 degrees, half of the half vectors near the normal; 5 % noise.
Measurement Random(const Truth& truth, std::size_t count, std::size_t channels, std::uint64_t seed) {
  ParameterValues values = truth.values;
  for (std::vector<double>& v : values) {
    if (v.size() > channels) v.erase(v.begin() + static_cast<std::ptrdiff_t>(channels), v.end());
  }
  const Reflectance reflectance(truth.model, values, channels);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal(0, 0.05);
  Measurement measurement;
  measurement.source = "random";
  for (std::size_t c = 0; c < channels; ++c) measurement.channels.names.push_back(std::to_string(c));
  measurement.samples.values.resize(channels);
  std::vector<Vec3> incident;
  for (int k = 0; k < 200; ++k)
    incident.push_back(FromSpherical(1.39 * std::sqrt(unit(random)), 2 * kPi * unit(random)));
  std::vector<double> f_r(channels);
  while (measurement.samples.size() < count) {
    const Vec3 wi = incident[measurement.samples.size() % incident.size()];
    Vec3 wo = FromSpherical(1.39 * std::sqrt(unit(random)), 2 * kPi * unit(random));
    if (measurement.samples.size() % 2 == 0)
      wo = Reflect(wi, FromSpherical(0.4 * unit(random), 2 * kPi * unit(random)));
    if (wo.z < 0.18) continue;
    reflectance.Evaluate(wi, wo, f_r.data());
    for (double& f : f_r) f *= 1 + normal(random);
    measurement.samples.Append(wi, wo, f_r.data(), 0);
  }
  return measurement;
}

// The model for any scalar, in the solver's slope coordinates; u = 5 shape, f0 a channel, albedo a channel.
struct SampleCost {
  Vec3 wi, wo;
  double target[3];
  bool round;

  template <class T>
  bool operator()(const T* u, T* residual) const {
    const int shapes = round ? 1 : 5;
    T v[5] = {T(0), T(0), u[0], T(0), u[0]};
    if (!round) std::copy(u, u + 5, v);
    const auto constant = [](const Vec3& w) { return Vec3T<T>{T(w.x), T(w.y), T(w.z)}; };
    const Vec3 wh = Normalized(wi + wo);
    T gi = T(wi.z) / SlopeSigmaFormula(v, constant(wi)), go = T(wo.z) / SlopeSigmaFormula(v, constant(wo));
    if (gi > 1.0) gi = T(1);
    if (go > 1.0) go = T(1);
    const T specular = SlopeDFormula(v, constant(wh)) * gi * go / T(4 * wi.z * wo.z);
    const double p5 = std::pow(1 - Dot(wi, wh), 5);
    for (int c = 0; c < 3; ++c) {
      const T f = u[shapes + 3 + c] * kInvPi + specular * (u[shapes + c] * (1 - p5) + p5);
      using std::log;
      residual[c] = log(1.0 + f * wi.z) - target[c];
    }
    return true;
  }
};

template <int kParameters>
double SolveByAutoDiff(const Samples& samples, bool round, std::vector<double> u, int threads, double* seconds) {
  const double start = Now();
  ceres::Problem problem;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    auto* cost = new SampleCost{samples.wi(i), samples.wo(i), {}, round};
    for (std::size_t c = 0; c < 3; ++c) cost->target[c] = std::log1p(samples.values[c][i] * samples.wi_z[i]);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<SampleCost, 3, kParameters>(cost), nullptr, u.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-10;
  options.num_threads = threads;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  *seconds = Now() - start;
  return summary.final_cost;
}

// The baseline descends once from one start; the search descends from eight, as Fit does, but each on all samples.
void AgainstAutoDiff(std::size_t count) {
  fmt::print(
      "\n| {} samples x RGB, `log` | AutoDiffCostFunction a sample | streamed, same start | ratio | costs differ by "
      "|\n",
      count);
  fmt::print("|---|---|---|---|---|\n");
  const int threads = HardwareThreads();
  std::string whole;
  for (const Ndf ndf : {Ndf::kGgx, Ndf::kEllipsoid}) {
    Measurement measurement = Random(OneLobeTruth(ndf), count, 3, 1);
    Recipe recipe = DefaultRecipe(OneLobeTruth(ndf).model, "bench");
    recipe.metric = Metric::kLog;
    SetAsideForRecipe(recipe, &measurement);
    const Layout layout(recipe, measurement.channels.names);
    constexpr double kAlphas[] = {0.3, 0.02, 0.05, 0.1, 0.15, 0.25, 0.45, 0.7};
    double all_slow = 0, one_slow = 0, expected = 0;
    for (const double alpha : kAlphas) {
      std::vector<double> start = layout.FromShapes({{alpha, IsRound(ndf) ? alpha : 0.7 * alpha, 0, 0, 0}});
      for (std::size_t i = layout.shape_size(); i < start.size(); ++i) start[i] = 0.3;
      double slow = 0;
      const double cost = IsRound(ndf) ? SolveByAutoDiff<7>(measurement.samples, true, start, threads, &slow)
                                       : SolveByAutoDiff<11>(measurement.samples, false, start, threads, &slow);
      all_slow += slow;
      if (alpha != kAlphas[0]) {
        expected = std::min(expected, cost);
        continue;
      }
      one_slow = slow;
      expected = cost;
      const double begin = Now();
      ThreadPool pool(threads);
      const Problem problem(measurement.samples, recipe);
      SolveOptions options;
      options.function_tolerance = 1e-10;
      const Solution solution = Solve(problem, layout, start, options, &pool);
      const double fast = Now() - begin;
      fmt::print("| {} | {:.3f} s | {:.4f} s | {:.0f} | {:.1e} |\n", NameOf(NdfChoices(), ndf), slow, fast, slow / fast,
                 std::fabs(solution.cost - cost) / cost);
    }
    FitOptions options;
    options.threads = threads;
    const double begin = Now();
    const Material material = Fit(recipe, options, &measurement);
    const double seconds = Now() - begin;
    const double solve = material.timings_s.at("solve");
    whole += fmt::format("| {} | {:.3f} s | {:.3f} s | {:.4f} s | {:.0f} | {:.0f} | {:.4f} s | {:.0f} | {:.1e} |\n",
                         NameOf(NdfChoices(), ndf), one_slow, all_slow, solve, one_slow / solve, all_slow / solve,
                         seconds, all_slow / seconds, std::fabs(material.cost - expected) / expected);
    std::fflush(stdout);
  }
  fmt::print(
      "\n| from default starts | AutoDiff, one start | AutoDiff, eight starts | search and descent | ratio to one | "
      "ratio to eight | `Fit`, with errors and tests | ratio to eight | costs differ by "
      "|\n|---|---|---|---|---|---|---|---|---|\n{}",
      whole);
}

// Seconds that the Gauss-Newton matrix and gradient of all samples take: what a descent does at each step. The best of
// several.
double OnePass(const Recipe& recipe, const Measurement& measurement, int threads) {
  const Layout layout(recipe, measurement.channels.names);
  const Problem problem(measurement.samples, recipe);
  ThreadPool pool(threads);
  const std::vector<double> u = layout.FromShapes({{0.3, 0.12, 0.03, -0.05, 0.4}});
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  double seconds = HUGE_VAL;
  for (int run = 0; run < 7; ++run) {
    const double start = Now();
    Linearise(problem, layout, u.data(), &pool, &hessian, &gradient);
    seconds = std::min(seconds, Now() - start);
  }
  return seconds;
}

void Growth(const std::vector<std::size_t>& counts) {
  fmt::print(
      "\n| samples x 1 | whole fit, s | ns a sample | exponent | one pass, ms | ns a sample | exponent | memory beside "
      "the samples, bytes a sample |\n|---|---|---|---|---|---|---|---|\n");
  double last = 0, last_pass = 0;
  std::size_t last_count = 0;
  for (const std::size_t count : counts) {
    Measurement measurement = Random(OneLobeTruth(Ndf::kEllipsoid), count, 1, 2);
    ForgetPeakMemory();
    const double before = PeakMemory();
    FitOptions options;
    options.threads = HardwareThreads();
    // The best of several runs: short fits are at the mercy of the machine.
    const Recipe recipe = DefaultRecipe(OneLobeTruth(Ndf::kEllipsoid).model, "bench");
    double seconds = HUGE_VAL;
    for (int run = 0; run < (count > 1000000 ? 1 : 3); ++run) {
      const double start = Now();
      Fit(recipe, options, &measurement);
      seconds = std::min(seconds, Now() - start);
    }
    const double memory = (PeakMemory() - before) * 1048576 / static_cast<double>(count);
    const double pass = OnePass(recipe, measurement, options.threads);
    const auto exponent = [&](double now, double before_it) {
      return before_it > 0
                 ? std::log(now / before_it) / std::log(static_cast<double>(count) / static_cast<double>(last_count))
                 : NAN;
    };
    const auto nanoseconds = [&](double time) { return 1e9 * time / static_cast<double>(count); };
    fmt::print("| {} | {:.3f} | {:.0f} | {:.2f} | {:.3f} | {:.1f} | {:.2f} | {:.0f} |\n", count, seconds,
               nanoseconds(seconds), exponent(seconds, last), 1e3 * pass, nanoseconds(pass), exponent(pass, last_pass),
               memory);
    std::fflush(stdout);
    last_pass = pass;
    last = seconds;
    last_count = count;
  }
}

// The search for the best minimum of a spectrum.
void Spectra(const std::vector<std::size_t>& counts) {
  fmt::print("\n| 200 samples x channels | coordinates | search, s | exponent |\n|---|---|---|---|\n");
  double last = 0;
  std::size_t last_count = 0;
  for (const std::size_t count : counts) {
    Truth truth = OneLobeTruth(Ndf::kEllipsoid);
    for (std::vector<double>& v : truth.values) {
      if (v.size() > 1) v.resize(count, v[0]);
    }
    const Measurement measurement = Random(truth, 200, count, 6);
    const Recipe recipe = DefaultRecipe(truth.model, "bench");
    const Layout layout(recipe, measurement.channels.names);
    const Problem problem(measurement.samples, recipe);
    ThreadPool pool(HardwareThreads());
    const double start = Now();
    FindMinima(problem, layout, measurement.samples, {}, &pool);
    const double seconds = Now() - start;
    const double exponent =
        last > 0 ? std::log(seconds / last) / std::log(static_cast<double>(count) / static_cast<double>(last_count))
                 : NAN;
    fmt::print("| {} | {} | {:.2f} | {:.2f} |\n", count, layout.size(), seconds, exponent);
    std::fflush(stdout);
    last = seconds;
    last_count = count;
  }
}

void TwoLobes(std::size_t count) {
  Measurement measurement = Random(TwoLobeTruth(), count, 3, 3);
  FitOptions options;
  options.threads = HardwareThreads();
  const double start = Now();
  const Material material = Fit(DefaultRecipe(TwoLobeTruth().model, "bench"), options, &measurement);
  fmt::print(
      "\nTwo lobes and a diffuse part on {} samples x RGB: {:.2f} s; alphas {:.4f} and {:.4f} (truth 0.04, 0.35)\n",
      count, Now() - start, material.parameters[0].values[0], material.parameters[6].values[0]);
}

void SmallFits(std::size_t problems) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Measurement> measurements;
  std::vector<const Samples*> samples;
  for (std::size_t k = 0; k < problems; ++k) {
    Truth truth = OneLobeTruth(Ndf::kEllipsoid);
    truth.values[0] = {0.1 + 0.4 * unit(random)};
    truth.values[1] = {truth.values[0][0] * (0.3 + 0.7 * unit(random))};
    truth.values[4] = {3 * unit(random) - 1.5};
    measurements.push_back(Random(truth, 200, 1, 100 + k));
  }
  for (const Measurement& measurement : measurements) samples.push_back(&measurement.samples);
  const Recipe recipe = DefaultRecipe(OneLobeTruth(Ndf::kEllipsoid).model, "bench");
  FitManyOptions options;
  options.threads = HardwareThreads();
  double seconds = HUGE_VAL;
  std::vector<SmallFit> fits;
  for (int run = 0; run < 3; ++run) {
    const double start = Now();
    fits = FitMany(recipe, samples, options);
    seconds = std::min(seconds, Now() - start);
  }
  // Against the full search, on some of them.
  std::size_t same = 0, checked = std::min<std::size_t>(problems, 200);
  double iterations = 0;
  const double start = Now();
  for (std::size_t k = 0; k < checked; ++k) {
    FitOptions alone;
    alone.threads = HardwareThreads();
    same += fits[k].cost <= Fit(recipe, alone, &measurements[k]).cost * 1.000001 ? 1 : 0;
  }
  const double whole = (Now() - start) / static_cast<double>(checked);
  for (const SmallFit& fit : fits) iterations += fit.iterations;
  fmt::print(
      "\n{} fits of 200 samples, 5 + 2 parameters: {:.0f} a second with {} threads ({:.1f} steps each); {} of {} reach "
      "the "
      "cost of the full search, which does {:.0f} a second\n",
      problems, static_cast<double>(problems) / seconds, options.threads, iterations / static_cast<double>(problems),
      same, checked, 1 / whole);
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres writes of every step of AutoDiff without a finite cost
  std::vector<std::string> parts(argv + 1, argv + argc);
  const bool quick = std::erase(parts, "--quick") > 0;
  const auto wanted = [&](const char* part) {
    return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  // The growth of memory first: what the others leave would hide it.
  if (wanted("growth")) {
    lobefit::Growth(quick ? std::vector<std::size_t>{1000, 2000}
                          : std::vector<std::size_t>{10000, 100000, 1000000, 10000000});
  }
  if (wanted("channels")) {
    lobefit::Spectra(quick ? std::vector<std::size_t>{40, 80} : std::vector<std::size_t>{100, 200, 400, 800});
  }
  if (wanted("autodiff")) lobefit::AgainstAutoDiff(quick ? 2000 : 1458000);
  if (wanted("small")) lobefit::SmallFits(quick ? 50 : 10000);
  if (wanted("two-lobes")) lobefit::TwoLobes(quick ? 5000 : 900000);
  return 0;
}
