#include "lobefit/io/alta/directions.h"

#include <cmath>

#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr Vec3 kNowhere = {0, 0, -1};

// sqrt(1 - s), or the pair below the horizon where s > 1: no direction has such coordinates.
bool Height(double s, double* height) {
  if (!(s <= 1)) return false;
  *height = std::sqrt(1 - s);
  return true;
}

void Nowhere(Vec3* wi, Vec3* wo) { *wi = *wo = kNowhere; }

// The polar angle of a cosine; not a number, which is set aside as "not finite", for one beyond rounding above 1.
double AngleOf(double cosine) { return std::acos(cosine > 1 && cosine < 1 + 1e-9 ? 1.0 : cosine); }

// ALTA turns the difference vector into V: "#PARAM_IN RUSIN_..." is the light's mirror image of the usual reading. The
// two differ only where the data are not reciprocal.
void FromHalf(double theta_h, double phi_h, double theta_d, double phi_d, Vec3* wi, Vec3* wo) {
  FromHalfDifference({theta_h, phi_h, theta_d, phi_d}, wo, wi);
}

// The direction whose polar angle theta and azimuth phi are given as theta cos(phi), theta sin(phi).
Vec3 FromProjected(double x, double y) { return FromSpherical(std::hypot(x, y), std::atan2(y, x)); }

// x = X / (1 + Z), y = Y / (1 + Z).
Vec3 FromStereographic(double x, double y) {
  const double square = x * x + y * y;
  return {2 * x / (1 + square), 2 * y / (1 + square), (1 - square) / (1 + square)};
}

void CosTh(const double* x, Vec3* wi, Vec3* wo) { FromHalf(AngleOf(x[0]), 0, 0, 0, wi, wo); }
void RusinVh(const double* x, Vec3* wi, Vec3* wo) { *wi = *wo = Normalized(Vec3{x[0], x[1], x[2]}); }

// The back vector K of light and mirrored view; with light and view in mirror position it is the light itself. (ALTA's
// own conversion gives 1 - k^2 in place of sqrt(1 - k^2), vectors that are not unit.)
void CosTk(const double* x, Vec3* wi, Vec3* wo) {
  const double theta = AngleOf(x[0]);
  *wi = FromSpherical(theta, 0);
  *wo = FromSpherical(theta, kPi);
}
void SchlickVk(const double* x, Vec3* wi, Vec3* wo) {
  *wi = Normalized(Vec3{x[0], x[1], x[2]});
  *wo = {-wi->x, -wi->y, wi->z};
}

// Light along the normal, view at the given angle from it; the reflected direction is the normal, too.
void CosTlv(const double* x, Vec3* wi, Vec3* wo) {
  *wi = {0, 0, 1};
  *wo = FromSpherical(AngleOf(x[0]), 0);
}
void CosTlr(const double* x, Vec3* wi, Vec3* wo) {
  *wi = {0, 0, 1};
  *wo = FromSpherical(AngleOf(x[0]), kPi);
}
void IsotropicTvProjDphi(const double* x, Vec3* wi, Vec3* wo) {
  *wi = {0, 0, 1};
  *wo = FromProjected(x[0], x[1]);
}

void CosThTd(const double* x, Vec3* wi, Vec3* wo) { FromHalf(AngleOf(x[0]), 0, AngleOf(x[1]), 0, wi, wo); }
void RusinThTd(const double* x, Vec3* wi, Vec3* wo) { FromHalf(x[0], 0, x[1], kPi / 2, wi, wo); }
void RusinThTdPd(const double* x, Vec3* wi, Vec3* wo) { FromHalf(x[0], 0, x[1], x[2], wi, wo); }
void RusinThPhTdPd(const double* x, Vec3* wi, Vec3* wo) { FromHalf(x[0], x[1], x[2], x[3], wi, wo); }

// Stark: x[0] = |H| projected, x[1] = |B|, x[2] = phi_B - phi_H with H = (L + V) / 2, B = (L - V) / 2, which are
// orthogonal, |H|^2 + |B|^2 = 1. H lies over the x axis. (ALTA's own conversion of the azimuth gives -B.)
void Stark(double h, double b, double phi, Vec3* wi, Vec3* wo) {
  double height = 0;
  if (!Height(h * h + b * b, &height)) return Nowhere(wi, wo);
  const double theta = std::atan2(height, -h * std::cos(phi));
  const Vec3 half = {h, 0, height};
  const Vec3 back = b * FromSpherical(theta, phi);
  *wi = half + back;
  *wo = half - back;
}
void Stark2d(const double* x, Vec3* wi, Vec3* wo) { Stark(x[0], x[1], kPi / 2, wi, wo); }
void Stark3d(const double* x, Vec3* wi, Vec3* wo) { Stark(x[0], x[1], x[2], wi, wo); }

