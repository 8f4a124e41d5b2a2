// Reading a measurement file: the format is recognised by content, what the file leaves open is filled by options.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

enum class AngleUnit { kDegrees, kRadians };
// What the file's numbers are: f_r; f_r times the cosine of wo or of wi; pi f_r (reflectance factor); radiant intensity per
// incident flux, which is f_r cos(theta_o) too but per irradiance of the whole sample.
enum class ValueKind { kBrdf, kBrdfCosO, kBrdfCosI, kReflectanceFactor, kIntensity };
// Whether the file's incident direction points to the source (as here) or along the propagation of the light.
enum class IncidentSense { kTowardsSource, kPropagation };
enum class CellPosition { kCentre, kEdge };

// What files do not say and formats disagree on. Unset: the format's documented default, or what the file's header says. Every
// choice that a reader makes is echoed in Measurement::conventions under the option's name on the command line.
struct ReadOptions {
  std::optional<AngleUnit> angle_unit;          // --angle-unit deg|rad          (csv)
  std::optional<ValueKind> value_kind;          // --value-kind f|f-cos-o|f-cos-i|pi-f|intensity   (csv)
  std::optional<IncidentSense> incident_sense;  // --incident towards|propagation (csv)
  std::optional<std::string> value_column;      // --value-column NAME            (csv with several candidate columns)
  CellPosition merl_cell = CellPosition::kCentre;  // --merl-cell centre|edge      (merl)
};

// An input file as the readers see it: its name for messages and its bytes.
struct InputFile {
  std::filesystem::path path;
  std::string_view bytes;
};

// One file format. `recognise` looks at content only, never at the name; `read` throws InputError with the place in the file.
struct Format {
  const char* name;
  const char* description;
  bool (*recognise)(std::string_view bytes);
  Measurement (*read)(const InputFile& file, const ReadOptions& options);
};

// The reader that recognises the bytes. Throws InputError that lists the known formats.
const Format& RecogniseFormat(const InputFile& file);

// Maps, recognises and reads a file; sets Measurement::format, source and sha256. Throws InputError for a file that cannot be read, is
// not valid, or has no usable sample.
Measurement ReadMeasurement(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace lobefit
