// [Walter] the ellipsoid distribution, its BRDF and its visible normals; also the conductor's Fresnel reflectance.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/core/ellipsoid/weighted_form.h"
#include "lobefit/core/masking/lune.h"
#include "lobefit/core/microfacet/ellipsoid_brdf.h"
#include "lobefit/core/microfacet/energy.h"
#include "lobefit/core/microfacet/vndf.h"
#include "lobefit/math/vec.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

Quantity OfEllipsoid(const char* name, const char* description, const char* source) {
  Quantity q;
  q.name = name;
  q.description = description;
  q.source = source;
  q.inputs = EllipsoidColumns();
  return q;
}

Quantity EllipsoidDQuantity() {
  Quantity q = OfEllipsoid("ellipsoid_D", "normal distribution of the ellipsoid", "[Walter] eq 1-3");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "m", "micro normal; D is 0 below the horizon");
  q.results = {{"D", "1/sr", "normal distribution, int D (m.n) dm = 1"}};
  AddDerivatives(&q, "D", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    out[0] = EllipsoidD(EllipsoidAt(in), DirectionAt(in + 5), out + 1);
  };
  return q;
}

// c = (A n).(A u) / |A n|^2: its terms cancel where the mean surface is seen edge-on, hence extended precision.
double MesoCosine(const double* in) {
  const Real p[5] = {in[0], in[1], in[2], in[3], in[4]};
  const Mat3T<Real> r = EllipsoidRotation(p);
  const Vec3T<Real> u = r * Vec3T<Real>{in[5], in[6], in[7]}, n = {r.row[0].z, r.row[1].z, r.row[2].z};
  const Real length = std::sqrt(Real{in[5]} * in[5] + Real{in[6]} * in[6] + Real{in[7]} * in[7]);
  const auto form = [&](const Vec3T<Real>& w) { return p[0] * p[0] * w.x * n.x + p[1] * p[1] * w.y * n.y + w.z * n.z; };
  return static_cast<double>(form(u) / (form(n) * length));
}

Quantity EllipsoidG1Quantity() {
  Quantity q = OfEllipsoid("ellipsoid_G1", "projected area and Smith masking of the ellipsoid",
                           "[Walter] eq 6, 26, 29; [Loubet] eq 1");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "u", "direction");
  q.results = {{"sigma", "1", "int D(m) <m.u> dm"},
               {"G1_unclamped", "1", "|u.n| / sigma"},
               {"G1", "1", "min(1, |u.n| / sigma)"},
               {"clamped", "1", "1 where the minimum is 1", true},
               {"meso_c", "1", "(mean normal . u) / (mean normal . n)"}};
  AddDerivatives(&q, "G1u", "1", parameters);
  AddDerivatives(&q, "sigma", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Ellipsoid e = EllipsoidAt(in);
    const Vec3 u = DirectionAt(in + 5);
    bool clamped = false;
    out[0] = EllipsoidSigma(e, u, out + 10);
    out[1] = EllipsoidG1Unclamped(e, u, out + 5);
    out[2] = EllipsoidG1(e, u, nullptr, &clamped);
    out[3] = clamped ? 1 : 0;
    out[4] = MesoCosine(in);
  };
  return q;
}

Quantity LuneQuantity() {
  Quantity q = OfEllipsoid("lune_area", "projected area of the part of the ellipsoid that faces two directions",
                           "[Walter] eq 24, 26 with the scale of eq 27");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "u", "direction along which the area is projected");
  AddDirection(&q, "v", "second direction that the part faces");
  q.results = {{"A_e_u", "1", "projected area of the whole ellipsoid, A_e(n) = 1"},
               {"A_l_uv", "1", "projected area of the lune"}};
  AddDerivatives(&q, "Al", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Ellipsoid e = EllipsoidAt(in);
    const Vec3 u = DirectionAt(in + 5);
    out[0] = EllipsoidProjectedArea(e, u);
    out[1] = EllipsoidLuneArea(e, u, DirectionAt(in + 8), out + 2);
  };
  return q;
}

// Mean slope and Q^-1 as off_center.cc has them, in extended precision: each entry can be a small difference.
void ExtendedOffCenter(const double* in, double* out) {
  const Real p[5] = {in[0], in[1], in[2], in[3], in[4]};
  const Mat3T<Real> columns = Transposed(EllipsoidRotation(p));
  const Vec3T<Real>&r1 = columns.row[0], &r2 = columns.row[1], &n = columns.row[2];
  const FormWeightsT<Real> shape = ShapeWeights(p[0], p[1]), cofactor = CofactorWeights(p[0], p[1]);
  const Real m33 = Form(shape, n, n), square = m33 * m33;
  const Real q11 = Form(cofactor, r2, r2) / square, q22 = Form(cofactor, r1, r1) / square;
  const Real q12 = -FormOfPerpendicular(cofactor, r1, r2) / square;
  const Real values[8] = {-FormOfPerpendicular(shape, r1, n) / m33,
                          -FormOfPerpendicular(shape, r2, n) / m33,
                          q11,
                          q12,
                          q22,
                          std::sqrt(q11),
                          std::sqrt(q22),
                          q12 / std::sqrt(q11 * q22)};
  for (int k = 0; k < 8; ++k) out[k] = static_cast<double>(values[k]);
}

