// Rows of a goniometer with named columns. What the columns mean: columns.h and layout.h; keys of the head: keys.h; how
// their angles become directions: directions.h.
#include "lobefit/io/csv/reader.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/process/memory.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/amid_rows.h"
#include "lobefit/io/csv/head/header.h"
#include "lobefit/io/csv/rows/angle_ranges.h"
#include "lobefit/io/csv/rows/distinctions.h"
#include "lobefit/io/csv/rows/layout.h"
#include "lobefit/io/csv/rows/mark_tally.h"
#include "lobefit/io/csv/rows/row_parser.h"
#include "lobefit/io/csv/rows/row_polarisations.h"
#include "lobefit/io/csv/rows/row_uncertainty.h"
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
    ranges_.emplace(layout_);
    repeated_ = options_.repeated.value_or(ParseRepeatedRows(header_.keys.repeated).value_or(RepeatedRows::kFirst));
    if (layout_.by_wavelength) {
      by_wavelength_.emplace(uncertainty_.HasSigmas()    ? WavelengthTable::Weights::kSigma
                             : uncertainty_.HasWeights() ? WavelengthTable::Weights::kWeight
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
      if (uncertainty_.HasSigmas()) rows.weight.clear();
      const Repeats repeats = MergeRepeated(&builder->measurement());
      notes_.remarks.push_back(std::to_string(repeats.samples) + " repeated rows were merged to " +
                               std::to_string(repeats.pairs) + "; a row scatters by " +
                               FormatDouble(std::round(1000 * repeats.relative_spread) / 10) + " % of its mean");
    }
    Measurement measurement = builder->Finish();
    if (uncertainty_.HasSigmas() && repeated_ == RepeatedRows::kFirst) {
      std::vector<double> sigma = std::exchange(measurement.samples.weight, {});
      FillUnknown(&sigma, &notes_.remarks);
      if (!sigma.empty()) AddSigma(sigma, &measurement.samples);
    }
    if (measurement.set_aside[SetAsideReason::kDuplicate] > 0) {
      const std::string distinctions = DescribeDistinctions(file_, header_, layout_);
      if (!distinctions.empty()) {
        notes_.remarks.push_back(distinctions);
      } else if (!amid_rows_.page().empty()) {
        notes_.remarks.push_back("directions occur again below " + amid_rows_.page() +
                                 ": where that begins another sample, put the parts into files of their own; only the "
                                 "first row of each pair of directions was kept");
      } else if (measurement.remarks.empty()) {  // by the builder, of repetitions that are unlike
        notes_.remarks.emplace_back(
            "directions occur again; --repeated mean averages their rows instead of keeping the first");
      } else {
        std::move(measurement.remarks.begin(), measurement.remarks.end(), std::back_inserter(notes_.remarks));
      }
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
    for (std::string& remark : FindImplausibleAngles(ranges_->State(layout_, at_), rows_))
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
        if (line[0] != '-' && IsComment(line)) amid_rows_.TakeComment(number, CommentText(line));
        continue;
      }
      // The names of a table may be numbers but for the first.
      if (line.size() == header_.names.size() && line == header_.names) {
        amid_rows_.TakeWords(line, number, parser);
        continue;
      }
      if (builder->measurement().samples.origin.capacity() == 0) Reserve(line.size(), builder);
      switch (parser.Parse(line, number)) {
        case RowParser::Kind::kBlank:
          continue;
        case RowParser::Kind::kWords:
          amid_rows_.TakeWords(line, number, parser);
          continue;
        case RowParser::Kind::kRow:
          break;
      }
      if (amid_rows_.pending()) amid_rows_.Fail();
      AddRow(parser, static_cast<std::uint32_t>(number), builder);
    }
    if (!amid_rows_.pending()) return;
    if (rows_ == 0 && builder->measurement().set_aside.total() == 0) amid_rows_.Fail();
    notes_.remarks.push_back(amid_rows_.Remark());
  }

  void Reserve(std::size_t line_size, MeasurementBuilder* builder) const {
    if (by_wavelength_) return;
    // Lines that are no rows take no memory of more than twice the rows that the first one promises.
    const std::size_t lines = std::min(EstimateLines(file_.bytes), 2 * (file_.bytes.size() / (line_size + 1) + 1)),
                      rows = lines * layout_.groups.size();
    Samples& samples = builder->measurement().samples;
    const auto reserve = [&](auto& array) {
      array.reserve(rows);
      AdviseLargePages(array.data(), rows * sizeof(array[0]));
    };
    for (std::vector<double>* array :
         {&samples.wi_x, &samples.wi_y, &samples.wi_z, &samples.wo_x, &samples.wo_y, &samples.wo_z})
      reserve(*array);
    for (std::vector<double>& array : samples.values) reserve(array);
    reserve(samples.origin);
    if (uncertainty_.HasWeights()) reserve(samples.weight);
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
    ranges_->Add(row);
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
    if (uncertainty_.HasWeights() && !uncertainty_.Find(row, group, line, factor, &weight)) {
      builder->Skip(SetAsideReason::kFlagged);
      return;
    }
    if (by_wavelength_) {
      AddWavelength(row, group, {wi, wo, 0, values_[0], weight, line}, builder);
    } else if (builder->Add(wi, wo, values_.data(), line)) {
      if (uncertainty_.HasWeights()) builder->measurement().samples.weight.push_back(weight);
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

  const InputFile& file_;
  const ReadOptions& options_;
  CsvHeader header_;
  CsvLayout layout_;
  Measurement notes_;
  RepeatedRows repeated_ = RepeatedRows::kFirst;
  Coordinates at_ = {};
  std::optional<AngleRanges> ranges_;  // as soon as the layout is known
  std::vector<double> values_;
  std::optional<WavelengthTable> by_wavelength_;  // where rows have wavelengths of their own
  MarkTally marks_;
  std::size_t rows_ = 0;
  AmidRows amid_rows_{file_, layout_, &header_, &at_};
  RowPolarisations polarisations_{header_, layout_};
  RowUncertainty uncertainty_{file_, header_, layout_};
};

}  // namespace

Measurement ReadCsv(const InputFile& file, const ReadOptions& options) { return CsvReader(file, options).Read(); }

}  // namespace lobefit
