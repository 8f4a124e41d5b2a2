#include "lobefit/fit/ladder.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/fit/compare.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/inference/energy_balance.h"
#include "lobefit/fit/objective/prediction.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/fit/rung.h"
#include "lobefit/fit/search/profile_knots.h"
#include "lobefit/fit/search/search.h"
#include "lobefit/fit/search/starts.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/recipe/free_scale.h"

namespace lobefit {
namespace {

constexpr std::size_t kSamples = 4000, kMostFolds = 4, kStarts = 4;
// Wavelengths that a spectrum is judged by; the shape is that of all, and descents cost the square of their number.
constexpr std::size_t kMostChannels = 5;
constexpr std::size_t kMostLobes = 3;
// A part whose gain in the mean square on held-out directions is beyond chance.
constexpr double kMuch = 0.9;
// Incident directions at which a model's albedo is looked at.
constexpr std::size_t kIncidences = 6;

struct Split {
  Samples training, test;
};

std::vector<std::size_t> SpreadChannels(std::size_t channels) {
  const std::size_t count = std::min(channels, kMostChannels);
  std::vector<std::size_t> spread;
  for (std::size_t k = 0; k < count; ++k) spread.push_back((2 * k + 1) * channels / (2 * count));
  return spread;
}

Samples SomeChannels(const Samples& samples, const std::vector<std::size_t>& indices) {
  Samples some = samples.Subset(indices);
  std::vector<std::vector<double>> values;
  for (const std::size_t c : SpreadChannels(some.values.size())) values.push_back(std::move(some.values[c]));
  some.values = std::move(values);
  return some;
}

class Ladder {
 public:
  Ladder(const Recipe& simplest, const FitOptions& options, const Measurement& measurement)
      : simplest_(simplest),
        wanted_(simplest.metric),
        options_(options),
        pool_(std::max(1, options.threads)),
        scaled_(simplest.model.lobes[0].fresnel == Fresnel::kNone) {
    // The noise that gives asinh its knee is estimated from the fit of the model that is chosen (fit.cc).
    if (simplest_.metric == Metric::kAsinh && !simplest_.noise.IsKnown()) simplest_.metric = Metric::kCubeRoot;
    options_.starts = std::min(options_.starts, kStarts);
    options_.subsample = kSamples / 4;
    options_.scouting_steps = kScoutingSteps;
    options_.trial = true;
    const Incidences incidences = GroupByIncidence(measurement);
    wi_ = SpreadIncidences(incidences, simplest.theta_max, kIncidences);
    const std::size_t folds = std::min(kMostFolds, incidences.wi.size());
    if (folds < 2) return;
    const std::vector<std::size_t> dealt = DealFolds(incidences.wi.size(), folds, options.seed);
    const std::vector<std::size_t> chosen = StratifiedSubsample(measurement.samples.size(), kSamples, options.seed);
    for (const std::size_t c : SpreadChannels(measurement.channels.names.size()))
      channels_.push_back(measurement.channels.names[c]);
    all_channels_ = measurement.channels.names.size();
    all_ = SomeChannels(measurement.samples, chosen);
    const std::vector<std::vector<double>> black(all_.values.size(), std::vector<double>(all_.size(), 0.0));
    exact_ = kRounding * kRounding *
             SumSquares(simplest_.metric, simplest_.noise, Weighting::kCells, true, all_, black).MeanSquare();
    for (std::size_t k = 0; k < folds; ++k) {
      std::vector<std::size_t> training, test;
      for (const std::size_t i : chosen) (dealt[incidences.group[i]] == k ? test : training).push_back(i);
      if (training.empty() || test.empty()) continue;
      folds_.push_back({SomeChannels(measurement.samples, training), SomeChannels(measurement.samples, test)});
    }
  }

  bool CanJudge() const { return folds_.size() >= 2; }

  // In the plane of incidence a lobe's width across it is not seen, and enters the values as a factor: with equal
  // widths the reflectance would exceed 1. Models from here on have a free factor in place of Schlick's term.
  void FreeTheScale() { scaled_ = true; }

