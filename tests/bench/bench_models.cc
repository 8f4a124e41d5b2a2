// What the richer models cost, as ratios of one run: a pass of value, gradient and Gram matrix of each kind against one
// GGX lobe's, of a lobe through an instrument's discs against the same lobe at a point, the masking table of a profile
// made in two ways, and a descent of a free profile with a free Fresnel curve against one AutoDiffCostFunction a sample
// with the same model. Tables in Markdown. Exit code 1 where a pass through one disc takes more than 6 times the time
// of a pass without, through both discs 25 times.
//   bench_models [--quick] [passes|apertures|tables|autodiff]...
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/radial/profile_masking.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"
#include "lobefit/synthesis/synthesis.h"
#include "lobefit/validate/truth.h"

namespace lobefit {
namespace {

double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// Processor time of this thread, s: what other processes of the machine take does not count.
double ProcessorTime() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Three channels; parameters that a model has beside its ellipses start where the table says, or at `rest`.
Truth TruthLike(const Model& model, double rest) {
  Truth truth = {model, {}, {"R", "G", "B"}};
  for (const Parameter& parameter : Parameters(model)) {
    const bool alpha = parameter.name.ends_with("alpha_x") || parameter.name.ends_with("alpha_y");
    const bool linear = parameter.per_channel && parameter.free && !parameter.shared;
    const double value = alpha ? (parameter.name.starts_with("lobe2") ? 0.08 : 0.25) : linear ? rest : parameter.start;
    truth.values.emplace_back(parameter.per_channel ? 3 : 1, value);
  }
  return truth;
}

Measurement Synthetic(const Truth& truth, double step_deg) {
  GoniometerLayout layout;
  for (double theta = 5; theta < 76; theta += 5) layout.polar_angles.push_back(DegreesToRadians(theta));
  layout.azimuths = {0, 1, 2};
  layout.detector_step = DegreesToRadians(step_deg);
  Measurement measurement = Synthesise(Goniometer(layout), {truth.channels, {}}, BrdfOf(truth), {0.05, 0}, 1);
  measurement.source = "synthetic";
  return measurement;
}

// A pass over a measurement on one thread.
class Pass {
 public:
  Pass(const Recipe& recipe, const Measurement& measurement, const Ellipsoid& shape)
      : layout_(recipe, measurement.channels.names),
        problem_(measurement.samples, recipe),
        u_(layout_.FromShapes(std::vector<Ellipsoid>(recipe.model.lobes.size(), shape))) {
    for (std::size_t i = layout_.shape_size(); i < u_.size(); ++i) u_[i] = std::max(u_[i], 0.2);
  }
  void Run() {
    const double start = ProcessorTime();
    Linearise(problem_, layout_, u_.data(), &pool_, &hessian_, &gradient_);
    seconds_ = std::min(seconds_, ProcessorTime() - start);
  }
  double seconds() const { return seconds_; }  // of the quickest so far
  std::size_t columns() const { return layout_.CoordinatesOfColumns(0).size() + 1; }

