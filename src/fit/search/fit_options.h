// How much a fit searches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace lobefit {

struct FitOptions {
  int threads = 1;
  // Descents on the subsample, from the best-ranked starts; five times as many for models of several lobes.
  std::size_t starts = 8;
  std::uint64_t seed = 1;
  // Samples of the subsample on which starts are ranked and descended; fits with at most three times as many use all
  // samples throughout. Larger ones go through a second level of 40 000 samples.
  std::size_t subsample = 2000;
  // Descents on the subsample end after so many steps, and only those that are best by then go on; 0: each goes on to
  // its minimum.
  int scouting_steps = 0;
  // The minimum is only compared with those of other models, to a per cent (ladder.h): descents end where a step gains
  // less than a millionth of the cost.
  bool trial = false;
  // Called after each model that the automatic choice has judged (ladder.h).
  std::function<void()> on_tried;
};

}  // namespace lobefit
