#include "lobefit/io/read.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <future>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/no_value.h"
#include "lobefit/io/csv/reader.h"
#include "lobefit/io/formats.h"
#include "lobefit/io/text/decoded_file.h"
#include "lobefit/io/wrong_kind.h"
#include "lobefit/measurement/checks/plausibility.h"
#include "lobefit/measurement/prepare/exclusion.h"
#include "lobefit/measurement/prepare/incomplete.h"
#include "lobefit/measurement/prepare/noise.h"
#include "lobefit/measurement/spectrum.h"

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

void RequireSamples(const std::string& name, const Measurement& measurement,
                    const char* advice = "check that the right file was named and that its units are stated") {
  if (measurement.samples.size() > 0) return;
  std::vector<std::string> reasons;
  for (int i = 0; i < kSetAsideReasons; ++i) {
    const auto reason = static_cast<SetAsideReason>(i);
    const std::size_t count = measurement.set_aside[reason];
    if (count > 0) reasons.push_back(std::to_string(count) + " " + std::string(Words(reason)));
  }
  throw InputError(name + ": holds no usable sample" +
                   (reasons.empty() ? std::string(": it has no data rows") : ": " + Join(reasons)) + "; " + advice);
}

// Keys behind the name of a file whose format has none of its own: how the sample was turned.
void TakeKeys(const std::vector<std::string>& keys, Measurement* measurement) {
  for (const std::string& key : keys) {
    const std::size_t at = key.find('=');
    const std::string name = ToLower(Trim(std::string_view(key).substr(0, at)));
    std::string_view word = at == std::string::npos ? std::string_view() : Trim(std::string_view(key).substr(at + 1));
    if (word.ends_with("deg")) word.remove_suffix(3);
    const std::optional<double> degrees = ParseDouble(word);
    if ((name != "sample-rotation" && name != "sample_rotation") || !degrees || !std::isfinite(*degrees)) {
      throw UsageError(measurement->source + ":" + Excerpt(key) + ": of a " + measurement->format +
                       " file only sample-rotation=DEGREES can be stated behind its name");
    }
    // The sample turned counter-clockwise sees both directions turned clockwise.
    Samples& samples = measurement->samples;
    const double c = std::cos(DegreesToRadians(*degrees)), s = std::sin(DegreesToRadians(*degrees));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3 wi = samples.wi(i), wo = samples.wo(i);
      samples.wi_x[i] = c * wi.x + s * wi.y;
      samples.wi_y[i] = c * wi.y - s * wi.x;
      samples.wo_x[i] = c * wo.x + s * wo.y;
      samples.wo_y[i] = c * wo.y - s * wo.x;
    }
    measurement->samples.sample_azimuth.assign(measurement->samples.size(), DegreesToRadians(*degrees));
    measurement->conventions["sample-rotation"] = FormatDouble(*degrees) + " deg (behind the file's name)";
  }
}

// Numbers that stand for no value, of formats whose reader does not know the option.
void MarkNoValues(const std::string& list, Measurement* measurement) {
  if (list.empty()) return;
  const NoValues marks(list);
  Samples& samples = measurement->samples;
  for (std::vector<double>& values : samples.values) {
    for (double& value : values) {
      if (marks.Holds(value)) value = std::nan("");
    }
  }
  std::vector<std::uint8_t> keep(samples.size(), 0);
  std::size_t holes = samples.size();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (const std::vector<double>& values : samples.values) keep[i] |= std::isnan(values[i]) ? 0 : 1;
    holes -= keep[i];
    if (keep[i] == 0) measurement->LeaveOut(samples.wi(i), samples.wo(i), LeftOutReason::kNoValue);
  }
  measurement->set_aside.Add(SetAsideReason::kHole, holes);
  samples.Keep(keep);
}

// Of text that is read line by line; XML and JSON may be one line, and binary files have none.
void RequireLines(const InputFile& file) {
  constexpr std::size_t kMostLine = std::size_t{4} << 20;
  const std::string_view head = Trim(file.bytes.substr(0, 4096));
  if (file.bytes.size() <= kMostLine || head.empty() || head.front() == '<' || head.front() == '{' ||
      head.front() == '[' || head.find('\0') != std::string_view::npos)
    return;
  // From the last line that ends within the limit to the next: lines in between are shorter and not looked at.
  for (std::size_t begin = 0; file.bytes.size() - begin > kMostLine;) {
    const std::size_t last = file.bytes.substr(begin, kMostLine + 1).rfind('\n');
    if (last == std::string_view::npos) {
      const auto line =
          1 + std::count(file.bytes.begin(), file.bytes.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
      const std::size_t end = std::min(file.bytes.find('\n', begin), file.bytes.size());
      throw InputError(file.path.string() + ": line " + std::to_string(line) + ": has " + std::to_string(end - begin) +
                       " bytes; at most " + std::to_string(kMostLine) +
                       " are read: is it text with the ends of its lines lost, or another kind of file?");
    }
    begin += last + 1;
  }
}

// Prose with a table, which may name angles.
bool IsProse(const std::filesystem::path& path) {
  return ToLower(path.filename().string()).starts_with("readme") || ToLower(path.extension().string()) == ".md";
}

}  // namespace

