#include "lobefit/export/targets/pbrt/tokens.h"

#include <algorithm>

#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

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
        std::string quoted;
        for (++i; i < line.size() && line[i] != '"'; ++i) {
          if (line[i] == '\\' && i + 1 < line.size()) ++i;
          quoted += line[i];
        }
        ++i;
        tokens.push_back({std::move(quoted), lines.line_number(), true});
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

std::string PbrtString(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : Printable(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace lobefit
