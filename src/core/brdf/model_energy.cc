#include "lobefit/core/brdf/model_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "lobefit/core/brdf/abg_lobe.h"
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

// The coat that lies over a lobe.
struct Cover {
  double ior;
  bool refracted;
  std::vector<double> tau;  // [channel]
};

// What leaves of the coat for wo inside it: false, it is reflected totally. d wo cos_o = n^2 d wo' cos_o'.
bool Leaves(const Cover& cover, const Vec3& inside, Vec3* wo, double* spread) {
  *wo = inside;
  *spread = 1;
  if (!cover.refracted) return true;
  const double n = cover.ior, x = n * inside.x, y = n * inside.y, left = 1 - x * x - y * y;
  if (left <= 0) return false;
  *wo = {x, y, std::sqrt(left)};
  *spread = n * n;
  return true;
}

// Adds the albedo of the lobe to `albedo`, a channel, with F of parameters[channel]. `cover`: null, none.
void AddLobe(const Lobe& lobe, const LobeShape& shape, Fresnel fresnel,
             const std::vector<std::vector<double>>& parameters, const Cover* cover, const Vec3& from,
             const FacetGrid& grid, std::vector<double>* albedo) {
  if (FamilyOf(lobe.ndf) == Family::kAbg) {
    const Vec3 light = lobe.direction == LobeDirection::kRetro ? Mirrored(from) : from;
    const double unit = AbgAlbedo(shape.slope, shape.exponent, light);
    for (std::size_t c = 0; c < albedo->size(); ++c)
      (*albedo)[c] += unit * FresnelFactor(fresnel, parameters[c].data(), 1, nullptr);
    return;
  }
  const Vec3 wi = cover != nullptr && cover->refracted ? Refracted(from, cover->ior) : from;
  const Vec3 light = lobe.direction == LobeDirection::kRetro ? Mirrored(wi) : wi;
  std::vector<double> in[3], out[3], weight, path;
  ForFacets(shape.slope, grid, [&](const Vec3& m, double share) {
    // wo is the mirror image of wi (of a retro lobe's mirrored wi) at the facet.
    const double along = Dot(light, m);
    const Vec3 wo = Reflect(light, m);
    if (along <= 0 || wo.z <= 0) return;
    double through = 1;
    if (cover != nullptr) {
      Vec3 outside;
      double spread;
      if (!Leaves(*cover, wo, &outside, &spread)) return;
      const CoatPassage passage = PassThroughCoat(cover->ior, cover->refracted, from, outside);
      through = passage.clear * spread;
      path.push_back(passage.path);
    }
    const double arrives[] = {wi.x, wi.y, wi.z}, leaves[] = {wo.x, wo.y, wo.z};
    for (std::size_t k = 0; k < 3; ++k) {
      in[k].push_back(arrives[k]);
      out[k].push_back(leaves[k]);
    }
    weight.push_back(through * wo.z * 4 * along * share);  // d wo = 4 (wi.m) dm
  });
  const std::size_t count = weight.size();
  std::vector<double> specular(count), cos_d(count);
  SpecularLobe({in[0].data(), in[1].data(), in[2].data(), out[0].data(), out[1].data(), out[2].data(), count}, lobe,
               shape, specular.data(), cos_d.data(), nullptr);
  if (fresnel == Fresnel::kCurve && cover == nullptr) {
    // Linear in its coefficients: of hundreds of channels the basis is found once.
    double sums[kFresnelCurveSize] = {}, basis[kFresnelCurveSize];
    for (std::size_t i = 0; i < count; ++i) {
      FresnelCurveBasis(cos_d[i], basis);
      for (std::size_t k = 0; k < kFresnelCurveSize; ++k) sums[k] += weight[i] * specular[i] * basis[k];
    }
    for (std::size_t c = 0; c < albedo->size(); ++c)
      (*albedo)[c] += std::inner_product(sums, sums + kFresnelCurveSize, parameters[c].data(), 0.0);
    return;
  }
  for (std::size_t c = 0; c < albedo->size(); ++c) {
    for (std::size_t i = 0; i < count; ++i) {
      const double kept = cover == nullptr ? 1 : std::exp(-cover->tau[c] * path[i]);
      (*albedo)[c] += kept * weight[i] * specular[i] * FresnelFactor(fresnel, parameters[c].data(), cos_d[i], nullptr);
    }
  }
}

// Of a Lambertian body of apparent albedo 1 below the coat: T(wi) int T(o) exp(-tau path) cos_o dwo / (pi (1 - F_ex)).
double LambertAlbedo(const Cover& cover, double tau, const Vec3& wi) {
  static const QuadratureRule rule = GaussLegendre(kDiffuseRings);
  const double unit = LambertBelowCoat(cover.ior, cover.refracted);
  return Integrate(rule, 0, 1, [&](double cos) {
    const CoatPassage passage =
        PassThroughCoat(cover.ior, cover.refracted, wi, {std::sqrt((1 - cos) * (1 + cos)), 0, cos});
    return 2 * kPi * cos * unit * passage.clear * std::exp(-tau * passage.path);
  });
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
  const std::size_t coat = CoatOf(model);
  std::optional<Cover> cover;
  if (coat < model.lobes.size()) {
    const std::size_t first = FirstFresnel(model, coat);
    cover = Cover{values[first][0], model.lobes[coat].fresnel == Fresnel::kCoatRefracted, values[first + 1]};
    for (std::size_t c = 0; model.diffuse != Diffuse::kNone && c < channels; ++c)
      albedo[c] *= LambertAlbedo(*cover, cover->tau[c], wi);
  }
  for (std::size_t lobe = 0; lobe < model.lobes.size(); ++lobe) {
    const Fresnel fresnel = model.lobes[lobe].fresnel;
    std::vector<std::vector<double>> parameters(channels);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < FresnelParameters(fresnel); ++k)
        parameters[c].push_back(values[FirstFresnel(model, lobe) + k][c]);
    }
    AddLobe(model.lobes[lobe], ShapeOf(model, values, lobe), fresnel, parameters,
            cover && lobe != coat ? &*cover : nullptr, wi, grid, &albedo);
  }
  return albedo;
}

double SingleBounceAlbedo(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& wi) {
  std::vector<double> albedo = {0};
  AddLobe(model.lobes[lobe], ShapeOf(model, values, lobe), Fresnel::kNone, {{1.0}}, nullptr, wi, {}, &albedo);
  return albedo[0];
}

double WeakFurnace(const Model& model, const ParameterValues& values, std::size_t lobe, const Vec3& u) {
  const Masking masking = model.lobes[lobe].masking;
  if (masking == Masking::kSmithUnclamped || masking == Masking::kVCavity) return 1;
  if (masking == Masking::kNone) return std::numeric_limits<double>::quiet_NaN();
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
