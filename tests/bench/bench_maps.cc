// One fit a texel, measured: normals of a benchmark object or of shaded hills against their truth, and texels a second
// against FitMany and ceres::Solve with AutoDiff, as ratios of one run.
//   bench_maps normals STACK TRUTH [--loss X] [--shadow X] [--share] [--threads N]   TRUTH: CSV column,row,n_x,n_y,n_z
//   bench_maps doubts     how stated error and doubt sort the normals of hills that the model does not hold
//   bench_maps hills      hills with cast shadows, for settings of loss and shadow
//   bench_maps search STACK [STEP]   costs against those of descents from every start, of each STEP-th texel
//   bench_maps speed [--quick]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <mutex>
#include <string>
#include <vector>

#include <ceres/ceres.h>

#include "lobefit/base/files/file.h"
#include "lobefit/base/process/threads.h"
#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/fit/fit_many.h"
#include "lobefit/maps/bands.h"
#include "lobefit/maps/synthetic/hills.h"
#include "lobefit/maps/synthetic/write_stack.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

double Seconds() {
  // Of this process' processor, which others may keep busy as well.
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double Angle(const Vec3& a, const Vec3& b) { return std::atan2(Norm(Cross(a, b)), Dot(a, b)) * 180 / kPi; }

double Mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// Normals of the maps of a stack against the truth; the surest shares by the angle error that the fit states.
int Normals(int argc, char** argv) {
  const Stack stack = OpenStack(argv[2], {});
  MapRecipe recipe;
  int threads = HardwareThreads();
  for (int i = 4; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--share") recipe.shares.over[static_cast<std::size_t>(Shared::kAlpha)] = ShareOver::kImage;
    if (word == "--loss") recipe.rules.loss = std::atof(argv[++i]);
    if (word == "--shadow") recipe.rules.shadow = std::atof(argv[++i]);
    if (word == "--always") recipe.rules.choice = LobeChoice::kAlways;
    if (word == "--lambert") recipe.rules.lobe = MapLobe::kNone;
    if (word == "--threads") threads = std::atoi(argv[++i]);
  }
  recipe.rules.schlick = stack.calibrated;
  std::vector<Vec3> truth(stack.width * stack.height, {0, 0, 0});
  const FileBytes file(argv[3]);
  LineReader lines(file.bytes());
  std::string_view line;
  lines.Next(&line);
  while (lines.Next(&line)) {
    const std::vector<std::string_view> f = Split(line, ',');
    if (f.size() != 5) continue;
    const auto at =
        static_cast<std::size_t>(*ParseInteger(f[1])) * stack.width + static_cast<std::size_t>(*ParseInteger(f[0]));
    truth[at] = {*ParseDouble(f[2]), *ParseDouble(f[3]), *ParseDouble(f[4])};
  }
  const FittedLights lights = LightsWithout(stack, {});
  const double start = Seconds();
  SharedNumbers shared;
  if (recipe.shares.Any()) shared = EstimateShared(stack, recipe, lights, threads);
  std::vector<MapRows> bands;
  std::mutex mutex;
  FitBands(stack, recipe, lights, shared, {{0, stack.height}}, threads, [&](const MapRows& band) {
    const std::lock_guard<std::mutex> lock(mutex);
    bands.push_back(band);
  });
  const double seconds = Seconds() - start;
  const std::vector<MapPlane> planes = PlanesFor(KindOf(recipe, stack));
  const std::size_t error_at = PlaneIndex(planes, MapPart::kErrors, "normal.angle_deg");
  const std::size_t doubt_at = PlaneIndex(planes, MapPart::kQuality, "normal.doubt_deg");
  std::vector<std::pair<double, double>> texels, by_doubt;  // stated error or doubt, true error
  std::size_t undetermined = 0;
  for (const MapRows& band : bands) {
    for (std::size_t t = 0; t < band.rows * band.width; ++t) {
      const Vec3& n = truth[band.first_row * band.width + t];
      if (!(Norm(n) > 0.5)) continue;
      const Vec3 found = {band.values[0][t], band.values[1][t], band.values[2][t]};
      if (std::isnan(found.z)) {
        ++undetermined;
        continue;
      }
      texels.emplace_back(band.values[error_at][t], Angle(found, n));
      by_doubt.emplace_back(band.values[doubt_at][t], Angle(found, n));
    }
  }
  std::printf("texels %zu, not determined %zu, %.1f s\n", texels.size(), undetermined, seconds);
  if (recipe.shares.Any()) std::printf("shared alpha %.4f\n", std::exp(shared.groups[0].held.point.width[0]));
  for (std::vector<std::pair<double, double>>* sorted_by : {&texels, &by_doubt}) {
    std::sort(sorted_by->begin(), sorted_by->end());
    std::printf("by %s\n", sorted_by == &texels ? "stated error" : "doubt");
    for (const int percent : {100, 90, 75, 50}) {
      const std::size_t count = sorted_by->size() * static_cast<std::size_t>(percent) / 100;
      std::vector<double> errors, stated;
      for (std::size_t i = 0; i < count; ++i) {
        errors.push_back((*sorted_by)[i].second), stated.push_back((*sorted_by)[i].first);
      }
      std::vector<double> sorted = errors;
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count / 2), sorted.end());
      std::printf("surest %3d %%: mean error %.3f deg, median %.3f; median stated %.3f\n", percent, Mean(errors),
                  sorted[count / 2], stated[count / 2]);
    }
  }
  return 0;
}

