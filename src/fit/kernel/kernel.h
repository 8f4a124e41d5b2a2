// The inner loop of a fit: streams samples in SIMD blocks and keeps only sums, so that no residual and no Jacobian is
// ever stored. Includes neither Ceres nor Eigen (platform: they must not meet instruction-set flags).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/brdf/model.h"
#include "lobefit/core/instrument/mean_lobe.h"
#include "lobefit/fit/metric/loss.h"
#include "lobefit/fit/metric/transform.h"

namespace lobefit {

// Samples as the loop reads them, in place: what follows from them (transformed values, weights) is computed anew in
// every pass, so that a fit needs no memory that grows with their number.
struct KernelSamples {
  const double* direction[6];           // wi_x, wi_y, wi_z, wo_x, wo_y, wo_z
  std::vector<const double*> measured;  // f_r[c][i]
  // The weight of a squared residual is weight_scale times these; null: 1.
  const double* weight = nullptr;
  const double* solid_angle = nullptr;
  bool sin_i = false, sin_o = false;  // times the sine of the polar angle
  double weight_scale = 1;
  // What a reading is multiplied by (gains.h): gain[gain_group[i]]; null: 1.
  const std::uint32_t* gain_group = nullptr;
  const double* gain = nullptr;
  // Which of KernelModel::turns a sample was measured in; null: the first.
  const std::uint16_t* turn = nullptr;
  std::size_t count = 0;
};

struct KernelLobe {
  Lobe kind;
  LobeShape shape;
  std::vector<double> fresnel;  // [channel][FresnelParameters(kind.fresnel)]
  // d(slope coordinates, then the profile's parameters) / d(solver's shape coordinates), ShapeParameters(kind) x
  // columns row-major.
  std::size_t columns = 0;
  std::vector<double> jacobian;
  // Over the instrument's discs; null: at a point. The same for a whole descent.
  std::shared_ptr<const LobeMeanRule> mean = nullptr;
};

// How the sample stands crooked on its stage: turned by R = Rz(e_z) Ry(e_y) Rx(e_x) against where the instrument has
// it. Directions in its frame are w' = Rz(-z) R^T Rz(z) w, z the sample's azimuth on the stage: e_x and e_y are common
// to all turns, e_z is 0 in the first and free in the others.
struct KernelAlignment {
  std::vector<double> azimuths;  // z of each turn
  std::vector<double> angles;    // e_x, e_y, e_z of the second turn and so on; empty: the sample stands straight
};

// A half angle that is fitted: the lobes' rules with it `step` smaller and larger, whose values give its column.
struct KernelHalfAngle {
  double step = 0;
  std::vector<std::shared_ptr<const LobeMeanRule>> below, above;  // [lobe]
};

struct KernelModel {
  std::vector<KernelLobe> lobes;
  std::vector<double> diffuse;  // [channel][DiffuseParameters(diffuse_kind)]; empty: no diffuse part
  Diffuse diffuse_kind = Diffuse::kLambert;
  std::size_t channels = 1;
  Transform transform;
  Loss loss = Loss::kNone;
  double loss_scale = 1;
  KernelAlignment alignment;
  std::vector<KernelHalfAngle> half_angles;  // those that are fitted
  std::vector<double> offset;                // [channel], of f_r cos_theta_i, 1/sr; empty: none
  bool gains = false;                        // readings have gains, whose logarithm has a column
  // Weights of the priors and the solver's coordinates (Coordinate::prior); empty: none.
  std::vector<double> prior, coordinates;

  std::size_t shape_columns() const;  // with the angles of the alignment and the discs
  // Columns of one channel: shape coordinates of all lobes, the angles of the alignment and of the discs (central
  // differences of the model, 1e-6 of them), Fresnel parameters lobe by lobe, the diffuse albedo, the offset, the
  // logarithm of the sample's gain where readings have them, the residual.
  std::size_t columns() const;
};

// Products of the column of a gain's logarithm with all columns, channel by channel, over the samples of its group.
struct GainArrow {
  std::uint32_t group;
  std::vector<double> products;  // [channel][column]
};

// Sums over samples. gram[c] is the upper triangle, row by row, of the Gram matrix of channel c's columns.
struct KernelSums {
  double sum_rho = 0;  // sum over samples of rho(sum over channels of weighted squared residuals)
  std::vector<std::vector<double>> gram;
  double sum_robust_weight = 0;   // sum of rho'; equals the count without a loss
  std::vector<GainArrow> arrows;  // of the groups that occur, with the gram and gains
  // Of the priors, once all samples are summed (Problem::Sum, which adds their part to sum_rho too): second and first
  // derivatives of half their sum, a coordinate; empty: none.
  std::vector<double> prior_curvature, prior_slope;
};

// Adds the samples [begin, end) to `sums`; without `gradient` only sum_rho. The order of additions depends on begin and
// end only; the width of the vectors, and so the last bit of the sums, on the processor.
void Accumulate(const KernelSamples& samples, const KernelModel& model, bool gradient, std::size_t begin,
                std::size_t end, KernelSums* sums);

// The column of each gain's logarithm squared and times the residual, summed over the samples of its group; without the
// model's derivatives.
struct GainSums {
  std::vector<double> curvature, slope;  // [group]
  double sum_of_squares = 0;             // of the residuals
  double weighted_squares = 0;           // of the residuals times the column
};
void SumGains(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
              GainSums* sums);

// Rows of J^T r a sample, for sandwich estimates: scores[j][i - begin] with j over shape columns, then
// [channel][columns of that channel].
void Scores(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
            std::vector<std::vector<double>>* scores);

// The weighted Jacobian and the residuals themselves: columns[c][j * (end - begin) + i - begin] with j over the columns
// of KernelModel, the last one the residual.
void Columns(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
             std::vector<std::vector<double>>* columns);

// f_r of the model: values[c][i - begin].
void ModelValues(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
                 std::vector<std::vector<double>>* values);

}  // namespace lobefit
