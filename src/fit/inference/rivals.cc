#include "lobefit/fit/inference/rivals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lobefit/core/ellipsoid/ellipsoid_symmetry.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/errors/sample_rows.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

// 95 % of chi-square with one degree of freedom.
constexpr double kLikelihoodRatio = 3.841458820694124;
constexpr double kSigmas = 2;

// What a residual adds to twice the cost on average where it decides nothing: its variance; with a loss the variance of
// its pull over the mean slope of the pull, for which twice a difference of costs is distributed as the likelihood
// ratio [Huber 1981, section 6.3].
double UnitOfCost(const Problem& problem, const Layout& layout, const Solution& best) {
  const auto residuals = static_cast<double>(problem.size() * problem.channels());
  const double freedom = std::max(1.0, residuals - static_cast<double>(layout.size()));
  if (layout.recipe().loss == Loss::kNone) return 2 * best.cost / freedom;
  const KernelModel kernel = layout.ToKernel(best.u.data());
  RowEvaluator evaluator(problem.kernel_samples(), kernel);
  const std::vector<std::uint32_t> order = FileOrder(problem.size());
  SampleRows piece;
  double pull2 = 0, slope = 0;
  for (std::size_t begin = 0; begin < problem.size(); begin += kPiece) {
    evaluator.Evaluate(order, begin, std::min(problem.size(), begin + kPiece), &piece);
    for (Eigen::Index i = 0; i < piece.root_rho.size(); ++i) {
      const double rho1 = piece.root_rho(i) * piece.root_rho(i);
      double s = 0;  // rho' times the squared residual
      for (const Eigen::VectorXd& r : piece.residuals) s += r(i) * r(i);
      pull2 += rho1 * s;
      slope += rho1 * static_cast<double>(problem.channels()) + rho1 * piece.curvature(i) * s;
    }
  }
  return slope > 0 ? pull2 / slope * residuals / freedom : 2 * best.cost / freedom;
}

// How many times the variance of the parameters is that of independent samples, at most: samples of an incidence that
// err together tell less than their number says.
double Dependence(const Material& material) {
  double dependence = 1;
  for (const FittedParameter& parameter : material.parameters) {
    for (std::size_t c = 0; c < parameter.standard_error.size(); ++c) {
      const double ratio = parameter.standard_error_clustered[c] / parameter.standard_error[c];
      if (std::isfinite(ratio)) dependence = std::max(dependence, ratio * ratio);
    }
  }
  return dependence;
}

// The largest cost that fits as well as the best.
double AsGood(const Problem& problem, const Layout& layout, const Solution& best, const Material& material) {
  const auto residuals = static_cast<double>(problem.size() * problem.channels());
  // Of values without noise nothing but rounding is left: residuals of 1e-12 on average.
  return best.cost + kLikelihoodRatio / 2 * UnitOfCost(problem, layout, best) * Dependence(material) +
         1e-24 * residuals;
}

// The lobe seen in the vertical mirror through `azimuth`.
Ellipsoid Mirrored(const Ellipsoid& ellipsoid, double azimuth) {
  const OffCenter lobe = OffCenterFromEllipsoid(ellipsoid);
  const double c = std::cos(2 * azimuth), s = std::sin(2 * azimuth);
  // R = [[c, s], [s, -c]]: slopes go to R s, Q^-1 to R Q^-1 R.
  return EllipsoidFromOffCenter({c * lobe.slope_x + s * lobe.slope_y, s * lobe.slope_x - c * lobe.slope_y,
                                 c * c * lobe.q11 + 2 * c * s * lobe.q12 + s * s * lobe.q22,
                                 c * s * (lobe.q11 - lobe.q22) + (s * s - c * c) * lobe.q12,
                                 s * s * lobe.q11 - 2 * c * s * lobe.q12 + c * c * lobe.q22});
}

std::vector<double> MirrorImage(const Layout& layout, const std::vector<double>& u, double azimuth) {
  const ParameterValues values = layout.Report(u.data());
  std::vector<Ellipsoid> shapes;
  for (std::size_t l = 0; l < layout.recipe().model.lobes.size(); ++l) {
    const std::vector<double>* p = values.data() + FirstParameter(layout.recipe().model, l);
    shapes.push_back(Mirrored({p[0][0], p[1][0], p[2][0], p[3][0], p[4][0]}, azimuth));
  }
  std::vector<double> image = layout.FromShapes(shapes);
  layout.CopyProfiles(u, &image);
  std::copy(u.begin() + static_cast<std::ptrdiff_t>(layout.shape_size()), u.end(),
            image.begin() + static_cast<std::ptrdiff_t>(layout.shape_size()));
  return image;
}

