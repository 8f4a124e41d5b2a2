#include "lobefit/io/csv/head/head_text.h"

#include <algorithm>
#include <optional>
#include <string>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/cells.h"
#include "lobefit/io/csv/head/head_lines.h"
#include "lobefit/io/csv/head/no_value.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

using Fields = CsvFields;

// A head is looked for in so much of the file, lines of comments not counted: a synthetic file has one for each number
// of its truth.
constexpr std::size_t kMostColumns = 65536;
constexpr std::size_t kHeadLines = 400;

// "1,234", but neither "0,234" nor "1,23".
bool MayBeThousands(std::string_view field) {
  while (!field.empty() && (field.front() == '+' || field.front() == '-')) field.remove_prefix(1);
  const std::size_t comma = field.find(',');
  return comma != std::string_view::npos && comma > 0 && comma < 4 && field.front() != '0' &&
         field.size() == comma + 4 && field.find_first_not_of("0123456789,") == std::string_view::npos;
}

class HeadTextReader {
 public:
  explicit HeadTextReader(const InputFile& file) : file_(file) {}

  HeadText Read() {
    Gather();
    text_.first_row = text_.lines.size();
    if (std::any_of(text_.lines.begin(), text_.lines.end(), [](const HeadLine& line) { return !line.comment; }))
      FindData();
    return std::move(text_);
  }

 private:
  void Gather() {
    CsvLines lines(file_.bytes);
    std::string_view text;
    std::size_t bytes = 0, counted = 0;
    while (counted < kHeadLines && bytes < kCsvHeadBytes && lines.Next(&text)) {
      text_.last_line = lines.line_number();
      bytes += text.size();
      if (Trim(text).empty()) continue;
      if (text_.lines.empty() && ToLower(text).starts_with("sep=") && text.size() >= 5) {
        stated_separator_ = text[4];
        continue;
      }
      text_.lines.push_back({lines.line_number(), text, IsComment(text)});
      if (text_.lines.back().comment) continue;
      ++counted;
      CheckColumns(text_.lines.back());
    }
  }

  // Before any name is looked at.
  void CheckColumns(const HeadLine& line) const {
    if (line.text.size() <= kMostColumns) return;
    for (const char separator : {';', '\t', '|', ',', ' '}) {
      const auto fields = static_cast<std::size_t>(std::count(line.text.begin(), line.text.end(), separator)) + 1;
      if (fields > kMostColumns) {
        FailAtLine(
            file_, line.number,
            "has " + std::to_string(fields) + " fields; at most " + std::to_string(kMostColumns) + " columns are read");
      }
    }
  }

  // Cells with units are numbers only where most lines that follow have such: so the names of a table may look.
  bool FindData(char separator, bool units) {
    std::size_t rows = 0, others = 0, first = 0;
    for (std::size_t i = 0; i < text_.lines.size(); ++i) {
      if (text_.lines[i].comment) continue;
      Fields fields = SplitFields(text_.lines[i].text, separator);
      std::vector<std::string> texts(units && fields.size() > 1 ? fields.size() : 0);  // of quotes within quotes
      for (std::size_t k = 0; k < texts.size(); ++k) {
        const std::string_view field = Unquoted(fields[k], &texts[k]);
        if (ParseCell(field, '.') || ParseCell(field, ',')) fields[k] = NumberOfCell(field);
      }
      const bool is_row = fields.size() >= 2 && IsData(fields) &&
                          !(separator == ',' && HasCommasWithinNumbers(text_.lines[i].text, fields));
      if (is_row && rows++ == 0) first = i;
      if (is_row && !units) break;
      others += !is_row && rows > 0 ? 1 : 0;
    }
    if (rows == 0 || others >= rows) return false;
    text_.separator = separator;
    text_.first_row = first;
    TakeRowsBefore();
    FindDecimalMark();
    return true;
  }

