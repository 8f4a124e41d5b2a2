#include "lobefit/export/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/core/brdf/brdf.h"
#include "lobefit/export/targets/gltf/write.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/export/targets/mitsuba/write.h"
#include "lobefit/export/targets/pbrt/write.h"
#include "lobefit/export/targets/sel/document.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/io/merl/table.h"
#include "lobefit/io/rgl/brdf.h"
#include "lobefit/material/json.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

ImportedMaterial ImportRgl(const std::filesystem::path& path, std::string_view bytes) {
  const auto table = std::make_shared<const RglBrdf>(path, bytes);
  return {"rgl",
          table->channels(),
          [table](const Vec3& wi, const Vec3& wo, double* values) { table->Evaluate(wi, wo, values); },
          {}};
}

// The lookup of the database's own reader: the cell that holds the angles. A negative channel makes the sample black.
ImportedMaterial ImportMerl(std::string_view bytes) {
  constexpr std::size_t kCells = 90 * 90 * 180;
  auto stored = std::make_shared<std::vector<double>>(3 * kCells);
  std::memcpy(stored->data(), bytes.data() + 12, 3 * kCells * sizeof(double));
  const auto brdf = [stored](const Vec3& wi, const Vec3& wo, double* values) {
    std::fill_n(values, 3, 0.0);
    if (wi.z <= 0 || wo.z <= 0) return;
    const HalfDifference angles = ToHalfDifference(wi, wo);
    const auto cell = [](double position, double count) {
      return static_cast<std::size_t>(std::clamp(std::floor(position * count), 0.0, count - 1));
    };
    const double phi_d = angles.phi_d < 0 ? angles.phi_d + kPi : angles.phi_d;
    const std::size_t index = cell(phi_d / kPi, 180) + 180 * (cell(angles.theta_d / (kPi / 2), 90) +
                                                              90 * cell(std::sqrt(angles.theta_h / (kPi / 2)), 90));
    std::array<double, 3> found = {};
    for (std::size_t c = 0; c < 3; ++c) {
      found[c] = (*stored)[index + c * kCells] * kMerlScale[c];
      if (found[c] < 0) return;
    }
    std::copy(found.begin(), found.end(), values);
  };
  return {"merl", {{"R", "G", "B"}, {}}, brdf, {"each value is that of the nearest cell"}};
}

ImportedMaterial ImportDocument(const std::filesystem::path& path) {
  const Material material = ReadMaterial(path);
  if (material.sel) return {"json", {material.channels, material.wavelengths_nm}, SelBrdf(*material.sel), {}};
  const auto reflectance =
      std::make_shared<const Reflectance>(material.model, material.Values(), material.channels.size());
  return {"json",
          {material.channels, material.wavelengths_nm},
          [reflectance](const Vec3& wi, const Vec3& wo, double* values) { reflectance->Evaluate(wi, wo, values); },
          {}};
}

ImportedMaterial FromSurface(const char* format, const Surface& surface, std::vector<std::string> remarks) {
  return {format, {{"R", "G", "B"}, {}}, SurfaceBrdf(surface), std::move(remarks)};
}

std::vector<std::string> MeshRemarks(std::string_view bytes) {
  const double rotation = RotationOfComment(bytes);
  if (rotation == 0) return {};
  return {"the texture coordinates of the mesh are turned as the file's comment says"};
}

bool IsMerl(std::string_view bytes) {
  if (bytes.size() != MerlBytes({90, 90, 180})) return false;
  std::array<std::int32_t, 3> dims = {};
  std::memcpy(dims.data(), bytes.data(), sizeof(dims));
  return dims == std::array<std::int32_t, 3>{90, 90, 180};
}

}  // namespace

ImportedMaterial ImportMaterial(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string_view bytes = file.bytes();
  if (bytes.starts_with("tensor_file")) return ImportRgl(path, bytes);
  if (IsMerl(bytes)) return ImportMerl(bytes);
  const std::string_view text = Trim(bytes);
  if (text.starts_with("{")) {
    if (text.find("\"pbrMetallicRoughness\"") == std::string_view::npos) return ImportDocument(path);
    return FromSurface("gltf", GltfSurface(ReadGltf(bytes, path)), {});
  }
  if (text.starts_with("<")) {
    if (text.find("<materialx") == std::string_view::npos) {
      return FromSurface("mitsuba", ReadMitsuba(bytes, path), MeshRemarks(bytes));
    }
    const MaterialXDocument document = ReadMaterialX(bytes, path);
    return FromSurface(document.open_pbr ? "openpbr" : "materialx", document.surface,
                       {"evaluated as MaterialX' GLSL does"});
  }
  if (text.find("Material \"") != std::string_view::npos) {
    return FromSurface("pbrt", ReadPbrt(bytes, path), MeshRemarks(bytes));
  }
  throw InputError(path.string() +
                   ": no material that can be read; allowed are materials of pbrt-v4 (.pbrt), Mitsuba 3 (.xml), "
                   "MaterialX (.mtlx) and glTF (.gltf), RGL tables (.bsdf), MERL tables (.binary) and material "
                   "documents (.json)");
}

}  // namespace lobefit
