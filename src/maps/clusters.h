// Texels parted by what they are made of.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "lobefit/maps/engine/texel.h"

namespace lobefit {

// Logarithms of the albedo of each channel, of f0 (mean over channels) and of alpha (geometric mean); NaN: not known.
inline constexpr std::size_t kFeatures = kMostChannels + 2;
using Features = std::array<double, kFeatures>;
Features FeaturesOf(const TexelFit& fit, int channels);

struct Clusters {
  std::vector<Features> centers;  // the largest first; empty: texels are not parted
  Features unit = {};             // what a distance is measured in
  // Mean square of the known differences; the first where nothing is known.
  std::size_t Nearest(const Features& features) const;
};

// k-means [Lloyd 1982] over the features that are known, from the best of several k-means++ starts [Arthur and
// Vassilvitskii 2007] of fixed seed: the same for the same texels in the same order. Units: interquartile ranges. At
// most `count` clusters; fewer where there are fewer different texels.
Clusters FindClusters(const std::vector<Features>& texels, std::size_t count);

}  // namespace lobefit
