#include "lobefit/export/targets/features.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lobefit {

std::vector<Carried> AllExactly(const FittedBrdf& fit, const std::string& note) {
  std::vector<Carried> rows = {{"shape", Carries::kExactly, note}};
  const auto any = [&](auto&& predicate) { return std::any_of(fit.lobes().begin(), fit.lobes().end(), predicate); };
  if (any([](const FittedLobe& lobe) { return lobe.anisotropic && lobe.rotation != 0; })) {
    rows.push_back({"rotation", Carries::kExactly, note});
  }
  if (fit.IsTilted()) rows.push_back({"tilt", Carries::kExactly, note});
  rows.push_back({"masking", Carries::kExactly, note});
  rows.push_back({"Fresnel", Carries::kExactly, note});
  if (fit.HasDiffuse()) rows.push_back({"diffuse", Carries::kExactly, note});
  if (fit.lobes().size() > 1) rows.push_back({"second lobe", Carries::kExactly, note});
  rows.push_back({"channels", Carries::kExactly, note});
  return rows;
}

void Mark(std::vector<Carried>* rows, const std::string& feature, Carries how, const std::string& note) {
  for (Carried& row : *rows) {
    if (row.feature == feature) row = {feature, how, note};
  }
}

std::string RefuseSpectra(const FittedBrdf& fit) {
  if (fit.IsRgbOrGrey()) return "";
  return fmt::format(
      "it holds R, G and B (or one grey channel), and the fit has {} channel{} ({}{}); fit with --channels rgb",
      fit.material().channels.size(), fit.material().channels.size() == 1 ? "" : "s", fit.material().channels[0],
      fit.material().channels.size() > 1 ? ", ..." : "");
}

std::string RefuseUnknownTerms(const FittedBrdf& fit) {
  for (const FittedLobe& lobe : fit.lobes()) {
    const NdfFamily family = FamilyOf(lobe.choices.ndf);
    if (family == NdfFamily::kGgx || family == NdfFamily::kBeckmann) continue;
    return fmt::format("its shader text knows GGX and Beckmann distributions, not '{}'",
                       NameOf(NdfChoices(), lobe.choices.ndf));
  }
  if (fit.material().model.diffuse == Diffuse::kMicrofacet) {
    return "its shader text knows Lambertian diffuse parts only, not microfacet ones";
  }
  return "";
}

}  // namespace lobefit
