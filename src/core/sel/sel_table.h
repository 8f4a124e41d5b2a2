// Reflectance as a table of squared ellipsoidal lobes: for each incident direction a few lobes and a constant.
//
// A slice (one incident direction) is g(wo) = constant + sum over lobes of amplitude K(wo), with g = f_r or g = f_r
// cos_theta_o. Lobes are given relative to the mirror direction of wi, so that they change little from one incident
// direction to the next and can be interpolated. The mirror frame of wi: z the mirror direction (-wi_x, -wi_y, wi_z), x
// the direction of growing polar angle there, in the plane of incidence, y = z x x across it. For wi along the normal
// its azimuth is taken as 0.
#pragma once

#include <cstddef>
#include <vector>

#include "lobefit/math/vec.h"

namespace lobefit {

enum class SelQuantity {
  kBrdf,         // g = f_r
  kBrdfCosineO,  // g = f_r cos_theta_o
};
// "f", "f-cos-o".
const char* NameOf(SelQuantity quantity);

// Domain: 0 < alpha_y <= alpha_x <= 1. The larger alpha has its axis at `psi` from the plane of incidence.
struct SelShape {
  double alpha_x = 0.3, alpha_y = 0.3;
  // The lobe's axis is turned away from the mirror direction along a great circle by the length of (offset_in,
  // offset_across), radians, towards x (growing polar angle) and y of the mirror frame.
  double offset_in = 0, offset_across = 0;
  double psi = 0;  // radians, from x towards y about the axis
};

// One lobe, made ready for many directions.
class SelLobeInFrame {
 public:
  explicit SelLobeInFrame(const SelShape& shape);
  // K at the unit direction v of the mirror frame. gradient: by alpha_x, alpha_y, offset_in, offset_across, psi; null:
  // not wanted. At alpha_x = alpha_y the derivatives are those of the side alpha_x > alpha_y (sel.h, SelKink).
  double Evaluate(const Vec3& v, double gradient[5]) const;
  // Rows: the lobe's axes in the mirror frame.
  const Mat3& axes() const { return axes_; }

 private:
  SelShape shape_;
  double cos_psi_, sin_psi_;
  Mat3 axes_, jacobian_transposed_;
};

struct SelSlice {
  double theta_i = 0, phi_i = 0;  // radians
  std::vector<SelShape> lobes;
  std::vector<std::vector<double>> amplitude;  // [lobe][channel], >= 0
  std::vector<double> constant;                // [channel], >= 0
};

struct SelTable {
  SelQuantity quantity = SelQuantity::kBrdfCosineO;
  bool isotropic = false;  // the lobes turn with the azimuth of wi; each polar angle has one slice
  bool bound = false;      // fitted as an upper bound of the samples
  std::vector<SelSlice> slices;
};

// Rows: axes of the mirror frame of wi.
Mat3 MirrorFrame(const Vec3& wi);

// A table as a function of both directions. Between its slices the lobes are interpolated: linearly in polar angle
// between two rings, and in each ring linearly in azimuth between two slices; offsets, amplitudes and constants
// linearly, widths and orientation through the logarithm of the 2x2 matrix of width. Beyond the first and last ring the
// nearest one holds, and in a ring with a single azimuth the lobes turn with the plane of incidence.
class SelReflectance {
 public:
  // Slices of one polar angle, by growing azimuth. Along the normal all azimuths are one direction: lobes that are
  // `fixed` do not turn with the plane of incidence.
  struct Ring {
    double theta;
    std::vector<std::size_t> slices;
    bool fixed;
  };

  // Domain: at least one slice; all with the same numbers of lobes and channels.
  explicit SelReflectance(const SelTable& table);

  std::size_t channels() const { return table_.slices[0].constant.size(); }
  const SelTable& table() const { return table_; }
  const std::vector<Ring>& rings() const { return rings_; }  // by growing polar angle
  // The lobes for an incident direction.
  SelSlice At(const Vec3& wi) const;
  // f_r[c], 1/sr, for unit directions; 0 where one of them is at or below the horizon.
  void Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const;
  // The same for many wo of one wi.
  void Evaluate(const Vec3& wi, const std::vector<Vec3>& wo, std::vector<std::vector<double>>* f_r) const;

 private:
  struct Share {
    std::size_t slice;
    double weight, turn;  // azimuth by which the slice's frame must be turned into that of wi
  };
  void AddShares(const Ring& ring, double phi, double weight, std::vector<Share>* shares) const;

  SelTable table_;
  std::vector<Ring> rings_;
};

}  // namespace lobefit
