#include "lobefit/export/targets/merl/read.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include "lobefit/io/merl/table.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr MerlDims kHalfTurn = {90, 90, 180}, kWholeTurn = {90, 90, 360};

MerlDims DimsOf(std::string_view bytes) {
  MerlDims dims = {};
  if (bytes.size() >= sizeof(dims)) std::memcpy(&dims, bytes.data(), sizeof(dims));
  return dims;
}

bool Has(std::string_view bytes, const MerlDims& wanted) {
  const MerlDims dims = DimsOf(bytes);
  return bytes.size() == MerlBytes(wanted) && dims.theta_h == wanted.theta_h && dims.theta_d == wanted.theta_d &&
         dims.phi_d == wanted.phi_d;
}

}  // namespace

bool IsMerlTable(std::string_view bytes) { return Has(bytes, kHalfTurn) || Has(bytes, kWholeTurn); }

ImportedMaterial ReadMerlLookup(const InputFile& file) {
  const MerlDims dims = DimsOf(file.bytes);
  const std::size_t cells = dims.cells();
  const double turn = dims.phi_d == kWholeTurn.phi_d ? 2 * kPi : kPi;
  auto stored = std::make_shared<std::vector<double>>(3 * cells);
  std::memcpy(stored->data(), file.bytes.data() + sizeof(dims), 3 * cells * sizeof(double));
  const auto brdf = [stored, dims, cells, turn](const Vec3& wi, const Vec3& wo, double* values) {
    std::fill_n(values, 3, 0.0);
    if (wi.z <= 0 || wo.z <= 0) return;
    const HalfDifference angles = ToHalfDifference(wi, wo);
    const auto cell = [](double position, int count) {
      return static_cast<std::size_t>(std::clamp(std::floor(position * count), 0.0, count - 1.0));
    };
    const double phi_d = angles.phi_d < 0 ? angles.phi_d + turn : angles.phi_d;
    const std::size_t theta_h = cell(std::sqrt(angles.theta_h / (kPi / 2)), dims.theta_h),
                      theta_d = cell(angles.theta_d / (kPi / 2), dims.theta_d);
    const std::size_t index =
        cell(phi_d / turn, dims.phi_d) +
        static_cast<std::size_t>(dims.phi_d) * (theta_d + static_cast<std::size_t>(dims.theta_d) * theta_h);
    std::array<double, 3> found = {};
    for (std::size_t c = 0; c < 3; ++c) {
      found[c] = (*stored)[index + c * cells] * kMerlScale[c];
      if (found[c] < 0) return;
    }
    std::copy(found.begin(), found.end(), values);
  };
  ImportedMaterial result = {"merl", {{"R", "G", "B"}, {}}, brdf, {"each value is that of the nearest cell"}};
  if (turn > kPi) result.remarks.emplace_back("the table has the whole turn of phi_d: it need not be reciprocal");
  return result;
}

}  // namespace lobefit
