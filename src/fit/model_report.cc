#include "lobefit/fit/model_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/QR>
#include <fmt/format.h>

#include "lobefit/fit/search/profile_knots.h"
#include "lobefit/fit/search/solve.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

// Flattened entry names of Layout::Report: "alpha_x", "f0[R]".
std::vector<std::string> EntryNames(const std::vector<Parameter>& parameters,
                                    const std::vector<std::string>& channels) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) {
    if (!parameter.per_channel) names.push_back(parameter.json_name);
    for (std::size_t c = 0; parameter.per_channel && c < channels.size(); ++c)
      names.push_back(parameter.json_name + "[" + channels[c] + "]");
  }
  return names;
}

double SquareRoot(double variance) { return variance > 0 ? std::sqrt(variance) : kNan; }

// Angles that are not determined because two alphas agree within the error; their intervals would mean nothing.
void FlagEqualAlphas(const EntryCovariance& covariance, std::size_t first, Eigen::Index row, const std::string& prefix,
                     Material* material) {
  FittedParameter* p = material->parameters.data() + first;
  if (!p[0].free || !p[1].free || !p[4].free) return;
  const double gap = p[0].values[0] - p[1].values[0];
  const double variance = covariance(row, row) + covariance(row + 1, row + 1) - 2 * covariance(row, row + 1);
  const double sigmas = std::isfinite(variance) && variance > 0 ? gap / std::sqrt(variance) : 0.0;
  if (sigmas >= 2) return;
  p[4].standard_error = p[4].standard_error_clustered = p[4].freedom = {kNan};
  material->degenerate.push_back(
      fmt::format("{}theta_z: {}alpha_x and {}alpha_y agree within {:.1f} sigma, so the axes have no direction", prefix,
                  prefix, prefix, sigmas));
}

}  // namespace

void ReportParameters(const Layout& layout, const std::vector<double>& u, const Uncertainty& uncertainty,
                      Material* material) {
  const Recipe& recipe = layout.recipe();
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  const ParameterValues values = layout.Report(u.data());
  const SparseRows jacobian = layout.ReportJacobian(u.data());
  const EntryCovariance& covariance = uncertainty.covariance;
  const EntryCovariance& clustered = uncertainty.clustered;
  std::vector<Eigen::Index> free_rows;
  std::vector<double> factors;
  const std::vector<std::string> names = EntryNames(parameters, material->channels);
  Eigen::Index row = 0;
  std::size_t linear_seen = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    FittedParameter fitted;
    fitted.values = values[i];
    fitted.free = recipe.IsFree(i);
    const bool shape = parameters[i].group == ParameterGroup::kShape;
    for (std::size_t c = 0; c < values[i].size(); ++c, ++row) {
      fitted.standard_error.push_back(fitted.free ? SquareRoot(covariance.Variance(row)) : kNan);
      fitted.standard_error_clustered.push_back(
          fitted.free && uncertainty.has_clusters ? SquareRoot(clustered.Variance(row)) : kNan);
      fitted.freedom.push_back(std::isnan(fitted.standard_error_clustered.back())
                                   ? kNan
                                   : uncertainty.freedom[static_cast<std::size_t>(row)]);
      fitted.independent_freedom.push_back(std::isnan(fitted.standard_error.back())
                                               ? kNan
                                               : uncertainty.independent_freedom[static_cast<std::size_t>(row)]);
      if (fitted.free) {
        free_rows.push_back(row);
        factors.push_back(1 / InsideFactor(parameters[i]));
        const int index = shape ? -1 : layout.linear(c)[linear_seen].index;
        fitted.at_bound = fitted.at_bound || (index >= 0 && uncertainty.at_bound[static_cast<std::size_t>(index)]);
      }
    }
    if (!shape) ++linear_seen;
    if (shape && fitted.free) {
      // A shape coordinate held at a bound marks the parameters that depend on it.
      for (std::size_t k = 0; k < layout.shape_size(); ++k) {
        const double dependence = jacobian.coeff(row - 1, static_cast<Eigen::Index>(k));
        fitted.at_bound =
            fitted.at_bound || (uncertainty.at_bound[k] && (std::isnan(dependence) || std::fabs(dependence) > 1e-9));
      }
    }
    material->parameters.push_back(fitted);
  }
  Eigen::Index first_row = 0;
  for (std::size_t l = 0; l < recipe.model.lobes.size(); ++l) {
    const auto theta_z = static_cast<std::size_t>(first_row) + 4;
    if (!uncertainty.undetermined[theta_z]) {
      FlagEqualAlphas(covariance, FirstParameter(recipe.model, l), first_row,
                      l == 0 ? "" : fmt::format("lobe{}.", l + 1), material);
    }
    const KernelModel kernel = layout.ToKernel(u.data());
    const OffCenter off_center = OffCenterFromSlopeCoordinates(kernel.lobes[l].shape.slope);
    const double ax = std::sqrt(off_center.q11), ay = std::sqrt(off_center.q22);
    first_row += static_cast<Eigen::Index>(ShapeParameters(recipe.model.lobes[l]) +
                                           FresnelParameters(recipe.model.lobes[l].fresnel) * layout.channels());
    material->slope_space.push_back({off_center.slope_x, off_center.slope_y, ax, ay, off_center.q12 / (ax * ay)});
  }
  if (!covariance.full() || free_rows.size() > kMostFull) {
    material->remarks.push_back(fmt::format(
        "the covariance of {} numbers is too large for the document: it holds that of the shapes; each number "
        "has its standard error",
        free_rows.size()));
    std::vector<Eigen::Index> of_shapes;
    std::vector<double> their_factors;
    for (std::size_t a = 0; a < free_rows.size(); ++a) {
      if (names[static_cast<std::size_t>(free_rows[a])].ends_with(']')) continue;  // of one channel
      of_shapes.push_back(free_rows[a]);
      their_factors.push_back(factors[a]);
    }
    free_rows.swap(of_shapes);
    factors.swap(their_factors);
  }
  for (std::size_t a = 0; a < free_rows.size(); ++a) {
    material->covariance_names.push_back(names[static_cast<std::size_t>(free_rows[a])]);
    for (std::size_t b = 0; b < free_rows.size(); ++b) {
      material->covariance.push_back(covariance(free_rows[a], free_rows[b]) * factors[a] * factors[b]);
      if (uncertainty.has_clusters)
        material->covariance_clustered.push_back(clustered(free_rows[a], free_rows[b]) * factors[a] * factors[b]);
    }
  }
}

