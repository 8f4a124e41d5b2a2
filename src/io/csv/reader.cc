// Rows of a goniometer with named columns. What the columns mean: csv_columns.h; keys of the head: csv_header.h.
//
// Angles: polar from +z, azimuth counter-clockwise from +x seen from +z. A negative polar angle is the other side:
// theta < 0 stands for |theta| at phi + 180 degrees. Without azimuths the rows lie in one plane with signed angles: the
// light stands at azimuth 0 and the receiver on the mirror side, so that theta_o = theta_i is the specular direction
// and theta_o = -theta_i the light's own. With azimuth, incidence and receive (three-axis instruments) the azimuth is
// that of the receiver's plane, counted so that at 90 degrees a positive receive angle lies on the light's side; the
// light is at azimuth 0, so phi_o = azimuth - 90 degrees.
#include "lobefit/io/csv/reader.h"

#include <cmath>
#include <optional>
#include <utility>

#include "lobefit/base/plain_decimal.h"
#include "lobefit/base/text.h"
#include "lobefit/io/csv/header.h"
#include "lobefit/io/csv/layout.h"
#include "lobefit/io/csv/wavelengths.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/measurement/noise.h"
#include "lobefit/measurement/repeats.h"

namespace lobefit {
namespace {

// Sine and cosine of an angle in the file's unit; rows of a goniometer repeat their angles, so the last one is kept.
class AngleCache {
 public:
  explicit AngleCache(double radians_per_unit = 1) : scale_(radians_per_unit) {}

  void Set(double angle) {
    if (angle == angle_) return;
    angle_ = angle;
    const double radians = angle * scale_;
    sin_ = std::sin(radians);
    cos_ = std::cos(radians);
  }
  double sin() const { return sin_; }
  double cos() const { return cos_; }

 private:
  double scale_;
  double angle_ = 0, sin_ = 0, cos_ = 1;
};

class CsvReader {
 public:
  CsvReader(const InputFile& file, const ReadOptions& options) : file_(file), options_(options) {}

  Measurement Read() {
    header_ = ReadCsvHeader(file_);
    Measurement notes;
    layout_ = ReadCsvLayout(file_, header_, options_, &notes);
    ChooseUnits(&notes);
    if (layout_.wavelength != kNoColumn && layout_.values.size() != 1) {
      FailAtLine(
          file_, header_.names_line,
          "a wavelength column goes with one column of values, but there are " + std::to_string(layout_.values.size()));
    }
    if (layout_.wavelength != kNoColumn) {
      by_wavelength_.emplace(HasSigmas()    ? WavelengthTable::Weights::kSigma
                             : HasWeights() ? WavelengthTable::Weights::kWeight
                                            : WavelengthTable::Weights::kNone,
                             options_.repeated == RepeatedRows::kMean);
    }
    MeasurementBuilder builder(layout_.channels);
    fields_.resize(header_.columns.size());
    ReadRows(&builder);
    if (by_wavelength_) {
      MeasurementBuilder pivoted(by_wavelength_->ChannelNames());
      pivoted.measurement().set_aside = builder.measurement().set_aside;
      by_wavelength_->MoveTo(&pivoted);
      return Finish(&pivoted, notes);
    }
    return Finish(&builder, notes);
  }

 private:
  Measurement Finish(MeasurementBuilder* builder, const Measurement& notes) const {
    std::vector<std::string> remarks = notes.remarks;
    Samples& rows = builder->measurement().samples;
    if (options_.repeated == RepeatedRows::kMean) {
      // The spread of the repetitions stands for the stated uncertainty.
      if (HasSigmas()) rows.weight.clear();
      const Repeats repeats = MergeRepeated(&builder->measurement());
      remarks.push_back(std::to_string(repeats.samples) + " repeated rows were merged to " +
                        std::to_string(repeats.pairs) + "; a row scatters by " +
                        FormatDouble(std::round(1000 * repeats.relative_spread) / 10) + " % of its mean");
    }
    Measurement measurement = builder->Finish();
    if (HasSigmas() && options_.repeated == RepeatedRows::kFirst) {
      const std::vector<double> sigma = std::exchange(measurement.samples.weight, {});
      AddSigma(sigma, &measurement.samples);
    }
    if (measurement.set_aside[SetAsideReason::kDuplicate] > 0) {
      remarks.emplace_back("directions occur again; --repeated mean averages their rows instead of keeping the first");
    }
    measurement.conventions = notes.conventions;
    measurement.conventions["repeated"] =
        options_.repeated == RepeatedRows::kMean ? "mean (option)" : "first (default)";
    measurement.remarks = std::move(remarks);
    measurement.isotropic = layout_.delta_phi != kNoColumn && layout_.phi_i == kNoColumn;
    ScaleToMeanOne(&measurement.samples.weight);
    return measurement;
  }

