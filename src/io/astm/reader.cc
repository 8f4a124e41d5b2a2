// ASTM E1392 / E2387 text: "KEY value" lines, the last of them VARS with the names of the columns, then rows separated
// by commas. Angles in radians in all files seen, though the format does not say; values are f_r in 1/sr without a
// cosine unless MEAS_NAME says otherwise.
#include "lobefit/io/astm/reader.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/io/text/units.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Header {
  std::vector<std::string> columns;
  std::size_t columns_line = 0;
  std::optional<std::size_t> points;
  std::size_t points_line = 0;
  std::string quantity;
  std::size_t quantity_line = 0;
};

struct Columns {
  std::optional<std::size_t> theta_i, phi_i, theta_s, phi_s;
  std::vector<std::size_t> values;
  Channels channels;
};

std::optional<std::size_t>* AngleColumn(const std::string& name, Columns* columns) {
  const std::string lower = ToLower(name);
  if (lower == "theta_i") return &columns->theta_i;
  if (lower == "phi_i") return &columns->phi_i;
  if (lower == "theta_s" || lower == "theta_r" || lower == "theta_o") return &columns->theta_s;
  if (lower == "phi_s" || lower == "phi_r" || lower == "phi_o") return &columns->phi_s;
  return nullptr;
}

// "465nm" gives 465.
std::optional<double> Wavelength(std::string_view name) {
  if (name.size() < 3 || name.substr(name.size() - 2) != "nm") return std::nullopt;
  const std::optional<double> wavelength = ParseDouble(name.substr(0, name.size() - 2));
  return wavelength && std::isfinite(*wavelength) && *wavelength > 0 ? wavelength : std::nullopt;
}

Columns SortColumns(const InputFile& file, const Header& header) {
  Columns columns;
  std::vector<double> wavelengths;
  for (std::size_t i = 0; i < header.columns.size(); ++i) {
    const std::string& name = header.columns[i];
    if (std::optional<std::size_t>* angle = AngleColumn(name, &columns)) {
      if (*angle) FailAtLine(file, header.columns_line, "VARS names the column '" + Excerpt(name) + "' twice");
      *angle = i;
      continue;
    }
    columns.values.push_back(i);
    columns.channels.names.push_back(name);
    if (const std::optional<double> wavelength = Wavelength(name)) wavelengths.push_back(*wavelength);
  }
  if (!columns.theta_i || !columns.theta_s || !columns.phi_s || columns.values.empty()) {
    FailAtLine(file, header.columns_line,
               "VARS is '" + Excerpt(Join(header.columns, ","), 60) +
                   "'; it needs theta_i, theta_s, phi_s (phi_i may be missing) and a value");
  }
  if (wavelengths.size() == columns.values.size()) columns.channels.wavelengths_nm = wavelengths;
  if (columns.values.size() == 1 && wavelengths.empty()) columns.channels.names = {"Y"};
  return columns;
}

// The lines up to VARS.
Header ReadHeader(const InputFile& file, LineReader* lines) {
  Header header;
  std::string_view line;
  while (lines->Next(&line)) {
    const std::vector<std::string_view> words = SplitBlanks(line);
    if (words.empty()) continue;
    const std::string_view value = Trim(Trim(line).substr(words[0].size()));
    if (words[0] == "VARS") {
      for (const std::string_view name : Split(value, ',')) header.columns.emplace_back(Trim(name));
      header.columns_line = lines->line_number();
      return header;
    }
    if (words[0] == "NUM_POINTS") {
      const std::optional<long long> points = ParseInteger(value);
      if (!points || *points < 0) {
        FailAtLine(file, lines->line_number(), "NUM_POINTS is '" + Excerpt(value) + "'; a count is needed");
      }
      header.points = static_cast<std::size_t>(*points);
      header.points_line = lines->line_number();
    } else if (words[0] == "MEAS_NAME") {
      header.quantity = std::string(value);
      header.quantity_line = lines->line_number();
    }
  }
  FailAtLine(
      file, std::max<std::size_t>(lines->line_number(), 1),
      "the file ends without the line VARS that names the columns, as in 'VARS theta_i,phi_i,theta_s,phi_s,R,G,B'");
}

struct Quantity {
  ValueKind kind;
  const char* source;
};

