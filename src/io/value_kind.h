// What a file's numbers are, by name and as the factor that turns them into f_r.
#pragma once

#include <string>

#include "lobefit/io/read.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// The name on the command line: "f", "f-cos-o", ...
inline std::string Name(ValueKind kind) {
  switch (kind) {
    case ValueKind::kBrdf:
      return "f";
    case ValueKind::kBrdfCosO:
      return "f-cos-o";
    case ValueKind::kBrdfCosI:
      return "f-cos-i";
    case ValueKind::kReflectanceFactor:
      return "pi-f";
    case ValueKind::kIntensity:
      return "intensity";
  }
  return "f";
}

// f_r / value. A direction at or below the horizon, which is set aside anyway, gives 1 for its cosine.
inline double BrdfFactor(ValueKind kind, double cos_theta_i, double cos_theta_o) {
  switch (kind) {
    case ValueKind::kBrdf:
      return 1;
    case ValueKind::kBrdfCosO:
    case ValueKind::kIntensity:
      return cos_theta_o > 0 ? 1 / cos_theta_o : 1;
    case ValueKind::kBrdfCosI:
      return cos_theta_i > 0 ? 1 / cos_theta_i : 1;
    case ValueKind::kReflectanceFactor:
      return kInvPi;
  }
  return 1;
}

}  // namespace lobefit
