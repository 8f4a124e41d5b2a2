#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {
namespace {

// "name x y z": the last three words are the direction, so that names may hold blanks.
bool SplitLight(std::string_view line, std::string* name, double numbers[3]) {
  std::string_view rest = Trim(line);
  for (int k = 2; k >= 0; --k) {
    const std::size_t blank = rest.find_last_of(" \t");
    if (blank == std::string_view::npos) return false;
    const std::optional<double> number = ParseDouble(rest.substr(blank + 1));
    if (!number) return false;
    numbers[k] = *number;
    rest = Trim(rest.substr(0, blank));
  }
  *name = rest;
  return !name->empty();
}

}  // namespace

StackFiles ReadLightFile(const std::filesystem::path& file) {
  const FileBytes bytes(file);
  LineReader lines(bytes.bytes());
  std::string_view line;
  const auto fail = [&](const std::string& message) {
    throw InputError(fmt::format("{}:{}: {}", PrintableName(file), lines.line_number(), message));
  };
  if (!lines.Next(&line)) throw InputError(PrintableName(file) + ": empty; the number of lights is expected first");
  const std::optional<long long> count = ParseInteger(Trim(line));
  if (!count || *count < 1 || *count > 100000) {
    fail(fmt::format("'{}' is no number of lights; the first line of a light file holds it", Excerpt(line)));
  }
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "RTI light file";
  while (lines.Next(&line)) {
    if (Trim(line).empty()) continue;
    std::string name;
    double w[3];
    if (!SplitLight(line, &name, w)) fail(fmt::format("'{}' is not FILE x y z", Excerpt(line)));
    stack.images.push_back(file.parent_path() / name);
    const Vec3 direction =
        LightDirection(w[0], w[1], w[2], fmt::format("{}:{}", PrintableName(file), lines.line_number()));
    stack.lights.push_back({direction, {1, 1, 1}, {w[0], w[1], w[2]}});
  }
  if (stack.lights.size() != static_cast<std::size_t>(*count)) {
    throw InputError(fmt::format("{}: the first line promises {} lights, {} follow; correct the one or the other",
                                 PrintableName(file), *count, stack.lights.size()));
  }
  return files;
}

}  // namespace lobefit
