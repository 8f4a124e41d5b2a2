#include "lobefit/maps/textures/export_maps.h"

#include <chrono>
#include <set>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/base/text/text.h"
#include "lobefit/base/version.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/meter.h"

namespace lobefit {
namespace {

constexpr std::size_t kJudgedTexels = 1000;

std::vector<std::string> Remarks(const MapNumbers& numbers) {
  std::vector<std::string> remarks;
  const FilledTexels& filled = numbers.filled();
  std::vector<std::string> words;
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) words.push_back(fmt::format("{} in {} texels", what, count));
  };
  add(filled.normal, "the normal"), add(filled.diffuse, "diffuse"), add(filled.f0, "F0"),
      add(filled.width, "the width");
  if (!words.empty()) {
    remarks.push_back(fmt::format(
        "not determined of {} texels and filled with the median of the determined texels around (blocks of 16 x 16, "
        "larger where they hold fewer than 8): {}",
        numbers.inside(), Join(words)));
  }
  const std::size_t outside = numbers.width() * numbers.height() - numbers.inside();
  if (outside > 0) remarks.push_back(fmt::format("{} texels outside the mask are black", outside));
  if (!numbers.schlick()) {
    remarks.push_back(
        fmt::format("the stack is not calibrated: diffuse and F0 are divided by {:.4g} (--white; by itself the 99.5th "
                    "percentile of "
                    "the largest channel of diffuse + F0), and the fit has no Fresnel term: what a target's own adds "
                    "towards grazing "
                    "counts as its error",
                    numbers.white()));
  }
  return remarks;
}

std::vector<std::string> Header(const ExportOptions& options, const ExportResult& result,
                                const std::vector<std::string>& remarks) {
  std::vector<std::string> lines = {
      fmt::format("{}: exported by lobefit {} from {}", options.name, Version(), options.material_file),
      fmt::format("command: {}", options.command),
      fmt::format("error relative to the maps' f_r: {}", ErrorWords(result.error))};
  lines.insert(lines.end(), remarks.begin(), remarks.end());
  AddLosses(result.carries, &lines);
  return lines;
}

// The pictures of one target; `done` holds those that another has written. Returns the files of this target.
std::vector<std::filesystem::path> WriteTextures(const std::vector<Texture>& textures, const MapNumbers& numbers,
                                                 const ExportOptions& options, std::set<std::string>* done) {
  std::vector<std::filesystem::path> files;
  for (const Texture& texture : textures) {
    files.push_back(options.folder / (options.name + texture.ending));
    if (done->insert(texture.ending).second) WriteFileAtomically(files.back(), EncodeTexture(texture, numbers));
  }
  return files;
}

}  // namespace

ExportOutcome ExportMaps(const Maps& maps, const MapsRecord& record, const std::filesystem::path& maps_file,
                         const ExportOptions& options, const MapsExportOptions& more) {
  ExportOutcome outcome;
  std::vector<std::string> can;
  for (const MapTarget& target : MapTargets()) can.emplace_back(target.name);
  for (const Target* target : options.targets) {
    if (FindMapTarget(target->name) == nullptr) {
      outcome.refusals.push_back({target, "it takes one material, and these are maps of many"});
    }
  }
  if (outcome.refusals.size() == options.targets.size()) {
    throw InputError(
        fmt::format("{}: {}; targets that can: {}", options.material_file, RefusalText(outcome.refusals), Join(can)));
  }
  if (maps.lobe == MapLobe::kEllipsoid) {
    throw InputError(
        options.material_file +
        ": lobes that lean over their normals; no renderer's textures hold that: fit ggx-anisotropic-maps, whose "
        "normal is free, to the same stack");
  }
  const MapNumbers numbers(maps, record.calibrated, more.white);
  outcome.remarks = Remarks(numbers);
  MakeFolder(options.folder);
  std::set<std::string> done;
  Progress progress("exporting", options.targets.size());
  for (const Target* target : options.targets) {
    const auto start = std::chrono::steady_clock::now();
    progress.Advance();
    const MapTarget* map_target = FindMapTarget(target->name);
    if (map_target == nullptr) continue;
    ExportResult result;
    result.target = target;
    result.numbers = "copied";
    result.load = LoadText({.load = map_target->load}, options.name);
    result.carries = map_target->carries(numbers);
    result.error = ErrorOfTarget(*map_target, numbers, kJudgedTexels, options.threads);
    result.files = WriteTextures(map_target->textures(numbers), numbers, options, &done);
    const std::filesystem::path document = map_target->write(
        numbers, {options.folder, options.name, Header(options, result, outcome.remarks), options.map_path});
    result.files.insert(result.files.begin(), document);
    for (const std::filesystem::path& file : result.files) result.bytes += std::filesystem::file_size(file);
    result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.results.push_back(std::move(result));
  }
  if (more.normal_y == NormalY::kDown) WriteTextures({NormalTexture(true)}, numbers, options, &done);
  const std::string digest = Sha256Hex(FileBytes(maps_file).bytes());
  WriteFileAtomically(options.folder / (options.name + ".export.json"),
                      ExportJson({"maps", digest, record.stack}, options, outcome));
  return outcome;
}

}  // namespace lobefit
