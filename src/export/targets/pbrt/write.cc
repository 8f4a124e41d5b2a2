#include "lobefit/export/targets/pbrt/write.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/pbrt/read.h"
#include "lobefit/export/targets/pbrt/tokens.h"
#include "lobefit/export/targets/spectra.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

struct Component {
  std::string name;
  double share;
};

// Least over largest reflectance of a colour whose eta and k survive pbrt's way from R, G, B to spectra. Measured in
// pbrt in the lobe: nickel (0.8) is then within 11 % in place of 57 %, silk of one blue (0.05) off by 26 %.
constexpr double kSaturated = 0.5;

bool IsSaturated(const FittedBrdf& fit, const Spectrum& f0) {
  return fit.IsRgbOrGrey() &&
         *std::min_element(f0.begin(), f0.end()) < kSaturated * *std::max_element(f0.begin(), f0.end());
}

bool IsMirror(const Widths& widths) { return std::max(widths.alpha_1, widths.alpha_2) < kPbrtMirror; }

std::string ColorText(const FittedBrdf& fit, const char* name, const Spectrum& values) {
  if (fit.IsRgbOrGrey()) return fmt::format("\"rgb {}\" [{}]", name, Numbers9(values));
  const SpectrumNodes nodes = Continued({fit.material().wavelengths_nm, values});
  std::string text;
  for (std::size_t k = 0; k < nodes.values.size(); ++k) {
    text += fmt::format("{}{} {}", k == 0 ? "" : "  ", Number9(nodes.wavelengths_nm[k]), Number9(nodes.values[k]));
  }
  return fmt::format("\"spectrum {}\" [{}]", name, text);
}

std::string LobeText(const FittedBrdf& fit, const SurfaceLobe& lobe) {
  Spectrum reflectance;
  for (std::size_t c = 0; c < lobe.fresnel.eta.size(); ++c) reflectance.push_back(lobe.fresnel(c, 1));
  const bool by_reflectance = lobe.fresnel.eta == Spectrum(lobe.fresnel.eta.size(), 1.0);
  return (by_reflectance
              ? "  " + ColorText(fit, "reflectance", reflectance)
              : "  " + ColorText(fit, "eta", lobe.fresnel.eta) + "\n  " + ColorText(fit, "k", lobe.fresnel.k)) +
         fmt::format("\n  \"float uroughness\" {} \"float vroughness\" {} \"bool remaproughness\" false\n",
                     Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2));
}

std::vector<Carried> CarriesPbrt(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesConductors(fit, Masking::kSmithHeight, "height-correlated Smith");
  if (std::any_of(fit.lobes().begin(), fit.lobes().end(),
                  [](const FittedLobe& lobe) { return IsMirror(lobe.widths); })) {
    Mark(&rows, Feature::kShape, Carries::kApproximately,
         fmt::format("a lobe is narrower than {}: pbrt makes a perfect mirror of such a lobe, so {} is written",
                     kPbrtMirror, kPbrtMirror));
  }
  Mark(&rows, Feature::kChannels, Carries::kApproximately,
       fit.IsRgbOrGrey()
           ? "pbrt makes spectra of R G B: usual colours come back within 0.5 %, saturated ones may be off "
             "by a factor in their least channel"
           : "spectra, linear between the wavelengths and constant beyond them");
  return rows;
}

Model HeightModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithHeight, kAnyNumber); }
BrdfFunction EvaluatePbrt(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(PbrtSurface(fit))); }

// The lobes and the diffuse part; names of the components and of the maps are added to the lists.
std::string ComponentsText(const FittedBrdf& fit, const WriteContext& context, std::vector<Component>* components,
                           WrittenFiles* written, std::vector<std::string>* maps) {
  const Surface surface = PbrtSurface(fit);
  const double rotation = CommonRotation(fit);
  std::string text;
  for (std::size_t l = 0; l < surface.lobes.size(); ++l) {
    const SurfaceLobe& lobe = surface.lobes[l];
    const std::string name = fmt::format("{}.lobe{}", context.name, l + 1);
    text +=
        fmt::format("MakeNamedMaterial {} \"string type\" \"conductor\"\n{}", PbrtString(name), LobeText(fit, lobe));
    if (lobe.normal.z < 1) {
      const std::filesystem::path map = context.File(fmt::format("_normal{}.png", l + 1));
      WriteFileAtomically(map, NormalMapPng(RotateZ(lobe.normal, -rotation)));
      written->files.push_back(map);
      maps->push_back(context.map_path + map.filename().string());
      text += fmt::format("  \"string normalmap\" {}\n", PbrtString(maps->back()));
    }
    components->push_back({name, lobe.weight});
  }
  if (fit.HasDiffuse() || components->empty()) {
    const double share = SharesOf(fit).diffuse;
    Spectrum reflectance = surface.diffuse;
    for (double& value : reflectance) value /= share;
    const std::string name = context.name + ".diffuse";
    text += fmt::format("MakeNamedMaterial {} \"string type\" \"diffuse\" {}\n", PbrtString(name),
                        ColorText(fit, "reflectance", reflectance));
    components->push_back({name, share});
  }
  return text;
}

