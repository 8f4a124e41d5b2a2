#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/version.h"
#include "lobefit/material/abg.h"
#include "lobefit/material/json.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

// A scalar for one entry that is not per channel, else an array; values times 1 / factor.
Json Numbers(const std::vector<double>& values, bool per_channel, double factor) {
  if (values.empty()) return nullptr;
  if (!per_channel) return Number(values[0] / factor);
  Json array = Json::array();
  for (const double value : values) array.push_back(Number(value / factor));
  return array;
}

Json ModelToJson(const Model& model) {
  Json lobes = Json::array();
  for (const Lobe& lobe : model.lobes) {
    Json entry = {{"ndf", NameOf(NdfChoices(), lobe.ndf)},
                  {"masking", NameOf(MaskingChoices(), lobe.masking)},
                  {"fresnel", NameOf(FresnelChoices(), lobe.fresnel)}};
    if (!lobe.metal.empty()) entry["metal"] = lobe.metal;
    if (lobe.direction != LobeDirection::kSpecular) entry["direction"] = NameOf(LobeDirectionChoices(), lobe.direction);
    if (GridOf(lobe) != nullptr) entry["knots"] = GridOf(lobe)->spline()->knots();
    lobes.push_back(entry);
  }
  return {{"lobes", lobes}, {"diffuse", NameOf(DiffuseChoices(), model.diffuse)}};
}

Json ParametersToJson(const Material& material) {
  Json object = Json::object();
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const FittedParameter& fitted = material.parameters[i];
    const double factor = InsideFactor(parameter);
    object[parameter.json_name] = {
        {"value", Numbers(fitted.values, parameter.per_channel, factor)},
        {"stderr", Numbers(fitted.standard_error, parameter.per_channel, factor)},
        {"stderr_clustered", Numbers(fitted.standard_error_clustered, parameter.per_channel, factor)},
        {"clustered_freedom", Numbers(fitted.freedom, parameter.per_channel, 1)},
        {"unit", parameter.unit},
        {"free", fitted.free},
        {"at_bound", fitted.at_bound}};
    Json& entry = object[parameter.json_name];
    if (!fitted.independent_freedom.empty())
      entry["stderr_freedom"] = Numbers(fitted.independent_freedom, parameter.per_channel, 1);
    if (fitted.standard_error_by_file.empty()) continue;
    entry["stderr_by_file"] = Numbers(fitted.standard_error_by_file, parameter.per_channel, factor);
    entry["by_file_freedom"] = Numbers(fitted.freedom_by_file, parameter.per_channel, 1);
  }
  return object;
}

Json SlopeSpaceToJson(const Material& material) {
  Json lobes = Json::array();
  for (const std::vector<double>& s : material.slope_space) {
    lobes.push_back(
        {{"slope_x", s[0]}, {"slope_y", s[1]}, {"slope_alpha_x", s[2]}, {"slope_alpha_y", s[3]}, {"slope_r", s[4]}});
  }
  return lobes;
}

// What follows from an ABg lobe's parameters; not read back.
Json AbgToJson(const Material& material) {
  Json lobes = Json::array(), scatter = Json::array();
  for (const AbgNumbers& n : AbgNumbersOf(material)) {
    lobes.push_back({{"lobe", n.lobe + 1},
                     {"channel", n.channel},
                     {"A", n.A},
                     {"A_stderr", Number(n.A_error)},
                     {"B", n.B},
                     {"B_stderr", Number(n.B_error)},
                     {"g", n.g},
                     {"g_stderr", Number(n.g_error)}});
  }
  for (const ScatterAt& at : material.scatter) {
    scatter.push_back({{"theta_i_deg", RadiansToDegrees(at.theta_i)},
                       {"phi_i_deg", RadiansToDegrees(at.phi_i)},
                       {"share", at.share}});
  }
  return {{"lobes", lobes}, {"total_integrated_scatter", scatter}};
}

Json MatrixToJson(const std::vector<double>& entries, std::size_t n) {
  Json matrix = Json::array();
  for (std::size_t i = 0; i < n; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < n; ++j) row.push_back(Number(entries[i * n + j]));
    matrix.push_back(row);
  }
  return matrix;
}

