#include "lobefit/export/targets/pbrt/write.h"

#include <fmt/format.h>

#include "lobefit/base/file.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

struct Component {
  std::string name;
  double share;
};

}  // namespace

Surface PbrtSurface(const FittedBrdf& fit) {
  Surface surface;
  const Shares shares = SharesOf(fit);
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    SurfaceLobe lobe = LobeOf(fit, l, shares.lobes[l]);
    lobe.rotation = CommonRotation(fit);
    const Color3 f0 = lobe.fresnel.f0;
    if (fit.lobes()[l].choices.fresnel == Fresnel::kConductor) {
      lobe.fresnel = ConductorFresnelOf(fit, l, shares.lobes[l]);
    } else {
      lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
      for (std::size_t c = 0; c < 3; ++c) {
        const ConductorIndex index = ConductorOfReflectance(f0[c]);
        lobe.fresnel.eta[c] = index.eta;
        lobe.fresnel.k[c] = index.k;
      }
    }
    surface.lobes.push_back(lobe);
  }
  surface.diffuse = DiffuseOf(fit);
  return surface;
}

WrittenFiles WritePbrt(const FittedBrdf& fit, const WriteContext& context) {
  const Surface surface = PbrtSurface(fit);
  const double rotation = CommonRotation(fit);
  WrittenFiles written;
  std::string text = CommentLines(context.header, "#") + CommentLines(RotationComment(rotation), "#") + "\n";
  std::vector<Component> components;
  for (std::size_t l = 0; l < surface.lobes.size(); ++l) {
    const SurfaceLobe& lobe = surface.lobes[l];
    const std::string name = fmt::format("{}.lobe{}", context.name, l + 1);
    Color3 reflectance = {};
    for (std::size_t c = 0; c < 3; ++c) reflectance[c] = lobe.fresnel(c, 1);
    text += fmt::format("MakeNamedMaterial \"{}\" \"string type\" \"conductor\"\n", name);
    text += lobe.fresnel.eta == Color3{1, 1, 1} ? fmt::format("  \"rgb reflectance\" [{}]\n", Numbers9(reflectance))
                                                : fmt::format("  \"rgb eta\" [{}] \"rgb k\" [{}]\n",
                                                              Numbers9(lobe.fresnel.eta), Numbers9(lobe.fresnel.k));
    text += fmt::format("  \"float uroughness\" {} \"float vroughness\" {} \"bool remaproughness\" false\n",
                        Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2));
    if (lobe.normal.z < 1) {
      const std::filesystem::path map = context.File(fmt::format("_normal{}.png", l + 1));
      WriteFileAtomically(map, NormalMapPng(RotateZ(lobe.normal, -rotation)));
      written.files.push_back(map);
      text += fmt::format("  \"string normalmap\" \"{}\"\n", map.filename().string());
    }
    components.push_back({name, lobe.weight});
  }
  if (fit.HasDiffuse() || components.empty()) {
    const double share = SharesOf(fit).diffuse;
    Color3 reflectance = surface.diffuse;
    for (double& value : reflectance) value /= share;
    const std::string name = context.name + ".diffuse";
    text += fmt::format("MakeNamedMaterial \"{}\" \"string type\" \"diffuse\" \"rgb reflectance\" [{}]\n", name,
                        Numbers9(reflectance));
    components.push_back({name, share});
  }
  // The last two are mixed first; `amount` is the share of the second.
  Component rest = components.back();
  for (std::size_t i = components.size() - 1; i-- > 0;) {
    const std::string name = i == 0 ? context.name : fmt::format("{}.mix{}", context.name, i);
    const double share = components[i].share + rest.share;
    text += fmt::format(
        "MakeNamedMaterial \"{}\" \"string type\" \"mix\" \"string materials\" [\"{}\" \"{}\"] \"float amount\" {}\n",
        name, components[i].name, rest.name, Number9(rest.share / share));
    rest = {name, share};
  }
  text += fmt::format("NamedMaterial \"{}\"\n", rest.name);
  const std::filesystem::path path = context.File(".pbrt");
  WriteFileAtomically(path, text);
  written.files.insert(written.files.begin(), path);
  written.brdf = InChannelsOf(fit, context.read_back(path).brdf);
  if (rotation != 0) {
    written.notes.push_back(fmt::format("turn the mesh's texture coordinates by {:.4g} degrees (the file says how)",
                                        RadiansToDegrees(rotation)));
  }
  return written;
}

}  // namespace lobefit
