// Fresnel terms with freedom, diffuse parts below an interface and of rough facets, retroreflecting lobes, coats.
#include <algorithm>
#include <cmath>
#include <limits>

#include "lobefit/core/brdf/coat.h"
#include "lobefit/core/brdf/diffuse.h"
#include "lobefit/core/fresnel/fresnel.h"
#include "lobefit/core/microfacet/microfacet.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

InputColumn Cosine(const char* name, const char* meaning) { return Within(name, "1", meaning, 0, 1); }

InputColumn Index() {
  InputColumn ior = AnyNumber("ior", "1", "refractive index");
  ior.low = 1;
  return ior;
}

Quantity FresnelF82Quantity() {
  Quantity q;
  q.name = "fresnel_f82";
  q.description = "Schlick's reflectance with an edge tint";
  q.source = "[Hoffman 2019], [Kutz 2021]; MATH.md 8.3";
  q.inputs = {Cosine("cos", "cosine of the angle of incidence"),
              Within("f0", "1", "reflectance at normal incidence", 0, 1),
              AnyNumber("tint", "1", "factor of Schlick's reflectance at cos = 1/7")};
  q.inputs[2].low = 0;
  q.results = {{"b", "1", "coefficient of -cos (1 - cos)^6"}, {"F", "1", "reflectance"}};
  AddDerivatives(&q, "F", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    SchlickF82Gradient g;
    out[0] = SchlickF82Coefficient(in[1], in[2]);
    out[1] = FresnelSchlickF82(in[0], in[1], in[2], &g);
    out[2] = g.dc;
    out[3] = g.df0;
    out[4] = g.dtint;
  };
  return q;
}

Quantity FresnelCurveQuantity() {
  Quantity q;
  q.name = "fresnel_curve";
  q.description = "reflectance as a cubic B-spline of the cosine, inner knots .25 and .6";
  q.source = "MATH.md 8.3";
  q.inputs = {Cosine("cos", "cosine of the angle of incidence")};
  for (std::size_t k = 0; k < kFresnelCurveSize; ++k)
    q.inputs.push_back(AnyNumber("F_" + std::to_string(k), "1", "coefficient, from grazing to normal incidence"));
  q.results = {{"F", "1", "reflectance"}};
  AddDerivatives(&q, "F", "1", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    double slope[kFresnelCurveSize];
    FresnelCurveBasis(in[0], out + 2, slope);
    out[0] = out[1] = 0;
    for (std::size_t k = 0; k < kFresnelCurveSize; ++k) {
      out[0] += in[1 + k] * out[2 + k];
      out[1] += in[1 + k] * slope[k];
    }
  };
  return q;
}

Quantity InterfacedQuantity() {
  Quantity q;
  q.name = "diffuse_interfaced";
  q.description = "Lambertian body below a smooth dielectric, with all reflections inside";
  q.source = "[Elias 2001]; MATH.md 8.4";
  q.inputs = {Cosine("cos_i", "cosine of the light's polar angle"),
              Cosine("cos_o", "cosine of the viewer's polar angle"), Index(),
              Within("albedo", "1", "albedo of the body below the interface", 0, 1)};
  for (std::size_t k = 0; k < 2; ++k) q.inputs[k].low_open = true;
  q.results = {{"F_i", "1", "reflectance of the interface for the light"},
               {"F_o", "1", "reflectance of the interface for the viewer"},
               {"F_ex", "1", "mean reflectance from outside"},
               {"F_in", "1", "mean reflectance from inside"},
               {"albedo_apparent", "1", "albedo of what enters"},
               {"f", "1/sr", "BRDF"}};
  AddDerivatives(&q, "f", "1/sr", ParameterNames(q));
  q.evaluate = [](const double* in, double* out) {
    const double ior = in[2];
    double drho, dior;
    out[0] = FresnelDielectric(in[0], ior);
    out[1] = FresnelDielectric(in[1], ior);
    out[2] = DielectricMeanReflectance(ior);
    // 1 - (1 - F_ex) / n^2, for n near 1 too.
    out[3] = ((ior - 1) * (ior + 1) + out[2]) / (ior * ior);
    out[4] = ApparentAlbedo(in[3], ior, &drho, &dior);
    InterfacedGradient g;
    out[5] = InterfacedDiffuse(in[0], in[1], ior, out[4], &g);
    out[6] = g.dcos_i;
    out[7] = g.dcos_o;
    out[8] = g.dior + g.dapparent * dior;
    out[9] = g.dapparent * drho;
  };
  return q;
}