Json CovarianceToJson(const Material& material) {
  const std::size_t n = material.covariance_names.size();
  Json covariance = {{"names", material.covariance_names}, {"matrix", MatrixToJson(material.covariance, n)}};
  if (!material.covariance_clustered.empty()) covariance["clustered"] = MatrixToJson(material.covariance_clustered, n);
  return covariance;
}

Json QualityToJson(const Material& material) {
  Json errors = Json::object();
  for (const MetricError& error : material.errors) errors[error.metric] = Number(error.rms);
  Json quality = {{"samples_read", material.samples_read},
                  {"samples_used", material.samples_used},
                  {"set_aside", material.set_aside},
                  {"cost", Number(material.cost)},
                  {"errors", errors},
                  {"remarks", material.remarks}};
  if (material.verdict) {
    const Verdict& verdict = *material.verdict;
    quality["verdict"] = NameOf(VerdictChoices(), verdict.kind);
    quality["typical_error"] = Number(100 * verdict.typical_error);
    quality["noise"] = Number(100 * verdict.noise);
    quality["explained"] = Number(verdict.explained);
    quality["advice"] = verdict.advice;
  }
  if (material.energy) {
    const EnergyBalance& energy = *material.energy;
    quality["energy"] = {{"absolute", energy.absolute}};
    if (energy.absolute) {
      quality["energy"]["largest_albedo"] = Number(energy.albedo);
      quality["energy"]["theta_i_deg"] = RadiansToDegrees(energy.theta_i);
      quality["energy"]["phi_i_deg"] = RadiansToDegrees(energy.phi_i);
      quality["energy"]["channel"] = energy.channel;
      quality["energy"]["above_one"] = energy.above_one;
      quality["energy"]["incidences"] = energy.incidences;
    }
  }
  if (!material.tried.empty()) {
    Json tried = Json::array();
    for (const TriedModel& model : material.tried) {
      tried.push_back({{"model", model.name},
                       {"free_parameters", model.free_parameters},
                       {"held_out_error", Number(model.held_out)},
                       {"ratio", Number(model.ratio)},
                       {"chosen", model.chosen}});
    }
    quality["tried"] = tried;
  }
  if (material.misfit) {
    const Misfit& misfit = *material.misfit;
    quality["misfit"] = {{"tested", misfit.tested},
                         {"flagged", misfit.flagged},
                         {"probability", Number(misfit.probability)},
                         {"size", Number(misfit.size)},
                         {"where", misfit.where}};
  }
  return quality;
}

Json MinimaToJson(const Material& material) {
  Json minima = Json::array();
  for (const Minimum& minimum : material.minima) {
    Json parameters = Json::object();
    for (const auto& [name, value] : minimum.parameters) parameters[name] = Number(value);
    minima.push_back({{"cost", Number(minimum.cost)}, {"starts", minimum.starts}, {"parameters", parameters}});
  }
  return minima;
}

Json SelToJson(const SelTable& table) {
  Json slices = Json::array();
  for (const SelSlice& slice : table.slices) {
    Json lobes = Json::array();
    for (std::size_t l = 0; l < slice.lobes.size(); ++l) {
      const SelShape& shape = slice.lobes[l];
      lobes.push_back({{"alpha_x", shape.alpha_x},
                       {"alpha_y", shape.alpha_y},
                       {"offset_in_deg", RadiansToDegrees(shape.offset_in)},
                       {"offset_across_deg", RadiansToDegrees(shape.offset_across)},
                       {"psi_deg", RadiansToDegrees(shape.psi)},
                       {"amplitude", slice.amplitude[l]}});
    }
    slices.push_back({{"theta_i_deg", RadiansToDegrees(slice.theta_i)},
                      {"phi_i_deg", RadiansToDegrees(slice.phi_i)},
                      {"constant", slice.constant},
                      {"lobes", lobes}});
  }
  return {
      {"quantity", NameOf(table.quantity)}, {"isotropic", table.isotropic}, {"bound", table.bound}, {"slices", slices}};
}

