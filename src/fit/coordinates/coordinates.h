// The solver's coordinates: which numbers Ceres moves, and how they become a model, and how they are reported.
//
// Shape. A free ellipsoid moves in slope coordinates (off_center.h), which cover it once and without singularities.
// Where the choice of NDF or the recipe fixes, bounds or ties single angles or alphas, the lobe moves in ln alpha and
// the angles that are left. Fresnel parameters and diffuse albedos are coordinates of their own, one a channel or one
// for all.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "lobefit/fit/coordinates/arrow.h"
#include "lobefit/fit/kernel/kernel.h"
#include "lobefit/recipe/recipe.h"

namespace lobefit {

// The cosine of the difference angle for which the rules of means (LobeMeanRule) are made: 60 degrees.
inline constexpr double kMeanCosine = 0.5;

// Rows of many channels depend on the shape and their own channel only: dense products took half of the time of a fit
// with 800 of them, and dense rows a third of its memory.
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

struct Coordinate {
  std::string name;  // for messages: "ln alpha_x", "f0[R]"
  double low, high;  // bounds of the solver
  // Weight of a prior: the cost grows by s^2 prior u^2 / 2, s^2 the mean square of the residuals. That of GGX for the
  // coefficients of a profile: where nothing was measured they stay near it (math.md 8.1, tau = 2).
  double prior = 0;
  // The prior is what is known of the coordinate from elsewhere, 1 / prior its variance, and counts as one more
  // observation; else it is a preference, and says nothing of the error.
  bool observed = false;
};

// How near a bound a coordinate lies on it: solvers end there to rounding. Of wide ranges that of amplitudes (factors
// up to 1e6) is no measure: the scatter of a mirror has a factor of 1e-5.
inline double BoundSlack(const Coordinate& coordinate) {
  return 1e-9 * std::min(1.0, coordinate.high - coordinate.low);
}

class Layout {
 public:
  // Throws InputError where nothing is left to fit.
  Layout(const Recipe& recipe, const std::vector<std::string>& channels);

  std::size_t size() const { return coordinates_.size(); }
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  std::size_t channels() const { return channels_; }
  // Coordinates [0, shape_size()) are common to the channels: shapes, lobe by lobe, then the angles of the alignment,
  // from first_angle() on, then those of the discs, from first_half_angle() on, as differences from the recipe's. The
  // rest are Fresnel parameters, albedos and offsets.
  std::size_t shape_size() const { return shape_size_; }
  std::size_t first_angle() const { return first_angle_; }
  std::size_t first_half_angle() const { return first_half_angle_; }
  // The discs at `u`.
  Aperture ApertureAt(const double* u) const;
  const Recipe& recipe() const { return recipe_; }
  // True where the lobe moves in slope coordinates.
  bool in_slope_space(std::size_t lobe) const { return shapes_[lobe].slope; }

  // The model at `u`, with the Jacobians of the shapes.
  KernelModel ToKernel(const double* u) const;
  // Leaves out the columns of the lobes' shapes for what moves amplitudes only, whose derivatives took a quarter of a
  // pass over many channels. Returns how many columns of a channel are gone: none with an alignment or half angles.
  std::size_t DropShapes(KernelModel* kernel) const;

  // Coordinates of lobe shapes given as ellipsoids, Fresnel parameters and albedos at the start that the recipe or the
  // parameter table gives; fixed ones are ignored, all are moved into the bounds.
  std::vector<double> FromShapes(const std::vector<Ellipsoid>& shapes) const;

  // The coordinates of profiles, from one point to another.
  void CopyProfiles(const std::vector<double>& from, std::vector<double>* to) const;

  // Whether two lobes exchange without another model: of one kind, with the same bounds and fixed values.
  bool AreInterchangeable(std::size_t lobe, std::size_t other) const;
  // The point that describes the same material as `u` and is nearest to `to`: lobes of one kind are interchangeable,
  // the axes of an ellipsoid too, and half a turn of them changes nothing. It may lie beyond bounds of angles.
  std::vector<double> NearestEquivalent(const std::vector<double>& u, const std::vector<double>& to) const;

  // Coordinate of each column of channel `c` of the kernel, the residual's left out; -1: a fixed parameter, or the
  // gain.
  std::vector<int> CoordinatesOfColumns(std::size_t c) const;

