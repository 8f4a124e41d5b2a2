// Samples that a measurement holds but a fit cannot use: set aside before the fit, counted by reason, shown in every
// report.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace lobefit {

enum class SetAsideReason {
  kHole,              // the file marks the value as not measured
  kNotFinite,         // NaN or infinity where a number belongs
  kBelowHorizon,      // a direction at or below the surface
  kNegative,          // a negative value that the metric cannot take
  kBeyondAngleLimit,  // steeper than the angle limit of the recipe
  kOutsideSelection,  // not in the part of the file that the user chose
  kDuplicate,         // the same pair of directions again
  kFlagged,           // the file itself flags the sample as unreliable
  kDiscAtHorizon,     // the disc of source or detector about a direction reaches the horizon
};
inline constexpr int kSetAsideReasons = 9;

// Key in JSON documents ("below_horizon") and words for people ("direction below the horizon").
std::string_view Key(SetAsideReason reason);
std::string_view Words(SetAsideReason reason);

// Number of samples by reason.
class SetAside {
 public:
  void Add(SetAsideReason reason, std::size_t count = 1) { counts_[static_cast<std::size_t>(reason)] += count; }
  std::size_t operator[](SetAsideReason reason) const { return counts_[static_cast<std::size_t>(reason)]; }
  std::size_t total() const;

 private:
  std::array<std::size_t, kSetAsideReasons> counts_ = {};
};

}  // namespace lobefit
