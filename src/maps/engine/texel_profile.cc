// What a texel says of numbers that it shares with others.
#include <vector>

#include "lobefit/maps/engine/factor.h"
#include "lobefit/maps/engine/texel.h"

namespace lobefit {

bool TexelFitter::ProfileOfLastFit(const HeldNumbers& shared, ProfileTerms* terms) {
  const MapModel& model = last_model_;
  if (model.channels == 0 || !(last_cost_ > 0)) return false;
  const MapModel whole = {rules_.lobe, channels_, rules_.schlick};
  MapVector gradient = {};
  MapMatrix hessian = {};
  const int unknowns = model.Unknowns();
  objective_.Derivatives(model, data_, last_point_, rules_.loss, Curvature::kClipped, &gradient, &hessian);
  const std::array<bool, kMostUnknowns> held = HeldUnknowns(model, last_point_, bounds_, gradient);
  // Where the shared unknowns of this texel's model stand in it and in the whole one, and their unit.
  struct Place {
    int own, whole;
    double unit;
  };
  std::vector<Place> places;
  const bool lobe = model.lobe != MapLobe::kNone;
  for (int j = 0; j < 2; ++j) {
    if (whole.TurnsNormal() ? shared.normal : shared.slope && lobe) places.push_back({j, j, 1});
  }
  for (int j = 2; j < model.Shape(); ++j) {
    if (shared.width) places.push_back({j, j, 1});
  }
  for (int c = 0; c < channels_; ++c) {
    if (shared.diffuse) places.push_back({model.DiffuseAt(c), whole.DiffuseAt(c), 1 / data_.scale});
    if (shared.f0 && lobe) places.push_back({model.F0At(c), whole.F0At(c), 1 / data_.scale});
  }
  if (places.empty()) return false;
  MapMatrix factor = hessian;
  if (!Factorise(unknowns, held, &factor)) return false;
  const double likelihood = 0.5 * static_cast<double>(data_.lights.count) * channels_ / last_cost_;
  *terms = {};
  for (const Place& p : places) {
    MapVector answer = {};
    for (int j = 0; j < unknowns; ++j) answer[j] = held[j] ? 0 : hessian[j][p.own];
    SolveFactorised(unknowns, factor, &answer);
    terms->slope[p.whole] = likelihood * p.unit * gradient[p.own];
    for (const Place& q : places) {
      double schur = hessian[q.own][p.own];
      for (int j = 0; j < unknowns; ++j) schur -= held[j] ? 0 : hessian[j][q.own] * answer[j];
      terms->curvature[q.whole][p.whole] = likelihood * p.unit * q.unit * schur;
    }
  }
  return true;
}

}  // namespace lobefit
