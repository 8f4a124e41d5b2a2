#include "lobefit/maps/bands.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "lobefit/base/process/parallel.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/maps/stack/geometry.h"

namespace lobefit {
namespace {

constexpr std::size_t kBandBytes = std::size_t{16} << 20U, kMostBandRows = 64;

struct BandRange {
  std::size_t first, rows;
};

// Bands begin at multiples of their height where they can, so that runs over parts of the picture make the same ones.
std::vector<BandRange> BandsOf(const std::vector<std::pair<std::size_t, std::size_t>>& ranges, std::size_t height) {
  std::vector<BandRange> bands;
  for (const auto& [first, end] : ranges) {
    for (std::size_t at = first; at < end;) {
      const std::size_t next = std::min(end, (at / height + 1) * height);
      bands.push_back({at, next - at});
      at = next;
    }
  }
  return bands;
}

// One texel, with what it shares and what is known of its normal.
TexelFit FitTexel(const SharedNumbers& shared, const Vec3* normal, const std::vector<float>& values, std::size_t lights,
                  int channels, TexelFitter* fitter) {
  HeldNumbers held;
  if (normal != nullptr) held.normal = true, held.point.normal = *normal;
  std::size_t group = 0;
  const bool parted = !shared.clusters.centers.empty();
  if (parted) {
    const TexelFit alone = fitter->Fit(values.data(), lights, held);
    if ((alone.status & kMapTooFew) != 0) return alone;
    group = shared.clusters.Nearest(FeaturesOf(alone, channels));
  }
  if (!shared.groups.empty()) held = shared.groups[group].held;
  if (normal != nullptr) held.normal = true, held.point.normal = *normal;
  TexelFit fit = fitter->Fit(values.data(), lights, held);
  if (parted) fit.cluster = static_cast<std::uint32_t>(group + 1);
  return fit;
}

MapRows FitBand(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, const SharedNumbers& shared,
                const StackBand& band, TexelFitter* fitter) {
  const int channels = static_cast<int>(stack.channels);
  const std::vector<MapPlane> planes = PlanesFor(KindOf(recipe, stack));
  MapRows rows = {band.first_row, band.rows, stack.width, {}};
  rows.values.assign(planes.size(), std::vector<float>(band.rows * stack.width));
  std::vector<float> values(stack.channels * lights.index.size()), numbers(planes.size());
  LightPaths paths;
  TexelFit outside, unknown;
  outside.status = kMapOutside, unknown.status = kMapTooFew | kMapNotDetermined;
  for (std::size_t t = 0; t < band.rows * stack.width; ++t) {
    TexelFit fit = outside;
    const Vec3* normal = band.normals.empty() ? nullptr : &band.normals[t];
    const bool is_known = normal == nullptr || !std::isnan(normal->z);
    if (stack.Holds(band.first_row * stack.width + t)) {
      Gather(band, t, stack.channels, lights, stack.lights.size(), values.data());
      if (stack.MovesPaths()) {
        PathsAt(stack, lights.index, band.first_row * stack.width + t, &paths);
        fitter->Move(paths);
      }
      fit = is_known ? FitTexel(shared, normal, values, lights.index.size(), channels, fitter) : unknown;
    }
    Fill(fit, KindOf(recipe, stack), numbers.data());
    for (std::size_t k = 0; k < planes.size(); ++k) rows.values[k][t] = numbers[k];
  }
  return rows;
}

}  // namespace

MapKind KindOf(const MapRecipe& recipe, const Stack& stack) {
  return {recipe.rules.lobe, static_cast<int>(stack.channels), recipe.shares.Parts()};
}

FittedLights LightsWithout(const Stack& stack, const std::vector<std::size_t>& left_out) {
  FittedLights lights;
  for (std::size_t l = 0; l < stack.lights.size(); ++l) {
    if (std::find(left_out.begin(), left_out.end(), l) != left_out.end()) continue;
    lights.index.push_back(l);
    lights.directions.push_back(stack.lights[l].direction);
  }
  return lights;
}

void Gather(const StackBand& band, std::size_t texel, std::size_t channels, const FittedLights& lights,
            std::size_t all_lights, float* values) {
  for (std::size_t c = 0; c < channels; ++c) {
    const float* from = band.values.data() + (texel * channels + c) * all_lights;
    for (const std::size_t l : lights.index) *values++ = from[l];
  }
}

std::size_t RowsOfBand(const Stack& stack) {
  const std::size_t row = stack.width * stack.channels * stack.lights.size() * sizeof(float);
  return std::clamp(kBandBytes / row, std::size_t{1}, kMostBandRows);
}

void FitBands(const Stack& stack, const MapRecipe& recipe, const FittedLights& lights, const SharedNumbers& shared,
              const std::vector<std::pair<std::size_t, std::size_t>>& ranges, int threads,
              const std::function<void(const MapRows&)>& done) {
  std::size_t height = RowsOfBand(stack);
  // A small picture has bands enough for the threads.
  while (height > 1 && stack.height < height * static_cast<std::size_t>(threads) * 2) height /= 2;
  const std::vector<BandRange> bands = BandsOf(ranges, height);
  if (bands.empty()) return;
  std::size_t total = 0;
  for (const BandRange& band : bands) total += band.rows * stack.width;
  Progress progress("fitting texels", total);
  StackReader reader(stack);
  std::mutex reading;
  std::size_t next = 0;
  const auto workers = std::min(static_cast<std::size_t>(threads), bands.size());
  ParallelFor(workers, threads, [&](std::size_t) {
    TexelFitter fitter(recipe.rules, {lights.directions, {}}, static_cast<int>(stack.channels));
    while (true) {
      StackBand band;
      {
        const std::lock_guard<std::mutex> lock(reading);
        if (next == bands.size()) return;
        const BandRange range = bands[next++];
        try {
          band = reader.Read(range.first, range.rows);
        } catch (...) {
          next = bands.size();  // the others end, and what is done stays
          throw;
        }
      }
      done(FitBand(stack, recipe, lights, shared, band, &fitter));
      progress.Advance(band.rows * stack.width);
    }
  });
}

}  // namespace lobefit
