#include "lobefit/io/csv/head/header.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/conventions.h"
#include "lobefit/io/csv/head/head_lines.h"
#include "lobefit/io/csv/head/head_text.h"
#include "lobefit/io/csv/head/mapping.h"
#include "lobefit/io/csv/head/no_value.h"
#include "lobefit/io/csv/head/side_tables.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

using Fields = CsvFields;

constexpr std::size_t kFirstRows = 60;

class HeaderReader {
 public:
  HeaderReader(const InputFile& file, const std::string& columns)
      : file_(file), mapping_(columns), head_(ReadHeadText(file)), lines_(head_.lines), data_(head_.first_row) {
    header_.separator = head_.separator;
    header_.decimal_mark = head_.decimal_mark;
    if (head_.decimal_mark == ',') header_.remarks.emplace_back("decimal commas were read");
  }

  CsvHeader Read() {
    if (std::all_of(lines_.begin(), lines_.end(), [](const HeadLine& line) { return line.comment; })) {
      ReadCommentKeys();
      FailAtLine(file_, head_.last_line, "the file ends before a line of column names");
    }
    // A mapping of the columns may stand in the file; the option is the word of whoever reads it.
    ReadCommentKeys();
    if (mapping_.empty()) mapping_ = ColumnMapping(header_.keys.columns);
    const bool named = FindNames();
    ReadTitleKeys();
    if (!named) FailWithoutNames();
    // Names may stand in a comment.
    if (IsComment(header_.names)) std::erase(header_.comments, std::string(CommentText(header_.names)));
    mapping_.Fix(file_, header_.names_line, header_.columns, &header_.keys);
    if (mapping_.head()) header_.head_coordinate = mapping_.head();
    TakeConventionsOfNames(header_.names_line, &header_.columns, &header_.keys);
    TakeUnits();
    TakeRows();
    header_.written_columns = header_.columns.size();
    header_.cells = TakeCells(file_, header_.names_line, header_.first_rows, header_.decimal_mark, &header_.columns);
    if (may_be_side_tables_) TakeSideTables();
    return std::move(header_);
  }

 private:
  bool SetNames(std::size_t at, std::vector<CsvColumn> columns) {
    header_.columns = std::move(columns);
    header_.names_line = lines_[at].number;
    header_.names = std::string(lines_[at].text);
    names_ = at;
    return true;
  }

  // "theta_i,10,30" over "theta_o,,": the name of what the columns are stands in a line of its own, as pandas writes
  // it.
  bool TryPivot(std::size_t at, const Fields& fields) {
    if (fields.size() < 3 || at == 0 || lines_[at - 1].comment) return false;
    if (std::any_of(fields.begin() + 1, fields.end(), [](std::string_view field) { return !Trim(field).empty(); }))
      return false;
    const Fields above = SplitFields(lines_[at - 1].text, header_.separator);
    if (above.size() != fields.size() || !std::all_of(above.begin() + 1, above.end(), IsNumeric)) return false;
    std::vector<CsvColumn> columns = Classify(above);
    const CsvColumn head = columns[0];
    std::string storage;
    columns[0] = ClassifyColumn(Unquoted(fields[0], &storage));
    mapping_.Rename(&columns);
    if (head.role != ColumnRole::kCoordinate || columns[0].role != ColumnRole::kCoordinate ||
        head.coordinate == columns[0].coordinate)
      return false;
    header_.head_coordinate = head.coordinate;
    return SetNames(at, std::move(columns));
  }

