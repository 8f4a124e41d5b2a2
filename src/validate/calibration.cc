#include "lobefit/validate/calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/math/student_t.h"

namespace lobefit {
namespace {

constexpr double kNormal95 = 1.959963984540054;   // quantile of the normal distribution, two-sided
constexpr double kOneSigma = 0.6826894921370859;  // probability within one standard deviation
// Quantile of the normal distribution that one of 1000 numbers exceeds on either side.
constexpr double kChance = 3.290526731491926;

// Errors so large are lost: 6 standard deviations of a normal distribution, and what is as rare under Student's t.
constexpr double kLost = 9.865876450376946e-10;

struct Moments {
  std::size_t count = 0;
  double sum = 0, squares = 0;
  void Add(double x) {
    ++count;
    sum += x;
    squares += x * x;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : NAN; }
  double deviation() const {
    if (count < 2) return NAN;
    const auto n = static_cast<double>(count);
    return std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1)));
  }
  double root_mean_square() const { return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : NAN; }
};

// Collects one kind of interval.
class IntervalTally {
 public:
  void Add(double error, double standard_error, double freedom) {
    const double z = error / standard_error;
    if (freedom != freedom_) {
      freedom_ = freedom;
      quantile_68_ = StudentTQuantile((1 + kOneSigma) / 2, freedom);
      quantile_95_ = StudentTQuantile(0.975, freedom);
    }
    // Student's t of 3 degrees of freedom spreads by 1.7: so that 1 is right for any of them.
    z_.Add(z * kNormal95 / quantile_95_);
    within_68_ += std::fabs(z) <= quantile_68_ ? 1 : 0;
    within_95_ += std::fabs(z) <= quantile_95_ ? 1 : 0;
  }
  IntervalCalibration Result() const {
    return {z_.mean(), z_.deviation(), ShareOf(within_68_, z_.count), ShareOf(within_95_, z_.count)};
  }

 private:
  Moments z_;
  double freedom_ = -1, quantile_68_ = 0, quantile_95_ = 0;
  std::size_t within_68_ = 0, within_95_ = 0;
};

bool IsRunning(const Trial& trial) { return trial.done && trial.error.empty(); }

EntryCalibration CalibrateEntry(const Entry& entry, std::size_t e, const std::vector<Trial>& trials,
                                bool judge_clustered) {
  EntryCalibration result;
  result.entry = entry;
  Moments errors, standard_errors;
  IntervalTally independent, clustered;
  for (const Trial& trial : trials) {
    if (!IsRunning(trial)) continue;
    const double error = trial.value[e] - trial.truth[e], sigma = trial.standard_error[e];
    if (!(sigma > 0) || trial.at_bound[e]) {
      ++result.not_determined;
      continue;
    }
    ++result.trials;
    errors.Add(error);
    standard_errors.Add(sigma);
    independent.Add(error, sigma, trial.independent_freedom[e]);
    const double cluster_sigma = trial.standard_error_clustered[e];
    // Without noise the standard errors are rounding, too.
    const double rounding = 1e-9 * std::max(1.0, std::fabs(trial.truth[e]));
    const double limit = judge_clustered ? StudentTQuantile(1 - kLost, trial.freedom[e]) * cluster_sigma
                                         : StudentTQuantile(1 - kLost, trial.independent_freedom[e]) * sigma;
    if (std::fabs(error) > limit + rounding) ++result.lost;
    if (cluster_sigma > 0) clustered.Add(error, cluster_sigma, trial.freedom[e]);
  }
  result.bias = errors.mean();
  result.spread = errors.deviation();
  result.bias_error = result.spread / std::sqrt(static_cast<double>(std::max<std::size_t>(1, errors.count)));
  result.mean_error = standard_errors.root_mean_square();
  result.independent = independent.Result();
  result.clustered = clustered.Result();
  return result;
}

