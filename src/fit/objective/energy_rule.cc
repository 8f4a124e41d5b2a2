#include "lobefit/fit/objective/energy_rule.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/ndf/slope_ndf.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Of a lobe's slopes, and of the hemisphere for the diffuse part.
constexpr int kRings = 48, kSteps = 32, kDiffuseRings = 16, kDiffuseSteps = 24;

// Calls each(u, angle) for points of equal probability; rings are turned against each other.
template <class Each>
void ForPoints(int rings, int steps, const Each& each) {
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < steps; ++k) each((i + 0.5) / rings, 2 * kPi * (k + 0.5 + 0.618034 * i) / steps);
  }
}

Vec3 LightOf(const Lobe& lobe, const Vec3& wi) { return lobe.direction == LobeDirection::kRetro ? Mirrored(wi) : wi; }

// Points of all kinds at wo, a unit of solid angle.
double Density(const KernelModel& kernel, const std::vector<SlopeFrame>& frames, const Vec3& wi, const Vec3& wo) {
  double density = kDiffuseRings * kDiffuseSteps * wo.z * kInvPi;
  for (std::size_t l = 0; l < frames.size(); ++l) {
    const Vec3 light = LightOf(kernel.lobes[l].kind, wi), m = Normalized(light + wo);
    density += kRings * kSteps * SlopeD(frames[l], m) * m.z / (4 * Dot(light, m));
  }
  return density;
}

// What the model is without its instrument and metric: residuals are f_r cos_theta_i.
KernelModel PlainModel(const Layout& layout, const double* u) {
  KernelModel kernel = layout.ToKernel(u);
  for (KernelLobe& lobe : kernel.lobes) lobe.mean = nullptr;
  kernel.transform = TransformOf(Metric::kCosineL2, {});
  kernel.loss = Loss::kNone;
  kernel.prior.clear();
  return kernel;
}

}  // namespace

EnergyRule::EnergyRule(std::vector<Vec3> wi, double limit) : wi_(std::move(wi)), limit_(limit), points_(wi_.size()) {}

void EnergyRule::Place(const KernelModel& kernel) {
  std::vector<SlopeFrame> frames;
  for (const KernelLobe& lobe : kernel.lobes) frames.emplace_back(lobe.shape.slope);
  for (std::size_t k = 0; k < wi_.size(); ++k) {
    const Vec3& wi = wi_[k];
    Points& points = points_[k] = {};
    const auto add = [&](const Vec3& wo) {
      const double all[6] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
      for (std::size_t j = 0; j < 6; ++j) points.direction[j].push_back(all[j]);
      points.weight.push_back(wo.z / (wi.z * Density(kernel, frames, wi, wo)));
    };
    for (std::size_t l = 0; l < frames.size(); ++l) {
      const SlopeFrame& frame = frames[l];
      const Vec3 light = LightOf(kernel.lobes[l].kind, wi);
      ForPoints(kRings, kSteps, [&](double level, double t) {
        const double rho = std::sqrt(level / (1 - level));
        const double x = frame.slope_x + frame.a * rho * std::cos(t);
        const double y = frame.slope_y + frame.b * rho * std::cos(t) + frame.c * rho * std::sin(t);
        const Vec3 m = Normalized(Vec3{-x, -y, 1.0}), wo = Reflect(light, m);
        if (Dot(light, m) > 0 && wo.z > 0) add(wo);
      });
    }
    ForPoints(kDiffuseRings, kDiffuseSteps, [&](double level, double t) {  // level = sin^2 theta_o
      const double sine = std::sqrt(level);
      add({sine * std::cos(t), sine * std::sin(t), std::sqrt(1 - level)});
    });
  }
}

double EnergyRule::Add(const Layout& layout, const double* u, ThreadPool* pool, Eigen::MatrixXd* hessian,
                       Eigen::VectorXd* gradient) const {
  const KernelModel kernel = PlainModel(layout, u);
  std::vector<std::vector<double>> excess(wi_.size());                  // [channel]
  std::vector<std::vector<std::vector<double>>> by_column(wi_.size());  // [channel][column]
  pool->Run(wi_.size(), [&](std::size_t k) {
    const Points& points = points_[k];
    const std::size_t count = points.weight.size();
    const std::vector<double> zero(count, 0.0);
    KernelSamples samples = {};
    for (std::size_t j = 0; j < 6; ++j) samples.direction[j] = points.direction[j].data();
    samples.measured.assign(kernel.channels, zero.data());
    samples.count = count;
    std::vector<std::vector<double>> values;
    ModelValues(samples, kernel, 0, count, &values);
    bool any = false;
    for (std::size_t c = 0; c < kernel.channels; ++c) {
      double albedo = 0;
      for (std::size_t i = 0; i < count; ++i) albedo += points.weight[i] * wi_[k].z * values[c][i];
      excess[k].push_back(std::max(0.0, albedo - limit_));
      any = any || excess[k].back() > 0;
    }
    if (!any || hessian == nullptr) return;
    std::vector<std::vector<double>> columns;
    Columns(samples, kernel, 0, count, &columns);
    by_column[k].assign(kernel.channels, {});
    for (std::size_t c = 0; c < kernel.channels; ++c) {
      for (std::size_t j = 0; j + 1 < kernel.columns(); ++j) {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += points.weight[i] * columns[c][j * count + i];
        by_column[k][c].push_back(sum);
      }
    }
  });
  double sum = 0;
  for (std::size_t k = 0; k < wi_.size(); ++k) {
    for (std::size_t c = 0; c < kernel.channels; ++c) {
      if (excess[k][c] == 0) continue;
      sum += excess[k][c] * excess[k][c];
      if (hessian == nullptr) continue;
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(gradient->size());
      const std::vector<int> index = layout.CoordinatesOfColumns(c);
      for (std::size_t j = 0; j < index.size(); ++j) {
        if (index[j] >= 0) slope(index[j]) += by_column[k][c][j];
      }
      *hessian += weight_ * slope * slope.transpose();
      *gradient += weight_ * excess[k][c] * slope;
    }
  }
  return weight_ / 2 * sum;
}

}  // namespace lobefit
