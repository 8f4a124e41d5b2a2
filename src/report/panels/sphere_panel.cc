// A sphere of the material under one light and under a sky, measured beside fitted: isotropic measurements that are
// dense enough.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>

#include "lobefit/base/process/parallel.h"
#include "lobefit/core/ndf/slope_ndf.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/panels/isotropic_lookup.h"
#include "lobefit/report/panels/panel.h"
#include "lobefit/report/panels/sphere.h"

namespace lobefit {
namespace {

constexpr int kLightSize = 220, kSkySize = 104;
// A third from the lobe, a third by the cosine, a third from the glow of the sun; a table is slower to ask than the
// model. With fewer, or without those from the glow, the sky on a rough surface is blotched.
constexpr int kSkySamples = 75, kSkySamplesOfAModel = 240;
constexpr double kGlow = 24;          // sharpness of the glow around the sun
constexpr double kLeastCover = 0.97;  // of the lit sphere that the samples must speak for

using Color = std::array<double, 3>;
using Brdf = ShownBrdf;

struct Frame {
  Vec3 x, y, n;
  Vec3 ToLocal(const Vec3& w) const { return {Dot(w, x), Dot(w, y), Dot(w, n)}; }
  Vec3 ToWorld(const Vec3& w) const { return w.x * x + w.y * y + w.z * n; }
};

// World: x right, y up, z to the viewer. The tangent runs around the vertical axis.
bool SphereFrame(int column, int row, int size, Frame* frame) {
  double x = (column + 0.5) / size * 2 - 1, y = 1 - (row + 0.5) / size * 2;
  const double r = std::hypot(x, y);
  // A rim of two pixels outside is drawn like the edge, for the interpolation when the picture is enlarged.
  if (r >= 1 + 4.0 / size) return false;
  const double most = 1 - 0.5 / size;
  if (r > most) x *= most / r, y *= most / r;
  const double r2 = x * x + y * y;
  frame->n = {x, y, std::sqrt(1 - r2)};
  const Vec3 up = {0, 1, 0};
  frame->x = Normalized(Cross(up, frame->n));
  frame->y = Cross(frame->n, frame->x);
  return true;
}

using Sphere = LitSphere;

void Light(const LitRow& lit, std::size_t i, const Color& f_r, Sphere* sphere) {
  for (std::size_t k = 0; k < 3; ++k) sphere->color[lit.pixel[i]][k] = f_r[k] * lit.d[2][i] * kPi;
}

void FindLit(int row, int size, LitRow* lit) {
  const Vec3 light = SphereLight(), view = {0, 0, 1};
  lit->pixel.clear();
  for (std::vector<double>& component : lit->d) component.clear();
  for (int column = 0; column < size; ++column) {
    Frame frame;
    if (!SphereFrame(column, row, size, &frame)) continue;
    const Vec3 wi = frame.ToLocal(light), wo = frame.ToLocal(view);
    if (wi.z <= 0 || wo.z <= 0) continue;
    lit->pixel.push_back(PixelIndex(column, row, size));
    const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t j = 0; j < 6; ++j) lit->d[j].push_back(all[j]);
  }
}

Sphere Unlit(int size) {
  const std::size_t pixels = PixelIndex(0, size, size);
  return {size, std::vector<Color>(pixels, Color{0, 0, 0}), std::vector<std::uint8_t>(pixels, 1)};
}

Vec3 Sun() { return Normalized(Vec3{-0.45, 0.6, 0.75}); }

// Radiance of the sky: bright horizon, blue zenith, dark ground, a broad glow around the sun.
Color Sky(const Vec3& w, bool grey) {
  const double up = w.y, t = std::clamp(up, 0.0, 1.0), blend = 1 / (1 + std::exp(-up * 24));
  const double glow = 5 * std::exp(kGlow * (Dot(w, Sun()) - 1));
  const Color zenith = {0.30, 0.50, 0.95}, horizon = {1.0, 0.97, 0.92}, ground = {0.16, 0.14, 0.12};
  Color color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double above = horizon[k] + (zenith[k] - horizon[k]) * std::sqrt(t);
    color[k] = ground[k] + (above - ground[k]) * blend + glow * (k == 2 ? 0.85 : 1.0);
  }
  if (grey) color.fill(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]);
  return color;
}

