#include "lobefit/validate/sweep.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

double NumberOf(const std::string& name, const std::string& value) {
  const std::optional<double> number = ParseDouble(value);
  if (!number || !std::isfinite(*number))
    throw UsageError(fmt::format("--sweep {}: '{}' is not a number", name, Excerpt(value)));
  return *number;
}

// `count` angles evenly from `low` to `high`; one: the middle.
std::vector<double> Spread(std::size_t count, double low, double high) {
  std::vector<double> angles;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = count == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(count - 1);
    angles.push_back(low + t * (high - low));
  }
  return angles;
}

std::size_t CountOf(const std::string& name, const std::string& value) {
  const double number = NumberOf(name, value);
  if (!(number >= 1 && number <= 1000 && number == std::floor(number)))
    throw UsageError(fmt::format("--sweep {}: '{}' must be a whole number from 1 to 1000", name, value));
  return static_cast<std::size_t>(number);
}

template <class Enum>
Enum ChoiceOf(const std::string& name, const std::string& value, const std::vector<Choice<Enum>>& choices) {
  const Choice<Enum>* choice = Find(choices, value);
  if (choice == nullptr) {
    throw UsageError(fmt::format("--sweep {}: '{}' is unknown{}; allowed: {}", name, Excerpt(value),
                                 DidYouMean(value, Names(choices)), Join(Names(choices))));
  }
  return choice->value;
}

// The truth's parameter of this name outside, the first lobe's where several have it; nothing where there is none.
std::optional<std::size_t> PlaceOf(const std::string& name, const Truth& truth) {
  const std::vector<Parameter> parameters = Parameters(truth.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].json_name == name) return i;
  }
  return std::nullopt;
}

// Of a shape: follows another one, or is 0, by the choice of NDF.
bool IsTied(const Parameter& parameter) { return parameter.group == ParameterGroup::kShape && !parameter.free; }

// The one that the sweep needs.
std::size_t Needed(const std::string& sweep, const char* parameter, const Truth& truth) {
  const std::optional<std::size_t> place = PlaceOf(parameter, truth);
  if (!place || IsTied(Parameters(truth.model)[*place])) {
    throw UsageError(fmt::format("--sweep {}: the truth's model has no {} of its own; give a truth whose ndf has it",
                                 sweep, parameter));
  }
  return *place;
}

// Sets all channels of a parameter, and what follows it. `value`: as the user gave it.
void SetTruth(const std::string& sweep, const std::string& value, std::size_t place, double inside, Truth* truth) {
  const std::vector<Parameter> parameters = Parameters(truth->model);
  const Parameter& parameter = parameters[place];
  if (!(inside >= parameter.low && inside <= parameter.high)) {
    const double factor = InsideFactor(parameter);
    throw UsageError(fmt::format("--sweep {}: '{}' makes {} {:g}, which lies outside [{:g}, {:g}]", sweep,
                                 Excerpt(value), parameter.json_name, inside / factor, parameter.low / factor,
                                 parameter.high / factor));
  }
  std::fill(truth->values[place].begin(), truth->values[place].end(), inside);
  // alpha_y of a round lobe.
  const bool is_alpha = parameter.name.ends_with("alpha_x");
  if (is_alpha && IsTied(parameters[place + 1])) truth->values[place + 1] = truth->values[place];
}

struct Knob {
  const char* name;
  void (*turn)(const std::string& name, const std::string& value, ExperimentRequest* request);
};

// Of the first lobe.
const Knob kKnobs[] = {
    {"alpha",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       const std::size_t place = Needed(name, "alpha_x", r->truth);
       const double ratio = r->truth.values[place + 1][0] / r->truth.values[place][0], alpha = NumberOf(name, value);
       SetTruth(name, value, place, alpha, &r->truth);
       SetTruth(name, value, place + 1, ratio * alpha, &r->truth);
     }},
    {"ratio",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       const std::size_t place = Needed(name, "alpha_y", r->truth);
       SetTruth(name, value, place, r->truth.values[place - 1][0] / NumberOf(name, value), &r->truth);
     }},
    {"tilt",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       const std::size_t place = Needed(name, "theta_y_deg", r->truth);
       r->truth.values[place - 1][0] = 0;
       SetTruth(name, value, place, DegreesToRadians(NumberOf(name, value)), &r->truth);
     }},
    {"incidences",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       r->layout.goniometer.polar_angles = Spread(CountOf(name, value), DegreesToRadians(5), DegreesToRadians(70));
     }},
    {"azimuths",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       const std::size_t count = CountOf(name, value);
       r->layout.goniometer.azimuths =
           Spread(count, 0, kPi * static_cast<double>(count - 1) / static_cast<double>(count));
       if (count == 1) r->layout.goniometer.azimuths = {0};
     }},
    {"detector-step",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       const double step = NumberOf(name, value);
       if (!(step >= 0.2 && step <= 45)) throw UsageError("--sweep detector-step: values from 0.2 to 45 degrees");
       r->layout.goniometer.detector_step = DegreesToRadians(step);
     }},
    {"metric",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       r->recipe.metric = ChoiceOf(name, value, MetricChoices());
       r->recipe.metric_given = true;
     }},
    {"masking",
     [](const std::string& name, const std::string& value, ExperimentRequest* r) {
       r->recipe.model.lobes[0].masking = ChoiceOf(name, value, MaskingChoices());
     }},
};

