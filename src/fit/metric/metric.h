// The metrics: how a value f becomes a residual against the measured one m. One table, one row a metric; everything
// that fits, judges or reports takes from here what differs between them.
#pragma once

#include <vector>

#include "lobefit/base/choice.h"
#include "lobefit/fit/metric/transform.h"

namespace lobefit {

// What the fit minimises: the sum of squared residuals, with f the model's and m the measured f_r of a sample and
// channel.
enum class Metric {
  kLog,       // ln(1 + f cos_theta_i) - ln(1 + m cos_theta_i)
  kCubeRoot,  // cbrt(f cos_theta_i) - cbrt(m cos_theta_i)
  kRelative,  // (f - m) / m; m > 0
  kCosineL2,  // (f - m) cos_theta_i
  kNgan,      // (f - m) cos_theta_i, weight sin_theta_i sin_theta_o [Ngan 2005, as in common use]
  kLowLog,    // ln(1 + f cos_theta_i) - ln(1 + m cos_theta_i), weight sin_theta_i [Low 2012, as in common use]
  kAsinh,     // asinh(f cos_theta_i / knee) - asinh(m cos_theta_i / knee), less the mean that the noise gives it
              // (transform.h)
};

// Noise of a reading v = f_r cos_theta_i: variance floor^2 + poisson |v| + (relative v)^2.
struct NoiseModel {
  double floor = 0;     // 1/sr
  double relative = 0;  // of 1
  double poisson = 0;   // 1/sr, the reading that one count stands for
  // As asinh needs it.
  bool IsKnown() const { return (floor > 0 || poisson > 0) && relative > 0; }
  // Of the terms that are no share of the value.
  double DarkVarianceAt(double v) const { return floor * floor + poisson * (v < 0 ? -v : v); }
  double VarianceAt(double v) const { return DarkVarianceAt(v) + relative * relative * v * v; }
};

struct MetricRow {
  Metric metric;
  const char* name;         // as recipes, documents and help spell it
  const char* description;  // one line for people
  Curve curve;
  bool sin_i, sin_o;  // the squared residual is weighted by the sine of these polar angles
};

// In the order of the enumeration.
const std::vector<MetricRow>& MetricTable();
const MetricRow& RowOf(Metric metric);
const std::vector<Choice<Metric>>& MetricChoices();

// The transform of a metric. Of kAsinh without counting noise: knee floor / relative, for which the residual has the
// same standard deviation, `relative`, at every value [asinh as the variance-stabilising transform of this noise]. With
// it: a knee of no fewer than 30 counts, above which the curve's bend takes no mean that is not taken out of it
// (Transform), and weights that level the residuals (sigma_weights.h). The table's other rows do not depend on the
// noise. Domain: kAsinh needs a known noise.
Transform TransformOf(Metric metric, const NoiseModel& noise);

// Weight by the metric's sines of a sample, from the cosines of its polar angles.
double AngularWeight(Metric metric, double cos_theta_i, double cos_theta_o);

}  // namespace lobefit