  // "AOI,10,10,30,30" over "angle,BRDF,std,BRDF,std": a table of columns at fixed angles, whose name and numbers stand
  // in the line above. Names them as one line would: "AOI=10", "AOI=10 err".
  void TakeFixedAbove(std::size_t at, std::vector<CsvColumn>* columns) {
    if (at == 0 || lines_[at - 1].comment || columns->size() < 3) return;
    const Fields above = SplitFields(lines_[at - 1].text, header_.separator);
    if (above.size() != columns->size()) return;
    std::string storage;
    const std::string head(Unquoted(above[0], &storage));
    const CsvColumn coordinate = ClassifyColumn(head);
    if (coordinate.role != ColumnRole::kCoordinate || (*columns)[0].role != ColumnRole::kCoordinate) return;
    std::string number;
    std::vector<CsvColumn> named = {(*columns)[0]};
    std::size_t values = 0;
    for (std::size_t i = 1; i < above.size(); ++i) {
      const CsvColumn& own = (*columns)[i];
      if (!Trim(above[i]).empty()) number = std::string(NumberOfCell(Unquoted(above[i], &storage)));
      const bool spread = own.role == ColumnRole::kSigma;
      if (!ParseCsvNumber(number, header_.decimal_mark) || (own.role != ColumnRole::kValue && !spread)) return;
      std::replace(number.begin(), number.end(), ',', '.');
      named.push_back(ClassifyColumn(head + "=" + number + (spread ? " err" : "")));
      named.back().value_kind = own.value_kind;
      named.back().value_scale = own.value_scale;
      values += spread ? 0 : 1;
    }
    if (values > 1) *columns = std::move(named);
  }