// Neumann: the same with B projected as well. (ALTA's own conversion of the azimuth gives -B here, too.)
void Neumann(double h, double b, double phi, Vec3* wi, Vec3* wo) {
  const double x = b * std::cos(phi), y = b * std::sin(phi);
  double wi_z = 0, wo_z = 0;
  if (!Height((h + x) * (h + x) + y * y, &wi_z) || !Height((h - x) * (h - x) + y * y, &wo_z)) return Nowhere(wi, wo);
  *wi = {h + x, y, wi_z};
  *wo = {h - x, -y, wo_z};
}
void Neumann2d(const double* x, Vec3* wi, Vec3* wo) { Neumann(x[0], x[1], kPi / 2, wi, wo); }
void Neumann3d(const double* x, Vec3* wi, Vec3* wo) { Neumann(x[0], x[1], x[2], wi, wo); }

void IsotropicTvTlDphi(const double* x, Vec3* wi, Vec3* wo) {
  *wo = FromSpherical(x[0], 0);
  *wi = FromSpherical(x[1], x[2]);
}
void IsotropicTlTvProjDphi(const double* x, Vec3* wi, Vec3* wo) {
  *wi = FromSpherical(x[0], 0);
  *wo = FromProjected(x[1], x[2]);
}

// View is the mirror image of the reflected light about the back vector.
void SchlickTlTkProjDphi(const double* x, Vec3* wi, Vec3* wo) {
  *wi = FromSpherical(x[0], 0);
  *wo = Reflect({-wi->x, -wi->y, wi->z}, FromProjected(x[1], x[2]));
}

// x[1], x[2]: angle between view and light times cosine and sine of the angle at the light between the arcs to the view
// and to the normal. (ALTA's own conversion loses the sign of the view's x.)
void RetroTlTvlProjDphi(const double* x, Vec3* wi, Vec3* wo) {
  *wi = FromSpherical(x[0], 0);
  const double angle = std::hypot(x[1], x[2]), azimuth = std::atan2(x[2], x[1]);
  const Vec3 to_normal = {-std::cos(x[0]), 0, std::sin(x[0])}, side = {0, 1, 0};
  *wo = std::cos(angle) * *wi + std::sin(angle) * (std::cos(azimuth) * to_normal + std::sin(azimuth) * side);
}

void SphericalTlPlTvPv(const double* x, Vec3* wi, Vec3* wo) {
  *wi = FromSpherical(x[0], x[1]);
  *wo = FromSpherical(x[2], x[3]);
}

// View first.
void Stereographic(const double* x, Vec3* wi, Vec3* wo) {
  *wo = FromStereographic(x[0], x[1]);
  *wi = FromStereographic(x[2], x[3]);
}
void Cartesian(const double* x, Vec3* wi, Vec3* wo) {
  *wo = Normalized(Vec3{x[0], x[1], x[2]});
  *wi = Normalized(Vec3{x[3], x[4], x[5]});
}

}  // namespace

const std::vector<AltaInput>& AltaInputs() {
  static const std::vector<AltaInput> inputs = {
      {"COS_TH", 1, true, CosTh},
      {"COS_TK", 1, true, CosTk},
      {"COS_TLV", 1, true, CosTlv},
      {"COS_TLR", 1, true, CosTlr},
      {"RUSIN_TH_TD", 2, true, RusinThTd},
      {"COS_TH_TD", 2, true, CosThTd},
      {"ISOTROPIC_TV_PROJ_DPHI", 2, true, IsotropicTvProjDphi},
      {"STARK_2D", 2, true, Stark2d},
      {"NEUMANN_2D", 2, true, Neumann2d},
      {"RUSIN_TH_TD_PD", 3, true, RusinThTdPd},
      {"RUSIN_VH", 3, false, RusinVh},
      {"SCHLICK_VH", 3, false, SchlickVk},
      {"SCHLICK_VK", 3, false, SchlickVk},
      {"ISOTROPIC_TV_TL_DPHI", 3, true, IsotropicTvTlDphi},
      {"ISOTROPIC_TL_TV_PROJ_DPHI", 3, true, IsotropicTlTvProjDphi},
      {"SCHLICK_TL_TK_PROJ_DPHI", 3, true, SchlickTlTkProjDphi},
      {"RETRO_TL_TVL_PROJ_DPHI", 3, true, RetroTlTvlProjDphi},
      {"STARK_3D", 3, true, Stark3d},
      {"NEUMANN_3D", 3, true, Neumann3d},
      {"RUSIN_TH_PH_TD_PD", 4, false, RusinThPhTdPd},
      {"SPHERICAL_TL_PL_TV_PV", 4, false, SphericalTlPlTvPv},
      {"STEREOGRAPHIC", 4, false, Stereographic},
      {"CARTESIAN", 6, false, Cartesian},
  };
  return inputs;
}

}  // namespace lobefit
