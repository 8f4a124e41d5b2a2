#include "lobefit/export/targets.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/gltf/write.h"
#include "lobefit/export/targets/materialx/write.h"
#include "lobefit/export/targets/mitsuba/write.h"
#include "lobefit/export/targets/pbrt/write.h"
#include "lobefit/export/targets/sel/document.h"
#include "lobefit/export/targets/shaders/write.h"
#include "lobefit/export/targets/tables/write.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

std::string RefuseNothing(const FittedBrdf&) { return ""; }

std::string RefuseSpectraAndUnknownTerms(const FittedBrdf& fit) {
  const std::string reason = RefuseSpectra(fit);
  return reason.empty() ? RefuseUnknownTerms(fit) : reason;
}

std::vector<Carried> CarriesModel(const FittedBrdf& fit) { return AllExactly(fit, "the model itself"); }

std::vector<Carried> CarriesTable(const FittedBrdf& fit) {
  std::vector<Carried> rows = AllExactly(fit, "");
  for (Carried& row : rows) row = {row.feature, Carries::kApproximately, "within the resolution of the table"};
  return rows;
}

std::vector<Carried> CarriesRgl(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesTable(fit);
  if (fit.material().channels.size() > 32) {
    Mark(&rows, "channels", Carries::kApproximately, "every k-th wavelength, linear between; R G B in the other file");
  } else if (fit.IsRgbOrGrey() && fit.material().channels.size() == 3) {
    Mark(&rows, "channels", Carries::kApproximately,
         "exact in the rgb file; a smooth spectrum of the same R G B in the other");
  } else {
    Mark(&rows, "channels", Carries::kExactly, "");
  }
  return rows;
}

std::vector<Carried> CarriesXml(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesTable(fit);
  if (fit.material().channels.size() == 3 && fit.IsRgbOrGrey()) {
    Mark(&rows, "channels", Carries::kApproximately, "as CIE Y, u', v' (sRGB primaries)");
  }
  return rows;
}

// What all targets share that hold GGX lobes in a text: `masking` is the one that equals theirs.
std::vector<Carried> CarriesLobes(const FittedBrdf& fit, Masking masking, const std::string& own_masking) {
  std::vector<Carried> rows = AllExactly(fit, "");
  if (!fit.HasOnlyGgx()) Mark(&rows, "shape", Carries::kApproximately, "as GGX of the same widths");
  if (fit.IsTilted()) {
    Mark(&rows, "tilt", Carries::kApproximately,
         "by a normal map or shading normal, which tilts the cosine and the horizon too");
  }
  const bool same = std::all_of(fit.lobes().begin(), fit.lobes().end(),
                                [&](const FittedLobe& lobe) { return lobe.choices.masking == masking; });
  if (!same || masking == Masking::kImplicit) Mark(&rows, "masking", Carries::kApproximately, own_masking);
  if (fit.material().model.diffuse == Diffuse::kMicrofacet) {
    Mark(&rows, "diffuse", Carries::kApproximately, "as a Lambertian part of the same albedo");
  }
  return rows;
}

bool AllHave(const FittedBrdf& fit, Fresnel fresnel) {
  return std::all_of(fit.lobes().begin(), fit.lobes().end(),
                     [&](const FittedLobe& lobe) { return lobe.choices.fresnel == fresnel; });
}

// pbrt and Mitsuba: conductors in a random choice with a diffuse material, one tangent.
std::vector<Carried> CarriesConductors(const FittedBrdf& fit, Masking masking, const std::string& own_masking) {
  std::vector<Carried> rows = CarriesLobes(fit, masking, own_masking);
  Mark(&rows, "rotation", Carries::kApproximately,
       "the format has no field: exact where the mesh's texture coordinates are turned as the file says");
  const bool alone = fit.lobes().size() == 1 && !fit.HasDiffuse();
  if (!alone || !AllHave(fit, Fresnel::kConductor)) {
    Mark(&rows, "Fresnel", Carries::kApproximately,
         alone ? "a conductor of the same reflectance at normal incidence"
               : "a conductor of the same reflectance at normal incidence, less at grazing by the share of the others");
  }
  Mark(&rows, "second lobe", Carries::kApproximately, "by a mixture, with the tangent of the strongest");
  return rows;
}

