// Free radial profiles and Student's distribution of slopes. Masking by the quadrature itself, not by the table that a
// fit interpolates: with more points, so that steep tails keep their digits.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "lobefit/core/ndf/student.h"
#include "lobefit/core/radial/profile_masking.h"
#include "lobefit/core/radial/smith.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

using SplinePointer = std::shared_ptr<const ProfileSpline>;

// Knots of profile_D, profile_sigma and profile_brdf, and those of profile_radial.
const SplinePointer& DefaultSpline() {
  static const SplinePointer spline = std::make_shared<const ProfileSpline>(std::vector<double>{0, 1, 2, 4, 8, 16, 32});
  return spline;
}
const SplinePointer& RadialSpline() {
  static const SplinePointer spline =
      std::make_shared<const ProfileSpline>(std::vector<double>{0, 0.5, 1, 2, 4, 8, 16, 32, 64});
  return spline;
}
const SplinePointer& PowerLawSpline() {
  static const SplinePointer spline = std::make_shared<const ProfileSpline>(ProfileSpline::PowerLaw());
  return spline;
}

void AddCoefficients(Quantity* q, std::size_t count) {
  for (std::size_t k = 1; k <= count; ++k) {
    q->inputs.push_back(AnyNumber("q" + std::to_string(k), "1",
                                  k < count ? "coefficient of the local exponent" : "exponent of the tail less 2"));
    if (k == count) {
      q->inputs.back().low = -0.5;
      q->inputs.back().low_open = true;
    }
  }
}

SlopeDistribution SlopesOf(const double* in) { return {Family::kGgx, in[0], in[1], in[2], in[3], in[4]}; }

Profile ProfileOf(const SplinePointer& spline, const double* q) { return {spline, {q, q + spline->size()}}; }

// t of a direction below which the slopes have the five parameters `in`, in extended precision: the offset from the
// mean slope is a small difference near it. Infinite at the horizon.
double ExtendedRadius(const double* in, const double* m) {
  if (m[2] == 0) return HUGE_VAL;
  const Real x = (Real{m[0]} / m[2] + in[3]) / in[0], y = (Real{m[1]} / m[2] + in[4]) / in[1], r = in[2];
  return static_cast<double>(((x - y) * (x - y) / (1 - r) + (x + y) * (x + y) / (1 + r)) / 2);
}

// M, T at |a| and the derivatives of M by q.
struct Moments {
  double m, tail;
  std::vector<double> dm;
};
Moments MomentsAt(const Profile& profile, double a) {
  static const QuadratureRule rule = GaussLegendre(32);
  const std::size_t K = profile.q().size(), stride = K + 1;
  std::vector<double> moments(3 * stride);
  ProfileRule(profile.spline(), a, rule, 8)
      .Apply(profile, ProfileTail(profile.tail_exponent()), false, moments.data(), stride);
  return {moments[0], moments[stride], {moments.begin() + 1, moments.begin() + static_cast<std::ptrdiff_t>(stride)}};
}

// sigma = sqrt(q) S(a) and Lambda = S / a - 1 with their derivatives by the five of the slopes and by the profile.
struct MaskingTerms {
  ProjectedSlopes at;
  double Lambda, sigma;
  std::vector<double> dLambda, dsigma;
};
MaskingTerms MaskingAt(const Profile& profile, const SlopeDistribution& slopes, const Vec3& u,
                       const ProjectedSlopes& at) {
  MaskingTerms result = {at, 0, 0, {}, {}};
  double dc[kSlopeParameters], dq[kSlopeParameters];
  ProjectSlopes(slopes, u, dc, dq);
  const double root = std::sqrt(at.q), a = std::abs(at.a);
  const Moments moments = MomentsAt(profile, a);
  const bool front = at.a > 0;
  const double S_slope = front ? 1.0 - moments.tail : moments.tail;
  const double in_q = 0.5 * (moments.m + a * moments.tail) / root;  // S - a S'
  const double Lambda_slope = (front ? -1.0 : 1.0) * (moments.tail + moments.m / a) / at.a;
  result.sigma = front ? at.c + root * moments.m : root * moments.m;
  result.Lambda = moments.m / at.a - (front ? 0.0 : 1.0);
  for (int k = 0; k < kSlopeParameters; ++k) {
    result.dsigma.push_back(S_slope * dc[k] + in_q * dq[k]);
    result.dLambda.push_back(Lambda_slope * (dc[k] - 0.5 * at.c * dq[k] / at.q) / root);
  }
  for (const double dm : moments.dm) {
    result.dsigma.push_back(root * dm);
    result.dLambda.push_back(dm / at.a);
  }
  return result;
}

