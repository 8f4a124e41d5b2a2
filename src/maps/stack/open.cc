#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/layouts.h"
#include "lobefit/maps/stack/reader.h"

namespace lobefit {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t kFewestLights = 4, kMostLights = 4096;

bool IsLightFile(const Path& path) {
  return path.extension() == ".lp" || path.extension() == ".dome" ||
         (path.extension() == ".json" && IsMaterialGan(path));
}

StackFiles ReadLayout(const Path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(PrintableName(path) + ": is not there");
  if (!std::filesystem::is_directory(path, error)) {
    if (path.extension() == ".dome") return ReadDome(path);
    if (path.extension() == ".json") return ReadMaterialGan(path);
    return path.extension() == ".toml" ? ReadManifest(path) : ReadLightFile(path);
  }
  if (std::filesystem::exists(path / "stack.toml", error)) return ReadManifest(path / "stack.toml");
  if (std::filesystem::exists(path / "filenames.txt", error)) return ReadDiligent(path);
  std::vector<Path> light_files;
  for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
    if (IsLightFile(entry.path())) light_files.push_back(entry.path());
  }
  if (light_files.size() == 1) return ReadLayout(light_files[0]);
  if (light_files.size() > 1) {
    throw InputError(
        fmt::format("{}: {} light files (.lp, .dome, .json) are in this folder; name the one that is meant",
                    PrintableName(path), light_files.size()));
  }
  if (HasAngleNames(path)) return ReadAngleNames(path);
  throw InputError(
      PrintableName(path) +
      ": no image stack: a stack.toml, DiLiGenT's filenames.txt, a light file (.lp, .dome, MaterialGAN's .json) or "
      "images named by angles (tl045 pl090 tv000 pv000.png) are looked for in the folder");
}

void ReadMask(const Path& file, Stack* stack) {
  const std::unique_ptr<ImageRows> rows = OpenImage(file);
  if (rows->width() != stack->width || rows->height() != stack->height) {
    throw InputError(fmt::format("{}: the mask is {} x {} pixels, the images are {} x {}; they must agree",
                                 PrintableName(file), rows->width(), rows->height(), stack->width, stack->height));
  }
  std::vector<float> row(rows->width() * rows->channels());
  stack->mask.reserve(stack->width * stack->height);
  for (std::size_t y = 0; y < stack->height; ++y) {
    rows->Next(row.data());
    for (std::size_t x = 0; x < stack->width; ++x) stack->mask.push_back(row[x * rows->channels()] > 0.5F ? 1 : 0);
  }
  if (stack->Texels() == 0) throw InputError(PrintableName(file) + ": the mask leaves no texel");
}

std::string NameOf(const Stack& stack, std::size_t image) {
  const std::string file = PrintableName(stack.images[image]);
  return stack.parts.empty() ? file : fmt::format("{}, part '{}'", file, Excerpt(stack.parts[image]));
}

void CheckImages(const StackOptions& options, Stack* stack) {
  int bits = 0;
  std::vector<Path> others = stack->white;
  if (!stack->dark.empty()) others.push_back(stack->dark);
  StackImages images(*stack);
  for (std::size_t i = 0; i < stack->images.size() + others.size(); ++i) {
    const bool is_own = i < stack->images.size();
    const std::unique_ptr<ImageRows> image = is_own ? images.Open(i) : OpenImage(others[i - stack->images.size()]);
    if (stack->width == 0) {
      stack->width = image->width(), stack->height = image->height(), stack->channels = image->channels();
      bits = image->bits();
    }
    if (image->width() != stack->width || image->height() != stack->height || image->channels() != stack->channels) {
      throw InputError(fmt::format("{}: {} x {} pixels, {} channels, but {} has {} x {} and {}; all must agree",
                                   is_own ? NameOf(*stack, i) : PrintableName(others[i - stack->images.size()]),
                                   image->width(), image->height(), image->channels(), NameOf(*stack, 0), stack->width,
                                   stack->height, stack->channels));
    }
    bits = std::min(bits, image->bits());
  }
  if (!options.encoding.empty()) ReadEncoding(options.encoding, "--encoding", &stack->response);
  if (stack->response.curve != Response::Curve::kUnknown) return;
  if (bits <= 8) {
    throw InputError(fmt::format(
        "{}: {} bits a channel, whose encoding is not said; say --encoding srgb (as cameras write), linear or gamma:G, "
        "or `encoding` in a stack.toml",
        PrintableName(stack->images[0]), bits));
  }
  stack->response.curve = Response::Curve::kLinear;
  stack->remarks.emplace_back(
      fmt::format("{} bits a channel are taken as linear; say --encoding where they are not", bits));
}

