#include "lobefit/report/figures/report_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

const Material& Checked(const Material& material, const Measurement& measurement) {
  if (material.channels != measurement.channels.names) {
    throw InputError(measurement.source + ": the measurement has the channels " + JoinSome(measurement.channels.names) +
                     ", the material has " + JoinSome(material.channels) +
                     "; give the measurement that the material was fitted to");
  }
  // One sample lies on any curve.
  if (measurement.samples.size() < 2) {
    throw InputError(
        fmt::format("{}: {} within the angle limit; a report needs two or more: check the selection and "
                    "--theta-max of the fit",
                    measurement.source, measurement.samples.size() == 0 ? "no sample" : "only one sample"));
  }
  return material;
}

constexpr std::size_t kPiece = 16384;

// "550 nm", "3.5 µm".
std::string WavelengthName(double nanometres) {
  if (nanometres >= 1e4) return Number(nanometres / 1000, 3) + " µm";
  const double tenths = std::round(nanometres * 10) / 10;
  return (tenths == std::round(tenths) ? std::to_string(std::lround(tenths)) : Number(tenths, 4)) + " nm";
}

}  // namespace

ReportData::ReportData(const Material& fitted_material, const Measurement& measured, int thread_count)
    : material(Checked(fitted_material, measured)),
      measurement(measured),
      fitted(fitted_material),
      staying(GroupByStayingDirection(measured)),
      threads(thread_count) {
  if (material.instrument && !material.sel) reading.emplace(material, measurement.listed_side);
  const Samples& samples = measurement.samples;
  fitted_values.assign(channels(), std::vector<float>(samples.size()));
  ParallelFor((samples.size() + kPiece - 1) / kPiece, threads, [&](std::size_t piece) {
    const std::size_t begin = piece * kPiece, count = std::min(kPiece, samples.size() - begin);
    const DirectionArrays directions = {&samples.wi_x[begin],
                                        &samples.wi_y[begin],
                                        &samples.wi_z[begin],
                                        &samples.wo_x[begin],
                                        &samples.wo_y[begin],
                                        &samples.wo_z[begin],
                                        count};
    std::vector<std::vector<double>> f_r;
    Read(directions, samples.sample_azimuth.empty() ? nullptr : &samples.sample_azimuth[begin], &f_r);
    for (std::size_t c = 0; c < channels(); ++c) {
      for (std::size_t i = 0; i < count; ++i) fitted_values[c][begin + i] = static_cast<float>(f_r[c][i]);
    }
  });
  const std::vector<std::string>& names = measurement.channels.names;
  if (names == std::vector<std::string>{"R", "G", "B"}) {
    display_weights = {0.2126, 0.7152, 0.0722};  // ITU-R BT.709
  } else if (names == std::vector<std::string>{"X", "Y", "Z"}) {
    display_weights = {0, 1, 0};
  } else {
    display_weights.assign(channels(), 1.0 / static_cast<double>(channels()));
  }
  channel_colors = ChannelColors(measurement.channels.names);
  for (std::size_t c = 0; c < channels(); ++c) {
    const bool spectral = c < measurement.channels.wavelengths_nm.size();
    channel_names.push_back(spectral ? WavelengthName(measurement.channels.wavelengths_nm[c])
                                     : measurement.channels.names[c]);
  }
  if (channels() <= 3) {
    for (std::size_t c = 0; c < channels(); ++c) shown_channels.push_back(c);
  } else {
    shown_channels = {0, (channels() - 1) / 2, channels() - 1};
  }
}

const Slices& ReportData::slices() const {
  std::call_once(slices_once_, [this] { slices_ = GatherSlices(measurement, staying); });
  return *slices_;
}

const IsotropicLookup& ReportData::lookup() const {
  std::call_once(lookup_once_, [this] { lookup_.emplace(measurement); });
  return *lookup_;
}

void ReportData::Read(const DirectionArrays& directions, const double* sample_azimuth,
                      std::vector<std::vector<double>>* values) const {
  if (reading) {
    reading->Evaluate(directions, sample_azimuth, values);
  } else {
    fitted.Evaluate(directions, values);
  }
}

void ReportData::Read(const Vec3& wi, const Vec3& wo, double* values) const {
  if (!reading) {
    fitted.Evaluate(wi, wo, values);
    return;
  }
  std::fill_n(values, channels(), 0.0);
  if (!(wi.z > 0 && wo.z > 0)) return;
  std::vector<std::vector<double>> all;
  reading->Evaluate({&wi.x, &wi.y, &wi.z, &wo.x, &wo.y, &wo.z, 1}, nullptr, &all);
  for (std::size_t c = 0; c < channels(); ++c) values[c] = all[c][0];
}

double ReportData::Display(const std::vector<double>& f_r) const {
  double sum = 0;
  for (std::size_t c = 0; c < display_weights.size(); ++c) sum += display_weights[c] * f_r[c];
  return sum;
}

