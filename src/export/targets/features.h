// The features of a fit that targets may lose, as rows of their tables; and what several targets share.
#pragma once

#include <string>
#include <vector>

#include "lobefit/export/targets/target.h"

namespace lobefit {

// Rows for every feature that this fit has, all exact: shape, rotation, tilt, masking, Fresnel, diffuse, second lobe,
// channels.
std::vector<Carried> AllExactly(const FittedBrdf& fit, const std::string& note);
std::vector<Carried> CarriesModelItself(const FittedBrdf& fit);
// All within the resolution of a table.
std::vector<Carried> CarriesTable(const FittedBrdf& fit);

// Changes the row of `feature` where the fit has it.
void Mark(std::vector<Carried>* rows, Feature feature, Carries how, const std::string& note);

// What all targets share that hold GGX lobes in a text: `masking` is the fit's choice that equals theirs (kImplicit:
// none does), which `own_masking` describes.
std::vector<Carried> CarriesLobes(const FittedBrdf& fit, Masking masking, const std::string& own_masking);
// The same of conductors in a random choice with a diffuse material, with one tangent for all (pbrt, Mitsuba).
std::vector<Carried> CarriesConductors(const FittedBrdf& fit, Masking masking, const std::string& own_masking);
// The same of one lobe with a base colour for metal and diffuse base (OpenPBR, glTF). `f0` is the reflectance at normal
// incidence that was written.
std::vector<Carried> CarriesMetalBase(const FittedBrdf& fit, std::vector<Carried> rows, const std::vector<double>& f0);

bool AllHave(const FittedBrdf& fit, Fresnel fresnel);
// The row of an Oren-Nayar diffuse part that goes to MaterialX' own node.
void MarkOrenNayar(const FittedBrdf& fit, std::vector<Carried>* rows);

// The model that is fitted for a target: GGX with this masking, Schlick's term, the strongest lobes that it holds.
inline constexpr std::size_t kAnyNumber = 100;
// `tint_and_roughness`: it has an edge tint for Fresnel terms that are not Schlick's, and Oren-Nayar diffuse parts.
Model OwnModel(const FittedBrdf& fit, Masking masking, std::size_t most_lobes, bool tint_and_roughness = false);

// "" or that all lobes lie about the back direction, or that one is no lobe of facets.
std::string RefuseForeignLobes(const FittedBrdf& fit);
// "" or that, or that the target needs a lobe.
std::string RefuseNoLobe(const FittedBrdf& fit);
// "" or the name of a distribution, masking or Fresnel term that shader text does not know.
std::string RefuseUnknownTerms(const FittedBrdf& fit);

}  // namespace lobefit