// In how many texels the search ends above the lowest cost of descents from every start.
int Search(const char* path, std::size_t step) {
  const Stack stack = OpenStack(path, {});
  MapRecipe recipe;
  recipe.rules.schlick = stack.calibrated;
  MapRules every = recipe.rules;
  every.every_start = true;
  const FittedLights lights = LightsWithout(stack, {});
  const int channels = static_cast<int>(stack.channels);
  TexelFitter quick(recipe.rules, {lights.directions, {}}, channels), whole(every, {lights.directions, {}}, channels);
  StackReader reader(stack);
  std::vector<float> values(stack.channels * lights.index.size());
  std::size_t texels = 0, above = 0, far_above = 0, other_model = 0, shown = 0;
  double spent[2] = {};
  for (std::size_t y = 0; y < stack.height; ++y) {
    const StackBand band = reader.Read(y, 1);
    for (std::size_t x = y % step; x < stack.width; x += step) {
      if (!stack.Holds(y * stack.width + x)) continue;
      Gather(band, x, stack.channels, lights, stack.lights.size(), values.data());
      MapPoint ends[2];
      double start = Seconds();
      const TexelFit a = quick.Fit(values.data(), lights.index.size(), {}, &ends[0]);
      spent[0] += Seconds() - start, start = Seconds();
      const TexelFit b = whole.Fit(values.data(), lights.index.size(), {}, &ends[1]);
      spent[1] += Seconds() - start;
      if ((a.status & kMapTooFew) != 0) continue;
      ++texels;
      if ((a.status & kMapNoLobe) != (b.status & kMapNoLobe)) ++other_model;
      if (!(a.cost > b.cost * (1 + 1e-6))) continue;
      ++above, far_above += a.cost > 1.01 * b.cost ? 1 : 0;
      if (shown++ % 50 != 0) continue;
      std::printf(
          "  %zu,%zu cost +%.2e, steps %d %d, status %u %u, normals %.2f deg apart, alpha %.4f %.4f, f0 %.3g %.3g\n", x,
          y, a.cost / b.cost - 1, a.iterations, b.iterations, a.status, b.status, Angle(ends[0].normal, ends[1].normal),
          std::exp(ends[0].width[0]), std::exp(ends[1].width[0]), ends[0].f0[0], ends[1].f0[0]);
    }
  }
  const auto percent = [&](std::size_t count) {
    return 100 * static_cast<double>(count) / static_cast<double>(texels);
  };
  std::printf(
      "%zu texels: %.3f %% above by 1e-6, %.3f %% by 1 %%, %.3f %% with the other model; %.1f and %.1f us a texel\n",
      texels, percent(above), percent(far_above), percent(other_model), 1e6 * spent[0] / static_cast<double>(texels),
      1e6 * spent[1] / static_cast<double>(texels));
  return 0;
}