  void ChooseUnits(Measurement* notes) {
    AngleUnit default_unit = AngleUnit::kDegrees;
    std::string origin = "default";
    if (header_.angle_unit) {
      default_unit = *header_.angle_unit;
      origin = "header";
    }
    if (options_.angle_unit) {
      default_unit = *options_.angle_unit;
      origin = "option";
    }
    bool by_name = false;
    const auto cache_for = [&](std::size_t column) {
      AngleUnit unit = default_unit;
      if (column != kNoColumn && header_.columns[column].angle_unit && !options_.angle_unit) {
        unit = *header_.columns[column].angle_unit;
        by_name = true;
      }
      return AngleCache(unit == AngleUnit::kDegrees ? kPi / 180 : 1.0);
    };
    theta_i_ = cache_for(layout_.theta_i);
    theta_o_ = cache_for(layout_.theta_o);
    phi_i_ = cache_for(layout_.phi_i);
    phi_o_ = cache_for(layout_.phi_o != kNoColumn       ? layout_.phi_o
                       : layout_.delta_phi != kNoColumn ? layout_.delta_phi
                                                        : layout_.azimuth);
    notes->conventions["angle-unit"] =
        by_name ? "by column names" : std::string(Name(default_unit)) + " (" + origin + ")";

    const IncidentSense sense =
        options_.incident_sense.value_or(header_.incident_sense.value_or(IncidentSense::kTowardsSource));
    flip_incident_ = sense == IncidentSense::kPropagation;
    notes->conventions["incident"] = std::string(Name(sense)) + (options_.incident_sense  ? " (option)"
                                                                 : header_.incident_sense ? " (header)"
                                                                                          : " (default)");
    if (layout_.phi_i == kNoColumn && layout_.phi_o == kNoColumn && layout_.delta_phi == kNoColumn) {
      notes->conventions["azimuths"] = layout_.azimuth == kNoColumn
                                           ? "one plane: theta_o = theta_i is the mirror direction"
                                           : "phi_i = 0, phi_o = azimuth - 90 deg";
    }
    if (layout_.wavelength != kNoColumn) {
      notes->conventions["wavelength-unit"] = header_.nm_per_wavelength_unit ? "by header" : "nm, below 100: um";
    }
  }

  // Fills fields_ with the numbers of the columns that are read.
  void ParseRow(std::string_view line, std::size_t line_number) {
    std::size_t column = 0;
    const auto take = [&](std::string_view field) {
      if (column < fields_.size() && layout_.is_read[column]) {
        const std::optional<double> number = ParseDouble(field);
        if (!number) FailAtField(line_number, column, field);
        fields_[column] = *number;
      }
      ++column;
    };
    if (header_.separator == kBlankSeparator) {
      for (const std::string_view field : SplitBlanks(line)) take(field);
    } else {
      std::size_t begin = 0;
      while (true) {
        // Most fields are plain numbers that fill their field: one pass over the characters.
        std::size_t length = 0;
        std::optional<double> plain;
        if (column < fields_.size() && layout_.is_read[column]) plain = ParsePlainDecimal(line.substr(begin), &length);
        std::size_t end = begin + length;
        if (plain && (end == line.size() || line[end] == header_.separator)) {
          fields_[column++] = *plain;
          if (end == line.size()) break;
        } else {
          end = line.find(header_.separator, begin);
          take(line.substr(begin, end - begin));
          if (end == std::string_view::npos) break;
        }
        begin = end + 1;
      }
    }
    if (column != fields_.size()) {
      FailAtLine(file_, line_number,
                 "has " + std::to_string(column) + " fields; line " + std::to_string(header_.names_line) + " names " +
                     std::to_string(fields_.size()) + " columns" +
                     (header_.separator == ',' && column > fields_.size()
                          ? " (with decimal commas, separate the fields by semicolons and write decimal points)"
                          : ""));
    }
  }