double ReportData::Display(const std::vector<std::vector<double>>& values, std::size_t sample) const {
  double sum = 0;
  for (std::size_t c = 0; c < display_weights.size(); ++c) sum += display_weights[c] * values[c][sample];
  return sum;
}

double ReportData::LogRatio(std::size_t channel, std::size_t sample) const {
  const double f = fitted_values[channel][sample], m = measurement.samples.values[channel][sample];
  if (!(f > 0)) return std::numeric_limits<double>::quiet_NaN();
  return m > 0 ? std::log(m / f) : -std::numeric_limits<double>::infinity();
}

double Quantile(std::vector<double>* values, double q) {
  if (values->empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = q * static_cast<double>(values->size() - 1);
  const auto below = static_cast<std::size_t>(at);
  std::nth_element(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(below), values->end());
  const double low = (*values)[below], f = at - static_cast<double>(below);
  if (f == 0) return low;
  const double high = *std::min_element(values->begin() + static_cast<std::ptrdiff_t>(below) + 1, values->end());
  return low == high || !std::isfinite(low) ? low : low + f * (high - low);
}

ResidualBand::ResidualBand(const ReportData& data, std::size_t channel) {
  constexpr std::array<double, 19> kEdges = {0, 1, 2, 3, 4, 6, 8, 10, 13, 16, 20, 25, 30, 36, 43, 50, 60, 70, 90};
  // Samples of a bin; fewer join the next one. The outer quantiles of two dozen samples of heavy-tailed residuals jump
  // from bin to bin by more than they say.
  const std::size_t enough = std::clamp<std::size_t>(data.measurement.samples.size() / 8, 24, 200);
  constexpr std::size_t kTaken = 1 << 18;  // samples taken in all, evenly over the file
  const Samples& samples = data.measurement.samples;
  std::vector<std::vector<double>> ratios(kEdges.size() - 1);
  std::vector<double> sums(kEdges.size() - 1);
  const std::size_t step = 1 + samples.size() / kTaken;
  for (std::size_t i = 0; i < samples.size(); i += step) {
    const double theta_h = RadiansToDegrees(PolarAngle(HalfVector(samples.wi(i), samples.wo(i))));
    const auto edge = std::upper_bound(kEdges.begin(), kEdges.end(), theta_h);
    const auto bin =
        std::clamp<std::ptrdiff_t>(edge - kEdges.begin() - 1, 0, static_cast<std::ptrdiff_t>(ratios.size()) - 1);
    const double ratio = data.LogRatio(channel, i);
    if (std::isnan(ratio)) continue;
    ratios[static_cast<std::size_t>(bin)].push_back(ratio);
    sums[static_cast<std::size_t>(bin)] += theta_h;
  }
  // Values of zero or less have no logarithm: they count as the lowest residual that has one.
  double lowest = std::numeric_limits<double>::infinity();
  for (const std::vector<double>& bin : ratios) {
    for (const double r : bin) lowest = std::isfinite(r) ? std::min(lowest, r) : lowest;
  }
  for (std::vector<double>& bin : ratios) {
    for (double& r : bin) r = std::isfinite(r) || !std::isfinite(lowest) ? r : lowest;
  }
  std::vector<double> gathered;
  double sum = 0;
  const auto end_bin = [&] {
    centers_.push_back(DegreesToRadians(sum / static_cast<double>(gathered.size())));
    quantiles_.push_back({Quantile(&gathered, 0.05), Quantile(&gathered, 0.5), Quantile(&gathered, 0.95)});
    gathered.clear();
    sum = 0;
  };
  std::size_t left = 0;  // samples of this bin and of those after it
  for (const std::vector<double>& bin : ratios) left += bin.size();
  for (std::size_t bin = 0; bin < ratios.size(); ++bin) {
    gathered.insert(gathered.end(), ratios[bin].begin(), ratios[bin].end());
    sum += sums[bin];
    left -= ratios[bin].size();
    // The last ones are no bin of their own either.
    if (gathered.size() >= enough && left >= enough) end_bin();
  }
  if (!gathered.empty()) end_bin();
}

ResidualBand::Quantiles ResidualBand::At(double theta_h) const {
  if (centers_.empty()) return {};
  const auto above =
      static_cast<std::size_t>(std::upper_bound(centers_.begin(), centers_.end(), theta_h) - centers_.begin());
  if (above == 0) return quantiles_.front();
  if (above == centers_.size()) return quantiles_.back();
  const double f = (theta_h - centers_[above - 1]) / (centers_[above] - centers_[above - 1]);
  const auto mix = [f](double a, double b) {
    return std::isfinite(a) && std::isfinite(b) ? a + f * (b - a) : std::min(a, b);
  };
  const Quantiles &a = quantiles_[above - 1], &b = quantiles_[above];
  return {mix(a.low, b.low), mix(a.middle, b.middle), mix(a.high, b.high)};
}

}  // namespace lobefit
