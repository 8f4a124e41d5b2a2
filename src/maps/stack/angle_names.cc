#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/layouts.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr std::array<const char*, 4> kKeys = {"tl", "pl", "tv", "pv"};

// The number behind each of tl, pl, tv, pv in a name, degrees; nothing where one is missing.
std::optional<std::array<double, 4>> AnglesOf(const std::string& name) {
  std::array<double, 4> angles = {};
  for (std::size_t k = 0; k < kKeys.size(); ++k) {
    std::size_t at = name.find(kKeys[k]);
    const auto is_digit = [&](std::size_t i) {
      return i < name.size() && std::isdigit(static_cast<unsigned char>(name[i])) != 0;
    };
    while (at != std::string::npos && !is_digit(at + 2)) at = name.find(kKeys[k], at + 1);
    if (at == std::string::npos) return std::nullopt;
    std::size_t end = at + 2;
    while (is_digit(end) || (name[end] == '.' && is_digit(end + 1))) ++end;
    const std::optional<double> value = ParseDouble(std::string_view(name).substr(at + 2, end - at - 2));
    if (!value) return std::nullopt;
    angles[k] = *value;
  }
  return angles;
}

}  // namespace

bool HasAngleNames(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (IsImageName(entry.path()) && AnglesOf(entry.path().stem().string())) return true;
  }
  return false;
}

StackFiles ReadAngleNames(const std::filesystem::path& folder) {
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "folder of tl pl tv pv names";
  std::vector<std::filesystem::path> images;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (IsImageName(entry.path())) images.push_back(entry.path());
  }
  std::sort(images.begin(), images.end());
  std::size_t slanted = 0, other = 0;
  for (const std::filesystem::path& image : images) {
    const std::optional<std::array<double, 4>> angles = AnglesOf(image.stem().string());
    if (!angles) {
      ++other;
      continue;
    }
    const auto& [theta, phi, view, turn] = *angles;
    if (!(theta <= 90) || !(view <= 90)) {
      throw InputError(
          fmt::format("{}: polar angles {} and {} are not within 0 and 90 degrees", PrintableName(image), theta, view));
    }
    if (view != 0) {
      ++slanted;
      continue;
    }
    const Vec3 direction = FromSpherical(theta * kPi / 180, phi * kPi / 180);
    stack.images.push_back(image);
    stack.lights.push_back({direction, {1, 1, 1}, direction});
  }
  if (stack.images.empty()) {
    throw InputError(
        fmt::format("{}: none of {} photographs is seen from above (tv000); the camera of a stack faces the "
                    "surface",
                    PrintableName(folder), slanted));
  }
  if (slanted > 0) stack.remarks.emplace_back(fmt::format("{} photographs of slanted views are left out", slanted));
  if (other > 0) stack.remarks.emplace_back(fmt::format("{} images whose names hold no angles are left out", other));
  return files;
}

}  // namespace lobefit
