#include "lobefit/export/targets/shader_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/radial_text.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {

const char* const kShaderLobeText =
#include "lobefit/core/brdf/lobe.glsl.inc"
    ;

const char* const kShaderContract =
    "f_r in 1/sr, without a cosine. wi points to the light, wo to the viewer, unit vectors in the frame of tangent, "
    "bitangent and normal.";
const char* const kShaderHalfText = "  vec3 h = normalize(wi + wo);\n  float cos_d = dot(wi, h);\n";

namespace {

// The parameters from `first` on, of one channel, as literals.
std::vector<std::string> Literals(const FittedBrdf& fit, std::size_t first, std::size_t count, std::size_t channel) {
  std::vector<std::string> texts;
  for (std::size_t k = first; k < first + count; ++k) {
    const std::vector<double>& values = fit.material().parameters[k].values;
    texts.push_back(FloatLiteral(values[values.size() == 1 ? 0 : channel]));
  }
  return texts;
}

std::string Slopes(const FittedBrdf& fit, std::size_t lobe) {
  const SlopeCoordinates& s = fit.reflectance().lobe_shapes()[lobe];
  return fmt::format("{}, {}, {}, {}, {}", FloatLiteral(s.v[0]), FloatLiteral(s.v[1]), FloatLiteral(std::exp(s.v[2])),
                     FloatLiteral(s.v[3]), FloatLiteral(std::exp(s.v[4])));
}

std::vector<std::string> FresnelLiterals(const FittedBrdf& fit, std::size_t lobe, std::size_t channel) {
  const Model& model = fit.material().model;
  return Literals(fit, FirstFresnel(model, lobe), FresnelParameters(model.lobes[lobe].fresnel), channel);
}

std::string FresnelOf(const FittedBrdf& fit, std::size_t lobe, std::size_t channel) {
  return ShaderFresnel(fit, lobe, FresnelLiterals(fit, lobe, channel));
}

std::string DiffuseOf(const FittedBrdf& fit, std::size_t channel) {
  const Model& model = fit.material().model;
  const std::size_t coat = CoatOf(model);
  return ShaderDiffuse(
      fit, Literals(fit, FirstParameter(model, model.lobes.size()), DiffuseParameters(model.diffuse), channel),
      coat < model.lobes.size() ? FresnelLiterals(fit, coat, channel) : std::vector<std::string>{});
}

// What a coat lets through in a channel.
std::string ThroughOf(const FittedBrdf& fit, std::size_t channel) {
  return ShaderThrough(fit, FresnelLiterals(fit, CoatOf(fit.material().model), channel));
}

// Statements that need wi, wo; GLSL that is OSL but for a few names.
std::string ColourBody(const FittedBrdf& fit, const std::string& prefix) {
  const std::size_t step = fit.IsGrey() ? 0 : 1;
  std::string text = fmt::format("  vec3 f_r = vec3({}, {}, {});\n", DiffuseOf(fit, 0), DiffuseOf(fit, step),
                                 DiffuseOf(fit, 2 * step));
  const std::size_t coat = CoatOf(fit.material().model);
  const auto add = [&](std::size_t l) {
    text += fmt::format("  f_r += {} *\n         vec3({},\n              {},\n              {});\n",
                        ShaderLobe(fit, l, prefix, Slopes(fit, l)), FresnelOf(fit, l, 0), FresnelOf(fit, l, step),
                        FresnelOf(fit, l, 2 * step));
  };
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    if (l != coat) add(l);
  }
  if (coat == fit.lobes().size()) return text;
  text += fmt::format("  f_r *= vec3({},\n              {},\n              {});\n", ThroughOf(fit, 0),
                      ThroughOf(fit, step), ThroughOf(fit, 2 * step));
  add(coat);
  return text;
}

