// Means of any lobe over the discs of source and detector: the closed form for GGX (ggx_mean.h), cubature for every
// other distribution and masking.
#pragma once

#include <memory>
#include <vector>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/instrument/ggx_mean.h"
#include "lobefit/core/instrument/region_mean.h"

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
  // How many points it has: nodes of the mixture of discs, rings (0: the seven points) and azimuths of the cubature.
  int nodes = 1, rings = 0, azimuths = 0;
  // In closed form and of the flux: where the cosine of the region's side is at most `cut_below` the mean is over this
  // region: of a rectangular detector everywhere, of a single disc where the horizon cuts it.
  std::shared_ptr<const DirectionRegion> region = nullptr;
  bool region_of_source = false;
  double cut_below = -1;
  double reach = 0;  // sine of the angle to its farthest point: the horizon cuts no region that stands higher
};

// Whether a lobe has the closed form; else by cubature, which is refused (see below) for lobes that are narrower than
// kMostRelativeWidth allows.
bool HasMeanInClosedForm(const Lobe& lobe);
inline constexpr double kMostRelativeWidth = 2;

// `alpha`: the narrowest width in slope space that the lobe may get; `cos_d`: the smallest cosine of the difference
// angle of the samples. The cubature keeps 1e-3 of the lobe's peak. Throws InputError where the discs are wider than
// kMostRelativeWidth lobes, or a detector is rectangular, and there is no closed form. `aperture` must not be a point;
// a rectangular detector goes with a source that is one, and the flux mean.
LobeMeanRule MakeLobeMeanRule(const Lobe& lobe, const Aperture& aperture, double alpha, double cos_d);

// The rule with as many points over discs of other half angles: what a fit that moves them minimises stays one
// function. A disc that is a point stays one.
LobeMeanRule WithDiscs(const LobeMeanRule& rule, const Aperture& aperture);

// factor[i]: what a constant f_r reads over the rule's region (ConstantMean), 1 where no horizon cuts it.
void ConstantMeans(const DirectionArrays& directions, const LobeMeanRule& rule, double* factor);

// As GgxMeanLobe, any lobe: gradients are ShapeParameters(lobe) arrays.
void MeanLobe(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape, const LobeMeanRule& rule,
              const LobeMeans& means);

}  // namespace lobefit