// One point set for all pixels: the sky is smooth, and both spheres see the same directions.
Vec2 Point2(int i, int count) { return {(i + 0.5) / (count / 3.0), std::fmod(0.5 + 0.6180339887498949 * i, 1.0)}; }

bool IsCovered(const Sphere& sphere) {
  const auto known = static_cast<double>(std::count(sphere.known.begin(), sphere.known.end(), 1));
  return known >= kLeastCover * static_cast<double>(sphere.known.size());
}

bool HasHoles(const Sphere& sphere) { return std::count(sphere.known.begin(), sphere.known.end(), 0) > 0; }

struct Spheres {
  std::array<Sphere, 4> sphere;  // measured and fitted under the light, under the sky
  std::array<double, 2> exposure;
  bool measured = false;  // else only the fitted ones
  bool sky = false;       // measured under the sky too
};

cv::Mat Rendered(const Sphere& sphere, double exposure) {
  cv::Mat picture(sphere.size, sphere.size, CV_8UC4);
  for (int row = 0; row < sphere.size; ++row) {
    for (int column = 0; column < sphere.size; ++column) {
      const std::size_t i = PixelIndex(column, row, sphere.size);
      const Rgb c = sphere.known[i] != 0 ? ToScreen(sphere.color[i], exposure) : style::kRule;
      picture.at<cv::Vec4b>(row, column) = {c.r, c.g, c.b, 255};
    }
  }
  return picture;
}

constexpr double kGap = 14, kGroupGap = 34;

// Four spheres side by side, or the two fitted ones in a narrow panel.
double Side(const Spheres& spheres, double width) {
  return std::min(260.0, spheres.measured ? (width - 2 * kGap - kGroupGap) / 4 : (width - kGap) / 2);
}

void Draw(const Spheres& spheres, Canvas* canvas, const Box& content) {
  const double size = Side(spheres, content.width), used = spheres.sky        ? 4 * size + 2 * kGap + kGroupGap
                                                           : spheres.measured ? 3 * size + kGap + kGroupGap
                                                                              : 2 * size + kGap;
  double x = content.x + std::max(0.0, (content.width - used) / 2);
  const std::array<const char*, 2> lights = {"one light, upper left", "sky with a low sun"};
  for (std::size_t k = 0; k < 4; ++k) {
    const bool is_fitted = k % 2 == 1;
    if (!is_fitted && !(k == 0 ? spheres.measured : spheres.sky)) continue;
    const Box box = {x, content.y + 42, size, size};
    const cv::Mat picture = Rendered(spheres.sphere[k], spheres.exposure[k / 2]);
    canvas->Image(RoundPicture(picture, static_cast<int>(std::lround(size * canvas->scale()))), box, false);
    canvas->Text({box.center().x, content.y + 34}, is_fitted ? "fitted" : "measured",
                 style::Body(style::kInk, Align::kCenter));
    const bool pair = k < 2 ? spheres.measured : spheres.sky;
    if (!is_fitted || !pair) {
      const double middle = pair ? x + size + kGap / 2 : box.center().x;
      canvas->Text({middle, content.y + 14}, lights[k / 2], style::Note(style::kSecondary, Align::kCenter));
    }
    x += size + (k == 1 && spheres.measured ? kGroupGap : kGap);
  }
}

}  // namespace

Vec3 SphereLight() { return Normalized(Vec3{-0.45, 0.6, 0.75}); }

LitSphere LightSphere(const ShownBrdf& brdf, const ChannelColor& to_color, std::size_t channels, int size) {
  LitSphere sphere = Unlit(size);
  LitRow lit;
  std::vector<double> f_r(channels);
  for (int row = 0; row < size; ++row) {
    FindLit(row, size, &lit);
    for (std::size_t i = 0; i < lit.pixel.size(); ++i) {
      if (brdf(lit.wi(i), lit.wo(i), f_r.data())) {
        Light(lit, i, to_color.Linear(f_r.data()), &sphere);
      } else {
        sphere.known[lit.pixel[i]] = 0;
      }
    }
  }
  return sphere;
}