  // Judges the model and keeps it, searched from the ellipses of `base` where one is given; null where it cannot be
  // fitted.
  const Rung* Try(Model model, const std::string& name, const Rung* base = nullptr) {
    const Rung* const kept = Judge(std::move(model), name, base);
    if (options_.on_tried) options_.on_tried();
    return kept;
  }

  bool scaled() const { return scaled_; }
  const Rung& First() const { return rungs_[0]; }
  // The rung that predicts best so far.
  const Rung& Best() const {
    return *std::min_element(rungs_.begin(), rungs_.end(),
                             [](const Rung& a, const Rung& b) { return a.mean() < b.mean(); });
  }

  // The one with the fewest parameters that predicts as well, but for what is worth nothing.
  const Rung& Simplest() const {
    const Rung* simplest = &Best();
    const double most = simplest->mean() * (1 + kWorthNothing) + exact_;
    for (const Rung& rung : rungs_) {
      if (rung.mean() <= most && rung.tried.free_parameters < simplest->tried.free_parameters) simplest = &rung;
    }
    return *simplest;
  }

  // Without what says that the scale is free.
  std::string NameOf(const Rung& rung) const {
    const std::string& name = rung.recipe.name;
    return scaled_ && name.ends_with("-scaled") ? name.substr(0, name.size() - 7) : name;
  }

  // `samples`: all of them, to which the choice is fitted.
  LadderChoice Choose(const Samples& samples) {
    const Rung& best = Best();
    std::size_t chosen = rungs_.size();
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
      const bool good = excess <= std::max({error, kWorthNothing * best.mean(), exact_}) &&
                        rung.mean() <= rungs_[0].mean() * (1 + 1e-9) + exact_;
      if (!good) continue;
      // What can be a surface before what cannot, then the fewest parameters.
      const auto rank = [](const Rung& of) { return std::pair(of.creates_energy, of.tried.free_parameters); };
      if (chosen == rungs_.size() || rank(rung) < rank(rungs_[chosen])) chosen = r;
    }
    LadderChoice choice;
    rungs_[chosen].tried.chosen = true;
    for (const Rung& rung : rungs_) choice.tried.push_back(rung.tried);
    const Rung& rung = rungs_[chosen];
    choice.recipe = rung.recipe;
    choice.recipe.metric = wanted_;
    // Several lobes have hundreds of starts, and those of a spectrum cost most; the search was made on the subsample.
    choice.warm = rung.found.shapes.size() > 1 || channels_.size() == kMostChannels;
    if (choice.warm) StartAt(rung.found, all_channels_, samples, &choice.recipe);
    choice.recipe.reason = fmt::format(
        "of {} models the simplest whose error on held-out incident directions ({:.3g}) is within one standard error "
        "of the least ({:.3g}, {}); one lobe of the simplest kind: {:.3g}",
        rungs_.size(), rung.tried.held_out, std::sqrt(best.mean()), best.tried.name, std::sqrt(rungs_[0].mean()));
    return choice;
  }

