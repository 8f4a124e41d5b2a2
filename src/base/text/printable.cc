#include "lobefit/base/text/printable.h"

#include <algorithm>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

unsigned Byte(std::string_view text, std::size_t at) { return static_cast<unsigned char>(text[at]); }

// The character's number; `length` as Utf8Length gives it.
char32_t Decode(std::string_view text, std::size_t length) {
  char32_t code = length == 1 ? Byte(text, 0) : Byte(text, 0) & (0xffU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) code = code << 6 | (Byte(text, i) & 0x3fU);
  return code;
}

bool IsHarmless(char32_t code) {
  if (code < 0x20 || (code >= 0x7f && code < 0xa0)) return false;
  // Bidirectional marks, embeddings, overrides and isolates; line and paragraph separators; the byte order mark.
  const bool turns = code == 0x61c || (code >= 0x200e && code <= 0x200f) || (code >= 0x2028 && code <= 0x202e) ||
                     (code >= 0x2066 && code <= 0x2069);
  return !turns && code != 0xfeff;
}

std::string Clean(std::string_view text, std::string_view kept) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    const bool keep = length > 0 && (IsHarmless(Decode(text, length)) || kept.find(text[0]) != std::string_view::npos);
    clean += keep ? text.substr(0, length) : "?";
    text.remove_prefix(std::max<std::size_t>(1, length));
  }
  return clean;
}

bool IsPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_@%+=:,./-").find(c) != std::string_view::npos;
}

}  // namespace

std::size_t Utf8Length(std::string_view text) {
  if (text.empty()) return 0;
  const unsigned lead = Byte(text, 0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xc2 && lead < 0xe0   ? 2
                             : lead >= 0xe0 && lead < 0xf0 ? 3
                             : lead >= 0xf0 && lead < 0xf5 ? 4
                                                           : 0;
  if (length == 0 || length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((Byte(text, i) & 0xc0U) != 0x80U) return 0;
  }
  // Neither longer than it has to be, nor half of a pair, nor past the last character.
  const unsigned second = Byte(text, 1);
  const bool bad = (lead == 0xe0 && second < 0xa0) || (lead == 0xed && second >= 0xa0) ||
                   (lead == 0xf0 && second < 0x90) || (lead == 0xf4 && second >= 0x90);
  return bad ? 0 : length;
}

std::string Printable(std::string_view text) { return Clean(text, ""); }
std::string PrintableName(const std::filesystem::path& path) { return Clean(path.native(), ""); }
std::string PrintableLines(std::string_view text) { return Clean(text, "\n\t"); }

std::string JoinSome(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 20;
  std::vector<std::string> shown;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i) shown.push_back(Excerpt(names[i]));
  return Join(shown) + (names.size() > kMost ? " and " + std::to_string(names.size() - kMost) + " more" : "");
}

std::string MarkupText(std::string_view text) {
  std::string html;
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    const auto c = static_cast<unsigned char>(text[0]);
    const char32_t code = length == 0 ? 0 : Decode(text, length);
    const bool control =
        (code < 0x20 && c != '\t' && c != '\n') || (code >= 0x7f && code < 0xa0) || code == 0xfffe || code == 0xffff;
    if (length == 0 || control) {
      html += "\xEF\xBF\xBD";
    } else if (c == '&') {
      html += "&amp;";
    } else if (c == '<') {
      html += "&lt;";
    } else if (c == '>') {
      html += "&gt;";
    } else if (c == '"') {
      html += "&quot;";
    } else if (c == '\'') {
      html += "&#39;";
    } else {
      html += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return html;
}

std::string ShellWord(std::string_view argument) {
  if (!argument.empty() && std::all_of(argument.begin(), argument.end(), IsPlain)) return std::string(argument);
  const bool one_line = std::none_of(argument.begin(), argument.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) == 0x7f;
  });
  std::string word = one_line ? "'" : "$'";
  for (const char c : argument) {
    const auto byte = static_cast<unsigned char>(c);
    if (one_line) {
      word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    } else if (byte < 0x20 || byte == 0x7f) {
      word += {'\\', static_cast<char>('0' + byte / 64), static_cast<char>('0' + byte / 8 % 8),
               static_cast<char>('0' + byte % 8)};
    } else {
      word += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    }
  }
  return word + "'";
}

}  // namespace lobefit
