// Visible normals of the ellipsoid distribution [Walter section 4]: density, three ways to sample, weight of a
// reflected sample, mean.
//
// psi is the known direction (unit, psi.z > 0 for a reflectance; any direction but -n works for the normals alone), m
// the micro normal. Points of the ellipsoid are p = A^-1 x with |x| = 1, their normals A^T x; psi sees x where x.(A
// psi) > 0 and x.(A n) > 0: a lune of the sphere.
#pragma once

#include <array>
#include <cmath>

#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/math/quadrature.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// Density of visible normals D(m) max(0, m.psi) / sigma(psi), 1/sr [Walter eq 30 with the one u that it needs];
// integrates to 1. 0 for m.z < 0 and m.psi <= 0 (continuous at the latter). Gradient in the order of Ellipsoid, and by
// the components of psi and m as free variables; null skips.
double EllipsoidVndfPdf(const Ellipsoid& ellipsoid, const Vec3& psi, const Vec3& m, double* gradient = nullptr,
                        Vec3* dpdf_dpsi = nullptr, Vec3* dpdf_dm = nullptr);

// Density of omega = reflection of psi about a visible normal, 1/sr: EllipsoidVndfPdf(m) / (4 m.psi).
double EllipsoidReflectionPdf(const Ellipsoid& ellipsoid, const Vec3& psi, const Vec3& omega);

// What a reflected sample contributes, f_r cos / pdf over the Fresnel reflectance: G1(omega) min(1, sigma(psi) /
// psi.z), never above 1; 0 for omega.z <= 0. Both G1 clamped as in [Walter eq 6].
double EllipsoidReflectionWeight(const Ellipsoid& ellipsoid, const Vec3& psi, const Vec3& omega);

// E[m] over the visible normals, by quadrature of the lune; and, if asked, its derivative by each parameter (E[m d log
// pdf]).
Vec3 EllipsoidMeanVisibleNormal(const Ellipsoid& ellipsoid, const Vec3& psi,
                                std::array<Vec3, kEllipsoidParameters>* gradient = nullptr,
                                const QuadratureOptions& options = {1e-11, 1e-14, 2000});

// Draws visible normals for one ellipsoid and one direction. Constant after construction.
class EllipsoidVndfSampler {
 public:
  EllipsoidVndfSampler(const Ellipsoid& ellipsoid, const Vec3& psi);

  // Version 3: a point of the unit disc, pushed row by row onto the crescent that is the lune's silhouette. Not the
  // affine map of the paper, which cannot make a crescent (MATH.md section 5), but a shear of each row: area preserving
  // up to a constant, smooth, no rejection. u1, u2 in [0, 1].
  Vec3 Sample(double u1, double u2) const;

  // Version 2: points of the sphere's own silhouette until one lies in the lune, 2 / (1 + cos) draws on average.
  // `uniform()` returns numbers in [0, 1); `tries`, if not null, receives the number of draws.
  template <class Uniform>
  Vec3 SampleByEllipsoid(Uniform&& uniform, int* tries = nullptr) const {
    for (int count = 1;; ++count) {
      const double u1 = uniform();
      const Vec3 x = OnSphere(u1, uniform());
      if (Dot(x, b_) < 0) continue;
      if (tries != nullptr) *tries = count;
      return NormalAt(x);
    }
  }

  // Version 1: rays along -psi through the disc of the ellipsoid's bounding sphere until one hits the visible part. The
  // draws needed grow as 1 / (alpha_x alpha_y): for tests and rough surfaces.
  template <class Uniform>
  Vec3 SampleBySphere(Uniform&& uniform, int* tries = nullptr) const {
    for (int count = 1;; ++count) {
      Vec3 m;
      const double u1 = uniform();
      if (!HitFromSphere(u1, uniform(), &m)) continue;
      if (tries != nullptr) *tries = count;
      return m;
    }
  }

 private:
  // Point of the unit sphere above a uniform point of the disc across a_.
  Vec3 OnSphere(double u1, double u2) const;
  // Unit normal A^T x of the ellipsoid's point A^-1 x.
  Vec3 NormalAt(const Vec3& x) const;
  bool HitFromSphere(double u1, double u2, Vec3* m) const;

  double alpha_x_, alpha_y_;
  Mat3 rotation_;
  Vec3 psi_;
  Vec3 a_, b_, e1_, e2_;                 // A psi and A n normalised; e1 across a towards b, e2 = a x e1
  double one_plus_cos_, one_minus_cos_;  // of the angle between a and b
};

}  // namespace lobefit
