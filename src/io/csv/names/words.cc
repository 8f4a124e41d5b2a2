#include "lobefit/io/csv/names/words.h"

#include <algorithm>
#include <array>
#include <utility>

#include "lobefit/base/text/same_word.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/names/foreign_words.h"
#include "lobefit/io/text/units.h"

namespace lobefit {
namespace {

// Letters and signs beyond ASCII that names of columns are written with. Greek letters are words of their own.
constexpr std::array<std::pair<std::string_view, std::string_view>, 97> kLetters = {{
    // Signs of no width.
    {"\u200b", ""},
    {"\u200e", ""},
    {"\u200f", ""},
    {"\ufeff", ""},
    {"\u00ad", ""},
    {"\xce\xb8", " theta "},
    {"\xce\x98", " theta "},
    {"\xcf\x91", " theta "},
    {"\xcf\x86", " phi "},
    {"\xce\xa6", " phi "},
    {"\xcf\x95", " phi "},
    {"\xce\xbb", " lambda "},
    {"\xce\x9b", " lambda "},
    {"\xce\x94", " delta "},
    {"\xce\xb4", " delta "},
    {"\xe2\x88\x86", " delta "},
    {"\xce\xb2", " beta "},
    {"\xcf\x83", " sigma "},
    {"\xcf\x80", " pi "},
    {"\xcf\x88", " psi "},
    {"\xcf\x89", " omega "},
    {"\xe1\xb5\xa2", "_i "},
    {"\xe1\xb5\xa3", "_r "},
    {"\xe2\x82\x92", "_o "},
    {"\xe2\x82\x9b", "_s "},
    {"\xe1\xb5\xa5", "_v "},
    {"\xe2\x82\x80", "_0 "},
    {"\xe2\x82\x81", "_1 "},
    {"\xe2\x82\x82", "_2 "},
    {"\xe2\x82\x97", "_l "},
    {"\xe2\x82\x91", "_e "},
    {"\xe2\x82\x99", "_n "},
    {"\xe2\x82\x95", "_h "},
    {"\xc3\xa4", "ae"},
    {"\xc3\xb6", "oe"},
    {"\xc3\xbc", "ue"},
    {"\xc3\x84", "ae"},
    {"\xc3\x96", "oe"},
    {"\xc3\x9c", "ue"},
    {"\xc3\x9f", "ss"},
    {"\xc3\xa9", "e"},
    {"\xc3\xa8", "e"},
    {"\xc3\xaa", "e"},
    {"\xc3\xa0", "a"},
    {"\xc3\xa1", "a"},
    {"\xc3\xa2", "a"},
    {"\xc3\xa7", "c"},
    {"\xc3\xad", "i"},
    {"\xc3\xac", "i"},
    {"\xc3\xae", "i"},
    {"\xc3\xb3", "o"},
    {"\xc3\xb2", "o"},
    {"\xc3\xb4", "o"},
    {"\xc3\xba", "u"},
    {"\xc3\xb9", "u"},
    {"\xc3\xbb", "u"},
    {"\xc3\xb1", "n"},
    {"\xc3\x89", "e"},
    {"\xc3\x85", "A"},
    {"\xe2\x84\xab", "A"},
    {"\xc3\x81", "a"},
    {"\xe2\x88\x92", "-"},
    {"\xe2\x80\x93", "-"},
    {"\xe2\x80\x94", "-"},
    {"\xe2\x80\x90", "-"},
    {"\xc2\xa0", " "},
    {"\xe2\x80\xaf", " "},
    {"\xe2\x80\x99", "'"},
    {"\xc2\xb5", "u"},
    {"\xce\xbc", "u"},
    {"\xc2\xb0", " deg "},
    {"\xc2\xba", " deg "},
    {"\xcb\x9a", " deg "},
    {"\xe2\x88\xa3", "|"},
    {"\xc2\xb7", "*"},
    {"\xc3\x97", "*"},
    {"\xc2\xb9", "1"},
    {"ã", "a"},
    {"õ", "o"},
    {"å", "a"},
    {"ø", "o"},
    {"æ", "ae"},
    {"ą", "a"},
    {"ę", "e"},
    {"ł", "l"},
    {"ś", "s"},
    {"ć", "c"},
    {"ż", "z"},
    {"ź", "z"},
    {"ń", "n"},
    {"ů", "u"},
    {"ě", "e"},
    {"š", "s"},
    {"č", "c"},
    {"ř", "r"},
    {"ž", "z"},
    {"ý", "y"},
}};

constexpr ByFirstByte<kLetters.size()> kLettersByByte(kLetters, [](const auto& letter) { return letter.first; });

bool IsLower(char c) { return c >= 'a' && c <= 'z'; }
bool IsUpper(char c) { return c >= 'A' && c <= 'Z'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) { return IsLower(c) || IsUpper(c); }

std::string ToAscii(std::string_view name) {
  std::string ascii;
  while (!name.empty()) {
    const std::size_t found =
        kLettersByByte.Find(name, [&](std::size_t i) { return name.starts_with(kLetters[i].first); });
    if (found < kLetters.size()) {
      ascii += kLetters[found].second;
      name.remove_prefix(kLetters[found].first.size());
      continue;
    }
    ascii += name.front();
    name.remove_prefix(1);
  }
  return ascii;
}

bool IsUnitOfAnything(std::string_view unit) {
  const std::string plain = PlainUnit(unit);
  return !plain.empty() && plain != "-" && plain != "m" && plain != "a" && plain != "v" && plain != "mv" &&
         plain != "na" && plain != "rel" &&
         (ParseAngleUnit(plain) || ParseWavelengthUnit(plain) || (ParseValueScale(plain) && !ParseDouble(plain)) ||
          plain == "grad");
}

// In brackets even a bare "-", "1", "m" or "a" is a unit, and so is what is none that is known but looks like one.
bool IsBracketedUnit(std::string_view text) {
  const std::string plain = PlainUnit(text);
  if (plain.empty() || IsUnitOfAnything(plain)) return true;
  // "(x 1000)" is no wavelength: some mean by it that the numbers are to be multiplied, some that they have been.
  if (plain.size() > 1 && (plain[0] == 'x' || plain[0] == '*') && IsDigit(plain[1])) return true;
  if (plain == "-" || plain == "1" || plain == "m" || plain == "a" || plain == "w" || plain == "rel" || plain == "ppm")
    return true;
  return plain.find('/') != std::string::npos || plain.find('^') != std::string::npos;
}

// Takes units in brackets off the end. Brackets with anything else stay.
void TakeBracketedUnit(std::string* name, std::string* unit) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}, std::pair{'<', '>'}}) {
    const std::string_view text = Trim(*name);
    if (text.size() < 3 || text.back() != close) continue;
    std::size_t depth = 0, at = text.size();
    while (at > 0) {
      --at;
      if (text[at] == close) ++depth;
      if (text[at] == open && --depth == 0) break;
    }
    if (at == 0 || depth != 0) continue;
    const std::string_view inside = text.substr(at + 1, text.size() - at - 2);
    if (!IsBracketedUnit(inside)) continue;
    *unit = PlainUnit(inside);
    *name = std::string(Trim(text.substr(0, at)));
    return;
  }
}