void JudgeEntry(const EntryCalibration& entry, bool clustered, std::vector<std::string>* failures) {
  const IntervalCalibration& interval = clustered ? entry.clustered : entry.independent;
  const Limits limits = clustered ? kClusteredLimits : kIndependentLimits;
  const Share& share = interval.within_95;
  if (share.total < 2) return;
  const Share wide = ShareOf(share.count, share.total, kChance);
  if (wide.high < limits.coverage_low || wide.low > limits.coverage_high) {
    failures->push_back(fmt::format("{}: its 95 % intervals hold the truth in {:.1f} % of {} trials", entry.entry.name,
                                    100 * share.value, share.total));
  }
  const double slack = 1 + kChance / std::sqrt(2.0 * static_cast<double>(share.total));
  if (interval.z_sd > limits.z_sd_high * slack || interval.z_sd < limits.z_sd_low / slack) {
    failures->push_back(fmt::format("{}: errors spread {:.3f} times as far as the standard error says",
                                    entry.entry.name, interval.z_sd));
  }
}

double Quantile(std::vector<double> values, double q) {
  if (values.empty()) return NAN;
  const auto k = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1) + 0.5);
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

std::string Percent(const Share& share) {
  if (share.total == 0) return "-";
  return fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * share.value, 100 * share.low, 100 * share.high);
}

}  // namespace

Share ShareOf(std::size_t count, std::size_t total, double sigmas) {
  Share share = {count, total, NAN, 0, 1};
  if (total == 0) return share;
  const auto n = static_cast<double>(total);
  share.value = static_cast<double>(count) / n;
  const double z2 = sigmas * sigmas, p = share.value;
  const double center = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = sigmas / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  share.low = count == 0 ? 0 : std::max(0.0, center - half);
  share.high = count == total ? 1 : std::min(1.0, center + half);
  return share;
}

Calibration Calibrate(const Experiment& experiment, const std::vector<Trial>& trials) {
  Calibration result;
  result.planned = trials.size();
  result.judge_clustered = experiment.noise.drift > 0;
  std::vector<double> seconds;
  std::size_t misfits = 0, biased = 0;
  const Trial* first = nullptr;
  for (const Trial& trial : trials) {
    if (!trial.done) continue;
    ++result.done;
    if (!trial.error.empty()) {
      ++result.refused;
      continue;
    }
    if (first == nullptr) first = &trial;
    seconds.push_back(trial.seconds);
    misfits += trial.misfit ? 1 : 0;
    biased += trial.biased ? 1 : 0;
    if (!trial.converged) ++result.not_converged;
    if (!trial.determined || !trial.degenerate.empty()) ++result.not_determined;
    // Rounding: costs that agree to 1e-9, or residuals of 1e-12 on average, are equal.
    const double slack = 1e-9 * trial.cost_at_truth + 1e-24 * static_cast<double>(trial.samples);
    if (trial.cost > trial.cost_at_truth + slack) {
      ++result.wrong_minima;
      if (trial.converged && trial.determined && trial.minima < 2 && !trial.misfit) ++result.wrong_unflagged;
    }
  }
  result.misfit = ShareOf(misfits, seconds.size());
  result.biased = ShareOf(biased, seconds.size());
  result.seconds_median = Quantile(seconds, 0.5);
  result.seconds_95 = Quantile(seconds, 0.95);
  if (first == nullptr) {
    result.failures.emplace_back(result.done == 0 ? "no trial was run" : "no measurement could be fitted");
    return result;
  }
  const std::vector<Entry> entries = Entries(experiment.recipe.model, experiment.truth.channels);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (!first->free[e] || std::isnan(first->truth[e])) continue;
    result.entries.push_back(CalibrateEntry(entries[e], e, trials, result.judge_clustered));
    JudgeEntry(result.entries.back(), result.judge_clustered, &result.failures);
    if (result.entries.back().lost > 0) {
      result.failures.push_back(fmt::format("{}: {} of {} fits are more than 6 standard errors from the truth",
                                            entries[e].name, result.entries.back().lost, result.entries.back().trials));
    }
  }
  if (result.refused > 0) result.failures.push_back(fmt::format("{} measurements could not be fitted", result.refused));
  if (result.not_converged > 0)
    result.failures.push_back(fmt::format("{} fits did not converge", result.not_converged));
  if (result.wrong_unflagged > 0) {
    result.failures.push_back(
        fmt::format("{} fits ended in a wrong minimum and gave no sign of it", result.wrong_unflagged));
  }
  return result;
}

