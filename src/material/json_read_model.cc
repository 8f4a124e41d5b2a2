// The model of a document, its parameters, and a table of lobes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/material/json_reader.h"
#include "lobefit/math/vec.h"

namespace lobefit {

Model ReadModel(const JsonReader& reader) {
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

namespace {

double InRange(const JsonReader& reader, const Json& object, const char* name, double low, double high) {
  const double value = reader.Get<double>(object, name);
  if (!(value >= low && value <= high)) {
    reader.Fail(
        fmt::format("member '{}' of the table of lobes is {:g}; it must lie in [{:g}, {:g}]", name, value, low, high));
  }
  return value;
}

std::vector<double> PerChannel(const JsonReader& reader, const Json& object, const char* name, std::size_t channels) {
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

}  // namespace

SelTable ReadSel(const JsonReader& reader, std::size_t channels) {
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

namespace {

// Values that a model can be evaluated at: widths wider and narrower than the bounds of a fit, as slope coordinates
// have them, and reflectances that a recipe let go beyond 1.
void CheckRange(const JsonReader& reader, const Parameter& parameter, double value) {
  constexpr double kNarrowest = 1e-10, kWidest = 10;
  const bool is_shape = parameter.group == ParameterGroup::kShape;
  const bool is_width = is_shape && parameter.name.find("alpha") != std::string::npos;
  const double slack = is_width ? 0 : parameter.unit == "deg" ? 1e-9 : 1e-12;  // rounding, of degrees too
  const double low = is_width ? kNarrowest : parameter.low;
  double high = parameter.high;
  if (is_width) high = std::max(kWidest, parameter.high);
  if (parameter.is_reflectance) high = kLargestReflectance;
  if (value >= low - slack && value <= high + slack) return;
  const double factor = InsideFactor(parameter);
  reader.Fail(fmt::format("parameter '{}' is {:g}; it must lie in [{:g}, {:g}]", parameter.json_name, value / factor,
                          low / factor, high / factor));
}

}  // namespace

void ReadParameters(const JsonReader& reader, Material* material) {
  const Json& json = reader.Member(reader.root(), "parameters");
  for (const Parameter& parameter : Parameters(material->model)) {
    const Json& entry = reader.Member(json, parameter.json_name.c_str());
    const double factor = InsideFactor(parameter);
    FittedParameter fitted;
    const std::size_t expected = parameter.per_channel ? material->channels.size() : 1;
    // null, of what is not known.
    const auto numbers_or_none = [&](const char* member, double by) {
      if (reader.Member(entry, member).is_null()) return std::vector<double>(expected, kNan);
      return reader.GetNumbers(entry, member, by);
    };
    fitted.values = reader.GetNumbers(entry, "value", factor);
    fitted.standard_error = numbers_or_none("stderr", factor);
    fitted.standard_error_clustered = numbers_or_none("stderr_clustered", factor);
    // Documents without degrees of freedom do not know them.
    fitted.freedom.assign(expected, kNan);
    if (entry.contains("clustered_freedom")) fitted.freedom = numbers_or_none("clustered_freedom", 1);
    if (entry.contains("stderr_freedom")) fitted.independent_freedom = numbers_or_none("stderr_freedom", 1);
    if (entry.contains("stderr_by_file")) {
      fitted.standard_error_by_file = numbers_or_none("stderr_by_file", factor);
      fitted.freedom_by_file = numbers_or_none("by_file_freedom", 1);
    }
    fitted.free = reader.Get<bool>(entry, "free");
    fitted.at_bound = reader.Get<bool>(entry, "at_bound");
    const auto check_count = [&](const std::vector<double>& numbers, const char* member, bool may_lack) {
      if (numbers.size() == expected || (may_lack && numbers.empty())) return;
      reader.Fail(fmt::format("parameter '{}' has {} {}, {} belong there", parameter.json_name, numbers.size(), member,
                              expected));
    };
    check_count(fitted.values, "values", false);
    check_count(fitted.standard_error, "of stderr", false);
    check_count(fitted.standard_error_clustered, "of stderr_clustered", false);
    check_count(fitted.freedom, "of clustered_freedom", false);
    check_count(fitted.independent_freedom, "of stderr_freedom", true);
    check_count(fitted.standard_error_by_file, "of stderr_by_file", true);
    check_count(fitted.freedom_by_file, "of by_file_freedom", true);
    for (const double value : fitted.values) CheckRange(reader, parameter, value);
    material->parameters.push_back(fitted);
  }
  const std::size_t coat = CoatOf(material->model);
  if (coat == material->model.lobes.size()) return;
  const std::vector<double>& ior = material->parameters[FirstFresnel(material->model, coat)].values;
  for (const double value : ior) {
    if (value != ior[0]) reader.Fail("the coat's ior differs from channel to channel; it is one for all");
  }
}

}  // namespace lobefit
