#include "lobefit/maps/recipe.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/files/toml_file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

const std::vector<std::string> kKeys = {"name", "model", "normal", "lobe", "loss", "shadow", "least_alpha", "share"};
const std::vector<std::string> kModels = {"lambert", "ggx", "ggx-anisotropic", "ellipsoid"};
const std::vector<std::string> kShared = {"normal", "tilt", "alpha", "diffuse", "f0"};
constexpr std::size_t kMostClusters = 64;

// "free", "fixed" or "map:FILE".
void ReadNormal(const TomlFile& file, const toml::table& table, const std::filesystem::path& folder,
                MapRecipe* recipe) {
  const toml::node* node = table.get("normal");
  const std::string word = node != nullptr && node->is_string() ? *node->value<std::string>() : "free";
  if (word.rfind("map:", 0) == 0 && word.size() > 4) {
    recipe->rules.normal_free = false;
    recipe->normal_map = folder / word.substr(4);
    return;
  }
  if (node != nullptr && (!node->is_string() || (word != "free" && word != "fixed"))) {
    file.Fail(node->source(), "'normal' must be one of free, fixed, map:FILE");
  }
  recipe->rules.normal_free = word == "free";
}

void ReadShare(const TomlFile& file, const toml::table& table, MapRecipe* recipe) {
  const toml::node* node = table.get("share");
  if (node == nullptr) return;
  const toml::table* share = node->as_table();
  if (share == nullptr) file.Fail(node->source(), "'share' must be a table: [share]");
  file.CheckKeys(*share, kShared, "in [share]");
  MapShares& shares = recipe->shares;
  std::size_t clusters = 0;
  for (std::size_t k = 0; k < kSharedKinds; ++k) {
    const toml::node* over = share->get(kShared[k]);
    if (over == nullptr) continue;
    const std::string word = over->is_string() ? *over->value<std::string>() : "";
    if (word == "texel") continue;
    const bool parted = word.rfind("cluster:", 0) == 0;
    const long long count = parted ? ParseInteger(std::string_view(word).substr(8)).value_or(0) : 0;
    if (word != "image" && !(count >= 1 && count <= static_cast<long long>(kMostClusters))) {
      file.Fail(over->source(),
                fmt::format("'{}' must be texel, image or cluster:N with N from 1 to {}", kShared[k], kMostClusters));
    }
    shares.over[k] = parted ? ShareOver::kCluster : ShareOver::kImage;
    if (!parted) continue;
    if (clusters != 0 && clusters != static_cast<std::size_t>(count)) {
      file.Fail(over->source(), "texels are parted into clusters once: all of [share] must name the same N");
    }
    clusters = static_cast<std::size_t>(count);
  }
  shares.clusters = std::max<std::size_t>(clusters, 1);
  const MapLobe lobe = recipe->rules.lobe;
  const auto needs = [&](Shared kind, bool there, const char* what) {
    if (shares.Of(kind) != ShareOver::kTexel && !there) {
      file.Fail(share->get(kShared[static_cast<std::size_t>(kind)])->source(), what);
    }
  };
  needs(Shared::kNormal, recipe->rules.normal_free, "a normal that is not free is not shared: leave normal out");
  needs(Shared::kTilt, lobe == MapLobe::kEllipsoid, "only model = \"ellipsoid\" has a tilt");
  needs(Shared::kAlpha, lobe != MapLobe::kNone, "model = \"lambert\" has no alpha");
  needs(Shared::kF0, lobe != MapLobe::kNone, "model = \"lambert\" has no f0");
}

}  // namespace

HeldNumbers HeldOver(const MapShares& shares, ShareOver over) {
  HeldNumbers held;
  held.normal = shares.Of(Shared::kNormal) == over, held.slope = shares.Of(Shared::kTilt) == over;
  held.width = shares.Of(Shared::kAlpha) == over, held.diffuse = shares.Of(Shared::kDiffuse) == over;
  held.f0 = shares.Of(Shared::kF0) == over;
  return held;
}

MapRecipe ReadMapRecipe(const std::filesystem::path& path) {
  const TomlFile file = {PrintableName(path)};
  const FileBytes bytes(path);
  const toml::table table = file.Parse(bytes.bytes());
  file.CheckKeys(table, kKeys);
  MapRecipe recipe;
  recipe.name = path.stem().string();
  MapRules& rules = recipe.rules;
  ReadNormal(file, table, path.parent_path(), &recipe);
  const std::size_t model = table.contains("model") ? file.Word(table, "model", kModels) : 1;
  rules.lobe = static_cast<MapLobe>(model);
  if (rules.lobe == MapLobe::kEllipsoid && rules.normal_free) {
    throw UsageError(
        fmt::format("{}: the tilt of an ellipsoid and a free normal say the same of a texel; take normal = "
                    "\"fixed\" or \"map:FILE\", or model = \"ggx-anisotropic\"",
                    file.name));
  }
  rules.choice =
      file.Word(table, "lobe", {"by-evidence", "always"}) == 0 ? LobeChoice::kByEvidence : LobeChoice::kAlways;
  rules.loss = file.Number(table, "loss", rules.loss, 1e-4, 1e3);
  rules.shadow = file.Number(table, "shadow", rules.shadow, 0, 0.9);
  rules.least_alpha = file.Number(table, "least_alpha", rules.least_alpha, 0.001, 0.5);
  ReadShare(file, table, &recipe);
  return recipe;
}

std::string RecipeText(const MapRecipe& recipe) {
  const MapRules& r = recipe.rules;
  std::string text = fmt::format("model={} normal={} lobe={} schlick={} loss={} shadow={} alpha={}:{}",
                                 kModels[static_cast<std::size_t>(r.lobe)],
                                 r.normal_free               ? "free"
                                 : recipe.normal_map.empty() ? "fixed"
                                                             : "map",
                                 r.choice == LobeChoice::kAlways ? "always" : "by-evidence", r.schlick, r.loss,
                                 r.shadow, r.least_alpha, r.most_alpha);
  for (std::size_t k = 0; k < kSharedKinds; ++k) {
    if (recipe.shares.over[k] == ShareOver::kTexel) continue;
    text += fmt::format(
        " share.{}={}", kShared[k],
        recipe.shares.over[k] == ShareOver::kImage ? "image" : fmt::format("cluster:{}", recipe.shares.clusters));
  }
  return text;
}

}  // namespace lobefit
