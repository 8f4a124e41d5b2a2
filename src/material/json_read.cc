#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/version.h"
#include "lobefit/material/json.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

// What the library says, without the name of its error in brackets.
std::string ReasonOf(const Json::exception& error) {
  const std::string_view reason = error.what();
  const std::size_t end = reason.find("] ");
  return std::string(end == std::string_view::npos ? reason : reason.substr(end + 2));
}

// Members in the order of the file are looked for one after the other: a megabyte of them in one object took 15 s. No
// object of a document has as many as this.
constexpr std::size_t kMostMembers = 1000;

bool HasCrowdedObject(std::string_view text) {
  std::vector<std::size_t> members = {0};  // of the objects that are open
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      quoted = c != '"';
      if (c == '\\') ++i;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      members.push_back(0);
    } else if ((c == '}' || c == ']') && members.size() > 1) {
      members.pop_back();
    } else if (c == ':' && ++members.back() > kMostMembers) {
      return true;
    }
  }
  return false;
}

// Reading: every access names the member in its error.
class Reader {
 public:
  Reader(const Json& json, std::string file) : json_(json), file_(std::move(file)) {}

  [[noreturn]] void Fail(const std::string& message) const {
    throw InputError(fmt::format("{}: {}; write the file with `lobefit fit`", file_, message));
  }
  const Json& Member(const Json& object, const char* name) const {
    if (!object.is_object() || !object.contains(name)) Fail(fmt::format("has no member '{}'", name));
    return object.at(name);
  }
  template <class T>
  T Get(const Json& object, const char* name) const {
    try {
      return Member(object, name).get<T>();
    } catch (const Json::exception&) {
      Fail(fmt::format("member '{}' has the wrong type", name));
    }
  }
  template <class Enum>
  Enum GetChoice(const Json& object, const char* name, const std::vector<Choice<Enum>>& choices) const {
    const std::string text = Get<std::string>(object, name);
    const Choice<Enum>* choice = Find(choices, text);
    if (choice == nullptr) Fail(fmt::format("{} '{}' is not known to this version ({})", name, text, Version()));
    return choice->value;
  }
  std::vector<double> GetNumbers(const Json& object, const char* name, double factor) const {
    const Json& member = Member(object, name);
    std::vector<double> numbers;
    for (const Json& entry : member.is_array() ? member : Json::array({member})) {
      if (!entry.is_number() && !entry.is_null())
        Fail(fmt::format("member '{}' holds something that is not a number", name));
      numbers.push_back(entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.get<double>() * factor);
    }
    return numbers;
  }
  // n x n, row by row; NaN for null.
  std::vector<double> GetMatrix(const Json& object, const char* name, std::size_t n) const {
    std::vector<double> entries;
    for (const Json& row : Member(object, name)) {
      for (const Json& entry : row)
        entries.push_back(entry.is_number() ? entry.get<double>() : std::numeric_limits<double>::quiet_NaN());
    }
    if (entries.size() != n * n) {
      Fail(fmt::format("member '{}' of the covariance has {} entries, {} belong to its {} names", name, entries.size(),
                       n * n, n));
    }
    return entries;
  }
  const Json& root() const { return json_; }

 private:
  const Json& json_;
  std::string file_;
};

Model ReadModel(const Reader& reader) {
  const Json& json = reader.Member(reader.root(), "model");
  Model model;
  for (const Json& lobe : reader.Member(json, "lobes")) {
    Lobe read = {reader.GetChoice(lobe, "ndf", NdfChoices()), reader.GetChoice(lobe, "masking", MaskingChoices()),
                 reader.GetChoice(lobe, "fresnel", FresnelChoices()),
                 lobe.contains("metal") ? reader.Get<std::string>(lobe, "metal") : ""};
    if (lobe.contains("direction")) read.direction = reader.GetChoice(lobe, "direction", LobeDirectionChoices());
    if (lobe.contains("knots")) {
      try {
        read.grid = GridWithKnots(reader.GetNumbers(lobe, "knots", 1));
      } catch (const InputError& error) {
        reader.Fail(error.what());
      }
    }
    model.lobes.push_back(read);
  }
  model.diffuse = reader.GetChoice(json, "diffuse", DiffuseChoices());
  if (model.lobes.empty() && !reader.root().contains("sel")) reader.Fail("model has no lobe");
  if (model.lobes.empty()) return model;
  if (const std::string why = WhyNotEvaluable(model); !why.empty()) reader.Fail(why);
  return model;
}