WrittenFiles WritePbrt(const FittedBrdf& fit, const WriteContext& context) {
  WrittenFiles written;
  std::vector<Component> components;
  std::vector<std::string> maps;
  std::string text = ComponentsText(fit, context, &components, &written, &maps);
  // The last two are mixed first; `amount` is the share of the second.
  Component rest = components.back();
  for (std::size_t i = components.size() - 1; i-- > 0;) {
    const std::string name = i == 0 ? context.name : fmt::format("{}.mix{}", context.name, i);
    const double share = components[i].share + rest.share;
    text += fmt::format(
        "MakeNamedMaterial {} \"string type\" \"mix\" \"string materials\" [{} {}] \"float amount\" {}\n",
        PbrtString(name), PbrtString(components[i].name), PbrtString(rest.name), Number9(rest.share / share));
    rest = {name, share};
  }
  text += fmt::format("NamedMaterial {}\n", PbrtString(rest.name));

  const double rotation = CommonRotation(fit);
  std::vector<std::string> header = context.header;
  if (!maps.empty()) {
    header.push_back(MapComment(maps, "the main scene file, also where this file is included from another folder"));
    written.notes.push_back(header.back());
  }
  for (const std::string& line : RotationComment(rotation)) header.push_back(line);
  const std::filesystem::path path = context.File(".pbrt");
  WriteFileAtomically(path, CommentLines(header, "#") + "\n" + text);
  written.files.insert(written.files.begin(), path);
  const FileBytes bytes(path);
  const ImportedMaterial back = ReadPbrt({path, bytes.bytes()});
  written.brdf = fit.IsRgbOrGrey()
                     ? InChannelsOf(fit, back.brdf)
                     : AtWavelengths(back.brdf, back.channels.wavelengths_nm, fit.material().wavelengths_nm);
  if (rotation != 0) {
    written.notes.push_back(fmt::format("turn the mesh's texture coordinates by {:.4g} degrees (the file says how)",
                                        RadiansToDegrees(rotation)));
  }
  return written;
}

}  // namespace

Surface PbrtSurface(const FittedBrdf& fit) {
  Surface surface;
  const Shares shares = SharesOf(fit);
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    if (shares.lobes[l] == 0) continue;
    SurfaceLobe lobe = LobeOf(fit, l, shares.lobes[l]);
    lobe.rotation = CommonRotation(fit);
    if (IsMirror(lobe.widths)) {
      lobe.widths.alpha_1 = kPbrtMirror;
      if (!fit.lobes()[l].anisotropic) lobe.widths.alpha_2 = kPbrtMirror;
    }
    const Spectrum f0 = lobe.fresnel.f0;
    if (fit.lobes()[l].choices.fresnel == Fresnel::kConductor || !IsSaturated(fit, f0)) {
      lobe.fresnel = ConductorFresnelOf(fit, l, shares.lobes[l]);
    } else {
      lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
      lobe.fresnel.eta.assign(f0.size(), 1.0);
      lobe.fresnel.k.clear();
      for (const double reflectance : f0) lobe.fresnel.k.push_back(ConductorOfReflectance(reflectance).k);
    }
    surface.lobes.push_back(lobe);
  }
  surface.diffuse = DiffuseOf(fit);
  return surface;
}

Target PbrtTarget() {
  return {.name = "pbrt",
          .description = "pbrt-v4 material: conductor and diffuse",
          .load = "Include \"{name}.pbrt\"",
          .by_wavelength = true,
          .refusal = RefuseForeignLobes,
          .carries = CarriesPbrt,
          .own_model = HeightModel,
          .evaluate = EvaluatePbrt,
          .write = WritePbrt,
          .recognises = IsPbrt,
          .read = ReadPbrt,
          .is_text = true};
}

}  // namespace lobefit
