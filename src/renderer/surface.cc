#include "lobefit/renderer/surface.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/microfacet/vndf.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Below this a lobe of a mixture is left out.
constexpr double kNoReflectance = 1e-5;

double Power5(double x) { return x * x * x * x * x; }

// 2 Lambda + 1 = sqrt(1 + tan^2 weighted by the widths) for w in the frame.
double Root(const Vec3& w, double alpha_x, double alpha_y) {
  const double x = alpha_x * w.x, y = alpha_y * w.y;
  return std::sqrt(1 + (x * x + y * y) / (w.z * w.z));
}

double G2(SurfaceMasking masking, const Widths& widths, const Vec3& i, const Vec3& o) {
  if (masking == SurfaceMasking::kSeparable) {
    return 4 / ((1 + Root(i, widths.alpha_1, widths.alpha_2)) * (1 + Root(o, widths.alpha_1, widths.alpha_2)));
  }
  const double mean = std::sqrt(widths.alpha_1 * widths.alpha_2);
  const bool averaged = masking == SurfaceMasking::kMeanAlpha;
  const double ax = averaged ? mean : widths.alpha_1, ay = averaged ? mean : widths.alpha_2;
  return 2 / (Root(i, ax, ay) + Root(o, ax, ay));
}

double GgxNdf(const Widths& widths, const Vec3& h) {
  const double x = h.x / widths.alpha_1, y = h.y / widths.alpha_2, q = x * x + y * y + h.z * h.z;
  return 1 / (kPi * widths.alpha_1 * widths.alpha_2 * q * q);
}

struct Frame {
  Vec3 tangent, bitangent, normal;

  explicit Frame(const SurfaceLobe& lobe) : normal(lobe.normal) {
    const Vec3 along = {std::cos(lobe.rotation), std::sin(lobe.rotation), 0};
    tangent = Normalized(along - Dot(along, normal) * normal);
    bitangent = Cross(normal, tangent);
  }
  Vec3 Local(const Vec3& w) const { return {Dot(w, tangent), Dot(w, bitangent), Dot(w, normal)}; }
};

// Everything that does not depend on directions, made once.
class SurfaceEvaluator {
 public:
  explicit SurfaceEvaluator(const Surface& surface) : surface_(surface) {
    for (const SurfaceLobe& lobe : surface.lobes) {
      frames_.emplace_back(lobe);
      const bool needs_albedo = surface.energy_compensation || surface.layering == Surface::Layering::kAlbedo ||
                                surface.coating == Surface::Coating::kAlbedo;
      albedos_.push_back(needs_albedo ? std::make_unique<const IsotropicAlbedo>(
                                            std::sqrt(lobe.widths.alpha_1 * lobe.widths.alpha_2), surface.albedo_side)
                                      : nullptr);
    }
  }

  void Evaluate(const Vec3& wi, const Vec3& wo, double* values) const {
    std::fill_n(values, surface_.diffuse.size(), 0.0);
    if (!(wi.z > 0) || !(wo.z > 0)) return;
    const double cos_d = Dot(wi, HalfVector(wi, wo));
    const bool coated = surface_.coating != Surface::Coating::kNone;
    for (std::size_t l = 0; l < surface_.lobes.size(); ++l) {
      if (!coated || l != surface_.coat_lobe) AddLobe(l, wi, wo, cos_d, values);
    }
    AddDiffuse(wi, wo, cos_d, values);
    if (!coated) return;
    const SurfaceLobe& coat = surface_.lobes[surface_.coat_lobe];
    const double cos_o = Dot(coat.normal, wo);
    const bool by_albedo = surface_.coating == Surface::Coating::kAlbedo;
    const double dims = coat.weight * (by_albedo ? LayerAlbedo(surface_.coat_lobe, cos_o) : coat.fresnel(0, cos_o));
    for (std::size_t c = 0; c < surface_.diffuse.size(); ++c) values[c] *= 1 - dims;
    AddLobe(surface_.coat_lobe, wi, wo, by_albedo ? cos_d : cos_o, values);
  }

