#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/printable.h"
#include "lobefit/base/text.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {
namespace {

struct Manifest {
  std::string name;
  std::filesystem::path folder;

  [[noreturn]] void Fail(const toml::source_region& at, const std::string& message) const {
    throw InputError(fmt::format("{}:{}: {}", name, at.begin.line, message));
  }
  void CheckKeys(const toml::table& table, const std::vector<std::string>& allowed) const {
    for (const auto& [key, node] : table) {
      const std::string given(key.str());
      if (std::find(allowed.begin(), allowed.end(), given) == allowed.end()) {
        Fail(key.source(),
             fmt::format("unknown key '{}'{}; allowed: {}", Excerpt(given), DidYouMean(given, allowed), Join(allowed)));
      }
    }
  }
  std::string Text(const toml::table& table, const char* key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return "";
    if (!node->is_string()) Fail(node->source(), fmt::format("'{}' must be a text", key));
    return *node->value<std::string>();
  }
  double Number(const toml::table& table, const char* key, double otherwise, double low, double high) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return otherwise;
    const double value = node->is_number() ? *node->value<double>() : kNan;
    if (!(value >= low && value <= high)) {
      Fail(node->source(), fmt::format("'{}' must be a number from {} to {}", key, low, high));
    }
    return value;
  }
  // The files of a pattern with one star in its last part, sorted by name.
  std::vector<std::filesystem::path> Matching(const std::string& pattern) const {
    const std::filesystem::path full = folder / pattern;
    const std::string last = full.filename().string();
    const std::size_t star = last.find('*');
    if (star == std::string::npos) return {full};
    const std::string head = last.substr(0, star), tail = last.substr(star + 1);
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(full.parent_path(), error)) {
      const std::string file = entry.path().filename().string();
      if (file.size() >= head.size() + tail.size() && file.rfind(head, 0) == 0 &&
          file.compare(file.size() - tail.size(), tail.size(), tail) == 0) {
        found.push_back(full.parent_path() / file);
      }
    }
    std::sort(found.begin(), found.end());
    if (found.empty()) throw InputError(fmt::format("{}: no file matches images = '{}'", name, Excerpt(pattern)));
    return found;
  }
};

void ReadImages(const Manifest& manifest, const toml::table& table, Stack* stack) {
  const toml::node* node = table.get("images");
  if (node == nullptr) return;
  if (const toml::array* array = node->as_array()) {
    for (const toml::node& item : *array) {
      if (!item.is_string()) manifest.Fail(item.source(), "images must be file names");
      stack->images.push_back(manifest.folder / *item.value<std::string>());
    }
    return;
  }
  stack->images = manifest.Matching(manifest.Text(table, "images"));
}

void ReadLights(const Manifest& manifest, const toml::table& table, Stack* stack) {
  const toml::table* lights = table["lights"].as_table();
  if (lights == nullptr) throw InputError(manifest.name + ": a table [lights] with file = \"...\" is needed");
  manifest.CheckKeys(*lights, {"file", "intensity", "kind"});
  const std::string kind = manifest.Text(*lights, "kind");
  if (!kind.empty() && kind != "distant") {
    manifest.Fail(lights->get("kind")->source(),
                  fmt::format("lights of kind '{}' are not understood; allowed: distant", Excerpt(kind)));
  }
  const std::string file = manifest.Text(*lights, "file");
  if (file.empty()) throw InputError(manifest.name + ": [lights] needs file = \"...\": a .lp, or x y z a line");
  const std::filesystem::path path = manifest.folder / file;
  if (path.extension() == ".lp") {
    StackFiles read = ReadLightFile(path);
    stack->lights = read.stack.lights;
    if (stack->images.empty()) stack->images = read.stack.images;
  } else {
    for (const std::vector<double>& row : ReadTable(path, 3)) {
      const std::string place = fmt::format("{}, light {}", PrintableName(path), stack->lights.size() + 1);
      stack->lights.push_back({LightDirection(row[0], row[1], row[2], place), {1, 1, 1}});
    }
  }
  const std::string intensity = manifest.Text(*lights, "intensity");
  if (intensity.empty()) return;
  const std::vector<std::vector<double>> rows = ReadTable(manifest.folder / intensity, 3);
  if (rows.size() != stack->lights.size()) {
    throw InputError(fmt::format("{}: {} intensities for {} lights", PrintableName(manifest.folder / intensity),
                                 rows.size(), stack->lights.size()));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(rows[i][c] > 0)) {
        throw InputError(fmt::format("{}, light {}: intensity {} is not positive",
                                     PrintableName(manifest.folder / intensity), i + 1, rows[i][c]));
      }
      stack->lights[i].intensity[c] = rows[i][c];
    }
  }
}

}  // namespace

StackFiles ReadManifest(const std::filesystem::path& file) {
  const Manifest manifest = {PrintableName(file), file.parent_path()};
  const FileBytes bytes(file);
  toml::table table;
  try {
    table = toml::parse(bytes.bytes());
  } catch (const toml::parse_error& error) {
    manifest.Fail(error.source(), Excerpt(error.description(), 200));
  }
  manifest.CheckKeys(table, {"images", "mask", "encoding", "saturation", "black", "calibrated", "lights"});
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "stack.toml";
  ReadImages(manifest, table, &stack);
  ReadLights(manifest, table, &stack);
  const std::string encoding = manifest.Text(table, "encoding"), mask = manifest.Text(table, "mask");
  if (!encoding.empty()) ReadEncoding(encoding, manifest.name, &stack.response);
  stack.response.black = manifest.Number(table, "black", 0, 0, 0.9);
  stack.response.saturation = manifest.Number(table, "saturation", stack.response.saturation, 0.1, 1);
  if (const toml::node* node = table.get("calibrated")) {
    if (!node->is_boolean()) manifest.Fail(node->source(), "'calibrated' must be true or false");
    stack.calibrated = *node->value<bool>();
  }
  if (!mask.empty()) files.mask = manifest.folder / mask;
  return files;
}

}  // namespace lobefit
