// A sphere under an analytic sky: one set of directions of light for all pixels.
#include <algorithm>
#include <array>
#include <cmath>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/ndf/slope_ndf.h"
#include "lobefit/math/directions.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/panels/sphere.h"
#include "lobefit/report/panels/sphere_frame.h"

namespace lobefit {
namespace {

constexpr int kSkySize = 104;
constexpr double kGlow = 24;       // sharpness of the glow around the sun
constexpr double kLowest = 0.001;  // cosine of light that is taken

using Color = std::array<double, 3>;

Vec3 Sun() { return SphereLight(); }

double GlowAt(const Vec3& w) { return std::exp(kGlow * (Dot(w, Sun()) - 1)); }

// Radiance of the sky: bright horizon, blue zenith, dark ground, a broad glow around the sun.
Color Sky(const Vec3& w, double glow, bool grey) {
  const double up = w.y, t = std::clamp(up, 0.0, 1.0), blend = 1 / (1 + std::exp(-up * 24));
  const Color zenith = {0.30, 0.50, 0.95}, horizon = {1.0, 0.97, 0.92}, ground = {0.16, 0.14, 0.12};
  Color color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double above = horizon[k] + (zenith[k] - horizon[k]) * std::sqrt(t);
    color[k] = ground[k] + (above - ground[k]) * blend + 5 * glow * (k == 2 ? 0.85 : 1.0);
  }
  if (grey) color.fill(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
  return color;
}

// The points of all pixels: the sky is smooth, and spheres that are compared see the same directions.
struct SkyPoints {
  struct Glowing {
    Vec3 world;
    double glow;
    Color radiance;
  };
  std::vector<Vec3> facets;      // of the lobe, in the pixel's frame
  std::vector<Vec3> cosine;      // in the pixel's frame
  std::vector<Glowing> glowing;  // by exp(kGlow (cos - 1)) around the sun

  // `each`: of each kind.
  SkyPoints(const SlopeFrame& lobe, int each, double glow_end, bool grey) {
    const Vec3 sun = Sun(), sun_x = Normalized(Cross(Vec3{0, 0, 1}, sun)), sun_y = Cross(sun, sun_x);
    for (int i = 0; i < each; ++i) {
      const double u = (i + 0.5) / each, phi = 2 * kPi * std::fmod(0.5 + 0.6180339887498949 * i, 1.0);
      const double x = std::cos(phi), y = std::sin(phi);
      const double rho = std::sqrt(u / (1 - u)), r = std::sqrt(u);
      facets.push_back(
          Normalized(Vec3{-lobe.slope_x - lobe.a * rho * x, -lobe.slope_y - rho * (lobe.b * x + lobe.c * y), 1.0}));
      cosine.push_back({r * x, r * y, std::sqrt(1 - u)});
      const double along = 1 + std::log(1 - u * (1 - glow_end)) / kGlow, across = std::sqrt(1 - along * along);
      const Vec3 world = along * sun + across * (x * sun_x + y * sun_y);
      const double glow = GlowAt(world);
      glowing.push_back({world, glow, Sky(world, glow, grey)});
    }
  }
};

// What reaches one pixel.
class Arriving {
 public:
  explicit Arriving(std::size_t most) : weight_(most), radiance_(most) {
    for (std::vector<double>& component : d_) component.resize(most);
  }

  void Clear() { size_ = 0; }
  // `weight`: the cosine of wi over the density of the points there.
  void Add(const Vec3& wi, const Vec3& wo, double weight, const Color& radiance) {
    const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t j = 0; j < 6; ++j) d_[j][size_] = all[j];
    weight_[size_] = weight;
    radiance_[size_++] = radiance;
  }
  std::size_t size() const { return size_; }
  DirectionArrays arrays() const {
    return {d_[0].data(), d_[1].data(), d_[2].data(), d_[3].data(), d_[4].data(), d_[5].data(), size_};
  }
  // What a channel sends on under each of the sky's red, green and blue; where known[i] == 0, nothing.
  Color Sum(const std::vector<double>& f_r, const std::vector<std::uint8_t>& known) const {
    Color sum = {0, 0, 0};
    for (std::size_t i = 0; i < size_; ++i) {
      if (known[i] == 0) continue;
      const double f = f_r[i] * weight_[i];
      for (std::size_t k = 0; k < 3; ++k) sum[k] += f * radiance_[i][k];
    }
    return sum;
  }

