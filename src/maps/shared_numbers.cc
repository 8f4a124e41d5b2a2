#include "lobefit/maps/shared_numbers.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/process/parallel.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/maps/bands.h"
#include "lobefit/maps/engine/factor.h"
#include "lobefit/maps/stack/geometry.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostTexels = 4096, kPieces = 64;
constexpr int kMostSteps = 30;
// Steps go no further: turns and slopes, logarithms of widths.
constexpr double kMostTurn = 0.2, kMostLog = 0.3;
// Of the standard error, below which a step is the last.
constexpr double kLastStep = 0.02;

struct GridTexel {
  std::size_t index = 0, cluster = 0;
  Vec3 normal;                // of the map of normals
  std::vector<float> values;  // [channel lights + light]
  // Its own numbers, and what of them is determined.
  HeldNumbers own;
};

std::vector<GridTexel> ReadGrid(const Stack& stack, const FittedLights& lights) {
  std::size_t step = 1;
  while (stack.Texels() / (step * step) > kMostTexels) ++step;
  std::vector<GridTexel> texels;
  StackReader reader(stack);
  Progress progress("reading a grid of texels", stack.height);
  for (std::size_t y = step / 2; y < stack.height; y += step) {
    const StackBand band = reader.Read(y, 1);
    for (std::size_t x = step / 2; x < stack.width; x += step) {
      if (!stack.Holds(y * stack.width + x)) continue;
      GridTexel texel;
      texel.index = y * stack.width + x;
      if (!band.normals.empty()) texel.normal = band.normals[x];
      if (std::isnan(texel.normal.z)) continue;
      texel.values.resize(stack.channels * lights.index.size());
      Gather(band, x, stack.channels, lights, stack.lights.size(), texel.values.data());
      texels.push_back(std::move(texel));
    }
    progress.Advance(std::min(step, stack.height - y));
  }
  return texels;
}

// What the texels of a group say: sums over them.
struct Sums {
  MapVector slope = {};
  MapMatrix curvature = {}, squares = {};
  std::size_t texels = 0;

  void Add(const ProfileTerms& terms) {
    for (std::size_t j = 0; j < kMostUnknowns; ++j) {
      slope[j] += terms.slope[j];
      for (std::size_t k = 0; k < kMostUnknowns; ++k) {
        curvature[j][k] += terms.curvature[j][k], squares[j][k] += terms.slope[j] * terms.slope[k];
      }
    }
    ++texels;
  }
  void Add(const Sums& other) {
    for (std::size_t j = 0; j < kMostUnknowns; ++j) {
      slope[j] += other.slope[j];
      for (std::size_t k = 0; k < kMostUnknowns; ++k) {
        curvature[j][k] += other.curvature[j][k], squares[j][k] += other.squares[j][k];
      }
    }
    texels += other.texels;
  }
};

// The grid of texels, and passes over it.
class Grid {
 public:
  Grid(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, int threads)
      : stack_(stack), recipe_(recipe), lights_(lights), threads_(threads), texels_(ReadGrid(stack, lights)) {}

  std::vector<GridTexel>& texels() { return texels_; }

  // visit(texel, piece, fitter, held) for all texels with what is held of them. A piece is worked on in order by one
  // thread.
  template <class Visit>
  void ForEach(const Visit& visit) {
    ParallelFor(kPieces, threads_, [&](std::size_t piece) {
      TexelFitter fitter(recipe_.rules, {lights_.directions, {}}, static_cast<int>(stack_.channels));
      LightPaths paths;
      for (std::size_t t = piece * texels_.size() / kPieces; t < (piece + 1) * texels_.size() / kPieces; ++t) {
        GridTexel& texel = texels_[t];
        if (stack_.MovesPaths()) {
          PathsAt(stack_, lights_.index, texel.index, &paths);
          fitter.Move(paths);
        }
        visit(&texel, piece, &fitter);
      }
    });
  }

  // Fits each texel by itself; clusters and features of all.
  std::vector<Features> FitAlone() {
    std::vector<std::vector<Features>> found(kPieces);
    const int channels = static_cast<int>(stack_.channels);
    ForEach([&](GridTexel* texel, std::size_t piece, TexelFitter* fitter) {
      HeldNumbers held;
      held.normal = !stack_.normal_map.empty(), held.point.normal = texel->normal;
      const TexelFit fit = fitter->Fit(texel->values.data(), lights_.index.size(), held, &texel->own.point);
      HeldNumbers& own = texel->own;
      own.normal = !std::isnan(fit.normal.z);
      own.width = own.slope = !std::isnan(fit.alpha_x);
      own.diffuse = !std::isnan(fit.diffuse[0]), own.f0 = !std::isnan(fit.f0[0]);
      for (std::size_t c = 0; c < kMostChannels; ++c) {
        own.point.diffuse[c] *= fit.scale, own.point.f0[c] *= fit.scale;
      }
      found[piece].push_back(FeaturesOf(fit, channels));
    });
    std::vector<Features> all;
    for (const std::vector<Features>& piece : found) all.insert(all.end(), piece.begin(), piece.end());
    return all;
  }

