#include "lobefit/io/read.h"

#include <cstdio>
#include <future>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/io/formats.h"
#include "lobefit/measurement/noise.h"

namespace lobefit {
namespace {

// Digests below this size take less time than starting a thread.
constexpr std::size_t kHashAsideBytes = std::size_t{1} << 20;

std::string KnownFormats() {
  std::vector<std::string> lines;
  for (const Format& format : Formats()) lines.push_back(std::string(format.name) + " (" + format.description + ")");
  return Join(lines, "; ");
}

void TreatNoise(const ReadOptions& options, Measurement* measurement) {
  if (options.noise_floor) {
    AddNoiseFloor(*options.noise_floor, &measurement->samples);
    measurement->conventions["noise-floor"] = FormatDouble(*options.noise_floor) + " (option)";
    return;
  }
  // Tables with cells of known size are computed from readings; rows of a goniometer are readings.
  if (!measurement->samples.solid_angle.empty()) return;
  const std::optional<RectifiedNoise> noise = FindRectifiedNoise(*measurement);
  if (!noise) return;
  char floor[32];
  std::snprintf(floor, sizeof(floor), "%.2g", noise->floor);
  measurement->remarks.push_back(
      "rectified noise: where readings f cos(theta_i) are near " + std::string(floor) +
      " their scatter is as large as they are, but none is negative; " + std::to_string(noise->samples_below) +
      " samples are below three times that. --noise-floor " + floor + " lets them weigh less");
}

}  // namespace

const Format& RecogniseFormat(const InputFile& file) {
  if (file.bytes.empty()) {
    throw InputError(file.path.string() +
                     ": is empty (0 bytes); name a file that holds a measurement. Known formats: " + KnownFormats());
  }
  for (const Format& format : Formats()) {
    if (format.recognise(file.bytes)) return format;
  }
  throw InputError(file.path.string() + ": is not in a format that can be read; it begins with '" +
                   Excerpt(file.bytes.substr(0, file.bytes.find('\n')), 24) + "' and has " +
                   std::to_string(file.bytes.size()) + " bytes. Known formats: " + KnownFormats());
}

Measurement ReadMeasurement(const std::filesystem::path& path, const ReadOptions& options) {
  const MappedFile mapped(path);
  const InputFile file = {path, mapped.bytes()};
  const Format& format = RecogniseFormat(file);
  const auto policy = file.bytes.size() >= kHashAsideBytes ? std::launch::async : std::launch::deferred;
  std::future<std::string> digest = std::async(policy, [&] { return Sha256Hex(file.bytes); });
  Measurement measurement = format.read(file, options);
  measurement.format = format.name;
  measurement.source = path.filename().string();
  measurement.sha256 = digest.get();
  if (measurement.samples.size() == 0) {
    std::vector<std::string> reasons;
    for (int i = 0; i < kSetAsideReasons; ++i) {
      const auto reason = static_cast<SetAsideReason>(i);
      const std::size_t count = measurement.set_aside[reason];
      if (count > 0) reasons.push_back(std::to_string(count) + " " + std::string(Words(reason)));
    }
    throw InputError(path.string() + ": holds no usable sample" +
                     (reasons.empty() ? std::string(": it has no data rows") : ": " + Join(reasons)) +
                     "; check that the right file was named and that its units are stated");
  }
  TreatNoise(options, &measurement);
  return measurement;
}

}  // namespace lobefit