  [[noreturn]] void FailAtField(std::size_t line_number, std::size_t column, std::string_view field) const {
    std::string what = "column " + std::to_string(column + 1) + " (" + Excerpt(header_.columns[column].name) + ") ";
    if (Trim(field).empty()) {
      what += "is empty; write a number, or nan for a value that was not measured";
    } else {
      what += "is '" + Excerpt(Trim(field)) + "', which is not a number";
      if (field.find(',') != std::string_view::npos) what += "; write a decimal point instead of a comma";
    }
    FailAtLine(file_, line_number, what);
  }

  void ReadRows(MeasurementBuilder* builder) {
    LineReader lines(file_.bytes);
    std::string_view line;
    while (lines.Next(&line)) {
      const std::size_t number = lines.line_number();
      if (number < header_.first_data_line || line.empty()) continue;
      const bool may_be_special = line[0] <= '/';  // blank, tab, '#', '%' or "//"
      if (may_be_special && (Trim(line).empty() || IsComment(line))) continue;
      if (builder->measurement().samples.origin.capacity() == 0) Reserve(line.size(), builder);
      ParseRow(line, number);
      AddRow(static_cast<std::uint32_t>(number), builder);
    }
  }

  void Reserve(std::size_t line_size, MeasurementBuilder* builder) const {
    const std::size_t rows = file_.bytes.size() / (line_size + 1) + 1;
    Samples& samples = builder->measurement().samples;
    for (std::vector<double>* array :
         {&samples.wi_x, &samples.wi_y, &samples.wi_z, &samples.wo_x, &samples.wo_y, &samples.wo_z}) {
      array->reserve(rows);
    }
    for (std::vector<double>& array : samples.values) array.reserve(rows);
    samples.origin.reserve(rows);
  }

  // A polar angle and an azimuth; the polar angle's sine carries its sign, which is the other side's azimuth.
  static Vec3 Direction(const AngleCache& theta, const AngleCache& phi) {
    return {theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()};
  }

  bool SetDirections(Vec3* wi, Vec3* wo) {
    theta_i_.Set(fields_[layout_.theta_i]);
    theta_o_.Set(fields_[layout_.theta_o]);
    if (layout_.phi_i != kNoColumn) phi_i_.Set(fields_[layout_.phi_i]);
    *wi = Direction(theta_i_, phi_i_);
    if (layout_.phi_o != kNoColumn) {
      phi_o_.Set(fields_[layout_.phi_o]);
      *wo = Direction(theta_o_, phi_o_);
    } else if (layout_.delta_phi != kNoColumn) {
      phi_o_.Set(fields_[layout_.delta_phi]);
      *wo = Turned(Direction(theta_o_, phi_o_), phi_i_.cos(), phi_i_.sin());
    } else if (layout_.azimuth != kNoColumn) {
      phi_o_.Set(fields_[layout_.azimuth]);
      const Vec3 in_receiver_plane = Direction(theta_o_, phi_o_);
      *wo = Turned(in_receiver_plane, 0, -1);
    } else {
      *wo = {-theta_o_.sin() * phi_i_.cos(), -theta_o_.sin() * phi_i_.sin(), theta_o_.cos()};
    }
    if (flip_incident_) *wi = {-wi->x, -wi->y, std::fabs(wi->z)};
    if (header_.sample_rotation != 0) {
      const double c = std::cos(header_.sample_rotation), s = -std::sin(header_.sample_rotation);
      *wi = Turned(*wi, c, s);
      *wo = Turned(*wo, c, s);
    }
    return std::isfinite(wi->x + wi->y + wi->z + wo->x + wo->y + wo->z);
  }

  static Vec3 Turned(const Vec3& w, double cos_angle, double sin_angle) {
    return {cos_angle * w.x - sin_angle * w.y, sin_angle * w.x + cos_angle * w.y, w.z};
  }