std::string SpectrumBody(const FittedBrdf& fit, const std::string& prefix) {
  std::string text;
  const std::size_t coat = CoatOf(fit.material().model);
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    text += fmt::format("  float lobe{} = {};\n", l + 1, ShaderLobe(fit, l, prefix, Slopes(fit, l)));
  }
  for (std::size_t c = 0; c < fit.material().channels.size(); ++c) {
    std::string sum = DiffuseOf(fit, c);
    for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
      if (l != coat) sum += fmt::format(" + lobe{} * {}", l + 1, FresnelOf(fit, l, c));
    }
    if (coat < fit.lobes().size())
      sum = fmt::format("{} * ({}) + lobe{} * {}", ThroughOf(fit, c), sum, coat + 1, FresnelOf(fit, coat, c));
    text += fmt::format("  f_r[{}] = {};\n", c, sum);
  }
  return text;
}

int FamilyNumber(const Lobe& lobe) {
  const Family family = FamilyOf(lobe.ndf);
  return family == Family::kAbg ? 2 : family == Family::kBeckmann ? 1 : 0;
}

// Of lobe.glsl.inc.
int MaskingNumber(Masking masking) {
  switch (masking) {
    case Masking::kSmithDirection:  // no lobe of a material has it
    case Masking::kSmithSeparable:
      return 0;
    case Masking::kSmithUnclamped:
      return 1;
    case Masking::kSmithHeight:
      return 2;
    case Masking::kSmithHeightDirection:
      return 3;
    case Masking::kVCavity:
      return 4;
    case Masking::kImplicit:
      return 5;
    case Masking::kSchlickSmith:
      return 6;
    case Masking::kKelemen:
      return 7;
    case Masking::kNone:
      return 8;
  }
  return 0;
}

bool IsRetro(const Lobe& lobe) { return lobe.direction == LobeDirection::kRetro; }

bool HasCoat(const FittedBrdf& fit) { return CoatOf(fit.material().model) < fit.lobes().size(); }

const char* Bends(const FittedBrdf& fit) {
  const Model& model = fit.material().model;
  return model.lobes[CoatOf(model)].fresnel == Fresnel::kCoatRefracted ? "1.0" : "0.0";
}

// The directions at which a lobe is evaluated, and the cosine of its Fresnel term, by the names of ShaderSetup.
struct Names {
  const char *directions, *cosine;
};
Names NamesOf(const FittedBrdf& fit, std::size_t lobe) {
  if (IsRetro(fit.lobes()[lobe].choices))
    return {HasCoat(fit) ? "back, below_o, back_h" : "back, wo, back_h", "cos_back"};
  if (HasCoat(fit) && !IsCoat(fit.lobes()[lobe].choices.fresnel)) return {"below_i, below_o, below_h", "cos_below"};
  return {"wi, wo, h", "cos_d"};
}

std::string LobePrefix(const std::string& prefix, std::size_t lobe) {
  return fmt::format("{}lobe{}_", prefix, lobe + 1);
}

}  // namespace

std::string ShaderFunctions(const FittedBrdf& fit, const std::string& prefix) {
  std::string text;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const Lobe& lobe = fit.lobes()[l].choices;
    if (!IsRadial(lobe)) continue;
    const std::string own = LobePrefix(prefix, l);
    text += RadialFunctions(own, lobe, fit.reflectance().shapes()[l]) +
            fmt::format(
                "float {0}value(vec3 wi, vec3 wo, vec3 h, float sx, float sy, float a, float b, float c) {{\n"
                "  return lobefit_lobe(wi, wo, h, sx, sy, a, b, c, 0, {1}, {0}excess(lobefit_u(h, sx, sy, a, b, c)),\n"
                "                      {0}ratio(lobefit_w(wi, sx, sy, a, b, c)), {0}ratio(lobefit_w(wo, sx, sy, a, b, "
                "c)));\n}}\n",
                own, MaskingNumber(lobe.masking));
  }
  return text;
}

std::string ShaderLobe(const FittedBrdf& fit, std::size_t lobe, const std::string& prefix, const std::string& slopes) {
  const Lobe& choices = fit.lobes()[lobe].choices;
  const char* directions = NamesOf(fit, lobe).directions;
  if (IsRadial(choices)) return fmt::format("{}value({}, {})", LobePrefix(prefix, lobe), directions, slopes);
  const std::string excess =
      FamilyOf(choices.ndf) == Family::kAbg ? FloatLiteral(fit.reflectance().shapes()[lobe].exponent) : "0.0";
  return fmt::format("lobefit_lobe({}, {}, {}, {}, {}, 1.0, 1.0)", directions, slopes, FamilyNumber(choices),
                     MaskingNumber(choices.masking), excess);
}