 private:
  Layout layout_;
  Problem problem_;
  std::vector<double> u_;
  ThreadPool pool_{1};
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;
  double seconds_ = HUGE_VAL;
};
constexpr int kRuns = 9;

Recipe LogRecipe(const Model& model, const char* name) {
  Recipe recipe = DefaultRecipe(model, name);
  recipe.metric = Metric::kLog;
  return recipe;
}

void Passes(double step_deg) {
  const Lobe ggx = {Ndf::kGgx}, ellipsoid = {Ndf::kEllipsoid};
  const auto with = [](Lobe lobe, Fresnel fresnel) {
    lobe.fresnel = fresnel;
    return lobe;
  };
  Lobe retro = with(ggx, Fresnel::kNone);
  retro.direction = LobeDirection::kRetro;
  Lobe profile = with({Ndf::kProfile}, Fresnel::kCurve);
  profile.grid = GridWithKnots({0, 1, 2, 4, 8});
  const struct {
    const char* name;
    Model model;
  } cases[] = {
      {"ggx", {{ggx}, Diffuse::kLambert}},
      {"ellipsoid", {{ellipsoid}, Diffuse::kLambert}},
      {"ellipsoid, curve", {{with(ellipsoid, Fresnel::kCurve)}, Diffuse::kLambert}},
      {"student", {{{Ndf::kStudent}}, Diffuse::kLambert}},
      {"profile", {{{Ndf::kProfile}}, Diffuse::kLambert}},
      {"profile, curve", {{with({Ndf::kProfile}, Fresnel::kCurve)}, Diffuse::kLambert}},
      {"profile of 5 knots, curve", {{profile}, Diffuse::kLambert}},
      {"ggx, f82", {{with(ggx, Fresnel::kSchlickF82)}, Diffuse::kLambert}},
      {"ggx, interfaced", {{ggx}, Diffuse::kInterfaced}},
      {"ggx, oren-nayar", {{ggx}, Diffuse::kOrenNayar}},
      {"ggx + retro", {{ggx, retro}, Diffuse::kLambert}},
      {"ellipsoid + coat", {{ellipsoid, with(ggx, Fresnel::kCoatLayered)}, Diffuse::kLambert}},
      {"ellipsoid + refracting coat", {{ellipsoid, with(ggx, Fresnel::kCoatRefracted)}, Diffuse::kLambert}},
  };
  const Measurement measurement = Synthetic(TruthLike(cases[1].model, 0.3), step_deg);
  const auto count = static_cast<double>(measurement.samples.size());
  fmt::print(
      "| one pass on {} samples x RGB, one thread | ns a sample | over ggx | over ellipsoid | columns | over GGX with "
      "as "
      "many |\n",
      measurement.samples.size());
  fmt::print("|---|---|---|---|---|---|\n");
  double first = 0, second = 0;
  std::map<std::size_t, double> of_ggx;  // by columns, of one GGX lobe
  for (const auto& c : cases) {
    Pass pass(LogRecipe(c.model, c.name), measurement, {0.25, 0.2, 0, 0, 0.3});
    for (int run = 0; run < kRuns; ++run) pass.Run();
    if (first == 0) {
      first = pass.seconds();
    } else if (second == 0) {
      second = pass.seconds();
    }
    const Lobe& lobe = c.model.lobes[0];
    const bool is_ggx = c.model.lobes.size() == 1 && c.model.diffuse == Diffuse::kLambert &&
                        FamilyOf(lobe.ndf) == Family::kGgx && lobe.fresnel != Fresnel::kSchlickF82;
    const auto as_many =
        is_ggx ? of_ggx.try_emplace(pass.columns(), pass.seconds()).first : of_ggx.find(pass.columns());
    fmt::print("| {} | {:.0f} | {:.1f} | {:.1f} | {} | {} |\n", c.name, 1e9 * pass.seconds() / count,
               pass.seconds() / first, second > 0 ? pass.seconds() / second : NAN, pass.columns(),
               as_many == of_ggx.end() ? "" : fmt::format("{:.1f}", pass.seconds() / as_many->second));
    std::fflush(stdout);
  }
}

// Through the discs of an instrument and at a point, in turns. Whether no ratio is above what it may be.
bool Apertures(double step_deg) {
  const Model ggx = {{{Ndf::kGgx}}, Diffuse::kLambert}, ellipsoid = {{{Ndf::kEllipsoid}}, Diffuse::kLambert};
  const struct {
    const char *name, *discs;
    const Model& model;
    double alpha, source, detector, most;
  } cases[] = {
      {"ggx, alpha 0.25", "1.5", ggx, 0.25, 0, 1.5, 6},
      {"ellipsoid, alpha 0.25", "1.5", ellipsoid, 0.25, 0, 1.5, 6},
      {"ggx, alpha 0.25", "1 and 1.5", ggx, 0.25, 1, 1.5, 25},
      {"ellipsoid, alpha 0.25", "1 and 1.5", ellipsoid, 0.25, 1, 1.5, 25},
      {"ellipsoid, alpha 0.01", "1.5", ellipsoid, 0.01, 0, 1.5, 6},
      {"ellipsoid, alpha 0.01", "1 and 1.5", ellipsoid, 0.01, 1, 1.5, 25},
  };
  const Measurement measurement = Synthetic(TruthLike(ellipsoid, 0.3), step_deg);
  fmt::print(
      "\n| one pass on {} samples x RGB, one thread | discs, half angles in degrees | ns a sample at a point | "
      "through the discs | ratio | at most |\n|---|---|---|---|---|---|\n",
      measurement.samples.size());
  bool kept = true;
  for (const auto& c : cases) {
    Recipe recipe = LogRecipe(c.model, c.name);
    const Ellipsoid shape = {c.alpha, 0.8 * c.alpha, 0, 0, 0.3};
    Pass point(recipe, measurement, shape);
    recipe.instrument.source = DegreesToRadians(c.source);
    recipe.instrument.detector = DegreesToRadians(c.detector);
    // As a fit does where the lobe is narrower than the smaller disc.
    if (c.alpha < DegreesToRadians(c.source)) recipe.instrument.finest_width = 0.8 * shape.alpha_y;
    Pass discs(recipe, measurement, shape);
    for (int run = 0; run < kRuns; ++run) {
      point.Run();
      discs.Run();
    }
    const double ratio = discs.seconds() / point.seconds(),
                 each = 1e9 / static_cast<double>(measurement.samples.size());
    fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.1f} | {} |\n", c.name, c.discs, each * point.seconds(),
               each * discs.seconds(), ratio, c.most);
    std::fflush(stdout);
    kept = kept && ratio <= c.most;
  }
  return kept;
}

