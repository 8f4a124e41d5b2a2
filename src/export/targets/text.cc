#include "lobefit/export/targets/text.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::string_view kRotationKey = "uv-rotation-deg:";

}  // namespace

std::string Number9(double value) { return fmt::format("{:.9g}", value); }

std::string FloatLiteral(double value) {
  std::string text = Number9(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string Numbers9(const std::vector<double>& values, std::string_view separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : std::string(separator)) + Number9(value);
  return text;
}
std::string Numbers9(const Color3& values, std::string_view separator) {
  return Numbers9(ToSpectrum(values), separator);
}

std::string PythonString(std::string_view text) {
  std::string literal = "'";
  while (!text.empty()) {
    const std::size_t length = Utf8Length(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
    const auto c = static_cast<unsigned char>(character[0]);
    if (length == 0) {
      literal += '?';
    } else if (c < 0x20 || c == 0x7f) {
      literal += fmt::format("\\x{:02x}", c);
    } else {
      if (c == '\'' || c == '\\') literal += '\\';
      literal += character;
    }
    text.remove_prefix(character.size());
  }
  return literal + "'";
}

std::string CommentLines(const std::vector<std::string>& lines, std::string_view mark) {
  std::string text;
  for (const std::string& line : lines) text += fmt::format("{} {}\n", mark, Printable(line));
  return text;
}

std::string XmlComment(const std::vector<std::string>& lines) {
  std::string text = CommentLines(lines, "");
  for (std::size_t at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.replace(at, 2, "- -");
  return "<!--\n" + text + "-->\n";
}

std::vector<std::string> RotationComment(double rotation) {
  if (rotation == 0) return {};
  return {fmt::format("{} {}", kRotationKey, FormatDouble(RadiansToDegrees(rotation))),
          "The format has no rotation: turn the texture coordinates of the mesh by this angle, u' = u cos + v sin, "
          "v' = v cos - u sin."};
}

double RotationOfComment(std::string_view text) {
  const std::size_t at = text.find(kRotationKey);
  if (at == std::string_view::npos) return 0;
  const std::string_view rest = text.substr(at + kRotationKey.size());
  return DegreesToRadians(ParseDouble(rest.substr(0, rest.find('\n'))).value_or(0));
}

std::string MapComment(const std::vector<std::string>& maps, std::string_view beside) {
  return fmt::format(
      "The renderer looks for the normal map {} beside {}; --map-path of the export writes another place.", Join(maps),
      beside);
}

std::filesystem::path FindMap(const std::filesystem::path& file, const std::string& name) {
  std::filesystem::path map = file.parent_path() / name;
  if (!std::filesystem::exists(map)) map = file.parent_path() / std::filesystem::path(name).filename();
  if (std::filesystem::exists(map) && !std::filesystem::is_regular_file(map)) {
    throw InputError(PrintableName(file) + ": the normal map '" + PrintableName(map) +
                     "' is no regular file; name a PNG picture");
  }
  return map;
}

std::string GlslPrefix(const std::string& name) {
  // Two underscores in a row are reserved.
  std::string prefix = "lobefit_";
  for (const char c : Identifier(name) + "_") {
    if (c != '_' || prefix.back() != '_') prefix += c;
  }
  return prefix;
}

std::string GlslShortName(const std::string& name, const std::string& own) {
  std::string guard = "LOBEFIT_";
  for (const char c : name) guard += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format("#ifndef {0}\n#define {0}\n#define lobefit_{1} {2}\n#endif\n", guard, name, own);
}

std::string Identifier(const std::string& name) {
  std::string identifier;
  for (const char c : name) identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier[0])) != 0) {
    identifier = "m_" + identifier;
  }
  return identifier;
}

}  // namespace lobefit
