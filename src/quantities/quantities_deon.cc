// [dEon] cross-sections of distributions that depend on the polar angle only.
#include "lobefit/core/axial/cross_section.h"
#include "lobefit/core/axial/cross_section_sg.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

Quantity CrossSection(const char* name, const char* description, const char* source, const InputColumn& parameter,
                      const char* meaning) {
  Quantity q;
  q.name = name;
  q.description = description;
  q.source = source;
  q.inputs = {parameter, Within("u", "1", "cosine of the angle to the axis", -1, 1)};
  q.results = {{"sigma", "1", meaning}};
  return q;
}

constexpr const char* kByArea = "cross-section, sigma(1) = 1";
constexpr const char* kBySphere = "cross-section, int D dm = 1 over the sphere";
constexpr const char* kPrinted = "2 pi sigma, the paper's normalisation int D du = 1";

Quantity RingQuantity() {
  Quantity q;
  q.name = "sigma_ring";
  q.description = "cross-section of a ring of normals";
  q.source = "[dEon] eq 8";
  q.inputs = {Within("u", "1", "cosine of the angle to the axis", -1, 1),
              Within("un", "1", "cosine of the ring's normals", -1, 1)};
  q.results = {{"sigma", "1", kBySphere}, {"sigma_printed", "1", kPrinted}};
  AddDerivatives(&q, "sigma", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    out[0] = RingCrossSection(in[0], in[1], out + 2, out + 3);
    out[1] = 2 * kPi * out[0];
  };
  return q;
}

Quantity BeckmannQuantity() {
  Quantity q = CrossSection("sigma_beckmann", "cross-section of Beckmann's distribution", "[dEon] eq 22, corrected",
                            Positive("alpha", "roughness"), kByArea);
  AddDerivatives(&q, "sigma", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) { out[0] = BeckmannCrossSection(in[0], in[1], out + 1, out + 2); };
  return q;
}

Quantity GgxQuantity() {
  Quantity q = CrossSection("sigma_ggx", "cross-section of the GGX distribution", "[dEon] eq 25",
                            Positive("alpha", "roughness"), kByArea);
  AddDerivatives(&q, "sigma", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) { out[0] = GgxCrossSection(in[0], in[1], out + 1, out + 2); };
  return q;
}

Quantity KagiwadaKalabaQuantity() {
  Quantity q =
      CrossSection("sigma_kk", "cross-section of the Kagiwada-Kalaba distribution", "[dEon] eq 26-27, corrected",
                   Within("b", "1", "concentration, 0 isotropic, 1 a flat surface", 0, 1, true, true), kBySphere);
  q.results.push_back({"sigma_printed", "1", kPrinted});
  AddDerivatives(&q, "sigma", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    out[0] = KagiwadaKalabaCrossSection(in[0], in[1], out + 2, out + 3);
    out[1] = 2 * kPi * out[0];
  };
  return q;
}

Quantity SphericalGaussianQuantity() {
  Quantity q = CrossSection("sigma_sg", "cross-section of a spherical Gaussian of normals and its approximations",
                            "[dEon] eq 28, 35-44, corrected", Positive("alpha", "roughness"), kBySphere);
  AddDerivatives(&q, "sigma", "1", ParameterNames(q));
  q.results.push_back({"sigma_odd", "1", "odd part, eq 35"});
  q.results.push_back({"sigma_2", "1", "share of the normals within the band, eq 37"});
  q.results.push_back({"approx_eq40", "1", "approximation, eq 40"});
  q.results.push_back({"approx_eq41", "1", "approximation, eq 41-43"});
  q.results.push_back({"approx_eq44", "1", "approximation, eq 44: Legendre polynomials to degree 2"});
  q.results.push_back({"sh_l_le_11", "1", "approximation, eq 38: Legendre polynomials to degree 11"});
  q.evaluate = [](const double* in, double* out) {
    const double alpha = in[0], u = in[1];
    out[0] = SgCrossSection(alpha, u, out + 1, out + 2);
    out[3] = SgCrossSectionOdd(alpha, u);
    out[4] = SgCrossSection2(alpha, u);
    out[5] = SgCrossSectionEq40(alpha, u);
    out[6] = SgCrossSectionEq41(alpha, u);
    out[7] = SgCrossSectionHarmonics(alpha, u, 2);
    out[8] = SgCrossSectionHarmonics(alpha, u, 11);
  };
  return q;
}

}  // namespace

std::vector<Quantity> DEonQuantities() {
  return {RingQuantity(), BeckmannQuantity(), GgxQuantity(), KagiwadaKalabaQuantity(), SphericalGaussianQuantity()};
}

}  // namespace lobefit