// s = i.o - i_z o_z in extended precision: a small difference where the azimuths are nearly perpendicular.
double ExtendedOffset(const double* i, const double* o) {
  const auto square = [](const double* u) { return Real{u[0]} * u[0] + Real{u[1]} * u[1] + Real{u[2]} * u[2]; };
  return static_cast<double>((Real{i[0]} * o[0] + Real{i[1]} * o[1]) / std::sqrt(square(i) * square(o)));
}

Quantity OrenNayarQuantity() {
  Quantity q;
  q.name = "diffuse_eon";
  q.description = "energy-preserving Oren-Nayar";
  q.source = "[Portsmouth, Kutz, Hill 2024]; MATH.md 8.4";
  q.inputs = {Within("albedo", "1", "albedo of the facets", 0, 1), Within("roughness", "1", "roughness", 0, 1)};
  const std::vector<std::string> parameters = ParameterNames(q);
  AddUpperDirection(&q, "i", "direction to the light");
  AddUpperDirection(&q, "o", "direction to the viewer");
  q.results = {{"s", "1", "i.o - i_z o_z"},
               {"E_i", "1", "albedo of single scattering for the light, rho = 1"},
               {"E_o", "1", "albedo of single scattering for the viewer, rho = 1"},
               {"f_ss", "1/sr", "single scattering"},
               {"f_ms", "1/sr", "what scatters again"},
               {"f", "1/sr", "BRDF"}};
  AddDerivatives(&q, "f", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    const Vec3 i = DirectionAt(in + 2), o = DirectionAt(in + 5);
    const OrenNayar f = OrenNayarDiffuse(in[0], in[1], i, o);
    out[0] = ExtendedOffset(in + 2, in + 5);
    out[1] = OrenNayarSingleAlbedo(in[1], i.z);
    out[2] = OrenNayarSingleAlbedo(in[1], o.z);
    out[3] = f.single;
    out[4] = f.multiple;
    out[5] = f.single + f.multiple;
    out[6] = f.dsingle_dalbedo + f.dmultiple_dalbedo;
    out[7] = f.dsingle_droughness + f.dmultiple_droughness;
  };
  return q;
}

Quantity RetroQuantity() {
  Quantity q;
  q.name = "retro_brdf";
  q.description = "specular factor of a lobe about the back direction, without Fresnel term";
  q.source = "[Raab 2025], [Portsmouth 2026]; MATH.md 8.5";
  q.inputs = SlopeColumns();
  const std::vector<std::string> parameters = ParameterNames(q);
  AddUpperDirection(&q, "o", "direction to the viewer");
  AddUpperDirection(&q, "i", "direction to the light");
  q.results = {{"cos_d", "1", "cosine between the viewer and the half vector of the mirrored light"},
               {"specular", "1/sr", "lobe at the mirrored light and the viewer"},
               {"specular_swapped", "1/sr", "lobe at the light and the mirrored viewer"},
               {"symmetric", "1/sr", "mean of both"}};
  AddDerivatives(&q, "specular", "1/sr", parameters);
  AddDerivatives(&q, "symmetric", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    const SlopeNormalDistribution distribution(SlopesAt(in));
    const Vec3 o = DirectionAt(in + 6), i = DirectionAt(in + 9);
    double swapped[kSlopeParameters];
    out[1] = MicrofacetSpecular(distribution, {}, o, Mirrored(i), out + 4, out);
    out[2] = MicrofacetSpecular(distribution, {}, i, Mirrored(o), swapped);
    out[3] = 0.5 * (out[1] + out[2]);
    for (std::size_t k = 0; k < kSlopeParameters; ++k) out[9 + k] = 0.5 * (out[4 + k] + swapped[k]);
  };
  return q;
}