// Mean error of the normals of the half of hills' texels that is surest, over that of all, by the stated error and by
// the doubt, where values are made otherwise than the model has them.
int Doubts() {
  const std::size_t size = 64;
  const std::vector<Vec3> lights = DomeLights(96, 60 * kPi / 180);
  const std::size_t count = lights.size();
  enum Kind { kNoise, kShadows, kTwoWidths, kBetween, kTwoLobes, kAll, kCalibration };
  const char* names[] = {"noise alone",       "cast shadows", "two widths",    "light between slopes",
                         "two lobes a texel", "all of these", "lights 3 % off"};
  std::printf("%-22s %8s %8s %8s\n", "", "all, deg", "error", "doubt");
  double means[2] = {};
  for (const Kind kind : {kNoise, kShadows, kTwoWidths, kBetween, kTwoLobes, kAll, kCalibration}) {
    const auto has = [&](Kind part) { return kind == part || (kind == kAll && part != kCalibration); };
    const Hills hills = MakeHills(size, has(kTwoWidths) ? MapLobe::kGgxAnisotropic : MapLobe::kGgx,
                                  has(kShadows) || has(kBetween) ? 1.6 : 1.2);
    Maps wide = hills.maps;
    for (const char* name : {"alpha", "alpha_x", "alpha_y"}) {
      const std::size_t at = PlaneIndex(wide.planes, MapPart::kParameters, name);
      if (at == wide.planes.size()) continue;
      for (float& alpha : wide.rows.values[at]) alpha = std::min(1.0F, 2.5F * alpha);
    }
    std::vector<Vec3> true_lights = lights;
    std::vector<double> gain(count, 1.0);
    RandomNumbers off(99);
    for (std::size_t l = 0; has(kCalibration) && l < count; ++l) {
      gain[l] = 1 + 0.03 * off.Normal();
      true_lights[l] = Normalized(lights[l] + 0.015 * Vec3{off.Normal(), off.Normal(), off.Normal()});
    }
    Relighting first(hills.maps, {true_lights, {}}, false, {}), second(wide, {true_lights, {}}, false, {});
    TexelFitter fitter({}, {lights, {}}, 3);
    std::vector<std::pair<double, double>> sorted[2];
    std::vector<double> exact(3 * count), other(3 * count);
    std::vector<float> values(3 * count);
    for (std::size_t t = 0; t < size * size; t += 2) {
      first.Texel(t, exact.data(), count), second.Texel(t, other.data(), count);
      const auto plane = [&](std::size_t k) { return static_cast<double>(hills.maps.rows.values[k][t]); };
      const Vec3 n = Normalized(Vec3{plane(0), plane(1), plane(2)});
      // A slope that faces this one sends it a part of its light.
      const Vec3 facing = {-n.x, -n.y, n.z};
      RandomNumbers random(StreamSeed(1, t));
      for (std::size_t i = 0; i < exact.size(); ++i) {
        const std::size_t l = i % count;
        const double diffuse = plane(3 + i / count);
        double v = has(kTwoLobes) ? 0.5 * (exact[i] + other[i]) : exact[i];
        if (has(kBetween)) {
          v += 0.25 * (1 - Dot(n, facing)) * diffuse * diffuse * kInvPi * std::max(0.0, Dot(facing, true_lights[l]));
        }
        if (has(kShadows) && InCastShadow(hills, t, true_lights[l])) v *= 0.1;
        values[i] = static_cast<float>(gain[l] * v * (1 + 0.02 * random.Normal()) + 0.001 * random.Normal());
      }
      const TexelFit fit = fitter.Fit(values.data(), count);
      if (std::isnan(fit.normal.z)) continue;
      sorted[0].emplace_back(fit.normal_angle_error, Angle(fit.normal, n));
      sorted[1].emplace_back(fit.normal_doubt, Angle(fit.normal, n));
    }
    double all = 0, half[2] = {};
    for (std::size_t by = 0; by < 2; ++by) {
      std::sort(sorted[by].begin(), sorted[by].end());
      std::vector<double> errors;
      for (const auto& texel : sorted[by]) errors.push_back(texel.second);
      all = Mean(errors);
      errors.resize(errors.size() / 2);
      half[by] = Mean(errors) / all, means[by] += half[by] / 7;
    }
    std::printf("%-22s %8.3f %8.3f %8.3f\n", names[kind], all, half[0], half[1]);
  }
  std::printf("%-22s %8s %8.3f %8.3f\n", "mean", "", means[0], means[1]);
  return 0;
}

