#include "lobefit/io/text/place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

std::string_view SkipBlanks(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size() && IsBlank(text[at])) ++at;
  return text.substr(at);
}

std::string_view FirstWord(std::string_view text) {
  std::size_t length = 0;
  while (length < text.size() && !IsBlank(text[length])) ++length;
  return text.substr(0, length);
}

}  // namespace

void FailAtLine(const InputFile& file, std::size_t line, const std::string& message) {
  throw InputError(file.path.string() + ": line " + std::to_string(line) + ": " + message);
}

void FailAtByte(const InputFile& file, std::size_t byte, const std::string& message) {
  throw InputError(file.path.string() + ": byte " + std::to_string(byte) + ": " + message);
}

std::size_t LineOfByte(std::string_view bytes, std::size_t offset) {
  const std::string_view before = bytes.substr(0, std::min(offset, bytes.size()));
  return 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
}

std::optional<std::size_t> CheckedProduct(std::initializer_list<std::size_t> factors) {
  std::size_t product = 1;
  for (const std::size_t factor : factors) {
    if (factor != 0 && product > std::numeric_limits<std::size_t>::max() / factor) return std::nullopt;
    product *= factor;
  }
  return product;
}

double NumberAt(const InputFile& file, std::size_t line, std::string_view field, const std::string& what) {
  const std::optional<double> number = ParseDouble(field);
  if (!number) {
    const bool comma = field.find(',') != std::string_view::npos;
    FailAtLine(file, line,
               what + " is '" + Excerpt(field) + "', which is not a number; " +
                   (comma ? "write a decimal point instead of a comma" : "write it as in 0.25 or 2.5e-1"));
  }
  return *number;
}

double FiniteNumberAt(const InputFile& file, std::size_t line, std::string_view field, const std::string& what) {
  const double number = NumberAt(file, line, field, what);
  if (!std::isfinite(number)) {
    FailAtLine(file, line, what + " is '" + Excerpt(field) + "'; a finite number is needed here");
  }
  return number;
}

void ScaleToMeanOne(std::vector<double>* factors) {
  const double sum = std::accumulate(factors->begin(), factors->end(), 0.0);
  if (!(sum > 0)) return;
  const double scale = static_cast<double>(factors->size()) / sum;
  for (double& factor : *factors) factor *= scale;
}

std::string_view Head(std::string_view bytes) {
  constexpr std::size_t kHeadBytes = std::size_t{64} << 10;
  return bytes.substr(0, kHeadBytes);
}

bool HasLineWithFirstWord(std::string_view text, std::string_view word) {
  LineReader lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    if (FirstWord(SkipBlanks(line)) == word) return true;
  }
  return false;
}

std::optional<std::string_view> WordReader::Peek() {
  rest_ = SkipBlanks(rest_);
  while (rest_.empty()) {
    if (!lines_.Next(&rest_)) return std::nullopt;
    rest_ = SkipBlanks(rest_);
    if (rest_.substr(0, comment_mark_.size()) == comment_mark_) rest_ = {};
  }
  return FirstWord(rest_);
}

std::optional<std::string_view> WordReader::Next() {
  const std::optional<std::string_view> word = Peek();
  line_ = std::max<std::size_t>(lines_.line_number(), 1);
  if (word) rest_.remove_prefix(word->size());
  return word;
}

std::string_view WordReader::RestOfLine() {
  const std::string_view rest = Trim(rest_);
  rest_ = {};
  return rest;
}

std::string_view WordReader::Word(const std::string& what) {
  const std::optional<std::string_view> word = Next();
  if (!word) Fail("the file ends where " + what + " should stand; it may be cut off: fetch or export it again");
  return *word;
}

double WordReader::Number(const std::string& what) {
  const std::string_view word = Word(what);  // first: it moves line_
  return NumberAt(file_, line_, word, what);
}

double WordReader::FiniteNumber(const std::string& what) {
  const std::string_view word = Word(what);
  return FiniteNumberAt(file_, line_, word, what);
}

std::size_t WordReader::MostWordsLeft() const { return (rest_.size() + file_.bytes.size() - lines_.offset() + 1) / 2; }

std::size_t WordReader::Count(const std::string& what) {
  const std::string_view word = Word(what);
  const std::optional<long long> count = ParseInteger(word);
  if (!count || *count < 1) Fail(what + " is '" + Excerpt(word) + "'; a whole number of at least 1 is needed");
  ExpectRoomFor(static_cast<std::size_t>(*count), what);
  return static_cast<std::size_t>(*count);
}

std::vector<double> WordReader::List(const std::string& what, double low, double high) {
  std::vector<double> numbers(Count("the number of " + what));
  for (double& number : numbers) {
    number = FiniteNumber("one of the " + what);
    if (number < low || number > high) {
      Fail("one of the " + what + " is " + FormatDouble(number) + "; allowed are " + FormatDouble(low) + " to " +
           FormatDouble(high));
    }
  }
  return numbers;
}

void WordReader::ExpectRoomFor(std::optional<std::size_t> words, const std::string& what) const {
  if (words && *words <= MostWordsLeft()) return;
  Fail(what + ": " + (words ? std::to_string(*words) : std::string("more than 2^64")) +
       " values should follow, but the file has only " + std::to_string(MostWordsLeft()) +
       " more at most; the counts of the header are wrong or the file is cut off");
}

void WordReader::Fail(const std::string& message) const { FailAtLine(file_, line_, message); }

}  // namespace lobefit