  // Above the first row of bare numbers others may stand whose cells have units or marks in place of values.
  void TakeRowsBefore() {
    const std::size_t fields = SplitFields(text_.lines[text_.first_row].text, text_.separator).size();
    for (std::size_t i = text_.first_row; i-- > 0;) {
      if (text_.lines[i].comment) continue;
      const Fields row = SplitFields(text_.lines[i].text, text_.separator);
      std::size_t numbers = 0;
      std::string storage;
      const bool is_row = row.size() == fields && std::all_of(row.begin(), row.end(), [&](std::string_view raw) {
                            const std::string_view field = Unquoted(raw, &storage);
                            const bool number = IsNumeric(field) || ParseCell(field, '.') || ParseCell(field, ',');
                            numbers += number ? 1 : 0;
                            return number || IsNoValueWord(field);
                          });
      const bool led = is_row && IsNumeric(NumberOfCell(Unquoted(row[0], &storage)));
      if (!led || numbers < 2) return;
      text_.first_row = i;
    }
  }

  // The first row of data, and the separator by which it is one.
  void FindData() {
    std::vector<char> candidates = {';', '\t', '|', ','};
    // A line that Excel writes may name a separator that the file, saved again, does not have.
    if (stated_separator_) candidates.insert(candidates.begin(), *stated_separator_);
    for (const char candidate : candidates) {
      if (FindData(candidate, false)) return;
    }
    // "10 deg;20 deg;0.5" is no row of numbers between blanks.
    for (const char candidate : candidates) {
      if (FindData(candidate, true)) return;
    }
    if (FindData(kBlankSeparator, false)) return;
    text_.first_row = text_.lines.size();
    const HeadLine& first =
        *std::find_if(text_.lines.begin(), text_.lines.end(), [](const HeadLine& line) { return !line.comment; });
    for (const char candidate : {';', '\t', '|', ','}) {
      if (first.text.find(candidate) == std::string_view::npos) continue;
      text_.separator = candidate;
      return;
    }
    text_.separator = kBlankSeparator;
  }

  void FindDecimalMark() {
    std::size_t commas = 0, points = 0, groups = 0;
    std::string storage, group;
    std::size_t line_of_group = 0;
    for (std::size_t i = text_.first_row; i < text_.lines.size(); ++i) {
      if (text_.lines[i].comment) continue;
      for (const std::string_view raw : SplitFields(text_.lines[i].text, text_.separator)) {
        const std::string_view cell = Unquoted(raw, &storage), field = NumberOfCell(cell);
        if (IsNoValueWord(cell)) continue;  // "1,#QNAN"
        if (HasThousandsSeparator(field)) {
          FailAtLine(file_, text_.lines[i].number,
                     "'" + Excerpt(field) +
                         "' has both a comma and a point; write numbers without separators between thousands");
        }
        if (HasDecimalComma(field)) {
          ++commas;
          if (MayBeThousands(field)) {
            if (groups++ == 0) group = std::string(field), line_of_group = text_.lines[i].number;
          }
        } else if (field.find('.') != std::string_view::npos && ParseDouble(field)) {
          ++points;
        }
      }
    }
    if (commas > 0 && points > 0) {
      FailAtLine(file_, text_.lines[text_.first_row].number,
                 "some numbers have a decimal comma and some a decimal point, or commas separate thousands; write all "
                 "with points");
    }
    if (groups > 0 && groups == commas && text_.separator == ',') {
      FailAtLine(
          file_, line_of_group,
          "'" + Excerpt(group) +
              "' can have a decimal comma or one between thousands, and no other number tells; write numbers with "
              "points and without separators between thousands");
    }
    if (commas > 0) text_.decimal_mark = ',';
  }

  const InputFile& file_;
  HeadText text_;
  std::optional<char> stated_separator_;
};

}  // namespace

HeadText ReadHeadText(const InputFile& file) { return HeadTextReader(file).Read(); }

}  // namespace lobefit
