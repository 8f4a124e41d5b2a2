// Rows of a goniometer with named columns. What the columns mean: columns.h and layout.h; keys of the head: keys.h; how
// their angles become directions: directions.h.
#include "lobefit/io/csv/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/head_lines.h"
#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/distinctions.h"
#include "lobefit/io/csv/rows/layout.h"
#include "lobefit/io/csv/rows/mark_tally.h"
#include "lobefit/io/csv/rows/row_parser.h"
#include "lobefit/io/csv/rows/row_polarisations.h"
#include "lobefit/io/csv/rows/stated_angles.h"
#include "lobefit/io/csv/rows/wavelengths.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/measurement/prepare/noise.h"
#include "lobefit/measurement/prepare/repeats.h"

namespace lobefit {
namespace {

class CsvReader {
 public:
  CsvReader(const InputFile& file, const ReadOptions& options) : file_(file), options_(options) {}

  Measurement Read() {
    header_ = ReadCsvHeader(file_, options_.columns);
    for (const std::string& key : options_.keys) {
      if (!ReadKey(file_, header_.names_line, key, &header_.keys)) {
        FailAtLine(
            file_, header_.names_line,
            "'" + Excerpt(key) +
                "', given behind the file's name, is no key of a CSV; write it as in theta_i=30 or sample-rotation=30");
      }
    }
    notes_.remarks = header_.remarks;
    layout_ = ReadCsvLayout(file_, header_, options_, &notes_);
    at_ = layout_.fixed;
    ranges_.assign(layout_.coordinates.size(),
                   {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
    repeated_ = options_.repeated.value_or(ParseRepeatedRows(header_.keys.repeated).value_or(RepeatedRows::kFirst));
    if (layout_.by_wavelength) {
      by_wavelength_.emplace(HasSigmas()    ? WavelengthTable::Weights::kSigma
                             : HasWeights() ? WavelengthTable::Weights::kWeight
                                            : WavelengthTable::Weights::kNone);
    }
    MeasurementBuilder builder(layout_.channels);
    ReadRows(&builder);
    marks_.AddRemarks(&notes_.remarks);
    if (by_wavelength_) {
      Measurement gathered;
      WithPath([&] {
        gathered = by_wavelength_->Gather(repeated_ == RepeatedRows::kMean, options_.wavelength_tolerance_nm);
      });
      RequireWhole(gathered);
      for (int r = 0; r < kSetAsideReasons; ++r) {
        const auto reason = static_cast<SetAsideReason>(r);
        gathered.set_aside.Add(reason, builder.measurement().set_aside[reason]);
      }
      if (gathered.channels.size() < by_wavelength_->wavelengths()) {
        const std::string how =
            options_.wavelength_tolerance_nm
                ? " wavelengths within " + FormatDouble(*options_.wavelength_tolerance_nm) + " nm are "
                : " wavelengths that wander by less than half of their spacing are ";
        notes_.remarks.push_back(std::to_string(by_wavelength_->wavelengths()) + how +
                                 std::to_string(gathered.channels.size()) + " channel" +
                                 (gathered.channels.size() == 1 ? "" : "s"));
      }
      gathered.left_out = std::move(builder.measurement().left_out);
      builder.measurement() = std::move(gathered);
    }
    return Finish(&builder);
  }

 private:
  // Rows whose wavelengths differ from pair to pair leave no pair that has all of them.
  void RequireWhole(const Measurement& gathered) const {
    if (!options_.channels.empty() || gathered.samples.size() == 0 || gathered.channels.size() < 2) return;
    for (std::size_t i = 0; i < gathered.samples.size(); ++i) {
      const bool whole = std::none_of(gathered.samples.values.begin(), gathered.samples.values.end(),
                                      [&](const std::vector<double>& values) { return std::isnan(values[i]); });
      if (whole) return;
    }
    throw InputError(
        file_.path.string() + ": " + std::to_string(gathered.channels.size()) +
        " different wavelengths, and none of the " + std::to_string(by_wavelength_->pairs()) +
        " pairs of directions has all of them; if the wavelength wanders from row to row, "
        "--wavelength-tolerance NM makes one channel of those that differ by no more, else choose channels "
        "with --channels");
  }

  // A turn of the whole sample.
  void StateTurn(Samples* samples) const {
    const FixedCoordinate* turn = header_.keys.Find(Coordinate::kSampleRotation);
    if (turn == nullptr || turn->number == 0) return;
    samples->sample_azimuth.assign(samples->size(),
                                   turn->number * RadiansPerUnit(turn->unit.value_or(AngleUnit::kDegrees)));
  }

  Measurement Finish(MeasurementBuilder* builder) {
    WithPath([&] {
      const std::string remark = polarisations_.Average(&builder->measurement());
      if (!remark.empty()) notes_.remarks.push_back(remark);
    });
    Samples& rows = builder->measurement().samples;
    if (repeated_ == RepeatedRows::kMean) {
      // The spread of the repetitions stands for the stated uncertainty.
      if (HasSigmas()) rows.weight.clear();
      const Repeats repeats = MergeRepeated(&builder->measurement());
      notes_.remarks.push_back(std::to_string(repeats.samples) + " repeated rows were merged to " +
                               std::to_string(repeats.pairs) + "; a row scatters by " +
                               FormatDouble(std::round(1000 * repeats.relative_spread) / 10) + " % of its mean");
    }
    Measurement measurement = builder->Finish();
    if (HasSigmas() && repeated_ == RepeatedRows::kFirst) {
      std::vector<double> sigma = std::exchange(measurement.samples.weight, {});
      FillUnknown(&sigma);
      if (!sigma.empty()) AddSigma(sigma, &measurement.samples);
    }
    if (measurement.set_aside[SetAsideReason::kDuplicate] > 0) {
      const std::string distinctions = DescribeDistinctions(file_, header_, layout_);
      notes_.remarks.push_back(
          distinctions.empty()
              ? "directions occur again; --repeated mean averages their rows instead of keeping the first"
              : distinctions);
    }
    measurement.conventions = notes_.conventions;
    measurement.conventions["repeated"] = Name(repeated_) + (options_.repeated               ? " (option)"
                                                             : header_.keys.repeated.empty() ? " (default)"
                                                                                             : " (header)");
    measurement.instrument = header_.keys.instrument;
    StateTurn(&measurement.samples);
    if (!header_.keys.exclude.empty()) measurement.conventions["exclude"] = header_.keys.exclude;
    measurement.remarks = std::move(notes_.remarks);
    measurement.comments = std::move(header_.comments);
    measurement.isotropic = layout_.directions.IsIsotropic();
    for (std::string& remark : FindImplausibleAngles(StateAngles(), rows_))
      measurement.remarks.push_back(std::move(remark));
    ScaleToMeanOne(&measurement.samples.weight);
    return measurement;
  }

  // What rows have in common is judged where no file is known.
  template <class Function>
  void WithPath(Function&& function) const {
    try {
      function();
    } catch (const InputError& error) {
      throw InputError(file_.path.string() + ": " + error.what());
    }
  }

  void ReadRows(MeasurementBuilder* builder) {
    RowParser parser(file_, header_, layout_,
                     NoValues(options_.no_value.empty() ? header_.keys.no_value : options_.no_value));
    CsvLines lines(file_.bytes);
    std::string_view line;
    while (lines.Next(&line)) {
      const std::size_t number = lines.line_number();
      if (number < header_.first_data_line || line.empty()) continue;
      const bool may_be_special = line[0] <= '/';  // blank, tab, '#', '%' or "//"
      if (may_be_special && (Trim(line).empty() || IsComment(line))) {
        if (line[0] != '-' && IsComment(line)) TakeComment(number, CommentText(line));
        continue;
      }
      if (builder->measurement().samples.origin.capacity() == 0) Reserve(line.size(), builder);
      switch (parser.Parse(line, number)) {
        case RowParser::Kind::kBlank:
          continue;
        case RowParser::Kind::kWords:
          TakeWords(line, number, parser);
          continue;
        case RowParser::Kind::kRow:
          break;
      }
      if (!words_message_.empty()) FailAtLine(file_, words_line_, words_message_);
      AddRow(parser, static_cast<std::uint32_t>(number), builder);
    }
    if (!words_message_.empty() && rows_ == 0 && builder->measurement().set_aside.total() == 0)
      FailAtLine(file_, words_line_, words_message_);
    if (!words_message_.empty()) {
      notes_.remarks.push_back(std::to_string(words_) + (words_ == 1 ? " line" : " lines") +
                               " after the last row, from line " + std::to_string(words_line_) + " on, hold no row: '" +
                               words_text_ + "'");
    }
  }

  // The names again, where files were joined; a key of the rows that follow; else a footer, unless rows come after it.
  void TakeWords(std::string_view line, std::size_t number, const RowParser& parser) {
    std::vector<std::string_view> fields;
    SplitCsvLine(line, header_.separator, &fields);
    if (Trim(line) == Trim(header_.names) || AreNamesAgain(fields)) {
      // What stands above names is the head of a page.
      words_message_.clear();
      words_ = 0;
      return;
    }
    if (ReadKeyAmidRows(number, {}, fields)) return;
    ++words_;
    const bool names = NamesADirection(Classify(fields));
    if (!words_message_.empty() && !names) return;
    words_line_ = number;
    words_message_ = names ? "names other columns than line " + std::to_string(header_.names_line) +
                                 ", or in another order or unit; put each table into a file of its own"
                           : parser.WordsMessage();
    words_text_ = Excerpt(Trim(line));
  }

  // The same columns in the same order, however their names are spelt.
  bool AreNamesAgain(const std::vector<std::string_view>& fields) const {
    if (fields.size() != header_.columns.size()) return false;
    std::string storage;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const CsvColumn own = ClassifyColumn(header_.columns[i].name),
                      other = ClassifyColumn(Unquoted(fields[i], &storage));
      const bool same = own.name == other.name ||
                        (own.role != ColumnRole::kUnknown && own.role == other.role && own.unit == other.unit &&
                         own.coordinate == other.coordinate && own.form == other.form && own.channel == other.channel &&
                         own.value_kind == other.value_kind);
      if (!same) return false;
    }
    return true;
  }

  void TakeComment(std::size_t number, std::string_view text) {
    constexpr std::size_t kMostComments = 10000;
    if (!ReadKeyAmidRows(number, text, {}) && !text.empty() && header_.comments.size() < kMostComments)
      header_.comments.emplace_back(PlainComment(text));
  }

  bool ReadKeyAmidRows(std::size_t number, std::string_view comment, const std::vector<std::string_view>& fields) {
    if (!comment.empty() && comment.find_first_of(":=") == std::string_view::npos) return false;
    CsvKeys keys = header_.keys;
    if (!(fields.empty() ? ReadKey(file_, number, comment, &keys) : ReadKey(file_, number, fields, &keys)))
      return false;
    RequireSameUnits(file_, number, header_.keys, keys);
    for (const FixedCoordinate& fixed : keys.fixed) {
      const FixedCoordinate* before = header_.keys.Find(fixed.coordinate);
      if (before == nullptr) {
        if (layout_.directions.Has(fixed.coordinate)) continue;
        FailAtLine(file_, number,
                   "an angle is stated here that the rows before lack; state it in the head too, or put the parts into "
                   "files of their own");
      }
      if (before->unit != fixed.unit)
        FailAtLine(file_, number, "an angle is stated in another unit than before; use one unit");
      at_[static_cast<std::size_t>(fixed.coordinate)] = fixed.number;
    }
    if (keys.wavelength_nm && !header_.keys.wavelength_nm && !layout_.by_wavelength) {
      FailAtLine(file_, number, "a wavelength is stated here that the rows before lack; state it in the head too");
    }
    header_.keys = std::move(keys);
    return true;
  }

  void Reserve(std::size_t line_size, MeasurementBuilder* builder) const {
    if (by_wavelength_) return;
    const std::size_t rows = (file_.bytes.size() / (line_size + 1) + 1) * layout_.groups.size();
    Samples& samples = builder->measurement().samples;
    for (std::vector<double>* array :
         {&samples.wi_x, &samples.wi_y, &samples.wi_z, &samples.wo_x, &samples.wo_y, &samples.wo_z})
      array->reserve(rows);
    for (std::vector<double>& array : samples.values) array.reserve(rows);
    samples.origin.reserve(rows);
    if (HasWeights()) samples.weight.reserve(rows);
  }

  bool PassesFilters(const RowParser& row) const {
    return std::all_of(layout_.filters.begin(), layout_.filters.end(), [&](const RowFilter& filter) {
      const std::string_view text = row.Text(filter.column);
      if (ToLower(Trim(text)) == filter.word) return true;
      const std::optional<double> number = ParseCsvNumber(text, header_.decimal_mark),
                                  wanted = ParseDouble(filter.word);
      return number && wanted && *number == *wanted;
    });
  }

  void AddRow(const RowParser& row, std::uint32_t line, MeasurementBuilder* builder) {
    if (!layout_.filters.empty() && !PassesFilters(row)) {
      builder->Skip(SetAsideReason::kOutsideSelection, layout_.groups.size());
      return;
    }
    for (const auto& [coordinate, column] : layout_.coordinates)
      at_[static_cast<std::size_t>(coordinate)] = row.Number(column);
    ++rows_;
    for (std::size_t k = 0; k < ranges_.size(); ++k) {
      const double number = row.Number(layout_.coordinates[k].second);
      ranges_[k].first = std::min(ranges_[k].first, number);
      ranges_[k].second = std::max(ranges_[k].second, number);
    }
    if (!row.marks().empty()) marks_.Add(row.marks(), line, header_.side_tables.empty());
    for (const ValueGroup& group : layout_.groups) {
      if (!group.coordinates.empty() && !TakeCoordinates(row, group)) continue;
      for (const auto& [coordinate, number] : group.fixed) at_[static_cast<std::size_t>(coordinate)] = number;
      AddSample(row, group, line, builder);
    }
  }

  // Of one of several tables side by side; false below its end.
  bool TakeCoordinates(const RowParser& row, const ValueGroup& group) {
    bool any = false;
    for (const auto& [coordinate, column] : group.coordinates) {
      at_[static_cast<std::size_t>(coordinate)] = row.Number(column);
      any = any || !std::isnan(row.Number(column));
    }
    return any || std::any_of(group.values.begin(), group.values.end(),
                              [&](std::size_t column) { return !std::isnan(row.Number(column)); });
  }

  void AddSample(const RowParser& row, const ValueGroup& group, std::uint32_t line, MeasurementBuilder* builder) {
    Vec3 wi, wo;
    if (!layout_.directions.Directions(at_, &wi, &wo)) {
      builder->Skip(SetAsideReason::kNotFinite);
      return;
    }
    if (!IsAboveHorizon(wi) || !IsAboveHorizon(wo)) {
      builder->Skip(SetAsideReason::kBelowHorizon);
      return;
    }
    const double factor = BrdfFactor(layout_.value_kind, wi.z, wo.z);
    values_.resize(group.values.size());
    const bool plain = layout_.value_scale.IsIdentity();
    bool any = false;
    for (std::size_t c = 0; c < values_.size(); ++c) {
      const double number = row.Number(group.values[c]);
      values_[c] = factor * (plain ? number : layout_.value_scale.Apply(number));
      any = any || !std::isnan(number);
    }
    if (!any && !row.marks().empty()) {
      builder->Skip(SetAsideReason::kHole);
      builder->measurement().LeaveOut(Normalized(wi), Normalized(wo), LeftOutReason::kNoValue);
      return;
    }
    double weight = 1;
    if (HasWeights() && !WeightOfRow(row, group, line, factor, &weight)) {
      builder->Skip(SetAsideReason::kFlagged);
      return;
    }
    if (by_wavelength_) {
      AddWavelength(row, group, {wi, wo, 0, values_[0], weight, line}, builder);
    } else if (builder->Add(wi, wo, values_.data(), line)) {
      if (HasWeights()) builder->measurement().samples.weight.push_back(weight);
      if (polarisations_.any()) polarisations_.Add(row, group);
    }
  }

  void AddWavelength(const RowParser& row, const ValueGroup& group, WavelengthTable::Row sample,
                     MeasurementBuilder* builder) {
    if (polarisations_.any() && polarisations_.NumberOf(row, group) > 0) {
      FailAtLine(
          file_, sample.line,
          "rows with a wavelength of their own differ in polarisation too; choose one with " + polarisations_.Choice());
    }
    if (layout_.wavelength == kNoColumn) {
      sample.nm = *header_.keys.wavelength_nm;
    } else {
      const double number = row.Number(layout_.wavelength);
      if (!std::isfinite(number) || number <= 0)
        FailAtLine(file_, sample.line, "the wavelength is " + FormatDouble(number) + "; it must be positive");
      sample.nm = std::round(layout_.wavelength_unit.ToNm(number) * 1e6) / 1e6;
    }
    if (std::isinf(sample.value)) {
      builder->Skip(SetAsideReason::kNotFinite);
    } else {
      by_wavelength_->Add(sample);
    }
  }

  bool HasSigmas() const {
    return layout_.sigma != kNoColumn || !layout_.channel_sigmas.empty() || layout_.groups[0].sigma != kNoColumn;
  }
  bool HasWeights() const { return layout_.weight != kNoColumn || HasSigmas(); }

  // The row's weight, or the standard deviation of its f_r (root mean square over the channels; NaN where it is not
  // known), which takes the weight's place until all rows are known. False where the file gives the row no weight.
  bool WeightOfRow(const RowParser& row, const ValueGroup& group, std::size_t line, double factor,
                   double* weight) const {
    if (layout_.weight != kNoColumn) {
      *weight = row.Number(layout_.weight);
      if (*weight == 0) return false;
      if (!(*weight >= 1e-100 && *weight <= 1e100)) {
        FailAtLine(file_, line, "the weight is " + FormatDouble(*weight) + "; it must be 0, or 1e-100 to 1e100");
      }
      return true;
    }
    double variance = 0, count = 0;
    const auto add = [&](std::size_t column, std::size_t value_column) {
      const double number = row.Number(column);
      if (number < 0 || std::isinf(number)) {
        FailAtLine(file_, line,
                   "the standard deviation in column " + std::to_string(column + 1) + " is " + FormatDouble(number) +
                       "; it must be more than 0");
      }
      const double sigma = StandardDeviation(header_.columns[column], number, row.Number(value_column));
      if (!(sigma > 0)) return;  // 0 and no value: not known
      variance += sigma * sigma;
      ++count;
    };
    if (layout_.sigma != kNoColumn) add(layout_.sigma, group.values[0]);
    if (group.sigma != kNoColumn) add(group.sigma, group.values[0]);
    for (std::size_t c = 0; c < layout_.channel_sigmas.size(); ++c) add(layout_.channel_sigmas[c], group.values[c]);
    *weight = count > 0 ? factor * std::sqrt(variance / count) : std::nan("");
    return true;
  }

  // Of the value before the cosines, from what the column says about its numbers.
  double StandardDeviation(const CsvColumn& column, double number, double value) const {
    number = (column.variance ? std::sqrt(number) : number) / column.coverage_factor;
    const bool percent = column.unit == "%" || column.unit == "percent";
    const double unit = percent ? 0.01 : column.unit == "ppm" ? 1e-6 : 1;
    const bool in_units_of_value =
        percent && layout_.value_scale.factor == 0.01 && ToLower(column.name).find("rel") == std::string::npos;
    if (column.relative && !in_units_of_value) return unit * number * std::fabs(layout_.value_scale.Apply(value));
    const std::optional<ValueScale> own =
        column.unit.empty() || in_units_of_value ? std::nullopt : ParseValueScale(column.unit);
    // Decibels are a ratio, whatever the values are in.
    if (own && own->form != ValueScale::Form::kLinear) {
      const double brdf = layout_.value_scale.Apply(value);
      return std::fabs(brdf) * own->Slope(0) * number;
    }
    if (own && own->form == ValueScale::Form::kLinear && layout_.value_scale.form == ValueScale::Form::kLinear)
      return own->factor * number;
    return std::fabs(layout_.value_scale.Slope(value)) * number;
  }

  // A sample without an uncertainty gets the middle one of the others.
  void FillUnknown(std::vector<double>* sigma) {
    if (std::none_of(sigma->begin(), sigma->end(), [](double s) { return std::isnan(s); })) return;
    std::vector<double> known;
    for (const double s : *sigma) {
      if (!std::isnan(s)) known.push_back(s);
    }
    notes_.remarks.push_back(std::to_string(sigma->size() - known.size()) + " samples have no uncertainty" +
                             (known.empty() ? "; none was used" : "; the median of the others stands for it"));
    if (known.empty()) {
      sigma->clear();
      return;
    }
    std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2), known.end());
    for (double& s : *sigma) {
      if (std::isnan(s)) s = known[known.size() / 2];
    }
  }