 private:
  std::size_t size_ = 0;
  std::array<std::vector<double>, 6> d_;  // wi.x ... wo.z
  std::vector<double> weight_;
  std::vector<Color> radiance_;
};

}  // namespace

LitSphere SkySphere(const ShownBrdf& brdf, const SlopeCoordinates& coordinates, const ChannelColor& to_color,
                    std::size_t channels, int count, int threads) {
  const SlopeFrame lobe(coordinates);
  const bool grey = channels < 3;
  const double glow_end = std::exp(-2 * kGlow), glow_density = kGlow / (2 * kPi * (1 - glow_end));
  const int each = count / 3;
  const SkyPoints points(lobe, each, glow_end, grey);
  LitSphere sphere = DarkSphere(kSkySize);
  ParallelFor(kSkySize, threads, [&](std::size_t row) {
    std::vector<std::vector<double>> f_r;
    std::vector<std::uint8_t> known;
    Arriving arriving(static_cast<std::size_t>(3 * each));
    for (int column = 0; column < kSkySize; ++column) {
      PointFrame frame;
      if (!FrameOfPixel(column, static_cast<int>(row), kSkySize, &frame)) continue;
      const Vec3 wo = frame.ToLocal({0, 0, 1});
      arriving.Clear();
      const auto add = [&](const Vec3& wi, double glow, const Color& radiance) {
        // D(h) h.z / (4 wo.h) of the lobe by the unnormalised half vector (slope_ndf.h).
        const Vec3 sum = wi + wo;
        const double y1 = (-sum.x - sum.z * lobe.slope_x) / lobe.a,
                     y2 = (-sum.y - sum.z * lobe.slope_y - lobe.b * y1) / lobe.c;
        const double t = sum.z * sum.z + y1 * y1 + y2 * y2;
        const double of_lobe = Dot(sum, sum) * sum.z / (2 * kPi * lobe.a * lobe.c * t * t);
        arriving.Add(wi, wo, wi.z / ((of_lobe + wi.z * kInvPi + glow_density * glow) * each), radiance);
      };
      const auto add_local = [&](const Vec3& wi) {
        if (wi.z <= kLowest) return;
        const Vec3 world = frame.ToWorld(wi);
        const double glow = GlowAt(world);
        add(wi, glow, Sky(world, glow, grey));
      };
      for (const Vec3& facet : points.facets) add_local(Reflect(wo, facet));
      for (const Vec3& wi : points.cosine) add_local(wi);
      for (const SkyPoints::Glowing& point : points.glowing) {
        const Vec3 wi = frame.ToLocal(point.world);
        if (wi.z > kLowest) add(wi, point.glow, point.radiance);
      }
      brdf(arriving.arrays(), &f_r, &known);
      const std::size_t pixel = PixelIndex(column, static_cast<int>(row), kSkySize);
      // A channel at a time: its colour weighs the sum of what all directions send on.
      for (std::size_t c = 0; c < channels; ++c) {
        const Color sum = arriving.Sum(f_r[c], known), of_channel = to_color.OfChannel(c);
        for (std::size_t k = 0; k < 3; ++k) sphere.color[pixel][k] += of_channel[k] * sum[k];
      }
      const auto unknown = static_cast<std::size_t>(std::count(known.begin(), known.end(), 0));
      sphere.known[pixel] = 4 * unknown <= arriving.size() ? 1 : 0;
    }
  });
  return sphere;
}

}  // namespace lobefit