Quantity CoatQuantity() {
  Quantity q;
  q.name = "coat_brdf";
  q.description = "dielectric coat over a GGX lobe with Schlick's reflectance and a Lambertian part";
  q.source = "MATH.md 8.6";
  q.inputs = SlopeShapeColumns();
  q.inputs.push_back(Within("f0", "1", "reflectance of the base at normal incidence", 0, 1));
  q.inputs.push_back(
      Within("albedo", "1", "of the diffuse part: below the coat (refracted), apparent (layered)", 0, 1));
  q.inputs.push_back(Positive("coat_alpha", "roughness of the coat"));
  q.inputs.push_back(Index());
  q.inputs.push_back(AnyNumber("tau", "1", "optical depth of the coat along the normal"));
  q.inputs.back().low = 0;
  const std::vector<std::string> parameters = ParameterNames(q);
  AddUpperDirection(&q, "o", "direction to the viewer");
  AddUpperDirection(&q, "i", "direction to the light");
  q.results = {{"coat_lobe", "1/sr", "lobe of the coat with its Fresnel term"},
               {"T_o", "1", "transmittance for the viewer"},
               {"T_i", "1", "transmittance for the light"},
               {"base_refracted", "1/sr", "base at the refracted directions"},
               {"base_unrefracted", "1/sr", "base at the directions themselves"},
               {"f_refracted", "1/sr", "BRDF with refraction"},
               {"f_layered", "1/sr", "BRDF without"}};
  AddDerivatives(&q, "f_refracted", "1/sr", parameters);
  AddDerivatives(&q, "f_layered", "1/sr", parameters);
  q.evaluate = [](const double* in, double* out) {
    const SlopeDistribution slopes = {Family::kGgx, in[0], in[1], in[2], in[3], in[4]};
    const double f0 = in[5], albedo = in[6], ior = in[8];
    const Vec3 o = DirectionAt(in + 10), i = DirectionAt(in + 13);
    out[1] = DielectricTransmittance(o.z, ior);
    out[2] = DielectricTransmittance(i.z, ior);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const bool refracted = kind == 0;
      const CoatFactors coat = EvaluateCoat({in[7], ior, in[9], refracted}, i, o);
      const DirectionalSpecular base = SpecularWithDirections(slopes, f0, coat.inside_i, coat.inside_o);
      // rho / (pi (1 - rho F_in)) = rho' n^2 / (pi (1 - F_ex)).
      double drho = 1, dior = 0;
      const double apparent = refracted ? ApparentAlbedo(albedo, ior, &drho, &dior) : albedo;
      double dscale;
      const double scale = LambertBelowCoat(ior, refracted, &dscale);
      const double bracket = base.value + apparent * scale;
      const double value = coat.lobe + coat.through * bracket;
      out[0] = coat.lobe;
      out[3 + kind] = bracket;
      out[5 + kind] = value;
      double* d = out + 7 + 10 * kind;
      for (std::size_t k = 0; k < kSlopeParameters; ++k) d[k] = coat.through * base.by_shape[k];
      d[5] = coat.through * base.df0;
      d[6] = coat.through * scale * drho;
      d[7] = coat.dlobe_dalpha;
      d[8] = coat.dlobe_dior + coat.dthrough_dior * bracket +
             coat.through * (Dot(base.dwi, coat.dinside_i_dior) + Dot(base.dwo, coat.dinside_o_dior) + dior * scale +
                             apparent * dscale);
      d[9] = coat.dthrough_dtau * bracket;
    }
  };
  return q;
}

}  // namespace

std::vector<Quantity> LayerQuantities() {
  return {FresnelF82Quantity(), FresnelCurveQuantity(), InterfacedQuantity(),
          OrenNayarQuantity(),  RetroQuantity(),        CoatQuantity()};
}

}  // namespace lobefit
