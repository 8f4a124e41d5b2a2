#include "lobefit/maps/recipe.h"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/printable.h"
#include "lobefit/base/text.h"
#include "lobefit/base/toml_file.h"

namespace lobefit {
namespace {

const std::vector<std::string> kKeys = {"name", "model",  "normal",      "lobe",
                                        "loss", "shadow", "share_alpha", "least_alpha"};
const std::vector<std::string> kModels = {"lambert", "ggx", "ggx-anisotropic"};

}  // namespace

MapRecipe ReadMapRecipe(const std::filesystem::path& path) {
  const TomlFile file = {PrintableName(path)};
  const FileBytes bytes(path);
  const toml::table table = file.Parse(bytes.bytes());
  file.CheckKeys(table, kKeys);
  MapRecipe recipe;
  recipe.name = path.stem().string();
  MapRules& rules = recipe.rules;
  rules.normal_free = file.Word(table, "normal", {"free", "fixed"}) == 0;
  if (const toml::node* node = table.get("model"); node != nullptr && node->value<std::string>() == "ellipsoid") {
    throw UsageError(fmt::format(
        "{}:{}: {}", file.name, node->source().begin.line,
        rules.normal_free ? "the tilt of an ellipsoid and a free normal say the same of a texel; with normal "
                            "= \"free\" take model = \"ggx-anisotropic\""
                          : "the ellipsoid is not fitted a texel; take model = \"ggx-anisotropic\""));
  }
  const std::size_t model = table.contains("model") ? file.Word(table, "model", kModels) : 1;
  rules.lobe = model == 0 ? MapLobe::kNone : model == 1 ? MapLobe::kGgx : MapLobe::kGgxAnisotropic;
  rules.choice =
      file.Word(table, "lobe", {"by-evidence", "always"}) == 0 ? LobeChoice::kByEvidence : LobeChoice::kAlways;
  rules.loss = file.Number(table, "loss", rules.loss, 1e-4, 1e3);
  rules.shadow = file.Number(table, "shadow", rules.shadow, 0, 0.9);
  rules.least_alpha = file.Number(table, "least_alpha", rules.least_alpha, 0.001, 0.5);
  recipe.share_alpha = file.Word(table, "share_alpha", {"texel", "image"}) == 1;
  if (recipe.share_alpha && rules.lobe != MapLobe::kGgx) {
    throw UsageError(file.name + ": share_alpha = \"image\" needs model = \"ggx\", whose width is one number");
  }
  return recipe;
}

std::string RecipeText(const MapRecipe& recipe) {
  const MapRules& r = recipe.rules;
  return fmt::format("model={} normal={} lobe={} schlick={} loss={} shadow={} alpha={}:{} share_alpha={}",
                     kModels[static_cast<std::size_t>(r.lobe)], r.normal_free ? "free" : "fixed",
                     r.choice == LobeChoice::kAlways ? "always" : "by-evidence", r.schlick, r.loss, r.shadow,
                     r.least_alpha, r.most_alpha, recipe.share_alpha ? "image" : "texel");
}

}  // namespace lobefit
