// ALTA text and binary data: "#KEY value" header, then rows of input coordinates, values and confidence intervals, as
// text or as 8-byte floats. Angles in radians; PARAM_IN names the coordinates, PARAM_OUT whether the values have the
// cosine of the outgoing direction.
#include "lobefit/io/alta/reader.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/io/alta/header.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

constexpr double kLargestCoordinate = 2 * kPi + 1e-6;
// Of the narrowest interval; a weight must not vanish in the square of a wide one.
constexpr double kLeastWeight = 1e-12;

// What the place of a row means: the line of a text, or the number of a row of bytes.
struct RowPlaces {
  const InputFile& file;
  std::size_t first_byte = 0, bytes_per_row = 0;  // 0 bytes: lines

  [[noreturn]] void Fail(std::size_t place, const std::string& what) const {
    if (bytes_per_row == 0) FailAtLine(file, place, what);
    FailAtByte(file, first_byte + place * bytes_per_row, "row " + std::to_string(place + 1) + ": " + what);
  }
};

// Half-widths of the confidence intervals, squared, until it is known how the columns are meant.
class Intervals {
 public:
  // The columns of one row, in the order of the outputs; factor turns a value into f_r; place as in RowTaker. Call Keep
  // where the sample is used.
  void Take(const AltaLayout& layout, const double* values, const double* columns, double factor, std::size_t place) {
    as_bounds_ = as_offsets_ = 0;
    std::size_t at = 0, outputs = 0;
    for (std::size_t c = 0; c < layout.outputs; ++c) {
      if (layout.intervals[c] == 0) continue;
      const double low = columns[at], high = layout.intervals[c] == 2 ? columns[at + 1] : low;
      at += static_cast<std::size_t>(layout.intervals[c]);
      ++outputs;
      if (!(low >= 0) || !(high >= 0)) Note(place, &not_offsets_);
      if (layout.intervals[c] == 2) {
        has_pairs_ = true;
        if (!(low <= values[c]) || !(values[c] <= high)) Note(place, &not_bounds_);
        as_bounds_ += 0.25 * (high - low) * (high - low);
      } else {
        as_bounds_ += low * low;
        if (!(low >= 0)) Note(place, &not_bounds_);
      }
      as_offsets_ += 0.25 * (high + low) * (high + low);
    }
    const double scale = factor * factor / static_cast<double>(std::max<std::size_t>(outputs, 1));
    as_bounds_ *= scale;
    as_offsets_ *= scale;
  }
  void Keep() {
    bounds_.push_back(as_bounds_);
    offsets_.push_back(as_offsets_);
  }

  // Standard deviations where the file says so, else weights 1 / variance into the samples; what was decided into the
  // conventions.
  void Finish(const RowPlaces& places, const ReadOptions& options, bool sigma, Measurement* measurement) {
    const bool bounds = options.alta_interval ? *options.alta_interval == IntervalKind::kBounds : !not_bounds_;
    const std::optional<std::size_t> wrong = bounds ? not_bounds_ : not_offsets_;
    if (wrong) {
      places.Fail(*wrong,
                  !has_pairs_
                      ? "the half-width of a confidence interval is negative or not a number; it must be 0 or more"
                  : bounds ? "the value does not lie between the two columns of its interval; --alta-interval offsets "
                             "reads them as distances from the value"
                           : "a half-width of the confidence interval is negative or not a number, and the value does "
                             "not lie between its two columns either");
    }
    std::vector<double>& variance = bounds ? bounds_ : offsets_;
    double smallest = std::numeric_limits<double>::infinity();
    for (const double v : variance) {
      if (v > 0) smallest = std::min(smallest, v);
    }
    if (!std::isfinite(smallest)) {
      measurement->remarks.emplace_back("the confidence intervals (#VS) have no width and were not used");
      return;
    }
    if (sigma && !has_pairs_) {
      for (double& v : variance) v = std::sqrt(std::max(v, smallest));
      measurement->samples.sigma = std::move(variance);
      measurement->conventions["alta-interval"] = "standard deviation (header)";
      return;
    }
    std::size_t without = 0;
    for (double& v : variance) {
      without += v > 0 ? 0 : 1;
      v = std::max(smallest / std::max(v, smallest), kLeastWeight);
    }
    if (without > 0) {
      measurement->remarks.push_back(std::to_string(without) +
                                     " confidence intervals have no width; they weigh as much as the narrowest other");
    }
    measurement->samples.weight = std::move(variance);
    measurement->conventions["alta-interval"] = std::string(!has_pairs_ ? "half-width"
                                                            : bounds    ? "bounds"
                                                                        : "offsets") +
                                                (options.alta_interval || !has_pairs_ ? ""
                                                 : bounds                             ? " (every value lies between)"
                                                                                      : " (some value lies outside)");
  }

