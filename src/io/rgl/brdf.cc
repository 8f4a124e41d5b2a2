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

// The nodes are float32.
constexpr double kSameAngle = 1e-4;

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
  light_z_.reserve(tables_.slices() * tables_.nodes());
  for (std::size_t slice = 0; slice < tables_.slices(); ++slice) {
    // Of many files the last polar angle is the horizon.
    const double viewer_z = std::cos(static_cast<double>(tables_.theta[slice % tables_.theta.size()]));
    for (std::size_t node = 0; node < tables_.nodes(); ++node) {
      const std::size_t width = tables_.spectra.width();
      const double z = LightOf(slice, node % width, node / width).z;
      light_z_.push_back(viewer_z > kRglHorizon && z > kRglHorizon ? static_cast<float>(z) : 0.0F);
    }
  }
}

RglBrdf::Place RglBrdf::Find(const Vec3& wi, const Vec3& wo) const {
  Place place = {};
  place.wi = wi;
  place.wo = wo;
  Vec3 &s = place.wi, &t = place.wo;
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
  place.u = {RglX(PolarAngle(m)), RglY(Azimuth(m) - (isotropic() ? phi_t : 0.0))};
  place.u.y -= std::floor(place.u.y);

  const Interval phi = Locate(tables_.phi, phi_t), theta = Locate(tables_.theta, theta_t);
  for (const std::size_t p : {0, 1}) {
    for (const std::size_t q : {0, 1}) {
      const double share = (p == 0 ? 1 - phi.fraction : phi.fraction) * (q == 0 ? 1 - theta.fraction : theta.fraction);
      if (share == 0) continue;
      place.slices[place.count] = (phi.index + p) * tables_.theta.size() + theta.index + q;
      place.parts[place.count] = {&warps_[place.slices[place.count]], share};
      ++place.count;
    }
  }
  double pdf = 0;
  place.point = BilinearWarp::Invert(std::span(place.parts.data(), place.count), place.u, &pdf);
  return place;
}

void RglBrdf::Evaluate(const Vec3& wi, const Vec3& wo, double* values) const {
  std::fill(values, values + channels_.size(), 0.0);
  if (!(wi.z > 0) || !(wo.z > 0)) return;
  const Place place = Find(wi, wo);
  double factor = 1 / wi.z;
  if (tables_.jacobian) {
    factor *= Bilinear(tables_.ndf.values.data(), tables_.ndf.width(), tables_.ndf.height(), place.u) /
              (4 * Bilinear(tables_.sigma.values.data(), tables_.sigma.width(), tables_.sigma.height(),
                            {RglX(PolarAngle(place.wo)), RglY(Azimuth(place.wo))}));
  }
  const RglGrid& spectra = tables_.spectra;
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    for (std::size_t k = 0; k < place.count; ++k) {
      const float* table = &spectra.values[(place.slices[k] * channels_.size() + c) * tables_.nodes()];
      values[c] += factor * place.parts[k].share * Bilinear(table, spectra.width(), spectra.height(), place.point);
    }
  }
}

Vec3 RglBrdf::LightOf(std::size_t slice, std::size_t column, std::size_t row) const {
  double pdf = 0;
  const Vec2 u = warps_[slice].Sample({static_cast<double>(column) / static_cast<double>(tables_.spectra.width() - 1),
                                       static_cast<double>(row) / static_cast<double>(tables_.spectra.height() - 1)},
                                      &pdf);
  const double theta = static_cast<double>(tables_.theta[slice % tables_.theta.size()]),
               phi = static_cast<double>(tables_.phi[slice / tables_.theta.size()]);
  return Reflect(FromSpherical(theta, phi), FromSpherical(RglTheta(u.x), RglPhi(u.y) + (isotropic() ? phi : 0.0)));
}

bool RglBrdf::Covers(const Vec3& wi, const Vec3& wo) const {
  if (!(wi.z > 0) || !(wo.z > 0)) return false;
  const double theta = PolarAngle(wo), least = static_cast<double>(tables_.theta.front()),
               most = static_cast<double>(tables_.theta.back());
  if (theta < least - kSameAngle || theta > most + kSameAngle) return false;
  const Place place = Find(wi, wo);
  const std::size_t width = tables_.spectra.width(), height = tables_.spectra.height();
  const auto column = std::min(static_cast<std::size_t>(place.point.x * static_cast<double>(width - 1)), width - 2),
             row = std::min(static_cast<std::size_t>(place.point.y * static_cast<double>(height - 1)), height - 2);
  double lowest = 1;
  for (std::size_t k = 0; k < place.count; ++k) {
    for (const std::size_t node :
         {row * width + column, row * width + column + 1, (row + 1) * width + column, (row + 1) * width + column + 1}) {
      lowest = std::min(lowest, static_cast<double>(light_z_[place.slices[k] * tables_.nodes() + node]));
    }
  }
  // A light below all nodes around it would be divided by a smaller cosine than any that was measured.
  return lowest > 0 && wi.z >= lowest;
}

}  // namespace lobefit