std::vector<LitRow> LitRows(int size) {
  std::vector<LitRow> rows(static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row) FindLit(row, size, &rows[static_cast<std::size_t>(row)]);
  return rows;
}

LitSphere LightFitted(const FittedFunction& fitted, const ChannelColor& to_color, const std::vector<LitRow>& rows) {
  const int size = static_cast<int>(rows.size());
  LitSphere sphere = Unlit(size);
  std::vector<std::vector<double>> f_r;
  std::vector<double> values(fitted.channels());
  for (const LitRow& lit : rows) {
    const std::array<std::vector<double>, 6>& d = lit.d;
    fitted.Evaluate({d[0].data(), d[1].data(), d[2].data(), d[3].data(), d[4].data(), d[5].data(), lit.pixel.size()},
                    &f_r);
    for (std::size_t i = 0; i < lit.pixel.size(); ++i) {
      for (std::size_t c = 0; c < values.size(); ++c) values[c] = f_r[c][i];
      Light(lit, i, to_color.Linear(values.data()), &sphere);
    }
  }
  return sphere;
}

LitSphere SkySphere(const ShownBrdf& brdf, const SlopeCoordinates& coordinates, const ChannelColor& to_color,
                    std::size_t channels, int count, int threads) {
  const SlopeFrame lobe(coordinates);
  const bool grey = channels < 3;
  const Vec3 view = {0, 0, 1};
  const double glow_end = std::exp(-2 * kGlow);
  const std::size_t pixels = PixelIndex(0, kSkySize, kSkySize);
  LitSphere sphere = {kSkySize, std::vector<Color>(pixels, Color{0, 0, 0}), std::vector<std::uint8_t>(pixels, 1)};
  ParallelFor(kSkySize, threads, [&](std::size_t row) {
    std::vector<double> f_r(channels);
    for (int column = 0; column < kSkySize; ++column) {
      Frame frame;
      if (!SphereFrame(column, static_cast<int>(row), kSkySize, &frame)) continue;
      const Vec3 wo = frame.ToLocal(view), sun = frame.ToLocal(Sun());
      const Vec3 sun_x = Normalized(Cross(std::fabs(sun.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}, sun)),
                 sun_y = Cross(sun, sun_x);
      const std::size_t pixel = row * kSkySize + static_cast<std::size_t>(column);
      Color sum = {0, 0, 0};
      int unknown = 0, taken = 0;
      for (int i = 0; i < count; ++i) {
        const Vec2 u = Point2(i / 3, count);
        const double phi = 2 * kPi * u.y;
        Vec3 wi;
        if (i % 3 == 0) {
          const double rho = std::sqrt(u.x / (1 - u.x));
          const double sx = lobe.slope_x + lobe.a * rho * std::cos(phi),
                       sy = lobe.slope_y + lobe.b * rho * std::cos(phi) + lobe.c * rho * std::sin(phi);
          wi = Reflect(wo, Normalized(Vec3{-sx, -sy, 1.0}));
        } else if (i % 3 == 1) {
          const double r = std::sqrt(u.x);
          wi = {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x)};
        } else {
          // By exp(kGlow (cos - 1)) around the sun.
          const double cosine = 1 + std::log(1 - u.x * (1 - glow_end)) / kGlow, sine = std::sqrt(1 - cosine * cosine);
          wi = cosine * sun + sine * (std::cos(phi) * sun_x + std::sin(phi) * sun_y);
        }
        if (wi.z <= 0.001) continue;
        const Vec3 h = HalfVector(wi, wo);
        const double density = (SlopeD(lobe, h) * h.z / (4 * std::max(1e-9, Dot(wo, h))) + wi.z * kInvPi +
                                kGlow / (2 * kPi * (1 - glow_end)) * std::exp(kGlow * (Dot(wi, sun) - 1))) *
                               (count / 3.0);
        ++taken;
        if (!brdf(wi, wo, f_r.data())) {
          ++unknown;
          continue;
        }
        const Color f = to_color.Linear(f_r.data()), radiance = Sky(frame.ToWorld(wi), grey);
        for (std::size_t k = 0; k < 3; ++k) sum[k] += f[k] * radiance[k] * wi.z / density;
      }
      sphere.color[pixel] = sum;
      sphere.known[pixel] = 4 * unknown <= taken ? 1 : 0;
    }
  });
  return sphere;
}