Quantity ToOffCenterQuantity() {
  Quantity q = OfEllipsoid("offcenter_from_ellipsoid", "the ellipsoid as an off-centre, correlated GGX of slopes",
                           "[Heitz] eq 88, 95; [Loubet] sec 2");
  const std::vector<std::string> parameters = ParameterNames(q);
  q.results = {{"slope_x", "1", "mean slope along x"},
               {"slope_y", "1", "mean slope along y"},
               {"q11", "1", "shape matrix of the slopes, xx"},
               {"q12", "1", "shape matrix, xy"},
               {"q22", "1", "shape matrix, yy"},
               {"slope_alpha_x", "1", "sqrt(q11)"},
               {"slope_alpha_y", "1", "sqrt(q22)"},
               {"slope_r", "1", "q12 / sqrt(q11 q22)"}};
  for (std::size_t i = 0; i < 5; ++i) AddDerivatives(&q, q.results[i].name, "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    OffCenterFromEllipsoid(EllipsoidAt(in), out + 8);
    ExtendedOffCenter(in, out);
  };
  return q;
}

// By way of the fitting coordinates ln a, b, ln c of Q^-1 = L L^T: their root keeps its digits for correlations near 1.
void EvaluateFromOffCenter(const double* in, double* out) {
  const double alpha_x = in[2], alpha_y = in[3], r = in[4], rest = (1 - r) * (1 + r);
  const SlopeCoordinates s = {
      {in[0], in[1], std::log(alpha_x), r * alpha_y, std::log(alpha_y) + 0.5 * (std::log1p(-r) + std::log1p(r))}};
  double jacobian[25];
  const Ellipsoid e = EllipsoidFromSlopeCoordinates(s, jacobian);
  const double values[5] = {e.alpha_x, e.alpha_y, e.theta_x, e.theta_y, e.theta_z};
  std::copy(values, values + 5, out);
  for (int k = 0; k < 5; ++k) {
    const double* row = jacobian + 5 * k;
    double* to = out + 5 + 5 * k;
    to[0] = row[0];
    to[1] = row[1];
    to[2] = row[2] / alpha_x;
    to[3] = row[3] * r + row[4] / alpha_y;
    to[4] = row[3] * alpha_y - row[4] * r / rest;
  }
}

Quantity FromOffCenterQuantity() {
  Quantity q;
  q.name = "ellipsoid_from_offcenter";
  q.description = "an off-centre, correlated GGX of slopes as an ellipsoid, in canonical form";
  q.source = "[Walter] eq 1-3; [Heitz] eq 88, 95";
  q.inputs = {AnyNumber("slope_x", "1", "mean slope along x"), AnyNumber("slope_y", "1", "mean slope along y"),
              Positive("slope_alpha_x", "roughness of the slopes along x"),
              Positive("slope_alpha_y", "roughness of the slopes along y"),
              Within("slope_r", "1", "correlation of the slopes", -1, 1, true, true)};
  const std::vector<std::string> parameters = ParameterNames(q);
  for (const InputColumn& column : EllipsoidColumns()) {
    q.results.push_back({column.name, column.unit, column.meaning});
  }
  for (std::size_t i = 0; i < 5; ++i) AddDerivatives(&q, q.results[i].name, q.results[i].unit, parameters);
  q.evaluate = EvaluateFromOffCenter;
  return q;
}

InputColumn ImaginaryIndex() {
  return Within("k", "1", "imaginary part of the index, 0 of a dielectric", 0, std::numeric_limits<double>::infinity(),
                false, true);
}

Quantity FresnelQuantity() {
  Quantity q;
  q.name = "fresnel";
  q.description = "reflectance of a smooth conductor, unpolarised light";
  q.source = "Fresnel's equations for the complex index eta + i k";
  q.inputs = {Within("cos", "1", "cosine of the angle of incidence", 0, 1), Positive("eta", "real part of the index"),
              ImaginaryIndex()};
  q.results = {{"F", "1", "reflectance"}};
  AddDerivatives(&q, "F", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    ConductorFresnelGradient g;
    out[0] = FresnelConductor(in[0], {in[1], in[2]}, &g);
    out[1] = g.dc;
    out[2] = g.deta;
    out[3] = g.dk;
  };
  return q;
}

