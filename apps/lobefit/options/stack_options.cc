#include "options/stack_options.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

std::string StackName(const std::filesystem::path& stack) {
  std::error_code error;
  std::filesystem::path path = std::filesystem::weakly_canonical(stack, error);
  if (error) path = stack;
  if (path.filename() == "stack.toml") path = path.parent_path();
  const std::string name = std::filesystem::is_directory(path, error) ? path.filename().string() : path.stem().string();
  return name.empty() ? "stack" : name;
}

std::vector<std::size_t> ParseLights(const std::string& text, const char* option, std::size_t lights) {
  std::vector<std::size_t> indices;
  if (text.empty()) return indices;
  for (const std::string_view word : Split(text, ',')) {
    const std::optional<long long> number = ParseInteger(Trim(word));
    if (!number || *number < 1 || static_cast<std::size_t>(*number) > lights) {
      throw UsageError(
          fmt::format("{} '{}': numbers of lights from 1 to {} are expected", option, Excerpt(word), lights));
    }
    indices.push_back(static_cast<std::size_t>(*number - 1));
  }
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  return indices;
}

}  // namespace lobefit