void ReportByFile(const FileErrors& errors, Material* material) {
  if (errors.variance.empty()) return;
  constexpr double kMuchLarger = 1.25;
  const std::vector<Parameter> parameters = Parameters(material->model);
  std::size_t row = 0;
  double largest = 0, freedom = 0;
  std::string of;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    FittedParameter& fitted = material->parameters[i];
    for (std::size_t c = 0; c < fitted.values.size(); ++c, ++row) {
      const bool has_error =
          fitted.free && !std::isnan(fitted.standard_error[std::min(c, fitted.standard_error.size() - 1)]);
      const double clustered = fitted.standard_error_clustered[std::min(c, fitted.standard_error_clustered.size() - 1)];
      // Those by incidence hold what the noise biases the metric by.
      const double error = has_error ? std::max(SquareRoot(errors.variance[row]), clustered) : kNan;
      const double ratio = error / clustered;
      fitted.standard_error_by_file.push_back(error);
      fitted.freedom_by_file.push_back(std::isnan(error) ? kNan : errors.freedom[row]);
      if (!(ratio > largest) || std::isinf(ratio)) continue;
      largest = ratio;
      of = parameters[i].json_name;
      freedom = errors.freedom[row];
    }
  }
  if (largest <= kMuchLarger) return;
  material->remarks.push_back(
      fmt::format("taking the samples of one file as dependent too makes standard errors up to {:.2g} times as large "
                  "(of {}, with {:.2g} degrees of freedom): stderr_by_file of the document",
                  largest, of, freedom));
}

