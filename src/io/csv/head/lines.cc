#include "lobefit/io/csv/head/lines.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/text/csv_fields.h"
#include "lobefit/io/text/units.h"

namespace lobefit {

namespace {

// Within the quotes that a spreadsheet puts around a comment with a comma: its text with the mark; else nothing.
std::string_view QuotedComment(std::string_view line) {
  if (!line.starts_with("\"#")) return {};
  const std::size_t end = line.rfind('"');
  const bool alone = line.find_first_not_of(",;\t ", end + 1) == std::string_view::npos;
  return end > 2 && alone && line.substr(2, end - 2).find('"') == std::string_view::npos ? line.substr(1, end - 1)
                                                                                         : std::string_view();
}

// "6.9x10^-2" and "6.9·10⁻²", as programs write numbers for people.
std::optional<double> ParsePowerOfTen(std::string_view field, char decimal_mark) {
  const std::string plain = PlainUnit(field);
  const std::size_t at = plain.find("10^");
  if (at == std::string::npos || at < 2 || (plain[at - 1] != 'x' && plain[at - 1] != '*')) return std::nullopt;
  const std::optional<double> factor = ParseCsvNumber(std::string_view(plain).substr(0, at - 1), decimal_mark),
                              exponent = ParseDouble(std::string_view(plain).substr(at + 3));
  if (!factor || !exponent) return std::nullopt;
  return *factor * std::pow(10.0, *exponent);
}

}  // namespace

bool IsComment(std::string_view line) {
  line = Trim(line);
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//") || line.starts_with("! ") ||
         line.starts_with("* ") || !QuotedComment(line).empty();
}

std::string_view CommentText(std::string_view line) {
  line = Trim(line);
  if (const std::string_view quoted = QuotedComment(line); !quoted.empty()) line = quoted;
  line.remove_prefix(line.starts_with("//") ? 2 : 1);
  return Trim(line);
}

std::string_view WithoutEmptyCells(std::string_view text, char separator) {
  while (separator != kBlankSeparator && text.ends_with(separator)) text = Trim(text.substr(0, text.size() - 1));
  return text;
}

std::string_view PlainComment(std::string_view comment) {
  return comment.starts_with(kCommentKey) ? comment.substr(kCommentKey.size()) : comment;
}

CsvLines::CsvLines(std::string_view bytes)
    : bytes_(bytes), lines_(bytes), has_quotes_(bytes.find('"') != std::string_view::npos) {}

bool CsvLines::Next(std::string_view* line) {
  const std::size_t begin = lines_.offset();
  if (!lines_.Next(line)) return false;
  first_line_ = lines_.line_number();
  if (!has_quotes_ || line->find('"') == std::string_view::npos || IsComment(*line)) return true;
  // A quoted cell of a heading may have a few lines; a lone quote must not swallow the file.
  constexpr int kMostLines = 8;
  const auto open = [](std::string_view text) {
    return EndsWithinQuotes(text, ',') || EndsWithinQuotes(text, ';') || EndsWithinQuotes(text, '\t');
  };
  LineReader ahead = lines_;
  std::string_view joined = *line, next;
  for (int i = 1; i < kMostLines && open(joined); ++i) {
    if (!ahead.Next(&next)) return true;
    joined = bytes_.substr(begin, ahead.offset() - begin);
    while (!joined.empty() && (joined.back() == '\n' || joined.back() == '\r')) joined.remove_suffix(1);
    if (open(joined)) continue;
    lines_ = ahead;
    *line = joined;
  }
  return true;
}

std::size_t EstimateLines(std::string_view bytes) {
  constexpr std::size_t kPiece = 4096, kPieces = 32;
  const auto lines = [](std::string_view text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  };
  if (bytes.size() <= kPiece * kPieces) return lines(bytes) + 1;
  std::size_t found = 0;
  // Not at the beginning, which need not be like the rest.
  for (std::size_t i = 0; i < kPieces; ++i)
    found += lines(bytes.substr(bytes.size() / kPieces / 2 * (2 * i + 1), kPiece));
  // A little more: what is too little by one is copied as a whole.
  return bytes.size() / kPiece * found / kPieces * 102 / 100 + 1;
}

void SplitCsvLine(std::string_view line, char separator, std::vector<std::string_view>* fields) {
  if (separator != kBlankSeparator) {
    SplitQuoted(line, separator, fields);
    return;
  }
  *fields = SplitBlanks(line);
}

std::optional<double> ParseCsvNumber(std::string_view field, char decimal_mark) {
  field = Trim(field);
  if (decimal_mark == '.') {
    if (const std::optional<double> number = ParseDouble(field)) return number;
  }
  // ="10" and '10 are texts of a spreadsheet, which are numbers all the same.
  if (field.size() > 3 && field.starts_with("=\"") && field.ends_with('"'))
    return ParseCsvNumber(field.substr(2, field.size() - 3), decimal_mark);
  if (field.size() > 1 && field.front() == '\'') return ParseCsvNumber(field.substr(1), decimal_mark);
  if (field.find("10") != std::string_view::npos) {
    if (const std::optional<double> number = ParsePowerOfTen(field, decimal_mark)) return number;
  }
  // The minus sign of typesetters and of some spreadsheets.
  constexpr std::string_view kMinus = "\xe2\x88\x92";
  if (const std::size_t minus = field.find(kMinus); minus != std::string_view::npos) {
    std::string text(field);
    text.replace(minus, kMinus.size(), "-");
    return ParseCsvNumber(text, decimal_mark);
  }
  constexpr std::string_view kNoBreak = "\xc2\xa0";
  while (field.starts_with(kNoBreak)) field = Trim(field.substr(kNoBreak.size()));
  while (field.ends_with(kNoBreak)) field = Trim(field.substr(0, field.size() - kNoBreak.size()));
  if (field.ends_with("\xc2\xb0")) field = Trim(field.substr(0, field.size() - 2));
  // Fortran writes the exponents of its double precision with a D.
  const std::size_t exponent = field.find_first_of("dD", 1);
  if (exponent != std::string_view::npos && field[exponent - 1] >= '.' && field[exponent - 1] <= '9') {
    std::string text(field);
    text[exponent] = 'e';
    return ParseCsvNumber(text, decimal_mark);
  }
  if (decimal_mark == '.') return ParseDouble(field);
  if (field.find('.') != std::string_view::npos && field.find(',') != std::string_view::npos) return std::nullopt;
  std::string point(field);
  std::replace(point.begin(), point.end(), decimal_mark, '.');
  return ParseDouble(point);
}

}  // namespace lobefit
