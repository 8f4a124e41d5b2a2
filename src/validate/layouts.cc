#include "lobefit/validate/layouts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/microfacet/vndf.h"
#include "lobefit/fit/instrument.h"
#include "lobefit/io/bsdf_xml/angle_basis.h"
#include "lobefit/io/merl/table.h"
#include "lobefit/io/read.h"
#include "lobefit/io/utia/grid.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

bool IsIsotropic(const Truth& truth) {
  return std::all_of(truth.model.lobes.begin(), truth.model.lobes.end(),
                     [](const Lobe& lobe) { return IsRound(lobe.ndf) && !IsTilted(lobe.ndf); });
}

void RequireIsotropic(const Truth& truth, const std::string& name) {
  if (IsIsotropic(truth)) return;
  throw UsageError(
      fmt::format("layout '{}' has no place for a dependence on azimuth, which this model has; take another layout or "
                  "ndf = \"ggx\"",
                  name));
}

MeasurementLayout OfGoniometer(const LayoutRequest& request, const Truth&) {
  return {Goniometer(request.goniometer), false, request.goniometer.detector_step / 2};
}

MeasurementLayout InPlane(const LayoutRequest& request, const Truth&) {
  GoniometerLayout layout = request.goniometer;
  layout.in_plane = true;
  return {Goniometer(layout), false, layout.detector_step / 2};
}

// The centres of MERL's 90 x 90 x 180 cells.
MeasurementLayout Merl(const LayoutRequest& request, const Truth& truth) {
  RequireIsotropic(truth, request.name);
  MeasurementLayout layout = {{}, true, kPi / 180};
  for (int h = 0; h < 90; ++h) {
    for (int d = 0; d < 90; ++d) {
      for (int p = 0; p < 180; ++p) {
        Vec3 wi, wo;
        FromHalfDifference({MerlThetaH(h + 0.5), 0, DegreesToRadians(d + 0.5), DegreesToRadians(p + 0.5)}, &wi, &wo);
        if (wi.z > 0 && wo.z > 0) layout.directions.Add(wi, wo);
      }
    }
  }
  return layout;
}

MeasurementLayout Utia(const LayoutRequest&, const Truth&) {
  MeasurementLayout layout = {{}, false, DegreesToRadians(7.5)};
  for (std::size_t i = 0; i < kUtiaDirections; ++i) {
    for (std::size_t o = 0; o < kUtiaDirections; ++o)
      layout.directions.Add(kUtiaGrid.Direction(i), kUtiaGrid.Direction(o));
  }
  return layout;
}

MeasurementLayout Klems(const LayoutRequest&, const Truth&) {
  MeasurementLayout layout = {{}, false, DegreesToRadians(10)};
  const std::vector<AngleBasis::Patch> patches = KlemsBases().front().Patches();
  for (const AngleBasis::Patch& i : patches) {
    for (const AngleBasis::Patch& o : patches) {
      layout.directions.Add({-i.direction.x, -i.direction.y, i.direction.z}, o.direction);
    }
  }
  return layout;
}

// Reflections of wi about the visible normals of the first lobe: a grid of `side` x `side` of their distribution's unit
// square, so that samples are as dense as the lobe is high.
void AddVisible(const Ellipsoid& lobe, const Vec3& wi, std::size_t side, double theta_max, DirectionList* list) {
  const EllipsoidVndfSampler sampler(lobe, wi);
  const double n = static_cast<double>(side), horizon = std::cos(theta_max + 1e-9);
  for (std::size_t a = 0; a < side; ++a) {
    for (std::size_t b = 0; b < side; ++b) {
      const Vec3 m = sampler.Sample((static_cast<double>(a) + 0.5) / n, (static_cast<double>(b) + 0.5) / n);
      const Vec3 wo = Reflect(wi, m);
      if (wo.z >= horizon && wo.z > 0) list->Add(wi, wo);
    }
  }
}

MeasurementLayout OfVisibleNormals(const std::vector<double>& polar, const std::vector<double>& azimuths,
                                   const LayoutRequest& request, const Truth& truth) {
  const ParameterValues& v = truth.values;
  const Ellipsoid lobe = {v[0][0], v[1][0], v[2][0], v[3][0], v[4][0]};
  const auto side = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(std::sqrt(request.samples))));
  // Neighbours stand apart by about the lobe's width (twice the smaller alpha) over the grid's side.
  MeasurementLayout layout = {{}, false, 2 * SmallestAlpha(truth) / static_cast<double>(side)};
  for (const double theta : polar) {
    for (const double phi : azimuths)
      AddVisible(lobe, FromSpherical(theta, phi), side, request.goniometer.theta_max, &layout.directions);
  }
  return layout;
}

