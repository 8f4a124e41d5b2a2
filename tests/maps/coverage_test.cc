#include <map>
#include <string>

#include "tests/maps/texels.h"
#include <gtest/gtest.h>

#include "lobefit/base/process/parallel.h"

namespace lobefit {
namespace {

struct Held {
  std::size_t within = 0, all = 0;
  void Add(double value, double truth, double error) {
    if (!std::isfinite(error)) return;
    ++all;
    within += std::fabs(value - truth) < 1.959964 * error ? 1 : 0;
  }
  double Percent() const { return 100 * static_cast<double>(within) / static_cast<double>(all); }
};

// 95 % intervals of every map, under noise that grows with the value and a floor.
std::map<std::string, Held> CoverageOf(MapLobe lobe, std::size_t size, LobeChoice choice) {
  const Hills hills = MakeHills(size, lobe, 0.7);
  const std::vector<Vec3> lights = DomeLights(96, 60 * kPi / 180);
  const std::size_t pieces = size;
  std::vector<std::map<std::string, Held>> parts(pieces);
  ParallelFor(pieces, HardwareThreads(), [&](std::size_t row) {
    test::TexelValues values(hills.maps, lights, 0.02, 0.002);
    MapRules rules;
    rules.lobe = lobe, rules.schlick = true, rules.choice = choice;
    TexelFitter fitter(rules, {lights, {}}, 3);
    std::map<std::string, Held>& held = parts[row];
    for (std::size_t t = row * size; t < (row + 1) * size; ++t) {
      const auto truth = [&](const char* name) { return test::At(hills.maps, MapPart::kParameters, name, t); };
      const double alpha = truth(lobe == MapLobe::kGgx ? "alpha" : "alpha_x");
      if (std::isnan(alpha)) continue;
      const TexelFit fit = fitter.Fit(values.Of(t, 7).data(), lights.size());
      const Vec3 n = test::NormalAt(hills.maps, t);
      held["normal.x"].Add(fit.normal.x, n.x, fit.normal_error.x);
      held["normal.y"].Add(fit.normal.y, n.y, fit.normal_error.y);
      held["diffuse"].Add(fit.diffuse[0], truth("diffuse.R"), fit.diffuse_error[0]);
      held["f0"].Add(fit.f0[1], truth("f0.G"), fit.f0_error[1]);
      held["alpha_x"].Add(std::log(fit.alpha_x), std::log(alpha), fit.log_alpha_x_error);
      if (lobe == MapLobe::kGgx) continue;
      held["alpha_y"].Add(std::log(fit.alpha_y), std::log(truth("alpha_y")), fit.log_alpha_y_error);
      held["angle"].Add(fit.angle, truth("angle_deg") * kPi / 180, fit.angle_error);
    }
  });
  std::map<std::string, Held> all;
  for (const auto& part : parts) {
    for (const auto& [name, held] : part) all[name].all += held.all, all[name].within += held.within;
  }
  return all;
}

void ExpectCovered(const std::map<std::string, Held>& coverage) {
  for (const auto& [name, held] : coverage) {
    std::printf("  %-10s %6.2f %% of %zu\n", name.c_str(), held.Percent(), held.all);
    EXPECT_GE(held.all, 100000) << name;
    EXPECT_GE(held.Percent(), 93.5) << name;
    EXPECT_LE(held.Percent(), 96.5) << name;
  }
}

TEST(Coverage, OfGgx) { ExpectCovered(CoverageOf(MapLobe::kGgx, 330, LobeChoice::kByEvidence)); }

TEST(Coverage, OfAnisotropicGgx) { ExpectCovered(CoverageOf(MapLobe::kGgxAnisotropic, 330, LobeChoice::kByEvidence)); }

}  // namespace
}  // namespace lobefit
