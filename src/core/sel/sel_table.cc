#include "lobefit/core/sel/sel_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobefit/core/sel/sel.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/rotation.h"

namespace lobefit {
namespace {

// Slices whose polar angles agree to this belong to one ring, and closer to the normal there is no azimuth: 0.05
// degree, the resolution of GroupByIncidence.
constexpr double kSameAngle = 0.05 * kPi / 180;

Vec3 Tilt(const SelShape& shape) { return {shape.offset_across, -shape.offset_in, 0}; }

// The 2x2 logarithm of widths: mean of the logarithms, and half their difference times (cos, sin) of twice psi.
struct LogWidth {
  double mean = 0, p = 0, q = 0;
};

LogWidth LogWidthOf(const SelShape& shape, double turn) {
  const double x = std::log(shape.alpha_x), y = std::log(shape.alpha_y), half = 0.5 * (x - y);
  const double angle = 2 * (shape.psi + turn);
  return {0.5 * (x + y), half * std::cos(angle), half * std::sin(angle)};
}

void SetWidths(const LogWidth& width, SelShape* shape) {
  const double half = std::hypot(width.p, width.q);
  shape->alpha_x = std::min(1.0, std::exp(width.mean + half));
  shape->alpha_y = std::min(shape->alpha_x, std::exp(width.mean - half));
  shape->psi = half > 0 ? 0.5 * std::atan2(width.q, width.p) : 0.0;
}

// Angle in [0, 2 pi).
double Wrapped(double angle) {
  const double wrapped = std::fmod(angle, 2 * kPi);
  return wrapped < 0 ? wrapped + 2 * kPi : wrapped;
}

}  // namespace

const char* NameOf(SelQuantity quantity) { return quantity == SelQuantity::kBrdf ? "f" : "f-cos-o"; }

SelLobeInFrame::SelLobeInFrame(const SelShape& shape)
    : shape_(shape),
      cos_psi_(std::cos(shape.psi)),
      sin_psi_(std::sin(shape.psi)),
      jacobian_transposed_(Transposed(RotationLeftJacobian(Tilt(shape)))) {
  const Mat3 tilt = RotationMatrix(Tilt(shape));
  axes_ = {{{cos_psi_ * tilt.row[0] + sin_psi_ * tilt.row[1], cos_psi_ * tilt.row[1] - sin_psi_ * tilt.row[0],
             tilt.row[2]}}};
}

double SelLobeInFrame::Evaluate(const Vec3& v, double gradient[5]) const {
  const Vec3 w = axes_ * v;
  if (gradient == nullptr) return SelLobe(shape_.alpha_x, shape_.alpha_y, w);
  SelLobeGradient lobe;
  const double k = SelLobe(shape_.alpha_x, shape_.alpha_y, w, &lobe, SelKink::kAlphaXLarger);
  // w = Rz(-psi) u, u = exp([tilt]) v.
  const auto turned = [&](const Vec3& a) {
    return Vec3{cos_psi_ * a.x - sin_psi_ * a.y, sin_psi_ * a.x + cos_psi_ * a.y, a.z};
  };
  const Vec3 by_tilt = jacobian_transposed_ * Cross(turned(w), turned(lobe.dv));
  gradient[0] = lobe.dalpha_x;
  gradient[1] = lobe.dalpha_y;
  gradient[2] = -by_tilt.y;
  gradient[3] = by_tilt.x;
  gradient[4] = lobe.dv.x * w.y - lobe.dv.y * w.x;
  return k;
}

Mat3 MirrorFrame(const Vec3& wi) {
  const double sine = std::hypot(wi.x, wi.y);
  const Vec3 across_plane = sine > 0 ? Vec3{wi.x / sine, wi.y / sine, 0} : Vec3{1, 0, 0};
  // The mirror direction's azimuth is that of -wi.
  const Vec3 z = {-wi.x, -wi.y, wi.z};
  const Vec3 x = {-across_plane.x * wi.z, -across_plane.y * wi.z, -sine};
  return {{{x, Cross(z, x), z}}};
}

SelReflectance::SelReflectance(const SelTable& table) : table_(table) {
  std::vector<std::size_t> order(table_.slices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto less = [&](std::size_t a, std::size_t b) { return table_.slices[a].theta_i < table_.slices[b].theta_i; };
  std::stable_sort(order.begin(), order.end(), less);
  for (const std::size_t s : order) {
    const double theta = table_.slices[s].theta_i;
    if (rings_.empty() || theta - rings_.back().theta > kSameAngle || table_.isotropic)
      rings_.push_back({theta, {}, false});
    rings_.back().slices.push_back(s);
  }
  for (Ring& ring : rings_) {
    std::stable_sort(ring.slices.begin(), ring.slices.end(), [&](std::size_t a, std::size_t b) {
      return Wrapped(table_.slices[a].phi_i) < Wrapped(table_.slices[b].phi_i);
    });
    ring.fixed = !table_.isotropic && ring.slices.size() == 1 && ring.theta < kSameAngle;
  }
}

void SelReflectance::AddShares(const Ring& ring, double phi, double weight, std::vector<Share>* shares) const {
  const auto azimuth = [&](std::size_t k) { return Wrapped(table_.slices[ring.slices[k]].phi_i); };
  const std::size_t count = ring.slices.size();
  if (count == 1) {
    shares->push_back({ring.slices[0], weight, ring.fixed ? table_.slices[ring.slices[0]].phi_i - phi : 0.0});
    return;
  }
  phi = Wrapped(phi);
  std::size_t next = 0;
  while (next < count && azimuth(next) <= phi) ++next;
  const std::size_t after = next % count, before = (next + count - 1) % count;
  const double gap = Wrapped(azimuth(after) - azimuth(before)), along = Wrapped(phi - azimuth(before));
  // Azimuths of a hundred-thousandth of a degree are the slice itself.
  const double share = along < 1e-7 ? 0.0 : gap - along < 1e-7 ? 1.0 : along / gap;
  if (share < 1) shares->push_back({ring.slices[before], weight * (1 - share), 0});
  if (share > 0) shares->push_back({ring.slices[after], weight * share, 0});
}

SelSlice SelReflectance::At(const Vec3& wi) const {
  const double theta = PolarAngle(wi), phi = Azimuth(wi);
  std::vector<Share> shares;
  const auto above = std::lower_bound(rings_.begin(), rings_.end(), theta,
                                      [](const Ring& ring, double angle) { return ring.theta < angle; });
  if (above == rings_.begin()) {
    AddShares(*above, phi, 1, &shares);
  } else if (above == rings_.end()) {
    AddShares(rings_.back(), phi, 1, &shares);
  } else {
    const Ring &low = *(above - 1), &high = *above;
    const double along = theta - low.theta, gap = high.theta - low.theta;
    const double share = along < 1e-7 ? 0.0 : gap - along < 1e-7 ? 1.0 : along / gap;
    if (share < 1) AddShares(low, phi, 1 - share, &shares);
    if (share > 0) AddShares(high, phi, share, &shares);
  }
  if (shares.size() == 1 && shares[0].turn == 0) return table_.slices[shares[0].slice];
  SelSlice slice;
  slice.theta_i = theta;
  slice.phi_i = phi;
  const SelSlice& first = table_.slices[shares[0].slice];
  slice.lobes.resize(first.lobes.size());
  slice.amplitude.assign(first.lobes.size(), std::vector<double>(channels()));
  slice.constant.assign(channels(), 0.0);
  std::vector<LogWidth> widths(first.lobes.size());
  for (SelShape& shape : slice.lobes) shape.offset_in = shape.offset_across = 0;
  for (const Share& share : shares) {
    const SelSlice& from = table_.slices[share.slice];
    const double c = std::cos(share.turn), s = std::sin(share.turn);
    for (std::size_t l = 0; l < slice.lobes.size(); ++l) {
      const LogWidth width = LogWidthOf(from.lobes[l], share.turn);
      widths[l].mean += share.weight * width.mean;
      widths[l].p += share.weight * width.p;
      widths[l].q += share.weight * width.q;
      const double in = from.lobes[l].offset_in, across = from.lobes[l].offset_across;
      slice.lobes[l].offset_in += share.weight * (c * in - s * across);
      slice.lobes[l].offset_across += share.weight * (s * in + c * across);
      for (std::size_t k = 0; k < channels(); ++k) slice.amplitude[l][k] += share.weight * from.amplitude[l][k];
    }
    for (std::size_t k = 0; k < channels(); ++k) slice.constant[k] += share.weight * from.constant[k];
  }
  for (std::size_t l = 0; l < slice.lobes.size(); ++l) SetWidths(widths[l], &slice.lobes[l]);
  return slice;
}

void SelReflectance::Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const {
  std::vector<std::vector<double>> values;
  Evaluate(wi, std::vector<Vec3>{wo}, &values);
  for (std::size_t c = 0; c < values.size(); ++c) f_r[c] = values[c][0];
}

void SelReflectance::Evaluate(const Vec3& wi, const std::vector<Vec3>& wo,
                              std::vector<std::vector<double>>* f_r) const {
  f_r->assign(channels(), std::vector<double>(wo.size()));
  if (!(wi.z > 0)) return;
  const SelSlice slice = At(wi);
  const Mat3 frame = MirrorFrame(wi);
  std::vector<SelLobeInFrame> lobes(slice.lobes.begin(), slice.lobes.end());
  for (std::size_t i = 0; i < wo.size(); ++i) {
    if (!(wo[i].z > 0)) continue;
    const Vec3 v = frame * wo[i];
    for (std::size_t c = 0; c < channels(); ++c) (*f_r)[c][i] = slice.constant[c];
    for (std::size_t l = 0; l < lobes.size(); ++l) {
      const double k = lobes[l].Evaluate(v, nullptr);
      for (std::size_t c = 0; c < channels(); ++c) (*f_r)[c][i] += slice.amplitude[l][c] * k;
    }
    if (table_.quantity == SelQuantity::kBrdf) continue;
    for (std::size_t c = 0; c < channels(); ++c) (*f_r)[c][i] /= wo[i].z;
  }
}

}  // namespace lobefit
