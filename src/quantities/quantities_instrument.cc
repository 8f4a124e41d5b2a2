// The instrument: means over the discs of source and detector, a sample that lies crooked, gains, noise.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/core/instrument/asinh_residual.h"
#include "lobefit/core/instrument/ellipsoid_means.h"
#include "lobefit/core/instrument/gain.h"
#include "lobefit/core/instrument/ggx_mean.h"
#include "lobefit/core/instrument/misalignment.h"
#include "lobefit/core/microfacet/ellipsoid_brdf.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

void AddEllipsoidAndPair(Quantity* q, std::vector<std::string>* parameters) {
  q->inputs = EllipsoidColumns();
  *parameters = ParameterNames(*q);
  AddDirection(q, "o", "direction to the viewer, above the horizon");
  AddDirection(q, "i", "direction to the light, above the horizon");
  for (const std::size_t first : q->directions) {
    q->inputs[first + 2].low = 0;
    q->inputs[first + 2].low_open = true;
  }
  q->inputs.push_back(Positive("eta", "real part of the index"));
  q->inputs.push_back(Positive("k", "imaginary part of the index"));
}

// Column of the first disc that reaches the horizon.
std::optional<DomainError> DiscsStayAboveTheHorizon(const double* in) {
  constexpr std::size_t kViewer = 5, kLight = 8, kSource = 13, kDetector = 14;
  const auto reaches = [&](std::size_t direction, std::size_t half_angle) -> std::optional<DomainError> {
    const double elevation = std::asin(std::min(1.0, DirectionAt(in + direction).z));
    if (in[half_angle] < elevation) return std::nullopt;
    return DomainError{half_angle,
                       fmt::format("a half angle of {:g} reaches the horizon of a direction that stands {:g} above it; "
                                   "allowed: less than that",
                                   in[half_angle], elevation)};
  };
  if (const std::optional<DomainError> error = reaches(kLight, kSource)) return error;
  return reaches(kViewer, kDetector);
}

// The closed form with the nodes that reference values of it were made with.
double ClosedMeanD(const Ellipsoid& ellipsoid, const Vec3& wo, const Vec3& wi, const Aperture& aperture) {
  constexpr int kNodes = 8;
  return GgxMeanD(wi, wo, SlopeCoordinatesFromEllipsoid(ellipsoid),
                  MakeGgxMeanRule(aperture, kNodes, FresnelArgument::kCosine), nullptr);
}

Quantity ApertureQuantity() {
  Quantity q;
  q.name = "aperture_ggx";
  q.description =
      "means of D and f_r over the discs of source and detector, of the ellipsoid with a conductor's Fresnel "
      "reflectance";
  q.source = "quadrature; closed form by the vector irradiance of an elliptic cone";
  std::vector<std::string> parameters;
  AddEllipsoidAndPair(&q, &parameters);
  q.inputs.push_back(Within("delta_s", "rad", "half angle of the source's disc, 0: a point", 0, kPi / 4));
  q.inputs.push_back(Within("delta_d", "rad", "half angle of the detector's disc, 0: a point", 0, kPi / 4));
  q.results = {{"D_mean", "1/sr", "mean of the normal distribution at the half vector"},
               {"fr_mean", "1/sr", "mean of the BRDF"},
               {"flux_mean", "1/sr", "mean of the BRDF times both cosines, over the means of the cosines"}};
  for (const char* value : {"D_mean", "fr_mean", "flux_mean"}) AddDerivatives(&q, value, "1/sr", parameters);
  q.results.push_back({"fr_centre", "1/sr", "BRDF at the centres of the discs"});
  q.results.push_back({"D_closed", "1/sr", "mean of D in closed form, exact with one disc, by 8 nodes with both"});
  q.results.push_back({"clamped_i", "1", "1 where G1 of the centre's light is cut at 1", true});
  q.results.push_back({"clamped_o", "1", "1 where G1 of the centre's viewer is cut at 1", true});
  q.check = DiscsStayAboveTheHorizon;
  q.evaluate = [](const double* in, double* out) {
    const Ellipsoid e = EllipsoidAt(in);
    const Vec3 wo = DirectionAt(in + 5), wi = DirectionAt(in + 8);
    const ConductorIndex index = {in[11], in[12]};
    const Aperture aperture = {in[13], in[14]};
    const EllipsoidMeans means = QuadratureMeans(e, index, wo, wi, aperture);
    const EllipsoidMean* all[] = {&means.D, &means.fr, &means.flux};
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = all[k]->value;
      std::copy(all[k]->gradient, all[k]->gradient + kEllipsoidParameters, out + 3 + k * kEllipsoidParameters);
    }
    BrdfFactors factors;
    out[18] = EllipsoidConductorBrdf(e, index, wo, wi, Masking::kSmithSeparable, nullptr, &factors);
    out[19] = aperture.any() ? ClosedMeanD(e, wo, wi, aperture) : means.D.value;
    out[20] = factors.clamped_i ? 1 : 0;
    out[21] = factors.clamped_o ? 1 : 0;
  };
  return q;
}

