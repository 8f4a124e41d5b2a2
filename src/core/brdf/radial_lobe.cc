#include "lobefit/core/brdf/radial_lobe.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lobefit {
namespace {

// Uniform over the samples.
struct Ellipse {
  double slope_x, slope_y, a, b, c, inv_a, inv_c, quarter_inv_pi_det;
};

// X = over / under of one direction, max(sigma, cos) where clamped, and what its derivatives need.
struct Area {
  double over, under;
  bool cut;
  double by_c, by_q;  // d ln sigma / dc, 2 d ln sigma / dq
  double q1, q2, root;
  double* by_profile;  // sigma's derivatives are root / sigma times these
};

// The operations and their order are those of ggx_lobe-inl.h.
Area AreaOf(const Ellipse& p, const ProfileMasking& profile, double ux, double uy, double uz, bool clamp, bool gradient,
            double* scratch) {
  Area area = {};
  const double cu = uz - p.slope_x * ux - p.slope_y * uy;
  area.q1 = p.a * ux + p.b * uy;
  area.q2 = p.c * uy;
  const double q = area.q1 * area.q1 + area.q2 * area.q2, s = std::sqrt(cu * cu + q);
  const double t = cu < 0.0 ? s - cu : s + cu;
  area.over = cu < 0.0 ? q : t;
  area.under = cu < 0.0 ? t + t : 2.0;
  area.root = std::sqrt(q);
  const double a = std::abs(cu) / area.root;  // infinite where u is the normal: no difference
  double slope = 0;
  profile.Difference(a, gradient ? &slope : nullptr, scratch);
  const double difference = scratch[0];
  area.over += area.under * (area.root * difference);
  area.cut = clamp && area.over - uz * area.under < 0.0;
  if (gradient && !area.cut) {
    // sigma = (c + s) / 2 + root difference(a): by c and, twice, by q.
    const double inverse = area.under / area.over;
    const double ggx = cu < 0.0 ? q / t : t;  // c + s
    area.by_c = inverse * (0.5 * ggx / s + (cu < 0.0 ? -slope : slope));
    area.by_q = inverse * (0.5 / s + (area.root > 0.0 ? (difference - a * slope) / area.root : 0.0));
    area.by_profile = scratch + 1;
  }
  if (area.cut) {
    area.over = uz;
    area.under = 1.0;
  }
  return area;
}

// Adds factor * d ln X to the gradient of ln specular.
void AddArea(const Ellipse& p, const Area& area, double ux, double uy, double factor, std::size_t size,
             double* gradient) {
  if (area.cut) return;
  const double f = factor * area.by_c, g = factor * area.by_q;
  gradient[0] -= f * ux;
  gradient[1] -= f * uy;
  gradient[2] += g * area.q1 * p.a * ux;
  gradient[3] += g * area.q1 * uy;
  gradient[4] += g * area.q2 * area.q2;
  const double by_profile = factor * area.root * area.under / area.over;
  for (std::size_t k = 0; k < size; ++k) gradient[5 + k] += by_profile * area.by_profile[k];
}

}  // namespace

void RadialLobe(const DirectionArrays& d, const SlopeCoordinates& shape, const ProfileMasking& profile, Masking masking,
                double* specular, double* cos_d, double* gradient) {
  const double a = std::exp(shape.v[2]), c = std::exp(shape.v[4]);
  const Ellipse p = {shape.v[0], shape.v[1], a, shape.v[3], c, 1 / a, 1 / c, 0.25 * kInvPi / (a * c)};
  const Profile& f = profile.profile();
  const std::size_t size = f.q().size();
  const double scale = 1.0 / (1.0 + f.mass_excess());
  const bool clamp = masking != Masking::kSmithUnclamped, height = masking == Masking::kSmithHeight;
  std::vector<double> scratch_i(profile.stride()), scratch_o(profile.stride()), dlog(5 + size);
  for (std::size_t i = 0; i < d.count; ++i) {
    const double ix = d.wi_x[i], iy = d.wi_y[i], iz = d.wi_z[i], ox = d.wo_x[i], oy = d.wo_y[i], oz = d.wo_z[i];
    const double hx = ix + ox, hy = iy + oy, hz = iz + oz, h2 = hx * hx + hy * hy + hz * hz;
    cos_d[i] = 0.5 * std::sqrt(h2);
    const double y1 = (0.0 - hx - p.slope_x * hz) * p.inv_a, y2 = (0.0 - hy - p.slope_y * hz - p.b * y1) * p.inv_c;
    const double k = hz * hz + y1 * y1 + y2 * y2;
    const Area in = AreaOf(p, profile, ix, iy, iz, clamp, gradient != nullptr, scratch_i.data());
    const Area out = AreaOf(p, profile, ox, oy, oz, clamp, gradient != nullptr, scratch_o.data());
    double both = in.over * out.over;
    if (height) both = in.over * out.under * oz + (out.over - oz * out.under) * in.under * iz;
    const double inverse = 1.0 / (k * k * both);
    const double ggx = p.quarter_inv_pi_det * (h2 * h2) * (in.under * out.under) * inverse;
    const double u = std::log(k / (hz * hz));
    double g = 2;
    specular[i] = ggx * (std::exp(f.Excess(u, &g)) * scale);
    if (gradient == nullptr) continue;
    const double z2 = y2 * p.inv_c, z1 = (y1 - p.b * z2) * p.inv_a, slope = 2.0 * g / k;
    dlog[0] = slope * z1 * hz;
    dlog[1] = slope * z2 * hz;
    dlog[2] = slope * p.a * z1 * y1 - 1.0;
    dlog[3] = slope * z2 * y1;
    dlog[4] = slope * p.c * z2 * y2 - 1.0;
    f.spline().Evaluate(u, dlog.data() + 5);
    for (std::size_t q = 0; q < size; ++q) dlog[5 + q] -= f.dlog_mass()[q];
    AddArea(p, in, ix, iy, height ? -in.over * out.under * oz / both : -1.0, size, dlog.data());
    AddArea(p, out, ox, oy, height ? -out.over * in.under * iz / both : -1.0, size, dlog.data());
    for (std::size_t j = 0; j < 5 + size; ++j) gradient[j * d.count + i] = dlog[j] * specular[i];
  }
}

}  // namespace lobefit