double InRange(const Reader& reader, const Json& object, const char* name, double low, double high) {
  const double value = reader.Get<double>(object, name);
  if (!(value >= low && value <= high)) {
    reader.Fail(
        fmt::format("member '{}' of the table of lobes is {:g}; it must lie in [{:g}, {:g}]", name, value, low, high));
  }
  return value;
}

std::vector<double> PerChannel(const Reader& reader, const Json& object, const char* name, std::size_t channels) {
  const std::vector<double> values = reader.Get<std::vector<double>>(object, name);
  if (values.size() != channels) {
    reader.Fail(
        fmt::format("member '{}' of the table of lobes has {} values, {} belong there", name, values.size(), channels));
  }
  for (const double value : values) {
    if (!(value >= 0) || !std::isfinite(value))
      reader.Fail(fmt::format("member '{}' of the table of lobes is below 0", name));
  }
  return values;
}

SelTable ReadSel(const Reader& reader, std::size_t channels) {
  const Json& json = reader.Member(reader.root(), "sel");
  SelTable table;
  const std::string quantity = reader.Get<std::string>(json, "quantity");
  table.quantity = quantity == NameOf(SelQuantity::kBrdf) ? SelQuantity::kBrdf : SelQuantity::kBrdfCosineO;
  if (quantity != NameOf(table.quantity))
    reader.Fail(fmt::format("quantity '{}' of the table of lobes is not known", quantity));
  table.isotropic = reader.Get<bool>(json, "isotropic");
  table.bound = reader.Get<bool>(json, "bound");
  for (const Json& entry : reader.Member(json, "slices")) {
    SelSlice slice;
    slice.theta_i = DegreesToRadians(InRange(reader, entry, "theta_i_deg", 0, 90));
    slice.phi_i = DegreesToRadians(InRange(reader, entry, "phi_i_deg", -360, 360));
    slice.constant = PerChannel(reader, entry, "constant", channels);
    for (const Json& lobe : reader.Member(entry, "lobes")) {
      SelShape shape;
      shape.alpha_x = InRange(reader, lobe, "alpha_x", 1e-6, 1);
      shape.alpha_y = InRange(reader, lobe, "alpha_y", 1e-9, shape.alpha_x);
      shape.offset_in = DegreesToRadians(InRange(reader, lobe, "offset_in_deg", -180, 180));
      shape.offset_across = DegreesToRadians(InRange(reader, lobe, "offset_across_deg", -180, 180));
      shape.psi = DegreesToRadians(InRange(reader, lobe, "psi_deg", -360, 360));
      slice.lobes.push_back(shape);
      slice.amplitude.push_back(PerChannel(reader, lobe, "amplitude", channels));
    }
    if (!table.slices.empty() && table.slices[0].lobes.size() != slice.lobes.size())
      reader.Fail("the slices of the table of lobes have different numbers of lobes");
    table.slices.push_back(slice);
  }
  if (table.slices.empty()) reader.Fail("the table of lobes has no slice");
  return table;
}

// Values that a model can be evaluated at: wider than the bounds of a fit where a recipe may widen them or where slope
// coordinates go beyond them.
void CheckRange(const Reader& reader, const Parameter& parameter, double value) {
  constexpr double kWidest = 10;  // of the slope coordinates
  const bool is_shape = parameter.group == ParameterGroup::kShape;
  const bool is_width = is_shape && parameter.name.find("alpha") != std::string::npos;
  if (!std::isfinite(value)) reader.Fail(fmt::format("parameter '{}' has no finite value", parameter.json_name));
  const double factor = InsideFactor(parameter);
  const double slack = parameter.unit == "deg" ? 1e-9 : 0;  // rounding of degrees
  if (is_width && !(value > 0 && value <= std::max(kWidest, parameter.high))) {
    reader.Fail(fmt::format("parameter '{}' is {:g}; it must be above 0 and at most {:g}", parameter.json_name, value,
                            std::max(kWidest, parameter.high)));
  }
  if (is_shape && !is_width && !(value >= parameter.low - slack && value <= parameter.high + slack)) {
    reader.Fail(fmt::format("parameter '{}' is {:g}; it must lie in [{:g}, {:g}]", parameter.json_name, value / factor,
                            parameter.low / factor, parameter.high / factor));
  }
  if (!is_shape && value < 0)
    reader.Fail(fmt::format("parameter '{}' is {:g}; it must not be below 0", parameter.json_name, value));
}

