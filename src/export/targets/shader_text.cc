#include "lobefit/export/targets/shader_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/file.h"
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

std::string FresnelOf(const FittedBrdf& fit, std::size_t lobe, std::size_t channel) {
  const Model& model = fit.material().model;
  const Lobe& choices = model.lobes[lobe];
  return ShaderFresnel(choices, Literals(fit, FirstFresnel(model, lobe), FresnelParameters(choices.fresnel), channel));
}

std::string DiffuseOf(const FittedBrdf& fit, std::size_t channel) {
  const Model& model = fit.material().model;
  return ShaderDiffuse(model.diffuse, Literals(fit, FirstParameter(model, model.lobes.size()),
                                               DiffuseParameters(model.diffuse), channel));
}

// Statements that need wi, wo; GLSL that is OSL but for a few names.
std::string ColourBody(const FittedBrdf& fit, const std::string& prefix) {
  const std::size_t step = fit.IsGrey() ? 0 : 1;
  std::string text = fmt::format("  vec3 f_r = vec3({}, {}, {});\n", DiffuseOf(fit, 0), DiffuseOf(fit, step),
                                 DiffuseOf(fit, 2 * step));
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    text += fmt::format("  f_r += {} *\n         vec3({},\n              {},\n              {});\n",
                        ShaderLobe(fit, l, prefix, Slopes(fit, l)), FresnelOf(fit, l, 0), FresnelOf(fit, l, step),
                        FresnelOf(fit, l, 2 * step));
  }
  return text;
}

std::string SpectrumBody(const FittedBrdf& fit, const std::string& prefix) {
  std::string text;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    text += fmt::format("  float lobe{} = {};\n", l + 1, ShaderLobe(fit, l, prefix, Slopes(fit, l)));
  }
  for (std::size_t c = 0; c < fit.material().channels.size(); ++c) {
    text += fmt::format("  f_r[{}] = {}", c, DiffuseOf(fit, c));
    for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
      text += fmt::format(" + lobe{} * {}", l + 1, FresnelOf(fit, l, c));
    }
    text += ";\n";
  }
  return text;
}

int FamilyNumber(const Lobe& lobe) { return FamilyOf(lobe.ndf) == NdfFamily::kBeckmann ? 1 : 0; }

bool IsRetro(const Lobe& lobe) { return lobe.direction == LobeDirection::kRetro; }

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
                own, static_cast<int>(lobe.masking));
  }
  return text;
}

std::string ShaderLobe(const FittedBrdf& fit, std::size_t lobe, const std::string& prefix, const std::string& slopes) {
  const Lobe& choices = fit.lobes()[lobe].choices;
  const char* directions = IsRetro(choices) ? "back, wo, back_h" : "wi, wo, h";
  if (IsRadial(choices)) return fmt::format("{}value({}, {})", LobePrefix(prefix, lobe), directions, slopes);
  return fmt::format("lobefit_lobe({}, {}, {}, {}, 0.0, 1.0, 1.0)", directions, slopes, FamilyNumber(choices),
                     static_cast<int>(choices.masking));
}

std::string ShaderFresnel(const Lobe& lobe, const std::vector<std::string>& parameters) {
  const std::string cosine = IsRetro(lobe) ? "cos_back" : "cos_d";
  const auto call = [&](const char* name) {
    return fmt::format("{}({}, {})", name, cosine, fmt::join(parameters, ", "));
  };
  switch (lobe.fresnel) {
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
    case Fresnel::kNone:
      break;
  }
  return parameters[0];
}

std::string ShaderDiffuse(Diffuse diffuse, const std::vector<std::string>& parameters) {
  switch (diffuse) {
    case Diffuse::kInterfaced:
      return fmt::format("lobefit_interfaced(wi, wo, {})", fmt::join(parameters, ", "));
    case Diffuse::kOrenNayar:
      return fmt::format("lobefit_oren_nayar(wi, wo, {})", fmt::join(parameters, ", "));
    case Diffuse::kLambert:
      return fmt::format("{} * 0.318309886", parameters[0]);
    case Diffuse::kMicrofacet:  // refused before (RefuseUnknownTerms)
    case Diffuse::kNone:
      break;
  }
  return "0.0";
}

std::string ShaderBackText(const FittedBrdf& fit) {
  const bool retro =
      std::any_of(fit.lobes().begin(), fit.lobes().end(), [](const FittedLobe& lobe) { return IsRetro(lobe.choices); });
  return retro ? "  vec3 back = vec3(-wi[0], -wi[1], wi[2]);\n  vec3 back_h = normalize(back + wo);\n"
                 "  float cos_back = dot(back, back_h);\n"
               : "";
}

std::string ShaderBody(const FittedBrdf& fit, const std::string& prefix) {
  return ShaderBackText(fit) + (fit.IsRgbOrGrey() ? ColourBody(fit, prefix) : SpectrumBody(fit, prefix));
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

WrittenFiles WriteShader(const FittedBrdf& fit, const std::filesystem::path& path, const std::string& text) {
  WriteFileAtomically(path, text);
  return {{path}, fit.function(), true, {"the error is not measured: the text is the model, in single precision"}};
}

}  // namespace lobefit
