#include "lobefit/core/microfacet/energy.h"

#include <algorithm>

#include "lobefit/core/microfacet/visible_quadrature.h"

namespace lobefit {
namespace {

// int w(m) D(m) dm over the visible normals and the integral of its gradient; `weight` gives w and, if asked, dw.
template <class Weight>
double IntegrateWithD(const NormalDistribution& distribution, const Vec3& wo, VisibleNormals normals,
                      const Weight& weight, double* gradient, double tolerance) {
  const VisiblePolar polar(distribution.Outline(), wo, normals);
  if (gradient == nullptr) {
    const auto f = [&](const Vec3& m) { return std::array<double, 1>{weight(m, nullptr) * distribution.D(m)}; };
    return IntegrateVisibleNormals<1>(polar, f, tolerance)[0];
  }
  const auto count = static_cast<std::size_t>(distribution.parameters());
  const auto f = [&](const Vec3& m) {
    std::array<double, kMaxDistributionParameters> dD, dw{};
    const double D = distribution.D(m, dD.data()), w = weight(m, dw.data());
    std::array<double, kMaxDistributionParameters + 1> value{};
    value[0] = w * D;
    for (std::size_t k = 0; k < count; ++k) value[1 + k] = w * dD[k] + dw[k] * D;
    return value;
  };
  const auto integral = IntegrateVisibleNormals<kMaxDistributionParameters + 1>(polar, f, tolerance);
  std::copy_n(integral.begin() + 1, count, gradient);
  return integral[0];
}

// G1 times an integral that does not hold it, or the integral with G1 inside where G1 depends on the micro normal.
template <class Weight>
double MaskedIntegral(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                      VisibleNormals normals, const Weight& weight, double* gradient, double tolerance) {
  const auto masked = [&](const Vec3& m, double* dw) {
    const double w = weight(m);
    const double g1 = MaskingG1(distribution, shadowing, wo, m, dw);
    if (dw != nullptr) {
      for (int k = 0; k < distribution.parameters(); ++k) dw[k] *= w;
    }
    return w * g1;
  };
  return IntegrateWithD(distribution, wo, normals, masked, gradient, tolerance);
}

}  // namespace

double WeakFurnaceSphere(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                         double* gradient, double tolerance) {
  if (IsSmith(shadowing.masking)) {
    bool cut;
    MaskingLambda(distribution, shadowing, wo, nullptr, &cut);
    if (!cut) {
      if (gradient != nullptr) std::fill(gradient, gradient + distribution.parameters(), 0.0);
      return 1.0;
    }
    const double sigma = distribution.Sigma(wo, gradient);
    if (gradient != nullptr) {
      for (int k = 0; k < distribution.parameters(); ++k) gradient[k] /= wo.z;
    }
    return sigma / wo.z;
  }
  return MaskedIntegral(
      distribution, shadowing, wo, VisibleNormals::kAll, [&](const Vec3& m) { return Dot(wo, m) / wo.z; }, gradient,
      tolerance);
}

double WeakFurnaceHemisphere(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                             double* gradient, double tolerance) {
  return MaskedIntegral(
      distribution, shadowing, wo, VisibleNormals::kReflectUp, [&](const Vec3& m) { return Dot(wo, m) / wo.z; },
      gradient, tolerance);
}

double WeakFurnaceDiffuseHemisphere(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                                    double* gradient, double tolerance) {
  const auto weight = [&](const Vec3& m) { return 0.5 * (1.0 + m.z) * Dot(wo, m) / wo.z; };
  return MaskedIntegral(distribution, shadowing, wo, VisibleNormals::kAll, weight, gradient, tolerance);
}

double DirectionalAlbedo(const NormalDistribution& distribution, const Shadowing& shadowing,
                         const FresnelOfCosine& fresnel, const Vec3& wo, double* gradient, double tolerance) {
  const auto weight = [&](const Vec3& m, double* dw) {
    const double cos_d = Dot(wo, m);
    const Vec3 wi = (2.0 * cos_d) * m - wo;
    const double w = fresnel(std::min(1.0, cos_d)) * cos_d / wo.z;
    if (!(wi.z > 0)) {  // on the bound, by rounding
      if (dw != nullptr) std::fill(dw, dw + distribution.parameters(), 0.0);
      return 0.0;
    }
    const double g2 = MaskingShadowingG2(distribution, shadowing, wo, wi, m, dw);
    if (dw != nullptr) {
      for (int k = 0; k < distribution.parameters(); ++k) dw[k] *= w;
    }
    return w * g2;
  };
  return IntegrateWithD(distribution, wo, VisibleNormals::kReflectUp, weight, gradient, tolerance);
}

double EnergyMissing(const NormalDistribution& distribution, const Shadowing& shadowing, const Vec3& wo,
                     double* gradient, double tolerance) {
  const double albedo = DirectionalAlbedo(
      distribution, shadowing, [](double) { return 1.0; }, wo, gradient, tolerance);
  if (gradient != nullptr) {
    for (int k = 0; k < distribution.parameters(); ++k) gradient[k] = -gradient[k];
  }
  return 1.0 - albedo;
}

double MeanVisibleFresnel(const NormalDistribution& distribution, const FresnelOfCosine& fresnel, const Vec3& wo,
                          double* gradient, double tolerance) {
  const auto weight = [&](const Vec3& m, double*) {
    const double cos_d = Dot(wo, m);
    return fresnel(std::min(1.0, cos_d)) * cos_d;
  };
  const double integral = IntegrateWithD(distribution, wo, VisibleNormals::kAll, weight, gradient, tolerance);
  double dsigma[kMaxDistributionParameters];
  const double sigma = distribution.Sigma(wo, gradient != nullptr ? dsigma : nullptr);
  const double value = integral / sigma;
  if (gradient != nullptr) {
    for (int k = 0; k < distribution.parameters(); ++k) gradient[k] = (gradient[k] - value * dsigma[k]) / sigma;
  }
  return value;
}

}  // namespace lobefit
