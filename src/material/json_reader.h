// What the parts of a document are read by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/choice.h"
#include "lobefit/base/error.h"
#include "lobefit/base/version.h"
#include "lobefit/material/material.h"

namespace lobefit {

using Json = nlohmann::ordered_json;

// Reading: every access names the member in its error.
class JsonReader {
 public:
  JsonReader(const Json& json, std::string file) : json_(json), file_(std::move(file)) {}

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
  // How many there are of something: the library would take -1 for the largest number and 1e308 for any.
  template <class T>
  T GetCount(const Json& object, const char* name) const {
    const Json& member = Member(object, name);
    const bool whole = member.is_number_integer() && (member.is_number_unsigned() || member.get<std::int64_t>() >= 0);
    if (!whole || member.get<std::uint64_t>() > static_cast<std::uint64_t>(std::numeric_limits<T>::max()))
      Fail(fmt::format("member '{}' is no whole number from 0", name));
    return member.get<T>();
  }
  // NaN for null.
  double GetNumber(const Json& object, const char* name) const {
    const Json& member = Member(object, name);
    return member.is_null() ? std::numeric_limits<double>::quiet_NaN() : Get<double>(object, name);
  }
  double GetWithin(const Json& object, const char* name, double low, double high) const {
    const double value = Get<double>(object, name);
    if (!(value >= low && value <= high))
      Fail(fmt::format("member '{}' is {:g}; it must lie in [{:g}, {:g}]", name, value, low, high));
    return value;
  }
  template <class Enum>
  Enum GetChoice(const Json& object, const char* name, const std::vector<Choice<Enum>>& choices) const {
    const std::string text = Get<std::string>(object, name);
    const Choice<Enum>* choice = Find(choices, text);
    if (choice == nullptr) Fail(fmt::format("{} '{}' is not known to this version ({})", name, text, Version()));
    return choice->value;
  }
  // A number or a list of them, at least one, times `factor`; NaN for null.
  std::vector<double> GetNumbers(const Json& object, const char* name, double factor) const {
    const Json& member = Member(object, name);
    if (member.is_array() && member.empty()) Fail(fmt::format("member '{}' holds no number", name));
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

Model ReadModel(const JsonReader& reader);
SelTable ReadSel(const JsonReader& reader, std::size_t channels);
// Of the material's model.
void ReadParameters(const JsonReader& reader, Material* material);
InstrumentUsed ReadInstrument(const JsonReader& reader, const Json& json, std::size_t channels);

}  // namespace lobefit
