// Spheres under one light from the upper left, as report and page draw them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "lobefit/report/color.h"
#include "lobefit/report/report_data.h"

namespace lobefit {

// Row-major linear colours of size x size pixels, first row at the top; known[i] == 0 where the measurement says
// nothing.
struct LitSphere {
  int size = 0;
  std::vector<std::array<double, 3>> color;
  std::vector<std::uint8_t> known;
};

// f_r of one pair of directions; false where it is not known.
using BrdfFunction = std::function<bool(const Vec3& wi, const Vec3& wo, double* f_r)>;

LitSphere LightSphere(const BrdfFunction& brdf, const ChannelColor& to_color, std::size_t channels, int size);
LitSphere LightFitted(const ReportData& data, const ChannelColor& to_color, int size);

// Factor before ToScreen: highlights may saturate, but not so far that the rest is black.
double SphereExposure(const LitSphere& sphere);

}  // namespace lobefit
