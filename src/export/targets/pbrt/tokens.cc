#include "lobefit/export/targets/pbrt/tokens.h"

#include <algorithm>

#include "lobefit/base/text.h"

namespace lobefit {

std::vector<PbrtToken> PbrtTokens(std::string_view text) {
  std::vector<PbrtToken> tokens;
  LineReader lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    for (std::size_t i = 0; i < line.size();) {
      const char c = line[i];
      if (c == '#') break;
      if (c == ' ' || c == '\t' || c == '\r') {
        ++i;
      } else if (c == '"') {
        const std::size_t end = std::min(line.find('"', i + 1), line.size());
        tokens.push_back({std::string(line.substr(i + 1, end - i - 1)), lines.line_number(), true});
        i = end + 1;
      } else if (c == '[' || c == ']') {
        tokens.push_back({std::string(1, c), lines.line_number(), false});
        ++i;
      } else {
        const std::size_t end = std::min(line.find_first_of(" \t\r\"[]#", i), line.size());
        tokens.push_back({std::string(line.substr(i, end - i)), lines.line_number(), false});
        i = end;
      }
    }
  }
  return tokens;
}

}  // namespace lobefit