// Mean error of the normals of hills, with and without cast shadows.
int ShadedHills() {
  const std::size_t size = 64;
  const std::vector<Vec3> lights = DomeLights(96, 65 * kPi / 180);
  std::printf("%8s %8s %10s %10s %10s %10s\n", "loss", "shadow", "clean", "shaded", "no lobe", "determined");
  const Hills hills = MakeHills(size, MapLobe::kGgx, 1.6);
  for (const double loss : {0.025, 0.05, 0.1, 0.2}) {
    for (const double shadow : {0.0, 0.05, 0.1, 0.2}) {
      MapRules rules;
      rules.loss = loss, rules.shadow = shadow, rules.schlick = true;
      double mean[2];
      std::size_t no_lobe = 0, determined = 0;
      for (const bool shaded : {false, true}) {
        TexelFitter fitter(rules, {lights, {}}, 3);
        Relighting relighting(hills.maps, {lights, {}}, true, {});
        std::vector<double> errors, exact(3 * lights.size());
        std::vector<float> values(exact.size());
        for (std::size_t t = 0; t < size * size; t += 3) {
          relighting.Texel(t, exact.data(), lights.size());
          RandomNumbers random(StreamSeed(1, t));
          for (std::size_t i = 0; i < exact.size(); ++i) {
            const std::size_t l = i % lights.size();
            // What stands in the shadow still sees other slopes: a tenth of the light.
            const double lit = shaded && InCastShadow(hills, t, lights[l]) ? 0.02 : 1;
            values[i] = static_cast<float>(exact[i] * lit * (1 + 0.02 * random.Normal()) + 0.001 * random.Normal());
          }
          const TexelFit fit = fitter.Fit(values.data(), lights.size());
          const Vec3 truth = {hills.maps.rows.values[0][t], hills.maps.rows.values[1][t], hills.maps.rows.values[2][t]};
          if (!std::isnan(fit.normal.z)) errors.push_back(Angle(fit.normal, truth));
          if (shaded) no_lobe += (fit.status & kMapNoLobe) != 0 ? 1 : 0, determined += std::isnan(fit.alpha_x) ? 0 : 1;
        }
        mean[shaded ? 1 : 0] = Mean(errors);
      }
      std::printf("%8.3f %8.3f %10.4f %10.4f %10zu %10zu\n", loss, shadow, mean[0], mean[1], no_lobe, determined);
    }
  }
  return 0;
}

// The model of engine/model.h as a residual for Jets: unknowns two slopes of the normal, ln alpha, diffuse and f0.
struct TexelResidual {
  Vec3 wi;
  double value[3], scale, loss;
  template <class T>
  bool operator()(const T* u, T* residual) const {
    const Vec3T<T> n = Normalized(Vec3T<T>{-u[0], -u[1], T(1.0)});
    const Vec3T<T> h = {T(wi.x), T(wi.y), T(wi.z + 1)};
    const T ci = n.x * wi.x + n.y * wi.y + n.z * wi.z, co = n.z, alpha = exp(u[2]), a2 = alpha * alpha;
    const T hz = Dot(n, h), square = Dot(h, h);
    const T K = hz * hz + (square - hz * hz) / a2;
    const T si = sqrt(ci * ci + a2 * (1.0 - ci * ci)), so = sqrt(co * co + a2 * (1.0 - co * co));
    const T specular = ci > T(0.0) ? square * square * ci * kInvPi / (a2 * K * K * (ci + si) * (co + so)) : T(0.0);
    const T cosine = ci > T(0.0) ? ci : T(0.0);
    const double k = std::pow(1 - 0.5 * std::sqrt(Dot(wi + Vec3{0, 0, 1}, wi + Vec3{0, 0, 1})), 5);
    for (int c = 0; c < 3; ++c) {
      const T f = u[4 + 2 * c] * (1.0 - k) + k / scale;
      residual[c] = u[3 + 2 * c] * cosine + f * specular - value[c];
    }
    return true;
  }
};