// False where no parameter of the truth has this name, or it follows another one.
bool TurnParameter(const std::string& name, const std::string& value, ExperimentRequest* request) {
  const std::optional<std::size_t> place = PlaceOf(name, request->truth);
  if (!place) return false;
  const Parameter parameter = Parameters(request->truth.model)[*place];
  if (IsTied(parameter)) return false;
  SetTruth(name, value, *place, NumberOf(name, value) * InsideFactor(parameter), &request->truth);
  return true;
}

bool TurnNoise(const std::string& name, const std::string& value, ExperimentRequest* request) {
  for (const NoiseTerm& term : NoiseTerms()) {
    if (name != term.name || term.flag != nullptr) continue;
    request->noise.*(term.value) = ParseNoise(name + "=" + value).*(term.value);
    return true;
  }
  return false;
}

std::vector<std::string> Swept(const ExperimentRequest& request) {
  std::vector<std::string> names;
  for (const Knob& knob : kKnobs) names.emplace_back(knob.name);
  for (const NoiseTerm& term : NoiseTerms()) {
    if (term.flag == nullptr) names.emplace_back(term.name);
  }
  for (const Parameter& parameter : Parameters(request.truth.model)) {
    if (!IsTied(parameter)) names.push_back(parameter.json_name);
  }
  return names;
}

void Turn(const std::string& name, const std::string& value, ExperimentRequest* request) {
  for (const Knob& knob : kKnobs) {
    if (name != knob.name) continue;
    knob.turn(name, value, request);
    return;
  }
  if (TurnNoise(name, value, request) || TurnParameter(name, value, request)) return;
  const std::vector<std::string> names = Swept(*request);
  throw UsageError(
      fmt::format("--sweep: '{}' cannot be swept{}; allowed: {}", Excerpt(name), DidYouMean(name, names), Join(names)));
}

}  // namespace

Experiment MakeExperiment(const ExperimentRequest& request) {
  const MeasurementLayout layout = MakeLayout(request.layout, request.truth);
  RequireApertureWithin(layout, request.noise);
  if (request.noise.across > 0 && (request.noise.source > 0 || !(request.noise.aperture > 0))) {
    throw UsageError(
        "noise term 'across' makes a rectangle of the detector that 'aperture' is along the meridian, before a source "
        "that is a point; give aperture, and leave source out");
  }
  if (request.turned && layout.isotropic) {
    throw UsageError(
        fmt::format("layout '{}' has no place for a turn of the sample; take another one, or leave --turned out",
                    request.layout.name));
  }
  Experiment experiment;
  experiment.truth = request.truth;
  experiment.range = request.range;
  experiment.directions = layout.directions;
  experiment.isotropic = layout.isotropic;
  experiment.turned = request.turned;
  experiment.noise = request.noise;
  experiment.recipe = request.recipe;
  experiment.fit = request.fit;
  experiment.seed = request.seed;
  return experiment;
}

Sweep ParseSweep(const std::string& text, const ExperimentRequest& base) {
  const std::size_t equals = text.find('=');
  Sweep sweep;
  sweep.name = std::string(Trim(std::string_view(text).substr(0, equals)));
  if (equals == std::string::npos) {
    throw UsageError(
        fmt::format("--sweep '{}': write NAME=VALUE,VALUE,...; NAME is one of {}", Excerpt(text), Join(Swept(base))));
  }
  for (const std::string_view piece : Split(std::string_view(text).substr(equals + 1), ',')) {
    SweepPoint point = {std::string(Trim(piece)), base, {}, {}};
    Turn(sweep.name, point.value, &point.request);
    sweep.numeric = sweep.numeric && ParseDouble(point.value).has_value();
    sweep.points.push_back(std::move(point));
  }
  return sweep;
}

std::string ToText(const Sweep& sweep) {
  std::size_t width = sweep.name.size();
  for (const SweepPoint& point : sweep.points) width = std::max(width, point.value.size());
  std::string text = fmt::format("{:<{}}  {:>7} {:>9} {:>9} {:>9} {:>9}\n", sweep.name, width, "trials", "misfit %",
                                 "wrong min", "no sign", "s a fit");
  for (const SweepPoint& point : sweep.points) {
    const Calibration& c = point.calibration;
    text += fmt::format("{:<{}}  {:>7} {:>9.1f} {:>9} {:>9} {:>9.3g}\n", point.value, width, c.done,
                        100 * c.misfit.value, c.wrong_minima, c.wrong_unflagged, c.seconds_median);
  }
  if (sweep.points.empty()) return text;
  for (const EntryCalibration& first : sweep.points.front().calibration.entries) {
    text += fmt::format("\n{} [{}]\n{:<{}}  {:>10} {:>10} {:>9} {:>7} {:>7} {:>7} {:>8}\n", first.entry.name,
                        first.entry.unit, sweep.name, width, "bias", "spread", "stderr", "z mean", "z sd", "95 % in",
                        "not det.");
    for (const SweepPoint& point : sweep.points) {
      for (const EntryCalibration& e : point.calibration.entries) {
        if (e.entry.name != first.entry.name) continue;
        const IntervalCalibration& i = point.calibration.judge_clustered ? e.clustered : e.independent;
        text +=
            fmt::format("{:<{}}  {:>10.2e} {:>10.2e} {:>9.1e} {:>7.2f} {:>7.3f} {:>7.1f} {:>8}\n", point.value, width,
                        e.bias, e.spread, e.mean_error, i.z_mean, i.z_sd, 100 * i.within_95.value, e.not_determined);
      }
    }
  }
  return text;
}

}  // namespace lobefit