void ReadParameters(const Reader& reader, Material* material) {
  const Json& json = reader.Member(reader.root(), "parameters");
  for (const Parameter& parameter : Parameters(material->model)) {
    const Json& entry = reader.Member(json, parameter.json_name.c_str());
    const double factor = InsideFactor(parameter);
    FittedParameter fitted;
    fitted.values = reader.GetNumbers(entry, "value", factor);
    fitted.standard_error = reader.GetNumbers(entry, "stderr", factor);
    fitted.standard_error_clustered = reader.GetNumbers(entry, "stderr_clustered", factor);
    if (entry.contains("clustered_freedom")) fitted.freedom = reader.GetNumbers(entry, "clustered_freedom", 1);
    if (entry.contains("stderr_freedom")) fitted.independent_freedom = reader.GetNumbers(entry, "stderr_freedom", 1);
    if (entry.contains("stderr_by_file")) {
      fitted.standard_error_by_file = reader.GetNumbers(entry, "stderr_by_file", factor);
      fitted.freedom_by_file = reader.GetNumbers(entry, "by_file_freedom", 1);
    }
    fitted.free = reader.Get<bool>(entry, "free");
    fitted.at_bound = reader.Get<bool>(entry, "at_bound");
    const std::size_t expected = parameter.per_channel ? material->channels.size() : 1;
    if (fitted.values.size() != expected) {
      reader.Fail(fmt::format("parameter '{}' has {} values, {} belong there", parameter.json_name,
                              fitted.values.size(), expected));
    }
    for (const double value : fitted.values) {
      CheckRange(reader, parameter, value);
    }
    material->parameters.push_back(fitted);
  }
  const std::size_t coat = CoatOf(material->model);
  if (coat == material->model.lobes.size()) return;
  constexpr double kMostIndex = 1000;  // beyond any medium; far beyond, nothing enters and the rest divides by that
  const std::vector<double>& ior = material->parameters[FirstFresnel(material->model, coat)].values;
  for (const double value : ior) {
    if (!(value >= 1 && value <= kMostIndex))
      reader.Fail(fmt::format("the coat's ior is {:g}; it must lie in [1, {:g}]", value, kMostIndex));
    if (value != ior[0]) reader.Fail("the coat's ior differs from channel to channel; it is one for all");
  }
}

// What pictures and predictions compute with.
void CheckInstrument(const Reader& reader, const InstrumentUsed& instrument, std::size_t channels) {
  constexpr double kMostHalfAngle = 30.001 * kPi / 180, kMostAngle = 10.001 * kPi / 180;
  for (const double half_angle : {instrument.source, instrument.detector, instrument.across}) {
    if (!(half_angle >= 0 && half_angle <= kMostHalfAngle))
      reader.Fail(
          fmt::format("a half angle of the instrument is {:g} degrees; allowed are 0 to 30", half_angle * 180 / kPi));
  }
  for (const InstrumentHalfAngle& half_angle : instrument.half_angles) {
    const bool known = half_angle.name == "source" || half_angle.name == "detector";
    if (!known)
      reader.Fail(fmt::format("a fitted half angle is named '{}'; allowed are source and detector", half_angle.name));
    if (!(half_angle.value > 0 && half_angle.value <= kMostHalfAngle && half_angle.prior > 0)) {
      reader.Fail(
          fmt::format("the half angle of the {} is {:g} degrees with a prior of {:g}; allowed are above 0 to 30 "
                      "and a prior above 0",
                      half_angle.name, half_angle.value * 180 / kPi, half_angle.prior * 180 / kPi));
    }
  }
  if (instrument.mean != "flux" && instrument.mean != "plain")
    reader.Fail(fmt::format("the mean of the instrument is '{}'; allowed are flux and plain", instrument.mean));
  for (const IncidenceGain& gain : instrument.gains) {
    if (!(gain.gain > 0)) reader.Fail(fmt::format("a gain of the instrument is {:g}; gains are positive", gain.gain));
  }
  for (const InstrumentAngle& angle : instrument.alignment) {
    if (!(std::fabs(angle.value) <= kMostAngle))
      reader.Fail(fmt::format("the alignment's {} is {:g} degrees; allowed are -10 to 10", angle.name,
                              angle.value * 180 / kPi));
  }
  const std::size_t turns = instrument.azimuths.size();
  if (instrument.alignment.size() != (turns == 0 ? 0 : turns + 1))
    reader.Fail(fmt::format("the alignment has {} angles, {} belong to {} turns of the sample",
                            instrument.alignment.size(), turns == 0 ? 0 : turns + 1, turns));
  if (!instrument.offset.empty() && instrument.offset.size() != channels)
    reader.Fail(
        fmt::format("the instrument has {} offsets, the document {} channels", instrument.offset.size(), channels));
}