  void AddRow(std::uint32_t line, MeasurementBuilder* builder) {
    Vec3 wi, wo;
    if (!SetDirections(&wi, &wo)) {
      builder->Skip(SetAsideReason::kNotFinite);
      return;
    }
    if (!(wi.z > 1e-9) || !(wo.z > 1e-9)) {
      builder->Skip(SetAsideReason::kBelowHorizon);
      return;
    }
    const double factor = BrdfFactor(layout_.value_kind, wi.z, wo.z);
    values_.resize(layout_.values.size());
    for (std::size_t c = 0; c < values_.size(); ++c) values_[c] = factor * fields_[layout_.values[c]];
    double weight = 1;
    if (!WeightOfRow(line, factor, &weight)) {
      builder->Skip(SetAsideReason::kFlagged);
      return;
    }
    if (by_wavelength_) {
      AddWavelength({wi, wo, 0, values_[0], weight, line}, builder);
      return;
    }
    if (builder->Add(wi, wo, values_.data(), line) && HasWeights()) {
      builder->measurement().samples.weight.push_back(weight);
    }
  }

  void AddWavelength(WavelengthTable::Row row, MeasurementBuilder* builder) {
    const double number = fields_[layout_.wavelength];
    if (!std::isfinite(number) || number <= 0) {
      FailAtLine(file_, row.line, "the wavelength is " + FormatDouble(number) + "; it must be positive");
    }
    // Nanometres of an optical instrument have three digits or more, micrometres at most two before the point.
    const double nm = number * header_.nm_per_wavelength_unit.value_or(number < 100 ? 1000.0 : 1.0);
    row.nm = std::round(nm * 1e6) / 1e6;
    if (!std::isfinite(row.value)) {
      builder->Skip(SetAsideReason::kNotFinite);
    } else if (!by_wavelength_->Add(row)) {
      builder->Skip(SetAsideReason::kDuplicate);
    }
  }

  bool HasSigmas() const { return layout_.sigma != kNoColumn || !layout_.channel_sigmas.empty(); }
  bool HasWeights() const { return layout_.weight != kNoColumn || HasSigmas(); }

  // The row's weight, or the standard deviation of its f_r (root mean square over the channels), which takes the
  // weight's place until all rows are known. False where the file gives the row no weight.
  bool WeightOfRow(std::size_t line, double factor, double* weight) const {
    if (!HasWeights()) return true;
    if (layout_.weight != kNoColumn) {
      *weight = fields_[layout_.weight];
      if (*weight == 0) return false;
      if (!(*weight >= 1e-100 && *weight <= 1e100)) {
        FailAtLine(file_, line, "the weight is " + FormatDouble(*weight) + "; it must be 0, or 1e-100 to 1e100");
      }
      return true;
    }
    double variance = 0;
    const auto add = [&](std::size_t column) {
      const double sigma = fields_[column];
      if (!(sigma > 0) || std::isinf(sigma)) {
        FailAtLine(file_, line,
                   "the standard deviation in column " + std::to_string(column + 1) + " is " + FormatDouble(sigma) +
                       "; it must be more than 0");
      }
      variance += sigma * sigma;
    };
    if (layout_.sigma != kNoColumn) add(layout_.sigma);
    for (const std::size_t column : layout_.channel_sigmas) add(column);
    const double count = layout_.sigma != kNoColumn ? 1.0 : static_cast<double>(layout_.channel_sigmas.size());
    *weight = factor * std::sqrt(variance / count);
    return true;
  }

  const InputFile& file_;
  const ReadOptions& options_;
  CsvHeader header_;
  CsvLayout layout_;
  bool flip_incident_ = false;
  AngleCache theta_i_, phi_i_, theta_o_, phi_o_;
  std::vector<double> fields_, values_;
  std::optional<WavelengthTable> by_wavelength_;  // where a column holds the wavelength
};

}  // namespace

bool IsCsv(std::string_view bytes) {
  LineReader lines(bytes.substr(0, 1 << 16));
  std::string_view line;
  while (lines.Next(&line)) {
    for (const char c : line) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 && byte != '\t') return false;
    }
    if (Trim(line).empty() || IsComment(line)) continue;
    if (line.find_first_of(",;\t") != std::string_view::npos) return true;
    // Words between blanks are prose, unless they are numbers or one of them is a column's name.
    bool numbers = true, named = false;
    const std::vector<std::string_view> words = SplitBlanks(line);
    for (const std::string_view word : words) {
      numbers = numbers && ParseDouble(word).has_value();
      named = named || ClassifyColumn(word).role == ColumnRole::kThetaI;
    }
    return words.size() >= 3 && (numbers || named);
  }
  return false;
}

Measurement ReadCsv(const InputFile& file, const ReadOptions& options) { return CsvReader(file, options).Read(); }

}  // namespace lobefit
