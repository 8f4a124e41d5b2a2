// Gains of incidences: lamp and alignment drift between incident directions, common to all samples and channels of one.
// A reading is g f_r with ln g normal about 0; the gains are solved for at every point of a descent, which so moves the
// model's coordinates only and needs a few numbers an incidence whatever the number of samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "lobefit/base/process/parallel.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {

class Layout;
class Problem;

class Gains {
 public:
  // All gains 1. Keeps a reference to `incidences`, which must outlive it.
  explicit Gains(const Incidences& incidences);
  Gains(const Gains&) = delete;
  Gains& operator=(const Gains&) = delete;

  std::size_t size() const { return logarithm_.size(); }
  const std::vector<double>& logarithms() const { return logarithm_; }
  // What the cost has twice for each ln g: precision (ln g)^2, sigma^2 / s^2 with residuals of variance sigma^2 and the
  // standard deviation s of ln g, both above 0.
  void SetPrior(double residual_variance, double sd) {
    precision_ = residual_variance / (sd * sd);
    residual_variance_ = residual_variance;
  }
  double precision() const { return precision_; }
  double residual_variance() const { return residual_variance_; }
  double PriorSum() const;

  // Tables that the kernel reads: the group of each sample, the gain of each group.
  const std::uint32_t* groups() const { return group_.data(); }
  const double* gains() const { return gain_.data(); }

  // Moves every gain to the minimum of the cost over it, the model held. Of passes that evaluate the model without its
  // derivatives it takes two or three where the model has moved little since the last call, else up to a dozen.
  void Profile(const Problem& problem, const KernelModel& model, ThreadPool* pool);

 private:
  const std::vector<std::uint32_t>& group_;
  std::vector<double> logarithm_, gain_;
  double precision_ = 1, residual_variance_ = 1;
};

// What links a gain to the coordinates of the model: J^T j_g of the samples of its incidence, and d = |j_g|^2 and the
// prior's precision, with j_g the column of ln g.
struct GainLink {
  Eigen::VectorXd link;
  double curvature = 0;
};

// Takes the gains out of the normal equations: H - sum h h^T / d and g - sum h q / d, the Gauss-Newton step of all
// unknowns together restricted to the model's. `sums` with arrows; `links`: a gain each, null: not wanted.
void EliminateGains(const KernelSums& sums, const Layout& layout, const Gains& gains, Eigen::MatrixXd* hessian,
                    Eigen::VectorXd* gradient, std::vector<GainLink>* links);

}  // namespace lobefit
