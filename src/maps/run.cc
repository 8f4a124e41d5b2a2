#include "lobefit/maps/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/base/version.h"
#include "lobefit/maps/bands.h"
#include "lobefit/maps/document.h"
#include "lobefit/maps/output/journal.h"

namespace lobefit {
namespace {

using Rows = std::vector<std::pair<std::size_t, std::size_t>>;

Rows Within(const Rows& ranges, std::size_t first, std::size_t end) {
  Rows within;
  for (const auto& [a, b] : ranges) {
    if (std::max(a, first) < std::min(b, end)) within.emplace_back(std::max(a, first), std::min(b, end));
  }
  return within;
}

// Kept in the journal: every shard and every rerun takes the same numbers.
SharedNumbers SharedNumbersOf(const Stack& stack, const MapsOptions& options, const FittedLights& lights,
                              const std::filesystem::path& file) {
  if (const std::optional<SharedNumbers> kept = ReadShared(file)) return *kept;
  SharedNumbers shared = EstimateShared(stack, options.recipe, lights, options.threads);
  WriteShared(shared, file);
  return shared;
}

void Count(const MapRows& rows, const std::vector<MapPlane>& planes, MapLobe lobe, MapsSummary* summary) {
  const std::size_t status = PlaneIndex(planes, MapPart::kQuality, "status");
  const std::size_t rms = PlaneIndex(planes, MapPart::kQuality, "rms"),
                    used = PlaneIndex(planes, MapPart::kQuality, "used");
  const std::size_t alpha = PlaneIndex(planes, MapPart::kParameters, WidestAlpha(lobe));
  for (std::size_t t = 0; t < rows.rows * rows.width; ++t) {
    const auto bits = static_cast<unsigned>(rows.values[status][t]);
    if ((bits & kMapOutside) != 0) continue;
    ++summary->texels;
    summary->too_few += (bits & kMapTooFew) != 0 ? 1 : 0;
    summary->no_lobe += (bits & kMapNoLobe) != 0 ? 1 : 0;
    summary->at_bound += (bits & kMapAtBound) != 0 ? 1 : 0;
    summary->not_converged += (bits & kMapNotConverged) != 0 ? 1 : 0;
    summary->normal += std::isfinite(rows.values[0][t]) ? 1 : 0;
    if (lobe != MapLobe::kNone && (bits & (kMapTooFew | kMapNoLobe)) == 0) ++summary->lobe;
    if (lobe != MapLobe::kNone && std::isfinite(rows.values[alpha][t])) ++summary->alpha;
    if (std::isfinite(rows.values[rms][t])) summary->mean_rms += static_cast<double>(rows.values[rms][t]);
    summary->mean_used += static_cast<double>(rows.values[used][t]);
  }
}

void WriteResults(const Stack& stack, const MapsOptions& options, const MapJournal& journal, const std::string& digest,
                  const std::string& command, MapsResult* result) {
  const std::vector<MapPlane> planes = PlanesFor(KindOf(options.recipe, stack));
  const std::filesystem::path stem = options.folder / options.name, exr = stem.string() + ".maps.exr";
  MapsSummary& summary = result->summary;
  WriteMapsExr(
      planes, stack.width, stack.height,
      [&](std::size_t first, std::size_t end) {
        MapRows rows = journal.Read(first, end);
        Count(rows, planes, options.recipe.rules.lobe, &summary);
        return rows;
      },
      exr);
  const auto texels = static_cast<double>(std::max<std::size_t>(summary.texels, 1));
  summary.mean_rms /= texels, summary.mean_used /= texels;
  result->written = {exr, stem.string() + ".maps.json"};
  WriteFileAtomically(result->written[1], MapsDocument(stack, options, *result, digest, command));
  for (const std::filesystem::path& path : WritePreviews(exr, stack.calibrated, options.normal_y, stem)) {
    result->written.push_back(path);
  }
}

}  // namespace

std::filesystem::path JournalFolder(const MapsOptions& options) {
  return options.folder / (options.name + ".maps.part");
}

MapsResult RunMaps(const Stack& stack, const MapsOptions& options, const std::string& command) {
  const FittedLights lights = LightsWithout(stack, options.left_out);
  const std::string digest = DigestOf(stack);
  std::string all = digest + RecipeText(options.recipe) + Version();
  for (const std::size_t light : options.left_out) all += fmt::format(" {}", light);
  const std::string key = Sha256Hex(all);
  const std::size_t planes = PlanesFor(KindOf(options.recipe, stack)).size();
  MapJournal journal(JournalFolder(options), key, stack.width, stack.height, planes);
  MapsResult result;
  const std::size_t first = options.rows ? options.rows->first : 0,
                    end = options.rows ? options.rows->second : stack.height;
  const std::filesystem::path shared_file = JournalFolder(options) / (key.substr(0, 16) + ".shared");
  const auto start = std::chrono::steady_clock::now();
  if (!options.merge || journal.Missing().empty()) {
    if (options.recipe.shares.Any()) result.shared = SharedNumbersOf(stack, options, lights, shared_file);
  }
  if (!options.merge) {
    const Rows missing = Within(journal.Missing(), first, end);
    for (const auto& [a, b] : missing) {
      for (std::size_t t = a * stack.width; t < b * stack.width; ++t) result.fitted_texels += stack.Holds(t) ? 1 : 0;
    }
    FitBands(stack, options.recipe, lights, result.shared, missing, options.threads,
             [&](const MapRows& band) { journal.Write(band); });
    journal.Refresh();
  }
  result.fit_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.missing = Within(journal.Missing(), 0, stack.height);
  result.complete = result.missing.empty();
  if (!result.complete || (options.rows && !options.merge)) return result;
  WriteResults(stack, options, journal, digest, command, &result);
  std::error_code ignored;
  std::filesystem::remove(shared_file, ignored);
  journal.Remove();
  return result;
}

}  // namespace lobefit
