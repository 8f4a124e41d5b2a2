#include "lobefit/base/text/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "lobefit/base/text/plain_decimal.h"
#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Edit distance, given up above 2.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  // A difference in length is a lower bound; words from hostile files may be very long.
  if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > 2) return 3;
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

// from_chars reports both overflow and underflow as out of range: the place of the first digit that is not 0 decides
// which it was. `number` is "-0.0012e-400" without blanks.
double OutOfRangeValue(std::string_view number) {
  const bool negative = number.front() == '-';
  if (negative) number.remove_prefix(1);
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, e);
  const std::size_t point = std::min(digits.find('.'), digits.size()), first = digits.find_first_not_of("0.");
  // Power of ten just above the number: digits before the point, or minus the zeros behind it.
  auto power = static_cast<double>(point) - static_cast<double>(std::min(first, digits.size()));
  if (first > point) power += 1;
  double exponent = 0;
  const bool below = e + 1 < number.size() && number[e + 1] == '-';
  for (const char c : number.substr(std::min(e, number.size()))) {
    if (IsDigit(c)) exponent = 10 * exponent + (c - '0');
  }
  power += below ? -exponent : exponent;
  const double magnitude = power > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  return negative ? -magnitude : magnitude;
}

}  // namespace

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string ToLower(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

std::vector<std::string_view> Split(std::string_view text, char separator) {
  std::vector<std::string_view> pieces;
  while (true) {
    const std::size_t at = text.find(separator);
    pieces.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return pieces;
    text.remove_prefix(at + 1);
  }
}

std::vector<std::string_view> SplitBlanks(std::string_view text) {
  std::vector<std::string_view> pieces;
  std::size_t at = 0;
  while (at < text.size()) {
    while (at < text.size() && IsBlank(text[at])) ++at;
    const std::size_t begin = at;
    while (at < text.size() && !IsBlank(text[at])) ++at;
    if (at > begin) pieces.push_back(text.substr(begin, at - begin));
  }
  return pieces;
}

std::optional<double> ParseDouble(std::string_view field) {
  field = Trim(field);
  std::size_t length = 0;
  if (const std::optional<double> plain = ParsePlainDecimal(field, &length); plain && length == field.size())
    return plain;
  if (field.size() > 1 && field[0] == '+' && field[1] != '-' && field[1] != '+') field.remove_prefix(1);
  if (field.empty()) return std::nullopt;
  double value = 0;
  const char* end = field.data() + field.size();
  const std::from_chars_result result = std::from_chars(field.data(), end, value);
  if (result.ptr != end) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) return OutOfRangeValue(field);
  if (result.ec != std::errc()) return std::nullopt;
  return value;
}

std::optional<long long> ParseInteger(std::string_view field) {
  field = Trim(field);
  if (field.size() > 1 && field[0] == '+' && IsDigit(field[1])) field.remove_prefix(1);
  long long value = 0;
  const char* end = field.data() + field.size();
  const std::from_chars_result result = std::from_chars(field.data(), end, value);
  if (field.empty() || result.ptr != end || result.ec != std::errc()) return std::nullopt;
  return value;
}

std::string DidYouMean(std::string_view name, const std::vector<std::string>& allowed) {
  std::size_t best = 3;
  std::string_view suggestion;
  for (const std::string& candidate : allowed) {
    const std::size_t distance = EditDistance(name, candidate);
    if (distance < best && distance < candidate.size()) {
      best = distance;
      suggestion = candidate;
    }
  }
  if (suggestion.empty()) return "";
  return " (did you mean '" + std::string(suggestion) + "'?)";
}

std::string Hex(std::string_view bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  return hex;
}

std::string Join(const std::vector<std::string>& items, std::string_view separator) {
  std::string joined;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) joined += separator;
    joined += items[i];
  }
  return joined;
}

std::string Excerpt(std::string_view text, std::size_t max_length) {
  std::size_t length = std::min(max_length, text.size());
  // Not amid a character, which has four bytes at most.
  for (int i = 0; i < 3 && length > 0 && length < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[length]) & 0xc0U) != 0x80U) break;
    --length;
  }
  return Printable(text.substr(0, length)) + (text.size() > max_length ? "..." : "");
}

std::string FormatDouble(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[32];
  const std::to_chars_result result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

bool LineReader::Next(std::string_view* line) {
  if (offset_ >= text_.size()) return false;
  std::size_t end = text_.find('\n', offset_);
  const bool has_newline = end != std::string_view::npos;
  if (!has_newline) end = text_.size();
  std::size_t length = end - offset_;
  while (length > 0 && text_[offset_ + length - 1] == '\r') --length;
  *line = text_.substr(offset_, length);
  offset_ = has_newline ? end + 1 : end;
  ++line_number_;
  return true;
}

}  // namespace lobefit
