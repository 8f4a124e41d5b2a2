#include "lobefit/validate/recovery.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

std::string ReasonOf(const Trial& trial) {
  if (!trial.error.empty()) return "refused: " + trial.error;
  if (std::isnan(trial.difference)) return "cannot be compared: fit and truth are not the same model";
  if (!trial.degenerate.empty()) return "not determined, and said: " + Join(trial.degenerate, "; ");
  if (!trial.converged) return "did not converge, and said";
  if (std::find(trial.at_bound.begin(), trial.at_bound.end(), true) != trial.at_bound.end())
    return "a parameter is held at its bound, and said";
  const double rms = std::sqrt(2 * trial.cost / static_cast<double>(std::max<std::size_t>(1, trial.samples)));
  if (rms > 1e-6) return fmt::format("a wrong minimum: residuals of {:.1e}", rms);
  return fmt::format("the descent ended at residuals of {:.1e}", rms);
}

}  // namespace

Recovery JudgeRecovery(const Experiment&, const std::vector<Trial>& trials, double limit) {
  Recovery recovery;
  recovery.limit = limit;
  std::vector<double> differences;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Trial& trial = trials[i];
    if (!trial.done) continue;
    ++recovery.trials;
    const double difference = trial.error.empty() && !std::isnan(trial.difference) ? trial.difference : INFINITY;
    differences.push_back(difference);
    if (difference <= limit) continue;
    recovery.exceptions.push_back({i, difference, ReasonOf(trial)});
    const bool wrong = recovery.exceptions.back().reason.starts_with("a wrong minimum");
    if (wrong && trial.minima < 2 && !trial.misfit) ++recovery.silent;
  }
  if (differences.empty()) return recovery;
  std::sort(differences.begin(), differences.end());
  recovery.median = differences[differences.size() / 2];
  recovery.largest = differences.back();
  std::sort(recovery.exceptions.begin(), recovery.exceptions.end(),
            [](const Recovery::Exception& a, const Recovery::Exception& b) { return a.difference > b.difference; });
  return recovery;
}

std::string ToText(const Recovery& recovery, const Experiment& experiment, const std::vector<Trial>& trials) {
  std::string text = fmt::format(
      "{} materials without noise: relative difference of lobes in slope space and of all else, median {:.1e}, largest "
      "{:.1e}\n"
      "{} within {:g}, {} beyond ({} of these wrong without a sign)\n",
      recovery.trials, recovery.median, recovery.largest, recovery.trials - recovery.exceptions.size(), recovery.limit,
      recovery.exceptions.size(), recovery.silent);
  const std::vector<Entry> entries = Entries(experiment.recipe.model, experiment.truth.channels);
  constexpr std::size_t kMostLines = 40;
  for (std::size_t k = 0; k < std::min(kMostLines, recovery.exceptions.size()); ++k) {
    const Recovery::Exception& exception = recovery.exceptions[k];
    text += fmt::format("  trial {}: {:.1e}, {}; truth", exception.trial, exception.difference, exception.reason);
    const Trial& trial = trials[exception.trial];
    for (std::size_t e = 0; e < trial.truth.size(); ++e)
      text += fmt::format(" {} {:.4g}", entries[e].name, trial.truth[e]);
    text += '\n';
  }
  return text;
}

}  // namespace lobefit
