#include "lobefit/export/refit.h"

#include "lobefit/fit/fit.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {
namespace {

bool IsSame(const Model& a, const Model& b) {
  if (a.diffuse != b.diffuse || a.lobes.size() != b.lobes.size()) return false;
  for (std::size_t l = 0; l < a.lobes.size(); ++l) {
    if (a.lobes[l].ndf != b.lobes[l].ndf || a.lobes[l].masking != b.lobes[l].masking ||
        a.lobes[l].fresnel != b.lobes[l].fresnel) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::optional<FittedBrdf> Refit(const FittedBrdf& fit, const Model& model, const ErrorMeter& meter, int threads) {
  if (IsSame(model, fit.material().model)) return std::nullopt;
  Recipe recipe = DefaultRecipe(model, "target");
  // Of all metrics this one gave the least sum of median and 90 % level of the relative error, over lobes of width 0.3,
  // 0.6 and 0.9 and three targets: the relative metric itself follows the dim tails, the logarithm the peaks.
  recipe.metric = Metric::kCubeRoot;
  FitOptions options;
  options.threads = threads;
  Measurement measurement = meter.measurement();
  Material material = Fit(recipe, options, &measurement);
  if (!material.termination.converged) return std::nullopt;
  return FittedBrdf(std::move(material));
}

}  // namespace lobefit