// "theta_i / deg" (ISO 80000), "theta_i, deg" and "angle in deg".
void TakeTrailingUnit(std::string* name, std::string* unit) {
  // "brdf_1/sr", "brdf_per_sr", "BRDF sr-1": a unit that has signs of its own.
  for (std::size_t at = name->find_first_of("_ ", 1); at != std::string::npos; at = name->find_first_of("_ ", at + 1)) {
    std::string rest = name->substr(at + 1);
    rest.erase(std::remove(rest.begin(), rest.end(), '_'), rest.end());
    // "1000 cm-1"
    const bool inverse = rest.find_first_of("-^/") != std::string::npos && ParseWavelengthUnit(rest);
    if (!IsPerSteradian(PlainUnit(rest)) && !inverse) continue;
    *unit = PlainUnit(rest);
    name->resize(at);
    return;
  }
  for (const std::string_view mark : {" / ", "/", ", ", " in "}) {
    const std::size_t at = name->rfind(mark);
    if (at == std::string::npos || at == 0) continue;
    const std::string_view inside = std::string_view(*name).substr(at + mark.size());
    if (!IsUnitOfAnything(inside)) continue;
    *unit = PlainUnit(inside);
    name->resize(at);
    return;
  }
}

// Breaks a word where "thetaIn" and "theta0", "phir", "thetaout" hide two.
void AppendWord(std::string word, NameWords* split) {
  std::vector<std::string>* words = &split->words;
  word = ToLower(word);
  if (const std::vector<std::string_view> english = TranslateWord(word); !english.empty()) {
    split->foreign = split->foreign || english.size() > 1 || english[0] != word;
    for (const std::string_view part : english) {
      if (!part.empty()) words->emplace_back(part);
    }
    return;
  }
  static constexpr std::array<std::string_view, 11> kHeads = {"theta", "phi",   "azimuth",   "zenith", "beta", "lambda",
                                                              "azim",  "delta", "elevation", "mu",     "teta"};
  static constexpr std::array<std::string_view, 26> kTails = {
      "i", "in", "inc", "incident", "o",    "out", "r",   "refl", "s",     "scat",  "v",   "view", "l",
      "e", "0",  "d",   "h",        "diff", "obs", "det", "sun",  "light", "theta", "phi", "beta", "half"};
  // "inc10", "aoi30": an angle in the name.
  for (const std::string_view head : {std::string_view("aoi"), std::string_view("inc")}) {
    if (!BeginsWith(word, head) || !ParseDouble(std::string_view(word).substr(head.size()))) continue;
    words->emplace_back(head);
    words->push_back(word.substr(head.size()));
    return;
  }
  for (const std::string_view head : kHeads) {
    if (!BeginsWith(word, head) || word.size() == head.size()) continue;
    const std::string_view tail = std::string_view(word).substr(head.size());
    if (std::none_of(kTails.begin(), kTails.end(), [&](std::string_view known) { return SameWord(known, tail); }))
      continue;
    words->emplace_back(head);
    words->emplace_back(tail);
    return;
  }
  if (!word.empty()) words->push_back(std::move(word));
}

}  // namespace

