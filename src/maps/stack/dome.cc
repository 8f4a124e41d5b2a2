#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {
namespace {

using Json = nlohmann::json;

struct DomeFile {
  std::string name;
  Json json;

  [[noreturn]] void Fail(const std::string& message) const { throw InputError(name + ": " + message); }

  // A list of {"x": , "y": , "z": }.
  std::vector<Vec3> Points(const char* key) const {
    const auto list = json.find(key);
    if (list == json.end() || !list->is_array() || list->empty()) {
      Fail(fmt::format("'{}' holds no lights; a list of x, y, z is expected there", key));
    }
    std::vector<Vec3> points;
    for (const Json& item : *list) {
      const auto number = [&](const char* axis) {
        if (!item.is_object() || !item.contains(axis) || !item[axis].is_number()) {
          Fail(fmt::format("{}[{}] has no number '{}'", key, points.size(), axis));
        }
        return item[axis].get<double>();
      };
      // Made one by one: where a member of an aggregate throws, g++ 12 ends with a crash.
      const double x = number("x"), y = number("y"), z = number("z");
      points.push_back({x, y, z});
    }
    return points;
  }
};

// The images beside it, by name.
std::vector<std::filesystem::path> ImagesBeside(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> images;
  std::error_code error;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (IsImageName(entry.path())) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  return images;
}

}  // namespace

bool IsImageName(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (const char* known : {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr"}) {
    if (extension == known) return true;
  }
  return false;
}

StackFiles ReadDome(const std::filesystem::path& path) {
  const FileBytes bytes(path);
  const DomeFile file = {PrintableName(path), Json::parse(bytes.bytes(), nullptr, false)};
  if (!file.json.is_object()) file.Fail("is no JSON object, as a dome of RelightLab is");
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "RelightLab dome";
  stack.images = ImagesBeside(path);
  const std::vector<std::string> kinds = {"directional", "spherical", "lights3d"};
  const auto kind = file.json.find("lightConfiguration");
  const std::string word = kind == file.json.end() ? kinds[0]
                           : kind->is_string()     ? kind->get<std::string>()
                                                   : std::string("?");
  if (std::find(kinds.begin(), kinds.end(), word) == kinds.end()) {
    file.Fail(fmt::format("lightConfiguration '{}' is unknown{}; allowed: {}", Excerpt(word), DidYouMean(word, kinds),
                          Join(kinds)));
  }
  const char* key = word == "directional" ? "directions" : word == "spherical" ? "positionsSphere" : "positions3d";
  for (const Vec3& p : file.Points(key)) {
    const Vec3 direction =
        LightDirection(p.x, p.y, p.z, fmt::format("{}, {}[{}]", file.name, key, stack.lights.size()));
    stack.lights.push_back({direction, {1, 1, 1}, p});
  }
  if (word != "directional") {
    const auto width = file.json.find("imageWidth");
    const double value = width != file.json.end() && width->is_number() ? width->get<double>() : 0;
    if (!(value > 0)) {
      file.Fail(
          fmt::format("lights of configuration '{}' need imageWidth, the width of the picture in their unit", word));
    }
    SetNear({}, value, file.name, &stack);
  }
  const auto adjust = file.json.find("ledAdjust");
  if (adjust != file.json.end() && adjust->is_array() && !adjust->empty()) {
    stack.remarks.emplace_back(
        "ledAdjust of the dome is not used; where its lights differ, give their intensities in a stack.toml");
  }
  return files;
}

}  // namespace lobefit
