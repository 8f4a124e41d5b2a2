#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {
namespace {

// A number that times `factor`, as it is read, gives `value` to the last bit, where there is one; the shortest.
std::string Outside(double value, double factor) {
  if (factor == 1) return FormatDouble(value);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double middle = value / factor;
  const double below = std::nextafter(middle, -kInfinity), above = std::nextafter(middle, kInfinity);
  std::string shortest;
  for (const double candidate :
       {middle, below, above, std::nextafter(below, -kInfinity), std::nextafter(above, kInfinity)}) {
    const std::string text = FormatDouble(candidate);
    if (candidate * factor == value && (shortest.empty() || text.size() < shortest.size())) shortest = text;
  }
  return shortest.empty() ? FormatDouble(middle) : shortest;
}

std::string Degrees(double radians) { return Outside(radians, DegreesToRadians(1)); }

// A basic string of TOML.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

// The section that ReadInstrument reads; empty where nothing is stated.
std::string InstrumentToToml(const Recipe& recipe) {
  const InstrumentRecipe& instrument = recipe.instrument;
  std::string text;
  const auto add_disc = [&text](const char* key, const std::optional<double>& half_angle,
                                const std::optional<double>& prior, const std::optional<double>& across) {
    if (half_angle && !prior && !across) text += fmt::format("{} = {}\n", key, Degrees(*half_angle));
    if (!prior && !across) return;
    std::vector<std::string> parts;
    if (half_angle) parts.push_back("value = " + Degrees(*half_angle));
    if (prior) parts.push_back("prior_deg = " + Degrees(*prior));
    if (across) parts.push_back("across = " + Degrees(*across));
    text += fmt::format("{} = {{ {} }}\n", key, Join(parts));
  };
  add_disc("source", instrument.source, instrument.source_prior, {});
  add_disc("detector", instrument.detector, instrument.detector_prior, instrument.detector_across);
  if (instrument.mean) text += fmt::format("mean = \"{}\"\n", NameOf(ApertureMeanChoices(), *instrument.mean));
  if (recipe.noise.IsKnown()) {
    const double poisson = recipe.noise.poisson;
    text += fmt::format("noise = {{ floor = {}, relative = {}{} }}\n", FormatDouble(recipe.noise.floor),
                        FormatDouble(recipe.noise.relative),
                        poisson > 0 ? ", poisson = " + FormatDouble(poisson) : std::string());
  }
  if (instrument.drift)
    text += "drift = " + (instrument.drift->sd ? FormatDouble(*instrument.drift->sd) : std::string("\"auto\"")) + '\n';
  if (instrument.alignment) {
    text += fmt::format("alignment = {{ prior_deg = {} }}\n", Degrees(instrument.alignment->prior));
  }
  if (instrument.offset) text += "offset = true\n";
  return text.empty() ? text : "\n[instrument]\n" + text;
}

}  // namespace

std::string ToToml(const Recipe& recipe) {
  if (recipe.sel) {
    return fmt::format(
        "name = {}\nmetric = \"{}\"\nweighting = \"{}\"\ntheta_max_deg = {}\n\n[sel]\nlobes = {}\nquantity = "
        "\"{}\"\nbound = {}\ndrift = {}\n",
        Quoted(recipe.name), NameOf(MetricChoices(), recipe.metric), NameOf(WeightingChoices(), recipe.weighting),
        Degrees(recipe.theta_max), recipe.sel->lobes, NameOf(recipe.sel->quantity), recipe.sel->bound,
        FormatDouble(recipe.sel->drift));
  }
  std::string text = fmt::format("name = {}\nweighting = \"{}\"\ntheta_max_deg = {}\ndiffuse = \"{}\"\n",
                                 Quoted(recipe.name), NameOf(WeightingChoices(), recipe.weighting),
                                 Degrees(recipe.theta_max), NameOf(DiffuseChoices(), recipe.model.diffuse));
  // Where it was not given, the fit may choose another.
  if (recipe.metric_given || recipe.metric != Recipe().metric)
    text += fmt::format("metric = \"{}\"\n", NameOf(MetricChoices(), recipe.metric));
  if (recipe.energy != EnergyChoice::kFree)
    text += fmt::format("energy = \"{}\"\n", NameOf(EnergyChoices(), recipe.energy));
  if (recipe.free_scale) text += "scale = \"free\"\n";
  if (recipe.loss != Loss::kNone) {
    text += fmt::format("loss = {{ kind = \"{}\", scale = {} }}\n", NameOf(LossChoices(), recipe.loss),
                        FormatDouble(recipe.loss_scale));
  }
  if (!recipe.wavelengths_nm.empty()) {
    std::vector<std::string> numbers;
    for (const double wavelength : recipe.wavelengths_nm) numbers.push_back(FormatDouble(wavelength));
    text += "wavelengths_nm = [" + Join(numbers) + "]\n";
  }
  for (const Lobe& lobe : recipe.model.lobes) {
    text +=
        fmt::format("\n[[lobe]]\nndf = \"{}\"\nmasking = \"{}\"\nfresnel = \"{}\"\n", NameOf(NdfChoices(), lobe.ndf),
                    NameOf(MaskingChoices(), lobe.masking), NameOf(FresnelChoices(), lobe.fresnel));
    if (!lobe.metal.empty()) text += fmt::format("metal = \"{}\"\n", lobe.metal);
    if (lobe.direction != LobeDirection::kSpecular)
      text += fmt::format("direction = \"{}\"\n", NameOf(LobeDirectionChoices(), lobe.direction));
    if (lobe.grid != nullptr) {
      std::vector<std::string> knots;
      for (const double r : lobe.grid->spline()->knots()) knots.push_back(FormatDouble(r));
      text += "knots = [" + Join(knots) + "]\n";
    }
  }
  text += InstrumentToToml(recipe);
  text += "\n[parameters]\n";
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterRecipe& parameter = recipe.parameters[i];
    const double factor = InsideFactor(parameters[i]);
    std::vector<std::string> parts;
    const auto list = [&](const std::vector<double>& values) {
      std::vector<std::string> numbers;
      for (const double value : values) numbers.push_back(Outside(value, factor));
      return numbers.size() == 1 ? numbers[0] : "[" + Join(numbers) + "]";
    };
    if (!parameter.start.empty()) parts.push_back("start = " + list(parameter.start));
    if (!parameter.fixed.empty()) parts.push_back("fixed = " + list(parameter.fixed));
    if (parameter.low || parameter.high)
      parts.push_back(fmt::format("bounds = [{}, {}]", Outside(parameter.low.value_or(parameters[i].low), factor),
                                  Outside(parameter.high.value_or(parameters[i].high), factor)));
    if (parameter.shared != parameters[i].shared)
      parts.emplace_back(parameter.shared ? "shared = true" : "shared = false");
    if (parameter.free) parts.emplace_back("free = true");
    if (!parts.empty()) text += fmt::format("\"{}\" = {{ {} }}\n", parameters[i].json_name, Join(parts));
  }
  return text;
}

Recipe AsWritten(const Recipe& recipe) {
  Recipe written = ParseRecipe(ToToml(recipe), recipe.name);
  written.reason = recipe.reason;
  written.metric_given = recipe.metric_given;
  written.plane_azimuth = recipe.plane_azimuth;
  return written;
}

}  // namespace lobefit