  // Sums of the groups at what they hold; of the numbers that are `shared`.
  std::vector<Sums> SumsOf(const std::vector<SharedNumbers::Group>& groups) {
    std::vector<std::vector<Sums>> pieces(kPieces, std::vector<Sums>(groups.size()));
    ForEach([&](GridTexel* texel, std::size_t piece, TexelFitter* fitter) {
      const HeldNumbers& shared = groups[texel->cluster].held;
      HeldNumbers held = shared;
      if (!stack_.normal_map.empty()) held.normal = true, held.point.normal = texel->normal;
      fitter->Fit(texel->values.data(), lights_.index.size(), held);
      ProfileTerms terms;
      if (fitter->ProfileOfLastFit(shared, &terms)) pieces[piece][texel->cluster].Add(terms);
    });
    // In the order of the pieces: the same bits on any number of threads.
    std::vector<Sums> sums(groups.size());
    for (const std::vector<Sums>& piece : pieces) {
      for (std::size_t g = 0; g < groups.size(); ++g) sums[g].Add(piece[g]);
    }
    return sums;
  }

 private:
  const Stack& stack_;
  const MapRecipe& recipe_;
  const FittedLights& lights_;
  int threads_;
  std::vector<GridTexel> texels_;
};

// Median of number(texel) over those that know it; NaN: none.
template <class Known, class Number>
double Median(const std::vector<const GridTexel*>& texels, const Known& known, const Number& number) {
  std::vector<double> values;
  for (const GridTexel* texel : texels) {
    if (known(texel->own)) values.push_back(number(texel->own.point));
  }
  if (values.empty()) return kNan;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Medians of the texels' own numbers into what `wanted` shares; what none knows is not held.
void StartFrom(const std::vector<const GridTexel*>& texels, const HeldNumbers& wanted, HeldNumbers* held) {
  MapPoint& point = held->point;
  const auto widths = [](const HeldNumbers& own) { return own.width; };
  if (wanted.normal) {
    Vec3 sum = {0, 0, 0};
    for (const GridTexel* texel : texels) sum = texel->own.normal ? sum + texel->own.point.normal : sum;
    held->normal = Norm(sum) > 0;
    if (held->normal) point.normal = Normalized(sum);
  }
  for (std::size_t k = 0; k < 2 && wanted.slope; ++k) {
    point.slope[k] = Median(texels, widths, [&](const MapPoint& p) { return p.slope[k]; });
    held->slope = !std::isnan(point.slope[k]);
  }
  for (std::size_t k = 0; k < 3 && wanted.width; ++k) {
    point.width[k] = Median(texels, widths, [&](const MapPoint& p) { return p.width[k]; });
    held->width = !std::isnan(point.width[k]);
  }
  for (std::size_t c = 0; c < kMostChannels && wanted.diffuse; ++c) {
    point.diffuse[c] = Median(
        texels, [](const HeldNumbers& own) { return own.diffuse; }, [&](const MapPoint& p) { return p.diffuse[c]; });
    held->diffuse = !std::isnan(point.diffuse[c]);
  }
  for (std::size_t c = 0; c < kMostChannels && wanted.f0; ++c) {
    point.f0[c] = Median(
        texels, [](const HeldNumbers& own) { return own.f0; }, [&](const MapPoint& p) { return p.f0[c]; });
    held->f0 = !std::isnan(point.f0[c]);
  }
}

// By unknowns of the whole model, whether `held` names them.
std::array<bool, kMostUnknowns> Named(const MapModel& model, const HeldNumbers& held) {
  std::array<bool, kMostUnknowns> named = {};
  named[0] = named[1] = model.TurnsNormal() ? held.normal : held.slope;
  for (int j = 2; j < model.Shape(); ++j) named[static_cast<std::size_t>(j)] = held.width;
  for (int c = 0; c < model.channels; ++c) {
    named[static_cast<std::size_t>(model.DiffuseAt(c))] = held.diffuse;
    if (model.lobe != MapLobe::kNone) named[static_cast<std::size_t>(model.F0At(c))] = held.f0;
  }
  return named;
}

// One step of Newton's method in the unknowns that are `moved`; whether it was so small that it is the last.
bool Step(const MapModel& model, const MapRules& rules, const HeldNumbers& moved, const Sums& sums,
          SharedNumbers::Group* group) {
  const std::array<bool, kMostUnknowns> named = Named(model, moved);
  std::array<bool, kMostUnknowns> fixed = {};
  const int unknowns = model.Unknowns();
  // Texels without a lobe say nothing of its numbers.
  for (int j = 0; j < unknowns; ++j) fixed[j] = !named[j] || !(sums.curvature[j][j] > 0);
  MapMatrix factor = sums.curvature;
  if (!Factorise(unknowns, fixed, &factor)) return true;
  MapVector step = {};
  for (int j = 0; j < unknowns; ++j) step[j] = fixed[j] ? 0 : -sums.slope[j];
  SolveFactorised(unknowns, factor, &step);
  const MapMatrix inverse = InverseOf(unknowns, fixed, factor);
  group->texels = sums.texels;
  bool last = true;
  for (int j = 0; j < unknowns; ++j) {
    if (fixed[j]) continue;
    double variance = 0;
    for (int k = 0; k < unknowns; ++k) {
      for (int i = 0; i < unknowns; ++i) variance += inverse[j][k] * sums.squares[k][i] * inverse[j][i];
    }
    group->error[j] = std::sqrt(variance);
    last = last && (std::fabs(step[j]) < kLastStep * group->error[j] || std::fabs(step[j]) < 1e-9);
  }
  MapPoint& point = group->held.point;
  const auto within = [&](int j, double most) { return std::clamp(step[j], -most, most); };
  if (model.TurnsNormal() && named[0]) {
    const MapFrame frame = FrameOf(point.normal);
    point.normal = Normalized(frame.n + within(0, kMostTurn) * frame.t + within(1, kMostTurn) * frame.b);
  }
  for (int k = 0; k < 2 && !model.TurnsNormal(); ++k) {
    point.slope[k] = std::clamp(point.slope[k] + within(k, kMostTurn), -1.0, 1.0);
  }
  for (int j = 2; j < model.Shape(); ++j) {
    // The middle one of three is no logarithm.
    const bool lean = model.Shape() == 5 && j == 3;
    double& width = point.width[j - 2];
    width = std::clamp(width + within(j, kMostLog), lean ? -1 : std::log(rules.least_alpha),
                       lean ? 1 : std::log(rules.most_alpha));
  }
  // An amplitude at most doubles, or halves, in a step.
  const auto scaled = [&](int j, double* value) { *value = std::clamp(*value + step[j], *value / 2, *value * 2); };
  for (int c = 0; c < model.channels; ++c) {
    scaled(model.DiffuseAt(c), &point.diffuse[c]);
    if (model.lobe == MapLobe::kNone) continue;
    scaled(model.F0At(c), &point.f0[c]);
    if (rules.schlick) point.f0[c] = std::min(point.f0[c], 1.0);
  }
  return last;
}

// What both name.
HeldNumbers Both(const HeldNumbers& a, const HeldNumbers& b) {
  HeldNumbers both;
  both.normal = a.normal && b.normal, both.slope = a.slope && b.slope, both.width = a.width && b.width;
  both.diffuse = a.diffuse && b.diffuse, both.f0 = a.f0 && b.f0;
  return both;
}

bool NamesAny(const HeldNumbers& held) { return held.normal || held.slope || held.width || held.diffuse || held.f0; }

}  // namespace

