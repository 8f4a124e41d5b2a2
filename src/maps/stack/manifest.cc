#include <algorithm>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/files/toml_file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/exr_parts.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {
namespace {

struct Manifest : TomlFile {
  std::filesystem::path folder;

  std::string Text(const toml::table& table, const char* key) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) return "";
    if (!node->is_string()) Fail(node->source(), fmt::format("'{}' must be a text", key));
    return *node->value<std::string>();
  }
  // The files of a pattern with one star in its last part, sorted by name.
  std::vector<std::filesystem::path> Matching(const std::string& pattern, const char* key) const {
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
    if (found.empty()) throw InputError(fmt::format("{}: no file matches {} = '{}'", name, key, Excerpt(pattern)));
    return found;
  }
};

// A board says all that intensities say: pixels become absolute.
void ReadWhite(const Manifest& manifest, const toml::table& table, Stack* stack) {
  const toml::node* node = table.get("white");
  if (node == nullptr) {
    if (table.contains("white_albedo")) throw InputError(manifest.name + ": white_albedo needs white = \"...\"");
    return;
  }
  stack->white = manifest.Matching(manifest.Text(table, "white"), "white");
  stack->white_albedo = manifest.Number(table, "white_albedo", 1, 0.01, 1.5);
  stack->calibrated = true;
  const toml::table* lights = table["lights"].as_table();
  if (lights != nullptr && lights->contains("intensity")) {
    manifest.Fail(node->source(), "white and the lights' intensity say the same; leave one of them out");
  }
  if (stack->white.size() == stack->images.size()) return;
  manifest.Fail(node->source(), fmt::format("{} photographs of the white board, but {} images; one a light is expected",
                                            stack->white.size(), stack->images.size()));
}

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
  stack->images = manifest.Matching(manifest.Text(table, "images"), "images");
}

// Where `images` names one OpenEXR file of several parts, these are the images: all, or those that the light file
// names.
void ReadParts(const std::vector<std::filesystem::path>& named, const std::filesystem::path& folder, Stack* stack) {
  if (stack->images.size() != 1) return;
  const std::filesystem::path file = stack->images[0];
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error) || !IsExrImage(file)) return;
  const ExrParts parts(file);
  if (parts.names().size() == 1) return;
  for (const std::filesystem::path& name : named) stack->parts.push_back(name.lexically_relative(folder).string());
  if (named.empty()) stack->parts = parts.names();
  stack->images.assign(stack->parts.size(), file);
}

// The width of the picture, mm, which `what` needs.
double WidthOf(const Manifest& manifest, const toml::table& table, const char* what) {
  const toml::table* plane = table["plane"].as_table();
  if (plane == nullptr || !plane->contains("width_mm")) {
    throw InputError(fmt::format("{}: {} need [plane] with width_mm, the width of the picture", manifest.name, what));
  }
  manifest.CheckKeys(*plane, {"width_mm"});
  return manifest.Number(*plane, "width_mm", 0, 1e-3, 1e6);
}

// The positions that the file of lights gave.
void ReadNear(const Manifest& manifest, const toml::table& table, const toml::table& lights, Stack* stack) {
  NearLights near;
  near.inverse_square = manifest.Word(lights, "falloff", {"inverse-square", "none"}) == 0;
  near.exponent = manifest.Number(lights, "exponent", 0, 0, 100);
  SetNear(near, WidthOf(manifest, table, "lights of kind \"position\""), manifest.name, stack);
}