Quantity ProfileDQuantity() {
  Quantity q;
  q.name = "profile_D";
  q.description = "distribution of normals with a free radial profile, knots at r = 0 1 2 4 8 16 32";
  q.source = "MATH.md 8.1; [Heitz] eq 87-95";
  q.inputs = SlopeShapeColumns();
  AddCoefficients(&q, DefaultSpline()->size());
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "m", "micro normal; all but t and ln_f are 0 at and below the horizon");
  q.results = {{"t", "1", "squared distance from the mean slope in units of the ellipse"},
               {"ln_f", "1", "logarithm of the profile, 0 at the mean slope"},
               {"P22", "1", "density of slopes"},
               {"D", "1/sr", "normal distribution, P22 / m_z^4"}};
  AddDerivatives(&q, "D", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    const SlopeDistribution slopes = SlopesOf(in);
    const Profile profile = ProfileOf(DefaultSpline(), in + 5);
    const Vec3 m = DirectionAt(in + 11);
    out[3] = ProfileD(profile, slopes, m, out + 4);
    out[0] = ExtendedRadius(in, in + 11);
    const double u = std::log1p(out[0]);
    out[1] = std::isinf(u) ? -u : profile.Excess(u) - 2.0 * u;
    const double zz = m.z * m.z;
    out[2] = out[3] * (zz * zz);
  };
  return q;
}

Quantity ProfileSigmaQuantity() {
  Quantity q;
  q.name = "profile_sigma";
  q.description = "projected area and Smith masking of a free radial profile, knots at r = 0 1 2 4 8 16 32";
  q.source = "MATH.md 8.1; [Heitz] eq 96; [Loubet] eq 1";
  q.inputs = SlopeShapeColumns();
  AddCoefficients(&q, DefaultSpline()->size());
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "u", "direction");
  q.results = MaskingColumns();
  q.results.push_back({"G1_clamped", "1", "min(1, |u.n| / sigma)"});
  q.results.push_back({"clamped", "1", "1 where the minimum is 1", true});
  AddDerivatives(&q, "sigma", "1", parameters);
  AddDerivatives(&q, "Lambda", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Vec3 u = DirectionAt(in + 11);
    const MaskingTerms m =
        MaskingAt(ProfileOf(DefaultSpline(), in + 5), SlopesOf(in), u, ExtendedProjection(in, in + 11));
    out[0] = m.at.c;
    out[1] = m.at.q;
    out[2] = m.at.a;
    out[3] = m.Lambda;
    out[4] = m.sigma;
    const bool clamped = std::abs(u.z) > m.sigma;
    out[5] = clamped ? 1.0 : std::abs(u.z) / m.sigma;
    out[6] = clamped ? 1 : 0;
    std::copy(m.dsigma.begin(), m.dsigma.end(), out + 7);
    std::copy(m.dLambda.begin(), m.dLambda.end(), out + 18);
  };
  return q;
}

