#include "lobefit/maps/stack/normal_map.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

// Shorter, a picture's value is no normal; lower, it does not face the camera.
constexpr double kShortest = 0.5, kLowest = 0.02;

}  // namespace

void SetNormalMap(const std::filesystem::path& file, bool down, Stack* stack) {
  stack->normal_map = file, stack->normal_map_down = down;
  OpenNormalMap(*stack);
}

std::unique_ptr<ImageRows> OpenNormalMap(const Stack& stack) {
  std::unique_ptr<ImageRows> rows = OpenImage(stack.normal_map);
  const std::string name = PrintableName(stack.normal_map);
  if (rows->width() != stack.width || rows->height() != stack.height) {
    throw InputError(fmt::format("{}: the map of normals is {} x {} pixels, the images are {} x {}; they must agree",
                                 name, rows->width(), rows->height(), stack.width, stack.height));
  }
  if (rows->channels() != 3) throw InputError(name + ": a map of normals has red, green and blue; this one is gray");
  if (rows->bits() < 16) {
    throw InputError(fmt::format(
        "{}: normals in {} bits a channel are rounded by half a degree; give them in 16 bits (PNG) or as OpenEXR", name,
        rows->bits()));
  }
  return rows;
}

void ReadNormals(ImageRows* rows, bool down, std::vector<Vec3>* normals) {
  std::vector<float> row(3 * rows->width());
  rows->Next(row.data());
  const bool integer = rows->bits() <= 16;
  for (std::size_t x = 0; x < rows->width(); ++x) {
    double v[3];
    for (std::size_t c = 0; c < 3; ++c) {
      v[c] = static_cast<double>(row[3 * x + c]);
      if (integer) v[c] = 2 * v[c] - 1;
    }
    const Vec3 n = {v[0], down ? -v[1] : v[1], v[2]};
    const double length = Norm(n);
    const bool known = length >= kShortest && std::isfinite(length) && n.z > kLowest * length;
    normals->push_back(known ? (1 / length) * n : Vec3{kNan, kNan, kNan});
  }
}

}  // namespace lobefit
