// lobefit info: what a measurement file holds.
#include <algorithm>
#include <memory>
#include <optional>

#include "options/measurement_options.h"
#include "tasks/stack_report.h"
#include "text/output.h"
#include "verbs/verb.h"
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/text/text.h"
#include "lobefit/io/write.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/checks/statistics.h"
#include "lobefit/measurement/incidence.h"
#include "lobefit/report/figures/coverage.h"

namespace lobefit {
namespace {

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void Add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

struct Description {
  Incidences incidences;
  Extent theta_i, theta_o;
  std::vector<Extent> values;
  bool in_plane;
  std::optional<Statistics> statistics;
};

// Albedo and reciprocity interpolate the samples; a table of millions takes seconds for that, so it is asked for.
constexpr std::size_t kStatisticsByDefault = 100000;

Description DescribeRanges(const Measurement& measurement) {
  const Samples& samples = measurement.samples;
  Description description = {GroupByIncidence(measurement),
                             {},
                             {},
                             std::vector<Extent>(samples.values.size()),
                             !measurement.isotropic && IsInPlane(samples),
                             {}};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    description.theta_i.Add(samples.wi_z[i]);
    description.theta_o.Add(samples.wo_z[i]);
  }
  for (Extent* range : {&description.theta_i, &description.theta_o}) {
    *range = {RadiansToDegrees(std::acos(std::min(1.0, range->high))),
              RadiansToDegrees(std::acos(std::min(1.0, range->low)))};
  }
  for (std::size_t c = 0; c < samples.values.size(); ++c) {
    for (const double value : samples.values[c]) description.values[c].Add(value);
  }
  return description;
}

nlohmann::ordered_json StatisticsToJson(const Statistics& statistics) {
  nlohmann::ordered_json incidences = nlohmann::ordered_json::array();
  for (const IncidenceStatistics& incidence : statistics.incidences) {
    incidences.push_back({{"theta_i_deg", RadiansToDegrees(PolarAngle(incidence.wi))},
                          {"phi_i_deg", RadiansToDegrees(Azimuth(incidence.wi))},
                          {"albedo", incidence.albedo},
                          {"coverage", incidence.coverage}});
  }
  return {{"azimuths_deg", statistics.azimuths_deg},
          {"reciprocal_pairs", statistics.reciprocal_pairs},
          {"reciprocity_median", statistics.reciprocity_median},
          {"reciprocity_percentile_90", statistics.reciprocity_percentile_90},
          {"conserves_energy", statistics.ConservesEnergy()},
          {"albedo", incidences}};
}

std::string StatisticsToText(const Statistics& statistics, const Measurement& measurement) {
  std::string text;
  if (!statistics.azimuths_deg.empty() && statistics.azimuths_deg.size() <= 12) {
    text += fmt::format("  azimuths     {:.5g} degrees\n", fmt::join(statistics.azimuths_deg, ", "));
  }
  if (statistics.reciprocal_pairs > 0) {
    text += fmt::format("  reciprocity  {} exchanged pairs differ by {:.2g} % (median), {:.2g} % (90 %)\n",
                        statistics.reciprocal_pairs, 100 * statistics.reciprocity_median,
                        100 * statistics.reciprocity_percentile_90);
  }
  for (const IncidenceStatistics& incidence : statistics.incidences) {
    text += fmt::format("  albedo       at theta_i {:.4g}:", RadiansToDegrees(PolarAngle(incidence.wi)));
    for (std::size_t c = 0; c < incidence.albedo.size() && c < 4; ++c)
      text += fmt::format("  {} {:.3f}", measurement.channels.names[c], incidence.albedo[c]);
    text += incidence.coverage < 0.9
                ? fmt::format("  (a guess: the samples cover {:.0f} % of the hemisphere)\n", 100 * incidence.coverage)
                : "\n";
  }
  if (!statistics.ConservesEnergy())
    text += fmt::format("  energy       NOT conserved: an albedo of {:.3f}\n", statistics.largest_albedo);
  return text;
}

// What the file states of its instrument; null: not stated.
nlohmann::ordered_json InstrumentToJson(const StatedInstrument& stated) {
  const auto degrees = [](const std::optional<double>& half_angle) {
    return half_angle ? nlohmann::ordered_json(RadiansToDegrees(*half_angle)) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json = {{"source_deg", degrees(stated.source)}, {"detector_deg", degrees(stated.detector)}};
  if (stated.detector_across) json["detector_across_deg"] = degrees(stated.detector_across);
  if (stated.source_prior) json["source_prior_deg"] = degrees(stated.source_prior);
  if (stated.detector_prior) json["detector_prior_deg"] = degrees(stated.detector_prior);
  json["mean"] = stated.plain_mean ? nlohmann::ordered_json(*stated.plain_mean ? "plain" : "flux")
                                   : nlohmann::ordered_json(nullptr);
  json["drift"] = nullptr;
  if (stated.drift)
    json["drift"] = stated.drift->sd ? nlohmann::ordered_json(*stated.drift->sd) : nlohmann::ordered_json("auto");
  json["alignment_deg"] = degrees(stated.alignment);
  json["offset"] = stated.offset ? nlohmann::ordered_json(*stated.offset) : nlohmann::ordered_json(nullptr);
  json["noise"] = nullptr;
  if (stated.noise) {
    json["noise"] = {
        {"floor", stated.noise->floor}, {"relative", stated.noise->relative}, {"poisson", stated.noise->poisson}};
  }
  return json;
}

std::string InstrumentToText(const StatedInstrument& stated) {
  const auto half_angle = [](const char* name, const std::optional<double>& radians,
                             const std::optional<double>& prior) {
    if (!radians) return fmt::format("{} not stated", name);
    const std::string known = prior ? fmt::format(" +- {:.2g}", RadiansToDegrees(*prior)) : "";
    return fmt::format("{} {:.4g}{} degrees (half angle)", name, RadiansToDegrees(*radians), known);
  };
  const std::string nothing = "not stated";
  const std::string drift = !stated.drift      ? nothing
                            : stated.drift->sd ? fmt::format("{:g}", *stated.drift->sd)
                                               : std::string("auto");
  const std::string alignment =
      stated.alignment ? fmt::format("{:.4g} degrees", RadiansToDegrees(*stated.alignment)) : nothing;
  const std::string offset = stated.offset ? std::string(*stated.offset ? "true" : "false") : nothing;
  const std::string noise = stated.noise ? fmt::format("floor {:g}, relative {:g}, poisson {:g}", stated.noise->floor,
                                                       stated.noise->relative, stated.noise->poisson)
                                         : nothing;
  return fmt::format("  instrument   {}, {}, mean {}; drift {}, alignment {}, offset {}, noise {}\n",
                     half_angle("source", stated.source, stated.source_prior),
                     half_angle("detector", stated.detector, stated.detector_prior) +
                         (stated.detector_across ? fmt::format(" x {:.4g}", RadiansToDegrees(*stated.detector_across))
                                                 : std::string()),
                     stated.plain_mean ? (*stated.plain_mean ? "plain" : "flux") : "not stated", drift, alignment,
                     offset, noise);
}

std::string ToJson(const Measurement& measurement, const Description& description) {
  nlohmann::ordered_json set_aside = nlohmann::ordered_json::object(), directions = nlohmann::ordered_json::array();
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    if (measurement.set_aside[reason] > 0) set_aside[std::string(Key(reason))] = measurement.set_aside[reason];
  }
  for (const Vec3& wi : description.incidences.wi) {
    directions.push_back(
        {{"theta_i_deg", RadiansToDegrees(PolarAngle(wi))}, {"phi_i_deg", RadiansToDegrees(Azimuth(wi))}});
  }
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const Extent& range : description.values) values.push_back({range.low, range.high});
  nlohmann::ordered_json json = {{"file", measurement.source},
                                 {"sha256", measurement.sha256},
                                 {"format", measurement.format},
                                 {"samples", measurement.samples.size()},
                                 {"set_aside", set_aside},
                                 {"channels", measurement.channels.names},
                                 {"wavelengths_nm", measurement.channels.wavelengths_nm},
                                 {"incidences", description.incidences.wi.size()},
                                 {"incident_directions", directions},
                                 {"isotropic", measurement.isotropic},
                                 {"in_plane", description.in_plane},
                                 {"theta_i_deg", {description.theta_i.low, description.theta_i.high}},
                                 {"theta_o_deg", {description.theta_o.low, description.theta_o.high}},
                                 {"values", values},
                                 {"conventions", measurement.conventions},
                                 {"instrument", InstrumentToJson(measurement.instrument)},
                                 {"remarks", measurement.remarks}};
  if (description.statistics) json["statistics"] = StatisticsToJson(*description.statistics);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string ToText(const Measurement& measurement, const Description& description) {
  std::string text = fmt::format("{}: {}\n", Printable(measurement.source), measurement.format);
  text += fmt::format("  samples      {}\n", measurement.samples.size());
  for (int r = 0; r < kSetAsideReasons; ++r) {
    const auto reason = static_cast<SetAsideReason>(r);
    if (measurement.set_aside[reason] > 0)
      text += fmt::format("  set aside    {} {}\n", measurement.set_aside[reason], Words(reason));
  }
  text += fmt::format("  channels     {}\n", Join(measurement.channels.names, " "));
  for (std::size_t c = 0; c < description.values.size() && c < 4; ++c) {
    text += fmt::format("  f_r {:<8} {:.4g} to {:.4g} 1/sr\n", measurement.channels.names[c], description.values[c].low,
                        description.values[c].high);
  }
  text += fmt::format("  incidences   {}{}\n", description.incidences.wi.size(),
                      measurement.isotropic ? " polar angles, in bins of one degree" : " directions");
  text += fmt::format("  theta_i      {:.4g} to {:.4g} degrees\n", description.theta_i.low, description.theta_i.high);
  text += fmt::format("  theta_o      {:.4g} to {:.4g} degrees\n", description.theta_o.low, description.theta_o.high);
  text += fmt::format("  isotropic    {}\n",
                      measurement.isotropic ? "yes, by construction of the format" : "not by construction");
  if (description.in_plane) text += "  in plane     all samples lie in one plane through the normal\n";
  if (description.statistics) text += StatisticsToText(*description.statistics, measurement);
  text += InstrumentToText(measurement.instrument);
  for (const auto& [option, value] : measurement.conventions) text += fmt::format("  {:<12} {}\n", option, value);
  for (const std::string& remark : measurement.remarks) text += "  note         " + remark + '\n';
  return text;
}

}  // namespace

