#include "lobefit/io/csv/rows/row_parser.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/plain_decimal.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

constexpr unsigned char kNumber = 1, kText = 2, kMayLack = 4;

// "5 530,6"
bool HasBlankWithin(std::string_view field) {
  field = Trim(field);
  const std::size_t blank = field.find(' ');
  return blank != std::string_view::npos && field.find_first_not_of("+-0123456789., ") == std::string_view::npos;
}

}  // namespace

RowParser::RowParser(const InputFile& file, const CsvHeader& header, const CsvLayout& layout, NoValues no_values)
    : file_(file),
      header_(header),
      no_values_(std::move(no_values)),
      written_(header.written_columns),
      needed_(header.columns.size(), 0),
      numbers_(header.columns.size(), 0.0),
      texts_(header.columns.size()) {
  for (std::size_t i = 0; i < needed_.size(); ++i) needed_[i] = layout.is_number[i] ? kNumber : 0;
  for (const ValueGroup& group : layout.groups) {
    for (const std::size_t i : group.values) needed_[i] |= kMayLack;
    if (group.sigma != kNoColumn) needed_[group.sigma] |= kMayLack;
    for (const auto& [coordinate, i] : group.coordinates) needed_[i] |= kMayLack;
  }
  if (layout.sigma != kNoColumn) needed_[layout.sigma] |= kMayLack;
  for (const std::size_t i : layout.channel_sigmas) needed_[i] |= kMayLack;
  for (const RowFilter& filter : layout.filters) needed_[filter.column] |= kText;
  for (const std::size_t i : layout.polarisations) needed_[i] |= kText;
  for (std::size_t i = 0; i < written_; ++i) {
    fast_.push_back((needed_[i] & (kNumber | kText)) == kNumber &&
                    ((needed_[i] & kMayLack) == 0 || no_values_.empty()));
  }
  is_table_ = layout.groups.size() > 1;
}

// A field that is not a plain number.
void RowParser::TakeOther(std::string_view field, std::size_t column) {
  if (column >= written_) {
    if (!Trim(field).empty()) ++filled_beyond_;
    return;
  }
  const unsigned char needed = needed_[column];
  if (needed == 0) return;
  const std::string_view text = Unquoted(field, &storage_);
  if ((needed & kText) != 0)
    texts_[column] = text.data() >= field.data() && text.data() <= field.data() + field.size() ? text : Trim(field);
  if ((needed & kNumber) == 0) return;
  const std::optional<double> number = ParseCsvNumber(text, header_.decimal_mark);
  // "nan(ind)" of C libraries is read as a number that is none.
  if (number && !(std::isnan(*number) && IsNoValueWord(text))) {
    ++good_;
    numbers_[column] = *number;
    if ((needed & kMayLack) != 0 && !no_values_.empty() && no_values_.Holds(*number)) {
      numbers_[column] = std::nan("");
      marks_.emplace_back(column, Trim(field));
    }
    return;
  }
  if (!header_.cells.empty() && TakeCell(text, column)) return;
  numbers_[column] = std::nan("");
  if ((needed & kMayLack) != 0 && (IsNoValueWord(text) || no_values_.Holds(text))) {
    marks_.emplace_back(column, Trim(field));
    return;
  }
  if (bad_ == 0) {
    bad_column_ = column;
    bad_field_ = field;
  }
  ++bad_;
}

// A number with its unit or uncertainty, of the form that the first rows have.
bool RowParser::TakeCell(std::string_view text, std::size_t column) {
  const CellForm& form = header_.cells[column];
  if (form.unit.empty() && form.uncertainty == 0) return false;
  std::optional<Cell> cell;
  // Most cells are written as the first one.
  if (!form.suffix.empty() && text.ends_with(form.suffix)) {
    const std::optional<double> number =
        ParseCsvNumber(text.substr(0, text.size() - form.suffix.size()), header_.decimal_mark);
    if (number) cell = Cell{*number, std::nullopt, form.unit};
  }
  if (!cell) cell = ParseCell(text, header_.decimal_mark);
  if (!cell || (!cell->unit.empty() && cell->unit != form.unit) || (cell->uncertainty && form.uncertainty == 0))
    return false;
  ++good_;
  numbers_[column] = cell->number;
  if (cell->uncertainty) numbers_[form.uncertainty] = *cell->uncertainty;
  if ((needed_[column] & kMayLack) != 0 && !no_values_.empty() && no_values_.Holds(cell->number)) {
    numbers_[column] = std::nan("");
    marks_.emplace_back(column, text);
  }
  return true;
}

