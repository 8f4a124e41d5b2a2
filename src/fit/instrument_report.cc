#include "lobefit/fit/instrument_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/fit/search/solve.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Below this, gains are no drift: the estimate of none is not 0.
constexpr double kNoDrift = 0.005;

// Reported entries (Layout::ReportJacobian) before those of the instrument.
Eigen::Index EntriesOfModel(const Layout& layout) {
  Eigen::Index rows = 0;
  for (const Parameter& parameter : Parameters(layout.recipe().model))
    rows += parameter.per_channel ? static_cast<Eigen::Index>(layout.channels()) : 1;
  return rows;
}

// The clustered error where there are clusters.
double ErrorOf(const Uncertainty& uncertainty, Eigen::Index row) {
  const double variance = (uncertainty.has_clusters ? uncertainty.clustered : uncertainty.covariance).Variance(row);
  return variance > 0 ? std::sqrt(variance) : kNan;
}

void ReportGains(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                 const Uncertainty& uncertainty, const Incidences& incidences, const LastDescent& last,
                 ThreadPool* pool, InstrumentUsed* instrument, std::vector<std::string>* remarks) {
  const bool estimated = !layout.recipe().instrument.drift->sd;
  instrument->drift = {last.drift, estimated};
  if (estimated) {
    remarks->push_back(last.drift < kNoDrift
                           ? "drift: none found, gains of the incidences scatter by less than 0.5 %"
                           : fmt::format("drift: gains of the {} incidences scatter by {:.2g} % (estimated)",
                                         last.gains->size(), 100 * last.drift));
  }
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  std::vector<GainLink> links;
  Linearise(problem, layout, u.data(), pool, &hessian, &gradient, &links);
  for (std::size_t k = 0; k < links.size(); ++k) {
    const double variance =
        last.gains->residual_variance() / links[k].curvature + uncertainty.gain_variance(static_cast<Eigen::Index>(k));
    const double gain = last.gains->gains()[k];
    instrument->gains.push_back(
        {PolarAngle(incidences.wi[k]), Azimuth(incidences.wi[k]), gain, gain * std::sqrt(variance)});
  }
}

// The largest correlation of an entry with a tilt of a lobe; 0 where no tilt is free.
double TiltCorrelation(const Layout& layout, const Uncertainty& uncertainty, Eigen::Index row) {
  const Model& model = layout.recipe().model;
  const EntryCovariance& covariance = uncertainty.covariance;
  double largest = 0;
  Eigen::Index entry = 0;
  for (std::size_t i = 0; i < Parameters(model).size(); ++i) {
    const Parameter parameter = Parameters(model)[i];
    const bool tilt = parameter.json_name.ends_with("theta_x_deg") || parameter.json_name.ends_with("theta_y_deg");
    if (tilt && covariance(entry, entry) > 0) {
      const double correlation = covariance(entry, row) / std::sqrt(covariance(entry, entry) * covariance(row, row));
      if (std::fabs(correlation) > std::fabs(largest)) largest = correlation;
    }
    entry += parameter.per_channel ? static_cast<Eigen::Index>(layout.channels()) : 1;
  }
  return largest;
}

void ReportAlignment(const Layout& layout, const std::vector<double>& u, const Uncertainty& uncertainty,
                     InstrumentUsed* instrument, std::vector<std::string>* remarks) {
  const AlignmentRecipe& recipe = *layout.recipe().instrument.alignment;
  const Eigen::Index first = EntriesOfModel(layout);
  instrument->azimuths = recipe.azimuths;
  bool told = true, any_tilt = false;
  double worst_share = 0, worst_correlation = 0;
  for (std::size_t k = layout.first_angle(); k < layout.first_half_angle(); ++k) {
    const Eigen::Index row = first + static_cast<Eigen::Index>(k - layout.first_angle());
    const Coordinate& coordinate = layout.coordinates()[k];
    InstrumentAngle angle = {coordinate.name, u[k], ErrorOf(uncertainty, row), 1 / std::sqrt(coordinate.prior),
                             TiltCorrelation(layout, uncertainty, row)};
    if (k < layout.first_angle() + 2) {
      any_tilt = any_tilt || angle.tilt_correlation != 0;
      worst_correlation = std::max(worst_correlation, std::fabs(angle.tilt_correlation));
      worst_share = std::max(worst_share, angle.standard_error / angle.prior);
      told = told && !(std::fabs(angle.tilt_correlation) > kMostTiltCorrelation) &&
             angle.standard_error <= kMostPriorShare * angle.prior;
    }
    instrument->alignment.push_back(angle);
  }
  const EntryCovariance& covariance = uncertainty.has_clusters ? uncertainty.clustered : uncertainty.covariance;
  const double square = covariance(first, first) * covariance(first + 1, first + 1);
  if (square > 0) instrument->alignment_correlation = covariance(first, first + 1) / std::sqrt(square);
  if (!any_tilt) return;
  instrument->told_from_tilt = told;
  const double prior = RadiansToDegrees(recipe.prior);
  if (told) {
    remarks->push_back(
        fmt::format("alignment: a crooked sample and a tilted lobe are told apart (correlation at most {:.2f})",
                    worst_correlation));
    return;
  }
  remarks->push_back(fmt::format(
      "alignment: a crooked sample and a tilted lobe are not told apart ({}), so the tilt is known no better than the "
      "sample's alignment, {:.2g} degrees (prior). {}",
      worst_correlation > kMostTiltCorrelation
          ? fmt::format("correlation {:.2f}", worst_correlation)
          : fmt::format("the error of an angle is {:.0f} % of its prior", 100 * worst_share),
      prior,
      recipe.azimuths.size() > 1 ? "More turns of the sample, by 180 degrees, would tell them"
                                 : "Turn the sample by 180 degrees, measure again and fit both files together, the "
                                   "second as FILE:turned=true"));
}

