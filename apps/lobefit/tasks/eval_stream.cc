#include "tasks/eval_stream.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/csv_fields.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 16;
constexpr std::size_t kMaxLine = std::size_t{1} << 24;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Lines of a stream, without their ends, one at a time.
class StreamLines {
 public:
  explicit StreamLines(std::FILE* file) : file_(file) {}

  // False at the end. `line` is valid until the next call.
  bool Next(std::string_view* line) {
    std::size_t searched = 0;
    while (true) {
      const std::string_view rest = std::string_view{buffer_}.substr(begin_);
      const std::size_t end = rest.find('\n', searched);
      if (end != std::string_view::npos) return Take(rest.substr(0, end), end + 1, line);
      searched = rest.size();
      if (!Fill()) break;
    }
    const std::string_view rest = std::string_view{buffer_}.substr(begin_);
    return !rest.empty() && Take(rest, rest.size(), line);
  }
  std::size_t number() const { return number_; }

 private:
  bool Take(std::string_view text, std::size_t used, std::string_view* line) {
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    *line = text;
    begin_ += used;
    ++number_;
    return true;
  }

  bool Fill() {
    buffer_.erase(0, begin_);
    begin_ = 0;
    const std::size_t held = buffer_.size();
    if (held > kMaxLine) {
      throw InputError(
          fmt::format("standard input, line {}: longer than {} bytes; is this CSV text?", number_ + 1, kMaxLine));
    }
    buffer_.resize(held + kBlock);
    const std::size_t count = std::fread(buffer_.data() + held, 1, kBlock, file_);
    buffer_.resize(held + count);
    if (std::ferror(file_) != 0) throw InputError("standard input: cannot be read");
    return count > 0;
  }

  std::FILE* file_;
  std::string buffer_;
  std::size_t begin_ = 0, number_ = 0;
};

// 17 significant digits, "nan", "inf", "-inf".
void AppendNumber(double value, std::string* text) {
  if (!std::isfinite(value)) {
    *text += std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
    return;
  }
  char digits[32];
  const std::to_chars_result result =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::scientific, 16);
  text->append(digits, result.ptr);
}

class Evaluation {
 public:
  Evaluation(const Quantity& quantity, std::string_view header, std::string* out) : quantity_(quantity) {
    SplitQuoted(header, ',', &fields_);
    std::string storage;
    for (const std::string_view field : fields_) names_.emplace_back(Unquoted(field, &storage));
    for (const InputColumn& column : quantity.inputs) from_.push_back(PlaceOf(column.name, true));
    result_at_.assign(names_.size(), kNone);
    for (std::size_t k = 0; k < quantity.results.size(); ++k) {
      const std::size_t at = PlaceOf(quantity.results[k].name, false);
      if (at == kNone) {
        appended_.push_back(k);
      } else {
        result_at_[at] = k;
      }
    }
    *out += header;
    for (const std::size_t k : appended_) *out += "," + quantity.results[k].name;
    *out += "\n";
    inputs_.resize(quantity.inputs.size());
    results_.resize(quantity.results.size());
  }

