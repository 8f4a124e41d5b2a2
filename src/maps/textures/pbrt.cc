// pbrt-v4: a mix of conductor and diffuse.
#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/pbrt/tokens.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/maps/textures/map_target.h"
#include "lobefit/maps/textures/mixture.h"

namespace lobefit {
namespace {

Surface Evaluated(const MapNumbers& maps, const std::vector<TextureValue>& read) {
  return MixtureSurface(maps, read, SurfaceMasking::kHeightCorrelated);
}

std::filesystem::path Write(const MapNumbers& maps, const WriteContext& context) {
  const auto file = [&](const char* ending) { return PbrtString(context.map_path + context.name + ending); };
  const auto own = [&](const char* part) { return PbrtString(context.name + "." + part); };
  const auto texture = [&](const char* part, const char* type, const char* ending) {
    return fmt::format(
        "Texture {} \"{}\" \"imagemap\" \"string filename\" {} \"string encoding\" \"linear\" "
        "\"string wrap\" \"clamp\"\n",
        own(part), type, file(ending));
  };
  const std::string normal = fmt::format("\"string normalmap\" {}", file("_normal.png"));
  std::string text = texture("diffuse", "spectrum", "_mix_diffuse.png");
  if (HasLobes(maps)) {
    const bool anisotropic = IsAnisotropic(maps);
    text += texture("share", "float", "_mix_share.png") + texture("specular", "spectrum", "_mix_specular.png") +
            texture("alpha_u", "float", anisotropic ? "_mix_alpha_u.png" : "_alpha.png");
    if (anisotropic) text += texture("alpha_v", "float", "_mix_alpha_v.png");
    text += fmt::format(
        "MakeNamedMaterial {} \"string type\" \"conductor\" \"texture reflectance\" {}\n  \"texture uroughness\" {} "
        "\"texture vroughness\" {} \"bool remaproughness\" false\n  {}\n"
        "MakeNamedMaterial {} \"string type\" \"diffuse\" \"texture reflectance\" {}\n  {}\n"
        "MakeNamedMaterial {} \"string type\" \"mix\" \"string materials\" [{} {}] \"texture amount\" {}\n",
        own("lobe"), own("specular"), own("alpha_u"), own(anisotropic ? "alpha_v" : "alpha_u"), normal, own("base"),
        own("diffuse"), normal, PbrtString(context.name), own("lobe"), own("base"), own("share"));
  } else {
    text += fmt::format("MakeNamedMaterial {} \"string type\" \"diffuse\" \"texture reflectance\" {}\n  {}\n",
                        PbrtString(context.name), own("diffuse"), normal);
  }
  text += fmt::format("NamedMaterial {}\n", PbrtString(context.name));
  const std::filesystem::path path = context.File(".pbrt");
  WriteFileAtomically(path, CommentLines(context.header, "#") + "\n" + text);
  return path;
}

std::vector<Carried> CarriedRows(const MapNumbers& maps) {
  std::vector<Carried> rows = MixtureRows(maps);
  Mark(&rows, Feature::kMasking, Carries::kApproximately, "height-correlated Smith");
  return rows;
}

}  // namespace

MapTarget PbrtMaps() { return {"pbrt", MixtureTextures, Evaluated, Write, CarriedRows, "Include \"{name}.pbrt\""}; }

}  // namespace lobefit