constexpr int kQ = 4, kParameters = 1 + kQ + 3 * kFresnelCurveSize + 3;

// An isotropic profile about the normal with a free curve for any scalar, by quadrature a sample. u: ln alpha, q, the
// curve's coefficients channel by channel, albedos.
struct ProfileCost {
  Vec3 wi, wo;
  double target[3];
  const ProfileSpline* spline;
  const QuadratureRule* rule;  // on (-1, 1)

  template <class T>
  T Density(const T& t, const T* q) const {
    const T u = log(1.0 + t);
    const std::size_t interval = spline->Interval(Scalar(u));
    const double* c = spline->Coefficients(interval);
    const T x = u - spline->Left(interval);
    T exponent = -2.0 * u;
    for (std::size_t k = 0; k < kQ; ++k)
      exponent += q[k] * (c[k] + x * (c[kQ + k] + x * (c[2 * kQ + k] + x * c[3 * kQ + k])));
    return exp(exponent);
  }
  static double Scalar(double x) { return x; }
  template <int N>
  static double Scalar(const ceres::Jet<double, N>& x) {
    return x.a;
  }
  // Integral of f over s in (0, infinity).
  template <class T, class Function>
  T Integral(const T& scale, const Function& f) const {
    T sum(0);
    for (std::size_t i = 0; i < rule->nodes.size(); ++i) {
      const double y = 0.5 * (1 + rule->nodes[i]);
      sum += 0.5 * rule->weights[i] / ((1 - y) * (1 - y)) * scale * f(scale * (y / (1 - y)));
    }
    return sum;
  }
  template <class T>
  bool operator()(const T* u, T* residual) const {
    const T alpha = exp(u[0]);
    const T* q = u + 1;
    const Vec3 wh = Normalized(wi + wo);
    const T mass = 2.0 * Integral(T(1), [&](const T& r) { return r * Density(T(r * r), q); });
    const T D =
        Density(T((1 / (wh.z * wh.z) - 1) / (alpha * alpha)), q) / (kPi * mass * alpha * alpha * std::pow(wh.z, 4));
    const auto masked = [&](double cosine) {
      const T width = alpha * std::sqrt(std::max(1e-8, 1 - cosine * cosine)), a = cosine / width;
      const T m = 2.0 / (kPi * mass) * Integral(T(1.0 + a), [&](const T& s) {
                    return Density(T(a * a + s * s), q) * s * (s - a * atan2(s, a));
                  });
      return width * (a + m);  // max with the cosine: a centred lobe's is above it
    };
    const T specular = D / (4.0 * masked(wi.z) * masked(wo.z));
    double basis[kFresnelCurveSize];
    FresnelCurveBasis(Dot(wi, wh), basis);
    for (int c = 0; c < 3; ++c) {
      T fresnel(0);
      for (std::size_t k = 0; k < kFresnelCurveSize; ++k)
        fresnel += basis[k] * u[1 + kQ + static_cast<std::size_t>(c) * kFresnelCurveSize + k];
      const T f = u[kParameters - 3 + c] * kInvPi + specular * fresnel;
      residual[c] = log(1.0 + f * wi.z) - target[c];
    }
    return true;
  }
};

