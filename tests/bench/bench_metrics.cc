// Which metric and weighting give fits that look right: fits each MERL table with every metric and weighting, renders
// spheres of fit and table under a point light and under a sky, and prints one table in Markdown.
//   bench_metrics NDF LOBES FILE.binary...
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/bench/look.h"
#include <fmt/format.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/fit.h"
#include "lobefit/io/read.h"
#include "lobefit/report/figures/isotropic_lookup.h"

namespace lobefit {
namespace {

struct Errors {
  double psnr_light = 0, psnr_sky = 0, color_light = 0, color_sky = 0, seconds = 0;
  int unreliable = 0;
};

Recipe RecipeOf(Ndf ndf, std::size_t lobes, Metric metric, Weighting weighting) {
  Recipe recipe = DefaultRecipe({std::vector<Lobe>(lobes, Lobe{ndf}), Diffuse::kLambert}, "study");
  recipe.metric = metric;
  recipe.weighting = weighting;
  return recipe;
}

void Run(Ndf ndf, std::size_t lobes, const std::vector<std::string>& files) {
  const std::size_t metrics = MetricChoices().size(), weightings = WeightingChoices().size();
  std::vector<std::vector<Errors>> all(metrics * weightings);
  for (const std::string& file : files) {
    const Measurement table = ReadMeasurement(file, {});
    const IsotropicLookup lookup(table);
    const ChannelColor to_color(table.channels);
    Look reference;
    for (std::size_t k = 0; k < all.size(); ++k) {
      Measurement measurement = table;
      FitOptions options;
      options.threads = HardwareThreads();
      const auto start = std::chrono::steady_clock::now();
      const Material material =
          Fit(RecipeOf(ndf, lobes, MetricChoices()[k / weightings].value, WeightingChoices()[k % weightings].value),
              options, &measurement);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const FittedFunction fitted(material);
      const SlopeCoordinates lobe = fitted.lobe_shapes()[0];
      // The directions of the light are those of the first fit, so that all fits are compared on the same picture.
      static SlopeCoordinates first;
      if (k == 0) {
        first = lobe;
        reference = Render(Shown(lookup, 3), first, to_color);
      }
      const Look look = Render(Shown(fitted), first, to_color);
      const auto [psnr_light, color_light] = CompareSpheres(reference.light, look.light);
      const auto [psnr_sky, color_sky] = CompareSpheres(reference.sky, look.sky);
      all[k].push_back({psnr_light, psnr_sky, color_light, color_sky, seconds,
                        material.termination.converged && material.termination.determined ? 0 : 1});
      std::fprintf(stderr, "%s %s %s: %.2f %.2f dB, %.2f %.2f dE, %.2f s\n", file.c_str(),
                   MetricChoices()[k / weightings].name, WeightingChoices()[k % weightings].name, psnr_light, psnr_sky,
                   color_light, color_sky, seconds);
    }
  }
  fmt::print("| metric | weighting | light, dB | sky, dB | worst sky, dB | light, dE | sky, dE | seconds | exit 4 |\n");
  fmt::print("|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < all.size(); ++k) {
    Errors mean;
    double worst = 1e9;
    for (const Errors& e : all[k]) {
      const double n = static_cast<double>(all[k].size());
      mean.psnr_light += e.psnr_light / n;
      mean.psnr_sky += e.psnr_sky / n;
      mean.color_light += e.color_light / n;
      mean.color_sky += e.color_sky / n;
      mean.seconds += e.seconds / n;
      mean.unreliable += e.unreliable;
      worst = std::min(worst, e.psnr_sky);
    }
    fmt::print("| `{}` | {} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:.2f} | {} |\n",
               MetricChoices()[k / weightings].name, WeightingChoices()[k % weightings].name, mean.psnr_light,
               mean.psnr_sky, worst, mean.color_light, mean.color_sky, mean.seconds, mean.unreliable);
  }
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  const lobefit::Choice<lobefit::Ndf>* ndf = argc > 3 ? lobefit::Find(lobefit::NdfChoices(), argv[1]) : nullptr;
  const std::size_t lobes = argc > 3 ? std::strtoul(argv[2], nullptr, 10) : 0;
  if (ndf == nullptr || lobes < 1 || lobes > 3) {
    std::fprintf(stderr, "usage: bench_metrics NDF LOBES FILE.binary...\n");
    return 2;
  }
  lobefit::Run(ndf->value, lobes, {argv + 3, argv + argc});
  return 0;
}
