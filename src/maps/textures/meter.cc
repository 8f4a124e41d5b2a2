#include "lobefit/maps/textures/meter.h"

#include <cmath>

#include "lobefit/base/process/parallel.h"
#include "lobefit/math/directions.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

constexpr int kPairs = 24, kMostTries = 200;
constexpr double kMostTheta = 88 * kPi / 180, kInLobe = 0.9;
// Samples a side of the albedo of renderers that compensate for lost energy: 1 % of what is added.
constexpr int kCoarseAlbedo = 16;

struct Pair {
  Vec3 wi, wo;
};

Vec3 Uniform(RandomNumbers* random) {
  const double z = random->Uniform(std::cos(kMostTheta), 1), r = std::sqrt(1 - z * z);
  const double phi = random->Uniform(0, 2 * kPi);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// The lobe's axes.
struct LobeFrame {
  Vec3 t, b, n;
  explicit LobeFrame(const TexelNumbers& texel) : n(texel.normal) {
    const Vec3 along = {std::cos(texel.rotation), std::sin(texel.rotation), 0};
    t = Normalized(along - Dot(along, n) * n);
    b = Cross(n, t);
  }
};

bool IsInLobe(const TexelNumbers& texel, const LobeFrame& frame, const Pair& pair) {
  if (!texel.lobe) return false;
  const Vec3 h = HalfVector(pair.wi, pair.wo);
  const double z = Dot(h, frame.n);
  const double x = Dot(h, frame.t) / (z * texel.widths.alpha_1), y = Dot(h, frame.b) / (z * texel.widths.alpha_2);
  return z > 0 && x * x + y * y <= kInLobe / (1 - kInLobe);
}

// A pair of directions; false where it is below a horizon.
bool Draw(const TexelNumbers& texel, const LobeFrame& frame, bool in_lobe, RandomNumbers* random, Pair* pair) {
  pair->wo = Uniform(random);
  if (in_lobe) {
    const double u = kInLobe * random->Uniform(), r = std::sqrt(u / (1 - u)), phi = random->Uniform(0, 2 * kPi);
    const Vec3 h = Normalized(r * std::cos(phi) * texel.widths.alpha_1 * frame.t +
                              r * std::sin(phi) * texel.widths.alpha_2 * frame.b + frame.n);
    pair->wi = Reflect(pair->wo, h);
  } else {
    pair->wi = Uniform(random);
  }
  const double least = std::cos(kMostTheta);
  return pair->wi.z > least && Dot(pair->wi, frame.n) > least && Dot(pair->wo, frame.n) > least;
}

struct Differences {
  std::vector<double> uniform, lobe, off;
};

void Compare(const TexelNumbers& texel, const BrdfFunction& fit, const BrdfFunction& target, RandomNumbers* random,
             Differences* differences) {
  const LobeFrame frame(texel);
  int pairs = 0;
  for (int attempt = 0; attempt < kMostTries && pairs < kPairs; ++attempt) {
    const bool drawn_in_lobe = texel.lobe && pairs % 2 == 1;
    Pair pair;
    if (!Draw(texel, frame, drawn_in_lobe, random, &pair)) continue;
    ++pairs;
    const bool in_lobe = drawn_in_lobe || IsInLobe(texel, frame, pair);
    double expected[3], found[3];
    fit(pair.wi, pair.wo, expected);
    target(pair.wi, pair.wo, found);
    for (int c = 0; c < 3; ++c) {
      const double off = std::fabs(found[c] - expected[c]) / std::max(expected[c], kErrorFloor);
      if (!drawn_in_lobe) differences->uniform.push_back(off);
      if (drawn_in_lobe || !in_lobe) (in_lobe ? differences->lobe : differences->off).push_back(off);
    }
  }
}

}  // namespace

ExportError ErrorOfTarget(const MapTarget& target, const MapNumbers& maps, std::size_t most_texels, int threads) {
  const std::size_t texels = maps.width() * maps.height();
  std::size_t step = 1;
  while (maps.inside() / (step * step) > most_texels) ++step;
  std::vector<std::size_t> chosen;
  for (std::size_t y = step / 2; y < maps.height(); y += step) {
    for (std::size_t x = step / 2; x < maps.width(); x += step) {
      if (maps.Inside(y * maps.width() + x)) chosen.push_back(y * maps.width() + x);
    }
  }
  if (chosen.empty()) {
    for (std::size_t t = 0; t < texels && chosen.empty(); ++t) {
      if (maps.Inside(t)) chosen.push_back(t);
    }
  }
  const std::vector<Texture> textures = target.textures(maps);
  std::vector<Differences> parts(chosen.size());
  ParallelFor(chosen.size(), threads, [&](std::size_t k) {
    const TexelNumbers texel = maps.At(chosen[k]);
    std::vector<TextureValue> read;
    for (const Texture& texture : textures) read.push_back(Stored(texture, texel));
    Surface surface = target.surface(maps, read);
    surface.albedo_side = kCoarseAlbedo;
    RandomNumbers random(StreamSeed(1, chosen[k]));
    Compare(texel, SurfaceBrdf(SurfaceOf(texel, maps.schlick())), SurfaceBrdf(surface), &random, &parts[k]);
  });
  Differences all;
  const auto append = [](const std::vector<double>& from, std::vector<double>* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  for (const Differences& part : parts) {
    append(part.uniform, &all.uniform), append(part.lobe, &all.lobe), append(part.off, &all.off);
  }
  return {LevelsOf(std::move(all.uniform)), LevelsOf(std::move(all.lobe)), LevelsOf(std::move(all.off)), kNan};
}

}  // namespace lobefit
