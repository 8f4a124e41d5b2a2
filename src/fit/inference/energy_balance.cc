#include "lobefit/fit/inference/energy_balance.h"

#include <algorithm>
#include <cmath>

#include "lobefit/math/directions.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// No misfit of a lobe's tail makes up for as much: the scale is another one.
constexpr double kNoReflectance = 2;

}  // namespace

std::vector<Vec3> SpreadIncidences(const Incidences& incidences, double theta_max, std::size_t most) {
  std::vector<Vec3> within;  // by polar angle, as Incidences are
  for (const Vec3& wi : incidences.wi) {
    if (wi.z >= std::cos(theta_max) - 1e-9) within.push_back(wi);
  }
  if (within.size() <= most) return within;
  std::vector<Vec3> spread;
  for (std::size_t k = 0; k < most; ++k) spread.push_back(within[k * (within.size() - 1) / (most - 1)]);
  return spread;
}

EnergyBalance BalanceAt(const std::vector<Vec3>& wi, const Model& model, const ParameterValues& values,
                        const std::vector<std::string>& channels, ThreadPool* pool, const FacetGrid& grid) {
  std::vector<std::vector<double>> albedo(wi.size());
  pool->Run(wi.size(),
            [&](std::size_t k) { albedo[k] = DirectionalAlbedo(model, values, channels.size(), wi[k], grid); });
  EnergyBalance balance;
  balance.incidences = wi.size();
  for (std::size_t k = 0; k < wi.size(); ++k) {
    const auto largest = std::max_element(albedo[k].begin(), albedo[k].end());
    balance.above_one += *largest > 1 ? 1 : 0;
    if (*largest <= balance.albedo) continue;
    balance.albedo = *largest;
    balance.theta_i = PolarAngle(wi[k]);
    balance.phi_i = std::atan2(wi[k].y, wi[k].x);
    balance.channel = channels[static_cast<std::size_t>(largest - albedo[k].begin())];
  }
  return balance;
}

std::vector<ScatterAt> ScatterOfAbg(const std::vector<Vec3>& wi, const Model& model, const ParameterValues& values,
                                    std::size_t channels) {
  std::vector<ScatterAt> scatter;
  for (const Vec3& direction : wi) {
    ScatterAt at = {PolarAngle(direction), std::atan2(direction.y, direction.x), std::vector<double>(channels, 0.0)};
    bool any = false;
    for (std::size_t l = 0; l < model.lobes.size(); ++l) {
      if (FamilyOf(model.lobes[l].ndf) != Family::kAbg) continue;
      any = true;
      const double unit = SingleBounceAlbedo(model, values, l, direction);
      for (std::size_t c = 0; c < channels; ++c) at.share[c] += unit * values[FirstFresnel(model, l)][c];
    }
    if (any) scatter.push_back(std::move(at));
  }
  return scatter;
}

void JudgeEnergy(const EnergyBalance& balance, Verdict* verdict) {
  if (!CreatesEnergy(balance) || verdict->kind == VerdictKind::kDoesNotDescribe) return;
  verdict->kind = VerdictKind::kRough;
  verdict->advice =
      balance.albedo > kNoReflectance
          ? "it reflects far more than it receives: the values are no f_r in 1/sr; --scale free fits their shape"
          : "it reflects more than it receives: --energy conserving keeps it from that";
}

}  // namespace lobefit