Quantity ProfileBrdfQuantity() {
  Quantity q;
  q.name = "profile_brdf";
  q.description = "specular factor of a free radial profile without Fresnel term, separable Smith masking";
  q.source = "MATH.md 8.1; [Heitz] eq 29, 98, 99";
  q.inputs = SlopeShapeColumns();
  AddCoefficients(&q, DefaultSpline()->size());
  const std::vector<std::string> parameters = ParameterNames(q);
  AddUpperDirection(&q, "o", "direction to the viewer");
  AddUpperDirection(&q, "i", "direction to the light");
  q.results = {{"D", "1/sr", "normal distribution at the half vector"},
               {"sigma_o", "1", "projected area seen by the viewer"},
               {"sigma_i", "1", "projected area seen by the light"},
               {"G1_o", "1", "masking of the viewer, at most 1"},
               {"G1_i", "1", "masking of the light, at most 1"},
               {"clamped_o", "1", "1 where G1_o is cut at 1", true},
               {"clamped_i", "1", "1 where G1_i is cut at 1", true},
               {"specular", "1/sr", "D G1_o G1_i / (4 o_z i_z)"},
               {"specular_height", "1/sr", "the same with height-correlated masking"}};
  AddDerivatives(&q, "specular", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    const SlopeDistribution slopes = SlopesOf(in);
    const Profile profile = ProfileOf(DefaultSpline(), in + 5);
    const Vec3 directions[2] = {DirectionAt(in + 11), DirectionAt(in + 14)};
    std::array<double, 11> dD;
    out[0] = ProfileD(profile, slopes, Normalized(directions[0] + directions[1]), dD.data());
    double area[2], cosine[2];
    MaskingTerms masking[2];
    for (std::size_t w = 0; w < 2; ++w) {
      masking[w] = MaskingAt(profile, slopes, directions[w], ExtendedProjection(in, in + 11 + 3 * w));
      cosine[w] = directions[w].z;
      const bool clamped = cosine[w] > masking[w].sigma;
      area[w] = clamped ? cosine[w] : masking[w].sigma;
      out[1 + w] = masking[w].sigma;
      out[3 + w] = cosine[w] / area[w];
      out[5 + w] = clamped ? 1 : 0;
    }
    out[7] = out[0] / (4.0 * area[0] * area[1]);
    out[8] = out[0] / (4.0 * (area[0] * cosine[1] + (area[1] - cosine[1]) * cosine[0]));
    for (std::size_t k = 0; k < dD.size(); ++k) {
      out[9 + k] = dD[k] / (4.0 * area[0] * area[1]);
      for (std::size_t w = 0; w < 2; ++w) {
        if (out[5 + w] == 0) out[9 + k] -= out[7] * masking[w].dsigma[k] / area[w];
      }
    }
  };
  return q;
}

Quantity ProfileRadialQuantity() {
  Quantity q;
  q.name = "profile_radial";
  q.description = "profile, its density and its masking in one dimension, knots at r = 0 .5 1 2 4 8 16 32 64";
  q.source = "MATH.md 8.1";
  q.inputs = {AnyNumber("t", "1", "squared distance from the mean slope in units of the ellipse"),
              AnyNumber("a", "1", "c / sqrt(q), signed, not 0")};
  q.inputs[0].low = 0;
  AddCoefficients(&q, RadialSpline()->size());
  std::vector<std::string> coefficients = ParameterNames(q);
  coefficients.erase(coefficients.begin(), coefficients.begin() + 2);
  q.results = {{"ln_f", "1", "logarithm of the profile"},
               {"p", "1", "density f / Z"},
               {"S", "1", "sigma / sqrt(q)"},
               {"Lambda", "1", "Smith's Lambda(a)"}};
  AddDerivatives(&q, "p", "1", {"t"});
  AddDerivatives(&q, "p", "1", coefficients);
  AddDerivatives(&q, "S", "1", {"a"});
  AddDerivatives(&q, "S", "1", coefficients);
  q.check = [](const double* in) -> std::optional<DomainError> {
    if (in[1] != 0) return std::nullopt;
    return DomainError{1, "Lambda has a pole at 0; allowed: any other finite number"};
  };
  q.evaluate = [](const double* in, double* out) {
    const Profile profile = ProfileOf(RadialSpline(), in + 2);
    const std::size_t K = profile.q().size();
    const double u = std::log1p(in[0]), a = in[1];
    double g;
    out[0] = profile.Excess(u, &g) - 2.0 * u;
    out[1] = std::exp(out[0]) * kInvPi / (1.0 + profile.mass_excess());
    const Moments moments = MomentsAt(profile, std::abs(a));
    out[2] = a > 0 ? a + moments.m : moments.m;
    out[3] = moments.m / a - (a > 0 ? 0.0 : 1.0);
    out[4] = -g * out[1] / (1.0 + in[0]);
    profile.spline().Evaluate(u, out + 5);
    for (std::size_t k = 0; k < K; ++k) out[5 + k] = out[1] * (out[5 + k] - profile.dlog_mass()[k]);
    out[5 + K] = a > 0 ? 1.0 - moments.tail : moments.tail;
    std::copy(moments.dm.begin(), moments.dm.end(), out + 6 + K);
  };
  return q;
}