 private:
  void AddLobe(std::size_t l, const Vec3& wi, const Vec3& wo, double cos_d, double* values) const {
    const SurfaceLobe& lobe = surface_.lobes[l];
    const Vec3 i = frames_[l].Local(wi), o = frames_[l].Local(wo);
    if (!(i.z > 0) || !(o.z > 0)) return;
    const double specular = lobe.weight * GgxNdf(lobe.widths, HalfVector(i, o)) *
                            G2(surface_.masking, lobe.widths, i, o) / (4 * o.z * wi.z);
    const double lost = surface_.energy_compensation ? 1 / (*albedos_[l])(o.z, 1, 1) - 1 : 0.0;
    for (std::size_t c = 0; c < surface_.diffuse.size(); ++c) {
      const double f = lobe.fresnel(c, cos_d);
      values[c] += specular * f * (1 + f * lost) * (lobe.tint.empty() ? 1.0 : lobe.tint[c]);
    }
  }

  void AddDiffuse(const Vec3& wi, const Vec3& wo, double cos_d, double* values) const {
    const double cos_i = Dot(surface_.diffuse_normal, wi), cos_o = Dot(surface_.diffuse_normal, wo);
    if (!(cos_i > 0) || !(cos_o > 0)) return;
    double left = 1;
    if (surface_.layering == Surface::Layering::kSchlick) {
      double largest = 0;
      for (std::size_t c = 0; c < surface_.diffuse.size(); ++c) largest = std::max(largest, surface_.layer(c, cos_d));
      left = 1 - largest;
    } else if (surface_.layering == Surface::Layering::kAlbedo) {
      left = 1 - LayerAlbedo(surface_.layer_lobe, Dot(frames_[surface_.layer_lobe].normal, wo));
    }
    for (std::size_t c = 0; c < surface_.diffuse.size(); ++c) {
      values[c] += Scattered(surface_.diffuse[c], wi, wo, cos_i, cos_o) * left * cos_i / wi.z;
    }
  }

  // f_r of the diffuse part in the frame of its normal.
  double Scattered(double albedo, const Vec3& wi, const Vec3& wo, double cos_i, double cos_o) const {
    if (surface_.diffuse_roughness == 0) return albedo * kInvPi;
    // The term needs the cosines and the product of the parts along the surface only.
    const double along = std::max(0.0, Dot(wi, wo)) - cos_i * cos_o;
    const OrenNayar f = OrenNayarDiffuse(albedo, surface_.diffuse_roughness, {along, 0, cos_i}, {1, 0, cos_o});
    return f.single + f.multiple;
  }

  double LayerAlbedo(std::size_t lobe, double cos_o) const {
    const IsotropicAlbedo& albedo = *albedos_[lobe];
    const double mu = std::max(cos_o, 1e-6);
    const double f0 = surface_.lobes[lobe].fresnel(0, 1);
    const double lost = 1 / albedo(mu, 1, 1) - 1;
    return std::min(1.0, albedo(mu, f0, 1) * (1 + lost * surface_.lobes[lobe].fresnel(0, mu)));
  }

  Surface surface_;
  std::vector<Frame> frames_;
  std::vector<std::unique_ptr<const IsotropicAlbedo>> albedos_;
};

}  // namespace

double SurfaceFresnel::operator()(std::size_t channel, double cos_d) const {
  switch (kind) {
    case Kind::kConductor:
      return k[channel] > 0 ? FresnelConductor(cos_d, {eta[channel], k[channel]})
                            : FresnelDielectric(cos_d, eta[channel]);
    case Kind::kDielectric:
      return FresnelDielectric(cos_d, eta[0]);
    case Kind::kSchlick:
      break;
  }
  const double rest = std::max(0.0, 1 - cos_d), schlick = f0[channel] + (f90[channel] - f0[channel]) * Power5(rest);
  if (f82.empty()) return schlick;
  constexpr double kCos82 = 1.0 / 7;
  const double at_edge = f0[channel] + (f90[channel] - f0[channel]) * Power5(1 - kCos82);
  return schlick -
         (1 - f82[channel]) * at_edge / (kCos82 * Power5(1 - kCos82) * (1 - kCos82)) * cos_d * Power5(rest) * rest;
}

BrdfFunction SurfaceBrdf(const Surface& surface) {
  return [evaluator = std::make_shared<const SurfaceEvaluator>(surface)](
             const Vec3& wi, const Vec3& wo, double* values) { evaluator->Evaluate(wi, wo, values); };
}

