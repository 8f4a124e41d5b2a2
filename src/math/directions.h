// Directions in spherical angles, half and difference vectors [Rusinkiewicz 1998], mirror and shading frames.
#pragma once

#include "lobefit/math/vec.h"

namespace lobefit {

// Unit vector of polar angle theta from +z and azimuth phi counter-clockwise from +x seen from +z; radians.
Vec3 FromSpherical(double theta, double phi);

// Polar angle in [0, pi], accurate near 0 and pi too (atan2, not acos). Azimuth in (-pi, pi], 0 for a direction along
// z.
double PolarAngle(const Vec3& w);
double Azimuth(const Vec3& w);

// Half vector of two unit directions that are not opposite: (wi + wo) / |wi + wo|.
Vec3 HalfVector(const Vec3& wi, const Vec3& wo);

// Mirror image of w about the unit axis m: 2 (w.m) m - w.
Vec3 Reflect(const Vec3& w, const Vec3& m);

// Half and difference angles, radians: wh = FromSpherical(theta_h, phi_h);
// the difference vector d = Ry(-theta_h) Rz(-phi_h) wi = FromSpherical(theta_d, phi_d). Where theta_h = 0, phi_h = 0 by
// choice.
struct HalfDifference {
  double theta_h, phi_h, theta_d, phi_d;
};
HalfDifference ToHalfDifference(const Vec3& wi, const Vec3& wo);
// Without phi_h (given as 0), and phi_d folded into [0, pi/2], which reciprocity and mirror symmetry make one: for
// isotropic surfaces, to rounding, in half the time.
HalfDifference ToFoldedHalfDifference(const Vec3& wi, const Vec3& wo);
void FromHalfDifference(const HalfDifference& angles, Vec3* wi, Vec3* wo);

// Rotation about z by `angle` radians, counter-clockwise seen from +z.
Vec3 RotateZ(const Vec3& w, double angle);
// Rotation about y by `angle` radians: +z turns towards +x.
Vec3 RotateY(const Vec3& w, double angle);
// Rotation about x by `angle` radians: +y turns towards +z.
Vec3 RotateX(const Vec3& w, double angle);

}  // namespace lobefit
