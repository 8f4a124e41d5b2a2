#include "lobefit/io/csv/names/directions.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

using C = Coordinate;

Vec3 Turned(const Vec3& w, double cos_angle, double sin_angle) {
  return {cos_angle * w.x - sin_angle * w.y, sin_angle * w.x + cos_angle * w.y, w.z};
}

bool IsFinite(const Vec3& w) { return std::isfinite(w.x + w.y + w.z); }

}  // namespace

void DirectionReader::Angle::Set(double number) {
  if (number == last) return;
  last = number;
  if (form == AngleForm::kCosine) {
    cos = number;
    sin = std::sqrt(1 - number * number);  // NaN for what is no cosine: the row cannot be used
    return;
  }
  const double radians = form == AngleForm::kElevation ? kPi / 2 - number * scale : number * scale;
  sin = std::sin(radians);
  cos = std::cos(radians);
}

void DirectionReader::Give(Coordinate coordinate, double radians_per_unit, AngleForm form) {
  Angle& angle = angles_[static_cast<std::size_t>(coordinate)];
  angle.given = true;
  angle.scale = radians_per_unit;
  angle.form = form;
  angle.last = std::nan("");  // equal to nothing: the first number is taken
}

void DirectionReader::SetOffset(bool reversed, bool magnitude) {
  offset_sign_ = reversed ? -1 : 1;
  magnitude_ = magnitude;
}

std::string DirectionReader::Missing() const {
  if (Has(C::kThetaH)) return Has(C::kThetaD) ? "" : "the difference angle (theta_d) that goes with theta_h";
  if (Has(C::kWiX) || Has(C::kWoX)) {
    for (const C c : {C::kWiX, C::kWiY, C::kWiZ, C::kWoX, C::kWoY, C::kWoZ}) {
      if (!Has(c)) return "a component of the directions; all of wi_x wi_y wi_z wo_x wo_y wo_z are needed";
    }
    return "";
  }
  if (!Has(C::kThetaI) && !Has(C::kBeta0)) return "the polar angle of the light (theta_i)";
  if (!Has(C::kThetaO) && !Has(C::kFromSpecular) && !Has(C::kBistatic) && !Has(C::kDeviation) && !Has(C::kBeta) &&
      !Has(C::kBetaOffset))
    return "the polar angle of the viewer (theta_o)";
  return "";
}

std::string DirectionReader::Azimuths() const {
  if (Has(C::kThetaH)) return "half and difference angles";
  if (Has(C::kWiX)) return "";
  if (Has(C::kPhiO) || Has(C::kDeltaPhi)) return "";
  if (Has(C::kPhase)) return "from the phase angle";
  if (Has(C::kAzimuth)) return "phi_i = 0, phi_o = azimuth - 90 deg";
  if (magnitude_) return "one plane: offsets from the mirror direction without a sign, taken towards the normal";
  if (!Has(C::kPhiI)) return "one plane: theta_o = theta_i is the mirror direction";
  return "";
}

bool DirectionReader::IsIsotropic() const {
  if (Has(C::kSampleRotation)) return false;
  if (Has(C::kThetaH)) return !Has(C::kPhiH);
  return (Has(C::kDeltaPhi) || Has(C::kPhase)) && !Has(C::kPhiI) && !Has(C::kWiX);
}

DirectionReader::Angle& DirectionReader::Of(Coordinate coordinate, const Coordinates& at) {
  const auto index = static_cast<std::size_t>(coordinate);
  angles_[index].Set(at[index]);
  return angles_[index];
}

bool DirectionReader::ViewerInPlane(const Coordinates& at, double sin_i, double cos_i, double* sin_o, double* cos_o) {
  const auto number = [&](Coordinate c) { return at[static_cast<std::size_t>(c)]; };
  if (Has(Coordinate::kThetaO)) {
    const Angle& theta = Of(Coordinate::kThetaO, at);
    *sin_o = theta.sin;
    *cos_o = theta.cos;
    return true;
  }
  // An offset without a sign counts from the mirror direction towards the normal, where there is always a direction.
  const double sign = magnitude_ ? (sin_i < 0 ? 1.0 : -1.0) : offset_sign_;
  if (Has(Coordinate::kFromSpecular)) {
    const Angle& offset = Of(Coordinate::kFromSpecular, at);
    const double s = magnitude_ ? sign * std::fabs(offset.sin) : sign * offset.sin;
    *sin_o = sin_i * offset.cos + cos_i * s;
    *cos_o = cos_i * offset.cos - sin_i * s;
    return true;
  }
  if (Has(Coordinate::kBistatic) || Has(Coordinate::kDeviation)) {
    const bool bistatic = Has(Coordinate::kBistatic);
    const Angle& between = Of(bistatic ? Coordinate::kBistatic : Coordinate::kDeviation, at);
    // theta_o = b - theta_i, with b = 180 degrees - deviation.
    const double cos_b = bistatic ? between.cos : -between.cos;
    *sin_o = between.sin * cos_i - cos_b * sin_i;
    *cos_o = cos_b * cos_i + between.sin * sin_i;
    return true;
  }
  const double beta = Has(Coordinate::kBeta) ? number(Coordinate::kBeta)
                                             : sin_i + sign * (magnitude_ ? std::fabs(number(Coordinate::kBetaOffset))
                                                                          : number(Coordinate::kBetaOffset));
  if (!(std::fabs(beta) <= 1)) return false;
  *sin_o = beta;
  *cos_o = std::sqrt(1 - beta * beta);
  return true;
}

