#include "lobefit/export/targets/sel/document.h"

#include <cmath>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/sel/glsl.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

// The table with its numbers in single precision, as shader text has them.
SelTable Single(SelTable table) {
  const auto round = [](double* value) { *value = static_cast<float>(*value); };
  for (SelSlice& slice : table.slices) {
    round(&slice.theta_i);
    round(&slice.phi_i);
    for (SelShape& shape : slice.lobes) {
      for (double* value : {&shape.alpha_x, &shape.alpha_y, &shape.offset_in, &shape.offset_across, &shape.psi}) {
        round(value);
      }
    }
    for (std::vector<double>& amplitude : slice.amplitude) {
      for (double& value : amplitude) round(&value);
    }
    for (double& constant : slice.constant) round(&constant);
  }
  return table;
}

}  // namespace

BrdfFunction SelBrdf(const SelTable& table) {
  const auto reflectance = std::make_shared<const SelReflectance>(table);
  return [reflectance](const Vec3& wi, const Vec3& wo, double* values) { reflectance->Evaluate(wi, wo, values); };
}

ErrorMeter SelErrorMeter(const Material& material) {
  // A lobe about the mirror direction is about that of GGX slopes of the same width; one for each lobe of the middle
  // slice.
  const SelTable& table = *material.sel;
  std::vector<SlopeCoordinates> shapes;
  for (const SelShape& lobe : table.slices[table.slices.size() / 2].lobes) {
    const double width = 0.5 * std::log(lobe.alpha_x * lobe.alpha_y);
    shapes.push_back({{0, 0, width, 0, width}});
  }
  return {SelBrdf(table), {material.channels, material.wavelengths_nm}, shapes, material.source.file};
}

std::vector<Carried> CarriesSel(const Material& material) {
  const std::string note = "the table itself";
  std::vector<Carried> rows = {{Feature::kLobes, Carries::kExactly, note},
                               {Feature::kInterpolation, Carries::kExactly, note}};
  if (material.sel->bound) rows.push_back({Feature::kBound, Carries::kExactly, note});
  rows.push_back({Feature::kChannels, Carries::kExactly, note});
  return rows;
}

WrittenFiles WriteSelJson(const Material& material, const WriteContext& context) {
  const std::filesystem::path path = context.File(".material.json");
  WriteMaterial(material, path);
  const Material back = ReadMaterial(path);
  return {{path}, SelBrdf(*back.sel), true, {}};
}

WrittenFiles WriteSelGlsl(const Material& material, const WriteContext& context) {
  const std::filesystem::path path = context.File(".glsl");
  WriteFileAtomically(path, SelGlslText(SelReflectance(*material.sel), {material.channels, material.wavelengths_nm},
                                        context.name, context.header));
  return {{path},
          SelBrdf(Single(*material.sel)),
          true,
          {"the error is that of the table in single precision; the shader's own rounding comes on top",
           "a compiler may spill the arrays of a large table: upload them as a buffer then"}};
}

}  // namespace lobefit
