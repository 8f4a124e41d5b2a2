// What to fit: model, free parameters, starts, bounds, metric, loss, angle limit. How to solve it is not in a recipe.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/core/instrument/aperture.h"
#include "lobefit/core/sel/sel_table.h"
#include "lobefit/fit/metric/loss.h"
#include "lobefit/fit/metric/metric.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// kAuto: solid angles where the format knows its cells, else cells.
enum class Weighting { kCells, kSolidAngle, kAuto };

// kConserving: the directional albedo stays at most 1 at the measured incident directions (keep_energy.h).
enum class EnergyChoice { kFree, kConserving };

const std::vector<Choice<Weighting>>& WeightingChoices();
const std::vector<Choice<EnergyChoice>>& EnergyChoices();
const std::vector<Choice<ApertureMean>>& ApertureMeanChoices();

// What a recipe says of one parameter; inside units. Bounds default to the range in the parameter table.
struct ParameterRecipe {
  // Empty: not given. One value, or one a channel. Starts of amplitudes and albedos are only used by synthesis: fits
  // solve for them.
  std::vector<double> start;
  std::vector<double> fixed;
  std::optional<double> low, high;
  bool shared = false;  // one value for all channels
  bool free = false;    // fitted, though the table would leave it at its start
};

// A table of squared ellipsoidal lobes in place of a model.
struct SelRecipe {
  std::size_t lobes = 1;  // 1 to 3
  SelQuantity quantity = SelQuantity::kBrdfCosineO;
  bool bound = false;  // lobes on or above all samples, with the least integral
  // Expected change of shapes from one incident direction to the next, per radian: of the logarithms of the widths and
  // of the offsets in radians. Smaller is smoother.
  double drift = 3;
};

// Drift of lamp and detector from one incident direction to the next.
struct DriftRecipe {
  std::optional<double> sd;  // standard deviation of a gain, relative, in (0, 1]; empty: estimated from the data
};

inline constexpr double kMostAlignmentDeg = 5;
// A sample that stands crooked on its stage (KernelAlignment): its angles are fitted with a normal prior about 0.
struct AlignmentRecipe {
  double prior = 0.2 * kPi / 180;       // standard deviation of e_x and e_y, radians, in (0, 5 degrees]
  double prior_turn = 0.5 * kPi / 180;  // of e_z of the turns after the first
  std::vector<double> azimuths = {0};   // of the sample in each turn, radians; the fit takes its measurement's
  std::uint16_t TurnOf(double azimuth) const;
};

// The instrument that the fit looks through; what is empty is taken as the measurement's file states it, else as a
// point and a flux mean.
struct InstrumentRecipe {
  std::optional<double> source, detector;  // half angles of their discs, radians, in [0, kLargestHalfAngle]
  // How well these are known, a standard deviation in radians: they are then fitted. Of a disc that is not a point.
  std::optional<double> source_prior, detector_prior;
  // Of a rectangular detector: the half angle across the meridian, `detector` being that along it; empty: a disc.
  std::optional<double> detector_across;
  std::optional<ApertureMean> mean;
  // Gains of the incidences, whose logarithms are normal about 0 (gains.h).
  std::optional<DriftRecipe> drift;
  std::optional<AlignmentRecipe> alignment;
  // Readings f_r cos_theta_i too high by a constant of each channel.
  bool offset = false;
  // The width in slope space that the rules of a mean are made for (LobeMeanRule), chosen by the fit; 0: the smaller
  // disc's own width.
  double finest_width = 0;
};
inline constexpr double kLargestHalfAngle = 30 * kPi / 180;
// A half angle is fitted within so many standard deviations of what is known of it.
inline constexpr double kMostHalfAngleSigmas = 4;

struct Recipe {
  std::string name;
  std::string reason;  // why it was chosen, where it was chosen automatically
  Model model;         // without lobes where `sel` is set
  std::optional<SelRecipe> sel;
  std::vector<ParameterRecipe> parameters;  // in the order of Parameters(model)
  // The defaults give the spheres that look most like the tables' (fits/README.md).
  Metric metric = Metric::kCubeRoot;
  // The user chose the metric: it is kept where the noise of the readings would bias it, and the bias is told. Else the
  // fit turns to kAsinh there.
  bool metric_given = false;
  NoiseModel noise;  // of the readings, for Metric::kAsinh; {0, 0}: the fit estimates it
  Weighting weighting = Weighting::kAuto;
  EnergyChoice energy = EnergyChoice::kFree;
  bool free_scale = false;  // the scale of the values is not known: no albedo follows from them (free_scale.h)
  Loss loss = Loss::kNone;
  double loss_scale = 0.1;
  double theta_max = DegreesToRadians(80);
  InstrumentRecipe instrument;
  // Of the channels, for metals; empty: the measurement's own.
  std::vector<double> wavelengths_nm;
  // Azimuth of the plane of an in-plane measurement, for ggx-tilted; Fit takes that of its measurement where it has
  // one.
  double plane_azimuth = 0;

  bool IsFree(std::size_t index) const;
  Aperture aperture() const;
  // The widest discs that a fit of half angles may come to.
  Aperture widest_aperture() const;
};

// A recipe for `model` with every choice at its default.
Recipe DefaultRecipe(const Model& model, const std::string& name);

// Reads fits/*.toml; its grammar is in fits/README.md. Throws InputError with file and line: unknown key (with a
// suggestion), wrong type, unknown choice (with the allowed ones), a bound that excludes its start.
Recipe ReadRecipe(const std::filesystem::path& path);
Recipe ParseRecipe(const std::string& toml_text, const std::string& file_name);

// The recipe as TOML that ParseRecipe reads back. What ParseRecipe gave comes back to the last bit, but for `reason`
// and `plane_azimuth`.
std::string ToToml(const Recipe& recipe);
// The recipe as its text says it: angles that no number of degrees stands for are rounded.
Recipe AsWritten(const Recipe& recipe);

// The recipe with eta and k of lobes of a metal fixed to the published values at the channels' wavelengths, which are
// the recipe's own or else `wavelengths_nm`. Throws InputError where there are none, or the metal is not known there.
Recipe WithMetals(const Recipe& recipe, const std::vector<double>& wavelengths_nm, std::size_t channels);

// What an automatic choice needs to know of a measurement.
struct MeasurementTraits {
  bool isotropic = false;  // by construction of the format
  bool in_plane = false;   // all samples in one plane
  double plane_azimuth = 0;
  std::size_t incidences = 0;
  std::size_t samples = 0;
};

// The richest default model that the measurement can determine; `reason` says what was chosen and why.
Recipe AutomaticRecipe(const MeasurementTraits& traits);

}  // namespace lobefit
