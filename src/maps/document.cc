#include "lobefit/maps/document.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/version.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

Json Lights(const std::vector<std::size_t>& indices) {
  Json list = Json::array();
  for (const std::size_t index : indices) list.push_back(index + 1);
  return list;
}

// What is shared, with its errors; amplitudes as in the maps.
Json SharedGroup(const Stack& stack, const MapRecipe& recipe, const SharedNumbers::Group& group) {
  const MapModel model = {recipe.rules.lobe, static_cast<int>(stack.channels), recipe.rules.schlick};
  const HeldNumbers& held = group.held;
  const MapPoint& point = held.point;
  Json json = {{"texels", group.texels}};
  const auto number = [](double value) { return std::isnan(value) ? Json() : Json(value); };
  if (held.normal) json["normal"] = {point.normal.x, point.normal.y, point.normal.z};
  if (held.slope) json["mean_slope"] = {point.slope[0], point.slope[1]};
  if (held.width && model.Shape() == 3) {
    json["alpha"] = number(std::exp(point.width[0])), json["ln_alpha_stderr"] = number(group.error[2]);
  } else if (held.width) {
    json["slope_widths"] = {std::exp(point.width[0]), point.width[1], std::exp(point.width[2])};
  }
  const auto amplitudes = [&](const char* name, const std::array<double, kMostChannels>& values, double unit,
                              const auto& at) {
    for (int c = 0; c < model.channels; ++c) {
      json[name].push_back(unit * values[static_cast<std::size_t>(c)]);
      json[std::string(name) + "_stderr"].push_back(number(unit * group.error[static_cast<std::size_t>(at(c))]));
    }
  };
  if (held.diffuse) amplitudes("diffuse", point.diffuse, kPi, [&](int c) { return model.DiffuseAt(c); });
  if (held.f0) amplitudes("f0", point.f0, 1, [&](int c) { return model.F0At(c); });
  return json;
}

}  // namespace

std::string MapsDocument(const Stack& stack, const MapsOptions& options, const MapsResult& result,
                         const std::string& digest, const std::string& command) {
  const MapsSummary& s = result.summary;
  Json json = {{"schema", "lobefit-maps-1"},
               {"version", Version()},
               {"command", command},
               {"maps", options.name + ".maps.exr"},
               {"recipe", options.recipe.name},
               {"settings", RecipeText(options.recipe)},
               {"source",
                {{"stack", stack.path.filename().string()},
                 {"layout", stack.layout},
                 {"sha256", digest},
                 {"width", stack.width},
                 {"height", stack.height},
                 {"channels", stack.channels},
                 {"images", stack.images.size()},
                 {"encoding", EncodingWord(stack.response)},
                 {"calibrated", stack.calibrated},
                 {"left_out_lights", Lights(options.left_out)},
                 {"remarks", stack.remarks}}},
               {"conventions",
                {{"frame", "x right, y up, z to the camera; rows of the picture run down"},
                 {"unit", stack.calibrated ? "diffuse and f0 are albedo and reflectance"
                                           : "diffuse and f0 times one unknown factor of the stack"},
                 {"errors", "standard errors; NaN: not determined; ln_alpha: of the logarithm of alpha"},
                 {"normal.doubt_deg", "to sort texels by: the normal's error if the misfit is smooth, no noise"},
                 {"status",
                  {{"outside", kMapOutside},
                   {"too_few_values", kMapTooFew},
                   {"not_determined", kMapNotDetermined},
                   {"at_bound", kMapAtBound},
                   {"not_converged", kMapNotConverged},
                   {"no_lobe", kMapNoLobe}}}}},
               {"texels",
                {{"fitted", s.texels},
                 {"normal_determined", s.normal},
                 {"lobe", s.lobe},
                 {"alpha_determined", s.alpha},
                 {"no_lobe", s.no_lobe},
                 {"at_bound", s.at_bound},
                 {"not_converged", s.not_converged},
                 {"too_few_values", s.too_few}}},
               {"mean_rms", s.mean_rms},
               {"mean_lights_used", s.mean_used}};
  for (const SharedNumbers::Group& group : result.shared.groups) {
    json["shared"].push_back(SharedGroup(stack, options.recipe, group));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

MapsRecord ReadMapsRecord(const std::filesystem::path& document) {
  const FileBytes bytes(document);
  const nlohmann::json json = nlohmann::json::parse(bytes.bytes(), nullptr, false);
  const auto fail = [&]() {
    throw InputError(PrintableName(document) + ": is not the document that `lobefit maps` writes beside NAME.maps.exr");
  };
  if (!json.is_object() || json.value("schema", "") != "lobefit-maps-1" || !json.contains("source")) fail();
  const nlohmann::json& source = json["source"];
  if (!source.is_object() || !source.contains("calibrated") || !source["calibrated"].is_boolean()) fail();
  MapsRecord record = {source["calibrated"].get<bool>(), {}, {}};
  if (source.contains("stack") && source["stack"].is_string()) record.stack = source["stack"].get<std::string>();
  for (const nlohmann::json& light : source.value("left_out_lights", nlohmann::json::array())) {
    if (!light.is_number_unsigned() || light.get<std::size_t>() == 0) fail();
    record.left_out.push_back(light.get<std::size_t>() - 1);
  }
  return record;
}

}  // namespace lobefit
