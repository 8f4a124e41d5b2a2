// Mitsuba 3: blendbsdf of roughconductor and diffuse under a normal map.
#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/mitsuba/components.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/mixture.h"

namespace lobefit {
namespace {

// eta = 1 and this k have the reflectance; it exceeds 1, which PNG does not hold.
Texture ExtinctionTexture() {
  return {"_mitsuba_k.exr", 3, 32, false, [](const TexelNumbers& texel) {
            const Color3 color = ConductorColor(texel);
            TextureValue k = {};
            for (std::size_t c = 0; c < 3; ++c) k[c] = ConductorOfReflectance(color[c]).k;
            return k;
          }};
}

std::vector<Texture> Textures(const MapNumbers& maps) {
  std::vector<Texture> textures = MixtureTextures(maps);
  if (HasLobes(maps) && maps.schlick()) textures[kMixSpecular] = ExtinctionTexture();
  return textures;
}

Surface Evaluated(const MapNumbers& maps, const std::vector<TextureValue>& read) {
  Surface surface = MixtureSurface(maps, read, SurfaceMasking::kSeparable);
  if (surface.lobes.empty()) return surface;
  SurfaceFresnel& fresnel = surface.lobes[0].fresnel;
  if (maps.schlick()) {
    fresnel.k = ColorOf(read[kMixSpecular]);
  } else {
    fresnel.kind = SurfaceFresnel::Kind::kSchlick;
    fresnel.f0 = fresnel.f90 = ColorOf(read[kMixSpecular]);
  }
  return surface;
}

std::filesystem::path Write(const MapNumbers& maps, const WriteContext& context) {
  const auto texture = [&](const char* name, const char* ending) {
    return fmt::format(
        "<texture type=\"bitmap\" name=\"{}\">\n  <string name=\"filename\" value=\"{}\"/>\n"
        "  <boolean name=\"raw\" value=\"true\"/>\n  <string name=\"wrap_mode\" value=\"clamp\"/>\n"
        "</texture>",
        name, MarkupText(context.map_path + context.name + ending));
  };
  const std::string base =
      fmt::format("<bsdf type=\"diffuse\">\n{}\n</bsdf>", Indented(texture("reflectance", "_mix_diffuse.png"), "  "));
  std::string whole = base;
  if (HasLobes(maps)) {
    const bool anisotropic = IsAnisotropic(maps);
    // A stack that is not calibrated has no Fresnel term: a mirror's, coloured.
    const std::string color = maps.schlick() ? "<rgb name=\"eta\" value=\"1\"/>\n" + texture("k", "_mitsuba_k.exr")
                                             : "<string name=\"material\" value=\"none\"/>\n" +
                                                   texture("specular_reflectance", "_mix_specular.png");
    const std::string lobe = fmt::format(
        "<bsdf type=\"roughconductor\">\n  <string name=\"distribution\" value=\"ggx\"/>\n{}\n{}\n{}\n</bsdf>",
        Indented(texture("alpha_u", anisotropic ? "_mix_alpha_u.png" : "_alpha.png"), "  "),
        Indented(texture("alpha_v", anisotropic ? "_mix_alpha_v.png" : "_alpha.png"), "  "), Indented(color, "  "));
    whole =
        fmt::format("<bsdf type=\"blendbsdf\">\n{}\n{}\n{}\n</bsdf>",
                    Indented(texture("weight", "_mix_share.png"), "  "), Indented(lobe, "  "), Indented(base, "  "));
  }
  const std::string xml = fmt::format(
      "<bsdf type=\"normalmap\" id=\"{}\">\n{}\n  <boolean name=\"use_shadowing_function\" value=\"false\"/>\n{}\n"
      "</bsdf>",
      Identifier(context.name), Indented(texture("normalmap", "_normal.png"), "  "), Indented(whole, "  "));
  std::vector<std::string> header = context.header;
  header.emplace_back(
      "For rgb variants. Mitsuba 3.7.1 or newer: before, take out the lines with use_shadowing_function.");
  header.emplace_back("One-sided, as every conductor is: <bsdf type=\"twosided\"> around it lights back faces.");
  const std::filesystem::path path = context.File(".mitsuba.xml");
  WriteFileAtomically(path, XmlComment(header) + "<scene version=\"3.0.0\">\n" + Indented(xml, "  ") + "\n</scene>\n");
  return path;
}

std::vector<Carried> CarriedRows(const MapNumbers& maps) {
  std::vector<Carried> rows = MixtureRows(maps);
  if (!maps.schlick()) Mark(&rows, Feature::kFresnel, Carries::kExactly, "");
  return rows;
}

}  // namespace

MapTarget MitsubaMaps() {
  return {"mitsuba", Textures,    Evaluated,
          Write,     CarriedRows, "<include filename=\"{name}.mitsuba.xml\"/>, then <ref id=\"{id}\"/>"};
}

}  // namespace lobefit
