// Pairs of directions from the coordinates that a row gives, whichever of the usual sets they are.
//
// Angles: polar from +z, azimuth counter-clockwise from +x seen from +z. A negative polar angle is the other side:
// theta < 0 stands for |theta| at phi + 180 degrees. Without azimuths the rows lie in one plane with signed angles: the
// light stands at azimuth 0 and the receiver on the mirror side, so that theta_o = theta_i is the specular direction
// and theta_o = -theta_i the light's own; beta = sin(theta_o) and beta0 = sin(theta_i) of stray-light work count the
// same way. With azimuth, incidence and receive (three-axis instruments) the azimuth is that of the receiver's plane,
// counted so that at 90 degrees a positive receive angle lies on the light's side; the light is at azimuth 0, so
// phi_o = azimuth - 90 degrees. Half and difference angles are those of Rusinkiewicz (math/directions.h).
#pragma once

#include <array>
#include <string>

#include "lobefit/io/csv/names/columns.h"
#include "lobefit/math/vec.h"

namespace lobefit {

using Coordinates = std::array<double, kCoordinates>;

// How a file's numbers become directions. The numbers that are not `given` are not read.
class DirectionReader {
 public:
  // A coordinate of the file, in radians per unit (1 for sines, cosines and components).
  void Give(Coordinate coordinate, double radians_per_unit, AngleForm form = AngleForm::kPolar);
  double RadiansPerUnit(Coordinate coordinate) const { return angles_[static_cast<std::size_t>(coordinate)].scale; }
  bool Has(Coordinate coordinate) const { return angles_[static_cast<std::size_t>(coordinate)].given; }
  // theta_i - theta_o instead of theta_o - theta_i; an offset of which the sign is not known, taken towards the normal.
  void SetOffset(bool reversed, bool magnitude);
  void SetPropagation(bool propagation) { propagation_ = propagation; }

  // "" where the coordinates given make a pair, else what is missing: "the polar angle of the viewer (theta_o)".
  std::string Missing() const;
  // How the azimuths are understood, for the echo of conventions; empty where the file gives phi_i and phi_o.
  std::string Azimuths() const;
  // True where the coordinates cannot tell one azimuth of the sample from another.
  bool IsIsotropic() const;

  // Unit directions. False for numbers that are not finite or no directions (a beta beyond 1): the row cannot be used.
  bool Directions(const Coordinates& at, Vec3* wi, Vec3* wo);

 private:
  // Sine and cosine; rows of a goniometer repeat their angles, so the last one is kept.
  struct Angle {
    bool given = false;
    AngleForm form = AngleForm::kPolar;
    double scale = 1;
    double last = 0, sin = 0, cos = 1;
    void Set(double number);
  };
  Angle& Of(Coordinate coordinate, const Coordinates& at);
  bool ViewerInPlane(const Coordinates& at, double sin_i, double cos_i, double* sin_o, double* cos_o);
  bool FromAngles(const Coordinates& at, Vec3* wi, Vec3* wo);
  bool FromHalf(const Coordinates& at, Vec3* wi, Vec3* wo);

  std::array<Angle, kCoordinates> angles_;
  double offset_sign_ = 1;
  bool magnitude_ = false, propagation_ = false;
};

}  // namespace lobefit