InstrumentUsed ReadInstrument(const Reader& reader, const Json& json, std::size_t channels) {
  InstrumentUsed instrument;
  instrument.source = DegreesToRadians(reader.Get<double>(json, "source_deg"));
  instrument.detector = DegreesToRadians(reader.Get<double>(json, "detector_deg"));
  instrument.mean = reader.Get<std::string>(json, "mean");
  if (json.contains("detector_across_deg"))
    instrument.across = DegreesToRadians(reader.Get<double>(json, "detector_across_deg"));
  if (json.contains("half_angles")) {
    for (const Json& half_angle : reader.Member(json, "half_angles")) {
      instrument.half_angles.push_back(
          {reader.Get<std::string>(half_angle, "name"), DegreesToRadians(reader.Get<double>(half_angle, "value_deg")),
           reader.GetNumbers(half_angle, "stderr_deg", kPi / 180)[0],
           DegreesToRadians(reader.Get<double>(half_angle, "given_deg")),
           DegreesToRadians(reader.Get<double>(half_angle, "prior_deg")), reader.Get<bool>(half_angle, "determined")});
    }
  }
  if (json.contains("drift")) {
    const Json& drift = reader.Member(json, "drift");
    instrument.drift = {reader.Get<double>(drift, "sd"), reader.Get<bool>(drift, "estimated")};
  }
  if (json.contains("gains")) {
    for (const Json& gain : reader.Member(json, "gains")) {
      instrument.gains.push_back({DegreesToRadians(reader.Get<double>(gain, "theta_i_deg")),
                                  DegreesToRadians(reader.Get<double>(gain, "phi_i_deg")),
                                  reader.Get<double>(gain, "gain"), reader.GetNumbers(gain, "stderr", 1)[0]});
    }
  }
  if (json.contains("alignment")) {
    for (const Json& angle : reader.Member(json, "alignment")) {
      instrument.alignment.push_back({reader.Get<std::string>(angle, "name"),
                                      DegreesToRadians(reader.Get<double>(angle, "value_deg")),
                                      reader.GetNumbers(angle, "stderr_deg", kPi / 180)[0],
                                      DegreesToRadians(reader.Get<double>(angle, "prior_deg")),
                                      reader.GetNumbers(angle, "tilt_correlation", 1)[0]});
    }
  }
  if (json.contains("alignment_correlation"))
    instrument.alignment_correlation = reader.Get<double>(json, "alignment_correlation");
  if (json.contains("sample_azimuths_deg"))
    instrument.azimuths = reader.GetNumbers(json, "sample_azimuths_deg", kPi / 180);
  if (json.contains("told_from_tilt")) instrument.told_from_tilt = reader.Get<bool>(json, "told_from_tilt");
  if (json.contains("offset")) {
    for (const Json& offset : reader.Member(json, "offset"))
      instrument.offset.push_back({reader.Get<double>(offset, "value"), reader.GetNumbers(offset, "stderr", 1)[0]});
  }
  // Documents of a single turn need not say its azimuth.
  if (!instrument.alignment.empty() && instrument.azimuths.empty()) instrument.azimuths = {0};
  CheckInstrument(reader, instrument, channels);
  return instrument;
}

