#include "lobefit/export/targets/text.h"

#include <cctype>

#include <fmt/format.h>

#include "lobefit/base/text.h"

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

std::string Numbers9(const Color3& values, std::string_view separator) {
  return fmt::format("{:.9g}{}{:.9g}{}{:.9g}", values[0], separator, values[1], separator, values[2]);
}

std::string CommentLines(const std::vector<std::string>& lines, std::string_view mark) {
  std::string text;
  for (const std::string& line : lines) text += fmt::format("{} {}\n", mark, line);
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

double CommonRotation(const FittedBrdf& fit) {
  double rotation = 0, largest = -1;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const double f0 = fit.Fresnel(l, 0, 1);
    if (fit.lobes()[l].anisotropic && f0 > largest) rotation = fit.lobes()[l].rotation, largest = f0;
  }
  return rotation;
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
