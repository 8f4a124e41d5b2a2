#include "lobefit/io/csv/rows/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/mapping.h"
#include "lobefit/io/csv/head/row_conditions.h"
#include "lobefit/io/csv/head/value_mention.h"
#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/io/csv/names/polarised_columns.h"
#include "lobefit/io/csv/rows/angles.h"
#include "lobefit/io/csv/rows/uncertainties.h"
#include "lobefit/io/csv/rows/value_columns.h"
#include "lobefit/io/csv/rows/value_unit.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

std::string NamesOf(const std::vector<CsvColumn>& columns) {
  std::vector<std::string> names;
  for (const CsvColumn& column : columns) names.push_back(Excerpt(column.name));
  return Excerpt(Join(names), 200);
}

// "counts", "Signal (V)": what a detector says, in units of its own.
bool IsReading(const CsvColumn& column) {
  static constexpr std::array<std::string_view, 8> kReadings = {"counts", "signal",   "voltage",   "current",
                                                                "power",  "radiance", "intensity", "raw"};
  if (column.role != ColumnRole::kIgnored && column.role != ColumnRole::kUnknown) return false;
  const NameList words = SplitName(column.name).words;
  return !words.empty() && std::find(kReadings.begin(), kReadings.end(), words[0]) != kReadings.end();
}

// "sample", "scan": what can tell rows of the same directions apart, though no number needs it.
bool TellsRowsApart(const CsvColumn& column) {
  static constexpr std::array<std::string_view, 6> kParts = {"sample", "material", "scan", "file", "filename", "user"};
  return column.role == ColumnRole::kIgnored &&
         std::find(kParts.begin(), kParts.end(), ToLower(column.name)) != kParts.end();
}

// Turns the header into a layout, or says what is missing, unknown or ambiguous.
class LayoutBuilder {
 public:
  LayoutBuilder(const InputFile& file, const CsvHeader& header, const ReadOptions& options, Measurement* measurement)
      : file_(file), header_(header), options_(options), columns_(header.columns), measurement_(measurement) {}