std::vector<Carried> CarriesPbrt(const FittedBrdf& fit) {
  return CarriesConductors(fit, Masking::kSmithHeight, "height-correlated Smith");
}
std::vector<Carried> CarriesMitsuba(const FittedBrdf& fit) {
  return CarriesConductors(fit, Masking::kSmithSeparable, "separable Smith");
}
std::vector<Carried> CarriesMaterialX(const FittedBrdf& fit) {
  std::vector<Carried> rows =
      CarriesLobes(fit, Masking::kImplicit, "height-correlated Smith of the mean width, with energy compensation");
  if (!AllHave(fit, Fresnel::kSchlick) && !AllHave(fit, Fresnel::kNone) && !AllHave(fit, Fresnel::kConductor)) {
    Mark(&rows, "Fresnel", Carries::kApproximately, "Schlick's term between the reflectances at 0 and 90 degrees");
  }
  return rows;
}

// OpenPBR and glTF: one lobe, a base colour for metal and diffuse base.
std::vector<Carried> CarriesMetalBase(const FittedBrdf& fit, std::vector<Carried> rows) {
  if (!AllHave(fit, Fresnel::kSchlick)) {
    Mark(&rows, "Fresnel", Carries::kApproximately, "Schlick's term with the reflectance at normal incidence");
  }
  Mark(&rows, "diffuse", Carries::kApproximately,
       "as the base under the specular layer, dimmed by it; of a metal only with the metal's colour");
  Mark(&rows, "second lobe", Carries::kNot, "only the lobe with the largest reflectance is there");
  return rows;
}
std::vector<Carried> CarriesOpenPbr(const FittedBrdf& fit) {
  return CarriesMetalBase(fit, CarriesLobes(fit, Masking::kImplicit,
                                            "height-correlated Smith of the mean width, with energy compensation"));
}
std::vector<Carried> CarriesGltf(const FittedBrdf& fit) {
  return CarriesMetalBase(fit, CarriesLobes(fit, Masking::kSmithHeight, "height-correlated Smith"));
}

// The model that is fitted for a target: GGX with the masking, Schlick's term, the lobes that the target holds.
Model OwnModel(const FittedBrdf& fit, Masking masking, std::size_t most_lobes) {
  Model model = fit.material().model;
  if (model.lobes.size() > most_lobes) model.lobes = {model.lobes[StrongestLobe(fit)]};
  for (Lobe& lobe : model.lobes) {
    const bool round = IsRound(lobe.ndf), tilted = IsTilted(lobe.ndf);
    if (FamilyOf(lobe.ndf) != NdfFamily::kGgx) {
      lobe.ndf = round ? Ndf::kGgx : tilted ? Ndf::kEllipsoid : Ndf::kGgxAnisotropic;
    }
    lobe = {lobe.ndf, masking, Fresnel::kSchlick, ""};
  }
  if (model.diffuse == Diffuse::kMicrofacet) model.diffuse = Diffuse::kLambert;
  return model;
}
constexpr std::size_t kAnyNumber = 100;
Model HeightModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithHeight, kAnyNumber); }
Model SeparableModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithSeparable, kAnyNumber); }
Model OneLobeModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithHeight, 1); }

BrdfFunction EvaluatePbrt(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(PbrtSurface(fit))); }
BrdfFunction EvaluateMitsuba(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(MitsubaSurface(fit))); }
BrdfFunction EvaluateMaterialX(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(MaterialXSurface(fit))); }
BrdfFunction EvaluateOpenPbr(const FittedBrdf& fit) {
  return InChannelsOf(fit, SurfaceBrdf(OpenPbrSurface(OpenPbrOf(fit))));
}
BrdfFunction EvaluateGltf(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(GltfSurface(GltfOf(fit)))); }

