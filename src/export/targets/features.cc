#include "lobefit/export/targets/features.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/renderer/surface.h"

namespace lobefit {

std::vector<Carried> AllExactly(const FittedBrdf& fit, const std::string& note) {
  std::vector<Carried> rows = {{Feature::kShape, Carries::kExactly, note}};
  const auto any = [&](auto&& predicate) { return std::any_of(fit.lobes().begin(), fit.lobes().end(), predicate); };
  if (any([](const FittedLobe& lobe) { return lobe.anisotropic && lobe.rotation != 0; })) {
    rows.push_back({Feature::kRotation, Carries::kExactly, note});
  }
  if (fit.IsTilted()) rows.push_back({Feature::kTilt, Carries::kExactly, note});
  rows.push_back({Feature::kMasking, Carries::kExactly, note});
  rows.push_back({Feature::kFresnel, Carries::kExactly, note});
  if (fit.HasDiffuse()) rows.push_back({Feature::kDiffuse, Carries::kExactly, note});
  if (fit.lobes().size() > 1) rows.push_back({Feature::kSecondLobe, Carries::kExactly, note});
  if (CoatOf(fit.material().model) < fit.lobes().size()) rows.push_back({Feature::kCoat, Carries::kExactly, note});
  rows.push_back({Feature::kChannels, Carries::kExactly, note});
  return rows;
}

std::vector<Carried> CarriesModelItself(const FittedBrdf& fit) { return AllExactly(fit, "the model itself"); }

std::vector<Carried> CarriesTable(const FittedBrdf& fit) {
  std::vector<Carried> rows = AllExactly(fit, "");
  for (Carried& row : rows) row = {row.feature, Carries::kApproximately, "within the resolution of the table"};
  return rows;
}

void Mark(std::vector<Carried>* rows, Feature feature, Carries how, const std::string& note) {
  for (Carried& row : *rows) {
    if (row.feature == feature) row = {feature, how, note};
  }
}

bool AllHave(const FittedBrdf& fit, Fresnel fresnel) {
  return std::all_of(fit.lobes().begin(), fit.lobes().end(),
                     [&](const FittedLobe& lobe) { return lobe.choices.fresnel == fresnel; });
}

namespace {

// Left out by all renderers but those that take a table or a program.
void MarkRetro(const FittedBrdf& fit, std::vector<Carried>* rows) {
  if (std::none_of(fit.lobes().begin(), fit.lobes().end(), [](const FittedLobe& lobe) { return lobe.retro; })) return;
  Mark(rows, Feature::kSecondLobe, Carries::kNot, "lobes about the back direction are left out");
}

}  // namespace

std::vector<Carried> CarriesLobes(const FittedBrdf& fit, Masking masking, const std::string& own_masking) {
  std::vector<Carried> rows = AllExactly(fit, "");
  if (!fit.HasOnlyGgx()) Mark(&rows, Feature::kShape, Carries::kApproximately, "as GGX of the same widths");
  if (fit.IsTilted()) {
    Mark(&rows, Feature::kTilt, Carries::kApproximately,
         "by a normal map or shading normal, which tilts the cosine and the horizon too");
  }
  const bool same = std::all_of(fit.lobes().begin(), fit.lobes().end(),
                                [&](const FittedLobe& lobe) { return lobe.choices.masking == masking; });
  if (!same || masking == Masking::kImplicit) Mark(&rows, Feature::kMasking, Carries::kApproximately, own_masking);
  const Diffuse diffuse = fit.material().model.diffuse;
  if (diffuse != Diffuse::kLambert && diffuse != Diffuse::kNone) {
    Mark(&rows, Feature::kDiffuse, Carries::kApproximately, "as a Lambertian part of the same albedo");
  }
  Mark(&rows, Feature::kCoat, Carries::kApproximately, "as one more lobe, which dims nothing below it");
  MarkRetro(fit, &rows);
  return rows;
}

std::vector<Carried> CarriesConductors(const FittedBrdf& fit, Masking masking, const std::string& own_masking) {
  std::vector<Carried> rows = CarriesLobes(fit, masking, own_masking);
  Mark(&rows, Feature::kRotation, Carries::kApproximately,
       "the format has no field: exact where the mesh's texture coordinates are turned as the file says");
  const bool alone = fit.lobes().size() == 1 && !fit.HasDiffuse();
  if (!alone || !AllHave(fit, Fresnel::kConductor)) {
    Mark(&rows, Feature::kFresnel, Carries::kApproximately,
         alone ? "a conductor of the same reflectance at normal incidence"
               : "a conductor of the same reflectance at normal incidence, less at grazing by the share of the others");
  }
  Mark(&rows, Feature::kSecondLobe, Carries::kApproximately, "by a mixture, with the tangent of the strongest");
  const std::vector<double> shares = SharesOf(fit).lobes;
  if (std::count(shares.begin(), shares.end(), 0.0) > 0) {
    Mark(&rows, Feature::kSecondLobe, Carries::kNot, "it reflects less than 1e-5 at normal incidence");
  }
  MarkRetro(fit, &rows);
  return rows;
}

std::vector<Carried> CarriesMetalBase(const FittedBrdf& fit, std::vector<Carried> rows, const std::vector<double>& f0) {
  if (!AllHave(fit, Fresnel::kSchlick)) {
    Mark(&rows, Feature::kFresnel, Carries::kApproximately, "Schlick's term with the reflectance at normal incidence");
  }
  const Spectrum fitted = LobeOf(fit, StrongestLobe(fit), 1).fresnel.f0;
  double off = 0;
  for (std::size_t c = 0; c < fitted.size(); ++c) off = std::max(off, std::fabs(f0[c] - fitted[c]));
  if (off > 1e-6) {
    const std::string note = fmt::format(
        "the reflectance at normal incidence is off by up to {:.2g}: colour of metal and base are one", off);
    Mark(&rows, Feature::kFresnel, Carries::kApproximately, note);
    Mark(&rows, Feature::kChannels, Carries::kApproximately, note);
  }
  Mark(&rows, Feature::kDiffuse, Carries::kApproximately,
       "as the base under the specular layer, dimmed by it; of a metal only with the metal's colour");
  Mark(&rows, Feature::kSecondLobe, Carries::kNot, "only the lobe with the largest reflectance is there");
  if (fit.lobes().size() > 1)
    Mark(&rows, Feature::kCoat, Carries::kNot, "what lies below it, or the coat, is left out");
  return rows;
}

void MarkOrenNayar(const FittedBrdf& fit, std::vector<Carried>* rows) {
  const Model& model = fit.material().model;
  if (model.diffuse != Diffuse::kOrenNayar) return;
  const std::vector<double>& roughness = fit.material().parameters[FirstParameter(model, model.lobes.size())].values;
  const bool same = std::all_of(roughness.begin(), roughness.end(), [&](double r) { return r == roughness[0]; });
  Mark(rows, Feature::kDiffuse, same ? Carries::kExactly : Carries::kApproximately,
       same ? "GLSL takes directions more than 90 degrees apart as 90" : "with the mean roughness of the channels");
}

Model OwnModel(const FittedBrdf& fit, Masking masking, std::size_t most_lobes, bool tint_and_roughness) {
  Model model = fit.material().model;
  model.lobes.clear();
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const FittedLobe& lobe = fit.lobes()[l];
    if (lobe.retro || (fit.lobes().size() > most_lobes && l != StrongestLobe(fit))) continue;
    const bool tilted = lobe.tilt > 1e-6;
    const Ndf ndf = tilted ? Ndf::kEllipsoid : lobe.anisotropic ? Ndf::kGgxAnisotropic : Ndf::kGgx;
    const bool kept = FamilyOf(lobe.choices.ndf) == Family::kGgx && tilted == IsTilted(lobe.choices.ndf) &&
                      lobe.anisotropic != IsRound(lobe.choices.ndf);
    const Fresnel fresnel = lobe.choices.fresnel;
    const bool tinted =
        tint_and_roughness && fresnel != Fresnel::kSchlick && fresnel != Fresnel::kNone && !IsCoat(fresnel);
    model.lobes.push_back(
        {kept ? lobe.choices.ndf : ndf, masking, tinted ? Fresnel::kSchlickF82 : Fresnel::kSchlick, ""});
  }
  const bool rough = tint_and_roughness && model.diffuse == Diffuse::kOrenNayar;
  if (model.diffuse != Diffuse::kNone && !rough) model.diffuse = Diffuse::kLambert;
  return model;
}