SharedNumbers EstimateShared(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, int threads) {
  const MapModel model = {recipe.rules.lobe, static_cast<int>(stack.channels), recipe.rules.schlick};
  const HeldNumbers of_image = HeldOver(recipe.shares, ShareOver::kImage),
                    of_cluster = HeldOver(recipe.shares, ShareOver::kCluster);
  SharedNumbers shared;
  Grid grid(stack, recipe, lights, threads);
  const std::vector<Features> features = grid.FitAlone();
  if (NamesAny(of_cluster)) shared.clusters = FindClusters(features, recipe.shares.clusters);
  shared.groups.resize(std::max<std::size_t>(shared.clusters.centers.size(), 1));
  std::vector<std::vector<const GridTexel*>> members(shared.groups.size());
  std::vector<const GridTexel*> all;
  for (std::size_t t = 0; t < grid.texels().size(); ++t) {
    GridTexel& texel = grid.texels()[t];
    texel.cluster = shared.clusters.Nearest(features[t]);
    members[texel.cluster].push_back(&texel), all.push_back(&texel);
  }
  for (std::size_t g = 0; g < shared.groups.size(); ++g) {
    StartFrom(members[g], of_cluster, &shared.groups[g].held);
    StartFrom(all, of_image, &shared.groups[g].held);
  }
  for (int step = 0; step < kMostSteps; ++step) {
    const std::vector<Sums> sums = grid.SumsOf(shared.groups);
    Sums whole;
    for (const Sums& s : sums) whole.Add(s);
    bool last = true;
    for (std::size_t g = 0; g < shared.groups.size(); ++g) {
      SharedNumbers::Group& group = shared.groups[g];
      const HeldNumbers own = Both(group.held, of_cluster), common = Both(group.held, of_image);
      if (NamesAny(own)) last = Step(model, recipe.rules, own, sums[g], &group) && last;
      // The same step in each group.
      if (NamesAny(common)) last = Step(model, recipe.rules, common, whole, &group) && last;
    }
    if (last) break;
  }
  return shared;
}

}  // namespace lobefit
