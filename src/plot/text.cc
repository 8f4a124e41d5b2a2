// The text of a canvas: UTF-8, markup for raised and lowered characters, lines that fit.
#include <algorithm>
#include <cmath>

#include "lobefit/plot/canvas.h"

namespace lobefit {
namespace {

// Characters of well-formed UTF-8; a byte that is not becomes U+FFFD, so that no file name breaks a picture.
std::u32string Decode(std::string_view utf8) {
  std::u32string text;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[i]);
    const int length = lead < 0x80                   ? 1
                       : lead >= 0xC2 && lead < 0xE0 ? 2
                       : lead >= 0xE0 && lead < 0xF0 ? 3
                       : lead >= 0xF0 && lead < 0xF5 ? 4
                                                     : 0;
    char32_t character = length == 1 ? lead : length == 2 ? lead & 0x1FU : length == 3 ? lead & 0x0FU : lead & 0x07U;
    bool valid = length > 0 && i + static_cast<std::size_t>(length) <= utf8.size();
    for (int k = 1; valid && k < length; ++k) {
      const auto next = static_cast<unsigned char>(utf8[i + static_cast<std::size_t>(k)]);
      valid = (next & 0xC0U) == 0x80U;
      character = (character << 6U) | (next & 0x3FU);
    }
    text.push_back(valid ? (character < 32 ? U' ' : character) : U'\uFFFD');
    i += valid ? static_cast<std::size_t>(length) : 1;
  }
  return text;
}

std::string Encode(std::u32string_view text) {
  std::string utf8;
  for (const char32_t c : text) {
    const auto put = [&utf8](char32_t byte) { utf8.push_back(static_cast<char>(static_cast<unsigned char>(byte))); };
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0U | (c >> 6U)), put(0x80U | (c & 0x3FU));
    } else if (c < 0x10000) {
      put(0xE0U | (c >> 12U)), put(0x80U | ((c >> 6U) & 0x3FU)), put(0x80U | (c & 0x3FU));
    } else {
      put(0xF0U | (c >> 18U)), put(0x80U | ((c >> 12U) & 0x3FU)), put(0x80U | ((c >> 6U) & 0x3FU)),
          put(0x80U | (c & 0x3FU));
    }
  }
  return utf8;
}

struct Piece {
  char32_t character;
  int level;  // -1 lowered, 0, 1 raised
};

std::vector<Piece> Parse(std::u32string_view text, bool markup) {
  std::vector<Piece> pieces;
  int level = 0;
  bool group = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char32_t c = text[i];
    if (markup && !group && level == 0 && (c == U'_' || c == U'^') && i + 1 < text.size()) {
      level = c == U'_' ? -1 : 1;
      if (text[i + 1] == U'{') group = true, ++i;
      continue;
    }
    if (group && c == U'}') {
      group = false, level = 0;
      continue;
    }
    pieces.push_back({c, level});
    if (!group) level = 0;
  }
  return pieces;
}

constexpr double kSmall = 0.72, kRaise = 0.36, kLower = 0.16;

}  // namespace

double Canvas::TextWidth(std::string_view utf8, const TextStyle& style) const {
  double width = 0;
  for (const Piece& piece : Parse(Decode(utf8), style.markup)) {
    const double pixels = style.size * scale_ * (piece.level == 0 ? 1 : kSmall);
    width += fonts_->Find(piece.character, pixels, style.weight).advance;
  }
  return width / scale_;
}

void Canvas::Text(Point at, std::string_view utf8, const TextStyle& style) {
  const double em = style.size * scale_;
  const double width = TextWidth(utf8, style) * scale_;
  // Along the line, and away from it (up positive), both in pixels from the anchor.
  double pen = style.align == Align::kLeft ? 0 : style.align == Align::kCenter ? -width / 2 : -width;
  const double rise = style.baseline == Baseline::kBottom   ? 0
                      : style.baseline == Baseline::kMiddle ? -0.364 * em
                                                            : -0.73 * em;
  const double x0 = at.x * scale_, y0 = at.y * scale_;
  for (const Piece& piece : Parse(Decode(utf8), style.markup)) {
    const Fonts::Glyph& glyph = fonts_->Find(piece.character, em * (piece.level == 0 ? 1 : kSmall), style.weight);
    const double up = rise + (piece.level > 0 ? kRaise : piece.level < 0 ? -kLower : 0) * em;
    if (!glyph.coverage.empty()) {
      if (style.upwards) {
        cv::Mat turned;
        cv::rotate(glyph.coverage, turned, cv::ROTATE_90_COUNTERCLOCKWISE);
        const int x = static_cast<int>(std::lround(x0 - up)) - glyph.top;
        const int y = static_cast<int>(std::lround(y0 - pen)) - glyph.left - glyph.coverage.cols;
        Blend(turned, {x, y}, style.color, 1);
      } else {
        const int x = static_cast<int>(std::lround(x0 + pen)) + glyph.left,
                  y = static_cast<int>(std::lround(y0 - up)) - glyph.top;
        Blend(glyph.coverage, {x, y}, style.color, 1);
      }
    }
    pen += glyph.advance;
  }
}

std::string Canvas::Shorten(std::string_view utf8, const TextStyle& style, double width, bool middle) const {
  if (TextWidth(utf8, style) <= width) return std::string(utf8);
  const std::u32string text = Decode(utf8);
  for (std::size_t kept = text.size(); kept-- > 0;) {
    const std::size_t head = middle ? (kept + 1) / 2 : kept, tail = kept - head;
    std::string shorter = Encode(text.substr(0, head) + U"…" + text.substr(text.size() - tail));
    if (TextWidth(shorter, style) <= width) return shorter;
  }
  return "…";
}

std::vector<std::string> Canvas::Wrap(std::string_view utf8, const TextStyle& style, double width) const {
  std::vector<std::string> lines;
  std::string line;
  const std::string text(utf8);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    begin = end + 1;
    if (word.empty()) continue;
    std::string longer = line;
    longer.append(line.empty() ? "" : " ").append(word);
    if (!line.empty() && TextWidth(longer, style) > width) {
      lines.push_back(line);
      line = word;
    } else {
      line = longer;
    }
    if (TextWidth(line, style) > width) line = Shorten(line, style, width, true);
  }
  if (!line.empty()) lines.push_back(line);
  return lines;
}

}  // namespace lobefit
