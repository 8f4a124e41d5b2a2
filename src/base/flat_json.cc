#include "lobefit/base/flat_json.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"

namespace lobefit {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Length of the number [RFC 8259, section 6] at the beginning; 0 where there is none.
std::size_t NumberLength(std::string_view text) {
  std::size_t at = 0;
  const auto peek = [&] { return at < text.size() ? text[at] : '\0'; };
  const auto digits = [&] {
    const std::size_t begin = at;
    while (IsDigit(peek())) ++at;
    return at - begin;
  };
  if (peek() == '-') ++at;
  if (peek() == '0') {
    ++at;
  } else if (digits() == 0) {
    return 0;
  }
  if (peek() == '.') {
    ++at;
    if (digits() == 0) return 0;
  }
  if (peek() == 'e' || peek() == 'E') {
    ++at;
    if (peek() == '+' || peek() == '-') ++at;
    if (digits() == 0) return 0;
  }
  return at;
}

std::optional<std::uint32_t> FourDigits(std::string_view text) {
  if (text.size() < 4) return std::nullopt;
  std::uint32_t code = 0;
  for (const char c : text.substr(0, 4)) {
    const std::size_t digit = std::string_view("0123456789abcdef").find(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c);
    if (digit == std::string_view::npos) return std::nullopt;
    code = 16 * code + static_cast<std::uint32_t>(digit);
  }
  return code;
}

void AppendUtf8(std::uint32_t code, std::string* text) {
  const auto tail = [&](int shift) { *text += static_cast<char>(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x80) {
    *text += static_cast<char>(code);
  } else if (code < 0x800) {
    *text += static_cast<char>(0xC0 | (code >> 6));
    tail(0);
  } else if (code < 0x10000) {
    *text += static_cast<char>(0xE0 | (code >> 12));
    tail(6);
    tail(0);
  } else {
    *text += static_cast<char>(0xF0 | (code >> 18));
    tail(12);
    tail(6);
    tail(0);
  }
}

// The character of "u" and four digits, or of two such that are surrogates; `at` is that of the "u" and goes past it.
std::optional<std::uint32_t> EscapedCode(std::string_view text, std::size_t* at) {
  const std::optional<std::uint32_t> high = FourDigits(text.substr(*at + 1));
  if (!high) return std::nullopt;
  *at += 5;
  if (*high < 0xD800 || *high > 0xDFFF) return high;
  if (*high > 0xDBFF || text.substr(*at, 2) != "\\u") return std::nullopt;
  const std::optional<std::uint32_t> low = FourDigits(text.substr(*at + 2));
  if (!low || *low < 0xDC00 || *low > 0xDFFF) return std::nullopt;
  *at += 6;
  return 0x10000 + ((*high - 0xD800) << 10) + (*low - 0xDC00);
}

}  // namespace

void FlatJson::Fail() const { throw InputError("'" + Excerpt(text_) + "' is no JSON object without nested ones"); }

void FlatJson::SkipBlanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

void FlatJson::Expect(char c) {
  SkipBlanks();
  if (at_ == text_.size() || text_[at_] != c) Fail();
  ++at_;
}

std::string_view FlatJson::String(std::string* unescaped) {
  Expect('"');
  const std::size_t begin = at_;
  const auto special = [](char c) { return c == '"' || c == '\\' || (c >= 0 && c < ' '); };
  const auto find = [&] {
    while (at_ < text_.size() && !special(text_[at_])) ++at_;
    if (at_ == text_.size() || (text_[at_] != '"' && text_[at_] != '\\')) Fail();
  };
  find();
  if (text_[at_] == '"') return text_.substr(begin, at_++ - begin);
  unescaped->assign(text_.substr(begin, at_ - begin));
  while (text_[at_] != '"') {
    if (++at_ == text_.size()) Fail();
    static constexpr std::string_view kEscapes = "\"\\/bfnrt", kMeant = "\"\\/\b\f\n\r\t";
    if (text_[at_] == 'u') {
      const std::optional<std::uint32_t> code = EscapedCode(text_, &at_);
      if (!code) Fail();
      AppendUtf8(*code, unescaped);
    } else {
      const std::size_t which = kEscapes.find(text_[at_++]);
      if (which == std::string_view::npos) Fail();
      *unescaped += kMeant[which];
    }
    const std::size_t plain = at_;
    find();
    unescaped->append(text_.substr(plain, at_ - plain));
  }
  ++at_;
  return *unescaped;
}

void FlatJson::Value() {
  SkipBlanks();
  const std::string_view rest = text_.substr(at_);
  if (rest.starts_with('"')) {
    kind_ = Kind::kString;
    value_ = String(&value_text_);
    return;
  }
  std::size_t length = 0;
  for (const std::string_view word : {"null", "true", "false"}) {
    if (!rest.starts_with(word)) continue;
    length = word.size();
    kind_ = word == "null" ? Kind::kNull : Kind::kBoolean;
  }
  if (length == 0) {
    length = NumberLength(rest);
    kind_ = Kind::kNumber;
  }
  if (length == 0) Fail();
  value_ = rest.substr(0, length);
  at_ += length;
}

bool FlatJson::Next() {
  if (!begun_) Expect('{');
  SkipBlanks();
  if (at_ < text_.size() && text_[at_] == '}') {
    ++at_;
    SkipBlanks();
    if (at_ != text_.size()) Fail();
    return false;
  }
  if (begun_) Expect(',');
  begun_ = true;
  name_ = String(&name_text_);
  Expect(':');
  Value();
  return true;
}

}  // namespace lobefit
