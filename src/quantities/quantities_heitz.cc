// [Heitz] slope distributions, Smith masking and the V-cavity model.
#include <algorithm>
#include <cmath>

#include "lobefit/core/masking/g2.h"
#include "lobefit/core/radial/smith.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

Quantity OfSlopes(const char* name, const char* description, const char* source) {
  Quantity q;
  q.name = name;
  q.description = description;
  q.source = source;
  q.inputs = SlopeColumns();
  return q;
}

Quantity OffCenterDQuantity() {
  Quantity q = OfSlopes("offcenter_D", "Beckmann or GGX distribution of slopes: anisotropic, correlated, off-centre",
                        "[Heitz] eq 64, 67, 70, 81, 84, 87-95");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "m", "micro normal; both are 0 at and below the horizon");
  q.results = {{"P22", "1", "density of slopes"}, {"D", "1/sr", "normal distribution, P22 / m_z^4"}};
  AddDerivatives(&q, "D", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Vec3 m = DirectionAt(in + 6);
    out[1] = SlopeDistributionD(SlopesAt(in), m, out + 2);
    const double zz = m.z * m.z;
    out[0] = out[1] * (zz * zz);
  };
  return q;
}

Quantity SmithLambdaQuantity() {
  Quantity q = OfSlopes("smith_lambda", "Smith masking of a distribution of slopes",
                        "[Heitz] eq 69, 72, 83, 86, 96, 97; [Loubet] eq 1");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "u", "direction");
  q.results = MaskingColumns();
  q.results.push_back({"G1_clamped", "1", "min(1, |u.n| / sigma)"});
  q.results.push_back({"clamped", "1", "1 where the minimum is 1", true});
  AddDerivatives(&q, "Lambda", "1", parameters);
  AddDerivatives(&q, "sigma", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const SlopeDistribution s = SlopesAt(in);
    const Vec3 u = DirectionAt(in + 6);
    const ProjectedSlopes p = ExtendedProjection(in + 1, in + 6);
    bool clamped = false;
    out[0] = p.c;
    out[1] = p.q;
    out[2] = p.a;
    out[3] = SmithLambda(s, u, out + 7);
    out[4] = SmithSigma(s, u, out + 12);
    out[5] = SmithG1Clamped(s, u, nullptr, &clamped);
    out[6] = clamped ? 1 : 0;
  };
  return q;
}

constexpr Masking kG2Kinds[] = {Masking::kSmithSeparable, Masking::kSmithHeight, Masking::kSmithDirection,
                                Masking::kSmithHeightDirection};

Quantity G2Quantity() {
  Quantity q = OfSlopes("g2", "Smith masking and shadowing of two directions", "[Heitz] eq 98-101, eq 100 corrected");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "o", "direction to the viewer, on the front of the mean surface");
  AddDirection(&q, "i", "direction to the light, on the front of the mean surface");
  q.results = {{"Lambda_o", "1", "Lambda of the viewer"},
               {"Lambda_i", "1", "Lambda of the light"},
               {"phi", "rad", "angle between the azimuths"},
               {"lambda", "1", "van Ginneken's 4.41 phi / (4.41 phi + 1)"},
               {"G2_separable", "1", "[Heitz] eq 98"},
               {"G2_height", "1", "[Heitz] eq 99, height-correlated"},
               {"G2_direction", "1", "[Heitz] eq 100, direction-correlated"},
               {"G2_height_direction", "1", "[Heitz] eq 101, both"}};
  for (std::size_t i = 4; i < 8; ++i) AddDerivatives(&q, q.results[i].name, "1", parameters);
  q.check = [](const double* in) -> std::optional<DomainError> {
    for (const std::size_t first : {6U, 9U}) {
      if (!(in[first + 2] - in[4] * in[first] - in[5] * in[first + 1] > 0)) {
        return DomainError{first + 2,
                           "the direction sees the back of the mean surface, where Lambda is negative; allowed: "
                           "z - slope_x x - slope_y y > 0"};
      }
    }
    return std::nullopt;
  };
  q.evaluate = [](const double* in, double* out) {
    const SlopeDistribution s = SlopesAt(in);
    const Vec3 o = DirectionAt(in + 6), i = DirectionAt(in + 9);
    double dLambda_o[kSlopeParameters], dLambda_i[kSlopeParameters];
    SmithLambda(s, o, dLambda_o);
    SmithLambda(s, i, dLambda_i);
    out[0] = SmithLambdaOfA(s.family, ExtendedProjection(in + 1, in + 6).a);
    out[1] = SmithLambdaOfA(s.family, ExtendedProjection(in + 1, in + 9).a);
    out[2] = AzimuthDifference(o, i);
    out[3] = VanGinnekenLambda(out[2]);
    for (int kind = 0; kind < 4; ++kind) {
      SmithG2Gradient g;
      out[4 + kind] = SmithG2(kG2Kinds[kind], out[0], out[1], out[3], &g);
      for (int k = 0; k < kSlopeParameters; ++k) {
        out[8 + kSlopeParameters * kind + k] = g.dLambda_o * dLambda_o[k] + g.dLambda_i * dLambda_i[k];
      }
    }
  };
  return q;
}

Quantity VCavityQuantity() {
  Quantity q;
  q.name = "vcavity";
  q.description = "V-cavity masking of two directions";
  q.source = "[Heitz] eq 49 with X+(w.m), eq 50";
  for (const char* what : {"o", "i", "m"}) {
    const std::string of = what[0] == 'o' ? "the viewer" : what[0] == 'i' ? "the light" : "the micro normal";
    q.inputs.push_back(Within(std::string("theta_") + what, "rad", "polar angle of " + of, 0, 0.5 * kPi));
    q.inputs.push_back(AnyNumber(std::string("phi_") + what, "rad", "azimuth of " + of));
  }
  q.results = {{"G1_o", "1", "masking of the viewer"},
               {"G1_i", "1", "masking of the light"},
               {"G2", "1", "the smaller of both"}};
  AddDerivatives(&q, "G1o", "1", ParameterNames(q));
  AddDerivatives(&q, "G2", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    const VCavityValues v = VCavity({in[0], in[1], in[2], in[3], in[4], in[5]}, out + 3, out + 9);
    out[0] = v.G1_o;
    out[1] = v.G1_i;
    out[2] = v.G2;
  };
  return q;
}

}  // namespace

std::vector<Quantity> HeitzQuantities() {
  return {OffCenterDQuantity(), SmithLambdaQuantity(), G2Quantity(), VCavityQuantity()};
}

}  // namespace lobefit
