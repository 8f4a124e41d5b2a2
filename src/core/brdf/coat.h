// A clear dielectric coat over any base, and the mirrored direction of retroreflecting lobes.
//
// MATH.md sections 8.5, 8.6. With T(c) = 1 - F(c, n), u' the direction inside the coat and tau its optical depth along
// the normal, one way:
//   refracted:  f = f_c + (T_i T_o / n^2) exp(-tau (1 / i'_z + 1 / o'_z)) f_base(i', o')
//   layered:    f = f_c + T_i T_o exp(-2 tau) f_base(i, o),
// f_c = F(o.h, n) D_c G_c / (4 cos_i cos_o), GGX about the normal. 1 / n^2: radiance is n^2 larger inside. Both are
// reciprocal where the base is; a Lambertian part of the base reflects inside many times (diffuse.h), a lobe once, so
// that no energy is made.
#pragma once

#include "lobefit/core/radial/slope_distribution.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// wi seen in the mirror of the normal: a lobe about the back direction is the lobe at (Mirrored(wi), wo). It is
// reciprocal if D(x, y, z) = D(-x, -y, z), so for a zero mean slope.
inline Vec3 Mirrored(const Vec3& w) { return {-w.x, -w.y, w.z}; }

// u inside a medium of index n >= 1, and its derivative by n.
Vec3 Refracted(const Vec3& u, double ior, Vec3* dior = nullptr);

// A coat of index `ior` lets through f_base(inside_i, inside_o) clear exp(-tau path), all but what it absorbs by its
// depth tau: clear = T_i T_o, and / n^2 where refracted; path = 2, or 1 / i'_z + 1 / o'_z.
struct CoatPassage {
  double clear, path;
  double dlog_clear_dior, dpath_dior;
  Vec3 inside_i, inside_o;
  Vec3 dinside_i_dior, dinside_o_dior;
};
CoatPassage PassThroughCoat(double ior, bool refracted, const Vec3& wi, const Vec3& wo);

// f_base of a Lambertian body below the coat with the apparent albedo 1 (diffuse.h), 1/sr: 1 / (pi (1 - F_ex)), and n^2
// where refracted. With it a clear coat over such a body is `interfaced` and the lobe.
double LambertBelowCoat(double ior, bool refracted, double* dior = nullptr);

struct Coat {
  double alpha = 0.1;  // of its GGX lobe, about the normal
  double ior = 1.5;
  double tau = 0.0;  // optical depth of one pass along the normal
  bool refracted = false;
};

// What the coat adds, and what of the base it lets through: f = lobe + through f_base(inside_i, inside_o).
struct CoatFactors {
  double lobe, through;
  Vec3 inside_i, inside_o;
  double dlobe_dalpha, dlobe_dior, dthrough_dior, dthrough_dtau;
  Vec3 dinside_i_dior, dinside_o_dior;
};
CoatFactors EvaluateCoat(const Coat& coat, const Vec3& wi, const Vec3& wo);

// The specular factor D G2 / (4 cos_i cos_o) of a slope distribution with separable, clamped Smith masking, times
// Schlick's F, with its derivatives in the two directions as free variables as well. Where G1 is cut it is 1 and moves
// with the direction only.
struct DirectionalSpecular {
  double value;  // with F
  double by_shape[kSlopeParameters];
  double df0;
  Vec3 dwi, dwo;
};
DirectionalSpecular SpecularWithDirections(const SlopeDistribution& slopes, double f0, const Vec3& wi, const Vec3& wo);

}  // namespace lobefit