void RowParser::SplitFast(std::string_view line) {
  const char separator = header_.separator, mark = header_.decimal_mark;
  std::size_t begin = 0;
  while (true) {
    // Most fields are plain numbers that fill their field: one pass over the characters.
    if (columns_ < written_ && fast_[columns_] != 0 && begin < line.size()) {
      const std::size_t quote = line[begin] == '"' ? 1 : 0;
      std::size_t length = 0;
      // Between commas only a number in quotes has a decimal comma.
      const std::optional<double> plain =
          ParsePlainDecimal(line.substr(begin + quote), &length, mark == separator && quote == 0 ? '.' : mark);
      std::size_t end = begin + quote + length;
      if (plain && quote == 1) end = end < line.size() && line[end] == '"' ? end + 1 : line.size() + 1;
      if (plain && (end == line.size() || (end < line.size() && line[end] == separator))) {
        numbers_[columns_++] = *plain;
        ++good_;
        if (end == line.size()) return;
        begin = end + 1;
        continue;
      }
    }
    std::size_t end = line.find(separator, begin);
    const std::size_t quote = line.find('"', begin);
    if (quote < end) {
      std::vector<std::string_view> rest;
      SplitQuoted(line.substr(begin), separator, &rest);
      end = rest.size() > 1 ? begin + rest[0].size() : std::string_view::npos;
    }
    TakeOther(line.substr(begin, end - begin), columns_);
    ++columns_;
    if (end == std::string_view::npos) return;
    begin = end + 1;
  }
}

void RowParser::SplitBlankSeparated(std::string_view line) {
  std::size_t at = 0;
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; };
  while (true) {
    while (at < line.size() && is_blank(line[at])) ++at;
    if (at == line.size()) return;
    std::size_t length = 0;
    std::optional<double> plain;
    if (columns_ < written_ && fast_[columns_] != 0)
      plain = ParsePlainDecimal(line.substr(at), &length, header_.decimal_mark);
    std::size_t end = at + length;
    if (plain && (end == line.size() || is_blank(line[end]))) {
      numbers_[columns_] = *plain;
      ++good_;
    } else {
      end = at;
      while (end < line.size() && !is_blank(line[end])) ++end;
      TakeOther(line.substr(at, end - at), columns_);
    }
    ++columns_;
    at = end;
  }
}

RowParser::Kind RowParser::Parse(std::string_view line, std::size_t line_number) {
  columns_ = good_ = bad_ = filled_beyond_ = 0;
  marks_.clear();
  for (std::size_t i = written_; i < numbers_.size(); ++i) numbers_[i] = std::nan("");
  if (header_.separator == kBlankSeparator) {
    SplitBlankSeparated(line);
  } else {
    SplitFast(line);
  }
  if (bad_ == 0 && columns_ == written_) return Kind::kRow;
  if (line.find_first_not_of(std::string{' ', '\t', '"', header_.separator}) == std::string_view::npos)
    return Kind::kBlank;
  if (good_ < 2 && (bad_ > 0 || columns_ < written_)) {
    if (bad_ == 0) bad_field_ = {};
    return Kind::kWords;
  }
  if (bad_ > 0 && (good_ < bad_ || IsSummary(line))) return Kind::kWords;
  // A table with a column for each angle may lack cells at the end of its rows; any row may have a separator there.
  bool lacks = false;
  for (std::size_t i = columns_; i < written_; ++i) {
    lacks = lacks || (needed_[i] != 0 && !(is_table_ && (needed_[i] & kMayLack) != 0));
    numbers_[i] = std::nan("");
    if ((needed_[i] & kMayLack) != 0) marks_.emplace_back(i, std::string_view());
  }
  if (filled_beyond_ > 0 || lacks) {
    FailAtLine(file_, line_number,
               "has " + std::to_string(columns_) + " fields; line " + std::to_string(header_.names_line) + " names " +
                   std::to_string(written_) + " columns" +
                   (header_.separator == ',' && filled_beyond_ > 0
                        ? " (with decimal commas, separate the fields by semicolons)"
                        : ""));
  }
  if (bad_ > 0) FailAtLine(file_, line_number, FieldMessage(bad_column_, bad_field_));
  return Kind::kRow;
}

