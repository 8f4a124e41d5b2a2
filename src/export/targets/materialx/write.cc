#include "lobefit/export/targets/materialx/write.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/materialx/nodes.h"
#include "lobefit/export/targets/materialx/read.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/renderer/open_pbr.h"

namespace lobefit {
namespace {

std::string LobeNode(const std::string& name, const SurfaceLobe& lobe, const FrameText& frame) {
  const bool conductor = lobe.fresnel.kind == SurfaceFresnel::Kind::kConductor,
             coat = lobe.fresnel.kind == SurfaceFresnel::Kind::kDielectric;
  const char* node = conductor ? "conductor_bsdf" : coat ? "dielectric_bsdf" : "generalized_schlick_bsdf";
  const auto color = [](const char* input, const Spectrum& value) {
    return fmt::format("    <input name=\"{}\" type=\"color3\" value=\"{}\"/>\n", input, Numbers9(value, ", "));
  };
  return fmt::format("  <{} name=\"{}\" type=\"BSDF\">\n", node, name) +
         (coat        ? fmt::format("    <input name=\"ior\" type=\"float\" value=\"{}\"/>\n"
                                           "    <input name=\"scatter_mode\" type=\"string\" value=\"R\"/>\n",
                                    Number9(lobe.fresnel.eta[0]))
          : conductor ? color("ior", lobe.fresnel.eta) + color("extinction", lobe.fresnel.k)
                      : color("color0", lobe.fresnel.f0) +
                            (lobe.fresnel.f82.empty() ? "" : color("color82", lobe.fresnel.f82)) +
                            color("color90", lobe.fresnel.f90)) +
         fmt::format(
             "    <input name=\"roughness\" type=\"vector2\" value=\"{}, {}\"/>\n"
             "    <input name=\"normal\" type=\"vector3\" nodename=\"{}\"/>\n"
             "    <input name=\"tangent\" type=\"vector3\" nodename=\"{}\"/>\n"
             "    <input name=\"distribution\" type=\"string\" value=\"ggx\"/>\n  </{}>\n",
             Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2), frame.normal, frame.tangent, node);
}

// A layer over all lobes but the coat's, and over the diffuse part.
void PutBelowCoat(const FittedBrdf& fit, Surface* surface) {
  const Model& model = fit.material().model;
  const std::size_t coat = CoatOf(model);
  if (coat == model.lobes.size()) return;
  std::size_t place = 0;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    if (fit.lobes()[l].retro) continue;
    SurfaceFresnel& fresnel = surface->lobes[place].fresnel;
    if (l == coat) {
      surface->coating = Surface::Coating::kAlbedo;
      surface->coat_lobe = place;
      const double ior = fit.material().parameters[FirstFresnel(model, coat)].values[0];
      fresnel.kind = SurfaceFresnel::Kind::kDielectric;
      fresnel.eta = Spectrum(fresnel.f0.size(), ior);
    } else if (fresnel.kind == SurfaceFresnel::Kind::kSchlick) {
      DimBelowCoat(fit, coat, &fresnel, nullptr);
    }
    ++place;
  }
  DimBelowCoat(fit, coat, nullptr, &surface->diffuse);
}

std::vector<Carried> CarriesMaterialX(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesLobes(fit, Masking::kImplicit, kMaterialXMasking);
  Mark(&rows, Feature::kCoat, Carries::kApproximately,
       "by a layer, which dims what lies below for the viewer's direction only, and refracts nothing");
  if (CoatOf(fit.material().model) < fit.lobes().size())
    Mark(&rows, Feature::kSecondLobe, Carries::kApproximately, "what the coat lets in at the normal is in its colour");
  MarkOrenNayar(fit, &rows);
  const bool own = std::all_of(fit.lobes().begin(), fit.lobes().end(), [](const FittedLobe& lobe) {
    const Fresnel fresnel = lobe.choices.fresnel;
    return fresnel != Fresnel::kDielectric && fresnel != Fresnel::kCurve && !IsCoat(fresnel);
  });
  if (!own) {
    Mark(&rows, Feature::kFresnel, Carries::kApproximately,
         "Schlick's term between the reflectances at 0 and 90 degrees");
  }
  return rows;
}

Model HeightModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithHeight, kAnyNumber, true); }
BrdfFunction EvaluateMaterialX(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(MaterialXSurface(fit))); }