std::string TrialToText(const Experiment& experiment, const Trial& trial) {
  const std::vector<Entry> entries = Entries(experiment.recipe.model, experiment.truth.channels);
  const bool clustered = experiment.noise.drift > 0;
  std::string text = fmt::format("  {:<18} {:>12} {:>12} {:>10} {:>10} {:>8}\n", "parameter", "truth", "value", "error",
                                 clustered ? "clustered" : "stderr", "z");
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (!trial.free[e] || std::isnan(trial.truth[e])) continue;
    const double sigma = clustered ? trial.standard_error_clustered[e] : trial.standard_error[e];
    const double error = trial.value[e] - trial.truth[e];
    text +=
        fmt::format("  {:<18} {:>12.7g} {:>12.7g} {:>10.2e} {:>10.2e} {:>8.2f}{}\n", entries[e].name, trial.truth[e],
                    trial.value[e], error, sigma, error / sigma, trial.at_bound[e] ? "  (at its bound)" : "");
  }
  for (const std::string& words : trial.degenerate) text += "Not determined: " + words + '\n';
  return text;
}

std::string TableOf(const Calibration& calibration) {
  std::string text = fmt::format("{} of {} trials; {:.3g} s a fit (95 % within {:.3g} s)\n", calibration.done,
                                 calibration.planned, calibration.seconds_median, calibration.seconds_95);
  text += fmt::format(
      "wrong minimum: {}, of these without a sign: {}; not converged: {}; something not determined: {}\n",
      calibration.wrong_minima, calibration.wrong_unflagged, calibration.not_converged, calibration.not_determined);
  text += fmt::format("misfit flag raised in % of the fits: {}\n", Percent(calibration.misfit));
  if (calibration.biased.count > 0)
    text += fmt::format("bias of the metric named in % of the fits: {}\n", Percent(calibration.biased));
  std::size_t width = 9;
  for (const EntryCalibration& entry : calibration.entries) width = std::max(width, entry.entry.name.size());
  const char* kind = calibration.judge_clustered ? "clustered by incidence" : "independent samples";
  text += fmt::format("Intervals for {}, shares in % [95 % interval of the share]:\n", kind);
  text += fmt::format("  {:<{}}  {:>10} {:>9} {:>9}  {:>6} {:>6}  {:<20} {:<20}{}\n", "parameter", width, "bias",
                      "spread", "stderr", "z mean", "z sd", "68.3 % intervals", "95 % intervals",
                      calibration.judge_clustered ? " 95 %, if taken as independent" : "");
  for (const EntryCalibration& entry : calibration.entries) {
    const IntervalCalibration& judged = calibration.judge_clustered ? entry.clustered : entry.independent;
    text += fmt::format(
        "  {:<{}}  {:>10.2e} {:>9.2e} {:>9.2e}  {:>6.2f} {:>6.3f}  {:<20} {:<20}{}{}\n", entry.entry.name, width,
        entry.bias, entry.spread, entry.mean_error, judged.z_mean, judged.z_sd, Percent(judged.within_68),
        Percent(judged.within_95), calibration.judge_clustered ? " " + Percent(entry.independent.within_95) : "",
        entry.not_determined > 0 ? fmt::format(" (not determined, and said: {})", entry.not_determined) : "");
  }
  return text;
}

std::string ToText(const Calibration& calibration) {
  std::string text = TableOf(calibration);
  if (calibration.passed()) {
    text += "PASSED: the intervals hold what they say.\n";
  } else {
    text += "FAILED:\n";
    for (const std::string& failure : calibration.failures) text += "  " + failure + "\n";
  }
  return text;
}

}  // namespace lobefit
