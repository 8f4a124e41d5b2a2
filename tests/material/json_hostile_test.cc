// Documents that were edited by hand or by other programs: each member taken away, and each replaced by what does not
// belong there. A reader says what is wrong, or has read a material that it can write again.
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/schema.h"
#include "tests/support/synthetic.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/fit/fit.h"
#include "lobefit/material/json.h"

namespace lobefit {
namespace {

using Json = nlohmann::json;
using Place = Json::json_pointer;

// A fit with an instrument, so that all parts of a document are there.
const Json& Good() {
  static const Json document = [] {
    Measurement measurement = Synthetic(OneLobe(Ndf::kEllipsoid, 0.3, 0.12, 1, 2, 20), StandardLayout(), 0.05, 3);
    measurement.conventions["value-kind"] = "f (header)";
    Material material = Fit(AutomaticRecipe(TraitsOf(measurement)), {}, &measurement);
    InstrumentUsed instrument;
    instrument.source = 0.01;
    instrument.mean = "flux";
    instrument.drift = {0.02, true};
    instrument.half_angles = {{"source", 0.01, 0.001, 0.012, 0.003, true}};
    instrument.gains = {{0.5, 0.1, 1.02, 0.01}};
    instrument.alignment = {{"e_x", 0.002, 0.001, 0.003, 0.9}, {"e_y", 0.001, 0.001, 0.003, 0.1}};
    instrument.alignment_correlation = 0.25;
    material.instrument = instrument;
    return Json::parse(ToJson(material));
  }();
  return document;
}

// Of all members, and of the first and the last element of lists.
void Places(const Json& json, const Place& at, std::vector<Place>* places) {
  if (!at.empty()) places->push_back(at);
  if (json.is_object()) {
    for (const auto& [key, value] : json.items()) Places(value, at / key, places);
  } else if (json.is_array() && !json.empty()) {
    Places(json.front(), at / 0, places);
    if (json.size() > 1) Places(json.back(), at / (json.size() - 1), places);
  }
}

std::vector<Place> AllPlaces() {
  std::vector<Place> places;
  Places(Good(), Place(), &places);
  EXPECT_GT(places.size(), 200U);
  return places;
}

// The first complaint about a document that is neither refused in words nor read as a material.
std::string FaultOf(const Json& json) {
  std::string again;
  try {
    again = ToJson(MaterialFromJson(json.dump(), "m.json"));
  } catch (const InputError& error) {
    const std::string words = error.what();
    if (!words.starts_with("m.json: ")) return "does not name the file: " + words;
    return words.size() > 600 ? "too long a message: " + words : "";
  } catch (const std::exception& error) {
    return std::string("another error: ") + error.what();
  }
  const testing::AssertionResult follows = FollowsSchema(again);
  if (!follows) return std::string("written again it breaks the schema: ") + follows.message();
  return ToJson(MaterialFromJson(again, "m.json")) == again ? "" : "does not read back as itself";
}

TEST(HostileMaterial, TheGoodOneIsRead) { EXPECT_EQ(FaultOf(Good()), ""); }

TEST(HostileMaterial, EachMemberTakenAway) {
  for (const Place& place : AllPlaces()) {
    Json json = Good();
    Json& parent = json[place.parent_pointer()];
    if (parent.is_object()) {
      parent.erase(place.back());
    } else {
      parent.erase(std::stoul(place.back()));
    }
    EXPECT_EQ(FaultOf(json), "") << place.to_string();
  }
}

class Replaced : public testing::TestWithParam<const char*> {};

TEST_P(Replaced, EachMember) {
  const Json value = Json::parse(GetParam());
  for (const Place& place : AllPlaces()) {
    Json json = Good();
    json[place] = value;
    EXPECT_EQ(FaultOf(json), "") << place.to_string() << " = " << GetParam();
  }
}

INSTANTIATE_TEST_SUITE_P(HostileMaterial, Replaced,
                         testing::Values("null", "true", "-1", "1e308", "9223372036854775807", "\"\"",
                                         "\"\\u0000\\u001b[31m\"", "\"abc\"", "[]", "[null]", "{}"));

// Lists of a parameter are as long as its values: readers of the document index them alike.
TEST(HostileMaterial, ListsOfOtherLengths) {
  for (const char* name : {"f0", "alpha_x"}) {
    for (const char* member : {"stderr", "stderr_clustered", "clustered_freedom", "stderr_freedom"}) {
      for (const Json& list : {Json{0.1, 0.2}, Json{0.1, 0.2, 0.3, 0.4}, Json(0.1)}) {
        Json json = Good();
        if (std::string(name) == "alpha_x" && list.is_number()) continue;
        json["parameters"][name][member] = list;
        EXPECT_THAT([&] { MaterialFromJson(json.dump(), "m.json"); },
                    testing::ThrowsMessage<InputError>(
                        testing::HasSubstr("m.json: parameter '" + std::string(name) + "' has ")))
            << name << " " << member << " " << list;
      }
    }
  }
  // Materials that were not fitted have no errors.
  Json bare = Good();
  for (const char* member : {"stderr", "stderr_clustered", "clustered_freedom"})
    bare["parameters"]["f0"][member] = nullptr;
  for (const FittedParameter& parameter : MaterialFromJson(bare.dump(), "m.json").parameters) {
    EXPECT_EQ(parameter.standard_error.size(), parameter.values.size());
    EXPECT_EQ(parameter.standard_error_clustered.size(), parameter.values.size());
    EXPECT_EQ(parameter.freedom.size(), parameter.values.size());
  }
  Json json = Good();
  for (auto& [name, parameter] : json["parameters"].items()) parameter.erase("clustered_freedom");
  for (const FittedParameter& parameter : MaterialFromJson(json.dump(), "m.json").parameters)
    EXPECT_EQ(parameter.freedom.size(), parameter.values.size()) << "not known";
}

// What a fit could not compute is written as null and read as what it was.
TEST(HostileMaterial, WhatIsNotANumberIsReadBack) {
  Material material = MaterialFromJson(Good().dump(), "m.json");
  material.cost = material.minima.at(0).cost = std::nan("");
  EXPECT_EQ(FaultOf(Json::parse(ToJson(material))), "");
  EXPECT_TRUE(std::isnan(MaterialFromJson(ToJson(material), "m.json").cost));
}

// The document cut short at any place is refused, and the message says so.
TEST(HostileMaterial, CutShort) {
  const std::string text = Good().dump();
  for (std::size_t end = 0; end < text.size(); end += 1 + text.size() / 150) {
    EXPECT_THROW(MaterialFromJson(text.substr(0, end), "m.json"), InputError) << end;
  }
  EXPECT_THROW(MaterialFromJson(text + "}", "m.json"), InputError);
  EXPECT_THROW(MaterialFromJson(std::string(100000, '['), "m.json"), InputError) << "deep";
}

}  // namespace
}  // namespace lobefit