  // Gauss-Newton matrix J^T J and gradient J^T r in solver coordinates from the sums over samples.
  void Gather(const KernelSums& sums, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const;
  // The same, linear in the channels; zero for the first `dropped` coordinates (DropShapes).
  void Gather(const KernelSums& sums, ArrowMatrix* hessian, Eigen::VectorXd* gradient, std::size_t dropped = 0) const;
  // Scores of the kernel (shape columns, then [channel][linear]) as scores of the solver's coordinates, arrays by
  // coordinate.
  std::vector<std::vector<double>> GatherScores(const std::vector<std::vector<double>>& scores) const;

  // Entry of a Fresnel parameter or albedo in the solver's coordinates; -1: fixed, then `value`. Most enter f_r
  // linearly.
  struct Linear {
    int index = -1;
    double value = 0;
    double start = 0;
  };
  // Those of a channel: the lobes' Fresnel parameters, then the diffuse albedo if the model has one, then the offset.
  const std::vector<Linear>& linear(std::size_t channel) const { return linear_[channel]; }

  // Reported values at `u`, inside units, in the order of Parameters(model).
  ParameterValues Report(const double* u) const;
  // d(reported entry) / d(coordinate), rows over the flattened entries of Report, then over the coordinates of the
  // instrument: angles of the alignment, offsets of the channels. Rows of a lobe whose angles are not
  // differentiable (equal alphas) are NaN.
  SparseRows ReportJacobian(const double* u) const;

 private:
  struct Shape {
    bool slope = false;                        // slope coordinates, else ln alpha and angles
    std::vector<int> entries;                  // slope coordinates, or ellipsoid parameters, that are free
    std::vector<std::size_t> profile;          // free parameters of the profile, whose coordinates follow
    std::vector<double> profile_start;         // of all of them, free or not
    bool tied = false;                         // alpha_y follows alpha_x
    double fixed[5] = {1, 1, 0, 0, 0};         // ellipsoid parameters that are not free
    std::size_t first = 0;                     // first coordinate
    std::shared_ptr<const LobeMeanRule> mean;  // over the recipe's aperture; null: a point
    std::size_t columns() const { return entries.size() + profile.size(); }
  };

  // Calls add(channel, i, j, value) for each entry of the upper triangles of the channels, and of the priors (of
  // shapes), that is one of J^T J, and sums up the gradient.
  template <class Add>
  void GatherEntries(const KernelSums& sums, std::size_t dropped, const Add& add, Eigen::VectorXd* gradient) const;
  void AddShape(std::size_t lobe, const std::vector<Parameter>& parameters, std::size_t first_parameter);
  void AddProfile(std::size_t lobe, const std::vector<Parameter>& parameters, Shape* shape);
  // The mean over the recipe's aperture, and bounds that keep the lobe as wide as its cubature can take.
  void AddMean(std::size_t lobe, Shape* shape);
  // Parameters of the profile at `u`, and where asked d(parameter) / d(coordinate) of the free ones.
  std::vector<double> ProfileAt(std::size_t lobe, const double* u, std::vector<double>* slopes = nullptr) const;
  // Of lobes with an exponent, whose coordinate is the logarithm of what it has above this.
  bool IsExponent(std::size_t lobe) const { return HasExponent(recipe_.model.lobes[lobe].ndf); }
  double LeastExponent(std::size_t lobe) const {
    constexpr double kLeastGamma = 1.5;  // below, Student's slopes have no mean
    return FamilyOf(recipe_.model.lobes[lobe].ndf) == Family::kStudent ? kLeastGamma : 0.0;
  }
  void AddAngles();
  void AddHalfAngles();
  // Sets the lobes' rules at `u` and those of the half angles' columns, where there are such.
  void SetDiscs(const double* u, KernelModel* kernel) const;
  void AddOffset(const std::vector<std::string>& channels);
  void AddLinear(const Parameter& parameter, const ParameterRecipe& entry, const std::vector<std::string>& channels);
  double Value(const Linear& linear, const double* u) const {
    return linear.index < 0 ? linear.value : u[linear.index];
  }
  Ellipsoid EllipsoidAt(const Shape& shape, const double* u) const;
  void SetEllipsoid(const Shape& shape, const Ellipsoid& ellipsoid, std::vector<double>* u) const;
  // Those of the lobe's shape, then of its Fresnel parameters channel by channel; -1: fixed.
  std::vector<int> CoordinatesOfLobe(std::size_t lobe) const;
  SlopeCoordinates SlopeAt(const Shape& shape, const double* u) const;

  Recipe recipe_;
  std::size_t channels_;
  std::size_t first_angle_ = 0, first_half_angle_ = 0, shape_size_ = 0;
  std::vector<Coordinate> coordinates_;
  std::vector<Shape> shapes_;
  std::vector<std::vector<Linear>> linear_;
};

}  // namespace lobefit