Quantity QuantityOf(const InputFile& file, const Header& header, const ReadOptions& options) {
  if (options.value_kind) return {*options.value_kind, ""};
  const std::string name = ToLower(header.quantity);
  if (name == "btdf") {
    FailAtLine(file, header.quantity_line, "MEAS_NAME is BTDF, transmission; only reflection can be fitted");
  }
  if (name == "dsf") return {ValueKind::kBrdfCosO, " (header)"};
  if (name == "brdf" || name == "bsdf") return {ValueKind::kBrdf, " (header)"};
  return {ValueKind::kBrdf, " (default)"};
}

}  // namespace

bool IsAstm(std::string_view bytes) {
  LineReader lines(Head(bytes));
  std::string_view line;
  while (lines.Next(&line)) {
    const std::vector<std::string_view> words = SplitBlanks(line);
    if (!words.empty() && words[0] == "VARS") return true;
    if (!words.empty() && (words[0] == "NUM_POINTS" || words[0] == "LAB_NAME" || words[0] == "MEAS_NAME")) return true;
  }
  return false;
}

Measurement ReadAstm(const InputFile& file, const ReadOptions& options) {
  LineReader lines(file.bytes);
  const Header header = ReadHeader(file, &lines);
  const Columns columns = SortColumns(file, header);
  const Quantity quantity = QuantityOf(file, header, options);
  const AngleUnit unit = options.angle_unit.value_or(AngleUnit::kRadians);
  const double to_radians = RadiansPerUnit(unit);
  const IncidentSense sense = options.incident_sense.value_or(IncidentSense::kTowardsSource);
  const double turn = sense == IncidentSense::kPropagation ? kPi : 0;

  MeasurementBuilder builder(columns.channels);
  std::vector<double> values(columns.values.size());
  std::size_t rows = 0;
  std::string_view line;
  while (lines.Next(&line)) {
    if (Trim(line).empty()) continue;
    const std::size_t at = lines.line_number();
    const std::vector<std::string_view> fields = Split(line, ',');
    if (fields.size() != header.columns.size()) {
      FailAtLine(file, at,
                 "has " + std::to_string(fields.size()) + " fields; VARS in line " +
                     std::to_string(header.columns_line) + " names " + std::to_string(header.columns.size()) +
                     " columns, separated by commas");
    }
    const auto angle = [&](std::optional<std::size_t> column, bool polar) {
      if (!column) return 0.0;
      const double radians = to_radians * FiniteNumberAt(file, at, fields[*column], header.columns[*column]);
      if (std::fabs(radians) > (polar ? kPi : 2 * kPi) + 1e-5) {
        FailAtLine(file, at,
                   header.columns[*column] + " is " + std::string(Trim(fields[*column])) + ", beyond " +
                       (polar ? "a half" : "a full") + " turn in " +
                       (unit == AngleUnit::kRadians ? "radians; for degrees use --angle-unit deg" : Name(unit)));
      }
      return radians;
    };
    // A negative theta_s is the far side of a scan in one plane: FromSpherical turns it by half a turn.
    const Vec3 wi = FromSpherical(angle(columns.theta_i, true), angle(columns.phi_i, false) + turn);
    const Vec3 wo = FromSpherical(angle(columns.theta_s, true), angle(columns.phi_s, false));
    const double factor = BrdfFactor(quantity.kind, wi.z, wo.z);
    for (std::size_t c = 0; c < values.size(); ++c) {
      values[c] = factor * NumberAt(file, at, fields[columns.values[c]], header.columns[columns.values[c]]);
    }
    builder.Add(wi, wo, values.data(), static_cast<std::uint32_t>(at));
    ++rows;
  }
  if (header.points && rows < *header.points) {
    FailAtLine(file, std::max<std::size_t>(lines.line_number(), 1),
               "the file ends after " + std::to_string(rows) + " rows, but NUM_POINTS in line " +
                   std::to_string(header.points_line) + " announces " + std::to_string(*header.points) +
                   "; it is cut off: fetch it again or correct the count");
  }
  Measurement measurement = builder.Finish();
  measurement.isotropic = !columns.phi_i;
  measurement.conventions["angle-unit"] = Name(unit) + (options.angle_unit ? "" : " (default)");
  measurement.conventions["value-kind"] = Name(quantity.kind) + quantity.source;
  measurement.conventions["incident"] = std::string(sense == IncidentSense::kPropagation ? "propagation" : "towards") +
                                        (options.incident_sense ? "" : " (default)");
  if (header.points && rows > *header.points) {
    measurement.remarks.push_back("NUM_POINTS announces " + std::to_string(*header.points) + " rows, but there are " +
                                  std::to_string(rows));
  }
  return measurement;
}

}  // namespace lobefit
