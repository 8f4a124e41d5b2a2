#include "lobefit/maps/output/previews.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lobefit/base/files/file.h"
#include "lobefit/maps/output/pixels.h"

namespace lobefit {
namespace {

double Srgb(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

// 99th percentile of what is finite; 1 where nothing is.
double White(const Maps& maps) {
  std::vector<float> values;
  for (const std::vector<float>& plane : maps.rows.values) {
    std::copy_if(plane.begin(), plane.end(), std::back_inserter(values), [](float v) { return std::isfinite(v); });
  }
  if (values.empty()) return 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at > 0 ? static_cast<double>(*at) : 1;
}

// The planes of `part` whose names begin with `head`.
Maps Chosen(const std::filesystem::path& path, MapPart part, const std::string& head) {
  return ReadMapsExr(path, [&](const MapPlane& plane) { return plane.part == part && plane.name.rfind(head, 0) == 0; });
}

// Its planes as pixels of `bits`; `curve` maps a value of channel c to 0..1.
template <class Curve>
std::string Picture(const Maps& maps, int bits, const Curve& curve) {
  std::vector<const std::vector<float>*> planes;
  for (const std::vector<float>& plane : maps.rows.values) {
    if (!plane.empty()) planes.push_back(&plane);
  }
  const std::size_t texels = maps.rows.rows * maps.rows.width;
  std::vector<std::uint16_t> pixels;
  pixels.reserve(texels * planes.size());
  for (std::size_t t = 0; t < texels; ++t) {
    for (std::size_t c = 0; c < planes.size(); ++c) {
      const double v = std::clamp(curve(static_cast<double>((*planes[c])[t]), c), 0.0, 1.0);
      pixels.push_back(static_cast<std::uint16_t>(std::lround(v * ((1 << bits) - 1))));
    }
  }
  return EncodePixels(pixels, maps.rows.width, maps.rows.rows, static_cast<int>(planes.size()), bits);
}

}  // namespace

std::vector<std::filesystem::path> WritePreviews(const std::filesystem::path& maps, bool calibrated, NormalY normal_y,
                                                 const std::filesystem::path& stem) {
  std::vector<std::filesystem::path> written;
  const auto write = [&](const char* kind, const std::string& bytes) {
    written.push_back(stem.string() + "." + kind + ".png");
    WriteFileAtomically(written.back(), bytes);
  };
  const Maps normals = Chosen(maps, MapPart::kParameters, "normal.");
  write("normal", Picture(normals, 16, [&](double v, std::size_t axis) {
          if (std::isnan(v)) return axis == 2 ? 1.0 : 0.5;
          return ((axis == 1 && normal_y == NormalY::kDown ? -v : v) + 1) / 2;
        }));
  for (const char* kind : {"diffuse", "f0"}) {
    if (normals.lobe == MapLobe::kNone && std::string(kind) == "f0") continue;
    const Maps colors = Chosen(maps, MapPart::kParameters, std::string(kind) + ".");
    const double white = calibrated ? 1 : White(colors);
    write(kind, Picture(colors, 8, [&](double v, std::size_t) { return std::isnan(v) ? 0 : Srgb(v / white); }));
  }
  if (normals.lobe != MapLobe::kNone) {
    const char* name = WidestAlpha(normals.lobe);
    write("alpha", Picture(Chosen(maps, MapPart::kParameters, name), 8,
                           [](double v, std::size_t) { return std::isnan(v) ? 0 : v; }));
  }
  write("normal_error", Picture(Chosen(maps, MapPart::kErrors, "normal.angle_deg"), 8,
                                [](double v, std::size_t) { return std::isnan(v) ? 1 : v / 10; }));
  return written;
}

}  // namespace lobefit
