#include "lobefit/core/brdf/model_energy.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/brdf/diffuse_facets.h"
#include "lobefit/core/brdf/lobe.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/ndf/slope_ndf.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

constexpr int kDiffuseRings = 24, kDiffuseSteps = 48;

LobeShape ShapeOf(const Model& model, const ParameterValues& values, std::size_t lobe) {
  return ShapeAt(model.lobes[lobe], &values[FirstParameter(model, lobe)]);
}

// Calls each(m, share) for facets m at the slopes of equal probability of GGX's P22 (midpoints in probability and
// angle); the mean of share * g(m) is the integral of g over normals.
template <class Each>
void ForFacets(const SlopeCoordinates& shape, const FacetGrid& grid, const Each& each) {
  const SlopeFrame frame(shape);
  for (int i = 0; i < grid.rings; ++i) {
    const double u = (i + 0.5) / grid.rings, rho = std::sqrt(u / (1 - u));
    for (int k = 0; k < grid.steps; ++k) {
      // Every ring is turned against the one before, so that rings do not line up.
      const double t = 2 * kPi * (k + 0.5 + 0.618034 * i) / grid.steps;
      const double x = frame.slope_x + frame.a * rho * std::cos(t);
      const double y = frame.slope_y + frame.b * rho * std::cos(t) + frame.c * rho * std::sin(t);
      const Vec3 m = Normalized(Vec3{-x, -y, 1.0});
      each(m, 1 / (SlopeD(frame, m) * m.z * grid.rings * grid.steps));  // P22 dslope = D (m.n) dm
    }
  }
}

// Adds the albedo of the lobe to `albedo`, a channel, with F of parameters[channel].
void AddLobe(const Lobe& lobe, const LobeShape& shape, Fresnel fresnel,
             const std::vector<std::vector<double>>& parameters, const Vec3& wi, const FacetGrid& grid,
             std::vector<double>* albedo) {
  const Vec3 light = lobe.direction == LobeDirection::kRetro ? Mirrored(wi) : wi;
  std::vector<double> in[3], out[3], weight;
  ForFacets(shape.slope, grid, [&](const Vec3& m, double share) {
    // wo is the mirror image of wi (of a retro lobe's mirrored wi) at the facet.
    const double along = Dot(light, m);
    const Vec3 wo = Reflect(light, m);
    if (along <= 0 || wo.z <= 0) return;
    const double from[] = {wi.x, wi.y, wi.z}, to[] = {wo.x, wo.y, wo.z};
    for (std::size_t k = 0; k < 3; ++k) {
      in[k].push_back(from[k]);
      out[k].push_back(to[k]);
    }
    weight.push_back(wo.z * 4 * along * share);  // d wo = 4 (wi.m) dm
  });
  const std::size_t count = weight.size();
  std::vector<double> specular(count), cos_d(count);
  SpecularLobe({in[0].data(), in[1].data(), in[2].data(), out[0].data(), out[1].data(), out[2].data(), count}, lobe,
               shape, specular.data(), cos_d.data(), nullptr);
  for (std::size_t c = 0; c < albedo->size(); ++c) {
    for (std::size_t i = 0; i < count; ++i)
      (*albedo)[c] += weight[i] * specular[i] * FresnelFactor(fresnel, parameters[c].data(), cos_d[i], nullptr);
  }
}

double DiffuseFacetsAlbedo(const DiffuseFacets& facets, const Vec3& wi) {
  static const QuadratureRule rule = GaussLegendre(kDiffuseRings);
  return Integrate(rule, 0, 1, [&](double u) {  // u = sin^2 theta_o
    double ring = 0;
    for (int k = 0; k < kDiffuseSteps; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / kDiffuseSteps, sin = std::sqrt(u);
      ring += facets.Evaluate(wi, {sin * std::cos(phi), sin * std::sin(phi), std::sqrt(1 - u)}, nullptr);
    }
    return ring * kPi / kDiffuseSteps;
  });
}

}  // namespace

std::vector<double> DirectionalAlbedo(const Model& model, const ParameterValues& values, std::size_t channels,
                                      const Vec3& wi, const FacetGrid& grid) {
  std::vector<double> albedo(channels, 0.0);
  if (model.diffuse != Diffuse::kNone) albedo = values.back();
  for (std::size_t c = 0; IsDirectional(model.diffuse) && c < channels; ++c) {
    const double first = values[values.size() - 2][c];
    albedo[c] = model.diffuse == Diffuse::kInterfaced ? albedo[c] * DielectricTransmittance(wi.z, first)
                                                      : OrenNayarAlbedo(albedo[c], first, wi.z);
  }
  if (model.diffuse == Diffuse::kMicrofacet) {
    const double unit = DiffuseFacetsAlbedo(DiffuseFacets(model.lobes[0], ShapeOf(model, values, 0).slope), wi);
    for (double& a : albedo) a *= unit;
  }
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    const Fresnel fresnel = model.lobes[lobe].fresnel;
    std::vector<std::vector<double>> parameters(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < FresnelParameters(fresnel); ++k)
        parameters[c].push_back(values[FirstFresnel(model, lobe) + k][c]);
    }
    AddLobe(model.lobes[lobe], ShapeOf(model, values, lobe), fresnel, parameters, wi, grid, &albedo);
  }
  return albedo;
}

double SingleBounceAlbedo(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& wi) {
  std::vector<double> albedo = {0};
  AddLobe(model.lobes[lobe], ShapeOf(model, values, lobe), Fresnel::kNone, {{1.0}}, wi, {}, &albedo);
  return albedo[0];
}

double WeakFurnace(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& u) {
  const Masking masking = model.lobes[lobe].masking;
  if (masking == Masking::kSmithUnclamped || masking == Masking::kVCavity) return 1;
  const LobeShape shape = ShapeOf(model, values, lobe);
  const std::unique_ptr<NormalDistribution> distribution = DistributionOf(model.lobes[lobe], shape, nullptr);
  if (masking <= Masking::kSmithHeightDirection) return std::min(1.0, distribution->Sigma(u) / u.z);
  const Shadowing shadowing = ShadowingOf(masking, shape.slope);
  double furnace = 0;
  ForFacets(shape.slope, {}, [&](const Vec3& m, double share) {
    const double along = Dot(u, m);
    if (along > 0) furnace += MaskingG1(*distribution, shadowing, u, m) * along * distribution->D(m) * share / u.z;
  });
  return furnace;
}

}  // namespace lobefit
