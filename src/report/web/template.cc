#include "lobefit/report/web/template.h"

#include <stdexcept>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/base64.h"

namespace lobefit {

std::string FillTemplate(std::string_view text, const std::map<std::string, std::string, std::less<>>& values,
                         const std::map<std::string, bool, std::less<>>& sections) {
  std::string filled;
  while (true) {
    const std::size_t open = text.find("{{");
    filled += text.substr(0, open);
    if (open == std::string_view::npos) return filled;
    const std::size_t close = text.find("}}", open);
    if (close == std::string_view::npos) throw std::logic_error("template: {{ without }}");
    std::string_view name = text.substr(open + 2, close - open - 2);
    text.remove_prefix(close + 2);
    if (name.starts_with('/')) continue;
    if (name.starts_with('#')) {
      name.remove_prefix(1);
      const std::string end = "{{/" + std::string(name) + "}}";
      const auto section = sections.find(name);
      const std::size_t at = text.find(end);
      if (section == sections.end() || at == std::string_view::npos)
        throw std::logic_error("template: section " + std::string(name));
      if (!section->second) text.remove_prefix(at + end.size());
      continue;
    }
    const auto value = values.find(name);
    if (value == values.end()) throw std::logic_error("template: no value for " + std::string(name));
    filled += value->second;
  }
}

std::string PolicyHash(std::string_view text) { return "sha256-" + Base64(Sha256(text)); }

}  // namespace lobefit