const Format& RecogniseFormat(const InputFile& file) {
  const std::string wrong_kind = DescribeWrongKind(file.bytes);
  if (!wrong_kind.empty()) throw InputError(file.path.string() + ": " + wrong_kind);
  RequireLines(file);
  if (file.bytes.empty()) {
    throw InputError(file.path.string() +
                     ": is empty (0 bytes); name a file that holds a measurement. Known formats: " + KnownFormats());
  }
  const std::string_view begin = Trim(file.bytes.substr(0, 64));
  const bool json = begin.starts_with('{') || (begin.starts_with('[') && Trim(begin.substr(1)).starts_with('{'));
  for (const Format& format : Formats()) {
    if (!format.recognise(file.bytes)) continue;
    if (!json || format.name != std::string_view("csv")) return format;
    throw InputError(file.path.string() +
                     ": is JSON of a kind that is not known (read are BRDF files of BiRD and of ASAM OpenMATERIAL 3D); "
                     "write its rows as CSV with a line of names");
  }
  throw InputError(file.path.string() + ": is not in a format that can be read; it begins with '" +
                   Excerpt(file.bytes.substr(0, file.bytes.find('\n')), 24) + "' and has " +
                   std::to_string(file.bytes.size()) + " bytes. Known formats: " + KnownFormats());
}

bool HoldsMeasurement(const std::filesystem::path& path, bool any_rows) {
  try {
    const DecodedFile file(path);
    try {
      const InputFile input = {path, file.bytes()};
      if (RecogniseFormat(input).name != std::string_view("csv")) return true;
      return !IsProse(path) && (any_rows || NamesDirections(input));
    } catch (const InputError&) {
      return false;
    }
  } catch (const InputError&) {
    return true;
  }
}

ReadOptions WithKeys(ReadOptions options, const std::vector<std::string>& keys) {
  options.keys = keys;
  return options;
}

Measurement ReadPart(const std::filesystem::path& path, const ReadOptions& options) {
  const DecodedFile decoded(path);
  const InputFile file = {path, decoded.bytes()};
  const Format& format = RecogniseFormat(file);
  const bool aside = decoded.stored().size() >= kHashAsideBytes && HardwareThreads() > 1;
  const auto policy = aside ? std::launch::async : std::launch::deferred;
  std::future<std::string> digest = std::async(policy, [&] { return Sha256Hex(decoded.stored()); });
  Measurement measurement = format.read(file, options);
  measurement.format = format.name;
  measurement.source = path.filename().string();
  measurement.sha256 = digest.get();
  measurement.remarks.insert(measurement.remarks.begin(), decoded.remarks().begin(), decoded.remarks().end());
  if (measurement.format != "csv") {
    TakeKeys(options.keys, &measurement);
    MarkNoValues(options.no_value, &measurement);
  }
  RequireSamples(path.string(), measurement);
  return measurement;
}

Measurement FinishReading(Measurement measurement, const ReadOptions& options) {
  if (!options.channels.empty() && options.channels != "all")
    Apply(MakeChannelMap(options.channels, measurement.channels), &measurement);
  DropIncomplete(&measurement);
  // Readers give samples that have a value in one channel at least.
  RequireSamples(measurement.source, measurement, "choose channels that were measured with --channels");
  const auto stated = measurement.conventions.find("exclude");
  const std::string exclude = !options.exclude.empty()                  ? options.exclude
                              : stated != measurement.conventions.end() ? stated->second
                                                                        : "";
  if (!exclude.empty()) {
    Apply(ParseExclusions(exclude), &measurement);
    measurement.conventions["exclude"] = exclude + (options.exclude.empty() ? " (header)" : " (option)");
  }
  TreatNoise(options, &measurement);
  for (std::string& remark : FindImplausible(measurement)) measurement.remarks.push_back(std::move(remark));
  return measurement;
}

Measurement ReadMeasurement(const std::filesystem::path& path, const ReadOptions& options) {
  return FinishReading(ReadPart(path, options), options);
}

}  // namespace lobefit