NameWords SplitName(std::string_view name) {
  NameWords split;
  // All that stands for something else begins beyond ASCII, but for "+-".
  const bool plain =
      std::none_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80 || c == '+'; });
  std::string text(plain ? Trim(name) : Trim(TranslateScripts(name)));
  if (text.size() > 1 && text.front() == '"' && text.back() == '"')
    text = std::string(Trim(std::string_view(text).substr(1, text.size() - 2)));
  TakeBracketedUnit(&text, &split.unit);
  if (split.unit.empty()) TakeTrailingUnit(&text, &split.unit);
  if (!plain) text = ToAscii(text);
  split.magnitude = text.find('|') != std::string::npos;
  // A function of one argument: its name, and what it is of.
  const std::string_view trimmed = Trim(text);
  const std::size_t open = trimmed.find('(');
  if (open != std::string_view::npos && open > 0 && trimmed.back() == ')' && trimmed.find(')') == trimmed.size() - 1) {
    const std::string head(Trim(trimmed.substr(0, open)));
    for (const std::string_view known : {"log10", "10log10", "10*log10", "lg", "ln", "log", "u", "U", "s", "sigma",
                                         "std", "stdev", "unc", "abs", "dB"}) {
      if (head != known && ToLower(head) != known) continue;
      split.function = head == "U" ? "U" : ToLower(head);
      split.magnitude = split.magnitude || split.function == "abs";
      text = std::string(trimmed.substr(open + 1, trimmed.size() - open - 2));
      break;
    }
  }
  std::string word;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool decimal_point = c == '.' && i > 0 && i + 1 < text.size() && IsDigit(text[i - 1]) && IsDigit(text[i + 1]);
    // "theta_o=-80", but not the hyphen of "theta-1" or "450-650".
    const bool sign = c == '-' && word.empty() && i + 1 < text.size() && IsDigit(text[i + 1]) &&
                      (i == 0 || (!IsLetter(text[i - 1]) && !IsDigit(text[i - 1])));
    const bool percent = c == '%';
    const bool kept =
        IsLetter(c) || IsDigit(c) || decimal_point || sign || percent || static_cast<unsigned char>(c) >= 0x80;
    const bool hump = IsUpper(c) && i > 0 &&
                      (IsLower(text[i - 1]) || (IsUpper(text[i - 1]) && i + 1 < text.size() && IsLower(text[i + 1])));
    // "thetaIRad": the letter between is a word.
    const bool lone = hump && word.size() == 1 && i > 1 && IsLower(text[i - 2]);
    if (!kept || (hump && word.size() > 1) || lone) {
      AppendWord(std::exchange(word, {}), &split);
    }
    if (kept) word += c;
  }
  AppendWord(word, &split);
  // "brdfPerSr"
  if (split.unit.empty() && split.words.size() > 2 && split.words.back() == "sr" &&
      split.words[split.words.size() - 2] == "per") {
    split.unit = "1/sr";
    split.words.resize(split.words.size() - 2);
  }
  // "BRDF (633 nm) [1/sr]"
  if (!split.unit.empty() && split.words.size() > 2 && ParseWavelengthUnit(split.words.back()) &&
      ParseDouble(split.words[split.words.size() - 2])) {
    const std::string unit = std::move(split.words.back());
    split.words.pop_back();
    split.words.back() += unit;
  }
  if (split.unit.empty() && split.words.size() > 1 && IsUnitOfAnything(split.words.back())) {
    split.unit = PlainUnit(split.words.back());
    split.words.pop_back();
  }
  // German "Grad" is the degree; beside English words it may be the gon.
  if (split.foreign && split.unit == "grad") split.unit = "deg";
  // An "A" by itself may be anything, behind a number alone it is the angstrom.
  if (split.unit.empty() && split.words.size() == 2 && split.words[1] == "a" && ParseDouble(split.words[0])) {
    split.unit = "a";
    split.words.pop_back();
  }
  return split;
}

}  // namespace lobefit
