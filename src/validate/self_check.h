// A validation that a user runs after installing: well under a minute on two processors.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace lobefit {

struct SelfCheckLine {
  std::string what, result;
  bool passed = false;
};

// Trials in all, for a progress bar.
inline constexpr std::size_t kSelfCheckTrials = 30 + 150 + 100 + 30;

// Recovery without noise; intervals under independent noise and under drift; the misfit flag on a wrong model. Fixed
// seeds: the result does not depend on threads. Stops early, and does not pass, once `stop` is set.
std::vector<SelfCheckLine> SelfCheck(int threads, const std::function<void()>& advance, const std::atomic<bool>& stop);

}  // namespace lobefit
