// Results that are asked for by a pointer.
#pragma once

namespace lobefit {

// Writes where the caller asked for it: a null pointer stands for a result that is not wanted.
inline void Store(double* target, double value) {
  if (target != nullptr) *target = value;
}

}  // namespace lobefit
