#include "lobefit/io/rgl/brdf.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/io/rgl/angles.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Interval {
  std::size_t index;
  double fraction;
};

// Place of an angle among increasing nodes, clamped at both ends.
Interval Locate(const std::vector<float>& nodes, double angle) {
  if (nodes.size() < 2) return {0, 0};
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), static_cast<float>(angle));
  const std::size_t index =
      std::clamp<std::ptrdiff_t>(above - nodes.begin() - 1, 0, static_cast<std::ptrdiff_t>(nodes.size()) - 2);
  const double low = static_cast<double>(nodes[index]), high = static_cast<double>(nodes[index + 1]);
  return {index, std::clamp((angle - low) / (high - low), 0.0, 1.0)};
}

}  // namespace

RglBrdf::RglBrdf(const std::filesystem::path& path, std::string_view bytes) {
  const TensorFile file(path, bytes);
  tables_ = ReadRglTables(file);
  channels_ = RglChannels(tables_);
  reduction_ = RglReduction(file, tables_);
  const std::size_t size = tables_.vndf.width() * tables_.vndf.height();
  for (std::size_t slice = 0; slice < tables_.slices(); ++slice) {
    warps_.emplace_back(&tables_.vndf.values[slice * size], tables_.vndf.width(), tables_.vndf.height());
  }
}

void RglBrdf::Evaluate(const Vec3& wi, const Vec3& wo, double* values) const {
  std::fill(values, values + channels_.size(), 0.0);
  if (!(wi.z > 0) || !(wo.z > 0)) return;
  Vec3 s = wi, t = wo;
  const bool flip_y = reduction_ > 1 && t.y > 0;
  const bool flip_x = reduction_ == 2 ? flip_y : reduction_ == 4 && t.x > 0;
  if (flip_x) {
    s.x = -s.x;
    t.x = -t.x;
  }
  if (flip_y) {
    s.y = -s.y;
    t.y = -t.y;
  }
  const Vec3 m = HalfVector(s, t);
  const double theta_t = PolarAngle(t), phi_t = Azimuth(t);
  Vec2 u = {RglX(PolarAngle(m)), RglY(Azimuth(m) - (isotropic() ? phi_t : 0.0))};
  u.y -= std::floor(u.y);

  const Interval phi = Locate(tables_.phi, phi_t), theta = Locate(tables_.theta, theta_t);
  std::array<BilinearWarp::Part, 4> parts;
  std::array<std::size_t, 4> slices;
  std::size_t count = 0;
  for (const std::size_t p : {0, 1}) {
    for (const std::size_t q : {0, 1}) {
      const double share = (p == 0 ? 1 - phi.fraction : phi.fraction) * (q == 0 ? 1 - theta.fraction : theta.fraction);
      if (share == 0) continue;
      slices[count] = (phi.index + p) * tables_.theta.size() + theta.index + q;
      parts[count] = {&warps_[slices[count]], share};
      ++count;
    }
  }
  double pdf = 0;
  const Vec2 point = BilinearWarp::Invert(std::span(parts.data(), count), u, &pdf);
  double factor = 1 / s.z;
  if (tables_.jacobian) {
    factor *= Bilinear(tables_.ndf.values.data(), tables_.ndf.width(), tables_.ndf.height(), u) /
              (4 * Bilinear(tables_.sigma.values.data(), tables_.sigma.width(), tables_.sigma.height(),
                            {RglX(theta_t), RglY(phi_t)}));
  }
  const RglGrid& spectra = tables_.spectra;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (std::size_t k = 0; k < count; ++k) {
      const float* table = &spectra.values[(slices[k] * channels_.size() + c) * tables_.nodes()];
      values[c] += factor * parts[k].share * Bilinear(table, spectra.width(), spectra.height(), point);
    }
  }
}

}  // namespace lobefit