void ReportHalfAngles(const Layout& layout, const std::vector<double>& u, const Uncertainty& uncertainty,
                      InstrumentUsed* instrument, std::vector<std::string>* remarks) {
  const Eigen::Index first = EntriesOfModel(layout);
  const Aperture given = layout.recipe().aperture();
  for (std::size_t k = layout.first_half_angle(); k < layout.shape_size(); ++k) {
    const Coordinate& coordinate = layout.coordinates()[k];
    InstrumentHalfAngle half_angle;
    half_angle.name = coordinate.name;
    half_angle.given = coordinate.name == "source" ? given.source : given.detector;
    half_angle.value = half_angle.given + u[k];
    half_angle.standard_error = ErrorOf(uncertainty, first + static_cast<Eigen::Index>(k - layout.first_angle()));
    half_angle.prior = 1 / std::sqrt(coordinate.prior);
    half_angle.determined = half_angle.standard_error <= kMostPriorShare * half_angle.prior;
    instrument->half_angles.push_back(half_angle);
    const double error = RadiansToDegrees(half_angle.standard_error), prior = RadiansToDegrees(half_angle.prior);
    if (uncertainty.at_bound[k]) {
      remarks->push_back(fmt::format(
          "{}: its half angle was fitted to {:.3g} degrees, as far from the given {:.3g} as is looked ({:g} standard "
          "deviations of {:.2g}): check what was given, or the model",
          half_angle.name, RadiansToDegrees(half_angle.value), RadiansToDegrees(half_angle.given), kMostHalfAngleSigmas,
          prior));
    } else if (half_angle.determined) {
      remarks->push_back(fmt::format(
          "{}: the samples determine its half angle, {:.3f} +- {:.2g} degrees (given: {:.3g} +- {:.2g})",
          half_angle.name, RadiansToDegrees(half_angle.value), error, RadiansToDegrees(half_angle.given), prior));
    } else {
      remarks->push_back(
          fmt::format("{}: its half angle is not determined by these samples (its error is {:.0f} % of the {:.2g} "
                      "degrees that were "
                      "given), so the widths are known no better than it. A sample of known narrow lobe, or a mirror, "
                      "measured with "
                      "the same detector tells it",
                      half_angle.name, 100 * half_angle.standard_error / half_angle.prior, prior));
    }
  }
}

}  // namespace

void ReportInstrument(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                      const Uncertainty& uncertainty, const Incidences& incidences, const LastDescent& last,
                      ThreadPool* pool, Material* material) {
  const Recipe& recipe = layout.recipe();
  const Aperture aperture = layout.ApertureAt(u.data());
  const InstrumentRecipe& wanted = recipe.instrument;
  if (!aperture.any() && !wanted.drift && !wanted.alignment && !wanted.offset) return;
  InstrumentUsed instrument;
  instrument.source = aperture.source;
  instrument.detector = aperture.detector;
  instrument.across = aperture.across;
  instrument.mean = NameOf(ApertureMeanChoices(), aperture.mean);
  ReportHalfAngles(layout, u, uncertainty, &instrument, &material->remarks);
  if (wanted.drift)
    ReportGains(problem, layout, u, uncertainty, incidences, last, pool, &instrument, &material->remarks);
  if (wanted.alignment) ReportAlignment(layout, u, uncertainty, &instrument, &material->remarks);
  if (wanted.offset) {
    const Eigen::Index first =
        EntriesOfModel(layout) + static_cast<Eigen::Index>(layout.shape_size() - layout.first_angle());
    for (std::size_t c = 0; c < layout.channels(); ++c) {
      const int index = layout.linear(c).back().index;
      instrument.offset.push_back(
          {u[static_cast<std::size_t>(index)], ErrorOf(uncertainty, first + static_cast<Eigen::Index>(c))});
    }
  }
  material->instrument = instrument;
}

}  // namespace lobefit