bool DirectionReader::FromAngles(const Coordinates& at, Vec3* wi, Vec3* wo) {
  double sin_i = 0, cos_i = 1, cos_phi = 1, sin_phi = 0;
  if (Has(Coordinate::kThetaI)) {
    const Angle& theta = Of(Coordinate::kThetaI, at);
    sin_i = theta.sin;
    cos_i = theta.cos;
  } else {
    sin_i = at[static_cast<std::size_t>(Coordinate::kBeta0)];
    if (!(std::fabs(sin_i) <= 1)) return false;
    cos_i = std::sqrt(1 - sin_i * sin_i);
  }
  if (Has(Coordinate::kPhiI)) {
    const Angle& phi = Of(Coordinate::kPhiI, at);
    cos_phi = phi.cos;
    sin_phi = phi.sin;
  }
  *wi = {sin_i * cos_phi, sin_i * sin_phi, cos_i};
  double sin_o = 0, cos_o = 1;
  if (!ViewerInPlane(at, sin_i, cos_i, &sin_o, &cos_o)) return false;
  if (Has(Coordinate::kPhiO)) {
    const Angle& phi = Of(Coordinate::kPhiO, at);
    *wo = {sin_o * phi.cos, sin_o * phi.sin, cos_o};
  } else if (Has(Coordinate::kDeltaPhi)) {
    const Angle& phi = Of(Coordinate::kDeltaPhi, at);
    *wo = Turned({sin_o * phi.cos, sin_o * phi.sin, cos_o}, cos_phi, sin_phi);
  } else if (Has(Coordinate::kPhase)) {
    // cos g = cos_i cos_o + sin_i sin_o cos(phi_o - phi_i); rounding of g is not allowed to leave the range.
    const double cos_g = Of(Coordinate::kPhase, at).cos, sines = sin_i * sin_o;
    if (std::isnan(cos_g)) return false;
    const double cos_dphi = std::fabs(sines) < 1e-12 ? 1.0 : std::clamp((cos_g - cos_i * cos_o) / sines, -1.0, 1.0);
    *wo = Turned({sin_o * cos_dphi, sin_o * std::sqrt(1 - cos_dphi * cos_dphi), cos_o}, cos_phi, sin_phi);
  } else if (Has(Coordinate::kAzimuth)) {
    const Angle& phi = Of(Coordinate::kAzimuth, at);
    *wo = Turned({sin_o * phi.cos, sin_o * phi.sin, cos_o}, 0, -1);
  } else {
    *wo = {-sin_o * cos_phi, -sin_o * sin_phi, cos_o};
  }
  return true;
}

bool DirectionReader::FromHalf(const Coordinates& at, Vec3* wi, Vec3* wo) {
  const Angle& theta_h = Of(Coordinate::kThetaH, at);
  const Angle& theta_d = Of(Coordinate::kThetaD, at);
  const Angle phi_h = Has(Coordinate::kPhiH) ? Of(Coordinate::kPhiH, at) : Angle();
  const Angle phi_d = Has(Coordinate::kPhiD) ? Of(Coordinate::kPhiD, at) : Angle();
  // The light in the frame of the half vector, and the viewer opposite to it; the frame is turned by theta_h about y,
  // then by phi_h about z.
  const auto from_half = [&](double x, double y, double z) {
    return Turned({theta_h.cos * x + theta_h.sin * z, y, theta_h.cos * z - theta_h.sin * x}, phi_h.cos, phi_h.sin);
  };
  const double x = theta_d.sin * phi_d.cos, y = theta_d.sin * phi_d.sin, z = theta_d.cos;
  *wi = from_half(x, y, z);
  *wo = from_half(-x, -y, z);
  return true;
}

bool DirectionReader::Directions(const Coordinates& at, Vec3* wi, Vec3* wo) {
  if (Has(Coordinate::kThetaH)) {
    if (!FromHalf(at, wi, wo)) return false;
  } else if (Has(Coordinate::kWiX)) {
    const auto* in = &at[static_cast<std::size_t>(Coordinate::kWiX)];
    const double length_i = std::hypot(in[0], in[1], in[2]), length_o = std::hypot(in[3], in[4], in[5]);
    if (!(length_i > 0) || !(length_o > 0)) return false;
    *wi = {in[0] / length_i, in[1] / length_i, in[2] / length_i};
    *wo = {in[3] / length_o, in[4] / length_o, in[5] / length_o};
  } else if (!FromAngles(at, wi, wo)) {
    return false;
  }
  if (propagation_) *wi = {-wi->x, -wi->y, std::fabs(wi->z)};
  if (Has(Coordinate::kSampleRotation)) {
    const Angle& turn = Of(Coordinate::kSampleRotation, at);
    *wi = Turned(*wi, turn.cos, -turn.sin);
    *wo = Turned(*wo, turn.cos, -turn.sin);
  }
  return IsFinite(*wi) && IsFinite(*wo);
}

}  // namespace lobefit
