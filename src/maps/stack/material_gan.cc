#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {
namespace {

using Json = nlohmann::json;

constexpr double kMmPerCm = 10;
constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 24;

struct CaptureFile {
  std::string name;
  Json json;

  [[noreturn]] void Fail(const std::string& message) const { throw InputError(name + ": " + message); }

  const Json& At(const char* key) const {
    const auto found = json.find(key);
    if (found == json.end()) Fail(fmt::format("'{}' is missing; MaterialGAN's captures have it", key));
    return *found;
  }
  static double Finite(const Json& value) { return value.is_number() ? value.get<double>() : kNan; }

  // Three numbers.
  Vec3 Triple(const Json& list, const std::string& where) const {
    double v[3] = {kNan, kNan, kNan};
    for (std::size_t k = 0; list.is_array() && list.size() == 3 && k < 3; ++k) v[k] = Finite(list[k]);
    const Vec3 triple = {v[0], v[1], v[2]};
    if (!std::isfinite(Norm(triple))) Fail(where + " must be three finite numbers");
    return triple;
  }
  std::vector<Vec3> Triples(const char* key) const {
    const Json& list = At(key);
    if (!list.is_array()) Fail(fmt::format("'{}' must be a list of [x, y, z], cm", key));
    std::vector<Vec3> triples;
    for (const Json& item : list) triples.push_back(Triple(item, fmt::format("{}[{}]", key, triples.size())));
    return triples;
  }
  // Numbers of the images.
  std::vector<std::size_t> Index(std::size_t images) const {
    std::vector<std::size_t> index;
    const auto found = json.find("idx");
    for (std::size_t i = 0; found == json.end() && i < images; ++i) index.push_back(i);
    if (found == json.end()) return index;
    for (std::size_t i = 0; found->is_array() && i < found->size(); ++i) {
      if (!(*found)[i].is_number_unsigned()) Fail(fmt::format("idx[{}] is no number of an image", i));
      index.push_back((*found)[i].get<std::size_t>());
    }
    if (index.size() != images) Fail(fmt::format("{} numbers in idx, but {} places of lights", index.size(), images));
    return index;
  }
};

}  // namespace

bool IsMaterialGan(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size > kMostBytes) return false;
  const FileBytes bytes(path);
  const Json json = Json::parse(bytes.bytes(), nullptr, false);
  return json.is_object() && json.contains("light_pos") && json.contains("im_size");
}

StackFiles ReadMaterialGan(const std::filesystem::path& path) {
  const FileBytes bytes(path);
  const CaptureFile file = {PrintableName(path), Json::parse(bytes.bytes(), nullptr, false)};
  if (!file.json.is_object()) file.Fail("is no JSON object, as a capture of MaterialGAN is");
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "MaterialGAN capture";
  const double width = kMmPerCm * CaptureFile::Finite(file.At("im_size"));
  if (!(width > 0) || !std::isfinite(width)) file.Fail("im_size must be a positive number, cm");
  const std::vector<Vec3> lights = file.Triples("light_pos");
  std::vector<Vec3> cameras = file.Triples("camera_pos");
  if (cameras.size() != lights.size()) {
    file.Fail(fmt::format("{} places of cameras, but {} of lights", cameras.size(), lights.size()));
  }
  for (Vec3& camera : cameras) camera = kMmPerCm * camera;
  for (const Vec3& light : lights) {
    const Vec3 place = kMmPerCm * light;
    const std::string where = fmt::format("{}, light_pos[{}]", file.name, stack.lights.size());
    stack.lights.push_back({LightDirection(place.x, place.y, place.z, where), {1, 1, 1}, place});
  }
  SetNear({}, width, file.name, &stack);
  SetCameras(cameras, width, file.name, &stack);
  // radiance = pow f cos / d^2 with d in cm; intensities here are those at the reference distance.
  const Vec3 power = file.Triple(file.At("light_pow"), "light_pow");
  const double reference = stack.near->reference_mm / kMmPerCm;
  if (!(std::min({power.x, power.y, power.z}) > 0)) file.Fail("light_pow must be positive");
  for (StackLight& light : stack.lights) {
    light.intensity = {power.x / (reference * reference), power.y / (reference * reference),
                       power.z / (reference * reference)};
  }
  const Json& target = file.At("target_dir");
  if (!target.is_string()) file.Fail("target_dir must be the name of a folder");
  const std::filesystem::path folder = path.parent_path() / target.get<std::string>();
  for (const std::size_t number : file.Index(lights.size())) {
    stack.images.push_back(folder / fmt::format("{:02}.png", number));
  }
  stack.calibrated = true;
  stack.response.curve = Response::Curve::kGamma, stack.response.gamma = 2.2;  // as the layout is defined
  return files;
}

}  // namespace lobefit
