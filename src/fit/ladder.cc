#include "lobefit/fit/ladder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/compare.h"
#include "lobefit/fit/objective/coordinates.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/search/profile_knots.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/starts.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

constexpr std::size_t kSamples = 4000, kMostFolds = 4;
// Excess in mean square that is not worth a parameter: 1 % in root mean square, as in compare.cc.
constexpr double kWorthNothing = 0.02;

struct Fold {
  Samples training, test;
};

struct Rung {
  Recipe recipe;
  TriedModel tried;
  std::vector<double> mean_square;  // of each fold's test
  double mean() const {
    return std::accumulate(mean_square.begin(), mean_square.end(), 0.0) / static_cast<double>(mean_square.size());
  }
};

class Ladder {
 public:
  Ladder(const Recipe& simplest, const FitOptions& options, const Measurement& measurement)
      : simplest_(simplest),
        options_(options),
        channels_(measurement.channels.names),
        pool_(std::max(1, options.threads)) {
    options_.starts = std::min<std::size_t>(options_.starts, 4);
    const Incidences incidences = GroupByIncidence(measurement);
    const std::size_t folds = std::min(kMostFolds, incidences.wi.size());
    if (folds < 2) return;
    const std::vector<std::size_t> dealt = DealFolds(incidences.wi.size(), folds, options.seed);
    const std::vector<std::size_t> chosen = StratifiedSubsample(measurement.samples.size(), kSamples, options.seed);
    all_ = measurement.samples.Subset(chosen);
    for (std::size_t k = 0; k < folds; ++k) {
      std::vector<std::size_t> training, test;
      for (const std::size_t i : chosen) (dealt[incidences.group[i]] == k ? test : training).push_back(i);
      if (training.empty() || test.empty()) continue;
      folds_.push_back({measurement.samples.Subset(training), measurement.samples.Subset(test)});
    }
  }

  bool CanJudge() const { return folds_.size() >= 2; }

  // Judges the model and keeps it; false where it cannot be fitted.
  bool Try(const Model& model, const std::string& name) {
    if (!WhyNotEvaluable(model).empty()) return false;
    Rung rung;
    rung.recipe = simplest_;
    rung.recipe.model = model;
    rung.recipe.name = name;
    rung.recipe.parameters = DefaultRecipe(model, name).parameters;
    const Recipe wanted = rung.recipe;
    rung.tried.name = name;
    try {
      const Recipe recipe = WithKnots(rung.recipe, all_, channels_, options_, &pool_);
      const Layout layout(recipe, channels_);
      rung.tried.free_parameters = layout.size();
      const std::vector<DistinctMinimum> minima = FindMinima(Problem(all_, recipe), layout, all_, options_, &pool_);
      if (minima.empty()) return false;
      rung.mean_square.assign(folds_.size(), kNan);
      pool_.Run(folds_.size(), [&](std::size_t k) {
        ThreadPool alone(1);
        const Problem training(folds_[k].training, recipe), test(folds_[k].test, recipe);
        SolveOptions finish;
        finish.function_tolerance = 1e-6;
        finish.max_iterations = 60;
        const Solution solution = Solve(training, layout, minima[0].solution.u, finish, &alone);
        std::vector<std::vector<double>> f_r;
        ModelValues(test.kernel_samples(), layout.ToKernel(solution.u.data()), 0, test.size(), &f_r);
        rung.mean_square[k] = SumSquares(recipe.metric, recipe.weighting, true, folds_[k].test, f_r).MeanSquare();
      });
    } catch (const InputError&) {
      return false;  // fewer samples than parameters
    }
    rung.recipe = wanted;  // the whole measurement may reach further knots
    if (!std::isfinite(rung.mean())) return false;
    rungs_.push_back(std::move(rung));
    return true;
  }

  // The rung that predicts best so far.
  const Rung& Best() const {
    return *std::min_element(rungs_.begin(), rungs_.end(),
                             [](const Rung& a, const Rung& b) { return a.mean() < b.mean(); });
  }

  LadderChoice Choose() {
    const Rung& best = Best();
    std::size_t chosen = 0, first = rungs_.size();
    for (std::size_t r = 0; r < rungs_.size(); ++r) {
      Rung& rung = rungs_[r];
      rung.tried.held_out = std::sqrt(rung.mean());
      rung.tried.ratio = std::sqrt(rung.mean() / rungs_[0].mean());
      const double excess = rung.mean() - best.mean();
      double square = 0;
      for (std::size_t k = 0; k < rung.mean_square.size(); ++k)
        square += std::pow(rung.mean_square[k] - best.mean_square[k] - excess, 2);
      const auto n = static_cast<double>(rung.mean_square.size());
      const double error = std::sqrt(square / (n - 1) / n);
      // Never one that predicts worse than the simplest.
      const bool good =
          excess <= std::max(error, kWorthNothing * best.mean()) && rung.mean() <= rungs_[0].mean() * (1 + 1e-9);
      if (!good) continue;
      const bool simpler = first == rungs_.size() || rung.tried.free_parameters < rungs_[chosen].tried.free_parameters;
      if (simpler) chosen = r;
      first = std::min(first, r);
    }
    LadderChoice choice;
    rungs_[chosen].tried.chosen = true;
    for (const Rung& rung : rungs_) choice.tried.push_back(rung.tried);
    choice.recipe = rungs_[chosen].recipe;
    const Rung& rung = rungs_[chosen];
    choice.recipe.reason = fmt::format(
        "of {} models the simplest whose error on held-out incident directions ({:.3g}) is within one standard error "
        "of "
        "the least ({:.3g}, {}); one lobe of the simplest kind: {:.3g}",
        rungs_.size(), rung.tried.held_out, std::sqrt(best.mean()), best.tried.name, std::sqrt(rungs_[0].mean()));
    return choice;
  }