namespace {

// The inverse's part of the border, by Schur's complement: of 800 channels the whole would take minutes and 300 MB.
// Exact for what is determined, whatever directions of the rest are not.
Eigen::MatrixXd InverseOfBorder(const ArrowMatrix& hessian) {
  Eigen::MatrixXd rest = hessian.border;
  for (std::size_t c = 0; c < hessian.own.size(); ++c) {
    if (hessian.own[c].size() == 0) continue;
    const Eigen::MatrixXd inverse = hessian.own[c].completeOrthogonalDecomposition().pseudoInverse();
    rest -= hessian.across[c] * inverse * hessian.across[c].transpose();
  }
  return rest.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace

void FlagUndeterminedProfiles(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                              const Samples& samples, ThreadPool* pool, Material* material) {
  constexpr double kMostShare = 0.5;
  const std::vector<Coordinate>& coordinates = layout.coordinates();
  if (std::none_of(coordinates.begin(), coordinates.end(), [](const Coordinate& c) { return c.prior > 0; })) return;
  ArrowMatrix hessian;
  Eigen::VectorXd gradient;
  const double cost = LineariseBlocks(problem, layout, u.data(), pool, &hessian, &gradient);
  const double square = 2 * cost / static_cast<double>(problem.size() * problem.channels());
  const std::vector<int>& border = hessian.shape.border;  // to which profiles belong
  const Eigen::MatrixXd covariance = square * InverseOfBorder(hessian);
  const std::vector<Parameter> parameters = Parameters(material->model);
  const KernelModel kernel = layout.ToKernel(u.data());
  for (std::size_t l = 0; l < material->model.lobes.size(); ++l) {
    const Lobe& lobe = material->model.lobes[l];
    if (FamilyOf(lobe.ndf) != Family::kProfile) continue;
    const double reach = LargestRadius(lobe, kernel.lobes[l].shape.slope, samples);
    const std::size_t first = FirstParameter(material->model, l) + kEllipseParameters;
    for (std::size_t k = 0; first + k < FirstFresnel(material->model, l); ++k) {
      FittedParameter& fitted = material->parameters[first + k];
      for (std::size_t i = 0; i < border.size(); ++i) {
        const Coordinate& coordinate = coordinates[static_cast<std::size_t>(border[i])];
        if (coordinate.name != parameters[first + k].name) continue;
        const auto at = static_cast<Eigen::Index>(i);
        const double from = GridOf(lobe)->spline()->FirstRadius(k);
        if (from <= reach && !(covariance(at, at) * coordinate.prior > kMostShare)) continue;
        fitted.standard_error = fitted.standard_error_clustered = {kNan};
        const double value = fitted.values[0];
        const std::string stands = std::fabs(value) * std::sqrt(coordinate.prior) <= 1
                                       ? "it is held near GGX's"
                                       : fmt::format("its value of {:.3g}, far from GGX's 0, tells nothing", value);
        material->degenerate.push_back(fmt::format(
            "{}: the density {} {:g} alphas is not determined by these samples; {}", parameters[first + k].name,
            from > 0 ? "beyond" : "from the mean slope on, within", from > 0 ? from : 1.0, stands));
      }
    }
  }
}

bool DeterminedButForCurves(const Uncertainty& uncertainty, const Layout& layout) {
  if (uncertainty.determined()) return true;
  const Model& model = layout.recipe().model;
  std::vector<bool> curve(Parameters(model).size());
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    if (model.lobes[l].fresnel != Fresnel::kCurve) continue;
    const auto first = curve.begin() + static_cast<std::ptrdiff_t>(FirstFresnel(model, l));
    std::fill_n(first, FresnelParameters(Fresnel::kCurve), true);
  }
  std::size_t entry = 0;
  const std::vector<Parameter> parameters = Parameters(model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (std::size_t c = 0; c < (parameters[i].per_channel ? layout.channels() : 1); ++c, ++entry) {
      if (uncertainty.undetermined[entry] && !curve[i]) return false;
    }
  }
  return true;
}

Minimum Describe(const Layout& layout, const DistinctMinimum& minimum) {
  Minimum described;
  described.cost = minimum.solution.cost;
  described.starts = minimum.starts;
  const std::vector<Parameter> parameters = Parameters(layout.recipe().model);
  const ParameterValues values = layout.Report(minimum.solution.u.data());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].group == ParameterGroup::kShape) {
      described.parameters.emplace_back(parameters[i].json_name, values[i][0] / InsideFactor(parameters[i]));
    }
  }
  return described;
}

}  // namespace lobefit