void ReadRest(const Reader& reader, Material* material) {
  const Json& root = reader.root();
  for (const Json& lobe : reader.Member(root, "slope_space")) {
    material->slope_space.push_back({reader.Get<double>(lobe, "slope_x"), reader.Get<double>(lobe, "slope_y"),
                                     reader.Get<double>(lobe, "slope_alpha_x"),
                                     reader.Get<double>(lobe, "slope_alpha_y"), reader.Get<double>(lobe, "slope_r")});
  }
  const Json& covariance = reader.Member(root, "covariance");
  material->covariance_names = reader.Get<std::vector<std::string>>(covariance, "names");
  const std::size_t n = material->covariance_names.size();
  material->covariance = reader.GetMatrix(covariance, "matrix", n);
  if (covariance.contains("clustered")) material->covariance_clustered = reader.GetMatrix(covariance, "clustered", n);
  material->degenerate = reader.Get<std::vector<std::string>>(root, "degenerate");
  const Json& quality = reader.Member(root, "quality");
  material->samples_read = reader.Get<std::size_t>(quality, "samples_read");
  material->samples_used = reader.Get<std::size_t>(quality, "samples_used");
  material->set_aside = reader.Get<std::map<std::string, std::size_t>>(quality, "set_aside");
  material->cost = reader.Get<double>(quality, "cost");
  material->remarks = reader.Get<std::vector<std::string>>(quality, "remarks");
  if (quality.contains("verdict")) {
    material->verdict = {reader.GetChoice(quality, "verdict", VerdictChoices()),
                         reader.GetNumbers(quality, "typical_error", 0.01)[0],
                         reader.GetNumbers(quality, "noise", 0.01)[0], reader.GetNumbers(quality, "explained", 1)[0],
                         reader.Get<std::string>(quality, "advice")};
  }
  if (quality.contains("energy")) {
    const Json& energy = reader.Member(quality, "energy");
    material->energy = EnergyBalance{};
    material->energy->absolute = reader.Get<bool>(energy, "absolute");
    if (material->energy->absolute) {
      *material->energy = {true,
                           reader.GetNumbers(energy, "largest_albedo", 1)[0],
                           DegreesToRadians(reader.Get<double>(energy, "theta_i_deg")),
                           DegreesToRadians(reader.Get<double>(energy, "phi_i_deg")),
                           reader.Get<std::string>(energy, "channel"),
                           reader.Get<std::size_t>(energy, "above_one"),
                           reader.Get<std::size_t>(energy, "incidences")};
    }
  }
  if (quality.contains("tried")) {
    for (const Json& entry : reader.Member(quality, "tried")) {
      material->tried.push_back({reader.Get<std::string>(entry, "model"),
                                 reader.Get<std::size_t>(entry, "free_parameters"),
                                 reader.GetNumbers(entry, "held_out_error", 1)[0],
                                 reader.GetNumbers(entry, "ratio", 1)[0], reader.Get<bool>(entry, "chosen")});
    }
  }
  if (quality.contains("misfit")) {
    const Json& misfit = reader.Member(quality, "misfit");
    material->misfit = {reader.Get<bool>(misfit, "tested"), reader.Get<bool>(misfit, "flagged"),
                        reader.Get<double>(misfit, "probability"), reader.Get<double>(misfit, "size"),
                        reader.Get<std::string>(misfit, "where")};
  }
  if (root.contains("instrument"))
    material->instrument = ReadInstrument(reader, reader.Member(root, "instrument"), material->channels.size());
  for (const auto& [metric, rms] : reader.Member(quality, "errors").items()) {
    material->errors.push_back(
        {metric, rms.is_number() ? rms.get<double>() : std::numeric_limits<double>::quiet_NaN()});
  }
  for (const Json& minimum : reader.Member(root, "minima")) {
    Minimum read;
    read.cost = reader.Get<double>(minimum, "cost");
    read.starts = reader.Get<std::size_t>(minimum, "starts");
    for (const auto& [name, value] : reader.Member(minimum, "parameters").items())
      read.parameters.emplace_back(name, value.get<double>());
    material->minima.push_back(read);
  }
  const Json& termination = reader.Member(root, "termination");
  material->termination = {reader.Get<bool>(termination, "converged"), reader.Get<bool>(termination, "determined"),
                           reader.Get<std::string>(termination, "message"), reader.Get<int>(termination, "iterations")};
  material->timings_s = reader.Get<std::map<std::string, double>>(root, "timings_s");
  const Json& source = reader.Member(root, "source");
  material->source = {reader.Get<std::string>(source, "file"), reader.Get<std::string>(source, "sha256"),
                      reader.Get<std::string>(source, "format"),
                      reader.Get<std::map<std::string, std::string>>(source, "conventions")};
  const Json& recipe = reader.Member(root, "recipe");
  material->recipe_name = reader.Get<std::string>(recipe, "name");
  material->recipe_reason = reader.Get<std::string>(recipe, "reason");
  material->metric = reader.Get<std::string>(recipe, "metric");
  material->weighting = reader.Get<std::string>(recipe, "weighting");
  material->loss = reader.Get<std::string>(recipe, "loss");
  material->theta_max_deg = reader.Get<double>(recipe, "theta_max_deg");
  if (recipe.contains("text")) {
    constexpr std::size_t kMostStarts = 100000;
    constexpr int kMostSteps = 100000;
    material->used = {reader.Get<std::string>(recipe, "text"), reader.Get<std::size_t>(recipe, "starts"),
                      reader.Get<std::uint64_t>(recipe, "seed"), reader.Get<int>(recipe, "scouting_steps"),
                      reader.Get<std::map<std::string, std::string>>(recipe, "reading")};
    if (material->used->starts < 1 || material->used->starts > kMostStarts)
      reader.Fail(fmt::format("the recipe's 'starts' is {}; allowed are 1 to {}", material->used->starts, kMostStarts));
    if (material->used->scouting_steps < 0 || material->used->scouting_steps > kMostSteps) {
      reader.Fail(fmt::format("the recipe's 'scouting_steps' is {}; allowed are 0 to {}",
                              material->used->scouting_steps, kMostSteps));
    }
  }
  material->command = reader.Get<std::string>(root, "command");
}

}  // namespace