std::string RefuseForeignLobes(const FittedBrdf& fit) {
  for (const FittedLobe& lobe : fit.lobes()) {
    if (FamilyOf(lobe.choices.ndf) == Family::kAbg)
      return "it has no lobe like 'abg', which falls by a power over decades; take rgl, bsdf-xml or glsl";
  }
  const bool only = std::all_of(fit.lobes().begin(), fit.lobes().end(), [](const FittedLobe& l) { return l.retro; });
  return only && !fit.lobes().empty() ? "it has no lobe about the back direction" : "";
}

std::string RefuseNoLobe(const FittedBrdf& fit) {
  return fit.lobes().empty() ? "it needs a specular lobe, and the fit has none" : RefuseForeignLobes(fit);
}

std::string RefuseUnknownTerms(const FittedBrdf& fit) {
  for (const FittedLobe& lobe : fit.lobes()) {
    const Family family = FamilyOf(lobe.choices.ndf);
    if (family != Family::kKagiwadaKalaba && family != Family::kSphericalGaussian) continue;
    return fmt::format("its shader text knows distributions of slopes, not '{}'",
                       NameOf(NdfChoices(), lobe.choices.ndf));
  }
  const Diffuse diffuse = fit.material().model.diffuse;
  if (diffuse == Diffuse::kMicrofacet) {
    return fmt::format("its shader text has no diffuse part '{}'", NameOf(DiffuseChoices(), diffuse));
  }
  return "";
}

}  // namespace lobefit
