#include "lobefit/fit/rung.h"

#include <algorithm>
#include <numeric>

#include "lobefit/fit/search/profile_knots.h"

namespace lobefit {
namespace {

void StartOthersAt(const FoundModel& found, std::size_t channels, Recipe* recipe) {
  const std::vector<Parameter> parameters = Parameters(recipe->model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto others = found.others.find(parameters[i].json_name);
    if (others == found.others.end() || others->second.size() != (parameters[i].per_channel ? channels : 1)) continue;
    if (!recipe->IsFree(i)) continue;
    std::vector<double>& start = recipe->parameters[i].start = others->second;
    if (recipe->parameters[i].shared) start.resize(1);
    for (double& value : start) value = std::clamp(value, parameters[i].low, parameters[i].high);
  }
}

void StartProfilesAt(const FoundModel& found, const Samples& samples, Recipe* recipe) {
  std::vector<std::shared_ptr<const ProfileGrid>> grids;
  for (std::size_t l = 0; l < found.profiles.size(); ++l) {
    grids.push_back(found.profiles[l].grid);
    if (grids[l] == nullptr) continue;
    const std::vector<double>& known = grids[l]->spline()->knots();
    const std::vector<double> knots =
        ProfileKnots(LargestRadius(recipe->model.lobes[l], found.profiles[l].shape, samples));
    if (knots.size() > known.size() && std::equal(known.begin(), known.end(), knots.begin()))
      grids[l] = GridWithKnots(knots);
  }
  *recipe = WithGrids(*recipe, grids);
  const std::vector<Parameter> parameters = Parameters(recipe->model);
  for (std::size_t l = 0; l < found.profiles.size(); ++l) {
    const std::vector<double>& q = found.profiles[l].q;
    for (std::size_t k = 0; grids[l] != nullptr && k < grids[l]->spline()->size(); ++k) {
      const std::size_t i = FirstParameter(recipe->model, l) + kEllipseParameters + k;
      recipe->parameters[i].start = {std::clamp(k < q.size() ? q[k] : q.back(), parameters[i].low, parameters[i].high)};
    }
  }
}

}  // namespace

FoundModel FoundAt(const Layout& layout, const std::vector<double>& u) {
  const Model& model = layout.recipe().model;
  const std::vector<Parameter> parameters = Parameters(model);
  const ParameterValues values = layout.Report(u.data());
  const KernelModel kernel = layout.ToKernel(u.data());
  FoundModel found;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].group != ParameterGroup::kShape) found.others[parameters[i].json_name] = values[i];
  }
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    const Lobe& lobe = model.lobes[l];
    const std::size_t first = FirstParameter(model, l), beyond = first + kEllipseParameters;
    const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
    found.shapes.emplace_back(at(first), at(beyond));
    if (HasExponent(lobe.ndf)) found.others[parameters[beyond].json_name] = values[beyond];
    found.profiles.push_back({kernel.lobes[l].shape.slope, nullptr, {}});
    if (FamilyOf(lobe.ndf) != Family::kProfile) continue;
    found.profiles[l].grid = GridOf(lobe);
    for (std::size_t i = beyond; i < FirstFresnel(model, l); ++i) found.profiles[l].q.push_back(values[i][0]);
  }
  return found;
}

void StartShapesAt(const FoundModel& found, Recipe* recipe) {
  const std::vector<Parameter> parameters = Parameters(recipe->model);
  for (std::size_t l = 0; l < std::min(found.shapes.size(), recipe->model.lobes.size()); ++l) {
    const std::size_t first = FirstParameter(recipe->model, l);
    for (std::size_t i = 0; i < kEllipseParameters; ++i) {
      const Parameter& parameter = parameters[first + i];
      if (!parameter.free) continue;
      recipe->parameters[first + i].start = {std::clamp(found.shapes[l][i][0], parameter.low, parameter.high)};
    }
  }
}

void StartAt(const FoundModel& found, std::size_t channels, const Samples& samples, Recipe* recipe) {
  StartShapesAt(found, recipe);
  StartOthersAt(found, channels, recipe);
  StartProfilesAt(found, samples, recipe);
}

double Rung::mean() const {
  return std::accumulate(mean_square.begin(), mean_square.end(), 0.0) / static_cast<double>(mean_square.size());
}

}  // namespace lobefit