MeasurementLayout VisibleNormals(const LayoutRequest& request, const Truth& truth) {
  return OfVisibleNormals(request.goniometer.polar_angles, request.goniometer.azimuths, request, truth);
}

// The viewers of an anisotropic RGL file, 16 azimuths x 8 polar angles (1 x 8 for an isotropic material), theta denser
// towards the normal, and samples placed by visible normals, as the instrument's tables are.
MeasurementLayout Rgl(const LayoutRequest& request, const Truth& truth) {
  std::vector<double> polar, azimuths;
  for (int k = 0; k < 8; ++k) polar.push_back(DegreesToRadians(80) * k / 7.0);
  const int count = IsIsotropic(truth) ? 1 : 16;
  for (int k = 0; k < count; ++k) azimuths.push_back(2 * kPi * k / count);
  return OfVisibleNormals(polar, azimuths, request, truth);
}

struct LayoutEntry {
  LayoutChoice choice;
  MeasurementLayout (*make)(const LayoutRequest& request, const Truth& truth);
};

const std::vector<LayoutEntry>& LayoutEntries() {
  static const std::vector<LayoutEntry> entries = {
      {{"goniometer", "given light directions, a detector grid over the hemisphere, finer about the mirror direction"},
       OfGoniometer},
      {{"in-plane", "given light directions, detectors in the plane of incidence"}, InPlane},
      {{"visible-normals", "given light directions, detectors where the lobe's visible normals reflect to"},
       VisibleNormals},
      {{"merl", "the 90 x 90 x 180 cells of a MERL table (isotropic models)"}, Merl},
      {{"rgl", "16 x 8 light directions (8 for isotropic models), detectors by visible normals"}, Rgl},
      {{"utia", "288 x 288 directions of a UTIA file"}, Utia},
      {{"klems", "145 x 145 patch centres of a Klems matrix"}, Klems},
  };
  return entries;
}

MeasurementLayout OfFile(const std::string& path) {
  const Measurement measurement = ReadMeasurement(path, {});
  MeasurementLayout layout = {{}, measurement.isotropic, kPi};
  const Samples& samples = measurement.samples;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    layout.directions.Add(samples.wi(i), samples.wo(i));
    if (i > 0 && Norm(samples.wi(i) - samples.wi(i - 1)) < 1e-6)
      layout.step = std::min(layout.step, Norm(samples.wo(i) - samples.wo(i - 1)));
  }
  return layout;
}

}  // namespace

const std::vector<LayoutChoice>& LayoutChoices() {
  static const std::vector<LayoutChoice> choices = [] {
    std::vector<LayoutChoice> all;
    for (const LayoutEntry& entry : LayoutEntries()) all.push_back(entry.choice);
    return all;
  }();
  return choices;
}

MeasurementLayout MakeLayout(const LayoutRequest& request, const Truth& truth) {
  std::vector<std::string> names;
  for (const LayoutEntry& entry : LayoutEntries()) {
    if (request.name == entry.choice.name) return entry.make(request, truth);
    names.emplace_back(entry.choice.name);
  }
  std::error_code error;
  if (std::filesystem::exists(request.name, error)) return OfFile(request.name);
  throw UsageError(fmt::format("layout '{}' is neither known nor a measurement file{}; allowed: {}, or a file",
                               Excerpt(request.name), DidYouMean(request.name, names), Join(names)));
}

void RequireApertureWithin(const MeasurementLayout& layout, const Noise& noise) {
  const double widest = std::max({noise.aperture, noise.source, noise.across});
  if (!(widest > kMostSteps * layout.step * (1 + 1e-9))) return;
  throw UsageError(fmt::format(
      "a disc of half angle {:.3g} degrees is more than {:g} times the step of the grid, {:.3g} degrees, so that its "
      "samples "
      "would all be the same average; choose at most {:.3g}, or a wider --detector-step",
      RadiansToDegrees(widest), kMostSteps, RadiansToDegrees(layout.step), RadiansToDegrees(kMostSteps * layout.step)));
}

}  // namespace lobefit
