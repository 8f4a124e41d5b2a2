#include "lobefit/base/process/control_group.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

using Path = std::filesystem::path;

std::optional<std::string> FirstLine(const Path& path) {
  std::ifstream file(path);
  std::string line;
  if (!std::getline(file, line)) return std::nullopt;
  return line;
}

// The folder of a group and of each above it. Inside of a container the path of the group may not exist below `root`;
// then `root` itself is the group.
std::vector<Path> GroupsFrom(const Path& root, const std::string& group) {
  std::vector<Path> folders;
  std::error_code error;
  for (Path path = Path(group).relative_path();; path = path.parent_path()) {
    if (std::filesystem::is_directory(root / path, error)) folders.push_back(root / path);
    if (path.empty()) return folders;
  }
}

// Folders of the process' groups: of the one hierarchy of version 2, and of `controller` in version 1.
struct Groups {
  std::vector<Path> unified, old;
};
Groups FindGroups(const Path& root, const Path& self, const std::string& controller) {
  Groups groups;
  std::ifstream file(self);
  std::string line;
  while (std::getline(file, line)) {
    // "0::/path", or "4:cpu,cpuacct:/path".
    const std::vector<std::string_view> fields = Split(line, ':');
    if (fields.size() < 3) continue;
    const std::string path(line.substr(fields[0].size() + fields[1].size() + 2));
    if (fields[1].empty()) groups.unified = GroupsFrom(root, path);
    for (const std::string_view name : Split(fields[1], ',')) {
      if (name == controller) groups.old = GroupsFrom(root / controller, path);
    }
  }
  return groups;
}

std::optional<double> Least(std::optional<double> a, std::optional<double> b) {
  return a && b ? std::min(*a, *b) : a ? a : b;
}

}  // namespace

std::optional<double> ControlGroupProcessors(const Path& root, const Path& self) {
  const Groups groups = FindGroups(root, self, "cpu");
  std::optional<double> least;
  const auto take = [&](const std::optional<double>& quota, const std::optional<double>& period) {
    if (quota && period && *quota > 0 && *period > 0) least = Least(least, *quota / *period);
  };
  for (const Path& folder : groups.unified) {
    const std::string line = FirstLine(folder / "cpu.max").value_or("");
    const std::vector<std::string_view> fields = SplitBlanks(line);
    if (fields.size() == 2) take(ParseDouble(fields[0]), ParseDouble(fields[1]));
  }
  for (const Path& folder : groups.old) {
    take(ParseDouble(FirstLine(folder / "cpu.cfs_quota_us").value_or("")),
         ParseDouble(FirstLine(folder / "cpu.cfs_period_us").value_or("")));
  }
  return least;
}

std::optional<std::uint64_t> ControlGroupMemory(const Path& root, const Path& self) {
  const Groups groups = FindGroups(root, self, "memory");
  std::optional<double> least;
  for (const Path& folder : groups.unified)
    least = Least(least, ParseDouble(FirstLine(folder / "memory.max").value_or("")));
  for (const Path& folder : groups.old)
    least = Least(least, ParseDouble(FirstLine(folder / "memory.limit_in_bytes").value_or("")));
  // No limit is written as "max" or, in version 1, as nearly 2^63.
  constexpr double kNone = 1e18;
  if (!least || !(*least > 0) || *least > kNone) return std::nullopt;
  return static_cast<std::uint64_t>(*least);
}

}  // namespace lobefit