IsotropicAlbedo::IsotropicAlbedo(double alpha, int side) {
  constexpr int kNodes = 65;
  for (int node = 0; node < kNodes; ++node) {
    const double mu = std::max(1e-3, static_cast<double>(node) / (kNodes - 1));
    const Vec3 v = {std::sqrt(1 - mu * mu), 0, mu};
    const EllipsoidVndfSampler sampler({alpha, alpha, 0, 0, 0}, v);
    const double root = Root(v, alpha, alpha);
    double a = 0, b = 0;
    // Of turns u and 1 - u the normals mirror each other in the plane of v: half of them are drawn.
    for (int row = 0; 2 * row < side; ++row) {
      const double both = 2 * row + 1 == side ? 1 : 2;
      for (int column = 0; column < side; ++column) {
        const Vec3 m = sampler.Sample((column + 0.5) / side, (row + 0.5) / side);
        const Vec3 l = Reflect(v, m);
        if (!(l.z > 0)) continue;
        // G2 / G1 of the viewer.
        const double weight = both * (1 + root) / (root + Root(l, alpha, alpha));
        const double schlick = Power5(1 - Dot(v, m));
        a += weight * (1 - schlick);
        b += weight * schlick;
      }
    }
    a_.push_back(a / (side * side));
    b_.push_back(b / (side * side));
  }
}

double IsotropicAlbedo::operator()(double mu, double f0, double f90) const {
  const double position = std::clamp(mu, 0.0, 1.0) * static_cast<double>(a_.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(position), a_.size() - 2);
  const double t = position - static_cast<double>(below);
  const auto at = [&](const std::vector<double>& table) { return (1 - t) * table[below] + t * table[below + 1]; };
  return f0 * at(a_) + f90 * at(b_);
}

ConductorIndex ConductorOfReflectance(double r) {
  const double clamped = std::clamp(r, 0.0, 0.9999);
  return {1, 2 * std::sqrt(clamped) / std::sqrt(1 - clamped)};
}

ConductorIndex NearestConductor(const std::function<double(double)>& fresnel) {
  const double f0 = std::clamp(fresnel(1), 1e-6, 0.9999), root = std::sqrt(f0);
  // The circle of all indices with that reflectance, from one dielectric to the other.
  const double log_low = std::log((1 - root) / (1 + root)), log_high = -log_low;
  const auto at = [&](double log_eta) {
    const double eta = std::exp(log_eta);
    const double k2 = (f0 * (eta + 1) * (eta + 1) - (eta - 1) * (eta - 1)) / (1 - f0);
    return ConductorIndex{eta, std::sqrt(std::max(0.0, k2))};
  };
  const auto cost = [&](double log_eta) {
    const ConductorIndex index = at(log_eta);
    double sum = 0;
    for (int i = 1; i < 50; ++i) {
      const double c = i / 50.0;
      const double f = index.k > 0 ? FresnelConductor(c, index) : FresnelDielectric(c, index.eta);
      sum += c * (f - fresnel(c)) * (f - fresnel(c));
    }
    return sum;
  };
  constexpr int kSteps = 100;
  double best = log_low, step = (log_high - log_low) / kSteps;
  for (int i = 0; i <= kSteps; ++i) {
    if (cost(log_low + i * step) < cost(best)) best = log_low + i * step;
  }
  for (; step > 1e-7; step /= 2) {
    for (const double trial : {best - step, best + step}) {
      if (trial >= log_low && trial <= log_high && cost(trial) < cost(best)) best = trial;
    }
  }
  return at(best);
}

namespace {

// A grey channel is three equal ones.
std::size_t ChannelsOf(const FittedBrdf& fit) { return fit.IsGrey() ? 3 : fit.material().channels.size(); }
std::size_t ChannelOf(const FittedBrdf& fit, std::size_t c) { return fit.IsGrey() ? 0 : c; }

}  // namespace

SurfaceLobe LobeOf(const FittedBrdf& fit, std::size_t lobe, double weight) {
  SurfaceLobe result;
  const FittedLobe& fitted = fit.lobes()[lobe];
  result.widths = fitted.widths;
  result.rotation = fitted.rotation;
  if (fitted.tilt > 1e-6) result.normal = fitted.axis;
  result.weight = weight;
  result.fresnel.f0.resize(ChannelsOf(fit));
  result.fresnel.f90.resize(ChannelsOf(fit));
  for (std::size_t c = 0; c < ChannelsOf(fit); ++c) {
    result.fresnel.f0[c] = fit.Fresnel(lobe, ChannelOf(fit, c), 1) / weight;
    result.fresnel.f90[c] = std::min(1.0, fit.Fresnel(lobe, ChannelOf(fit, c), 0) / weight);
    if (fitted.choices.fresnel == Fresnel::kSchlickF82 && weight == 1) {
      const std::size_t tint = FirstFresnel(fit.material().model, lobe) + 1;
      result.fresnel.f82.push_back(fit.material().parameters[tint].values[ChannelOf(fit, c)]);
    }
  }
  return result;
}

