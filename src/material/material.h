// The result of a fit: parameters with their intervals, how good it is, and where it came from. It is what
// *.material.json holds and what reports and exporters take.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/core/sel/sel_table.h"

namespace lobefit {

// One fitted parameter, inside units (radians). Each vector has one entry, or one a channel.
struct FittedParameter {
  std::vector<double> values;
  // Standard error, robust to noise that differs from sample to sample. NaN: fixed, tied or not determined.
  std::vector<double> standard_error;
  // Standard error where the samples of one incident direction are taken as dependent (sandwich, clustered by
  // incidence). NaN as above, or with fewer than two incidences.
  std::vector<double> standard_error_clustered;
  // Degrees of freedom of that error: 95 % within this quantile of Student's t. NaN where it is NaN.
  std::vector<double> freedom;
  // The same of `standard_error`: few where few samples decide, or few gains of which a drift was estimated. Empty or
  // infinite: its errors are normal.
  std::vector<double> independent_freedom = {};
  bool free = true;
  bool at_bound = false;
  // Standard error where the samples of one file of a series are taken as dependent too, and its degrees of freedom
  // (fit/errors/file_clusters.h). Empty where there are no files that say more than incidences.
  std::vector<double> standard_error_by_file = {}, freedom_by_file = {};
};

// Error of the model under one metric: root mean square over all samples and channels, with the weights of the fit.
struct MetricError {
  std::string metric;
  double rms = 0;
};

// A distinct minimum that the search found, best first.
struct Minimum {
  double cost = 0;                                         // half the sum of squares, on all samples
  std::vector<std::pair<std::string, double>> parameters;  // JSON names and outside values of the shape
  std::size_t starts = 0;                                  // number of starts that ended there
};

struct Termination {
  bool converged = false;
  bool determined = false;
  std::string message;  // in words
  int iterations = 0;
};

// Whether the residuals are structured: what the noise does not explain says that the model is not the one behind the
// data, whatever the standard errors say. See fit/misfit.h for the test.
struct Misfit {
  bool tested = false;
  bool flagged = false;
  double probability = 1;  // of a bin of residuals so far from zero if the model were right
  double size = 0;         // mean residual of that bin over the root mean square of all residuals
  std::string where;       // that bin, in words
};

// How well the model describes the data, whatever the solver says; fit/verdict.h has the thresholds and why.
enum class VerdictKind { kWithinNoise, kClose, kRough, kDoesNotDescribe };
struct Verdict {
  VerdictKind kind = VerdictKind::kClose;
  double typical_error = 0;  // median |ln f / m| over values above the noise, as a relative error
  double noise = 0;          // relative, of the data themselves; NaN where they do not tell
  double explained = 0;      // share of the measurement's squares under the metric, less the model's
  std::string advice;        // what to try next, in words; empty: nothing
};
const std::vector<Choice<VerdictKind>>& VerdictChoices();
// 0.078 as "7.8 %"; "over 1000 %" beyond; "unknown" for NaN.
std::string PercentText(double share);

// The largest directional albedo of the model at the measured incident directions.
struct EnergyBalance {
  bool absolute = true;  // else the scale of the values is not known (--scale free), and nothing below is set
  double albedo = 0;
  double theta_i = 0, phi_i = 0;  // of the incident direction, radians
  std::string channel;
  std::size_t above_one = 0, incidences = 0;  // directions where it is above 1, of those looked at
};
// Values of goniometers are calibrated to some per cent: an albedo above this one is no error of calibration.
inline constexpr double kCreatesEnergy = 1.05;
inline bool CreatesEnergy(const EnergyBalance& balance) { return balance.absolute && balance.albedo > kCreatesEnergy; }
// "an albedo of 8.2 at theta_i 60, phi_i 0 degrees in value, above 1 at 11 of 12 incident directions"; empty where none
// is above 1.005.
std::string EnergyText(const EnergyBalance& balance);

// A model of the automatic choice, judged on incident directions that it had not seen.
struct TriedModel {
  std::string name;
  std::size_t free_parameters = 0;
  double held_out = 0;  // root mean square under the metric
  double ratio = 1;     // over that of the simplest model
  bool chosen = false;
};

// The total integrated scatter of the ABg lobes at a measured incident direction.
struct ScatterAt {
  double theta_i = 0, phi_i = 0;  // radians
  std::vector<double> share;      // of the light that arrives, [channel]
};

// What a fit assumed and found of its instrument. Angles in radians.
struct Drift {
  double sd = 0;           // of the logarithm of a gain
  bool estimated = false;  // from the data, else given
};
struct IncidenceGain {
  double theta_i = 0, phi_i = 0, gain = 1, standard_error = 0;
};
// An angle by which the sample stood crooked.
struct InstrumentAngle {
  std::string name;  // "e_x"
  double value = 0, standard_error = 0, prior = 0;
  double tilt_correlation = 0;  // with a lobe's tilt, the largest; 0: no tilt is free
};
// A half angle that was fitted about the one that is known.
struct InstrumentHalfAngle {
  std::string name;  // "source", "detector"
  double value = 0, standard_error = 0;
  double given = 0, prior = 0;
  bool determined = false;  // by the samples: the error is below 0.7 of the prior
};
struct InstrumentOffset {
  double value = 0, standard_error = 0;  // of f_r cos_theta_i, 1/sr
};
struct InstrumentUsed {
  double source = 0, detector = 0;               // half angles of the discs that they fill, as fitted
  double across = 0;                             // above 0: the detector is a rectangle, this across the meridian
  std::vector<InstrumentHalfAngle> half_angles;  // those that were fitted
  std::string mean;                              // over them, that a value is: "flux", "plain"
  std::optional<Drift> drift;
  std::vector<IncidenceGain> gains;  // with drift
  std::vector<InstrumentAngle> alignment;
  double alignment_correlation = 0;      // of e_x and e_y
  std::vector<double> azimuths;          // of the sample on its stage, one a turn, with alignment
  std::optional<bool> told_from_tilt;    // the alignment; empty: no alignment or no tilt was fitted
  std::vector<InstrumentOffset> offset;  // [channel]; empty: none was fitted
};

struct Source {
  std::string file, sha256, format;
  std::map<std::string, std::string> conventions;
};

// What repeats the fit of a measurement: `lobefit fit FILE --recipe DOCUMENT`.
struct RecipeUsed {
  std::string text;  // the recipe as ParseRecipe reads it, before the fit chose what it leaves open
  std::size_t starts = 0;
  std::uint64_t seed = 0;
  int scouting_steps = 0;  // FitOptions
  // Options of `lobefit fit` by which the measurement was read and selected: "theta-i", "10:50".
  std::map<std::string, std::string> reading;
};

struct Material {
  Model model;
  // A table of lobes in place of a model, whose lobes and parameters are then empty.
  std::optional<SelTable> sel;
  std::vector<std::string> channels;
  std::vector<double> wavelengths_nm;
  std::vector<FittedParameter> parameters;  // in the order of Parameters(model)

