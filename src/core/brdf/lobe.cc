#include "lobefit/core/brdf/lobe.h"

#include <algorithm>
#include <cmath>

#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/ndf/axial_distribution.h"

namespace lobefit {
namespace {

bool IsSimd(const Lobe& lobe) { return FamilyOf(lobe.ndf) == NdfFamily::kGgx && lobe.masking <= Masking::kSmithHeight; }

// One lobe, made ready for many samples.
class GeneralLobe {
 public:
  GeneralLobe(const Lobe& lobe, const SlopeCoordinates& shape)
      : distribution_(DistributionOf(lobe.ndf, shape, jacobian_)),
        shadowing_(ShadowingOf(lobe.masking, shape)),
        schlick_(lobe.masking == Masking::kSchlickSmith) {}

  double Evaluate(const Vec3& wi, const Vec3& wo, double* cos_d, double gradient[5]) const {
    if (gradient == nullptr) return MicrofacetSpecular(*distribution_, shadowing_, wo, wi, nullptr, cos_d);
    double by_parameter[kMaxDistributionParameters];
    const double value = MicrofacetSpecular(*distribution_, shadowing_, wo, wi, by_parameter, cos_d);
    for (std::size_t j = 0; j < 5; ++j) {
      gradient[j] = 0;
      for (int k = 0; k < distribution_->parameters(); ++k)
        gradient[j] += by_parameter[k] * jacobian_[5 * static_cast<std::size_t>(k) + j];
    }
    if (schlick_ && value > 0) {
      // microfacet.h holds m constant; here m = sqrt(a c).
      double dG_o = 0, dG_i = 0;
      const double m = shadowing_.schlick_m;
      const double G_o = SchlickSmithG1(wo, m, &dG_o), G_i = SchlickSmithG1(wi, m, &dG_i);
      const double by_m = value * (dG_o / G_o + dG_i / G_i) * 0.5 * m;
      gradient[2] += by_m;
      gradient[4] += by_m;
    }
    return value;
  }

 private:
  double jacobian_[5 * kMaxDistributionParameters] = {};
  std::unique_ptr<NormalDistribution> distribution_;
  Shadowing shadowing_;
  bool schlick_;
};

}  // namespace

Shadowing ShadowingOf(Masking masking, const SlopeCoordinates& shape) {
  switch (masking) {
    case Masking::kSmithUnclamped:
      return {ShadowingKind::kSmithSeparable, false};
    case Masking::kSmithHeight:
      return {ShadowingKind::kSmithHeight};
    case Masking::kSmithHeightDirection:
      return {ShadowingKind::kSmithHeightDirection};
    case Masking::kVCavity:
      return {ShadowingKind::kVCavity};
    case Masking::kImplicit:
      return {ShadowingKind::kImplicit};
    case Masking::kSchlickSmith:
      return {ShadowingKind::kSchlickSmith, true, std::exp(0.5 * (shape.v[2] + shape.v[4]))};
    case Masking::kKelemen:
      return {ShadowingKind::kKelemen};
    case Masking::kSmithSeparable:
      break;
  }
  return {};
}

std::unique_ptr<NormalDistribution> DistributionOf(Ndf ndf, const SlopeCoordinates& shape, double* jacobian) {
  const NdfFamily family = FamilyOf(ndf);
  const double a = std::exp(shape.v[2]), b = shape.v[3], c = std::exp(shape.v[4]);
  if (family == NdfFamily::kGgx || family == NdfFamily::kBeckmann) {
    const double alpha_y = std::hypot(b, c), r = b / alpha_y;
    if (jacobian != nullptr) {
      const double rows[kSlopeParameters][5] = {
          {0, 0, a, 0, 0},
          {0, 0, 0, r, c * c / alpha_y},
          {0, 0, 0, (c / alpha_y) * (c / alpha_y) / alpha_y, -r * (c / alpha_y) * (c / alpha_y)},
          {1, 0, 0, 0, 0},
          {0, 1, 0, 0, 0},
      };
      std::copy(&rows[0][0], &rows[0][0] + 25, jacobian);
    }
    const SlopeKind kind = family == NdfFamily::kGgx ? SlopeKind::kGgx : SlopeKind::kBeckmann;
    return std::make_unique<SlopeNormalDistribution>(SlopeDistribution{kind, a, alpha_y, r, shape.v[0], shape.v[1]});
  }
  const bool gaussian = family == NdfFamily::kSphericalGaussian;
  const double kk = 1 / (1 + 0.5 * a * a);
  if (jacobian != nullptr) {
    std::fill(jacobian, jacobian + 5, 0.0);
    jacobian[2] = gaussian ? a : -a * a * kk * kk;
  }
  return std::make_unique<AxialDistribution>(gaussian ? AxialNdf{AxialFamily::kSphericalGaussian, a}
                                                      : AxialNdf{AxialFamily::kKagiwadaKalaba, kk});
}

double SpecularLobe(const Vec3& wi, const Vec3& wo, const Lobe& lobe, const SlopeCoordinates& shape, double* cos_d,
                    double gradient[5]) {
  if (IsSimd(lobe)) return GgxLobe(wi, wo, shape, lobe.masking, cos_d, gradient);
  return GeneralLobe(lobe, shape).Evaluate(wi, wo, cos_d, gradient);
}

void SpecularLobe(const DirectionArrays& directions, const Lobe& lobe, const SlopeCoordinates& shape, double* specular,
                  double* cos_d, double* gradient) {
  if (IsSimd(lobe)) return GgxLobe(directions, shape, lobe.masking, specular, cos_d, gradient);
  const GeneralLobe general(lobe, shape);
  const DirectionArrays& d = directions;
  for (std::size_t i = 0; i < d.count; ++i) {
    double by_shape[5];
    specular[i] = general.Evaluate({d.wi_x[i], d.wi_y[i], d.wi_z[i]}, {d.wo_x[i], d.wo_y[i], d.wo_z[i]}, &cos_d[i],
                                   gradient != nullptr ? by_shape : nullptr);
    for (std::size_t j = 0; gradient != nullptr && j < 5; ++j) gradient[j * d.count + i] = by_shape[j];
  }
}

double FresnelFactor(Fresnel fresnel, const double* parameters, double cos_d, double* dF) {
  switch (fresnel) {
    case Fresnel::kSchlick:
      return FresnelSchlick(cos_d, parameters[0], nullptr, dF);
    case Fresnel::kConductor: {
      ConductorFresnelGradient gradient = {};
      const double value = FresnelConductor(cos_d, {parameters[0], parameters[1]}, dF != nullptr ? &gradient : nullptr);
      if (dF != nullptr) dF[0] = gradient.deta, dF[1] = gradient.dk;
      return value;
    }
    case Fresnel::kDielectric:
      return FresnelDielectric(cos_d, parameters[0], nullptr, dF);
    case Fresnel::kNone:
      break;
  }
  if (dF != nullptr) dF[0] = 1;
  return parameters[0];
}

}  // namespace lobefit