// The rival's values in the form nearest to the material's.
ParameterValues NearestValues(const Layout& layout, const std::vector<double>& u, const Material& material) {
  ParameterValues values = layout.Report(u.data());
  for (std::size_t l = 0; l < material.model.lobes.size(); ++l) {
    const std::size_t first = FirstParameter(material.model, l);
    std::vector<double>* p = values.data() + first;
    const FittedParameter* q = material.parameters.data() + first;
    const Ellipsoid nearest =
        NearestEllipsoid({p[0][0], p[1][0], p[2][0], p[3][0], p[4][0]},
                         {q[0].values[0], q[1].values[0], q[2].values[0], q[3].values[0], q[4].values[0]});
    p[0][0] = nearest.alpha_x, p[1][0] = nearest.alpha_y;
    p[2][0] = nearest.theta_x, p[3][0] = nearest.theta_y, p[4][0] = nearest.theta_z;
  }
  return values;
}

// Parameters that the rival puts elsewhere, in words; empty where it is the same solution. They lose their standard
// errors.
std::string Differences(const Layout& layout, const std::vector<double>& u, Material* material) {
  const ParameterValues values = NearestValues(layout, u, *material);
  const std::vector<Parameter> parameters = Parameters(material->model);
  std::vector<std::string> words;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    FittedParameter& fitted = material->parameters[i];
    if (!fitted.free) continue;
    double furthest = 0;  // in standard errors
    std::size_t channel = 0;
    for (std::size_t c = 0; c < fitted.values.size(); ++c) {
      const double clustered = fitted.standard_error_clustered[c];
      const double sigma = std::max(fitted.standard_error[c], std::isnan(clustered) ? 0.0 : clustered);
      const double gap = std::fabs(values[i][c] - fitted.values[c]);
      if (!(gap > kSigmas * sigma)) continue;
      if (gap / sigma > furthest) furthest = gap / sigma, channel = c;
      fitted.standard_error[c] = fitted.standard_error_clustered[c] = fitted.freedom[c] =
          std::numeric_limits<double>::quiet_NaN();
    }
    if (furthest == 0) continue;
    words.push_back(fmt::format("{}{} {:.4g} in place of {:.4g}", parameters[i].json_name,
                                parameters[i].per_channel ? "[" + material->channels[channel] + "]" : "",
                                values[i][channel] / InsideFactor(parameters[i]),
                                fitted.values[channel] / InsideFactor(parameters[i])));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

bool FlagRivals(const Problem& problem, const Layout& layout, const Samples& samples,
                const std::vector<DistinctMinimum>& minima, ThreadPool* pool, Material* material) {
  const Solution& best = minima[0].solution;
  const double as_good = AsGood(problem, layout, best, *material);
  std::vector<std::string> found;
  std::optional<Neighbourhood> around_image;
  if (const std::optional<double> plane = PlaneAzimuth(samples)) {
    const std::vector<double> image = MirrorImage(layout, best.u, *plane);
    if (problem.Sum(layout.ToKernel(image.data()), false, pool).sum_rho / 2 <= as_good) {
      if (const std::string words = Differences(layout, image, material); !words.empty()) {
        found.push_back("all samples lie in one plane, and the mirror image of the solution fits as well: " + words);
        around_image.emplace(problem, layout, image, pool);
      }
    }
  }
  for (std::size_t k = 1; k < minima.size(); ++k) {
    const Solution& rival = minima[k].solution;
    if (!minima[k].on_all_samples || !rival.converged || rival.cost > as_good) continue;
    if (around_image && around_image->Holds(rival.u)) continue;
    const std::vector<double> nearest = layout.NearestEquivalent(rival.u, best.u);
    if (const std::string words = Differences(layout, nearest, material); !words.empty())
      found.push_back("a second minimum fits as well: " + words);
  }
  material->degenerate.insert(material->degenerate.end(), found.begin(), found.end());
  return !found.empty();
}

}  // namespace lobefit
