#include "lobefit/io/csv/amid_rows.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/cells.h"
#include "lobefit/io/csv/head/head_lines.h"
#include "lobefit/io/csv/names/name_rules.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostProse = 64;

std::string WithoutNumbers(std::string_view text) {
  std::string words;
  for (const char c : text) {
    if (std::string_view("0123456789.,+-").find(c) == std::string_view::npos) words.push_back(c);
  }
  return words;
}

}  // namespace

void AmidRows::TakeWords(std::string_view line, std::size_t number, const RowParser& parser) {
  // Of a file that was put behind another.
  if (line.starts_with("\ufeff")) line.remove_prefix(3);
  std::vector<std::string_view> fields;
  SplitCsvLine(line, header_.separator, &fields);
  if (Trim(line) == Trim(header_.names) || AreNamesAgain(fields) || AreUnitsAgain(fields)) {
    // What stands above names is the head of a page.
    if (page_.empty() && !message_.empty()) page_ = "'" + text_ + "' in line " + std::to_string(line_);
    message_.clear();
    words_ = 0;
    return;
  }
  if (ReadKeyAmidRows(number, {}, fields)) return;
  ++words_;
  const bool names = fields.size() > 1 && NamesADirection(Classify(fields));
  if (!message_.empty() && !names) return;
  line_ = number;
  message_ = names ? "names other columns than line " + std::to_string(header_.names_line) +
                         ", or in another order or unit; put each table into a file of its own"
                   : parser.WordsMessage();
  text_ = Excerpt(Trim(line));
}

// The same columns in the same order, however their names are spelt.
bool AmidRows::AreNamesAgain(const std::vector<std::string_view>& fields) const {
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

// A row of units below names that stand there again: the same units.
bool AmidRows::AreUnitsAgain(const std::vector<std::string_view>& fields) const {
  if (fields.size() > header_.columns.size()) return false;
  std::string storage;
  bool any = false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view unit = Unquoted(fields[i], &storage);
    if (unit.empty()) continue;
    if (!IsUnitOrBlank(unit)) return false;
    CsvColumn again = ClassifyColumn(header_.columns[i].name);
    again.unit.clear();
    SetUnit(unit, &again);
    if (again.unit != header_.columns[i].unit) return false;
    any = true;
  }
  return any;
}

void AmidRows::TakeComment(std::size_t number, std::string_view text) {
  constexpr std::size_t kMostComments = 10000;
  text = WithoutEmptyCells(text, header_.separator);
  if (!ReadKeyAmidRows(number, text, {}) && !text.empty() && header_.comments.size() < kMostComments)
    header_.comments.emplace_back(PlainComment(text));
}

bool AmidRows::ReadKeyAmidRows(std::size_t number, std::string_view comment,
                               const std::vector<std::string_view>& fields) {
  if (!comment.empty() && comment.find_first_of(":=") == std::string_view::npos) {
    RequireKeptUnits(number, FindColumnUnits(comment));
    if (!MayStateAnAngle(comment)) return false;
  }
  CsvKeys keys = header_.keys;
  if (!(fields.empty() ? ReadKey(file_, number, comment, &keys) : ReadKey(file_, number, fields, &keys))) {
    if (!comment.empty() && !MentionsAnAngle(number, comment) && prose_.size() < kMostProse)
      prose_.insert(WithoutNumbers(comment));
    return false;
  }
  RequireSameUnits(file_, number, header_.keys, keys);
  RequireKeptUnits(number, {keys.column_units.begin() + static_cast<std::ptrdiff_t>(header_.keys.column_units.size()),
                            keys.column_units.end()});
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

// "# theta_i 30" before the next part, as the head states it of the first. Comments of a hundred thousand rows have the
// same words about other numbers: what was prose before is not looked at again, nor are rows that were commented out.
bool AmidRows::MayStateAnAngle(std::string_view comment) const {
  constexpr std::size_t kLongest = 60;
  const bool stated = !header_.keys.fixed.empty() || header_.keys.wavelength_nm;
  if (!stated || comment.size() > kLongest || comment.find_first_of("0123456789") == std::string_view::npos ||
      std::none_of(comment.begin(), comment.end(), [](char c) { return (c | 0x20) >= 'a' && (c | 0x20) <= 'z'; }))
    return false;
  return prose_.find(WithoutNumbers(comment)) == prose_.end();
}

// "Scan 2: theta_i 45", which is no key: whether rows lie at another angle from there on, only its writer knows.
bool AmidRows::MentionsAnAngle(std::size_t number, std::string_view comment) const {
  constexpr std::size_t kMostWords = 8, kLongestName = 3;
  static constexpr std::array<std::string_view, 10> kParts = {"thet", "inc",  "aoi", "angl", "winkel",
                                                              "phi",  "azim", "emi", "sza",  "vza"};
  if (header_.keys.fixed.empty() || !HoldsAnyPart(ToLower(comment), kParts)) return false;
  std::string text(comment);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return std::string_view(":=,;()").find(c) != std::string_view::npos; },
      ' ');
  std::vector<std::string_view> words = SplitBlanks(text);
  std::erase_if(words, [](std::string_view word) { return word == "is" || word == "-" || word == "at"; });
  if (words.size() > kMostWords) return false;
  bool mentioned = false;
  for (std::size_t at = 1; at < words.size(); ++at) {
    const std::optional<double> angle = ParseDouble(NumberOfCell(words[at]));
    if (!angle) continue;
    for (std::size_t length = 1; length <= std::min(at, kLongestName); ++length) {
      const auto first = words.begin() + static_cast<std::ptrdiff_t>(at - length);
      const CsvColumn column =
          ClassifyColumn(Join(std::vector<std::string>(first, first + static_cast<std::ptrdiff_t>(length)), " "));
      const FixedCoordinate* stated =
          column.role == ColumnRole::kCoordinate ? header_.keys.Find(column.coordinate) : nullptr;
      if (stated == nullptr) continue;
      mentioned = true;
      if (stated->number == *angle) continue;
      FailAtLine(file_, number,
                 "'" + Excerpt(comment) + "' names another angle than that of the rows before, " +
                     FormatDouble(stated->number) + "; where the rows after it lie there, write it as '# " +
                     column.name + ": " + FormatDouble(*angle) + "', else without the angle");
    }
  }
  return mentioned;
}

// A file put behind another may have other units.
void AmidRows::RequireKeptUnits(std::size_t number, const std::vector<ColumnUnit>& stated) const {
  for (const ColumnUnit& unit : stated) {
    if (KeepsUnits(unit, header_.columns, header_.keys.angle_unit.value_or(AngleUnit::kDegrees))) continue;
    FailAtLine(file_, number,
               "the unit of '" + Excerpt(unit.column) + "' is stated as '" + Excerpt(unit.unit) +
                   "' here, other than that of the rows before; put the parts into files of their own and name them "
                   "all");
  }
}

void AmidRows::Fail() const { FailAtLine(file_, line_, message_); }

std::string AmidRows::Remark() const {
  return std::to_string(words_) + (words_ == 1 ? " line" : " lines") + " after the last row, from line " +
         std::to_string(line_) + " on, hold no row: '" + text_ + "'";
}

}  // namespace lobefit
