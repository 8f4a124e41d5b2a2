#include <nlohmann/json.hpp>

#include "lobefit/base/files/file.h"
#include "lobefit/maps/shared_numbers.h"

namespace lobefit {
namespace {

using SharedJson = nlohmann::json;

// NaN is null.
template <std::size_t kCount>
bool Read(const SharedJson& list, std::array<double, kCount>* values) {
  if (!list.is_array() || list.size() != kCount) return false;
  for (std::size_t k = 0; k < kCount; ++k) {
    if (!list[k].is_number() && !list[k].is_null()) return false;
    (*values)[k] = list[k].is_null() ? kNan : list[k].get<double>();
  }
  return true;
}

}  // namespace

void WriteShared(const SharedNumbers& shared, const std::filesystem::path& file) {
  SharedJson json = {
      {"unit", shared.clusters.unit}, {"centers", shared.clusters.centers}, {"groups", SharedJson::array()}};
  for (const SharedNumbers::Group& group : shared.groups) {
    const HeldNumbers& h = group.held;
    const Vec3& n = h.point.normal;
    json["groups"].push_back({{"held", {h.normal, h.slope, h.width, h.diffuse, h.f0}},
                              {"normal", {n.x, n.y, n.z}},
                              {"slope", h.point.slope},
                              {"width", h.point.width},
                              {"diffuse", h.point.diffuse},
                              {"f0", h.point.f0},
                              {"error", group.error},
                              {"texels", group.texels}});
  }
  WriteFileAtomically(file, json.dump() + "\n");
}

std::optional<SharedNumbers> ReadShared(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  const FileBytes bytes(file);
  const SharedJson json = SharedJson::parse(bytes.bytes(), nullptr, false);
  if (!json.is_object() || !json.contains("groups") || !json.contains("centers")) return std::nullopt;
  SharedNumbers shared;
  if (!Read(json.value("unit", SharedJson()), &shared.clusters.unit)) return std::nullopt;
  for (const SharedJson& center : json["centers"]) {
    shared.clusters.centers.emplace_back();
    if (!Read(center, &shared.clusters.centers.back())) return std::nullopt;
  }
  for (const SharedJson& item : json["groups"]) {
    SharedNumbers::Group group;
    std::array<double, 3> normal;
    MapPoint& point = group.held.point;
    const SharedJson held = item.value("held", SharedJson());
    if (!Read(item.value("normal", SharedJson()), &normal) || !Read(item.value("slope", SharedJson()), &point.slope) ||
        !Read(item.value("width", SharedJson()), &point.width) ||
        !Read(item.value("diffuse", SharedJson()), &point.diffuse) ||
        !Read(item.value("f0", SharedJson()), &point.f0) || !Read(item.value("error", SharedJson()), &group.error) ||
        !held.is_array() || held.size() != kSharedKinds) {
      return std::nullopt;
    }
    bool* const flags[] = {&group.held.normal, &group.held.slope, &group.held.width, &group.held.diffuse,
                           &group.held.f0};
    for (std::size_t k = 0; k < kSharedKinds; ++k) {
      if (!held[k].is_boolean()) return std::nullopt;
      *flags[k] = held[k].get<bool>();
    }
    point.normal = {normal[0], normal[1], normal[2]};
    group.texels = item.value("texels", std::size_t{0});
    shared.groups.push_back(group);
  }
  return shared;
}

}  // namespace lobefit