  void Row(std::string_view text, std::size_t line, std::string* out) {
    ++row_;
    line_ = line;
    SplitQuoted(text, ',', &fields_);
    if (fields_.size() != names_.size()) {
      throw InputError(
          fmt::format("standard input, line {} (row {}): {} fields, the header has {} columns; give every "
                      "row one field a column",
                      line_, row_, fields_.size(), names_.size()));
    }
    for (std::size_t i = 0; i < inputs_.size(); ++i) inputs_[i] = InputAt(i);
    if (const std::optional<DomainError> error = CheckDomain(quantity_, inputs_.data())) {
      Refuse(quantity_.inputs[error->column].name, error->message);
    }
    quantity_.evaluate(inputs_.data(), results_.data());
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (i > 0) *out += ',';
      if (result_at_[i] == kNone) {
        *out += fields_[i];
      } else {
        AppendResult(result_at_[i], out);
      }
    }
    for (const std::size_t k : appended_) {
      *out += ',';
      AppendResult(k, out);
    }
    *out += '\n';
  }

 private:
  // Place in the header; kNone if it is not there and need not be.
  std::size_t PlaceOf(const std::string& name, bool required) const {
    const auto first = std::find(names_.begin(), names_.end(), name);
    if (first == names_.end()) {
      if (!required) return kNone;
      std::vector<std::string> needed;
      for (const InputColumn& column : quantity_.inputs) needed.push_back(column.name);
      throw InputError(fmt::format("standard input, line 1: column '{}' is missing{}; {} reads {}; the header has {}",
                                   name, DidYouMean(name, names_), quantity_.name, Join(needed),
                                   Excerpt(Join(names_), 400)));
    }
    if (std::find(first + 1, names_.end(), name) != names_.end()) {
      throw InputError(fmt::format("standard input, line 1: column '{}' is there twice; name each column once", name));
    }
    return static_cast<std::size_t>(first - names_.begin());
  }

  double InputAt(std::size_t i) const {
    const InputColumn& column = quantity_.inputs[i];
    std::string storage;
    const std::string_view field = Unquoted(fields_[from_[i]], &storage);
    if (!column.words.empty()) {
      const auto word = std::find(column.words.begin(), column.words.end(), field);
      if (word != column.words.end()) return static_cast<double>(word - column.words.begin());
      Refuse(column.name, fmt::format("'{}' is not known{}; allowed: {}", Excerpt(field),
                                      DidYouMean(field, column.words), DomainText(column)));
    }
    const std::optional<double> value = ParseDouble(field);
    if (!value) {
      Refuse(column.name, fmt::format("'{}' is not a number; allowed: {}, with a decimal point", Excerpt(field),
                                      DomainText(column)));
    }
    return *value;
  }

  [[noreturn]] void Refuse(const std::string& column, const std::string& message) const {
    throw InputError(fmt::format("standard input, line {} (row {}), column '{}': {}", line_, row_, column, message));
  }

  void AppendResult(std::size_t k, std::string* out) const {
    if (quantity_.results[k].is_flag) {
      *out += results_[k] != 0 ? '1' : '0';
    } else {
      AppendNumber(results_[k], out);
    }
  }

  const Quantity& quantity_;
  std::vector<std::string> names_;
  std::vector<std::size_t> from_;       // of each input, its place in the row
  std::vector<std::size_t> result_at_;  // of each place in the row, the result that replaces it
  std::vector<std::size_t> appended_;   // results that are not in the header
  std::vector<std::string_view> fields_;
  std::vector<double> inputs_, results_;
  std::size_t row_ = 0, line_ = 0;
};

void Flush(std::string* text, std::FILE* out) {
  const bool good = std::fwrite(text->data(), 1, text->size(), out) == text->size();
  text->clear();
  if (!good) throw OutputError("standard output: cannot be written (disk full or closed); rows are missing");
}

}  // namespace

void EvaluateStream(const Quantity& quantity, std::FILE* in, std::FILE* out) {
  StreamLines lines(in);
  std::string_view line;
  std::string text;
  if (!lines.Next(&line)) {
    throw InputError(
        "standard input is empty; give CSV with a header, for instance the output of `lobefit eval` or a "
        "table of your own (see `lobefit eval --list`)");
  }
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  Evaluation evaluation(quantity, line, &text);
  std::size_t blank = 0;  // number of the first blank line, which only other blank lines may follow
  try {
    while (lines.Next(&line)) {
      if (Trim(line).empty()) {
        if (blank == 0) blank = lines.number();
        continue;
      }
      if (blank != 0) {
        throw InputError(fmt::format("standard input, line {}: blank, but rows follow; remove the line", blank));
      }
      evaluation.Row(line, lines.number(), &text);
      if (text.size() >= kBlock) Flush(&text, out);
    }
  } catch (const InputError&) {
    Flush(&text, out);
    throw;
  }
  Flush(&text, out);
  if (std::fflush(out) != 0) {
    throw OutputError("standard output: cannot be written (disk full or closed); rows are missing");
  }
}

}  // namespace lobefit