  bool TryNames(std::size_t at) {
    const std::string_view text = lines_[at].comment ? CommentText(lines_[at].text) : lines_[at].text;
    const Fields fields = SplitNames(text, header_.separator, row_fields_);
    if (fields.size() < 2 || (fields.size() == 2 && IsNumeric(fields[1]))) return false;
    if (TryPivot(at, fields)) return true;
    std::vector<CsvColumn> columns = Classify(fields);
    CsvColumn rows;
    Coordinate head = Coordinate::kPhiO;
    if (IsCorner(fields[0], &rows, &head)) {
      columns[0] = rows;
      header_.head_coordinate = head;
      return SetNames(at, std::move(columns));
    }
    TakeFixedAbove(at, &columns);
    // Angles under merged headings: "Illumination;;Viewing" over "theta;phi;theta;phi".
    std::size_t lone = 0;
    for (const CsvColumn& column : columns) {
      lone += column.role == ColumnRole::kCoordinate &&
                      (column.coordinate == Coordinate::kTheta || column.coordinate == Coordinate::kPhi)
                  ? 1
                  : 0;
    }
    const Fields above =
        at > 0 && !lines_[at - 1].comment ? SplitFields(lines_[at - 1].text, header_.separator) : Fields();
    // Not a title with its value.
    if (lone > 1 && !above.empty() && std::none_of(above.begin(), above.end(), IsNumeric)) {
      const std::vector<std::string> names = Combined(above, fields);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const CsvColumn combined = ClassifyColumn(names[i]);
        // A heading may stand alone, over a cell that is empty or holds its unit.
        const bool alone = (columns[i].role == ColumnRole::kIgnored || IsUnitOrBlank(fields[i])) &&
                           combined.role == ColumnRole::kValue;
        if (combined.role == ColumnRole::kCoordinate || alone) columns[i] = combined;
      }
    }
    mapping_.Rename(&columns);
    if (!NamesADirection(columns)) return false;
    return SetNames(at, std::move(columns));
  }

  bool FindNames() {
    row_fields_ = data_ < lines_.size() ? SplitFields(lines_[data_].text, header_.separator).size() : 0;
    const std::size_t fields = row_fields_;
    std::optional<std::size_t> twins;
    for (const bool comments : {false, true}) {
      for (std::size_t i = data_; i-- > 0;) {
        if (lines_[i].comment != comments || !TryNames(i)) continue;
        if (HasTwins(header_.columns)) {
          if (!twins) twins = i;
          continue;
        }
        // Remarks on columns ("incidence;incidence;scatter;scatter") may stand below their names, but titles above.
        if (twins && (header_.columns.size() != fields || CountDirections(header_.columns) < 2)) continue;
        return TakeNames(i);
      }
    }
    if (twins && TryNames(*twins)) {
      may_be_side_tables_ = true;
      return TakeNames(*twins);
    }
    if (FindNamesBelow()) return TakeNames(names_);
    // A line of numbers under an empty corner, and the rows below it.
    if (data_ + 1 < lines_.size()) {
      const Fields names = SplitFields(lines_[data_].text, header_.separator);
      if (Trim(names[0]).empty() && mapping_.head()) {
        std::vector<CsvColumn> columns = Classify(names);
        mapping_.Rename(&columns);
        SetNames(data_, std::move(columns));
        ++data_;
        return true;
      }
    }
    if (NameByNumbers(fields)) return true;
    // No line names a direction: the last line of words before the data then says what there is.
    for (std::size_t i = data_; i-- > 0;) {
      if (lines_[i].comment) continue;
      const Fields names = SplitFields(lines_[i].text, header_.separator);
      if (names.size() < 2 && data_ < lines_.size()) continue;
      if (std::all_of(names.begin(), names.end(), IsUnitOrBlank)) continue;
      std::vector<CsvColumn> columns = Classify(names);
      mapping_.Rename(&columns);
      return SetNames(i, std::move(columns));
    }
    return false;
  }

  bool TakeNames(std::size_t at) {
    if (lines_[at].comment && header_.columns.size() != row_fields_ && row_fields_ > 0) {
      FailAtLine(file_, lines_[data_].number,
                 "has " + std::to_string(row_fields_) + " fields, but line " + std::to_string(header_.names_line) +
                     " names " + std::to_string(header_.columns.size()) + " columns");
    }
    NameRowNumbers(row_fields_);
    TakeHeadAbove(at);
    return true;
  }

  static bool HasTwins(const std::vector<CsvColumn>& columns) {
    std::set<std::pair<Coordinate, bool>> known;
    return std::any_of(columns.begin(), columns.end(), [&](const CsvColumn& column) {
      return column.role == ColumnRole::kCoordinate && !known.emplace(column.coordinate, column.letter_s).second;
    });
  }

  static std::ptrdiff_t CountDirections(const std::vector<CsvColumn>& columns) {
    return std::count_if(columns.begin(), columns.end(),
                         [](const CsvColumn& column) { return column.role == ColumnRole::kCoordinate; });
  }

  // "Samples 861 861 861" of an instrument's head is no row, nor is a line or two of numbers ("Min,Max,Mean" above
  // them), where names and rows stand below.
  bool FindNamesBelow() {
    constexpr std::size_t kMostNumbers = 2;
    std::size_t numbers = 0;
    for (std::size_t i = data_; i + 1 < lines_.size(); ++i) {
      if (lines_[i].comment) continue;
      const Fields fields = SplitFields(lines_[i].text, header_.separator);
      if (IsData(fields)) {
        if (IsNumeric(fields[0]) && ++numbers > kMostNumbers) return false;
        continue;
      }
      if (!TryNames(i) || CountDirections(header_.columns) < 2) continue;
      for (std::size_t k = i + 1; k < lines_.size(); ++k) {
        const Fields row = SplitFields(lines_[k].text, header_.separator);
        if (lines_[k].comment || !IsData(row)) continue;
        data_ = k;
        row_fields_ = row.size();
        return true;
      }
    }
    return false;
  }

  // The same names again and again are tables side by side, whose headings may say an angle each.
  void TakeSideTables() {
    const bool headed = names_ > 0 && !lines_[names_ - 1].comment;
    const Fields headings = headed ? SplitFields(lines_[names_ - 1].text, header_.separator) : Fields();
    header_.side_tables = FindSideTables(headings, header_.written_columns, &header_.columns);
    if (header_.side_tables.empty()) return;
    const std::optional<FixedCoordinate>& fixed = header_.side_tables[0].fixed;
    if (fixed) header_.keys.Fix(*fixed);
    header_.remarks.push_back(std::to_string(header_.side_tables.size()) + " tables stand side by side");
  }

  // Rows without any names, where the mapping says what the columns are by their numbers.
  bool NameByNumbers(std::size_t fields) {
    if (fields == 0) return false;
    std::vector<CsvColumn> columns(fields, ClassifyColumn(""));
    mapping_.Rename(&columns);
    if (!NamesADirection(columns)) return false;
    header_.columns = std::move(columns);
    header_.names_line = lines_[data_].number;
    return true;
  }

  // R writes the numbers of the rows without a name for them.
  void NameRowNumbers(std::size_t fields) {
    if (header_.columns.size() + 1 != fields || header_.columns.back().name.empty()) return;
    std::size_t rows = 0;
    std::optional<double> last;
    std::string storage;
    for (std::size_t i = data_; i < lines_.size() && rows < 5; ++i) {
      if (lines_[i].comment) continue;
      const Fields row = SplitFields(lines_[i].text, header_.separator);
      const std::optional<double> number = ParseDouble(Unquoted(row[0], &storage));
      if (row.size() != fields || !number || (last && *number != *last + 1)) return;
      last = number;
      ++rows;
    }
    if (rows < 2) return;
    header_.columns.insert(header_.columns.begin(), ClassifyColumn(""));
    header_.remarks.emplace_back("the first column has no name; it counts the rows and was not used");
  }

  // What the numbers that columns are named by are may stand alone above them: "AOI (deg)".
  void TakeHeadAbove(std::size_t names) {
    const bool numbers = std::any_of(header_.columns.begin(), header_.columns.end(),
                                     [](const CsvColumn& column) { return column.role == ColumnRole::kNumber; });
    if (!numbers || header_.head_coordinate || names == 0 || lines_[names - 1].comment) return;
    const Fields above = SplitFields(lines_[names - 1].text, header_.separator);
    // Beside it the name of the values may stand, as a spreadsheet's pivot table has it.
    std::optional<Coordinate> only;
    for (const CsvColumn& column : Classify(above)) {
      if (column.role == ColumnRole::kIgnored || column.role == ColumnRole::kValue) continue;
      if (only || column.role != ColumnRole::kCoordinate) return;
      only = column.coordinate;
    }
    if (only) header_.head_coordinate = only;
  }

  void ReadCommentKeys() {
    for (std::size_t i = 0; i < data_; ++i) {
      if (!lines_[i].comment) continue;
      const std::string_view text = WithoutEmptyCells(CommentText(lines_[i].text), header_.separator);
      AddTitle(PlainComment(text));
      if (!ReadKey(file_, lines_[i].number, text, &header_.keys) && !IsKeyInCells(lines_[i].number, text) &&
          !text.empty())
        header_.comments.emplace_back(PlainComment(text));
    }
  }

  // "# angle unit;rad", as a spreadsheet saves a comment whose value has a cell of its own.
  bool IsKeyInCells(std::size_t line, std::string_view text) {
    if (header_.separator == kBlankSeparator || text.find_first_of(":=") != std::string_view::npos) return false;
    const Fields fields = SplitFields(text, header_.separator);
    // A key has no number, and its value no blank: others are parts of a sentence.
    std::size_t filled = 0;
    for (const std::string_view field : fields) {
      const std::string_view word = Trim(field);
      if (word.empty()) continue;
      if (word.find_first_of(filled == 0 ? "0123456789" : " ") != std::string_view::npos) return false;
      ++filled;
    }
    return (filled == 2 || filled == 3) && ReadKey(file_, line, fields, &header_.keys);
  }

  // Titles above the names: "Wavelength (nm): 633;;;;", "AOI;30;deg".
  void ReadTitleKeys() {
    for (std::size_t i = 0; i < data_; ++i) {
      if (i == names_ || lines_[i].comment) continue;
      const Fields fields = SplitFields(lines_[i].text, header_.separator);
      const bool key = ReadKey(file_, lines_[i].number, fields, &header_.keys);
      if (i > names_) continue;
      std::vector<std::string> filled;
      std::string storage;
      for (const std::string_view field : fields) {
        if (!Trim(field).empty()) filled.emplace_back(Unquoted(field, &storage));
      }
      // More are a heading of columns.
      if (header_.separator == kBlankSeparator) filled = {std::string(Trim(lines_[i].text))};
      if (filled.size() > 2) continue;
      AddTitle(Join(filled, " "));
      if (!key) header_.comments.push_back(Join(filled, " "));
    }
  }

  void AddTitle(std::string_view text) {
    constexpr std::size_t kMostTitles = 200;
    if (header_.titles.size() < kMostTitles && !text.empty()) header_.titles.emplace_back(text);
  }

  void TakeUnits() {
    header_.first_data_line = data_ < lines_.size() ? lines_[data_].number : lines_[names_].number + 1;
    for (std::size_t i = names_ + 1; i > 0 && i < data_; ++i) TakeUnitsOf(i, false);
    if (names_ > 0 && names_ < lines_.size()) TakeUnitsOf(names_ - 1, true);
    if (const ColumnUnit* unit = SetColumnUnits(header_.keys.column_units, &header_.columns)) {
      FailAtLine(file_, header_.names_line,
                 "a line states the unit of '" + Excerpt(unit->column) + "' as '" + Excerpt(unit->unit) +
                     "', which is not that of the column's name; take one of them away");
    }
    for (const std::string& remark : header_.keys.remarks) header_.remarks.push_back(remark);
  }

  // A row of units; one that holds a unit which is not known is not passed over, see CsvColumn::problem. Above the
  // names titles stand, so there it must speak of angles.
  void TakeUnitsOf(std::size_t line, bool above) {
    // Below names in a comment the units stand in one too.
    if (lines_[line].comment && (above || !lines_[names_].comment)) return;
    const std::string_view text = lines_[line].comment ? CommentText(lines_[line].text) : lines_[line].text;
    const Fields units = SplitFields(text, header_.separator);
    if (lines_[line].comment && units.size() != header_.columns.size()) return;
    if (units.size() > header_.columns.size() + 1) return;
    std::string storage;
    std::size_t known = 0, angles = 0, others = 0;
    for (const std::string_view unit : units) {
      known += IsUnitOrBlank(unit) ? 1 : 0;
      angles += ParseAngleUnit(Unquoted(unit, &storage)) ? 1 : 0;
      others += IsPerSteradian(PlainUnit(Unquoted(unit, &storage))) ? 1 : 0;
    }
    const bool all = known == units.size();
    const bool some =
        !above && angles + others > 0 && units.size() == header_.columns.size() &&
        std::none_of(units.begin(), units.end(), [](std::string_view unit) { return Trim(unit).empty(); });
    if (above ? !all || angles == 0 : !all && !some) return;
    for (std::size_t c = 0; c < std::min(units.size(), header_.columns.size()); ++c)
      SetUnit(Unquoted(units[c], &storage), &header_.columns[c]);
  }

  void TakeRows() {
    std::string storage;
    for (std::size_t i = data_; i < lines_.size() && header_.first_rows.size() < kFirstRows; ++i) {
      if (lines_[i].comment) continue;
      std::vector<std::string> row;
      for (const std::string_view field : SplitFields(lines_[i].text, header_.separator))
        row.emplace_back(Unquoted(field, &storage));
      header_.first_rows.push_back(std::move(row));
    }
  }

  [[noreturn]] void FailWithoutNames() const {
    FailAtLine(
        file_, lines_[std::min(data_, lines_.size() - 1)].number,
        "numbers begin, but no line names the columns; write a line of names first, or say what they are by --columns "
        "theta_i=#1,theta_o=#2,... Allowed: " +
            AllowedColumns());
  }

  const InputFile& file_;
  ColumnMapping mapping_;
  CsvHeader header_;
  const HeadText head_;
  const std::vector<HeadLine>& lines_;
  std::size_t data_;  // the first row's, in lines_
  std::size_t names_ = static_cast<std::size_t>(-1);
  bool may_be_side_tables_ = false;
  std::size_t row_fields_ = 0;  // of the first row
};

}  // namespace

CsvHeader ReadCsvHeader(const InputFile& file, const std::string& columns) {
  return HeaderReader(file, columns).Read();
}

}  // namespace lobefit
