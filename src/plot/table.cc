#include "lobefit/plot/table.h"

#include <map>

#include "lobefit/plot/style.h"

namespace lobefit {

std::size_t LobeOf(const Parameter& parameter) {
  const std::size_t dot = parameter.name.find('.');
  if (dot == std::string::npos || parameter.name.rfind("lobe", 0) != 0) return 0;
  return static_cast<std::size_t>(parameter.name[4] - '1');
}

std::string Symbol(const Parameter& parameter) {
  static const std::map<std::string, std::string> symbols = {
      {"alpha_x", "α_x"}, {"alpha_y", "α_y"},     {"theta_x", "θ_x"},
      {"theta_y", "θ_y"}, {"theta_z", "θ_z"},     {"f0", "F_0"},
      {"ior", "n"},       {"interface_ior", "n"}, {"diffuse_roughness", "roughness"}};
  const std::size_t dot = parameter.name.find('.');
  const std::string name = dot == std::string::npos ? parameter.name : parameter.name.substr(dot + 1);
  const auto found = symbols.find(name);
  return found == symbols.end() ? name : found->second;
}

double DrawHeading(Canvas* canvas, double x, double y, const std::string& text) {
  if (canvas != nullptr)
    canvas->Text({x, y + 12}, text, {.size = style::kNoteSize, .color = style::kSecondary, .weight = Weight::kBold});
  return y + 16;
}

}  // namespace lobefit
