#include "lobefit/io/csv/head/no_value.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::array<std::string_view, 60> kWords = {
    "",           "over",       "ovr",      "ovl",       "ovld",       "ol",           "o.l.",      "ovf",
    "oor",        "overload",   "overflow", "overrange", "over range", "out of range", "sat",       "sat.",
    "saturated",  "saturation", "n/a",      "n.a.",      "na",         "#n/a",         "#na",       "#div/0!",
    "#value!",    "#ref!",      "#num!",    "#name?",    "#null!",     "nan(ind)",     "-nan(ind)", "nan(snan)",
    "-nan(snan)", "-nan",       "<na>",     "null",      "none",       "nil",          "missing",   "?",
    "x",          "n.d.",       "n.d",      "nd",        "bdl",        "lod",          "underflow", "under",
    "undefined",  "invalid",    "bad",      "blocked",   "shadow",     "shadowed",     "masked",    "fail",
    "failed",     "error",      "err",      "nul"};

}  // namespace

bool IsNoValueWord(std::string_view field) {
  std::string lower = ToLower(Trim(field));
  if (lower.size() > 2 && lower.front() == '(' && lower.back() == ')') lower = lower.substr(1, lower.size() - 2);
  if (std::find(kWords.begin(), kWords.end(), lower) != kWords.end()) return true;
  // "---", "***", "####" (a column too narrow), an en or em dash.
  if (lower.find_first_not_of("-") == std::string::npos || lower.find_first_not_of("*") == std::string::npos ||
      lower.find_first_not_of("#") == std::string::npos || lower.find_first_not_of("_") == std::string::npos ||
      lower.find_first_not_of(".") == std::string::npos || lower == "\xe2\x80\x93" || lower == "\xe2\x80\x94") {
    return true;
  }
  // "1.#QNAN", "-1.#IND", "1.#INF" of older C libraries; "<0.001" and ">100", beyond what the instrument can tell.
  if (lower.find(".#") != std::string::npos) return true;
  if (lower.front() != '<' && lower.front() != '>') return false;
  const std::string_view limit = Trim(std::string_view(lower).substr(lower.size() > 1 && lower[1] == '=' ? 2 : 1));
  return limit == "lod" || limit == "loq" || limit == "dl" || limit == "mdl" || ParseDouble(limit).has_value();
}

NoValues::NoValues(const std::string& list) {
  if (Trim(list).empty()) return;
  for (const std::string_view item : Split(list, ',')) {
    const std::string word = ToLower(Trim(item));
    if (word.empty())
      throw UsageError("--no-value " + Excerpt(list) +
                       ": an item is empty; write words and numbers with commas between, as in 0,-999,OVER");
    if (const std::optional<double> number = ParseDouble(word)) {
      numbers_.push_back(*number);
    } else {
      words_.push_back(word);
    }
  }
}

bool NoValues::Holds(double number) const {
  // A mark may have been written with fewer digits than the option has.
  return std::any_of(numbers_.begin(), numbers_.end(),
                     [&](double mark) { return std::fabs(number - mark) <= 1e-6 * std::fabs(mark); });
}

bool NoValues::Holds(std::string_view word) const {
  return std::find(words_.begin(), words_.end(), ToLower(Trim(word))) != words_.end();
}

}  // namespace lobefit