// f_r and its kinds in extended precision: narrow lobes amplify the rounding of turned directions.
std::array<double, 3> ExtendedMisaligned(const double* in) {
  Real p[7];
  for (std::size_t k = 0; k < 5; ++k) p[k] = in[k];
  p[5] = in[11], p[6] = in[12];
  const MisalignmentT<Real> e = {in[13], in[14], in[15]};
  const auto unit = [&](std::size_t at) { return Normalized(Vec3T<Real>{in[at], in[at + 1], in[at + 2]}); };
  const Vec3T<Real> o = unit(5), i = unit(8), turned_o = InSampleFrame(e, o), turned_i = InSampleFrame(e, i);
  if (!(turned_o.z > 0 && turned_i.z > 0)) return {0, 0, 0};
  const Real f = EllipsoidConductorBrdfFormula(p, turned_o, turned_i, true);
  return {static_cast<double>(f), static_cast<double>(f * turned_i.z / i.z), static_cast<double>(f * turned_o.z / o.z)};
}

Quantity MisalignedQuantity() {
  Quantity q;
  q.name = "misaligned_brdf";
  q.description = "BRDF of a sample that is turned by Rz(e_z) Ry(e_y) Rx(e_x) under directions that do not know it";
  q.source = "[Walter] eq 4-6 at turned directions";
  std::vector<std::string> parameters;
  AddEllipsoidAndPair(&q, &parameters);
  const std::vector<std::string> turns = {"e_x", "e_y", "e_z"};
  for (const std::string& turn : turns)
    q.inputs.push_back(AnyNumber(turn, "rad", std::string("turn of the sample about ") + turn.back()));
  parameters.insert(parameters.begin(), turns.begin(), turns.end());
  q.results = {{"fr", "1/sr", "BRDF at the turned directions; 0 where one is at or below the sample's horizon"},
               {"fr_ci", "1/sr", "the same as radiance over the nominal irradiance: times cos_i' / cos_i"},
               {"fr_co", "1/sr", "the same as flux over the nominal cosine: times cos_o' / cos_o"}};
  for (const char* value : {"fr", "fr_ci", "fr_co"}) AddDerivatives(&q, value, "1/sr", parameters);
  q.results.push_back({"clamped_i", "1", "1 where G1 of the turned light is cut at 1", true});
  q.results.push_back({"clamped_o", "1", "1 where G1 of the turned viewer is cut at 1", true});
  q.evaluate = [](const double* in, double* out) {
    constexpr ValueKind kKinds[] = {ValueKind::kBrdf, ValueKind::kRadiance, ValueKind::kFlux};
    const std::array<double, 3> values = ExtendedMisaligned(in);
    BrdfFactors factors;
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = values[k];
      MisalignedConductorBrdf(EllipsoidAt(in), {in[11], in[12]}, DirectionAt(in + 5), DirectionAt(in + 8),
                              {in[13], in[14], in[15]}, kKinds[k], out + 3 + 8 * k, &factors);
    }
    out[27] = factors.clamped_i ? 1 : 0;
    out[28] = factors.clamped_o ? 1 : 0;
  };
  return q;
}

constexpr std::size_t kGainSamples = 8;

void AddNumbered(Quantity* q, const std::string& prefix, const std::string& unit, const std::string& meaning,
                 bool positive) {
  for (std::size_t k = 0; k < kGainSamples; ++k) {
    const std::string name = prefix + std::to_string(k);
    InputColumn column = positive ? Positive(name, meaning) : AnyNumber(name, unit, meaning);
    column.unit = unit;
    q->inputs.push_back(column);
  }
}