 private:
  static void Note(std::size_t place, std::optional<std::size_t>* first) {
    if (!*first) *first = place;
  }

  double as_bounds_ = 0, as_offsets_ = 0;
  std::vector<double> bounds_, offsets_;
  std::optional<std::size_t> not_bounds_, not_offsets_;  // first place where the reading is impossible
  bool has_pairs_ = false;
};

class RowTaker {
 public:
  RowTaker(const RowPlaces& places, const AltaLayout& layout, bool sigma)
      : places_(places), layout_(layout), sigma_(sigma), builder_(layout.channels), values_(layout.outputs) {}

  // One row: coordinates, values, columns of confidence, and its place.
  void Take(const double* row, const double* columns, std::size_t place) {
    for (std::size_t i = 0; i < layout_.input->dimension; ++i) {
      if (std::fabs(row[i]) > kLargestCoordinate) {
        places_.Fail(place, "coordinate " + std::to_string(i + 1) + " is " + FormatDouble(row[i]) +
                                ", beyond 2 pi; ALTA angles are in radians and vectors of length 1");
      }
    }
    Vec3 wi = {}, wo = {};
    layout_.input->convert(row, &wi, &wo);
    const double factor = BrdfFactor(layout_.kind, wi.z, wo.z);
    const double* stated = row + layout_.input->dimension;
    for (std::size_t c = 0; c < layout_.outputs; ++c) values_[c] = factor * stated[c];
    if (layout_.interval_columns() > 0) intervals_.Take(layout_, stated, columns, factor, place);
    if (builder_.Add(wi, wo, values_.data(), static_cast<std::uint32_t>(place)) && layout_.interval_columns() > 0) {
      intervals_.Keep();
    }
  }

  Measurement Finish(const ReadOptions& options) {
    if (layout_.interval_columns() > 0) intervals_.Finish(places_, options, sigma_, &builder_.measurement());
    Measurement measurement = builder_.Finish();
    ScaleToMeanOne(&measurement.samples.weight);
    return measurement;
  }

 private:
  RowPlaces places_;
  const AltaLayout& layout_;
  bool sigma_;
  MeasurementBuilder builder_;
  std::vector<double> values_;
  Intervals intervals_;
};

Measurement ReadText(const InputFile& file, const AltaHeader& header, AltaLayout* layout, const ReadOptions& options) {
  const std::size_t plain = layout->input->dimension + layout->outputs;
  std::optional<RowTaker> taker;
  std::vector<double> row;
  LineReader lines(file.bytes.substr(header.end));
  std::string_view line;
  while (lines.Next(&line)) {
    const std::size_t at = header.end_line + lines.line_number();
    const std::vector<std::string_view> fields = SplitBlanks(line);
    if (fields.empty() || fields[0][0] == '#') continue;
    if (!taker) {
      // "#VS v" with several outputs: ALTA reads the columns of the first output only; a file with columns for all of
      // them is told by its width.
      if (layout->one_interval_number &&
          fields.size() == plain + layout->outputs * static_cast<std::size_t>(layout->intervals[0])) {
        layout->intervals.assign(layout->outputs, layout->intervals[0]);
      }
      taker.emplace(RowPlaces{file}, *layout, header.sigma);
    }
    const std::size_t expected = plain + layout->interval_columns();
    if (fields.size() != expected) {
      FailAtLine(file, at,
                 "has " + std::to_string(fields.size()) + " numbers; the header announces " + std::to_string(expected) +
                     " (coordinates " + std::to_string(layout->input->dimension) + ", values " +
                     std::to_string(layout->outputs) + ", columns of confidence " +
                     std::to_string(layout->interval_columns()) + ")");
    }
    row.clear();
    for (std::size_t i = 0; i < fields.size(); ++i) {
      row.push_back(i < layout->input->dimension ? FiniteNumberAt(file, at, fields[i], "a coordinate")
                                                 : NumberAt(file, at, fields[i], "a value"));
    }
    taker->Take(row.data(), row.data() + plain, at);
  }
  if (!taker) FailAtLine(file, header.end_line + lines.line_number(), "the file ends without a row of data");
  return taker->Finish(options);
}

double LoadDouble(const char* bytes, bool big_endian) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    bits = (bits << 8) | static_cast<unsigned char>(bytes[big_endian ? i : 7 - i]);
  }
  double value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

void RequireValue(const InputFile& file, const AltaHeader& header, const std::string& key, const std::string& value) {
  const AltaEntry& entry = RequireKey(file, header, key, value);
  if (entry.value != value) {
    FailAtLine(file, entry.line, "#" + key + " is '" + Excerpt(entry.value) + "'; allowed is " + value);
  }
}

