#include "lobefit/fit/instrument.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/search/solve.h"

namespace lobefit {
namespace {

double NarrowestLobe(const KernelModel& kernel) {
  double narrowest = HUGE_VAL;
  for (const KernelLobe& lobe : kernel.lobes) narrowest = std::min(narrowest, NarrowestWidth(lobe.shape.slope));
  return narrowest;
}

// Azimuths of the sample on its stage, in the order in which they come.
std::vector<double> AzimuthsOfTurns(const Measurement& measurement) {
  // Those of one stage agree to less than this; the angle between turns is known no better than their prior.
  constexpr double kSame = 0.5 * kPi / 180;
  constexpr std::size_t kMostTurns = 24;
  std::vector<double> azimuths;
  for (const double azimuth : measurement.samples.sample_azimuth) {
    const bool known = std::any_of(azimuths.begin(), azimuths.end(), [&](double other) {
      return std::fabs(std::remainder(azimuth - other, 2 * kPi)) < kSame;
    });
    if (!known) azimuths.push_back(azimuth);
  }
  if (azimuths.size() > kMostTurns) {
    throw InputError(fmt::format("{}: the sample has {} azimuths on its stage; an alignment is fitted over {} at most",
                                 measurement.source, azimuths.size(), kMostTurns));
  }
  if (azimuths.empty()) azimuths.push_back(0);
  return azimuths;
}

// A half angle that is to be fitted must be known in the first place.
void RequireHalfAngle(const char* which, const std::optional<double>& half_angle, const std::optional<double>& prior,
                      const std::string& source) {
  if (!prior || half_angle.value_or(0) > 0) return;
  throw InputError(fmt::format(
      "{}: the half angle of the {} is to be fitted (known to {:.3g} degrees), but {}; give --{} DEGREES, or leave its "
      "prior out",
      source, which, RadiansToDegrees(*prior),
      half_angle ? "it is 0, a point" : "neither the recipe nor the file states it", which));
}

// What the means over a rectangular detector are made for.
void RequireRectangle(const Recipe& recipe, const std::string& source) {
  const InstrumentRecipe& instrument = recipe.instrument;
  if (!instrument.detector_across) return;
  const auto refuse = [&](const char* why) {
    throw InputError(fmt::format("{}: the detector is a rectangle (half angle across {:.3g} degrees), {}", source,
                                 RadiansToDegrees(*instrument.detector_across), why));
  };
  if (!(instrument.detector.value_or(0) > 0))
    refuse("but its half angle along the meridian is not known; give --detector DEGREES");
  if (instrument.source.value_or(0) > 0)
    refuse(
        "over which a mean with a source that is a disc too is not known; give --source 0, or both as discs of the "
        "same solid angle");
  if (instrument.detector_prior) refuse("whose half angles are not fitted; leave the detector's prior out");
  if (recipe.aperture().mean == ApertureMean::kPlain)
    refuse("over which the mean is that of the flux; leave mean = \"plain\" out");
}

// What incidences must be for gains, alignment and offset to be more than another name of the model.
void RequireIncidences(const Recipe& recipe, const Measurement& measurement, const Incidences& incidences) {
  const InstrumentRecipe& instrument = recipe.instrument;
  const auto refuse = [&](const std::string& why) { throw InputError(measurement.source + ": " + why); };
  if ((instrument.drift || instrument.alignment) && measurement.isotropic) {
    refuse(
        "drift and alignment belong to a sample on a stage; this format is isotropic by construction, and has lost "
        "them");
  }
  if (instrument.alignment && incidences.wi.size() < 2) {
    refuse(
        "an alignment cannot be told from one incident direction, whose lobe a crooked sample moves as a tilt does; "
        "measure several, or leave the alignment out");
  }
  if (instrument.drift && incidences.wi.size() < 3) {
    refuse(fmt::format("drift is what gains of the incidences scatter by, and there {} {}; three are needed",
                       incidences.wi.size() == 1 ? "is" : "are", incidences.wi.size()));
  }
  if (!instrument.offset || recipe.model.diffuse == Diffuse::kNone) return;
  bool free = false;
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    free = free || (parameters[i].group == ParameterGroup::kDiffuse && recipe.IsFree(i));
  const auto [low, high] = std::minmax_element(incidences.wi.begin(), incidences.wi.end(),
                                               [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  // An offset b is an albedo of pi b / cos_theta_i.
  constexpr double kLeastRatio = 0.9;
  if (free && low->z > kLeastRatio * high->z) {
    refuse(
        "at incident directions of one polar angle an offset is exactly a diffuse part: fix the diffuse albedo, or "
        "leave the offset out");
  }
}

}  // namespace

std::optional<double> DetectorStep(const Measurement& measurement, const Incidences& incidences) {
  if (measurement.isotropic) return std::nullopt;
  constexpr std::size_t kMostDirections = 500;
  const Samples& samples = measurement.samples;
  std::vector<std::vector<std::size_t>> groups(incidences.wi.size());
  for (std::size_t i = 0; i < samples.size(); ++i) groups[incidences.group[i]].push_back(i);
  std::vector<double> distances;
  const std::size_t step = std::max<std::size_t>(1, samples.size() / kMostDirections);
  for (std::size_t i = 0; i < samples.size(); i += step) {
    double nearest = HUGE_VAL;
    for (const std::size_t j : groups[incidences.group[i]]) {
      if (j != i) nearest = std::min(nearest, Norm(samples.wo(i) - samples.wo(j)));
    }
    if (nearest < HUGE_VAL) distances.push_back(2 * std::asin(std::min(1.0, 0.5 * nearest)));
  }
  if (distances.empty()) return std::nullopt;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

Recipe ThroughInstrument(const Recipe& recipe, const Measurement& measurement) {
  Recipe through = recipe;
  InstrumentRecipe& instrument = through.instrument;
  const StatedInstrument& stated = measurement.instrument;
  // A half angle that the recipe states is not the file's, whose uncertainty and shape do not belong to it.
  if (!instrument.detector && !instrument.detector_across) instrument.detector_across = stated.detector_across;
  const auto take = [](const std::optional<double>& from, const std::optional<double>& from_prior,
                       std::optional<double>* half_angle, std::optional<double>* prior) {
    if (*half_angle) return;
    *half_angle = from;
    if (!*prior) *prior = from_prior;
  };
  take(stated.source, stated.source_prior, &instrument.source, &instrument.source_prior);
  take(stated.detector, stated.detector_prior, &instrument.detector, &instrument.detector_prior);
  RequireHalfAngle("source", instrument.source, instrument.source_prior, measurement.source);
  RequireHalfAngle("detector", instrument.detector, instrument.detector_prior, measurement.source);
  if (!instrument.mean && stated.plain_mean)
    instrument.mean = *stated.plain_mean ? ApertureMean::kPlain : ApertureMean::kFlux;
  if (!instrument.drift && stated.drift) instrument.drift = DriftRecipe{stated.drift->sd};
  if (!instrument.alignment && stated.alignment) {
    instrument.alignment = AlignmentRecipe();
    instrument.alignment->prior = *stated.alignment;
  }
  instrument.offset = instrument.offset || stated.offset.value_or(false);
  if (!through.noise.IsKnown() && stated.noise)
    through.noise = {stated.noise->floor, stated.noise->relative, stated.noise->poisson};
  RequireRectangle(through, measurement.source);
  const Incidences incidences = GroupByIncidence(measurement);
  RequireIncidences(through, measurement, incidences);
  if (instrument.alignment) instrument.alignment->azimuths = AzimuthsOfTurns(measurement);
  const Aperture aperture = through.aperture();
  if (!aperture.any()) return through;
  const std::size_t coat = CoatOf(through.model);
  if (coat < through.model.lobes.size() && through.model.lobes[coat].fresnel == Fresnel::kCoatRefracted) {
    throw InputError("recipe '" + recipe.name +
                     "': what lies below a refracting coat is not averaged over the discs of an instrument; use "
                     "fresnel = 'coat-layered', or leave --source and --detector out (0 where the file states them)");
  }
  const std::optional<double> step = DetectorStep(measurement, incidences);
  const double widest = std::max({aperture.source, aperture.detector, aperture.across});
  if (step && widest > kMostSteps * *step) {
    throw InputError(fmt::format(
        "{}: a {} of half angle {:.3g} degrees is {:.0f} times the step between neighbouring directions, {:.3g} "
        "degrees: "
        "the samples would all be the same average; allowed are {:g} steps. Half angles are meant, in degrees",
        measurement.source, aperture.source > aperture.detector ? "source" : "detector", RadiansToDegrees(widest),
        widest / *step, RadiansToDegrees(*step), kMostSteps));
  }
  return through;
}

void RefineRules(const Problem& problem, const std::vector<std::string>& channels, Layout* layout,
                 std::vector<DistinctMinimum>* minima, ThreadPool* pool) {
  Recipe recipe = layout->recipe();
  const Aperture aperture = recipe.aperture();
  const double smaller = std::min(aperture.source, aperture.detector);
  if (smaller == 0) return;
  constexpr int kMostRounds = 3;
  // Room for the lobe to become a little narrower still.
  constexpr double kRoom = 0.8;
  for (int round = 0; round < kMostRounds && !minima->empty(); ++round) {
    const double made_for = recipe.instrument.finest_width > 0 ? recipe.instrument.finest_width : smaller;
    const double width = NarrowestLobe(layout->ToKernel(minima->front().solution.u.data()));
    if (width >= made_for) return;
    recipe.instrument.finest_width = kRoom * width;
    *layout = Layout(recipe, channels);
    for (DistinctMinimum& minimum : *minima) {
      const int before = minimum.solution.iterations;
      minimum.solution = Solve(problem, *layout, minimum.solution.u, {}, pool);
      minimum.solution.iterations += before;
      minimum.samples = problem.size();
      minimum.on_all_samples = true;
    }
    std::stable_sort(minima->begin(), minima->end(), [](const DistinctMinimum& a, const DistinctMinimum& b) {
      return a.solution.cost < b.solution.cost;
    });
  }
}

}  // namespace lobefit
