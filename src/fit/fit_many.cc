#include "lobefit/fit/fit_many.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/core/brdf/lobe.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/fit/search/starts.h"

namespace lobefit {
namespace {

constexpr double kAlphas[] = {0.01, 0.02, 0.035, 0.06, 0.1, 0.17, 0.28, 0.45, 0.7};

// Amplitude and albedo of each channel, best in the linearised metric and within their bounds, for one shape; and the
// sum of squares left.
struct LinearFit {
  double square = 0;
  std::vector<double> amplitude, diffuse;
};

LinearFit SolveForShape(const Samples& samples, const Layout& layout, const std::vector<double>& weight,
                        const SlopeCoordinates& shape, std::vector<double>* specular, std::vector<double>* cos_d) {
  const Lobe& lobe = layout.recipe().model.lobes[0];
  const std::size_t count = samples.size();
  const DirectionArrays directions = {samples.wi_x.data(),
                                      samples.wi_y.data(),
                                      samples.wi_z.data(),
                                      samples.wo_x.data(),
                                      samples.wo_y.data(),
                                      samples.wo_z.data(),
                                      count};
  SpecularLobe(directions, lobe, shape, specular->data(), cos_d->data(), nullptr);
  const bool schlick = lobe.fresnel == Fresnel::kSchlick, lambert = layout.recipe().model.diffuse == Diffuse::kLambert;
  LinearFit fit;
  for (const std::vector<double>& values : samples.values) {
    // f = offset + amplitude * slope + diffuse / pi.
    double aa = 0, ad = 0, dd = 0, ar = 0, dr = 0, rr = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double x = 1 - (*cos_d)[i], p5 = schlick ? x * x * x * x * x : 0.0;
      const double slope = (*specular)[i] * (1 - p5), rest = values[i] - (*specular)[i] * p5, w = weight[i];
      aa += w * slope * slope;
      ad += w * slope;
      dd += w;
      ar += w * slope * rest;
      dr += w * rest;
      rr += w * rest * rest;
    }
    ad *= kInvPi, dd *= kInvPi * kInvPi, dr *= kInvPi;
    const double high = schlick ? 1.0 : std::numeric_limits<double>::max();
    const double determinant = aa * dd - ad * ad;
    double a = ar / aa, d = 0;
    if (lambert && determinant > 1e-12 * aa * dd) {
      a = (dd * ar - ad * dr) / determinant;
      d = std::clamp((aa * dr - ad * ar) / determinant, 0.0, 1.0);
      // The other one again, where a bound was met.
      a = (ar - ad * d) / aa;
      if (a < 0 || a > high) d = std::clamp((dr - ad * std::clamp(a, 0.0, high)) / dd, 0.0, 1.0);
    }
    a = std::isfinite(a) ? std::clamp(a, 0.0, high) : 0.0;
    fit.amplitude.push_back(a);
    fit.diffuse.push_back(d);
    fit.square += rr - 2 * (a * ar + d * dr) + a * a * aa + 2 * a * d * ad + d * d * dd;
  }
  return fit;
}

std::vector<double> BestStart(const Samples& samples, const Layout& layout) {
  const Recipe& recipe = layout.recipe();
  const Ndf ndf = recipe.model.lobes[0].ndf;
  std::vector<double> weight = LinearisedWeights(samples, recipe.metric, recipe.noise);
  // Those are for f cos_theta_i.
  for (std::size_t i = 0; i < weight.size(); ++i) weight[i] *= samples.wi_z[i] * samples.wi_z[i];
  std::vector<Ellipsoid> axes = {{1, 1, 0, 0, IsInPlane(ndf) ? -recipe.plane_azimuth : 0.0}};
  if (IsTilted(ndf)) axes.push_back(PeakAxis(samples, ndf, recipe.plane_azimuth));
  std::vector<double> best, specular(samples.size()), cos_d(samples.size());
  LinearFit best_fit;
  for (const Ellipsoid& axis : axes) {
    for (const double alpha : kAlphas) {
      Ellipsoid shape = axis;
      shape.alpha_x = shape.alpha_y = alpha;
      const LinearFit fit =
          SolveForShape(samples, layout, weight, SlopeCoordinatesFromEllipsoid(shape), &specular, &cos_d);
      if (!std::isfinite(fit.square) || (!best.empty() && fit.square >= best_fit.square)) continue;
      best_fit = fit;
      best = layout.FromShapes({shape});
    }
  }
  for (std::size_t c = 0; c < layout.channels() && !best.empty(); ++c) {
    const std::vector<Layout::Linear>& linear = layout.linear(c);
    const double found[] = {best_fit.amplitude[c], best_fit.diffuse[c]};
    for (std::size_t k = 0; k < linear.size(); ++k) {
      if (linear[k].index >= 0) best[static_cast<std::size_t>(linear[k].index)] = found[k];
    }
  }
  return best;
}

SmallFit DescendFrom(const Layout& layout, const std::vector<double>& start, const FitManyOptions& options,
                     Problem* problem) {
  ThreadPool alone(1);
  const SolveOptions solve = {options.max_iterations, options.function_tolerance, false};
  std::vector<DistinctMinimum> minimum(1);
  minimum[0].solution = Solve(*problem, layout, start, solve, &alone);
  DescendReweighted(layout, &alone, problem, &minimum);
  if (minimum.empty()) return {layout.Report(start.data())};
  const Solution& solution = minimum[0].solution;
  return {layout.Report(solution.u.data()), solution.cost, solution.converged, solution.iterations};
}

}  // namespace

std::vector<SmallFit> FitMany(const Recipe& recipe, const std::vector<const Samples*>& samples,
                              const FitManyOptions& options) {
  const Model& model = recipe.model;
  const Family family = model.lobes.empty() ? Family::kGgx : FamilyOf(model.lobes[0].ndf);
  const bool linear = model.lobes.size() == 1 &&
                      (model.diffuse == Diffuse::kLambert || model.diffuse == Diffuse::kNone) &&
                      family != Family::kProfile && family != Family::kStudent && family != Family::kAbg &&
                      (model.lobes[0].fresnel == Fresnel::kSchlick || model.lobes[0].fresnel == Fresnel::kNone);
  if (!linear) {
    throw InputError("recipe '" + recipe.name +
                     "': many small fits take one lobe of an ellipse alone (ggx, beckmann and others) with fresnel "
                     "'schlick' or 'none' and a Lambertian part or none; "
                     "fit the measurements one by one instead");
  }
  std::vector<SmallFit> fits(samples.size());
  if (samples.empty()) return fits;
  const Layout layout(recipe, std::vector<std::string>(samples[0]->values.size()));
  ThreadPool pool(std::max(1, options.threads));
  // Several problems a task: one alone takes less time than handing it out.
  constexpr std::size_t kChunk = 16;
  pool.Run((samples.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    for (std::size_t k = chunk * kChunk; k < std::min(samples.size(), (chunk + 1) * kChunk); ++k) {
      if (samples[k]->size() * layout.channels() < layout.size()) continue;
      Problem problem(*samples[k], recipe);
      const std::vector<double> start = BestStart(*samples[k], layout);
      if (!start.empty()) fits[k] = DescendFrom(layout, start, options, &problem);
    }
  });
  return fits;
}

}  // namespace lobefit
