#include "lobefit/io/csv/head/no_value.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// In small letters; of letters beyond ASCII both sizes.
constexpr auto kWords = std::to_array<std::string_view>({
    // nothing, or nothing that is known
    "",
    "n/a",
    "n.a.",
    "na",
    "#n/a",
    "#na",
    "<na>",
    "n/d",
    "n.d.",
    "n.d",
    "nd",
    "n/m",
    "nc",
    "k.a.",
    "k. a.",
    "null",
    "(null)",
    "<null>",
    "nul",
    "none",
    "nil",
    "\\n",
    "nan(ind)",
    "-nan(ind)",
    "nan(snan)",
    "-nan(snan)",
    "-nan",
    "?",
    "x",
    "missing",
    "empty",
    "void",
    "undefined",
    "undef",
    "unknown",
    "invalid",
    "bad",
    "no data",
    "nodata",
    "no value",
    "not available",
    "not measured",
    "nicht gemessen",
    "non mesur\u00e9",
    "non mesur\u00e9e",
    "no medido",
    "non misurato",
    "skipped",
    "rejected",
    "fail",
    "failed",
    "error",
    "err",
    "fehler",
    "erreur",
    // too much
    "over",
    "ovr",
    "ovl",
    "ovld",
    "ol",
    "o.l.",
    "ovf",
    "oor",
    "overload",
    "overflow",
    "overrange",
    "over range",
    "out of range",
    "sat",
    "sat.",
    "saturated",
    "saturation",
    "clipped",
    "\u00dcberlauf",
    "\u00fcberlauf",
    "ueberlauf",
    "ges\u00e4ttigt",
    "\u00dcbersteuert",
    "\u00fcbersteuert",
    "satur\u00e9",
    "satur\u00e9e",
    "hors plage",
    "hors gamme",
    "saturado",
    "fuera de rango",
    "saturato",
    "fuori scala",
    "\u221e",
    "-\u221e",
    "+\u221e",
    // too little
    "bdl",
    "lod",
    "underflow",
    "under",
    "noise",
    "below noise",
    "noise floor",
    // nothing to be seen
    "blocked",
    "shadow",
    "shadowed",
    "masked",
    "vignetted",
    "occluded",
    "obscured",
    "obstructed",
    "abgeschattet",
});

// "#VALUE!", "#WERT!", "#\u00a1DIV/0!", "#NV", "#N/D", "#N/A N/A" and "Err:502": what spreadsheets in any language
// write for a formula that has no result.
bool IsSpreadsheetError(std::string_view lower) {
  if (lower.starts_with("err:")) return ParseDouble(lower.substr(4)).has_value();
  if (lower.size() < 3 || lower.front() != '#') return false;
  lower.remove_prefix(1);
  for (const std::string_view mark : {"\u00a1", "\u00bf"}) {
    if (lower.starts_with(mark)) lower.remove_prefix(mark.size());
  }
  return !lower.empty() &&
         ((lower.front() >= 'a' && lower.front() <= 'z') || static_cast<unsigned char>(lower.front()) >= 0x80);
}

}  // namespace

bool IsNoValueWord(std::string_view field) {
  std::string lower = ToLower(Trim(field));
  if (lower.size() > 2 && lower.front() == '(' && lower.back() == ')') lower = lower.substr(1, lower.size() - 2);
  if (std::find(kWords.begin(), kWords.end(), lower) != kWords.end() || IsSpreadsheetError(lower)) return true;
  // "---", "***", "####" (a column too narrow), an en or em dash.
  if (lower.find_first_not_of('-') == std::string::npos || lower.find_first_not_of('*') == std::string::npos ||
      lower.find_first_not_of('#') == std::string::npos || lower.find_first_not_of('_') == std::string::npos ||
      lower.find_first_not_of('.') == std::string::npos || lower == "\xe2\x80\x93" || lower == "\xe2\x80\x94") {
    return true;
  }
  // "1.#QNAN", "-1.#IND", "1.#INF" of older C libraries; "<0.001" and ">100", beyond what the instrument can tell.
  if (lower.find(".#") != std::string::npos || lower.find(",#") != std::string::npos) return true;
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
