#include <algorithm>

#include "lobefit/core/brdf/diffuse.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "interfaced_arrays.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::CappedTag<double, 8>;
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Number(double x) { return hn::Set(D64(), x); }

// T(c, n) = 2 c g (1 / s^2 + n^2 / p^2) of DielectricTransmittance with g^2 = n^2 - 1 + c^2, s = c + g, p = n^2 c + g,
// and d ln T / dn; dg/dn = n / g.
struct Transmittance {
  V64 value, dlog;
};
HWY_INLINE Transmittance TransmittanceOf(V64 c, V64 n) {
  const V64 one = Number(1), two = Number(2), nn = n * n;
  const V64 g = hn::Sqrt((n - one) * (n + one) + c * c), s = c + g, p = nn * c + g;
  const V64 is = one / s, ip = one / p, ig = one / g, dg = n * ig;
  const V64 by_s = is * is, by_p = nn * ip * ip, sum = by_s + by_p;
  // d(1 / s^2) = -2 dg / s^3, d(n^2 / p^2) = 2 n / p^2 - 2 n^2 (2 n c + dg) / p^3.
  const V64 dsum = two * n * ip * ip - two * (by_s * is * dg + by_p * ip * (two * n * c + dg));
  return {two * c * g * sum, dg * ig + dsum / sum};
}

// unit = T(cos_i) T(cos_o) scale, by_ior = d ln unit / dn; uniform: n, scale, d ln scale / dn.
void InterfacedArrays(const double* cos_i, const double* cos_o, std::size_t count, const double* uniform, double* unit,
                      double* by_ior) {
  const D64 d;
  const std::size_t lanes = hn::Lanes(d);
  const V64 n = Number(uniform[0]), scale = Number(uniform[1]), dlog_scale = Number(uniform[2]);
  double pad[2][8];
  for (std::size_t i = 0; i < count; i += lanes) {
    const std::size_t size = std::min(lanes, count - i);
    const double *from_i = cos_i + i, *from_o = cos_o + i;
    if (size < lanes) {
      std::fill_n(pad[0], lanes, 1.0);
      std::fill_n(pad[1], lanes, 1.0);
      from_i = std::copy_n(from_i, size, pad[0]) - size;
      from_o = std::copy_n(from_o, size, pad[1]) - size;
    }
    const Transmittance in = TransmittanceOf(hn::LoadU(d, from_i), n), out = TransmittanceOf(hn::LoadU(d, from_o), n);
    const V64 value = in.value * out.value * scale, slope = in.dlog + out.dlog + dlog_scale;
    if (size == lanes) {
      hn::StoreU(value, d, unit + i);
      hn::StoreU(slope, d, by_ior + i);
      continue;
    }
    hn::StoreU(value, d, pad[0]);
    hn::StoreU(slope, d, pad[1]);
    std::copy_n(pad[0], size, unit + i);
    std::copy_n(pad[1], size, by_ior + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
HWY_EXPORT(InterfacedArrays);

void DirectionalDiffuse::EvaluateInterfaced(const double* cos_i, const double* cos_o, std::size_t count, double* unit,
                                            double* by_ior) const {
  const double uniform[3] = {first_, kInvPi / enters_, dF_ex_ / enters_};
  HWY_DYNAMIC_DISPATCH(InterfacedArrays)(cos_i, cos_o, count, uniform, unit, by_ior);
}

}  // namespace lobefit
#endif  // HWY_ONCE
