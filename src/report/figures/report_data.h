// What every panel of a report draws from: the measurement, the fitted model, and the model's values at the samples.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/fit/objective/reading.h"
#include "lobefit/material/material.h"
#include "lobefit/measurement/measurement.h"
#include "lobefit/plot/canvas.h"
#include "lobefit/report/figures/fitted_function.h"
#include "lobefit/report/figures/isotropic_lookup.h"
#include "lobefit/report/figures/slices.h"

namespace lobefit {

struct ReportData {
  // Throws InputError where the channels of the two do not agree or the measurement holds no sample. Both must outlive
  // the object.
  ReportData(const Material& fitted_material, const Measurement& measured, int thread_count);

  const Material& material;
  const Measurement& measurement;
  FittedFunction fitted;           // the surface
  std::optional<Reading> reading;  // where the fit knows an instrument, what that reads of the surface
  Staying staying;
  int threads;
  // fitted_values[channel][sample], f_r in 1/sr: readings, where there is an instrument.
  std::vector<std::vector<float>> fitted_values;
  // One a channel: colour and name for people ("R", "550 nm").
  std::vector<Rgb> channel_colors;
  std::vector<std::string> channel_names;
  // Channels that figures show where there is no room for all: all of up to three, else first, middle and last.
  std::vector<std::size_t> shown_channels;
  std::vector<double> display_weights;  // one a channel, sum 1

  std::size_t channels() const { return fitted.channels(); }
  // Found when first asked for, by any thread: the slices, and the values of an isotropic measurement between samples.
  const Slices& slices() const;
  const IsotropicLookup& lookup() const;
  // What stands beside measured values: readings, or f_r of the surface where there is no instrument. Directions above
  // the horizon; values[c][i].
  void Read(const DirectionArrays& directions, const double* sample_azimuth,
            std::vector<std::vector<double>>* values) const;
  void Read(const Vec3& wi, const Vec3& wo, double* values) const;
  // One number for pictures: luminance of R, G, B, the Y of X, Y, Z, else the mean of the channels.
  double Display(const std::vector<double>& f_r) const;
  double Display(const std::vector<std::vector<double>>& values, std::size_t sample) const;
  // ln(measured / fitted); -infinity for a measured value of zero or less, NaN where the fitted value is zero.
  double LogRatio(std::size_t channel, std::size_t sample) const;

 private:
  mutable std::once_flag slices_once_, lookup_once_;
  mutable std::optional<Slices> slices_;
  mutable std::optional<IsotropicLookup> lookup_;
};

// Quantiles of ln(measured / fitted) of one channel over theta_h, as far as samples are there.
class ResidualBand {
 public:
  ResidualBand(const ReportData& data, std::size_t channel);
  struct Quantiles {
    double low = 0, middle = 0, high = 0;  // 5, 50 and 95 %
  };
  // theta_h in radians; interpolated between the centres of bins, constant beyond the first and last.
  Quantiles At(double theta_h) const;

 private:
  std::vector<double> centers_;
  std::vector<Quantiles> quantiles_;
};

// The q-quantile (0..1) of values, which are reordered; NaN if there is none. Linear between neighbours.
double Quantile(std::vector<double>* values, double q);

}  // namespace lobefit