  CsvLayout Build() {
    FindFilters();
    ResolveLetters();
    ResolveZeros();
    ResolveHead();
    FindAngles(file_, header_, options_, &columns_, &layout_, measurement_);
    layout_.wavelength = FindOnly(ColumnRole::kWavelength);
    FindPolarisations();
    const std::string value_column = options_.value_column.value_or(header_.keys.value_column);
    if (!value_column.empty()) {
      ChooseValueColumn(value_column);
    } else if (!ChooseFixedGroups() && !ChoosePolarised()) {
      ChooseChannels();
    }
    FindWavelength();
    layout_.weight = FindOnly(ColumnRole::kWeight);
    FindUncertainties(file_, header_, columns_, &layout_, measurement_);
    SpreadSideTables(file_, header_, &layout_);
    CheckColumns();
    FindValueUnit(file_, header_, options_, columns_, &layout_, measurement_);
    MarkNumbers();
    return std::move(layout_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { FailAtLine(file_, header_.names_line, what); }

  std::size_t FindOnly(ColumnRole role) const {
    std::size_t found = kNoColumn;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].role != role) continue;
      if (found != kNoColumn)
        Fail("the columns " + QuotedName(columns_[found]) + " and " + QuotedName(columns_[i]) +
             " mean the same; remove one of them");
      found = i;
    }
    return found;
  }

  // --where COLUMN=VALUE,...
  void FindFilters() {
    const std::string& text = options_.where.empty() ? header_.keys.where : options_.where;
    if (Trim(text).empty()) return;
    for (const RowCondition& condition : ParseRowConditions(text)) {
      const std::size_t column = FindColumn(columns_, condition.column);
      if (column == columns_.size()) {
        Fail("no column is named '" + Excerpt(condition.column) + "', which --where asks for; the columns are " +
             NamesOf(columns_));
      }
      layout_.filters.push_back({column, condition.word});
    }
    measurement_->conventions["where"] = Excerpt(text, 80) + (options_.where.empty() ? " (header)" : " (option)");
  }

  // Those that --where does not choose one of.
  void FindPolarisations() {
    bool light_chosen = false;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].role != ColumnRole::kPolarisation) continue;
      const bool chosen = std::any_of(layout_.filters.begin(), layout_.filters.end(),
                                      [&](const RowFilter& filter) { return filter.column == i; });
      light_chosen = light_chosen || (chosen && !columns_[i].of_viewer);
      if (!chosen) layout_.polarisations.push_back(i);
    }
    if (layout_.polarisations.size() > 2) {
      Fail("more than two columns hold a polarisation: " + QuotedName(columns_[layout_.polarisations[0]]) + ", " +
           QuotedName(columns_[layout_.polarisations[1]]) + ", ...; choose rows with --where");
    }
    // The light's state chosen, f_r is the sum over the detector's, which the average is not.
    if (light_chosen && layout_.polarisations.size() == 1 && columns_[layout_.polarisations[0]].of_viewer) {
      Fail("--where chooses a polarisation of the light; choose one of " +
           QuotedName(columns_[layout_.polarisations[0]]) + " too");
    }
  }

  bool IsPolarisation(std::size_t i) const {
    return std::find(layout_.polarisations.begin(), layout_.polarisations.end(), i) != layout_.polarisations.end();
  }

  // "f_R" is f_r where no "f_G" and "f_B" stand beside it, and a channel where they do.
  void ResolveLetters() {
    for (CsvColumn& column : columns_) {
      if (column.role != ColumnRole::kValue) continue;
      const NameWords split = SplitName(column.name);
      if (split.words.size() != 2 || split.words[1] != "r") continue;
      const auto sibling = [&](const char* letter) {
        return std::any_of(columns_.begin(), columns_.end(), [&](const CsvColumn& other) {
          const NameWords name = SplitName(other.name);
          return other.role == ColumnRole::kChannel && name.words.size() == 2 && name.words[0] == split.words[0] &&
                 name.words[1] == letter;
        });
      };
      if (!sibling("g") && !sibling("b")) continue;
      column.role = ColumnRole::kChannel;
      column.channel = "R";
    }
  }

  // "theta_o 0" is "theta_o - theta_0", but beside "theta_o 10" a column of its own angle.
  void ResolveZeros() {
    for (CsvColumn& column : columns_) {
      if (column.role != ColumnRole::kCoordinate) continue;
      CsvColumn fixed = column;
      if (!ClassifyFixed(SplitName(column.name).words, &fixed) || fixed.role != ColumnRole::kFixed) continue;
      const bool sibling = std::any_of(columns_.begin(), columns_.end(), [&](const CsvColumn& other) {
        return other.role == ColumnRole::kFixed && other.coordinate == fixed.coordinate;
      });
      if (sibling) column = fixed;
    }
  }

  // Names that are numbers, where the head says what they are.
  void ResolveHead() {
    const bool chosen = options_.value_column || !header_.keys.value_column.empty();
    const std::string repetitions = header_.head_coordinate ? "" : SetRepetitionsAside(chosen, &columns_);
    if (!repetitions.empty()) Fail(repetitions);
    std::vector<std::string> numbers;
    for (CsvColumn& column : columns_) {
      const bool bare = column.role == ColumnRole::kChannel && column.wavelength_nm > 0 &&
                        ParseCsvNumber(column.name, header_.decimal_mark);
      if (column.role != ColumnRole::kNumber && !(bare && header_.head_coordinate)) continue;
      if (!header_.head_coordinate) {
        numbers.push_back(Excerpt(column.name));
        continue;
      }
      if (bare) column.fixed = *ParseCsvNumber(column.name, header_.decimal_mark);
      column.role = ColumnRole::kFixed;
      column.coordinate = *header_.head_coordinate;
    }
    if (numbers.size() > 1) {
      Fail("the names of columns are numbers: " + Excerpt(Join(numbers), 80) +
           "; say what they are by --columns, as in theta_i=names, or write one row a value with the columns theta_i, "
           "theta_o, dphi, brdf");
    }
  }

  void ChooseValueColumn(const std::string& name) {
    const std::size_t at = FindColumn(columns_, name);
    if (at == columns_.size())
      Fail("no column is named '" + Excerpt(name) + "', which --value-column asks for; the columns are " +
           NamesOf(columns_));
    CsvColumn& column = columns_[at];
    // "Panel BRF" is one, whatever else stands beside it.
    if (!column.value_kind) column.value_kind = KindNamedIn(column.name);
    if (IsReading(column) && !column.value_scale) column.value_scale = ValueScale{ValueScale::Form::kLinear, 1, true};
    layout_.groups = {{{}, {at}}};
    layout_.channels.names = {column.role == ColumnRole::kChannel ? column.channel : "Y"};
    if (column.wavelength_nm > 0) layout_.channels.wavelengths_nm = {column.wavelength_nm};
    measurement_->conventions["value-column"] = column.name + " (option)";
  }

  // A table with a column for each angle.
  bool ChooseFixedGroups() {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i].role != ColumnRole::kFixed) continue;
      layout_.groups.push_back({{{columns_[i].coordinate, columns_[i].fixed}}, {i}});
      if (columns_[i].fixed_incidence)
        layout_.groups.back().fixed.emplace_back(Coordinate::kThetaI, *columns_[i].fixed_incidence);
    }
    if (layout_.groups.empty()) return false;
    const auto value = std::find_if(columns_.begin(), columns_.end(),
                                    [](const CsvColumn& column) { return column.role == ColumnRole::kValue; });
    if (value != columns_.end()) {
      Fail("the column " + QuotedName(columns_[layout_.groups[0].values[0]]) +
           " holds values at one angle, by its name, but " + QuotedName(*value) +
           " holds values too; say what they are by --columns, or choose one with --value-column");
    }
    layout_.channels.names = {"Y"};
    measurement_->conventions["value-column"] =
        "one for each angle: " + std::to_string(layout_.groups.size()) + " columns";
    return true;
  }

  // "f_s" is the scattered light's, but beside "f_p" one of two polarisations. A column of their mean is used as it is.
  bool ChoosePolarised() {
    const PolarisedColumns polarised = FindPolarisedColumns(columns_);
    for (std::size_t k = 0; k < polarised.columns.size(); ++k) {
      CsvColumn& column = columns_[polarised.columns[k]];
      column.role = polarised.mean_is_given ? ColumnRole::kIgnored : ColumnRole::kValue;
      column.value_kind = polarised.value_kind;
      const std::string unit = std::exchange(column.unit, {});
      SetUnit(unit, &column);
      if (!polarised.mean_is_given) layout_.groups.push_back({{}, {polarised.columns[k]}, polarised.states[k]});
    }
    if (layout_.groups.empty()) return false;
    if (std::any_of(columns_.begin(), columns_.end(),
                    [](const CsvColumn& column) { return column.role == ColumnRole::kPolarisation; }))
      Fail("polarisations stand in a column and in the names of others; choose one with --value-column");
    layout_.channels.names = {"Y"};
    measurement_->conventions["value-column"] =
        "one for each polarisation: " + std::to_string(layout_.groups.size()) + " columns";
    return true;
  }

  void ChooseChannels() {
    std::vector<std::size_t> mono, spectral;
    std::map<std::string, std::size_t> letters;
    std::set<double> wavelengths;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const CsvColumn& column = columns_[i];
      if (column.role == ColumnRole::kValue) mono.push_back(i);
      if (column.role != ColumnRole::kChannel) continue;
      if (column.wavelength_nm > 0) {
        if (!wavelengths.insert(column.wavelength_nm).second)
          Fail("two columns hold the channel " + column.channel + "; remove one of them");
        spectral.push_back(i);
      } else if (!letters.emplace(column.channel, i).second) {
        Fail("two columns are named " + QuotedName(column) + "; remove one of them");
      }
    }
    std::vector<std::vector<std::size_t>> candidates;
    for (const std::size_t i : mono) candidates.push_back({i});
    const bool has_xyz = letters.contains("X") && letters.contains("Z");
    if (letters.contains("Y") && !has_xyz) candidates.push_back({letters["Y"]});
    for (const char* triple : {"RGB", "XYZ"}) {
      std::vector<std::size_t> found;
      for (const char c : std::string_view(triple)) {
        if (letters.contains(std::string(1, c))) found.push_back(letters[std::string(1, c)]);
      }
      if (found.size() == 3) candidates.push_back(found);
      const bool lone_y = found.size() == 1 && letters.contains("Y") && triple[0] == 'X';
      if (!found.empty() && found.size() < 3 && !lone_y) {
        Fail("of the channels " + std::string(triple) + " only " + std::to_string(found.size()) +
             " are given; give all three, or choose one column with --value-column");
      }
    }
    constexpr std::size_t kMostWavelengths = 4096;
    if (spectral.size() > kMostWavelengths) {
      Fail(std::to_string(spectral.size()) + " columns hold wavelengths; at most " + std::to_string(kMostWavelengths) +
           " are read: take out some, or choose one with --value-column");
    }
    if (!spectral.empty()) candidates.push_back(spectral);
    if (candidates.size() != 1) {
      std::vector<std::string> names;
      for (const std::vector<std::size_t>& candidate : candidates) {
        names.push_back(Excerpt(columns_[candidate[0]].name) + (candidate.size() > 1 ? "..." : ""));
      }
      if (!candidates.empty())
        Fail("several columns can be the value: " + Excerpt(Join(names), 200) + "; choose one with --value-column");
      const bool known = options_.value_kind || header_.keys.value_kind || FindValueMention(header_.titles).kind;
      const std::vector<std::string> reflectances = TakeReflectances(known, &columns_);
      if (!reflectances.empty() && known) return ChooseChannels();
      if (!reflectances.empty()) {
        Fail("the columns " + Excerpt(Join(reflectances), 80) +
             " can be reflectance factors, pi f_r, or f_r; say it with --value-kind pi-f or --value-kind f");
      }
      const std::size_t other = FindPossibleValue(columns_);
      // "Reflectance" below "BRF Values".
      if (other < columns_.size() && columns_[other].role == ColumnRole::kOtherValue && !options_.value_kind &&
          FindValueMention(header_.titles).kind) {
        columns_[other].role = ColumnRole::kValue;
        return ChooseChannels();
      }
      if (other < columns_.size() && TakeOnlyNamed(&columns_)) return ChooseChannels();
      if (other < columns_.size()) {
        Fail("the column " + QuotedName(columns_[other]) +
             " can be f_r, pi f_r, f_r times a cosine or something else; say it with --value-column \"" +
             Excerpt(columns_[other].name) + "\" and --value-kind f|pi-f|f-cos-o|f-cos-i");
      }
      const auto reading = std::find_if(columns_.begin(), columns_.end(), IsReading);
      if (reading != columns_.end()) {
        Fail("no column holds f_r; " + QuotedName(*reading) +
             " can be readings of an unknown scale: choose them with "
             "--value-column \"" +
             Excerpt(reading->name) + "\", and fit with --scale free");
      }
      const std::vector<std::string> unknown = FindUnknownNumbers(header_, columns_);
      if (!unknown.empty()) {
        Fail("no column is known to hold values; if it is one of " + Excerpt(Join(unknown), 120) +
             ", choose it with --value-column \"" + unknown[0] +
             "\" (and --value-kind, where it is not f_r). Allowed: " + AllowedColumns());
      }
      Fail("no column holds values; allowed: " + AllowedColumns() + "; or choose one with --value-column");
    }
    layout_.groups = {{{}, candidates[0]}};
    for (const std::size_t i : candidates[0]) {
      const CsvColumn& column = columns_[i];
      layout_.channels.names.push_back(column.role == ColumnRole::kChannel ? column.channel : "Y");
      if (column.wavelength_nm > 0) layout_.channels.wavelengths_nm.push_back(column.wavelength_nm);
    }
    if (candidates[0].size() == 1) measurement_->conventions["value-column"] = columns_[candidates[0][0]].name;
  }

  // The unit of a column that does not say it: what all of the first rows can be.
  void FindWavelength() {
    const bool stated = header_.keys.wavelength_nm.has_value();
    layout_.by_wavelength = layout_.wavelength != kNoColumn ||
                            (stated && layout_.channels.wavelengths_nm.empty() && layout_.channels.size() == 1);
    if (layout_.wavelength == kNoColumn) return;
    if (layout_.channels.size() != 1) {
      Fail("a wavelength column goes with one column of values, but there are " +
           std::to_string(layout_.channels.size()));
    }
    const CsvColumn& column = columns_[layout_.wavelength];
    const char* origin = " (column name)";
    if (header_.keys.wavelength_unit) {
      layout_.wavelength_unit = *header_.keys.wavelength_unit;
      origin = " (header)";
    } else if (column.wavelength_unit) {
      layout_.wavelength_unit = *column.wavelength_unit;
    } else {
      double largest = 0;
      for (const std::vector<std::string>& row : header_.first_rows) {
        const std::optional<double> number = layout_.wavelength < row.size()
                                                 ? ParseCsvNumber(row[layout_.wavelength], header_.decimal_mark)
                                                 : std::nullopt;
        if (number) largest = std::max(largest, *number);
      }
      // Nanometres of an optical instrument have three digits or more, micrometres at most two before the point.
      layout_.wavelength_unit = *ParseWavelengthUnit(largest < 1e-3 ? "m" : largest < 100 ? "um" : "nm");
      origin = " (by the first rows)";
    }
    measurement_->conventions["wavelength-unit"] = std::string(layout_.wavelength_unit.name) + origin;
  }

  bool IsUsed(std::size_t i) const {
    const auto is_value = [&](const ValueGroup& group) {
      return i == group.sigma || std::find(group.values.begin(), group.values.end(), i) != group.values.end() ||
             std::any_of(group.coordinates.begin(), group.coordinates.end(),
                         [&](const auto& entry) { return entry.second == i; });
    };
    return std::any_of(layout_.groups.begin(), layout_.groups.end(), is_value) || i == layout_.sigma ||
           i == layout_.weight || i == layout_.wavelength || IsPolarisation(i) ||
           std::find(layout_.channel_sigmas.begin(), layout_.channel_sigmas.end(), i) != layout_.channel_sigmas.end() ||
           std::any_of(layout_.filters.begin(), layout_.filters.end(),
                       [&](const RowFilter& filter) { return filter.column == i; }) ||
           std::any_of(layout_.coordinates.begin(), layout_.coordinates.end(),
                       [&](const auto& entry) { return entry.second == i; });
  }

  void CheckColumns() {
    std::vector<std::string> ignored;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const CsvColumn& column = columns_[i];
      if (IsUsed(i)) {
        if (!column.problem.empty() && !(options_.angle_unit && column.role == ColumnRole::kCoordinate) &&
            !(IsValue(i) && HasValueScale())) {
          Fail("column " + std::to_string(i + 1) + ", " + QuotedName(column) + ", " + column.problem);
        }
        continue;
      }
      if (column.name.empty() || i >= header_.written_columns) continue;
      if (LooksLikeAngle(column) && !options_.value_column) {
        Fail("column " + std::to_string(i + 1) + " is named " + QuotedName(column) +
             ", which speaks of an angle but is not known; allowed: " + AllowedColumns() +
             "; or choose the column of values with --value-column, then unknown ones are ignored");
      }
      if (MarksRows(column)) {
        measurement_->remarks.push_back("the column " + QuotedName(column) +
                                        " may say which rows are good and was not used; choose them with --where \"" +
                                        Excerpt(column.name) + "=...\"");
        continue;
      }
      ignored.push_back(Excerpt(column.name));
      if (column.role == ColumnRole::kUnknown || TellsRowsApart(column)) layout_.unused.push_back(i);
    }
    if (ignored.size() > 8) {
      const std::string more = " and " + std::to_string(ignored.size() - 8) + " more";
      ignored.resize(8);
      ignored.back() += more;
    }
    if (!ignored.empty()) measurement_->remarks.push_back("columns not used: " + Join(ignored));
  }

  // A column that tells good rows from bad ones, by its name and by more than one word in the first rows.
  bool MarksRows(const CsvColumn& column) const {
    const NameWords split = SplitName(column.name);
    if (split.words.size() > 2) return false;
    const bool named = std::any_of(split.words.begin(), split.words.end(), [](const std::string& word) {
      return word == "flag" || word == "flags" || word == "valid" || word == "validity" || word == "status" ||
             word == "quality" || word == "good" || word == "bad" || word == "ok" || word == "saturated" ||
             word == "overload" || word == "mask" || word == "masked" || word == "usable" || word == "outlier";
    });
    const auto at = static_cast<std::size_t>(&column - columns_.data());
    std::set<std::string> words;
    for (const std::vector<std::string>& row : header_.first_rows) {
      if (at < row.size()) words.insert(row[at]);
    }
    return named && words.size() > 1;
  }

  bool IsValue(std::size_t i) const {
    return std::any_of(layout_.groups.begin(), layout_.groups.end(), [&](const ValueGroup& group) {
      return std::find(group.values.begin(), group.values.end(), i) != group.values.end();
    });
  }
  bool HasValueScale() const { return !options_.value_scale.empty() || header_.keys.value_scale; }

  void MarkNumbers() {
    layout_.is_number.assign(columns_.size(), false);
    for (std::size_t i = 0; i < columns_.size(); ++i) layout_.is_number[i] = IsUsed(i) && !IsPolarisation(i);
    for (const RowFilter& filter : layout_.filters) {
      const bool only_filtered = std::none_of(layout_.coordinates.begin(), layout_.coordinates.end(),
                                              [&](const auto& entry) { return entry.second == filter.column; }) &&
                                 !IsValue(filter.column) && filter.column != layout_.wavelength &&
                                 filter.column != layout_.sigma && filter.column != layout_.weight;
      if (only_filtered) layout_.is_number[filter.column] = false;
    }
  }

  const InputFile& file_;
  const CsvHeader& header_;
  const ReadOptions& options_;
  std::vector<CsvColumn> columns_;
  Measurement* measurement_;
  CsvLayout layout_;
};

}  // namespace

CsvLayout ReadCsvLayout(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                        Measurement* notes) {
  return LayoutBuilder(file, header, options, notes).Build();
}

}  // namespace lobefit