void CheckLights(const Stack& stack) {
  const std::size_t count = stack.images.size();
  if (count != stack.lights.size()) {
    throw InputError(fmt::format("{}: {} images, but {} lights; one light an image is expected",
                                 PrintableName(stack.path), count, stack.lights.size()));
  }
  if (count < kFewestLights || count > kMostLights) {
    throw InputError(fmt::format("{}: {} images; {} to {} are expected", PrintableName(stack.path), count,
                                 kFewestLights, kMostLights));
  }
  std::size_t below = 0;
  for (const StackLight& light : stack.lights) below += light.direction.z <= 0 ? 1 : 0;
  if (2 * below > count) {
    throw InputError(fmt::format(
        "{}: {} of {} lights are behind the surface (z <= 0); z must point to the camera: change the sign of z",
        PrintableName(stack.path), below, count));
  }
}

// Of the one file of a stack, which may be larger than the memory.
std::string DigestOfPieces(const Path& path) {
  std::ifstream in(path, std::ios::binary);
  std::string digests, piece(std::size_t{1} << 24, '\0');
  do {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    digests += Sha256(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
  } while (in);
  if (!in.eof()) throw InputError(PrintableName(path) + ": cannot be read to its end");
  return Sha256(digests);
}

}  // namespace

std::size_t Stack::Texels() const {
  if (mask.empty()) return width * height;
  return static_cast<std::size_t>(std::count_if(mask.begin(), mask.end(), [](std::uint8_t m) { return m != 0; }));
}

bool LooksLikeStack(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return IsLightFile(path) || path.filename() == "stack.toml";
  if (std::filesystem::exists(path / "stack.toml", error) || std::filesystem::exists(path / "filenames.txt", error))
    return true;
  for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
    if (IsLightFile(entry.path())) return true;
  }
  return HasAngleNames(path);
}

Stack OpenStack(const std::filesystem::path& path, const StackOptions& options) {
  StackFiles files = ReadLayout(path);
  Stack& stack = files.stack;
  stack.path = path;
  CheckLights(stack);
  CheckImages(options, &stack);
  if (!files.mask.empty()) ReadMask(files.mask, &stack);
  std::size_t below = 0;
  for (const StackLight& light : stack.lights) below += light.direction.z <= 0 ? 1 : 0;
  if (below > 0) stack.remarks.emplace_back(fmt::format("{} lights are behind a surface that faces the camera", below));
  return std::move(files.stack);
}

std::string DigestOf(const Stack& stack) {
  std::string all =
      fmt::format("{} {} {} {} {} {} {};", stack.width, stack.height, stack.channels, EncodingWord(stack.response),
                  stack.response.black, stack.response.saturation, stack.calibrated);
  for (const StackLight& light : stack.lights) {
    all += fmt::format("{} {} {} {} {} {};", light.direction.x, light.direction.y, light.direction.z,
                       light.intensity[0], light.intensity[1], light.intensity[2]);
  }
  if (stack.near) {
    const NearLights& near = *stack.near;
    all += fmt::format("near {} {} {} {};", stack.width_mm, near.inverse_square, near.reference_mm, near.exponent);
    for (const StackLight& light : stack.lights) {
      all += fmt::format("{} {} {};", light.place.x, light.place.y, light.place.z);
    }
  }
  for (const Vec3& camera : stack.cameras) {
    all += fmt::format("camera {} {} {} {};", stack.width_mm, camera.x, camera.y, camera.z);
  }
  if (!stack.normal_map.empty()) {
    all += fmt::format("normals {} {};", stack.normal_map_down, Sha256(FileBytes(stack.normal_map).bytes()));
  }
  all.append(stack.mask.begin(), stack.mask.end());
  for (const std::string& part : stack.parts) all += fmt::format("part {} {};", part.size(), part);
  if (!stack.parts.empty()) {
    all += DigestOfPieces(stack.images[0]);
  } else {
    for (const std::filesystem::path& image : stack.images) all += Sha256(FileBytes(image).bytes());
  }
  if (!stack.dark.empty()) all += "dark" + Sha256(FileBytes(stack.dark).bytes());
  for (const std::filesystem::path& image : stack.white) all += "white" + Sha256(FileBytes(image).bytes());
  if (!stack.white.empty()) all += fmt::format("{}", stack.white_albedo);
  return Sha256Hex(all);
}

}  // namespace lobefit
