// OpenPBR in MaterialX.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/materialx/nodes.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/metal_texel.h"
#include "lobefit/maps/textures/mtlx_images.h"
#include "lobefit/renderer/open_pbr.h"

namespace lobefit {
namespace {

// The dielectric's reflectance, one for all texels, which specular_weight scales: F0 is to be below it.
constexpr double kMostF0 = 0.9;
const double kRoot = std::sqrt(kMostF0), kIor = (1 + kRoot) / (1 - kRoot);

struct Numbers {
  BaseNumbers base;
  Color3 specular_color = {1, 1, 1};
  double weight = 0;
};

Numbers NumbersOf(const TexelNumbers& texel) {
  // The weight is that of the metal too: where it is one, the dielectric reflects what its index says.
  Numbers numbers = {BaseNumbersOf(texel, kMostF0)};
  const Color3& f0 = numbers.base.f0;
  const double largest = *std::max_element(f0.begin(), f0.end());
  numbers.weight = numbers.base.metalness > 0 ? 1 : std::min(1.0, largest / kMostF0);
  for (std::size_t c = 0; c < 3 && largest > 0; ++c) numbers.specular_color[c] = f0[c] / largest;
  return numbers;
}

enum Place : std::size_t { kBase, kParameters, kSpecular, kWeight, kNormal, kDirection };

std::vector<Texture> Textures(const MapNumbers& maps) {
  std::vector<Texture> textures = {
      ColorTexture("_openpbr_base_color.png", [](const TexelNumbers& texel) { return NumbersOf(texel).base.base; }),
      {"_openpbr_parameters.png", 3, 16, false,
       [](const TexelNumbers& texel) {
         const RoughnessPair pair = OpenPbrRoughness(texel.widths);
         return TextureValue{NumbersOf(texel).base.metalness, pair.roughness, pair.anisotropy, 1};
       }},
      ColorTexture("_openpbr_specular_color.png",
                   [](const TexelNumbers& texel) { return NumbersOf(texel).specular_color; }),
      GreyTexture("_openpbr_specular_weight.png", [](const TexelNumbers& texel) { return NumbersOf(texel).weight; }),
      NormalTexture(false)};
  if (IsAnisotropic(maps)) textures.push_back(DirectionTexture());
  return textures;
}

Surface Evaluated(const MapNumbers& maps, const std::vector<TextureValue>& read) {
  OpenPbr parameters;
  for (std::size_t c = 0; c < 3; ++c) {
    parameters.base_color[c] = read[kBase][c], parameters.specular_color[c] = read[kSpecular][c];
  }
  parameters.metalness = read[kParameters][0];
  parameters.roughness = {read[kParameters][1], read[kParameters][2]};
  // The weight scales the reflectance at normal incidence, which then gives the index.
  const double root = std::sqrt(read[kWeight][0]) * kRoot;
  parameters.ior = (1 + root) / (1 - root);
  parameters.normal = NormalOf(read[kNormal]);
  if (IsAnisotropic(maps)) parameters.rotation = RotationOf(read[kDirection]);
  return OpenPbrSurface(parameters);
}

std::filesystem::path Write(const MapNumbers& maps, const WriteContext& context) {
  const std::string id = Identifier(context.name);
  const auto image = [&](const char* name, const char* ending, const char* type) {
    return ImageNode(id + "_" + name, context.name + ending, type);
  };
  const bool anisotropic = IsAnisotropic(maps);
  const auto channel = [&](const char* input, const char* output) {
    return fmt::format("    <input name=\"{}\" type=\"float\" nodename=\"{}_split\" output=\"{}\"/>\n", input, id,
                       output);
  };
  const std::string nodes =
      MeshFrame() + image("base", "_openpbr_base_color.png", "color3") +
      image("parameters", "_openpbr_parameters.png", "vector3") +
      fmt::format(
          "  <separate3 name=\"{0}_split\" type=\"multioutput\">\n    <input name=\"in\" type=\"vector3\" "
          "nodename=\"{0}_parameters\"/>\n  </separate3>\n",
          id) +
      image("specular", "_openpbr_specular_color.png", "color3") +
      image("weight", "_openpbr_specular_weight.png", "float") + MapFrameNodes(id, context.name, anisotropic) +
      fmt::format(
          "  <open_pbr_surface name=\"{0}_surface\" type=\"surfaceshader\">\n"
          "    <input name=\"base_color\" type=\"color3\" nodename=\"{0}_base\"/>\n",
          id) +
      channel("base_metalness", "outx") +
      fmt::format(
          "    <input name=\"specular_weight\" type=\"float\" nodename=\"{0}_weight\"/>\n"
          "    <input name=\"specular_color\" type=\"color3\" nodename=\"{0}_specular\"/>\n",
          id) +
      channel("specular_roughness", "outy") + channel("specular_roughness_anisotropy", "outz") +
      fmt::format(
          "    <input name=\"specular_ior\" type=\"float\" value=\"{1}\"/>\n"
          "    <input name=\"geometry_normal\" type=\"vector3\" nodename=\"{0}_normal\"/>\n"
          "    <input name=\"geometry_tangent\" type=\"vector3\" nodename=\"{0}_tangent\"/>\n"
          "  </open_pbr_surface>\n",
          id, Number9(kIor)) +
      MaterialNode(id);
  const std::filesystem::path path = context.File(".openpbr.mtlx");
  WriteFileAtomically(path, MaterialXDocument(context, nodes));
  return path;
}

std::vector<Carried> CarriedRows(const MapNumbers& maps) {
  std::vector<Carried> rows = CommonRows(maps);
  Mark(&rows, Feature::kMasking, Carries::kApproximately, kMaterialXMasking);
  Mark(&rows, Feature::kFresnel, Carries::kApproximately,
       "a dielectric's with the same F0, a metal's where colour of metal and base agree");
  Mark(&rows, Feature::kDiffuse, Carries::kApproximately, "as the base under the specular layer, dimmed by it");
  return rows;
}

}  // namespace

MapTarget OpenPbrMaps() {
  return {"openpbr", Textures, Evaluated, Write, CarriedRows, "reference {name}.openpbr.mtlx, material {id}"};
}

}  // namespace lobefit