int Speed(bool quick) {
  const std::size_t texels = quick ? 60 : 1500;
  const Hills hills = MakeHills(64, MapLobe::kGgx, 0.6);
  const std::vector<Vec3> lights = DomeLights(96, 60 * kPi / 180);
  MapRules rules;
  rules.schlick = true, rules.choice = LobeChoice::kAlways;
  TexelFitter fitter(rules, {lights, {}}, 3);
  Relighting relighting(hills.maps, {lights, {}}, true, {});
  std::vector<std::vector<float>> values;
  std::vector<double> exact(3 * lights.size());
  std::vector<Samples> samples;
  for (std::size_t k = 0; k < texels; ++k) {
    // Not the columns at the left, which have no lobe.
    const std::size_t t = k * 2 % 4032 / 60 * 64 + k * 2 % 60 + 4;
    relighting.Texel(t, exact.data(), lights.size());
    RandomNumbers random(StreamSeed(1, t));
    std::vector<float> v;
    for (const double e : exact) v.push_back(static_cast<float>(e * (1 + 0.02 * random.Normal())));
    Samples s;
    s.values.resize(3);
    for (std::size_t l = 0; l < lights.size(); ++l) {
      s.wi_x.push_back(lights[l].x), s.wi_y.push_back(lights[l].y), s.wi_z.push_back(lights[l].z);
      s.wo_x.push_back(0), s.wo_y.push_back(0), s.wo_z.push_back(1);
      for (std::size_t c = 0; c < 3; ++c)
        s.values[c].push_back(std::max(1e-6, static_cast<double>(v[c * lights.size() + l]) / lights[l].z));
    }
    values.push_back(v);
    samples.push_back(s);
  }
  double start = Seconds();
  std::vector<TexelFit> fits;
  std::vector<MapPoint> points(texels);
  for (std::size_t k = 0; k < texels; ++k) fits.push_back(fitter.Fit(values[k].data(), lights.size(), {}, &points[k]));
  const double ours = (Seconds() - start) / static_cast<double>(texels);
  double iterations = 0;
  for (const TexelFit& fit : fits) iterations += fit.iterations;
  std::printf("this engine           %8.1f us a texel, errors included; %.1f steps\n", 1e6 * ours,
              iterations / static_cast<double>(texels));

  Model model;
  model.lobes = {Lobe{}};
  const Recipe recipe = DefaultRecipe(model, "bench");
  std::vector<const Samples*> pointers;
  for (const Samples& s : samples) pointers.push_back(&s);
  start = Seconds();
  const std::vector<SmallFit> many = FitMany(recipe, pointers, {});
  const double theirs = (Seconds() - start) / static_cast<double>(texels);
  std::printf("FitMany (ellipsoid)   %8.1f us a texel, ratio %.2f\n", 1e6 * theirs, theirs / ours);

  const std::size_t few = std::min<std::size_t>(texels, 300);
  start = Seconds();
  std::size_t as_low = 0;
  for (std::size_t k = 0; k < few; ++k) {
    const double scale = fits[k].scale;
    double u[9] = {-points[k].normal.x / points[k].normal.z, -points[k].normal.y / points[k].normal.z, std::log(0.2)};
    for (int c = 0; c < 3; ++c) u[3 + 2 * c] = 0.5, u[4 + 2 * c] = 0.3;
    ceres::Problem problem;
    std::vector<double> mean(lights.size());
    for (std::size_t l = 0; l < lights.size(); ++l) {
      auto* residual = new TexelResidual;
      residual->wi = lights[l], residual->scale = scale, residual->loss = rules.loss;
      double sum = 0;
      for (std::size_t c = 0; c < 3; ++c)
        sum += residual->value[c] = static_cast<double>(values[k][c * lights.size() + l]) / scale;
      if (sum / 3 < rules.shadow) {
        delete residual;
        continue;
      }
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<TexelResidual, 3, 9>(residual),
                               new ceres::CauchyLoss(rules.loss), u);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.function_tolerance = 1e-10;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    as_low += fits[k].cost <= summary.final_cost * (1 + 1e-6) ? 1 : 0;
  }
  const double autodiff = (Seconds() - start) / static_cast<double>(few);
  std::printf("ceres::Solve AutoDiff %8.1f us a texel, ratio %.2f; cost as low or lower here in %zu of %zu\n",
              1e6 * autodiff, autodiff / ours, as_low, few);
  return 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "normals" && argc >= 4) return lobefit::Normals(argc, argv);
  if (what == "search" && argc >= 3) {
    return lobefit::Search(argv[2], argc > 3 ? static_cast<std::size_t>(std::max(1, std::atoi(argv[3]))) : 1);
  }
  if (what == "doubts") return lobefit::Doubts();
  if (what == "hills") return lobefit::ShadedHills();
  if (what == "speed") return lobefit::Speed(argc > 2 && std::strcmp(argv[2], "--quick") == 0);
  std::fprintf(stderr, "bench_maps normals STACK TRUTH.csv | search STACK [STEP] | doubts | hills | speed [--quick]\n");
  return 2;
}