// One place, or a file with one a photograph.
void ReadCamera(const Manifest& manifest, const toml::table& table, Stack* stack) {
  const toml::node* node = table.get("camera");
  if (node == nullptr) return;
  const toml::table* camera = node->as_table();
  if (camera == nullptr) manifest.Fail(node->source(), "'camera' must be a table: [camera]");
  manifest.CheckKeys(*camera, {"kind", "position", "file"}, "in [camera]");
  const bool placed = camera->contains("position") || camera->contains("file");
  const bool orthographic = manifest.Word(*camera, "kind", {"orthographic", "position"}) == 0;
  if (orthographic && placed && camera->contains("kind")) {
    manifest.Fail(node->source(), "an orthographic camera has no position; leave position and file out");
  }
  if (!placed) {
    if (!orthographic)
      manifest.Fail(node->source(), "kind = \"position\" needs position = [x, y, z] or file = \"...\"");
    return;
  }
  std::vector<Vec3> places;
  if (const toml::node* position = camera->get("position")) {
    if (camera->contains("file"))
      manifest.Fail(node->source(), "position and file say the same; leave one of them out");
    const toml::array* list = position->as_array();
    double at[3] = {kNan, kNan, kNan};
    for (std::size_t k = 0; list != nullptr && list->size() == 3 && k < 3; ++k) {
      if ((*list)[k].is_number()) at[k] = *(*list)[k].value<double>();
    }
    const Vec3 place = {at[0], at[1], at[2]};
    if (!std::isfinite(Norm(place))) manifest.Fail(position->source(), "position must be three numbers, mm");
    places.push_back(place);
  } else {
    const std::filesystem::path file = manifest.folder / manifest.Text(*camera, "file");
    for (const std::vector<double>& row : ReadTable(file, 3)) places.push_back({row[0], row[1], row[2]});
    if (places.size() != stack->images.size()) {
      throw InputError(fmt::format("{}: {} places of cameras for {} images; one an image is expected",
                                   PrintableName(file), places.size(), stack->images.size()));
    }
  }
  SetCameras(places, WidthOf(manifest, table, "cameras at a position"), manifest.name, stack);
}

void ReadLights(const Manifest& manifest, const toml::table& table, Stack* stack) {
  const toml::table* lights = table["lights"].as_table();
  if (lights == nullptr) throw InputError(manifest.name + ": a table [lights] with file = \"...\" is needed");
  manifest.CheckKeys(*lights, {"file", "intensity", "kind", "falloff", "exponent"});
  const bool near = manifest.Word(*lights, "kind", {"distant", "position"}) == 1;
  const std::string file = manifest.Text(*lights, "file");
  if (file.empty()) throw InputError(manifest.name + ": [lights] needs file = \"...\": a .lp, or x y z a line");
  const std::filesystem::path path = manifest.folder / file;
  if (path.extension() == ".lp") {
    StackFiles read = ReadLightFile(path);
    stack->lights = read.stack.lights;
    if (stack->images.empty()) stack->images = read.stack.images;
    ReadParts(read.stack.images, path.parent_path(), stack);
  } else {
    ReadParts({}, {}, stack);
    for (const std::vector<double>& row : ReadTable(path, 3)) {
      const std::string place = fmt::format("{}, light {}", PrintableName(path), stack->lights.size() + 1);
      stack->lights.push_back({LightDirection(row[0], row[1], row[2], place), {1, 1, 1}, {row[0], row[1], row[2]}});
    }
  }
  if (near) {
    ReadNear(manifest, table, *lights, stack);
  } else if (lights->contains("falloff") || lights->contains("exponent")) {
    throw InputError(manifest.name + ": [lights] falloff and exponent are for kind = \"position\"");
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
  const Manifest manifest = {{PrintableName(file)}, file.parent_path()};
  const FileBytes bytes(file);
  const toml::table table = manifest.Parse(bytes.bytes());
  manifest.CheckKeys(table, {"images", "mask", "encoding", "saturation", "black", "calibrated", "lights", "plane",
                             "dark", "white", "white_albedo", "camera"});
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "stack.toml";
  ReadImages(manifest, table, &stack);
  ReadLights(manifest, table, &stack);
  ReadCamera(manifest, table, &stack);
  const std::string encoding = manifest.Text(table, "encoding"), mask = manifest.Text(table, "mask");
  if (!encoding.empty()) ReadEncoding(encoding, manifest.name, &stack.response);
  stack.response.black = manifest.Number(table, "black", 0, 0, 0.9);
  stack.response.saturation = manifest.Number(table, "saturation", stack.response.saturation, 0.1, 1);
  if (const toml::node* node = table.get("calibrated")) {
    if (!node->is_boolean()) manifest.Fail(node->source(), "'calibrated' must be true or false");
    stack.calibrated = *node->value<bool>();
  }
  if (!mask.empty()) files.mask = manifest.folder / mask;
  const std::string dark = manifest.Text(table, "dark");
  if (!dark.empty()) stack.dark = manifest.folder / dark;
  ReadWhite(manifest, table, &stack);
  return files;
}

}  // namespace lobefit
