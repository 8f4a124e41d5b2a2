#include "lobefit/material/badge.h"

namespace lobefit {

Badge BadgeOf(const Material& material) {
  if (!material.termination.converged) return {BadgeMark::kBad, "not converged"};
  if (!material.verdict) {
    if (!material.termination.determined) return {BadgeMark::kRough, "converged, not fully determined"};
    return {BadgeMark::kGood, "converged"};
  }
  const Verdict& verdict = *material.verdict;
  const std::string error = ", typical error " + PercentText(verdict.typical_error);
  if (verdict.kind == VerdictKind::kDoesNotDescribe) return {BadgeMark::kBad, "does not describe the data" + error};
  if (!material.termination.determined) return {BadgeMark::kRough, "not fully determined" + error};
  switch (verdict.kind) {
    case VerdictKind::kWithinNoise:
      return {BadgeMark::kGood, "within the noise" + error};
    case VerdictKind::kClose:
      return {BadgeMark::kGood, "close" + error};
    default:
      return {BadgeMark::kRough, "rough" + error};
  }
}

}  // namespace lobefit