 private:
  const Rung* Judge(Model model, const std::string& name, const Rung* base) {
    Rung rung;
    rung.recipe = simplest_;
    rung.recipe.name = scaled_ ? name + "-scaled" : name;
    if (scaled_) {
      for (Lobe& lobe : model.lobes) {
        if (lobe.fresnel == Fresnel::kSchlick) lobe.fresnel = Fresnel::kNone;
      }
    }
    if (!WhyNotEvaluable(model).empty()) return nullptr;
    rung.recipe.model = model;
    rung.recipe.parameters = DefaultRecipe(model, name).parameters;
    if (scaled_) LiftReflectanceBounds(&rung.recipe);
    const Recipe wanted = rung.recipe;
    if (base != nullptr) StartShapesAt(base->found, &rung.recipe);
    rung.tried.name = wanted.name;
    try {
      const Recipe recipe = WithKnots(rung.recipe, all_, channels_, options_, &pool_);
      const Layout layout(recipe, channels_);
      rung.tried.free_parameters = layout.size();
      if (all_.size() * channels_.size() < layout.size() || (!rungs_.empty() && LeastTraining() < layout.size()))
        return nullptr;
      const std::vector<DistinctMinimum> minima = FindMinima(Problem(all_, recipe), layout, all_, options_, &pool_);
      if (minima.empty()) return nullptr;
      const ParameterValues values = layout.Report(minima[0].solution.u.data());
      const std::vector<double>& reflectance = values[FirstFresnel(recipe.model, 0)];
      rung.above_one = recipe.model.lobes[0].fresnel == Fresnel::kSchlick &&
                       std::any_of(reflectance.begin(), reflectance.end(), [](double f0) { return f0 >= 1 - 1e-6; });
      rung.found = FoundAt(layout, minima[0].solution.u);
      rung.mean_square.assign(folds_.size(), kNan);
      if (!recipe.free_scale)
        rung.creates_energy = CreatesEnergy(BalanceAt(wi_, recipe.model, values, channels_, &pool_));
      pool_.Run(folds_.size(), [&](std::size_t k) {
        ThreadPool alone(1);
        const Problem training(folds_[k].training, recipe), test(folds_[k].test, recipe);
        SolveOptions finish;
        finish.function_tolerance = 1e-6;
        finish.max_iterations = 60;
        finish.use_ceres = false;  // bounds hold many coordinates, and its factorisations take as long as the passes
        const Solution solution = Solve(training, layout, minima[0].solution.u, finish, &alone);
        std::vector<std::vector<double>> f_r;
        ModelValues(test.kernel_samples(), layout.ToKernel(solution.u.data()), 0, test.size(), &f_r);
        rung.mean_square[k] =
            SumSquares(recipe.metric, recipe.noise, recipe.weighting, true, folds_[k].test, f_r).MeanSquare();
      });
    } catch (const InputError&) {
      return nullptr;  // what cannot be fitted is no candidate
    }
    rung.recipe = wanted;  // the whole measurement may reach further knots
    if (!std::isfinite(rung.mean())) return nullptr;
    rungs_.push_back(std::move(rung));
    return &rungs_.back();
  }

  // Numbers that the fold with the fewest leaves: a model of more parameters goes through all of them, and what it
  // predicts of the others is chance.
  std::size_t LeastTraining() const {
    std::size_t least = all_.size();
    for (const Split& fold : folds_) least = std::min(least, fold.training.size());
    return least * channels_.size();
  }

  Recipe simplest_;
  Metric wanted_;
  FitOptions options_;
  std::vector<std::string> channels_;
  std::vector<Vec3> wi_;  // where albedos are looked at
  ThreadPool pool_;
  bool scaled_;
  std::size_t all_channels_ = 0;
  double exact_ = 0;  // mean square that is no error
  Samples all_;
  std::vector<Split> folds_;
  std::deque<Rung> rungs_;  // references stay
};

// The lobe in the shape of `like`, of another family.
Ndf InShape(Ndf like, Ndf round, Ndf tilted, Ndf anisotropic, Ndf free) {
  if (IsRound(like)) return IsTilted(like) ? tilted : round;
  return IsTilted(like) ? free : anisotropic;
}

std::string NameOfParts(const Model& model) {
  std::string name;
  bool curve = false, coat = false;
  for (const Lobe& lobe : model.lobes) {
    curve = curve || lobe.fresnel == Fresnel::kCurve;
    coat = coat || IsCoat(lobe.fresnel);
    if (IsCoat(lobe.fresnel)) continue;
    name += name.empty() ? "" : "+";
    name += lobe.direction == LobeDirection::kRetro ? "retro" : NameOf(NdfChoices(), lobe.ndf);
  }
  return name + (curve ? "+curve" : "") + (coat ? "+coat" : "") +
         (model.diffuse == Diffuse::kInterfaced ? "+interfaced" : "");
}

}  // namespace

