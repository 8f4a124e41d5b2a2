// What to fit to each texel: fits/maps/*.toml.
#pragma once

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>

#include "lobefit/maps/engine/texel.h"

namespace lobefit {

// The numbers that texels may share: the normal, the ellipsoid's tilt, all numbers of the width, albedo, f0.
enum class Shared { kNormal, kTilt, kAlpha, kDiffuse, kF0 };
inline constexpr std::size_t kSharedKinds = 5;
enum class ShareOver { kTexel, kCluster, kImage };

struct MapShares {
  std::array<ShareOver, kSharedKinds> over = {};
  std::size_t clusters = 1;

  ShareOver Of(Shared kind) const { return over[static_cast<std::size_t>(kind)]; }
  // Whether texels are parted into clusters.
  bool Parts() const { return std::find(over.begin(), over.end(), ShareOver::kCluster) != over.end(); }
  bool Any() const { return over != std::array<ShareOver, kSharedKinds>{}; }
};

// Flags of what is shared over `over`.
HeldNumbers HeldOver(const MapShares& shares, ShareOver over);

struct MapRecipe {
  std::string name = "ggx-maps";
  MapRules rules;  // its `schlick` follows from the stack
  MapShares shares;
  std::filesystem::path normal_map;  // of normals that are held; empty: none
};

// Keys: model = lambert, ggx, ggx-anisotropic, ellipsoid; normal = free, fixed, map:FILE (beside the recipe); lobe =
// by-evidence, always; loss, shadow, least_alpha; [share] with normal, tilt, alpha, diffuse, f0 = texel, cluster:N,
// image. Throws InputError with file and line; UsageError for what contradicts itself.
MapRecipe ReadMapRecipe(const std::filesystem::path& file);

// One line with everything that changes a result, for digests and documents.
std::string RecipeText(const MapRecipe& recipe);

}  // namespace lobefit