void AgainstAutoDiff(double step_deg) {
  Lobe lobe = {Ndf::kProfile, Masking::kSmithSeparable, Fresnel::kCurve};
  lobe.grid = GridWithKnots({0, 1, 2, 4, 8});
  const Model model = {{lobe}, Diffuse::kLambert};
  Truth truth = TruthLike(model, 0.3);
  truth.values[5] = {0.6};
  truth.values[6] = {-0.4};
  Measurement measurement = Synthetic(truth, step_deg);
  Recipe recipe = DefaultRecipe(model, "bench");
  recipe.metric = Metric::kLog;
  const Layout layout(recipe, measurement.channels.names);
  std::vector<double> start = layout.FromShapes({{0.4, 0.4, 0, 0, 0}});
  for (std::size_t i = layout.shape_size(); i < start.size(); ++i) start[i] = 0.2;
  const Samples& samples = measurement.samples;
  const int threads = HardwareThreads();

  // Coordinates of both are alpha, q, then channel by channel the curve and the albedo; the baseline has albedos last.
  std::vector<double> u(kParameters, 0.2);
  std::copy_n(start.begin(), 1 + kQ, u.begin());
  const QuadratureRule rule = GaussLegendre(48);
  double begin = Now();
  ceres::Problem problem;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    auto* cost = new ProfileCost{samples.wi(i), samples.wo(i), {}, lobe.grid->spline().get(), &rule};
    for (std::size_t c = 0; c < 3; ++c) cost->target[c] = std::log1p(samples.values[c][i] * samples.wi_z[i]);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ProfileCost, 3, kParameters>(cost), nullptr, u.data());
  }
  for (int k = 1 + kQ; k < kParameters; ++k) {
    problem.SetParameterLowerBound(u.data(), k, 0);
    problem.SetParameterUpperBound(u.data(), k, 1);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-8;
  options.num_threads = threads;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const double slow = Now() - begin;

  begin = Now();
  ThreadPool pool(threads);
  const Problem streamed(samples, recipe);
  SolveOptions solve;
  solve.function_tolerance = 1e-8;
  const Solution solution = Solve(streamed, layout, start, solve, &pool);
  const double fast = Now() - begin;
  KernelModel kernel = layout.ToKernel(solution.u.data());
  kernel.prior.clear();  // the baseline has none
  const double cost = streamed.Sum(kernel, false, &pool).sum_rho / 2;
  fmt::print(
      "\n| {} samples x RGB, profile and curve | AutoDiffCostFunction a sample | steps | streamed, same start | steps "
      "| "
      "ratio | ratio a step | cost over the baseline's |\n|---|---|---|---|---|---|---|---|\n",
      samples.size());
  const double slow_step = slow / static_cast<double>(summary.iterations.size()),
               fast_step = fast / std::max(1, solution.iterations);
  fmt::print("| 1 | {:.2f} s | {} | {:.4f} s | {} | {:.0f} | {:.0f} | {:.6f} |\n", slow, summary.iterations.size(),
             fast, solution.iterations, slow / fast, slow_step / fast_step, cost / summary.final_cost);
}

// The masking table of a profile, which every step of a descent makes anew, against the sums over quadrature points
// from which its nodes come where the matrix does not resolve the profile.
void Tables(int rounds) {
  const auto spline = std::make_shared<const ProfileSpline>(std::vector<double>{0, 1, 2, 4, 8, 16, 32});
  const auto grid = std::make_shared<const ProfileGrid>(spline);
  const auto microseconds = [&](const std::vector<double>& q) {
    const Profile profile(spline, q);
    double least = 1e9;
    for (int round = 0; round < rounds; ++round) {
      const double begin = ProcessorTime();
      const ProfileMasking masking(grid, profile);
      least = std::min(least, 1e6 * (ProcessorTime() - begin));
    }
    return least;
  };
  const double by_matrix = microseconds({0.4, -0.3, 0.2, 0.5, -0.4, 0.3}),
               by_points = microseconds({-30, 20, 1, 0, 0, 0});
  fmt::print("\n| masking table of a profile | by the sums over points | by the matrix | ratio |\n|---|---|---|---|\n");
  fmt::print("| 6 coefficients | {:.0f} us | {:.0f} us | {:.1f} |\n", by_points, by_matrix, by_points / by_matrix);
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  FLAGS_minloglevel = google::GLOG_FATAL;
  std::vector<std::string> parts(argv + 1, argv + argc);
  const bool quick = std::erase(parts, "--quick") > 0;
  const auto wanted = [&](const char* part) {
    return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
  };
  if (wanted("passes")) lobefit::Passes(quick ? 20 : 2);
  const bool kept = !wanted("apertures") || lobefit::Apertures(quick ? 20 : 2);
  if (wanted("tables")) lobefit::Tables(quick ? 5 : 500);
  if (wanted("autodiff")) lobefit::AgainstAutoDiff(quick ? 40 : 10);
  return kept || quick ? 0 : 1;
}
