// Values of a recipe's TOML: a number, a name out of a list, a table, numbers of channels; nothing where the key is not
// there. What is not of that kind ends in InputError with file and line. Internal to the recipe's readers.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/choice.h"
#include "lobefit/base/files/toml_file.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

inline std::optional<double> OptionalNumber(const toml::table& table, const char* key, const TomlFile& place) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  const std::optional<double> value = node->value<double>();
  if (!value || !node->is_number() || !std::isfinite(*value)) {
    place.Fail(node->source(), fmt::format("'{}' must be a finite number", key));
  }
  return value;
}

template <class Enum>
void ReadChoice(const toml::table& table, const char* key, const std::vector<Choice<Enum>>& choices,
                const TomlFile& place, Enum* value) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return;
  const std::optional<std::string> text = node->value<std::string>();
  const Choice<Enum>* choice = text && node->is_string() ? Find(choices, *text) : nullptr;
  if (choice == nullptr) {
    const std::vector<std::string> names = Names(choices);
    place.Fail(node->source(), fmt::format("{} = '{}' is unknown{}; allowed: {}", key, text.value_or("?"),
                                           DidYouMean(text.value_or(""), names), Join(names)));
  }
  *value = choice->value;
}

inline const toml::table* TableOf(const toml::table& table, const char* key, const TomlFile& place) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) place.Fail(node->source(), fmt::format("'{}' must be a table", key));
  return node->as_table();
}

// A number or, where `per_channel`, a list of numbers; times `factor`.
inline std::vector<double> NumberList(const toml::table& table, const char* key, bool per_channel, double factor,
                                      const TomlFile& place) {
  std::vector<double> numbers;
  const toml::node* node = table.get(key);
  if (node == nullptr) return numbers;
  const toml::array* array = node->as_array();
  if (array == nullptr) return {*OptionalNumber(table, key, place) * factor};
  for (const toml::node& entry : *array) {
    const std::optional<double> value = entry.value<double>();
    if (!per_channel || !value || !entry.is_number() || !std::isfinite(*value)) {
      place.Fail(node->source(), fmt::format("'{}' must be a finite number{}", key,
                                             per_channel ? " or a list of them, one a channel" : ""));
    }
    numbers.push_back(*value * factor);
  }
  if (numbers.empty()) place.Fail(node->source(), fmt::format("'{}' is an empty list", key));
  return numbers;
}

}  // namespace lobefit