// "Average;37,5;157,5;0,4": a row that a spreadsheet has put below the others.
bool RowParser::IsSummary(std::string_view line) const {
  static constexpr std::array<std::string_view, 20> kSummaries = {
      "mean",  "average", "avg", "median", "max",    "maximum",    "min",    "minimum", "sum",     "total",
      "count", "std",     "sd",  "stdev",  "stdev.", "mittelwert", "mittel", "summe",   "moyenne", "media"};
  std::vector<std::string_view> fields;
  SplitCsvLine(line, header_.separator, &fields);
  const auto first = std::find_if(fields.begin(), fields.end(), [](std::string_view f) { return !Trim(f).empty(); });
  if (first == fields.end()) return false;
  std::string storage, word = ToLower(Unquoted(*first, &storage));
  if (!word.empty() && word.back() == ':') word.pop_back();
  return std::find(kSummaries.begin(), kSummaries.end(), word) != kSummaries.end();
}

std::string RowParser::FieldMessage(std::size_t column, std::string_view field) const {
  std::string what = "column " + std::to_string(column + 1) + " (" + Excerpt(header_.columns[column].name) + ") ";
  if (Trim(field).empty()) {
    return what + ((needed_[column] & kMayLack) != 0
                       ? "is empty; write a number, or nan for a value that was not measured"
                       : "is empty; write its number into every row (cells that were merged hold it in the first)");
  }
  what += "is '" + Excerpt(Trim(field)) + "', which is not a number";
  const bool digits = field.find_first_of("0123456789") != std::string_view::npos;
  const bool apart = digits && (field.find('\'') != std::string_view::npos || field.find("\xc2\xa0") != field.npos ||
                                field.find("\xe2\x80\xaf") != field.npos || HasBlankWithin(field) ||
                                field.find("\xe2\x80\x99") != field.npos);
  const bool point_and_comma = field.find(',') != std::string_view::npos && field.find('.') != std::string_view::npos;
  const std::optional<Cell> cell = ParseCell(field, header_.decimal_mark);
  if (cell && cell->uncertainty) {
    what += "; write uncertainties into all cells of the column, or into a column of their own, 'sigma'";
  } else if (cell && !cell->unit.empty()) {
    const std::string unit = header_.cells.empty() ? std::string() : header_.cells[column].unit;
    what += unit.empty() ? "; write the unit into the name of the column, as in 'theta_i [deg]' or 'brdf [%]'"
                         : "; the cells before are in '" + unit + "': give all in one unit";
  } else if (field.find("\xc2\xb1") != std::string_view::npos || field.find("+/-") != std::string_view::npos) {
    what += "; write the uncertainty in the unit of the value, as in '0.31 ± 0.02', or into a column 'sigma'";
  } else if (digits && (field.find("\xc2\xb0") != std::string_view::npos || field.find("\xe2\x80\xb2") != field.npos)) {
    what += "; write degrees with decimals";
  } else if (apart || point_and_comma) {
    what += "; write numbers without separators between thousands";
  } else if (field.find(',') != std::string_view::npos) {
    what += "; write a decimal point instead of a comma";
  } else if (!digits && (needed_[column] & kMayLack) != 0) {
    what += "; if it stands for no value, use --no-value \"" + Excerpt(Trim(field)) + "\"";
  }
  return what;
}

std::string RowParser::WordsMessage() const {
  if (bad_ > 0) return FieldMessage(bad_column_, bad_field_);
  return "has " + std::to_string(columns_) + " fields; line " + std::to_string(header_.names_line) + " names " +
         std::to_string(written_) + " columns";
}

}  // namespace lobefit
