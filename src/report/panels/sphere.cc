#include "lobefit/report/panels/sphere.h"

#include <algorithm>
#include <cmath>

#include "lobefit/math/directions.h"
#include "lobefit/report/figures/field_image.h"
#include "lobefit/report/figures/report_data.h"
#include "lobefit/report/panels/sphere_frame.h"

namespace lobefit {
namespace {

constexpr double kLeastCover = 0.97;  // of the lit sphere that the samples must speak for

void FindLit(int row, int size, LitRow* lit) {
  const Vec3 light = SphereLight(), view = {0, 0, 1};
  lit->pixel.clear();
  for (std::vector<double>& component : lit->d) component.clear();
  for (int column = 0; column < size; ++column) {
    PointFrame frame;
    if (!FrameOfPixel(column, row, size, &frame)) continue;
    const Vec3 wi = frame.ToLocal(light), wo = frame.ToLocal(view);
    if (wi.z <= 0 || wo.z <= 0) continue;
    lit->pixel.push_back(PixelIndex(column, row, size));
    const double all[] = {wi.x, wi.y, wi.z, wo.x, wo.y, wo.z};
    for (std::size_t j = 0; j < 6; ++j) lit->d[j].push_back(all[j]);
  }
}

// Whether f_r is linear, but for a constant, in the parameters that differ between channels.
bool IsLinearInChannels(const Model& model) {
  const auto linear = [](const Lobe& lobe) {
    return lobe.fresnel == Fresnel::kSchlick || lobe.fresnel == Fresnel::kCurve || lobe.fresnel == Fresnel::kNone;
  };
  return std::all_of(model.lobes.begin(), model.lobes.end(), linear) && !IsDirectional(model.diffuse);
}

}  // namespace

ColoredFit InColors(const Material& material, const ChannelColor& to_color) {
  const std::size_t channels = material.channels.size();
  std::array<double, 3> sums = {0, 0, 0};
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t k = 0; k < 3; ++k) sums[k] += to_color.OfChannel(c)[k];
  }
  const bool has_means = *std::min_element(sums.begin(), sums.end()) > 0;
  if (channels <= 3 || material.sel || !has_means || !IsLinearInChannels(material.model))
    return {FittedFunction(material), to_color};
  Material colored = material;
  colored.channels = {"R", "G", "B"};
  const std::vector<Parameter> parameters = Parameters(material.model);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].per_channel) continue;
    std::vector<double>& means = colored.parameters[i].values;
    means.assign(3, 0.0);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < 3; ++k)
        means[k] += to_color.OfChannel(c)[k] / sums[k] * material.parameters[i].values[c];
    }
  }
  return {FittedFunction(colored),
          ChannelColor(std::vector<std::array<double, 3>>{{sums[0], 0, 0}, {0, sums[1], 0}, {0, 0, sums[2]}})};
}

ShownBrdf Shown(const FittedFunction& fitted) {
  return [&fitted](const DirectionArrays& directions, std::vector<std::vector<double>>* f_r,
                   std::vector<std::uint8_t>* known) {
    fitted.Evaluate(directions, f_r);
    known->assign(directions.count, 1);
  };
}

ShownBrdf Shown(const IsotropicLookup& lookup, std::size_t channels) {
  return [&lookup, channels](const DirectionArrays& d, std::vector<std::vector<double>>* f_r,
                             std::vector<std::uint8_t>* known) {
    f_r->assign(channels, std::vector<double>(d.count));
    known->assign(d.count, 0);
    std::vector<double> values(channels);
    for (std::size_t i = 0; i < d.count; ++i) {
      if (!lookup.Find({d.wi_x[i], d.wi_y[i], d.wi_z[i]}, {d.wo_x[i], d.wo_y[i], d.wo_z[i]}, values.data())) continue;
      (*known)[i] = 1;
      for (std::size_t c = 0; c < channels; ++c) (*f_r)[c][i] = values[c];
    }
  };
}

bool FrameOfPixel(int column, int row, int size, PointFrame* frame) {
  double x = (column + 0.5) / size * 2 - 1, y = 1 - (row + 0.5) / size * 2;
  const double r = std::hypot(x, y);
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

Vec3 SphereLight() { return Normalized(Vec3{-0.45, 0.6, 0.75}); }

LitSphere DarkSphere(int size) {
  const std::size_t pixels = PixelIndex(0, size, size);
  return {size, std::vector<std::array<double, 3>>(pixels, {0, 0, 0}), std::vector<std::uint8_t>(pixels, 1)};
}

std::vector<LitRow> LitRows(int size) {
  std::vector<LitRow> rows(static_cast<std::size_t>(size));
  for (int row = 0; row < size; ++row) FindLit(row, size, &rows[static_cast<std::size_t>(row)]);
  return rows;
}

LitSphere LightSphere(const ShownBrdf& brdf, const ChannelColor& to_color, std::size_t channels,
                      const std::vector<LitRow>& rows) {
  LitSphere sphere = DarkSphere(static_cast<int>(rows.size()));
  std::vector<std::vector<double>> f_r;
  std::vector<std::uint8_t> known;
  std::vector<double> values(channels);
  for (const LitRow& lit : rows) {
    brdf(lit.arrays(), &f_r, &known);
    for (std::size_t i = 0; i < lit.pixel.size(); ++i) {
      sphere.known[lit.pixel[i]] = known[i];
      if (known[i] == 0) continue;
      for (std::size_t c = 0; c < channels; ++c) values[c] = f_r[c][i];
      const std::array<double, 3> color = to_color.Linear(values.data());
      for (std::size_t k = 0; k < 3; ++k) sphere.color[lit.pixel[i]][k] = color[k] * lit.d[2][i] * kPi;
    }
  }
  return sphere;
}

bool IsCovered(const LitSphere& sphere) {
  const auto known = static_cast<double>(std::count(sphere.known.begin(), sphere.known.end(), 1));
  return known >= kLeastCover * static_cast<double>(sphere.known.size());
}

std::optional<LitSphere> LightMeasured(const Measurement& measurement, const ChannelColor& to_color, int size) {
  if (!measurement.isotropic) return std::nullopt;
  const IsotropicLookup lookup(measurement);
  const std::size_t channels = measurement.channels.size();
  LitSphere sphere = LightSphere(Shown(lookup, channels), to_color, channels, LitRows(size));
  if (!IsCovered(sphere)) return std::nullopt;
  return sphere;
}

double SphereExposure(const LitSphere& sphere) {
  std::vector<double> brightest;
  for (const std::array<double, 3>& c : sphere.color) {
    const double v = std::max({c[0], c[1], c[2]});
    if (v > 0) brightest.push_back(v);
  }
  if (brightest.empty()) return 1;
  // Highlights may saturate, but not so far that the rest is black.
  std::vector<double> copy = brightest;
  const double high = Quantile(&brightest, 0.97), middle = Quantile(&copy, 0.5);
  return std::min(0.8 / std::max(high, 1e-9), 0.5 / std::max(middle, 1e-9)) * 1.15;
}

}  // namespace lobefit
