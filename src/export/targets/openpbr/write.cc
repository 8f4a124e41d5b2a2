#include "lobefit/export/targets/openpbr/write.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/materialx/nodes.h"
#include "lobefit/export/targets/materialx/read.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/renderer/open_pbr.h"

namespace lobefit {
namespace {

std::vector<Carried> CarriesOpenPbr(const FittedBrdf& fit) {
  const OpenPbr written = OpenPbrOf(fit);
  const bool coated = written.coat.weight > 0;
  const Surface surface = OpenPbrSurface(written);
  Spectrum f0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double dielectric = surface.lobes[1].fresnel(c, 1) * written.specular_color[c];
    f0.push_back(written.metalness * written.base_color[c] + (1 - written.metalness) * dielectric);
  }
  std::vector<Carried> rows = CarriesMetalBase(fit, CarriesLobes(fit, Masking::kImplicit, kMaterialXMasking), f0);
  if (coated) {
    Mark(&rows, Feature::kCoat, Carries::kApproximately,
         "by the coat, which dims what lies below for the viewer's direction only, and refracts nothing");
    if (fit.lobes().size() == 2) Mark(&rows, Feature::kSecondLobe, Carries::kApproximately, "the coat");
  }
  if (written.metalness == 1 && AllHave(fit, Fresnel::kSchlickF82)) {
    const Spectrum tint = LobeOf(fit, StrongestLobe(fit), 1).fresnel.f82;
    const bool held = std::all_of(tint.begin(), tint.end(), [](double t) { return t <= 1; });
    Mark(&rows, Feature::kFresnel, held ? Carries::kExactly : Carries::kApproximately,
         held ? "" : "a tint of at most 1");
  }
  if (written.diffuse_roughness > 0) {
    Mark(&rows, Feature::kDiffuse, Carries::kApproximately,
         "roughness and colour as the base under the specular layer, dimmed by it");
  }
  return rows;
}

Model OneLobeModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithHeight, 1, true); }
BrdfFunction EvaluateOpenPbr(const FittedBrdf& fit) {
  return InChannelsOf(fit, SurfaceBrdf(OpenPbrSurface(OpenPbrOf(fit))));
}

std::string Real(const char* input, double value) {
  return fmt::format("    <input name=\"{}\" type=\"float\" value=\"{}\"/>\n", input, Number9(value));
}

// About the surface's own normal, which is the default.
std::string CoatText(const OpenPbrCoat& coat) {
  if (coat.weight == 0) return "";
  return Real("coat_weight", coat.weight) + Real("coat_roughness", coat.roughness.roughness) +
         Real("coat_ior", coat.ior) + Real("coat_darkening", coat.darkening);
}

WrittenFiles WriteOpenPbr(const FittedBrdf& fit, const WriteContext& context) {
  const OpenPbr parameters = OpenPbrOf(fit);
  const std::string id = Identifier(context.name);
  const FrameText frame = FrameNodes(id, parameters.rotation, parameters.normal);
  const std::string nodes =
      MeshFrame() + frame.nodes + fmt::format("  <open_pbr_surface name=\"{}_surface\" type=\"surfaceshader\">\n", id) +
      fmt::format("    <input name=\"base_color\" type=\"color3\" value=\"{}\"/>\n",
                  Numbers9(parameters.base_color, ", ")) +
      Real("base_metalness", parameters.metalness) + Real("base_diffuse_roughness", parameters.diffuse_roughness) +
      fmt::format("    <input name=\"specular_color\" type=\"color3\" value=\"{}\"/>\n",
                  Numbers9(parameters.specular_color, ", ")) +
      Real("specular_roughness", parameters.roughness.roughness) +
      Real("specular_roughness_anisotropy", parameters.roughness.anisotropy) + Real("specular_ior", parameters.ior) +
      CoatText(parameters.coat) +
      fmt::format(
          "    <input name=\"geometry_normal\" type=\"vector3\" nodename=\"{}\"/>\n"
          "    <input name=\"geometry_tangent\" type=\"vector3\" nodename=\"{}\"/>\n  </open_pbr_surface>\n",
          frame.normal, frame.tangent) +
      fmt::format(
          "  <surfacematerial name=\"{0}\" type=\"material\">\n    <input name=\"surfaceshader\" "
          "type=\"surfaceshader\" nodename=\"{0}_surface\"/>\n  </surfacematerial>\n",
          id);
  const std::filesystem::path path = context.File(".openpbr.mtlx");
  WriteFileAtomically(path, MaterialXDocument(context, nodes));
  const FileBytes bytes(path);
  const ImportedMaterial back = ReadMaterialX({path, bytes.bytes()});
  return {{path}, InChannelsOf(fit, back.brdf), false, {}};
}

}  // namespace

Target OpenPbrTarget() {
  return {.name = "openpbr",
          .description = "MaterialX 1.39: OpenPBR surface",
          .load = "reference {name}.openpbr.mtlx, material {id}",
          .rgb_only = true,
          .refusal = RefuseNoLobe,
          .carries = CarriesOpenPbr,
          .own_model = OneLobeModel,
          .evaluate = EvaluateOpenPbr,
          .write = WriteOpenPbr};
}

}  // namespace lobefit
