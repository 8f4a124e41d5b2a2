// Words for the values of an enumeration, as recipes, documents and help spell them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

template <class Enum>
struct Choice {
  Enum value;
  const char* name;
  const char* description;
};

template <class Enum>
const char* NameOf(const std::vector<Choice<Enum>>& choices, Enum value) {
  for (const Choice<Enum>& choice : choices) {
    if (choice.value == value) return choice.name;
  }
  return "?";
}

template <class Enum>
const Choice<Enum>* Find(const std::vector<Choice<Enum>>& choices, std::string_view name) {
  for (const Choice<Enum>& choice : choices) {
    if (name == choice.name) return &choice;
  }
  return nullptr;
}

template <class Enum>
std::vector<std::string> Names(const std::vector<Choice<Enum>>& choices) {
  std::vector<std::string> names;
  for (const Choice<Enum>& choice : choices) names.emplace_back(choice.name);
  return names;
}

}  // namespace lobefit