WrittenFiles WriteMaterialX(const FittedBrdf& fit, const WriteContext& context) {
  const Surface surface = MaterialXSurface(fit);
  const std::string id = Identifier(context.name);
  std::string nodes = MeshFrame(), sum;
  const auto add = [&](const std::string& bsdf) {
    if (sum.empty()) {
      sum = bsdf;
      return;
    }
    const std::string both = sum + "_and_" + bsdf.substr(id.size() + 1);
    nodes += fmt::format(
        "  <add name=\"{}\" type=\"BSDF\">\n    <input name=\"in1\" type=\"BSDF\" nodename=\"{}\"/>\n"
        "    <input name=\"in2\" type=\"BSDF\" nodename=\"{}\"/>\n  </add>\n",
        both, sum, bsdf);
    sum = both;
  };
  for (std::size_t l = 0; l < surface.lobes.size(); ++l) {
    const std::string name = fmt::format("{}_lobe{}", id, l + 1);
    const FrameText frame = FrameNodes(name, surface.lobes[l].rotation, surface.lobes[l].normal);
    nodes += frame.nodes + LobeNode(name, surface.lobes[l], frame);
    if (surface.coating == Surface::Coating::kNone || l != surface.coat_lobe) add(name);
  }
  if (fit.HasDiffuse() || surface.lobes.empty()) {
    nodes += fmt::format(
        "  <oren_nayar_diffuse_bsdf name=\"{}_diffuse\" type=\"BSDF\">\n"
        "    <input name=\"color\" type=\"color3\" value=\"{}\"/>\n"
        "    <input name=\"roughness\" type=\"float\" value=\"{}\"/>\n"
        "    <input name=\"energy_compensation\" type=\"boolean\" value=\"true\"/>\n  </oren_nayar_diffuse_bsdf>\n",
        id, Numbers9(surface.diffuse, ", "), Number9(surface.diffuse_roughness));
    add(id + "_diffuse");
  }
  if (surface.coating != Surface::Coating::kNone) {
    nodes += fmt::format(
        "  <layer name=\"{0}_coated\" type=\"BSDF\">\n    <input name=\"top\" type=\"BSDF\" "
        "nodename=\"{0}_lobe{1}\"/>\n"
        "    <input name=\"base\" type=\"BSDF\" nodename=\"{2}\"/>\n  </layer>\n",
        id, surface.coat_lobe + 1, sum);
    sum = id + "_coated";
  }
  nodes += fmt::format(
      "  <surface name=\"{0}_surface\" type=\"surfaceshader\">\n    <input name=\"bsdf\" type=\"BSDF\" "
      "nodename=\"{1}\"/>\n  </surface>\n  <surfacematerial name=\"{0}\" type=\"material\">\n    <input "
      "name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"{0}_surface\"/>\n  </surfacematerial>\n",
      id, sum);
  const std::filesystem::path path = context.File(".mtlx");
  WriteFileAtomically(path, MaterialXDocument(context, nodes));
  const FileBytes bytes(path);
  const ImportedMaterial back = ReadMaterialX({path, bytes.bytes()});
  return {{path}, InChannelsOf(fit, back.brdf), false, {}};
}

}  // namespace

Surface MaterialXSurface(const FittedBrdf& fit) {
  Surface surface;
  surface.masking = SurfaceMasking::kMeanAlpha;
  surface.energy_compensation = true;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    if (fit.lobes()[l].retro) continue;
    surface.lobes.push_back(LobeOf(fit, l, 1));
    if (fit.lobes()[l].choices.fresnel == Fresnel::kConductor) {
      surface.lobes.back().fresnel = ConductorFresnelOf(fit, l, 1);
    }
  }
  surface.diffuse = DiffuseOf(fit);
  surface.diffuse_roughness = DiffuseRoughnessOf(fit);
  PutBelowCoat(fit, &surface);
  return surface;
}

Target MaterialXTarget() {
  return {.name = "materialx",
          .description = "MaterialX 1.39: BSDF nodes",
          .load = "reference {name}.mtlx (USD: @{name}.mtlx@), material {id}",
          .rgb_only = true,
          .refusal = RefuseForeignLobes,
          .carries = CarriesMaterialX,
          .own_model = HeightModel,
          .evaluate = EvaluateMaterialX,
          .write = WriteMaterialX,
          .recognises = IsMaterialX,
          .read = ReadMaterialX,
          .is_text = true};
}

}  // namespace lobefit