Material MaterialFromJson(const std::string& text, const std::string& file_name) {
  if (HasCrowdedObject(text)) {
    throw InputError(
        fmt::format("{}: is not a material document of lobefit (one of its objects has more than {} members)",
                    file_name, kMostMembers));
  }
  Json json;
  try {
    json = Json::parse(text);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: is not JSON: {}", file_name, ReasonOf(error)));
  }
  const Reader reader(json, file_name);
  if (!json.is_object() || json.value("format", Json()) != Json("lobefit material")) {
    throw InputError(file_name +
                     ": is not a material document of lobefit (its member 'format' must be \"lobefit material\")");
  }
  const std::string version = reader.Get<std::string>(json, "format_version");
  if (version.substr(0, 2) != "1.")
    reader.Fail(fmt::format("format_version {} is not readable here; this version reads 1.x", version));
  try {
    Material material;
    material.model = ReadModel(reader);
    material.channels = reader.Get<std::vector<std::string>>(json, "channels");
    material.wavelengths_nm = reader.Get<std::vector<double>>(json, "wavelengths_nm");
    if (material.channels.empty()) reader.Fail("has no channel");
    if (json.contains("sel")) material.sel = ReadSel(reader, material.channels.size());
    ReadParameters(reader, &material);
    ReadRest(reader, &material);
    return material;
  } catch (const Json::exception& error) {
    reader.Fail(fmt::format("does not follow the schema: {}", ReasonOf(error)));
  }
}

Material ReadMaterial(const std::filesystem::path& path) {
  const FileBytes file(path);
  return MaterialFromJson(std::string(file.bytes()), path.string());
}

Material ReadModelMaterial(const std::filesystem::path& path) {
  Material material = ReadMaterial(path);
  if (material.sel) {
    throw InputError(
        path.string() +
        ": holds a table of squared ellipsoidal lobes, which is no model of the surface; fit a recipe with "
        "[[lobe]] for that");
  }
  return material;
}

bool LooksLikeMaterial(const std::filesystem::path& path) {
  // What a stream holds can be read once only, and is a measurement's.
  if (IsStream(path)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string head(256, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.starts_with('{') && head.find("\"lobefit material\"") != std::string::npos;
}

}  // namespace lobefit
