#include "lobefit/measurement/set_aside.h"

#include <numeric>

namespace lobefit {
namespace {

struct Names {
  std::string_view key, words;
};
constexpr std::array<Names, kSetAsideReasons> kNames = {{
    {"hole", "marked as not measured"},
    {"not_finite", "not a finite number"},
    {"below_horizon", "direction below the horizon"},
    {"negative", "negative value that the metric cannot take"},
    {"beyond_angle_limit", "beyond the angle limit"},
    {"outside_selection", "outside the chosen part of the file"},
    {"duplicate", "pair of directions that occurs before"},
    {"flagged", "flagged as unreliable by the file"},
    {"disc_at_horizon", "source or detector reaches the horizon"},
}};

}  // namespace

std::string_view Key(SetAsideReason reason) { return kNames[static_cast<std::size_t>(reason)].key; }
std::string_view Words(SetAsideReason reason) { return kNames[static_cast<std::size_t>(reason)].words; }

std::size_t SetAside::total() const { return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0}); }

}  // namespace lobefit