Measurement ReadBinary(const InputFile& file, const AltaHeader& header, AltaLayout* layout,
                       const ReadOptions& options) {
  RequireValue(file, header, "FORMAT", "binary");
  RequireValue(file, header, "VERSION", "0");
  RequireValue(file, header, "PRECISION", "ieee754-double");
  const AltaEntry& endian = RequireKey(file, header, "ENDIAN", "little");
  if (endian.value != "little" && endian.value != "big") {
    FailAtLine(file, endian.line, "#ENDIAN is '" + Excerpt(endian.value) + "'; allowed are little and big");
  }
  const AltaEntry& count_entry = RequireKey(file, header, "SAMPLE_COUNT", "150");
  const std::optional<long long> count = ParseInteger(count_entry.value);
  if (!count || *count < 1) {
    FailAtLine(file, count_entry.line,
               "#SAMPLE_COUNT is '" + Excerpt(count_entry.value) + "'; a count of at least 1 is needed");
  }
  if (layout->one_interval_number) layout->intervals.assign(layout->outputs, layout->intervals[0]);
  const std::size_t plain = layout->input->dimension + layout->outputs;
  const std::size_t columns = plain + layout->interval_columns();
  const std::size_t rows = static_cast<std::size_t>(*count);
  const std::optional<std::size_t> bytes = CheckedProduct({rows, columns, sizeof(double)});
  if (!bytes || *bytes > file.bytes.size() - header.end) {
    FailAtByte(file, header.end,
               std::to_string(rows) + " rows of " + std::to_string(columns) +
                   " numbers should follow, but the file has only " + std::to_string(file.bytes.size() - header.end) +
                   " more bytes; it is cut off");
  }
  const std::string_view trailer = Trim(file.bytes.substr(header.end + *bytes));
  // Older files end with their data.
  if (header.end + *bytes != file.bytes.size() && trailer != "#END_STREAM") {
    FailAtByte(file, header.end + *bytes,
               "found '" + Excerpt(trailer) +
                   "' where #END_STREAM should end the data; "
                   "#SAMPLE_COUNT, #DIM or #VS does not fit the file");
  }
  RowTaker taker({file, header.end, columns * sizeof(double)}, *layout, header.sigma);
  std::vector<double> row(columns), intervals(layout->interval_columns());
  const char* data = file.bytes.data() + header.end;
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      row[c] = LoadDouble(data, endian.value == "big");
      data += sizeof(double);
    }
    // The binary form has the lower ends of all outputs first, then the upper ends.
    const std::size_t ends = layout->interval_columns() / layout->outputs;
    for (std::size_t i = 0; i < intervals.size(); ++i)
      intervals[i] = row[plain + (i % ends) * layout->outputs + i / ends];
    taker.Take(row.data(), intervals.data(), r);
  }
  return taker.Finish(options);
}

}  // namespace

bool IsAlta(std::string_view bytes) {
  const std::string_view head = Head(bytes);
  return HasLineWithFirstWord(head, "#DIM") || HasLineWithFirstWord(head, "#PARAM_IN") ||
         HasLineWithFirstWord(head, "#ALTA");
}

Measurement ReadAlta(const InputFile& file, const ReadOptions& options) {
  const AltaHeader header = ReadAltaHeader(file);
  AltaLayout layout = ReadAltaLayout(file, header, options);
  const AltaEntry* format = FindKey(header, "FORMAT");
  const bool binary = format != nullptr && format->value == "binary";
  if (binary && !header.stream && !header.ended) {
    FailAtLine(file, std::max<std::size_t>(header.end_line, 1),
               "the header says #FORMAT binary, but is not ended by #BEGIN_STREAM or #ALTA HEADER END");
  }
  Measurement measurement =
      binary || header.stream ? ReadBinary(file, header, &layout, options) : ReadText(file, header, &layout, options);
  measurement.comments = header.comments;
  measurement.isotropic = layout.input->isotropic;
  measurement.conventions["angle-unit"] = "rad (format)";
  measurement.conventions["value-kind"] = Name(layout.kind) + (layout.kind_from_option  ? ""
                                                               : layout.kind_not_stated ? " (not stated)"
                                                                                        : " (header)");
  if (layout.kind_not_stated) {
    measurement.remarks.push_back(
        "the file does not say what its values are (no #PARAM_OUT); a fit needs --value-kind, one of " +
        AllowedValueKinds());
  }
  measurement.conventions["directions"] = std::string(layout.input->name) + " (header)";
  return measurement;
}

}  // namespace lobefit
