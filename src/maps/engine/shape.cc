#include "lobefit/maps/engine/shape.h"

#include <algorithm>
#include <cmath>

#include "lobefit/maps/engine/kernels.h"

namespace lobefit {
namespace {

// Derivatives of the frame's axes t and b where n moves by dn.
MapFrame FrameDerivative(const Vec3& n, const Vec3& dn) {
  const double q = 1 / (1 + n.z), dq = -q * q * dn.z;
  const double dxy = -(dn.x * n.y * q + n.x * dn.y * q + n.x * n.y * dq);
  return {
      {-(2 * n.x * dn.x * q + n.x * n.x * dq), dxy, -dn.x}, {dxy, -(2 * n.y * dn.y * q + n.y * n.y * dq), -dn.y}, dn};
}

}  // namespace

void ShapeArrays::Resize(std::size_t padded) {
  cosine.resize(padded), specular.resize(padded);
  for (LightVector& d : dcosine) d.resize(padded);
  for (LightVector& d : dspecular) d.resize(padded);
}

void EvaluateShape(MapLobe lobe, const MapPoint& point, const LightArrays& lights, bool gradient, ShapeArrays* out) {
  const MapFrame frame = FrameOf(point.normal);
  double* const dcosine[2] = {out->dcosine[0].data(), out->dcosine[1].data()};
  const bool general = lobe == MapLobe::kEllipsoid || (lobe != MapLobe::kNone && !lights.from_z);
  if (lobe == MapLobe::kGgx && !general) {
    // One width: D and G1 depend on the cosines with the normal alone. With s(c) = sqrt(c^2 + alpha^2 (1 - c^2)) and K
    // = h_z^2 + (|h|^2 - h_z^2) / alpha^2:
    //   specular = |h|^4 i_z / (pi alpha^2 K^2 (i_z + s_i) (o_z + s_o)).
    double* const dspecular[3] = {out->dspecular[0].data(), out->dspecular[1].data(), out->dspecular[2].data()};
    const double alpha = std::exp(point.width[0]);
    double *cosine = out->cosine.data(), *specular = out->specular.data();
    if (gradient) IsotropicGradient(alpha, frame, lights, cosine, specular, dcosine, dspecular);
    if (!gradient) IsotropicValue(alpha, frame.n, lights, cosine, specular);
    return;
  }
  Cosines(frame.n, lights, out->cosine.data());
  const bool turns = lobe != MapLobe::kEllipsoid;
  if (gradient && turns) CosineDerivatives(frame, lights, dcosine[0], dcosine[1]);
  for (LightVector& d : out->dcosine) {
    if (gradient && !turns) std::fill(d.begin(), d.begin() + static_cast<std::ptrdiff_t>(lights.padded), 0.0);
  }
  if (lobe == MapLobe::kNone) return;
  TwoWidths widths = {std::exp(point.width[0]),
                      point.width[1],
                      std::exp(point.width[2]),
                      frame,
                      {FrameDerivative(frame.n, frame.t), FrameDerivative(frame.n, frame.b)}};
  if (lobe == MapLobe::kGgx) widths.b = 0, widths.c = widths.a;
  std::array<double*, kMostShape> dspecular = {};
  for (std::size_t j = 0; j < dspecular.size(); ++j) dspecular[j] = out->dspecular[j].data();
  double** const wanted = gradient ? dspecular.data() : nullptr;
  if (!general) return AnisotropicLobe(widths, lights, out->specular.data(), wanted);
  GeneralLobe(widths, {point.slope[0], point.slope[1], !turns}, lights, out->specular.data(), wanted);
  // One width: ln a and ln c move together.
  for (std::size_t l = 0; gradient && lobe == MapLobe::kGgx && l < lights.padded; ++l)
    dspecular[2][l] += dspecular[4][l];
}

}  // namespace lobefit
