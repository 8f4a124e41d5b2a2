// MaterialX: BSDF nodes that hold the fit's own numbers.
#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/materialx/nodes.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/mtlx_images.h"

namespace lobefit {
namespace {

enum Place : std::size_t { kDiffuse, kNormal, kF0, kLobe, kAlpha1, kAlpha2, kDirection };

std::vector<Texture> Textures(const MapNumbers& maps) {
  std::vector<Texture> textures = {
      ColorTexture("_diffuse.png", [](const TexelNumbers& texel) { return texel.diffuse; }), NormalTexture(false)};
  if (!HasLobes(maps)) return textures;
  textures.push_back(ColorTexture("_f0.png", [](const TexelNumbers& texel) { return texel.f0; }));
  textures.push_back(GreyTexture("_lobe.png", [](const TexelNumbers& texel) { return texel.lobe ? 1.0 : 0.0; }));
  const auto alpha_1 = [](const TexelNumbers& texel) { return texel.widths.alpha_1; };
  if (!IsAnisotropic(maps)) {
    textures.push_back(GreyTexture("_alpha.png", alpha_1));
    return textures;
  }
  textures.push_back(GreyTexture("_alpha_x.png", alpha_1));
  textures.push_back(GreyTexture("_alpha_y.png", [](const TexelNumbers& texel) { return texel.widths.alpha_2; }));
  textures.push_back(DirectionTexture());
  return textures;
}

Surface Evaluated(const MapNumbers& maps, const std::vector<TextureValue>& read) {
  Surface surface;
  surface.masking = SurfaceMasking::kMeanAlpha;
  surface.energy_compensation = true;
  surface.diffuse = ColorOf(read[kDiffuse]);
  surface.diffuse_normal = NormalOf(read[kNormal]);
  if (!HasLobes(maps) || read[kLobe][0] == 0) return surface;
  SurfaceLobe lobe;
  lobe.normal = surface.diffuse_normal;
  lobe.fresnel.f0 = ColorOf(read[kF0]);
  if (!maps.schlick()) lobe.fresnel.f90 = lobe.fresnel.f0;
  lobe.widths = {read[kAlpha1][0], read[IsAnisotropic(maps) ? kAlpha2 : kAlpha1][0]};
  if (IsAnisotropic(maps)) lobe.rotation = RotationOf(read[kDirection]);
  surface.lobes.push_back(lobe);
  return surface;
}

std::string LobeNodes(const MapNumbers& maps, const std::string& id, const std::string& name) {
  const bool anisotropic = IsAnisotropic(maps);
  std::string text = ImageNode(id + "_f0", name + "_f0.png", "color3") +
                     ImageNode(id + "_weight", name + "_lobe.png", "float") +
                     ImageNode(id + "_alpha_x", name + (anisotropic ? "_alpha_x.png" : "_alpha.png"), "float");
  if (anisotropic) text += ImageNode(id + "_alpha_y", name + "_alpha_y.png", "float");
  return text +
         fmt::format(
             "  <combine2 name=\"{0}_widths\" type=\"vector2\">\n"
             "    <input name=\"in1\" type=\"float\" nodename=\"{0}_alpha_x\"/>\n"
             "    <input name=\"in2\" type=\"float\" nodename=\"{0}_{1}\"/>\n  </combine2>\n",
             id, anisotropic ? "alpha_y" : "alpha_x") +
         fmt::format(
             "  <generalized_schlick_bsdf name=\"{0}_lobe\" type=\"BSDF\">\n"
             "    <input name=\"weight\" type=\"float\" nodename=\"{0}_weight\"/>\n"
             "    <input name=\"color0\" type=\"color3\" nodename=\"{0}_f0\"/>\n"
             "    <input name=\"color90\" type=\"color3\" {1}/>\n"
             "    <input name=\"roughness\" type=\"vector2\" nodename=\"{0}_widths\"/>\n"
             "    <input name=\"normal\" type=\"vector3\" nodename=\"{0}_normal\"/>\n"
             "    <input name=\"tangent\" type=\"vector3\" nodename=\"{0}_tangent\"/>\n"
             "    <input name=\"distribution\" type=\"string\" value=\"ggx\"/>\n"
             "  </generalized_schlick_bsdf>\n"
             "  <add name=\"{0}_both\" type=\"BSDF\">\n"
             "    <input name=\"in1\" type=\"BSDF\" nodename=\"{0}_lobe\"/>\n"
             "    <input name=\"in2\" type=\"BSDF\" nodename=\"{0}_diffuse\"/>\n  </add>\n",
             id, maps.schlick() ? "value=\"1, 1, 1\"" : fmt::format("nodename=\"{}_f0\"", id));
}

std::filesystem::path Write(const MapNumbers& maps, const WriteContext& context) {
  const std::string id = Identifier(context.name);
  const std::string nodes =
      MeshFrame() + MapFrameNodes(id, context.name, IsAnisotropic(maps)) +
      ImageNode(id + "_albedo", context.name + "_diffuse.png", "color3") +
      fmt::format(
          "  <oren_nayar_diffuse_bsdf name=\"{0}_diffuse\" type=\"BSDF\">\n"
          "    <input name=\"color\" type=\"color3\" nodename=\"{0}_albedo\"/>\n"
          "    <input name=\"roughness\" type=\"float\" value=\"0\"/>\n"
          "    <input name=\"normal\" type=\"vector3\" nodename=\"{0}_normal\"/>\n"
          "  </oren_nayar_diffuse_bsdf>\n",
          id) +
      (HasLobes(maps) ? LobeNodes(maps, id, context.name) : "") +
      fmt::format(
          "  <surface name=\"{0}_surface\" type=\"surfaceshader\">\n    <input name=\"bsdf\" type=\"BSDF\" "
          "nodename=\"{0}_{1}\"/>\n  </surface>\n",
          id, HasLobes(maps) ? "both" : "diffuse") +
      MaterialNode(id);
  const std::filesystem::path path = context.File(".mtlx");
  WriteFileAtomically(path, MaterialXDocument(context, nodes));
  return path;
}

std::vector<Carried> CarriedRows(const MapNumbers& maps) {
  std::vector<Carried> rows = CommonRows(maps);
  Mark(&rows, Feature::kMasking, Carries::kApproximately, kMaterialXMasking);
  return rows;
}

}  // namespace

MapTarget MaterialXMaps() {
  return {"materialx", Textures,    Evaluated,
          Write,       CarriedRows, "reference {name}.mtlx (USD: @{name}.mtlx@), material {id}"};
}

}  // namespace lobefit
