// Means of any lobe over the discs of source and detector: the closed form for GGX (ggx_mean.h), cubature for every
// other distribution and masking.
#pragma once

#include <vector>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/instrument/ggx_mean.h"

namespace lobefit {

// How one lobe is averaged in one call. Made from a width that does not change while a fit descends, so that what is
// minimised stays one function.
struct LobeMeanRule {
  bool closed_form = true;
  GgxMeanRule ggx;
  // Cubature: one pair of directions each, as the multiples that GgxMeanRule::Point has, with its weight.
  std::vector<GgxMeanRule::Point> points;
  FresnelArgument argument = FresnelArgument::kSchlickPower;
  // RelativeDiscWidth of both discs together.
  double relative_width = 0;
};

// Whether a lobe has the closed form; else by cubature, which is refused (see below) for lobes that are narrower than
// kMostRelativeWidth allows.
bool HasMeanInClosedForm(const Lobe& lobe);
inline constexpr double kMostRelativeWidth = 2;

// `alpha`: the narrowest width in slope space that the lobe may get; `cos_d`: the smallest cosine of the difference
// angle of the samples. The cubature keeps 1e-3 of the lobe's peak. Throws InputError where the discs are wider than
// kMostRelativeWidth lobes and there is no closed form. `aperture` must not be a point.
LobeMeanRule MakeLobeMeanRule(const Lobe& lobe, const Aperture& aperture, double alpha, double cos_d);

// As GgxMeanLobe, any lobe: gradients are ShapeParameters(lobe) arrays.
void MeanLobe(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape, const LobeMeanRule& rule,
              const LobeMeans& means);

}  // namespace lobefit