Json InstrumentToJson(const InstrumentUsed& instrument) {
  Json json = {{"source_deg", RadiansToDegrees(instrument.source)},
               {"detector_deg", RadiansToDegrees(instrument.detector)},
               {"mean", instrument.mean}};
  if (instrument.across > 0) json["detector_across_deg"] = RadiansToDegrees(instrument.across);
  for (const InstrumentHalfAngle& half_angle : instrument.half_angles) {
    json["half_angles"].push_back({{"name", half_angle.name},
                                   {"value_deg", RadiansToDegrees(half_angle.value)},
                                   {"stderr_deg", Number(RadiansToDegrees(half_angle.standard_error))},
                                   {"given_deg", RadiansToDegrees(half_angle.given)},
                                   {"prior_deg", RadiansToDegrees(half_angle.prior)},
                                   {"determined", half_angle.determined}});
  }
  if (instrument.drift) json["drift"] = {{"sd", instrument.drift->sd}, {"estimated", instrument.drift->estimated}};
  for (const IncidenceGain& gain : instrument.gains) {
    json["gains"].push_back({{"theta_i_deg", RadiansToDegrees(gain.theta_i)},
                             {"phi_i_deg", RadiansToDegrees(gain.phi_i)},
                             {"gain", gain.gain},
                             {"stderr", Number(gain.standard_error)}});
  }
  for (const InstrumentAngle& angle : instrument.alignment) {
    json["alignment"].push_back({{"name", angle.name},
                                 {"value_deg", RadiansToDegrees(angle.value)},
                                 {"stderr_deg", Number(RadiansToDegrees(angle.standard_error))},
                                 {"prior_deg", RadiansToDegrees(angle.prior)},
                                 {"tilt_correlation", Number(angle.tilt_correlation)}});
  }
  if (!instrument.alignment.empty()) json["alignment_correlation"] = Number(instrument.alignment_correlation);
  for (const double azimuth : instrument.azimuths) json["sample_azimuths_deg"].push_back(RadiansToDegrees(azimuth));
  if (instrument.told_from_tilt) json["told_from_tilt"] = *instrument.told_from_tilt;
  for (const InstrumentOffset& offset : instrument.offset)
    json["offset"].push_back({{"value", offset.value}, {"stderr", Number(offset.standard_error)}});
  return json;
}

}  // namespace

std::string ToJson(const Material& material) {
  Json json = {
      {"format", "lobefit material"},
      {"format_version", "1.0"},
      {"version", Version()},
      {"command", material.command},
      {"model", ModelToJson(material.model)},
      {"channels", material.channels},
      {"wavelengths_nm", material.wavelengths_nm},
      {"parameters", ParametersToJson(material)},
      {"slope_space", SlopeSpaceToJson(material)},
      {"covariance", CovarianceToJson(material)},
      {"degenerate", material.degenerate},
      {"quality", QualityToJson(material)},
      {"minima", MinimaToJson(material)},
      {"termination",
       {{"converged", material.termination.converged},
        {"determined", material.termination.determined},
        {"message", material.termination.message},
        {"iterations", material.termination.iterations}}},
      {"timings_s", material.timings_s},
      {"source",
       {{"file", material.source.file},
        {"sha256", material.source.sha256},
        {"format", material.source.format},
        {"conventions", material.source.conventions}}},
      {"recipe",
       {{"name", material.recipe_name},
        {"reason", material.recipe_reason},
        {"metric", material.metric},
        {"weighting", material.weighting},
        {"loss", material.loss},
        {"theta_max_deg", material.theta_max_deg}}},
  };
  const std::vector<Lobe>& lobes = material.model.lobes;
  if (std::any_of(lobes.begin(), lobes.end(), [](const Lobe& lobe) { return FamilyOf(lobe.ndf) == Family::kAbg; }))
    json["abg"] = AbgToJson(material);
  if (material.used) {
    const RecipeUsed& used = *material.used;
    Json& recipe = json["recipe"];
    recipe["text"] = used.text;
    recipe["starts"] = used.starts;
    recipe["seed"] = used.seed;
    recipe["scouting_steps"] = used.scouting_steps;
    recipe["reading"] = used.reading;
  }
  if (material.sel) json["sel"] = SelToJson(*material.sel);
  if (material.instrument) json["instrument"] = InstrumentToJson(*material.instrument);
  // Bytes that are not UTF-8 (a file name may hold any) become the replacement character.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void WriteMaterial(const Material& material, const std::filesystem::path& path) {
  WriteFileAtomically(path, ToJson(material));
}

}  // namespace lobefit