InputColumn GammaColumn() {
  InputColumn gamma = Positive("gamma", "exponent of the tail; 2 is GGX");
  gamma.low = 1.5;
  return gamma;
}

std::vector<InputColumn> StudentColumns() {
  std::vector<InputColumn> columns = {GammaColumn()};
  for (const InputColumn& column : SlopeShapeColumns()) columns.push_back(column);
  return columns;
}

Quantity StudentDQuantity() {
  Quantity q;
  q.name = "student_D";
  q.description = "distribution of normals whose slopes follow Student's distribution";
  q.source = "[Ribardiere 2017]; MATH.md 8.2";
  q.inputs = StudentColumns();
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "m", "micro normal; D is 0 at and below the horizon");
  q.results = {{"D", "1/sr", "normal distribution"}};
  AddDerivatives(&q, "D", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    out[0] = StudentD(in[0], SlopesOf(in + 1), DirectionAt(in + 6), out + 1);
    std::rotate(out + 1, out + 6, out + 7);  // gamma first
  };
  return q;
}

Quantity StudentSigmaQuantity() {
  Quantity q;
  q.name = "student_sigma";
  q.description = "projected area and Smith's Lambda of Student's distribution of slopes";
  q.source = "[Ribardiere 2017]; MATH.md 8.2";
  q.inputs = StudentColumns();
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "u", "direction");
  q.results = MaskingColumns();
  AddDerivatives(&q, "sigma", "1", parameters);
  AddDerivatives(&q, "Lambda", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const double gamma = in[0], rest = gamma - 1.0, scale = std::sqrt(rest);
    const SlopeDistribution slopes = SlopesOf(in + 1);
    const Vec3 u = DirectionAt(in + 6);
    const ProjectedSlopes at = ExtendedProjection(in + 1, in + 6);
    // The power law's, of a / sqrt(gamma - 1).
    const ProjectedSlopes scaled = {at.c, at.q * rest, at.a / scale};
    const Profile profile(PowerLawSpline(), {gamma - 2.0});
    const MaskingTerms m = MaskingAt(profile, PowerLawSlopes(gamma, slopes), u, scaled);
    out[0] = at.c;
    out[1] = at.q;
    out[2] = at.a;
    out[3] = m.Lambda;
    out[4] = m.sigma;
    const auto derivatives = [&](const std::vector<double>& d, double* to) {
      for (std::size_t k = 0; k < kSlopeParameters; ++k) to[k + 1] = d[k] * (k < 2 ? scale : 1.0);
      to[0] = d[kSlopeParameters] + 0.5 * (slopes.alpha_x * to[1] + slopes.alpha_y * to[2]) / rest;
    };
    derivatives(m.dsigma, out + 5);
    derivatives(m.dLambda, out + 11);
  };
  return q;
}

}  // namespace

std::vector<Quantity> ProfileQuantities() {
  return {ProfileDQuantity(),      ProfileSigmaQuantity(), ProfileBrdfQuantity(),
          ProfileRadialQuantity(), StudentDQuantity(),     StudentSigmaQuantity()};
}

}  // namespace lobefit