SurfaceFresnel ConductorFresnelOf(const FittedBrdf& fit, std::size_t lobe, double share) {
  SurfaceFresnel fresnel;
  fresnel.kind = SurfaceFresnel::Kind::kConductor;
  const Material& material = fit.material();
  const bool own = fit.lobes()[lobe].choices.fresnel == Fresnel::kConductor && share == 1;
  const std::size_t first = FirstFresnel(material.model, lobe);
  fresnel.eta.resize(ChannelsOf(fit));
  fresnel.k.resize(ChannelsOf(fit));
  for (std::size_t c = 0; c < ChannelsOf(fit); ++c) {
    const std::size_t channel = ChannelOf(fit, c);
    const ConductorIndex index =
        own ? ConductorIndex{material.parameters[first].values[channel], material.parameters[first + 1].values[channel]}
            : NearestConductor([&](double cos_d) { return fit.Fresnel(lobe, channel, cos_d) / share; });
    fresnel.eta[c] = index.eta;
    fresnel.k[c] = index.k;
  }
  return fresnel;
}

std::size_t StrongestLobe(const FittedBrdf& fit) {
  std::size_t strongest = 0;
  double largest = -1;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    double sum = 0;
    // A coat is no lobe of what lies below, unless it is the only one.
    const bool left_out = fit.lobes()[l].retro || (IsCoat(fit.lobes()[l].choices.fresnel) && fit.lobes().size() > 1);
    for (std::size_t c = 0; c < fit.material().channels.size() && !left_out; ++c) {
      sum += fit.Fresnel(l, c, 1);
    }
    if (sum > largest) largest = sum, strongest = l;
  }
  return strongest;
}

Spectrum DiffuseOf(const FittedBrdf& fit) { return fit.IsGrey() ? Spectrum(3, fit.diffuse()[0]) : fit.diffuse(); }

void DimBelowCoat(const FittedBrdf& fit, std::size_t coat, SurfaceFresnel* fresnel, Spectrum* diffuse) {
  const std::vector<double>& tau = fit.material().parameters[FirstFresnel(fit.material().model, coat) + 1].values;
  const double enters = 1 - fit.Fresnel(coat, 0, 1);
  for (std::size_t c = 0; c < ChannelsOf(fit); ++c) {
    const double kept = std::exp(-2 * tau[ChannelOf(fit, c)]);
    if (fresnel != nullptr) {
      fresnel->f0[c] *= enters * kept;
      fresnel->f90[c] *= enters * kept;
    }
    if (diffuse != nullptr) (*diffuse)[c] *= kept;
  }
}

Shares SharesOf(const FittedBrdf& fit) {
  Shares shares;
  const Spectrum diffuse = DiffuseOf(fit);
  shares.diffuse = fit.lobes().empty() ? 1.0 : std::clamp(*std::max_element(diffuse.begin(), diffuse.end()), 0.0, 0.99);
  double sum = 0;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const SurfaceLobe lobe = LobeOf(fit, l, 1);
    const double largest = *std::max_element(lobe.fresnel.f0.begin(), lobe.fresnel.f0.end());
    shares.lobes.push_back(largest < kNoReflectance || fit.lobes()[l].retro ? 0.0 : largest);
    sum += shares.lobes.back();
  }
  if (sum == 0) {
    shares.diffuse = 1;
    return shares;
  }
  for (double& share : shares.lobes) share *= (1 - shares.diffuse) / sum;
  return shares;
}

double CommonRotation(const FittedBrdf& fit) {
  double rotation = 0, largest = -1;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const double f0 = fit.Fresnel(l, 0, 1);
    if (fit.lobes()[l].anisotropic && f0 > largest) rotation = fit.lobes()[l].rotation, largest = f0;
  }
  return rotation;
}

}  // namespace lobefit
