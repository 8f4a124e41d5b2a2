#include "lobefit/report/figures/fitted_function.h"

namespace lobefit {
namespace {

Vec3 LightOf(const DirectionArrays& d, std::size_t i) { return {d.wi_x[i], d.wi_y[i], d.wi_z[i]}; }

bool IsSame(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

}  // namespace

FittedFunction::FittedFunction(const Material& material)
    : model_(material.model, material.Values(), material.channels.size()) {
  if (material.sel) table_.emplace(*material.sel);
}

void FittedFunction::Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const {
  if (table_) {
    table_->Evaluate(wi, wo, f_r);
  } else {
    model_.Evaluate(wi, wo, f_r);
  }
}

void FittedFunction::Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const {
  if (!table_) {
    model_.Evaluate(directions, f_r);
    return;
  }
  f_r->assign(channels(), std::vector<double>(directions.count));
  std::vector<std::vector<double>> values;
  std::vector<Vec3> wo;
  // Samples of one light usually stand together: the lobes are interpolated once for each such run.
  for (std::size_t begin = 0; begin < directions.count;) {
    const Vec3 wi = LightOf(directions, begin);
    wo.clear();
    for (std::size_t i = begin; i < directions.count && IsSame(LightOf(directions, i), wi); ++i) {
      wo.push_back({directions.wo_x[i], directions.wo_y[i], directions.wo_z[i]});
    }
    table_->Evaluate(wi, wo, &values);
    for (std::size_t c = 0; c < channels(); ++c) {
      for (std::size_t k = 0; k < wo.size(); ++k) (*f_r)[c][begin + k] = values[c][k];
    }
    begin += wo.size();
  }
}

}  // namespace lobefit
