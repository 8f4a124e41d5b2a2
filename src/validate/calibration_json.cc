#include "lobefit/validate/calibration_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "lobefit/base/version.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json ToObject(const Share& share) {
  return {{"count", share.count},
          {"total", share.total},
          {"share", Number(share.value)},
          {"low", Number(share.low)},
          {"high", Number(share.high)}};
}

Json ToObject(const IntervalCalibration& interval) {
  return {{"z_mean", Number(interval.z_mean)},
          {"z_sd", Number(interval.z_sd)},
          {"within_68", ToObject(interval.within_68)},
          {"within_95", ToObject(interval.within_95)}};
}

// What every document begins with.
Json Head(const Experiment& experiment, bool passed, const std::string& command) {
  return {{"format", "lobefit validation"},
          {"format_version", "1.0"},
          {"version", Version()},
          {"command", command},
          {"passed", passed},
          {"noise", ToText(experiment.noise)},
          {"seed", experiment.seed},
          {"recipe", experiment.recipe.name},
          {"metric", NameOf(MetricChoices(), experiment.recipe.metric)}};
}

Json EntriesOf(const Calibration& calibration) {
  Json entries = Json::object();
  for (const EntryCalibration& entry : calibration.entries) {
    entries[entry.entry.name] = {{"unit", entry.entry.unit},
                                 {"trials", entry.trials},
                                 {"not_determined", entry.not_determined},
                                 {"lost", entry.lost},
                                 {"bias", Number(entry.bias)},
                                 {"bias_error", Number(entry.bias_error)},
                                 {"spread", Number(entry.spread)},
                                 {"mean_stderr", Number(entry.mean_error)},
                                 {"independent", ToObject(entry.independent)},
                                 {"clustered", ToObject(entry.clustered)}};
  }
  return entries;
}

Json Document(const Experiment& experiment, const Calibration& calibration, const std::string& command) {
  Json document = Head(experiment, calibration.passed(), command);
  document.update(Json{
      {"failures", calibration.failures},
      {"trials",
       {{"planned", calibration.planned},
        {"done", calibration.done},
        {"refused", calibration.refused},
        {"not_converged", calibration.not_converged},
        {"not_determined", calibration.not_determined},
        {"wrong_minima", calibration.wrong_minima},
        {"wrong_minima_without_sign", calibration.wrong_unflagged}}},
      {"seconds_a_fit",
       {{"median", Number(calibration.seconds_median)}, {"percentile_95", Number(calibration.seconds_95)}}},
      {"misfit_flagged", ToObject(calibration.misfit)},
      {"bias_named", ToObject(calibration.biased)},
      {"judged", calibration.judge_clustered ? "clustered" : "independent"},
      {"parameters", EntriesOf(calibration)},
  });
  return document;
}

}  // namespace

std::string ToJson(const Experiment& experiment, const Calibration& calibration, const Calibration* without,
                   const std::string& command) {
  Json document = Document(experiment, calibration, command);
  if (without != nullptr) document["without_instrument"] = {{"parameters", EntriesOf(*without)}};
  return document.dump(2) + "\n";
}

std::string ToJson(const Experiment& experiment, const Recovery& recovery, const std::string& command) {
  Json document = Head(experiment, recovery.passed(), command);
  Json exceptions = Json::array();
  for (const Recovery::Exception& exception : recovery.exceptions) {
    exceptions.push_back(
        {{"trial", exception.trial}, {"difference", Number(exception.difference)}, {"reason", exception.reason}});
  }
  document["recovery"] = {{"trials", recovery.trials},         {"limit", recovery.limit},
                          {"median", Number(recovery.median)}, {"largest", Number(recovery.largest)},
                          {"without_sign", recovery.silent},   {"exceptions", exceptions}};
  return document.dump(2) + "\n";
}

std::string ToJsonLine(const std::string& sweep, const std::string& value, const Experiment& experiment,
                       const Calibration& calibration, const std::string& command) {
  Json line = Document(experiment, calibration, command);
  line["sweep"] = sweep;
  line["value"] = value;
  return line.dump() + "\n";
}

}  // namespace lobefit
