// FRED tabular scatter text: "type bsdf_data", a format line, then for each incidence a line "theta_i phi_i" followed
// by lines "theta_s phi_s value". Values are f_r in 1/sr without a cosine, or their decimal logarithms (bsdf=log); with
// angles=sin the polar angles are given by their sines, the azimuths in degrees. The incident azimuth is that of the
// propagation in the files that are around: the specular direction has the azimuth of its incidence.
#include "lobefit/io/fred/reader.h"

#include <cmath>
#include <string>
#include <vector>

#include "lobefit/io/text/place.h"
#include "lobefit/io/text/units.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct FormatLine {
  AngleUnit unit = AngleUnit::kDegrees;
  bool sines = false, logarithms = false;
  double scale = 1;
};

FormatLine ParseFormatLine(const InputFile& file, std::size_t line_number,
                           const std::vector<std::string_view>& fields) {
  FormatLine format;
  for (std::size_t i = 1; i < fields.size(); ++i) {
    const std::vector<std::string_view> pair = Split(fields[i], '=');
    const std::string key = ToLower(pair[0]);
    const std::string value = pair.size() == 2 ? ToLower(pair[1]) : "";
    if (key == "angles" && (value == "deg" || value == "rad")) {
      format.unit = value == "deg" ? AngleUnit::kDegrees : AngleUnit::kRadians;
    } else if (key == "angles" && value == "sin") {
      format.sines = true;
    } else if (key == "bsdf" && (value == "value" || value == "log")) {
      format.logarithms = value == "log";
    } else if (key == "scale" && pair.size() == 2) {
      format.scale = FiniteNumberAt(file, line_number, pair[1], "scale");
    } else {
      FailAtLine(file, line_number,
                 "the format line has '" + Excerpt(fields[i]) +
                     "', which is not known; allowed are angles=deg, angles=rad, "
                     "angles=sin, bsdf=value, bsdf=log and scale=NUMBER");
    }
  }
  return format;
}

}  // namespace

bool IsFred(std::string_view bytes) {
  LineReader lines(Head(bytes));
  std::string_view line;
  while (lines.Next(&line)) {
    const std::vector<std::string_view> fields = SplitBlanks(line);
    if (fields.empty() || fields[0].substr(0, 1) == "#" || fields[0].substr(0, 2) == "!!") continue;
    return fields.size() == 2 && ToLower(fields[0]) == "type" && ToLower(fields[1]) == "bsdf_data";
  }
  return false;
}

Measurement ReadFred(const InputFile& file, const ReadOptions& options) {
  const IncidentSense sense = options.incident_sense.value_or(IncidentSense::kPropagation);
  const double turn = sense == IncidentSense::kPropagation ? kPi : 0;
  MeasurementBuilder builder({{"Y"}, {}});
  FormatLine format;
  std::vector<std::string> comments;
  bool has_type = false, has_format = false, has_incidence = false;
  double to_radians = 1;
  Vec3 wi = {0, 0, 1};
  LineReader lines(file.bytes);
  std::string_view line;
  while (lines.Next(&line)) {
    const std::vector<std::string_view> fields = SplitBlanks(line);
    if (fields.empty()) continue;
    if (fields[0].starts_with('#') || fields[0].starts_with("!!")) {
      comments.emplace_back(Trim(Trim(line).substr(fields[0].starts_with('#') ? 1 : 2)));
      continue;
    }
    const std::size_t at = lines.line_number();
    if (!has_type) {
      if (fields.size() != 2 || ToLower(fields[0]) != "type" || ToLower(fields[1]) != "bsdf_data") {
        FailAtLine(file, at, "a FRED table begins with 'type bsdf_data', but here stands '" + Excerpt(line) + "'");
      }
      has_type = true;
      continue;
    }
    if (!has_format) {
      if (ToLower(fields[0]) != "format") {
        FailAtLine(file, at,
                   "'" + Excerpt(line) +
                       "' stands where the format line should; write 'format angles=deg "
                       "bsdf=value scale=1' if that is what the numbers are");
      }
      format = ParseFormatLine(file, at, fields);
      to_radians = RadiansPerUnit(format.unit);
      has_format = true;
      continue;
    }
    if (fields.size() != 2 && fields.size() != 3) {
      FailAtLine(file, at,
                 "has " + std::to_string(fields.size()) +
                     " fields; allowed are 2 (theta_i phi_i, a new "
                     "incidence) or 3 (theta_s phi_s value)");
    }
    const char* polar = fields.size() == 2 ? "theta_i" : "theta_s";
    const double number = FiniteNumberAt(file, at, fields[0], polar);
    if (format.sines && std::fabs(number) > 1) {
      FailAtLine(file, at,
                 std::string(polar) + " is " + Excerpt(fields[0]) + ", but the format line says that it is a sine");
    }
    const double theta = format.sines ? std::asin(number) : to_radians * number;
    const double phi = to_radians * FiniteNumberAt(file, at, fields[1], fields.size() == 2 ? "phi_i" : "phi_s");
    if (std::fabs(theta) > kPi + 1e-6) {
      FailAtLine(file, at,
                 "the polar angle '" + Excerpt(fields[0]) +
                     "' is beyond a half turn; check the unit in the "
                     "format line");
    }
    if (fields.size() == 2) {
      wi = FromSpherical(theta, phi + turn);
      has_incidence = true;
      continue;
    }
    if (!has_incidence) {
      FailAtLine(file, at, "a row theta_s phi_s value stands before the first line theta_i phi_i; add the incidence");
    }
    const double stated = NumberAt(file, at, fields[2], "value");
    const double value = format.scale * (format.logarithms ? std::pow(10.0, stated) : stated);
    builder.Add(wi, FromSpherical(theta, phi), &value, static_cast<std::uint32_t>(at));
  }
  if (!has_format) {
    FailAtLine(file, std::max<std::size_t>(lines.line_number(), 1),
               "the file ends before its format line ('format angles=deg bsdf=value scale=1'); it may be cut off");
  }
  Measurement measurement = builder.Finish();
  measurement.comments = std::move(comments);
  measurement.conventions["angle-unit"] = format.unit == AngleUnit::kDegrees ? "deg (header)" : "rad (header)";
  measurement.conventions["value-kind"] = "f (header)";
  measurement.conventions["incident"] = std::string(sense == IncidentSense::kPropagation ? "propagation" : "towards") +
                                        (options.incident_sense ? "" : " (default)");
  if (format.scale != 1) measurement.conventions["scale"] = FormatDouble(format.scale) + " (header)";
  return measurement;
}

}  // namespace lobefit
