#include "lobefit/recipe/toml_parameter.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/recipe/toml_values.h"

namespace lobefit {

ParameterRecipe ReadParameter(const toml::node& node, const Parameter& parameter, const TomlFile& place) {
  const std::string& name = parameter.json_name;
  if (!node.is_table()) {
    place.Fail(
        node.source(),
        fmt::format("'{}' must be a table such as {{ start = 0.2 }}; keys: start, fixed, bounds, shared, free", name));
  }
  const toml::table& table = *node.as_table();
  place.CheckKeys(table, {"start", "fixed", "bounds", "shared", "free"}, "of parameter '" + name + "'");
  const double factor = InsideFactor(parameter);
  ParameterRecipe recipe;
  recipe.shared = parameter.shared;
  recipe.start = NumberList(table, "start", parameter.per_channel, factor, place);
  recipe.fixed = NumberList(table, "fixed", parameter.per_channel, factor, place);
  if (const toml::node* bounds = table.get("bounds")) {
    const toml::array* array = bounds->as_array();
    const bool two_numbers =
        array != nullptr && array->size() == 2 && array->get(0)->is_number() && array->get(1)->is_number();
    if (!two_numbers)
      place.Fail(bounds->source(), fmt::format("bounds of '{}' must be two numbers, [low, high]", name));
    recipe.low = *array->get(0)->value<double>() * factor;
    recipe.high = *array->get(1)->value<double>() * factor;
    if (!std::isfinite(*recipe.low) || !std::isfinite(*recipe.high))
      place.Fail(bounds->source(), fmt::format("bounds of '{}' must be finite numbers", name));
    if (!(*recipe.low < *recipe.high))
      place.Fail(bounds->source(), fmt::format("bounds of '{}': the first must be below the second", name));
    const double highest = parameter.is_reflectance ? kLargestReflectance : parameter.high;
    if (*recipe.low < parameter.low - 1e-12 || *recipe.high > highest + 1e-12) {
      place.Fail(bounds->source(), fmt::format("bounds of '{}' leave its range [{:g}, {:g}]", name,
                                               parameter.low / factor, highest / factor));
    }
  }
  if (const toml::node* shared = table.get("shared")) {
    if (!shared->is_boolean()) place.Fail(shared->source(), "'shared' must be true or false");
    recipe.shared = *shared->value<bool>();
    if (recipe.shared && !parameter.per_channel)
      place.Fail(shared->source(), fmt::format("'{}' has one value for all channels anyway", name));
  }
  if (!recipe.fixed.empty() && (!recipe.start.empty() || recipe.low))
    place.Fail(node.source(), fmt::format("'{}' is fixed: start and bounds do not apply", name));
  if (const toml::node* free = table.get("free")) {
    if (!free->is_boolean() || !*free->value<bool>())
      place.Fail(free->source(), fmt::format("'free' of '{}' must be true; {{ fixed = ... }} fixes it", name));
    recipe.free = true;
  }
  const bool may_be_free = parameter.free || parameter.group != ParameterGroup::kShape;
  if (recipe.free && (!may_be_free || !recipe.fixed.empty())) {
    place.Fail(node.source(), recipe.fixed.empty()
                                  ? fmt::format("'{}' is not a free parameter of this ndf; it can only be fixed", name)
                                  : fmt::format("'{}' is both fixed and free", name));
  }
  if (!parameter.free && !recipe.free && (!recipe.start.empty() || recipe.low || recipe.shared != parameter.shared)) {
    place.Fail(node.source(),
               may_be_free ? fmt::format("'{}' is not fitted unless it has free = true", name)
                           : fmt::format("'{}' is not a free parameter of this ndf; it can only be fixed", name));
  }
  for (const std::vector<double>& values : {recipe.start, recipe.fixed}) {
    for (const double value : values) {
      const double low = recipe.low.value_or(parameter.low), high = recipe.high.value_or(parameter.high);
      if (value < low - 1e-12 || value > high + 1e-12) {
        place.Fail(node.source(), fmt::format("'{}' = {:g} lies outside its bounds [{:g}, {:g}]", name, value / factor,
                                              low / factor, high / factor));
      }
    }
  }
  return recipe;
}

}  // namespace lobefit