  // Names of the free entries (JSON names, per-channel ones with "[R]"), and in outside units their covariances, of the
  // standard errors and of the clustered ones (empty with fewer than two incidences), row-major.
  std::vector<std::string> covariance_names;
  std::vector<double> covariance, covariance_clustered;
  // Slope-space form of each lobe: slope_x, slope_y, alpha_x, alpha_y (standard widths in slope), r.
  std::vector<std::vector<double>> slope_space;

  // Directions in parameter space that the data do not determine, in words.
  std::vector<std::string> degenerate;
  std::vector<std::string> remarks;
  std::optional<Misfit> misfit;              // of fits of a model
  std::vector<TriedModel> tried;             // where the model was chosen automatically
  std::optional<Verdict> verdict;            // of fits of a model
  std::optional<EnergyBalance> energy;       // of fits of a model
  std::vector<ScatterAt> scatter;            // of fits with ABg lobes whose values are calibrated
  std::optional<InstrumentUsed> instrument;  // of fits through one

  std::size_t samples_used = 0, samples_read = 0;
  std::map<std::string, std::size_t> set_aside;
  std::vector<MetricError> errors;
  double cost = 0;
  std::vector<Minimum> minima;
  Termination termination;
  std::map<std::string, double> timings_s;

  Source source;
  std::string recipe_name, recipe_reason;  // why this recipe, where it was chosen automatically
  std::string metric, weighting, loss;
  double theta_max_deg = 90;
  std::optional<RecipeUsed> used;  // of fits; documents of earlier versions lack it
  std::string command;

  // Inside values in the form that Reflectance takes.
  ParameterValues Values() const;
};

}  // namespace lobefit
