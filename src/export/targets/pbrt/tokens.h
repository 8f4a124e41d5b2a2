// Words of pbrt's scene text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

struct PbrtToken {
  std::string text;
  std::size_t line = 1;
  bool quoted = false;
};

// Words, quoted strings and brackets; comments are dropped.
std::vector<PbrtToken> PbrtTokens(std::string_view text);

// `text` in double quotes, with \\ before what would end it or begin an escape; control characters become '?'.
std::string PbrtString(std::string_view text);

}  // namespace lobefit