Quantity GainQuantity() {
  Quantity q;
  q.name = "gain_profile";
  q.description = "cost of eight samples of one incidence with its gain, which has a prior, solved for";
  q.source = "least squares with a normal prior; asinh stabilises a noise with a floor and a relative part";
  q.inputs = {Positive("s", "standard deviation of the gain's prior"), Positive("knee", "knee of the metric asinh"),
              Positive("rho", "relative noise, the residual's unit")};
  AddNumbered(&q, "f", "1/sr", "value of the model", true);
  AddNumbered(&q, "y", "1/sr", "reading", false);
  AddNumbered(&q, "sd", "1/sr", "standard deviation of the reading, of the linear form", true);
  q.inputs[1].unit = "1/sr";
  q.results = {{"g", "1", "best gain of the linear residual (g f - y) / sd"},
               {"cost", "1", "sum of squares with the prior's, linear"},
               {"ln_g", "1", "logarithm of the best gain of (asinh(g f / knee) - asinh(y / knee)) / rho"},
               {"cost_asinh", "1", "sum of squares with the prior's, asinh"}};
  std::vector<std::string> values;
  for (std::size_t k = 0; k < kGainSamples; ++k) values.push_back("f" + std::to_string(k));
  AddDerivatives(&q, "cost", "1", values);
  AddDerivatives(&q, "cost_asinh", "1", values);
  q.evaluate = [](const double* in, double* out) {
    Real f[kGainSamples], y[kGainSamples], sd[kGainSamples], by_f[kGainSamples];
    for (std::size_t k = 0; k < kGainSamples; ++k) {
      f[k] = in[3 + k];
      y[k] = in[3 + kGainSamples + k];
      sd[k] = in[3 + 2 * kGainSamples + k];
    }
    const auto put = [&](const ProfiledGain<Real>& profile, std::size_t at, std::size_t derivatives) {
      out[at] = static_cast<double>(profile.gain);
      out[at + 1] = static_cast<double>(profile.cost);
      for (std::size_t k = 0; k < kGainSamples; ++k) out[derivatives + k] = static_cast<double>(by_f[k]);
    };
    put(ProfileLinearGain<Real>(f, y, sd, kGainSamples, in[0], by_f), 0, 4);
    put(ProfileAsinhGain<Real>(f, y, kGainSamples, in[1], in[2], in[0], by_f), 2, 4 + kGainSamples);
  };
  return q;
}

Quantity AsinhQuantity() {
  Quantity q;
  q.name = "asinh_residual";
  q.description =
      "residual that a noise with a floor and a relative part leaves of the same size everywhere, and the weights of "
      "other metrics";
  q.source = "variance-stabilising transform of s^2 = s0^2 + (rho v)^2; delta method";
  q.inputs = {AnyNumber("m", "1/sr", "reading, f_r cos_theta_i"),
              Within("v", "1/sr", "value of the model", 0, HUGE_VAL), Positive("s0", "floor of the noise"),
              Positive("rho", "relative noise")};
  q.inputs[2].unit = "1/sr";
  q.results = {{"knee", "1/sr", "s0 / rho"},
               {"T_v", "1", "asinh(v / knee)"},
               {"T_m", "1", "asinh(m / knee)"},
               {"r", "1", "T_v - T_m"},
               {"r_corrected", "1", "r less the mean that the noise gives T_m"}};
  AddDerivatives(&q, "r", "1", {"v"});
  AddDerivatives(&q, "r_corrected", "1", {"v"});
  AddDerivatives(&q, "r", "1", {"m"});
  q.results.push_back({"sd", "1/sr", "standard deviation of a reading of v"});
  q.results.push_back({"pearson", "1", "(m - v) / sd"});
  q.results.push_back({"w_log", "1", "weight of a squared residual of ln(1 + v)"});
  q.results.push_back({"w_cube_root", "1", "weight of a squared residual of the cube root"});
  q.results.push_back({"w_relative", "1", "weight of a squared residual relative to v"});
  q.results.push_back({"w_cosine_l2", "sr^2", "weight of a squared residual of v"});
  q.evaluate = [](const double* in, double* out) {
    const Real m = in[0], v = in[1];
    const NoiseModelT<Real> noise = {in[2], in[3]};
    const AsinhResidual<Real> r = EvaluateAsinhResidual(noise, v, m);
    const MetricWeights<Real> w = WeightsAt(noise, v);
    const Real all[] = {
        noise.knee(),   r.of_model,      r.of_measured,  r.residual,         r.corrected,
        r.dresidual_dv, r.dcorrected_dv, r.dresidual_dm, noise.Deviation(v), (m - v) / noise.Deviation(v),
        w.log,          w.cube_root,     w.relative,     w.cosine_l2};
    for (std::size_t k = 0; k < std::size(all); ++k) out[k] = static_cast<double>(all[k]);
  };
  return q;
}

}  // namespace

std::vector<Quantity> InstrumentQuantities() {
  return {ApertureQuantity(), MisalignedQuantity(), GainQuantity(), AsinhQuantity()};
}

}  // namespace lobefit
