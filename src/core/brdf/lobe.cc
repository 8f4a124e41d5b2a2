#include "lobefit/core/brdf/lobe.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobefit/core/axial/axial_distribution.h"
#include "lobefit/core/brdf/abg_lobe.h"
#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/brdf/radial_lobe.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/ndf/shape_invariant.h"
#include "lobefit/core/ndf/student.h"

namespace lobefit {
namespace {

bool IsFast(Masking masking) { return masking <= Masking::kSmithHeight; }
bool IsGgx(const Lobe& lobe) { return FamilyOf(lobe.ndf) == Family::kGgx; }
bool IsAbg(const Lobe& lobe) { return FamilyOf(lobe.ndf) == Family::kAbg; }

const std::shared_ptr<const ProfileGrid>& PowerLawGrid() {
  static const auto grid =
      std::make_shared<const ProfileGrid>(std::make_shared<const ProfileSpline>(ProfileSpline::PowerLaw()));
  return grid;
}

// Student's ellipse as that of the power law whose density it is: all widths times sqrt(gamma - 1).
SlopeCoordinates Widened(const SlopeCoordinates& slope, double gamma) {
  const double log_scale = 0.5 * std::log(gamma - 1.0);
  SlopeCoordinates wide = slope;
  wide.v[2] += log_scale;
  wide.v[3] *= std::exp(log_scale);
  wide.v[4] += log_scale;
  return wide;
}

// One lobe, made ready for many samples.
class GeneralLobe {
 public:
  GeneralLobe(const Lobe& lobe, const LobeShape& shape)
      : size_(ShapeParameters(lobe)),
        distribution_(DistributionOf(lobe, shape, &jacobian_)),
        shadowing_(ShadowingOf(lobe.masking, shape.slope)),
        schlick_(lobe.masking == Masking::kSchlickSmith) {}