Quantity BrdfQuantity() {
  Quantity q =
      OfEllipsoid("brdf", "microfacet BRDF of the ellipsoid with a conductor's Fresnel reflectance", "[Walter] eq 4-6");
  std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "o", "direction to the viewer; at or below the horizon all is 0");
  AddDirection(&q, "i", "direction to the light; at or below the horizon all is 0");
  q.inputs.push_back(Positive("eta", "real part of the index"));
  q.inputs.push_back(ImaginaryIndex());
  q.results = {{"D", "1/sr", "normal distribution at the half vector"},
               {"G1_o", "1", "masking of the viewer, at most 1"},
               {"G1_i", "1", "masking of the light, at most 1"},
               {"F", "1", "Fresnel reflectance"},
               {"fr", "1/sr", "BRDF"},
               {"clamped_o", "1", "1 where G1_o is cut at 1", true},
               {"clamped_i", "1", "1 where G1_i is cut at 1", true}};
  parameters.push_back("eta");
  parameters.push_back("k");
  AddDerivatives(&q, "fr", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    BrdfFactors f;
    out[4] = EllipsoidConductorBrdf(EllipsoidAt(in), {in[11], in[12]}, DirectionAt(in + 5), DirectionAt(in + 8),
                                    Masking::kSmithSeparable, out + 7, &f);
    out[0] = f.D;
    out[1] = f.G1_o;
    out[2] = f.G1_i;
    out[3] = f.F;
    out[5] = f.clamped_o ? 1 : 0;
    out[6] = f.clamped_i ? 1 : 0;
  };
  return q;
}

Quantity WhiteFurnaceQuantity() {
  Quantity q = OfEllipsoid("white_furnace", "weak white furnace integrals and albedo of the ellipsoid BRDF",
                           "[Heitz] eq 36 with [Walter] eq 5-6");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "o", "direction to the viewer, above the horizon");
  q.inputs.back().low = 0;
  q.inputs.back().low_open = true;
  q.results = {{"W_sphere", "1", "integral over the sphere of reflected directions, min(1, sigma / cos)"},
               {"W_hemi", "1", "integral over the upper hemisphere, by quadrature"},
               {"albedo_F1", "1", "directional albedo for F = 1, by quadrature; nan if the lobe is tilted"}};
  AddDerivatives(&q, "Wsphere", "1", parameters);
  AddDerivatives(&q, "Whemi", "1", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Ellipsoid e = EllipsoidAt(in);
    const EllipsoidDistribution distribution(e);
    const Shadowing smith;
    const Vec3 wo = DirectionAt(in + 5);
    out[0] = WeakFurnaceSphere(distribution, smith, wo, out + 3);
    out[1] = WeakFurnaceHemisphere(distribution, smith, wo, out + 8);
    const bool tilted = e.theta_x != 0 || e.theta_y != 0;
    out[2] = tilted ? kNan
                    : DirectionalAlbedo(
                          distribution, smith, [](double) { return 1.0; }, wo);
  };
  return q;
}

Quantity VisiblePdfQuantity() {
  Quantity q = OfEllipsoid("vndf_pdf", "density of the normals that a direction sees", "[Walter] eq 30");
  const std::vector<std::string> parameters = ParameterNames(q);
  AddDirection(&q, "psi", "direction that sees");
  AddDirection(&q, "m", "micro normal");
  q.results = {{"pdf", "1/sr", "D(m) <m.psi> / sigma(psi)"}};
  AddDerivatives(&q, "pdf", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    out[0] = EllipsoidVndfPdf(EllipsoidAt(in), DirectionAt(in + 5), DirectionAt(in + 8), out + 1);
  };
  return q;
}

Quantity VisibleMomentsQuantity() {
  Quantity q = OfEllipsoid("vndf_moments", "mean of the normals that a direction sees, by quadrature",
                           "[Walter] eq 30 and section 4");
  AddDirection(&q, "psi", "direction that sees");
  q.results = {{"Em_x", "1", "mean normal, x"}, {"Em_y", "1", "mean normal, y"}, {"Em_z", "1", "mean normal, z"}};
  q.evaluate = [](const double* in, double* out) {
    const Vec3 mean = EllipsoidMeanVisibleNormal(EllipsoidAt(in), DirectionAt(in + 5));
    out[0] = mean.x;
    out[1] = mean.y;
    out[2] = mean.z;
  };
  return q;
}

}  // namespace

std::vector<Quantity> WalterQuantities() {
  return {EllipsoidDQuantity(),    EllipsoidG1Quantity(),   LuneQuantity(), ToOffCenterQuantity(),
          FromOffCenterQuantity(), FresnelQuantity(),       BrdfQuantity(), WhiteFurnaceQuantity(),
          VisiblePdfQuantity(),    VisibleMomentsQuantity()};
}

}  // namespace lobefit
