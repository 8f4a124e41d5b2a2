// What to fit: model, free parameters, starts, bounds, metric, loss, angle limit. How to solve it is not in a recipe.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/core/sel/sel_table.h"
#include "lobefit/fit/metric/loss.h"
#include "lobefit/fit/metric/metric.h"

namespace lobefit {

// kAuto: solid angles where the format knows its cells, else cells.
enum class Weighting { kCells, kSolidAngle, kAuto };

const std::vector<Choice<Weighting>>& WeightingChoices();

// What a recipe says of one parameter; inside units. Bounds default to the range in the parameter table.
struct ParameterRecipe {
  // Empty: not given. One value, or one a channel. Starts of amplitudes and albedos are only used by synthesis: fits
  // solve for them.
  std::vector<double> start;
  std::vector<double> fixed;
  std::optional<double> low, high;
  bool shared = false;  // one value for all channels
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
  Loss loss = Loss::kNone;
  double loss_scale = 0.1;
  double theta_max = 80 * 3.14159265358979323846 / 180;  // radians
  // Of the channels, for metals; empty: the measurement's own.
  std::vector<double> wavelengths_nm;
  // Azimuth of the plane of an in-plane measurement, for ggx-tilted; Fit takes that of its measurement where it has
  // one.
  double plane_azimuth = 0;

  bool IsFree(std::size_t index) const;
};

// A recipe for `model` with every choice at its default.
Recipe DefaultRecipe(const Model& model, const std::string& name);

// Reads fits/*.toml; its grammar is in fits/README.md. Throws InputError with file and line: unknown key (with a
// suggestion), wrong type, unknown choice (with the allowed ones), a bound that excludes its start.
Recipe ReadRecipe(const std::filesystem::path& path);
Recipe ParseRecipe(const std::string& toml_text, const std::string& file_name);

// The recipe as TOML that ParseRecipe reads back.
std::string ToToml(const Recipe& recipe);

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
