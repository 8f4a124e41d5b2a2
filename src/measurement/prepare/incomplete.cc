#include "lobefit/measurement/prepare/incomplete.h"

#include <cmath>

namespace lobefit {

void DropIncomplete(Measurement* measurement) {
  Samples& samples = measurement->samples;
  std::vector<std::uint8_t> keep(samples.size(), 1);
  std::size_t dropped = 0;
  for (const std::vector<double>& values : samples.values) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i]) || keep[i] == 0) continue;
      keep[i] = 0;
      ++dropped;
      measurement->LeaveOut(samples.wi(i), samples.wo(i), LeftOutReason::kNoValue);
    }
  }
  if (dropped == 0) return;
  measurement->set_aside.Add(SetAsideReason::kHole, dropped);
  samples.Keep(keep);
}

}  // namespace lobefit