std::string RefuseNoLobe(const FittedBrdf& fit) {
  if (fit.lobes().empty()) return "it needs a specular lobe, and the fit has none";
  return RefuseSpectra(fit);
}

}  // namespace

const std::vector<Target>& ExportTargets() {
  static const std::vector<Target> targets = {
      {"json", "the material document itself", "lobefit report NAME.material.json MEASUREMENT", RefuseNothing,
       CarriesModel, nullptr, nullptr, WriteJsonTarget, WriteSelJson},
      {"glsl", "GLSL function of the exact model", "f_r = lobefit_f_r(wi, wo), directions in the tangent frame",
       RefuseUnknownTerms, CarriesModel, nullptr, nullptr, WriteGlsl, WriteSelGlsl},
      {"osl", "OSL function and shader of the exact model", "oslc NAME.osl; f_r = lobefit_f_r(wi, wo)",
       RefuseUnknownTerms, CarriesModel, nullptr, nullptr, WriteOsl},
      {"brdf-explorer", "Disney BRDF Explorer, parameters as sliders", "brdf NAME.brdf", RefuseSpectraAndUnknownTerms,
       CarriesModel, nullptr, nullptr, WriteBrdfExplorer},
      {"pbrt", "pbrt-v4 material: conductor and diffuse", "Include \"NAME.pbrt\"", RefuseSpectra, CarriesPbrt,
       HeightModel, EvaluatePbrt, WritePbrt},
      {"mitsuba", "Mitsuba 3: roughconductor and diffuse, as XML and Python dict",
       "<include filename=\"NAME.mitsuba.xml\"/>, then <ref id=\"NAME\"/>", RefuseSpectra, CarriesMitsuba,
       SeparableModel, EvaluateMitsuba, WriteMitsuba},
      {"materialx", "MaterialX 1.39: BSDF nodes", "reference NAME.mtlx (USD: @NAME.mtlx@), material NAME",
       RefuseSpectra, CarriesMaterialX, HeightModel, EvaluateMaterialX, WriteMaterialX},
      {"openpbr", "MaterialX 1.39: OpenPBR surface", "reference NAME.openpbr.mtlx, material NAME", RefuseNoLobe,
       CarriesOpenPbr, OneLobeModel, EvaluateOpenPbr, WriteOpenPbr},
      {"gltf", "glTF 2.0 with KHR_materials_anisotropy, ior, specular", "open NAME.gltf; copy its material",
       RefuseNoLobe, CarriesGltf, OneLobeModel, EvaluateGltf, WriteGltf},
      {"rgl", "RGL/EPFL tables for Mitsuba 3 and pbrt-v4, tilt and rotation kept",
       "Mitsuba: <bsdf type=\"measured\"><string name=\"filename\" value=\"NAME_rgb.bsdf\"/></bsdf>; pbrt-v4: Material "
       "\"measured\" \"string filename\" \"NAME_spec.bsdf\"",
       RefuseRgl, CarriesRgl, nullptr, nullptr, WriteRglTarget},
      {"merl", "MERL table, isotropic materials only", "as any file of the MERL database: NAME.binary", RefuseMerl,
       CarriesTable, nullptr, nullptr, WriteMerlTarget},
      {"bsdf-xml", "BSDF-XML tensor tree for Radiance", "void BSDF NAME 6 0 NAME.xml 0 1 0 . (and two lines 0)",
       RefuseNothing, CarriesXml, nullptr, nullptr, WriteBsdfXmlTarget},
      {"csv", "samples over a goniometer's directions", "lobefit info NAME.csv", RefuseNothing, CarriesTable, nullptr,
       nullptr, WriteCsvTarget},
  };
  return targets;
}

const Target& FindTarget(std::string_view name) {
  std::vector<std::string> names;
  for (const Target& target : ExportTargets()) {
    if (name == target.name) return target;
    names.emplace_back(target.name);
  }
  throw UsageError(
      fmt::format("'{}' is not a target{}; the targets are: {}", Excerpt(name), DidYouMean(name, names), Join(names)));
}

}  // namespace lobefit
