// The masking-shadowing terms that this program knows.
#pragma once

namespace lobefit {

// Masking and shadowing for both directions, G2.
enum class Masking {
  kSmithSeparable,  // G1(wi) G1(wo) [Heitz eq 98], each min(1, cos / sigma) [Walter eq 5-6]: a kink of tilted lobes
  kSmithUnclamped,  // the same without the min: smooth, but energy can be created on one side of a tilted lobe
  kSmithHeight,     // height-correlated [Heitz eq 99] with 1 + Lambda = max(1, sigma / cos)
  kSmithDirection,  // direction-correlated [Heitz eq 100, corrected]; evaluated only, no choice of a recipe
  kSmithHeightDirection,  // height- and direction-correlated [Heitz eq 101]; a kink where both Lambdas are equal
  kVCavity,               // [Heitz eq 49-50]; for distributions with D(x, y, z) = D(-x, -y, z)
  // For comparison, not derived from a surface:
  kImplicit,      // cos_theta_i cos_theta_o [Heitz eq 56]
  kSchlickSmith,  // [Schlick 1994] with m^2 the product of the widths in slope space
  kKelemen,       // cos_theta_i cos_theta_o / (wi . wh)^2 [Heitz eq 58]
  kNone,          // of lobes that are f_r themselves (abg_lobe.h)
};

// Made of the distribution's own Lambda.
constexpr bool IsSmith(Masking masking) {
  switch (masking) {
    case Masking::kSmithSeparable:
    case Masking::kSmithUnclamped:
    case Masking::kSmithHeight:
    case Masking::kSmithDirection:
    case Masking::kSmithHeightDirection:
      return true;
    default:
      return false;
  }
}

}  // namespace lobefit