LadderChoice ClimbLadder(const Recipe& simplest, const FitOptions& options, Measurement* measurement) {
  const MeasurementTraits traits = TraitsOf(*measurement);
  SetAsideForRecipe(simplest, measurement);
  Recipe weighted = simplest;
  weighted.weighting = EffectiveWeighting(simplest.weighting, measurement->samples);
  Ladder ladder(weighted, options, *measurement);
  if (!ladder.CanJudge()) return {simplest, false, {}};
  Model model;
  model.lobes = {{Ndf::kGgx}};
  if (ladder.Try(model, "ggx") == nullptr) return {simplest, false, {}};
  const auto with_ndf = [&](Ndf ndf) {
    Model changed = ladder.Best().recipe.model;
    changed.lobes[0].ndf = ndf;
    return changed;
  };
  if (traits.in_plane) {
    if (ladder.First().above_one) {
      ladder.FreeTheScale();
      ladder.Try(model, "ggx");
    }
    ladder.Try(with_ndf(Ndf::kGgxTilted), "ggx-tilted");
  } else if (!traits.isotropic) {
    ladder.Try(with_ndf(Ndf::kGgxAnisotropic), "ggx-anisotropic");
    ladder.Try(with_ndf(Ndf::kEllipsoid), "ellipsoid");
  }
  const Rung& plain = ladder.Simplest();
  const Ndf shape = plain.recipe.model.lobes[0].ndf;
  const Ndf student =
      InShape(shape, Ndf::kStudent, Ndf::kStudentTilted, Ndf::kStudentAnisotropic, Ndf::kStudentEllipsoid);
  const Ndf profile =
      InShape(shape, Ndf::kProfile, Ndf::kProfileTilted, Ndf::kProfileAnisotropic, Ndf::kProfileEllipsoid);
  const std::string profile_name = NameOf(NdfChoices(), profile);
  ladder.Try(with_ndf(student), NameOf(NdfChoices(), student));
  Model free;
  free.lobes = {{profile}};
  const Rung* const with_profile = ladder.Try(free, profile_name);
  // The scatter of polished surfaces is no lobe of facets. A wide lobe has the shape of one, which is searched above.
  constexpr double kPolished = 0.1;
  if (ladder.First().found.shapes[0][0][0] < kPolished) {
    Model scatter;
    scatter.lobes = {{IsRound(shape) ? Ndf::kAbg : Ndf::kAbgAnisotropic, Masking::kNone, Fresnel::kNone}};
    ladder.Try(scatter, NameOf(NdfChoices(), scatter.lobes[0].ndf));
  }
  Model two;
  two.lobes = {{shape}, {Ndf::kGgx}};
  const std::string two_name = std::string(NameOf(NdfChoices(), shape)) + "+ggx";
  const Rung* const with_two = ladder.Try(two, two_name);
  // A free curve of the angle takes up what a tail lacks and the other way round: each with it.
  const auto with_curve = [&](std::vector<Lobe> lobes, const Rung* base) {
    if (base == nullptr) return;
    Model curved;
    for (Lobe& lobe : lobes) lobe.fresnel = Fresnel::kCurve;
    curved.lobes = std::move(lobes);
    ladder.Try(curved, NameOfParts(curved), base);
  };
  with_curve({{shape}}, &plain);
  with_curve({{profile}}, with_profile);
  with_curve({{shape}, {Ndf::kGgx}}, with_two);
  with_curve({{student}, {student}}, with_two);
  // Two profiles in each of a spectrum's channels cost minutes, and predict little better.
  const bool spectrum = measurement->channels.names.size() > kMostChannels;
  if (!spectrum) with_curve({{profile}, {profile}}, with_two);
  // What a part gains it may gain over one lobe as well, where tails and curves stood in for it; that takes little.
  const auto add_part = [&](const Model& with, const std::string& name, const Model& alone) {
    const std::string name_alone = NameOfParts(alone);
    if (NameOfParts(with) != name_alone) ladder.Try(with, name, &ladder.Best());
    ladder.Try(alone, name_alone);
  };
  // What an interface throws back is no multiple of an albedo, which a free scale does not tell.
  Model interfaced = ladder.Best().recipe.model;
  interfaced.diffuse = Diffuse::kInterfaced;
  if (!simplest.free_scale)
    add_part(interfaced, ladder.NameOf(ladder.Best()) + "+interfaced", {{{shape}}, Diffuse::kInterfaced});
  const auto with_lobe = [](const Rung& rung, const Lobe& lobe) {
    Model more = rung.recipe.model;
    more.lobes.push_back(lobe);
    return more;
  };
  const Rung& before = ladder.Best();
  Lobe back = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kNone};
  back.direction = LobeDirection::kRetro;
  if (before.recipe.model.lobes.size() < kMostLobes)
    add_part(with_lobe(before, back), ladder.NameOf(before) + "+retro", {{{shape}, back}, Diffuse::kLambert});
  // A lobe about the back direction that gains little leaves its place to another.
  const Rung& base = ladder.Best().mean() < kMuch * before.mean() ? ladder.Best() : before;
  const std::size_t lobes = base.recipe.model.lobes.size();
  if (lobes > 1 && lobes < kMostLobes && !spectrum) {
    const Lobe third = {Ndf::kGgx, Masking::kSmithSeparable, base.recipe.model.lobes[0].fresnel};
    ladder.Try(with_lobe(base, third), ladder.NameOf(base) + "+ggx", &base);
  }
  // Last, as a third lobe may do the same. Below a coat the diffuse part is Lambertian; a coat's reflectance is
  // calibrated, so that a free scale has none.
  if (!ladder.scaled() && !spectrum) {
    const Lobe coat = {Ndf::kGgx, Masking::kSmithSeparable, Fresnel::kCoatLayered};
    const Model simple = {{{shape}, coat}, Diffuse::kLambert};
    const Rung* const rung = ladder.Try(simple, NameOfParts(simple));
    if (rung != nullptr && rung->mean() < kMuch * plain.mean()) {
      Model coated = ladder.Best().recipe.model;
      coated.diffuse = Diffuse::kLambert;
      if (IsCoat(coated.lobes.back().fresnel)) coated.lobes.pop_back();
      coated.lobes.resize(std::min(coated.lobes.size(), kMostLobes - 1));
      coated.lobes.push_back(coat);
      if (coated.lobes.size() > 2 || coated.lobes[0].ndf != shape)
        ladder.Try(coated, NameOfParts(coated), &ladder.Best());
    }
  }
  return ladder.Choose(measurement->samples);
}

void AddAdvice(Material* material) {
  if (!material->verdict) return;
  Verdict& verdict = *material->verdict;
  if (material->energy && CreatesEnergy(*material->energy)) return;  // what to do about that is said
  if (verdict.kind != VerdictKind::kRough && verdict.kind != VerdictKind::kDoesNotDescribe) return;
  const TriedModel *best = nullptr, *chosen = nullptr;
  for (const TriedModel& model : material->tried) {
    if (model.chosen) chosen = &model;
    if (best == nullptr || model.held_out < best->held_out) best = &model;
  }
  // Less is worth nothing (compare.h).
  constexpr double kBetter = 0.99;
  if (material->misfit && material->misfit->flagged && !material->misfit->where.empty()) {
    verdict.advice = "it fits worst " + material->misfit->where;
  } else if (chosen != nullptr && best->held_out < kBetter * chosen->held_out) {
    verdict.advice = fmt::format("{} predicted {:.0f} % better, with {} parameters", best->name,
                                 100 * (1 - best->held_out / chosen->held_out), best->free_parameters);
  } else if (material->tried.empty()) {
    verdict.advice = "leave --recipe out: richer models are then tried";
  }
}

}  // namespace lobefit
