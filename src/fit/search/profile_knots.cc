#include "lobefit/fit/search/profile_knots.h"

#include <algorithm>
#include <cmath>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/starts.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

bool NeedsKnots(const Lobe& lobe) { return FamilyOf(lobe.ndf) == Family::kProfile && lobe.grid == nullptr; }

// Beyond, densities are 1e-9 of the peak's and less.
constexpr double kLastKnot = 256;

// A recipe for another model with what `recipe` says of parameters of the same name.
Recipe WithModel(const Recipe& recipe, const Model& model) {
  Recipe changed = recipe;
  changed.model = model;
  changed.parameters = DefaultRecipe(model, "").parameters;
  const std::vector<Parameter> before = Parameters(recipe.model), after = Parameters(model);
  for (std::size_t i = 0; i < after.size(); ++i) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (before[k].name == after[i].name) changed.parameters[i] = recipe.parameters[k];
    }
  }
  return changed;
}

Ndf GgxOf(Ndf ndf) {
  if (IsRound(ndf)) return IsTilted(ndf) ? Ndf::kGgxTilted : Ndf::kGgx;
  return IsTilted(ndf) ? Ndf::kEllipsoid : Ndf::kGgxAnisotropic;
}

}  // namespace

double LargestRadius(const Lobe& lobe, const SlopeCoordinates& shape, const Samples& samples) {
  const double a = std::exp(shape.v[2]), c = std::exp(shape.v[4]);
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 wi = samples.wi(i);
    const Vec3 h = (lobe.direction == LobeDirection::kRetro ? Vec3{-wi.x, -wi.y, wi.z} : wi) + samples.wo(i);
    const double y1 = (-h.x / h.z - shape.v[0]) / a, y2 = (-h.y / h.z - shape.v[1] - shape.v[3] * y1) / c;
    largest = std::max(largest, std::hypot(y1, y2));
  }
  return largest;
}

Recipe WithGrids(const Recipe& recipe, const std::vector<std::shared_ptr<const ProfileGrid>>& grids) {
  Model model = recipe.model;
  for (std::size_t l = 0; l < grids.size(); ++l) {
    if (grids[l] != nullptr) model.lobes[l].grid = grids[l];
  }
  return WithModel(recipe, model);
}

std::vector<double> ProfileKnots(double r_max) {
  std::vector<double> knots = r_max < 8 ? std::vector<double>{0, 0.25, 0.5, 0.75, 1, 1.5} : std::vector<double>{0, 1};
  for (double r = 2; r <= std::min(r_max, kLastKnot); r *= 2) knots.push_back(r);
  if (r_max < 1.5) knots.pop_back();
  return knots;
}

Recipe WithKnots(const Recipe& recipe, const Samples& samples, const std::vector<std::string>& channels,
                 const FitOptions& options, ThreadPool* pool) {
  if (std::none_of(recipe.model.lobes.begin(), recipe.model.lobes.end(), NeedsKnots)) return recipe;
  Model ggx = recipe.model;
  for (Lobe& lobe : ggx.lobes) {
    if (NeedsKnots(lobe)) lobe.ndf = GgxOf(lobe.ndf);
  }
  const Recipe first = WithModel(recipe, ggx);
  const Layout layout(first, channels);
  const Samples small = samples.Subset(StratifiedSubsample(samples.size(), options.subsample, options.seed));
  const std::vector<DistinctMinimum> minima = FindMinima(Problem(small, first), layout, small, options, pool);
  if (minima.empty()) return recipe;
  const KernelModel kernel = layout.ToKernel(minima[0].solution.u.data());
  const ParameterValues values = layout.Report(minima[0].solution.u.data());
  std::vector<std::shared_ptr<const ProfileGrid>> grids(recipe.model.lobes.size());
  for (std::size_t l = 0; l < grids.size(); ++l) {
    const Lobe& lobe = recipe.model.lobes[l];
    if (NeedsKnots(lobe))
      grids[l] = GridWithKnots(ProfileKnots(LargestRadius(lobe, kernel.lobes[l].shape.slope, samples)));
  }
  Recipe resolved = WithGrids(recipe, grids);
  for (std::size_t l = 0; l < grids.size(); ++l) {
    if (grids[l] == nullptr) continue;
    const std::size_t from = FirstParameter(ggx, l), to = FirstParameter(resolved.model, l);
    for (std::size_t i = 0; i < kEllipseParameters; ++i) {
      ParameterRecipe& entry = resolved.parameters[to + i];
      if (entry.fixed.empty() && entry.start.empty()) entry.start = values[from + i];
    }
  }
  return resolved;
}

}  // namespace lobefit