std::optional<LitSphere> LightMeasured(const Measurement& measurement, const ChannelColor& to_color, int size) {
  if (!measurement.isotropic) return std::nullopt;
  const IsotropicLookup lookup(measurement);
  LitSphere sphere =
      LightSphere([&lookup](const Vec3& wi, const Vec3& wo, double* f_r) { return lookup.Find(wi, wo, f_r); }, to_color,
                  measurement.channels.size(), size);
  if (!IsCovered(sphere)) return std::nullopt;
  return sphere;
}

double SphereExposure(const LitSphere& sphere) {
  std::vector<double> brightest;
  for (const Color& c : sphere.color) {
    const double v = std::max({c[0], c[1], c[2]});
    if (v > 0) brightest.push_back(v);
  }
  if (brightest.empty()) return 1;
  // Highlights may saturate, but not so far that the rest is black.
  std::vector<double> copy = brightest;
  const double high = Quantile(&brightest, 0.97), middle = Quantile(&copy, 0.5);
  return std::min(0.8 / std::max(high, 1e-9), 0.5 / std::max(middle, 1e-9)) * 1.15;
}

std::optional<Panel> SpherePanel(const ReportData& data) {
  if (data.material.model.lobes.empty()) return std::nullopt;
  const ChannelColor to_color(data.measurement.channels);
  const Brdf fitted = [&data](const Vec3& wi, const Vec3& wo, double* f_r) {
    data.fitted.Evaluate(wi, wo, f_r);
    return true;
  };
  const SlopeCoordinates& lobe = data.fitted.lobe_shapes()[0];
  const auto spheres = std::make_shared<Spheres>();
  if (data.measurement.isotropic) {
    const IsotropicLookup lookup(data.measurement);
    const Brdf measured = [&lookup](const Vec3& wi, const Vec3& wo, double* f_r) { return lookup.Find(wi, wo, f_r); };
    spheres->sphere[0] = LightSphere(measured, to_color, data.channels(), kLightSize);
    spheres->measured = IsCovered(spheres->sphere[0]);
    if (spheres->measured)
      spheres->sphere[2] = SkySphere(measured, lobe, to_color, data.channels(), kSkySamples, data.threads);
    // A narrow lobe in a sparse table leaves holes and rings under the sky: that is no measured appearance.
    spheres->sky = spheres->measured && IsCovered(spheres->sphere[2]);
  }
  spheres->sphere[1] = LightFitted(data.fitted, to_color, LitRows(kLightSize));
  spheres->sphere[3] = SkySphere(fitted, lobe, to_color, data.channels(),
                                 spheres->sky ? kSkySamples : kSkySamplesOfAModel, data.threads);
  // One exposure for a pair: the measured sphere sets it.
  spheres->exposure = {SphereExposure(spheres->sphere[spheres->measured ? 0 : 1]),
                       SphereExposure(spheres->sphere[spheres->sky ? 2 : 3])};
  Panel panel;
  panel.id = "sphere";
  panel.title = "As it looks";
  panel.wide = spheres->measured;
  if (spheres->measured && (HasHoles(spheres->sphere[0]) || (spheres->sky && HasHoles(spheres->sphere[2]))))
    panel.legend = {{LegendEntry::Mark::kNone, {}, "grey: no sample near"}};
  panel.height = [spheres](Canvas*, double width) { return 42 + Side(*spheres, width) + 8; };
  panel.draw = [spheres](Canvas* canvas, const Box& content) { Draw(*spheres, canvas, content); };
  return panel;
}

}  // namespace lobefit