  double Evaluate(const Vec3& wi, const Vec3& wo, double* cos_d, double* gradient) const {
    if (gradient == nullptr) return MicrofacetSpecular(*distribution_, shadowing_, wo, wi, nullptr, cos_d);
    double by_parameter[kMaxDistributionParameters];
    const double value = MicrofacetSpecular(*distribution_, shadowing_, wo, wi, by_parameter, cos_d);
    for (std::size_t j = 0; j < size_; ++j) {
      gradient[j] = 0;
      for (int k = 0; k < distribution_->parameters(); ++k)
        gradient[j] += by_parameter[k] * jacobian_[size_ * static_cast<std::size_t>(k) + j];
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
  std::size_t size_;
  std::vector<double> jacobian_;  // before what its making fills it
  std::unique_ptr<NormalDistribution> distribution_;
  Shadowing shadowing_;
  bool schlick_;
};

// A profile or Student's by its table; Student's is the power law's with its ellipse widened.
void FastRadialLobe(const DirectionArrays& d, const Lobe& lobe, const LobeShape& shape, double* specular, double* cos_d,
                    double* gradient) {
  if (FamilyOf(lobe.ndf) == Family::kProfile)
    return RadialLobe(d, shape.slope, *shape.masking, lobe.masking, specular, cos_d, gradient);
  const double rest = shape.exponent - 1.0, scale = std::sqrt(rest);
  const SlopeCoordinates wide = Widened(shape.slope, shape.exponent);
  RadialLobe(d, wide, *shape.masking, lobe.masking, specular, cos_d, gradient);
  const std::size_t n = d.count;
  for (std::size_t i = 0; gradient != nullptr && i < n; ++i) {
    double* g = gradient + i;
    g[5 * n] += 0.5 * (g[2 * n] + wide.v[3] * g[3 * n] + g[4 * n]) / rest;
    g[3 * n] *= scale;
  }
}

}  // namespace

LobeShape::LobeShape(const Lobe& lobe, const SlopeCoordinates& ellipse, const std::vector<double>& profile)
    : slope(ellipse) {
  const Family family = FamilyOf(lobe.ndf);
  if (family == Family::kStudent) {
    exponent = profile[0];
    masking = std::make_shared<const ProfileMasking>(
        PowerLawGrid(), Profile(PowerLawGrid()->spline(), std::vector<double>{exponent - 2.0}));
  }
  if (family == Family::kAbg) exponent = profile[0];
  if (family == Family::kProfile)
    masking = std::make_shared<const ProfileMasking>(GridOf(lobe), Profile(GridOf(lobe)->spline(), profile));
}

LobeShape ShapeAt(const Lobe& lobe, const std::vector<double>* values) {
  const SlopeCoordinates slope =
      SlopeCoordinatesFromEllipsoid({values[0][0], values[1][0], values[2][0], values[3][0], values[4][0]});
  std::vector<double> profile;
  for (std::size_t k = kEllipseParameters; k < ShapeParameters(lobe); ++k) profile.push_back(values[k][0]);
  return {lobe, slope, profile};
}

Shadowing ShadowingOf(Masking masking, const SlopeCoordinates& shape) {
  if (masking != Masking::kSchlickSmith) return {masking};
  return {masking, std::exp(0.5 * (shape.v[2] + shape.v[4]))};
}

std::unique_ptr<NormalDistribution> DistributionOf(const Lobe& lobe, const LobeShape& shape,
                                                   std::vector<double>* jacobian) {
  const Family family = FamilyOf(lobe.ndf);
  const std::size_t size = ShapeParameters(lobe);
  const SlopeCoordinates& s = shape.slope;
  if (family == Family::kAbg) {
    if (jacobian != nullptr) {
      jacobian->assign(size * size, 0.0);
      for (std::size_t k = 0; k < size; ++k) (*jacobian)[k * size + k] = 1;
    }
    return std::make_unique<AbgDistribution>(s, shape.exponent);
  }
  const double a = std::exp(s.v[2]), b = s.v[3], c = std::exp(s.v[4]);
  const bool on_sphere = family == Family::kKagiwadaKalaba || family == Family::kSphericalGaussian;
  if (jacobian != nullptr) jacobian->assign((on_sphere ? 1 : size) * size, 0.0);
  if (!on_sphere) {
    const double alpha_y = std::hypot(b, c), r = b / alpha_y;
    if (jacobian != nullptr) {
      const double rows[kSlopeParameters][5] = {
          {0, 0, a, 0, 0},
          {0, 0, 0, r, c * c / alpha_y},
          {0, 0, 0, (c / alpha_y) * (c / alpha_y) / alpha_y, -r * (c / alpha_y) * (c / alpha_y)},
          {1, 0, 0, 0, 0},
          {0, 1, 0, 0, 0},
      };
      for (std::size_t k = 0; k < kSlopeParameters; ++k) std::copy(rows[k], rows[k] + 5, jacobian->data() + k * size);
      for (std::size_t k = kSlopeParameters; k < size; ++k) (*jacobian)[k * size + k] = 1;
    }
    const SlopeDistribution slopes = {family, a, alpha_y, r, s.v[0], s.v[1]};
    if (family == Family::kProfile) return std::make_unique<ShapeInvariantDistribution>(shape.masking, slopes);
    if (family == Family::kStudent) return std::make_unique<StudentDistribution>(shape.masking, slopes);
    return std::make_unique<SlopeNormalDistribution>(slopes);
  }
  const bool gaussian = family == Family::kSphericalGaussian;
  const double kk = 1 / (1 + 0.5 * a * a);
  if (jacobian != nullptr) (*jacobian)[2] = gaussian ? a : -a * a * kk * kk;
  return std::make_unique<AxialDistribution>(gaussian ? AxialNdf{Family::kSphericalGaussian, a}
                                                      : AxialNdf{Family::kKagiwadaKalaba, kk});
}

double SpecularLobe(const Vec3& wi, const Vec3& wo, const Lobe& lobe, const LobeShape& shape, double* cos_d,
                    double* gradient) {
  const Vec3 light = lobe.direction == LobeDirection::kRetro ? Mirrored(wi) : wi;
  if (IsFast(lobe.masking) && IsGgx(lobe)) return GgxLobe(light, wo, shape.slope, lobe.masking, cos_d, gradient);
  if (IsFast(lobe.masking) && shape.masking != nullptr) {
    double specular;
    FastRadialLobe({&light.x, &light.y, &light.z, &wo.x, &wo.y, &wo.z, 1}, lobe, shape, &specular, cos_d, gradient);
    return specular;
  }
  if (IsAbg(lobe)) {
    double specular;
    AbgLobe({&light.x, &light.y, &light.z, &wo.x, &wo.y, &wo.z, 1}, shape.slope, shape.exponent, &specular, cos_d,
            gradient);
    return specular;
  }
  return GeneralLobe(lobe, shape).Evaluate(light, wo, cos_d, gradient);
}

void SpecularLobe(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape, double* specular,
                  double* cos_d, double* gradient) {
  DirectionArrays d = directions;
  std::vector<double> mirrored_x, mirrored_y;
  if (lobe.direction == LobeDirection::kRetro) {
    for (std::size_t i = 0; i < d.count; ++i) {
      const Vec3 light = Mirrored({d.wi_x[i], d.wi_y[i], d.wi_z[i]});
      mirrored_x.push_back(light.x);
      mirrored_y.push_back(light.y);
    }
    d.wi_x = mirrored_x.data();
    d.wi_y = mirrored_y.data();
  }
  if (IsFast(lobe.masking) && IsGgx(lobe)) return GgxLobe(d, shape.slope, lobe.masking, specular, cos_d, gradient);
  if (IsFast(lobe.masking) && shape.masking != nullptr)
    return FastRadialLobe(d, lobe, shape, specular, cos_d, gradient);
  if (IsAbg(lobe)) return AbgLobe(d, shape.slope, shape.exponent, specular, cos_d, gradient);
  const GeneralLobe general(lobe, shape);
  std::vector<double> by_shape(ShapeParameters(lobe));
  for (std::size_t i = 0; i < d.count; ++i) {
    specular[i] = general.Evaluate({d.wi_x[i], d.wi_y[i], d.wi_z[i]}, {d.wo_x[i], d.wo_y[i], d.wo_z[i]}, &cos_d[i],
                                   gradient != nullptr ? by_shape.data() : nullptr);
    for (std::size_t j = 0; gradient != nullptr && j < by_shape.size(); ++j) gradient[j * d.count + i] = by_shape[j];
  }
}

double FresnelFactor(Fresnel fresnel, const double* parameters, double cos_d, double* dF, double* dF_dcos_d) {
  switch (fresnel) {
    case Fresnel::kSchlick:
      return FresnelSchlick(cos_d, parameters[0], dF_dcos_d, dF);
    case Fresnel::kConductor: {
      ConductorFresnelGradient gradient = {};
      const bool derivatives = dF != nullptr || dF_dcos_d != nullptr;
      const double value = FresnelConductor(cos_d, {parameters[0], parameters[1]}, derivatives ? &gradient : nullptr);
      if (dF != nullptr) dF[0] = gradient.deta, dF[1] = gradient.dk;
      if (dF_dcos_d != nullptr) *dF_dcos_d = gradient.dc;
      return value;
    }
    case Fresnel::kCoatLayered:
    case Fresnel::kCoatRefracted:
      if (dF != nullptr) dF[1] = 0;
      [[fallthrough]];
    case Fresnel::kDielectric:
      return FresnelDielectric(cos_d, parameters[0], dF_dcos_d, dF);
    case Fresnel::kSchlickF82: {
      SchlickF82Gradient gradient = {};
      const bool derivatives = dF != nullptr || dF_dcos_d != nullptr;
      const double value = FresnelSchlickF82(cos_d, parameters[0], parameters[1], derivatives ? &gradient : nullptr);
      if (dF != nullptr) dF[0] = gradient.df0, dF[1] = gradient.dtint;
      if (dF_dcos_d != nullptr) *dF_dcos_d = gradient.dc;
      return value;
    }
    case Fresnel::kCurve: {
      double basis[kFresnelCurveSize], by_cos_d[kFresnelCurveSize], value = 0;
      FresnelCurveBasis(cos_d, basis, dF_dcos_d != nullptr ? by_cos_d : nullptr);
      for (std::size_t k = 0; k < kFresnelCurveSize; ++k) value += parameters[k] * basis[k];
      if (dF != nullptr) std::copy(basis, basis + kFresnelCurveSize, dF);
      if (dF_dcos_d != nullptr)
        *dF_dcos_d = std::inner_product(by_cos_d, by_cos_d + kFresnelCurveSize, parameters, 0.0);
      return value;
    }
    case Fresnel::kNone:
      break;
  }
  if (dF != nullptr) dF[0] = 1;
  if (dF_dcos_d != nullptr) *dF_dcos_d = 0;
  return parameters[0];
}

}  // namespace lobefit
