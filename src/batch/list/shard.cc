#include "lobefit/batch/list/shard.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

std::pair<std::size_t, std::size_t> Shard::Range(std::size_t items) const {
  const std::size_t each = items / count, longer = items % count, before = index - 1;
  const std::size_t begin = before * each + std::min(before, longer);
  return {begin, begin + each + (before < longer ? 1 : 0)};
}

Shard ParseShard(const std::string& text) {
  constexpr long long kMost = 100000;
  const std::vector<std::string_view> parts = Split(text, '/');
  const std::optional<long long> index = parts.size() == 2 ? ParseInteger(parts[0]) : std::nullopt;
  const std::optional<long long> count = parts.size() == 2 ? ParseInteger(parts[1]) : std::nullopt;
  if (!index || !count || *count < 1 || *count > kMost || *index < 1 || *index > *count) {
    throw UsageError(
        fmt::format("--shard {}: is not I/N with I from 1 to N and N at most {}; the third of eight parts is 3/8",
                    Excerpt(text), kMost));
  }
  return {static_cast<std::size_t>(*index), static_cast<std::size_t>(*count)};
}

}  // namespace lobefit
