#include "lobefit/material/badge.h"

#include <fmt/format.h>

namespace lobefit {

Badge BadgeOf(const Material& material) {
  if (!material.termination.converged) return {BadgeMark::kBad, "not converged"};
  if (!material.verdict) {
    if (!material.termination.determined) return {BadgeMark::kRough, "converged, not fully determined"};
    return {BadgeMark::kGood, "converged"};
  }
  const Verdict& verdict = *material.verdict;
  std::string error = ", typical error " + PercentText(verdict.typical_error);
  if (material.energy && !material.energy->absolute) error += ", scale free";
  if (verdict.kind == VerdictKind::kDoesNotDescribe) return {BadgeMark::kBad, "does not describe the data" + error};
  if (!material.termination.determined) return {BadgeMark::kRough, "not fully determined" + error};
  switch (verdict.kind) {
    case VerdictKind::kWithinNoise:
      return {BadgeMark::kGood, "within the noise" + error};
    case VerdictKind::kClose:
      return {BadgeMark::kGood, "close" + error};
    default: {
      // What is above 1 by less is no reason for the word.
      const bool creates = material.energy && CreatesEnergy(*material.energy);
      return {BadgeMark::kRough,
              creates ? fmt::format("reflects more than it receives, albedo {:.3g}{}", material.energy->albedo, error)
                      : "rough" + error};
    }
  }
}

}  // namespace lobefit