  // For the check of conventions: how far the angles reach, whatever directions they gave.
  StatedAngles StateAngles() const {
    StatedAngles stated;
    static constexpr std::array<std::pair<Coordinate, const char*>, 5> kNames = {{{Coordinate::kThetaI, "theta_i"},
                                                                                  {Coordinate::kPhiI, "phi_i"},
                                                                                  {Coordinate::kThetaO, "theta_o"},
                                                                                  {Coordinate::kPhiO, "phi_o"},
                                                                                  {Coordinate::kDeltaPhi, "dphi"}}};
    for (const auto& [coordinate, name] : kNames) {
      if (!layout_.directions.Has(coordinate)) continue;
      const double degrees = RadiansToDegrees(layout_.directions.RadiansPerUnit(coordinate));
      std::pair<double, double> range(at_[static_cast<std::size_t>(coordinate)],
                                      at_[static_cast<std::size_t>(coordinate)]);
      for (std::size_t k = 0; k < ranges_.size(); ++k) {
        if (layout_.coordinates[k].first == coordinate) range = ranges_[k];
      }
      stated[name] = {degrees * range.first, degrees * range.second};
    }
    return stated;
  }

  const InputFile& file_;
  const ReadOptions& options_;
  CsvHeader header_;
  CsvLayout layout_;
  Measurement notes_;
  RepeatedRows repeated_ = RepeatedRows::kFirst;
  Coordinates at_ = {};
  std::vector<std::pair<double, double>> ranges_;  // of the coordinates that columns give, in the file's units
  std::vector<double> values_;
  std::optional<WavelengthTable> by_wavelength_;  // where rows have wavelengths of their own
  MarkTally marks_;
  std::size_t rows_ = 0, words_ = 0, words_line_ = 0;
  std::string words_message_, words_text_;
  RowPolarisations polarisations_{header_, layout_};
};

}  // namespace

Measurement ReadCsv(const InputFile& file, const ReadOptions& options) { return CsvReader(file, options).Read(); }

}  // namespace lobefit