std::function<int()> SetUpInfo(CLI::App* app, CommonOptions* common) {
  auto options = std::make_shared<MeasurementOptions>();
  auto files = std::make_shared<std::vector<std::string>>();
  app->add_option("FILE", *files,
                  "measurement files: one, or several and folders as one measurement; FILE:theta_i=30 states what a "
                  "file lacks; or "
                  "an image stack")
      ->required();
  auto statistics = std::make_shared<bool>(false);
  app->add_flag("--statistics", *statistics,
                "albedo and reciprocity for a large table too (small ones show them anyway)");
  auto picture = std::make_shared<std::string>();
  app->add_option("--png", *picture,
                  "also write where the samples lie over the hemisphere, and what was excluded, to this picture");
  options->AddTo(app);
  auto encoding = std::make_shared<std::string>();
  app->add_option("--encoding", *encoding, "of an image stack: how pixels are stored: linear, srgb, gamma:G");
  return [=] {
    if (files->size() == 1 && LooksLikeStack(files->front()))
      return DescribeStack(files->front(), {*encoding}, common->json);
    const Measurement measurement = options->Load(*files);
    Description description = DescribeRanges(measurement);
    if (*statistics || measurement.samples.size() <= kStatisticsByDefault) {
      description.statistics = Describe(measurement, measurement.conventions.count("channels") == 0
                                                         ? TabulatedBrdf(OnlyFile(*files), measurement).brdf
                                                         : nullptr);
    }
    if (!picture->empty()) WriteCoveragePng(measurement, *picture);
    if (common->json) {
      fmt::print("{}\n", ToJson(measurement, description));
      return 0;
    }
    Print(ToText(measurement, description) + "\n");
    if (!picture->empty()) Print(fmt::format("Picture: {}\n", PrintableName(*picture)));
    return 0;
  };
}

}  // namespace lobefit
