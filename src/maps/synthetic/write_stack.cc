#include "lobefit/maps/synthetic/write_stack.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/process/progress.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/output/pixels.h"
#include "lobefit/maps/stack/geometry.h"
#include "lobefit/synthesis/random.h"

namespace lobefit {
namespace {

constexpr double kWidthMm = 100;

// What OpenStack will make of the files: where the lights are.
Stack GeometryOf(const Maps& maps, const StackSynthesis& synthesis) {
  Stack stack;
  stack.width = maps.rows.width, stack.height = maps.rows.rows;
  for (const Vec3& w : synthesis.lights) stack.lights.push_back({w, {1, 1, 1}, synthesis.distance * kWidthMm * w});
  if (synthesis.distance > 0) stack.near = NearLights{true, synthesis.distance * kWidthMm, 0};
  if (synthesis.camera_distance > 0) stack.cameras = {{0, 0, synthesis.camera_distance * kWidthMm}};
  stack.width_mm = kWidthMm;
  return stack;
}

// One photograph: f_r cos_theta_i times the irradiance, [texel channels + channel]; NaN of texels without a normal
// becomes 0.
std::vector<float> Photograph(const Maps& maps, const StackSynthesis& synthesis, std::size_t light) {
  const std::size_t channels = static_cast<std::size_t>(maps.channels), texels = maps.rows.rows * maps.rows.width;
  Relighting relighting(maps, {{synthesis.lights[light]}, {}}, synthesis.calibrated, synthesis.fallback);
  const Stack geometry = GeometryOf(maps, synthesis);
  RandomNumbers random(StreamSeed(synthesis.seed, light));
  LightPaths paths;
  std::vector<float> image(texels * channels);
  for (std::size_t t = 0; t < texels; ++t) {
    double values[kMostChannels];
    PathsAt(geometry, {light}, t, &paths);
    const Vec3 direction = paths.wi[0];
    if (geometry.MovesPaths()) relighting.Move(paths);
    relighting.Texel(t, values, 1);
    const double irradiance = IrradianceAt(geometry, light, t);
    const bool dark = synthesis.shadow && synthesis.shadow(t, direction);
    for (std::size_t c = 0; c < channels; ++c) {
      double value = dark || std::isnan(values[c]) ? 0 : irradiance * values[c];
      if (synthesis.noise.multiplicative > 0) value *= 1 + synthesis.noise.multiplicative * random.Normal();
      if (synthesis.noise.additive > 0) value += synthesis.noise.additive * random.Normal();
      image[t * channels + c] = static_cast<float>(value);
    }
  }
  return image;
}

std::string EncodeSixteen(const std::vector<float>& image, double intensity, std::size_t width, std::size_t height,
                          std::size_t channels) {
  std::vector<std::uint16_t> pixels;
  pixels.reserve(image.size());
  for (const float value : image) {
    const double stored = std::clamp(static_cast<double>(value) * intensity, 0.0, 1.0);
    pixels.push_back(static_cast<std::uint16_t>(std::lround(65535 * stored)));
  }
  return EncodePixels(pixels, width, height, static_cast<int>(channels), 16);
}

}  // namespace

std::vector<Vec3> DomeLights(std::size_t count, double theta_max) {
  // Fibonacci's lattice: equal areas, turned by the golden angle each.
  std::vector<Vec3> lights;
  const double golden = kPi * (3 - std::sqrt(5.0)), n = static_cast<double>(count);
  for (std::size_t l = 0; l < count; ++l) {
    const double z = 1 - (1 - std::cos(theta_max)) * (static_cast<double>(l) + 0.5) / n;
    const double r = std::sqrt(1 - z * z), phi = golden * static_cast<double>(l);
    lights.push_back({r * std::cos(phi), r * std::sin(phi), z});
  }
  return lights;
}

void WriteStack(const Maps& maps, const StackSynthesis& synthesis, const std::filesystem::path& folder) {
  Noise other = synthesis.noise;
  other.multiplicative = other.additive = 0;
  if (!(other == Noise{})) {
    throw UsageError("--noise '" + ToText(other) + "': a stack has the terms multiplicative and additive");
  }
  MakeFolder(folder);
  const std::size_t width = maps.rows.width, height = maps.rows.rows,
                    channels = static_cast<std::size_t>(maps.channels);
  const bool exr = synthesis.bits == 32;
  std::string lp = fmt::format("{}\n", synthesis.lights.size()), intensities;
  // One exposure for all images, as a camera with fixed settings has.
  double most = 0;
  Progress progress("photographing", synthesis.lights.size() * (exr ? 1 : 2));
  for (std::size_t l = 0; !exr && l < synthesis.lights.size(); ++l) {
    for (const float value : Photograph(maps, synthesis, l)) most = std::max(most, static_cast<double>(value));
    progress.Advance();
  }
  const double intensity = exr ? 1 : std::exp2(std::floor(std::log2(0.98 / most)));
  for (std::size_t l = 0; l < synthesis.lights.size(); ++l) {
    const std::string name = fmt::format("{:03}.{}", l + 1, exr ? "exr" : "png");
    const Vec3 w = synthesis.distance > 0 ? synthesis.distance * kWidthMm * synthesis.lights[l] : synthesis.lights[l];
    lp += fmt::format("{} {} {} {}\n", name, FormatDouble(w.x), FormatDouble(w.y), FormatDouble(w.z));
    intensities += fmt::format("{0} {0} {0}\n", FormatDouble(intensity));
    const std::vector<float> image = Photograph(maps, synthesis, l);
    progress.Advance();
    WriteFileAtomically(folder / name, exr ? EncodeExr(image, width, height, channels)
                                           : EncodeSixteen(image, intensity, width, height, channels));
  }
  WriteFileAtomically(folder / "lights.lp", lp);
  WriteFileAtomically(folder / "intensity.txt", intensities);
  WriteMapsExr(
      maps.planes, width, height,
      [&](std::size_t first, std::size_t end) {
        MapRows rows = {first, end - first, width, {}};
        for (const std::vector<float>& plane : maps.rows.values) {
          rows.values.emplace_back(plane.begin() + static_cast<std::ptrdiff_t>(first * width),
                                   plane.begin() + static_cast<std::ptrdiff_t>(end * width));
        }
        return rows;
      },
      folder / "truth.maps.exr");
  std::string manifest = fmt::format(
      "# Synthetic: the truth is truth.maps.exr; noise: {}\nencoding = \"linear\"\ncalibrated = {}\n\n[lights]\nfile = "
      "\"lights.lp\"\nintensity = \"intensity.txt\"\n",
      synthesis.noise == Noise{} ? "none" : ToText(synthesis.noise), synthesis.calibrated);
  if (synthesis.distance > 0) manifest += "kind = \"position\"\n";
  if (synthesis.camera_distance > 0) {
    manifest += fmt::format("\n[camera]\nposition = [0, 0, {}]\n", FormatDouble(synthesis.camera_distance * kWidthMm));
  }
  if (GeometryOf(maps, synthesis).MovesPaths()) {
    manifest += fmt::format("\n[plane]\nwidth_mm = {}\n", FormatDouble(kWidthMm));
  }
  // Last: a folder with it is whole.
  WriteFileAtomically(folder / "stack.toml", manifest);
}

}  // namespace lobefit