 private:
  Recipe simplest_;
  FitOptions options_;
  std::vector<std::string> channels_;
  ThreadPool pool_;
  Samples all_;
  std::vector<Fold> folds_;
  std::vector<Rung> rungs_;
};

// The lobe in the shape of `like`, of another family.
Ndf InShape(Ndf like, Ndf round, Ndf tilted, Ndf anisotropic, Ndf free) {
  if (IsRound(like)) return IsTilted(like) ? tilted : round;
  return IsTilted(like) ? free : anisotropic;
}

}  // namespace

LadderChoice ClimbLadder(const Recipe& simplest, const FitOptions& options, Measurement* measurement) {
  const MeasurementTraits traits = TraitsOf(*measurement);
  SetAsideForRecipe(simplest, measurement);
  Recipe weighted = simplest;
  weighted.weighting = EffectiveWeighting(simplest.weighting, measurement->samples);
  Ladder ladder(weighted, options, *measurement);
  if (!ladder.CanJudge()) return {simplest, {}};
  Model model;
  model.lobes = {{Ndf::kGgx}};
  if (!ladder.Try(model, "ggx")) return {simplest, {}};
  const auto with_ndf = [&](Ndf ndf) {
    Model changed = ladder.Best().recipe.model;
    changed.lobes[0].ndf = ndf;
    return changed;
  };
  if (traits.in_plane) {
    ladder.Try(with_ndf(Ndf::kGgxTilted), "ggx-tilted");
  } else if (!traits.isotropic) {
    ladder.Try(with_ndf(Ndf::kGgxAnisotropic), "ggx-anisotropic");
    ladder.Try(with_ndf(Ndf::kEllipsoid), "ellipsoid");
  }
  const Ndf shape = ladder.Best().recipe.model.lobes[0].ndf;
  const Ndf student =
      InShape(shape, Ndf::kStudent, Ndf::kStudentTilted, Ndf::kStudentAnisotropic, Ndf::kStudentEllipsoid);
  const Ndf profile =
      InShape(shape, Ndf::kProfile, Ndf::kProfileTilted, Ndf::kProfileAnisotropic, Ndf::kProfileEllipsoid);
  ladder.Try(with_ndf(student), NameOf(NdfChoices(), student));
  ladder.Try(with_ndf(profile), NameOf(NdfChoices(), profile));
  Model two;
  two.lobes = {{shape}, {Ndf::kGgx}};
  ladder.Try(two, std::string(NameOf(NdfChoices(), shape)) + "+ggx");
  Model curve = ladder.Best().recipe.model;
  const std::string before = ladder.Best().recipe.name;
  for (Lobe& lobe : curve.lobes) lobe.fresnel = Fresnel::kCurve;
  ladder.Try(curve, before + "+curve");
  Model interfaced = ladder.Best().recipe.model;
  const std::string base = ladder.Best().recipe.name;
  interfaced.diffuse = Diffuse::kInterfaced;
  ladder.Try(interfaced, base + "+interfaced");
  Model retro = ladder.Best().recipe.model;
  const std::string lobes = ladder.Best().recipe.name;
  if (retro.lobes.size() < 3) {
    Lobe back = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kNone};
    back.direction = LobeDirection::kRetro;
    retro.lobes.push_back(back);
    ladder.Try(retro, lobes + "+retro");
  }
  return ladder.Choose();
}

void AddAdvice(Material* material) {
  if (!material->verdict) return;
  Verdict& verdict = *material->verdict;
  if (verdict.kind != VerdictKind::kRough && verdict.kind != VerdictKind::kDoesNotDescribe) return;
  const TriedModel* best = nullptr;
  for (const TriedModel& model : material->tried) {
    if (!model.chosen && model.ratio < 1 && (best == nullptr || model.ratio < best->ratio)) best = &model;
  }
  if (material->misfit && material->misfit->flagged && !material->misfit->where.empty()) {
    verdict.advice = "it fits worst " + material->misfit->where;
  } else if (best != nullptr) {
    verdict.advice = fmt::format("{} predicted {:.0f} % better than one lobe", best->name, 100 * (1 - best->ratio));
  } else if (material->tried.empty()) {
    verdict.advice = "leave --recipe out: richer models are then tried";
  }
}

}  // namespace lobefit