std::string ShaderFresnel(const FittedBrdf& fit, std::size_t lobe, const std::vector<std::string>& parameters) {
  const std::string cosine = NamesOf(fit, lobe).cosine;
  const auto call = [&](const char* name) {
    return fmt::format("{}({}, {})", name, cosine, fmt::join(parameters, ", "));
  };
  switch (fit.lobes()[lobe].choices.fresnel) {
    case Fresnel::kSchlick:
      return fmt::format("({0} + (1.0 - {0}) * lobefit_schlick({1}))", parameters[0], cosine);
    case Fresnel::kConductor:
      return call("lobefit_conductor");
    case Fresnel::kDielectric:
      return call("lobefit_dielectric");
    case Fresnel::kSchlickF82:
      return call("lobefit_schlick_f82");
    case Fresnel::kCurve:
      return call("lobefit_curve");
    case Fresnel::kCoatLayered:
    case Fresnel::kCoatRefracted:
      return fmt::format("lobefit_dielectric({}, {})", cosine, parameters[0]);
    case Fresnel::kNone:
      break;
  }
  return parameters[0];
}

std::string ShaderThrough(const FittedBrdf& fit, const std::vector<std::string>& coat) {
  return fmt::format("lobefit_through(wi, wo, {}, {}, {})", Bends(fit), coat[0], coat[1]);
}

std::string ShaderDiffuse(const FittedBrdf& fit, const std::vector<std::string>& parameters,
                          const std::vector<std::string>& coat) {
  switch (fit.material().model.diffuse) {
    case Diffuse::kInterfaced:
      return fmt::format("lobefit_interfaced(wi, wo, {})", fmt::join(parameters, ", "));
    case Diffuse::kOrenNayar:
      return fmt::format("lobefit_oren_nayar(wi, wo, {})", fmt::join(parameters, ", "));
    case Diffuse::kLambert:
      if (!coat.empty()) return fmt::format("{} * lobefit_below({}, {})", parameters[0], Bends(fit), coat[0]);
      return fmt::format("{} * 0.318309886", parameters[0]);
    case Diffuse::kMicrofacet:  // refused before (RefuseUnknownTerms)
    case Diffuse::kNone:
      break;
  }
  return "0.0";
}

std::string ShaderSetup(const FittedBrdf& fit, const std::string& coat_ior) {
  std::string text, from = "wi", to = "wo";
  if (HasCoat(fit)) {
    from = "below_i";
    to = "below_o";
    const bool bends = std::string(Bends(fit)) == "1.0";
    const auto inside = [&](const char* direction) {
      return bends ? fmt::format("lobefit_refracted({}, {})", direction, coat_ior) : std::string(direction);
    };
    text += fmt::format(
        "  vec3 below_i = {};\n  vec3 below_o = {};\n  vec3 below_h = normalize(below_i + below_o);\n  float cos_below "
        "= "
        "dot(below_i, below_h);\n",
        inside("wi"), inside("wo"));
  }
  const bool retro =
      std::any_of(fit.lobes().begin(), fit.lobes().end(), [](const FittedLobe& lobe) { return IsRetro(lobe.choices); });
  if (!retro) return text;
  return text + fmt::format(
                    "  vec3 back = vec3(-{0}[0], -{0}[1], {0}[2]);\n  vec3 back_h = normalize(back + {1});\n"
                    "  float cos_back = dot(back, back_h);\n",
                    from, to);
}

std::string ShaderBody(const FittedBrdf& fit, const std::string& prefix) {
  const std::string ior = HasCoat(fit) ? FresnelLiterals(fit, CoatOf(fit.material().model), 0)[0] : "";
  return ShaderSetup(fit, ior) + (fit.IsRgbOrGrey() ? ColourBody(fit, prefix) : SpectrumBody(fit, prefix));
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

WrittenFiles WriteShader(const std::filesystem::path& path, const std::string& text) {
  WriteFileAtomically(path, text);
  return {{path}, nullptr, true, {"the text is the model, in single precision; that alone is not measured"}};
}

}  // namespace lobefit
