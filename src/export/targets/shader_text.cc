#include "lobefit/export/targets/shader_text.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/file.h"
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

std::string Vector(const std::vector<double>& values) {
  const auto at = [&](std::size_t c) { return FloatLiteral(values[values.size() == 1 ? 0 : c]); };
  return fmt::format("vec3({}, {}, {})", at(0), at(1), at(2));
}

std::string LobeCall(const FittedBrdf& fit, std::size_t lobe) {
  const SlopeCoordinates& s = fit.reflectance().lobe_shapes()[lobe];
  return fmt::format("lobefit_lobe(wi, wo, h, {}, {}, {}, {}, {}, {}, {})", FloatLiteral(s.v[0]), FloatLiteral(s.v[1]),
                     FloatLiteral(std::exp(s.v[2])), FloatLiteral(s.v[3]), FloatLiteral(std::exp(s.v[4])),
                     ShaderFamily(fit.lobes()[lobe]), ShaderMasking(fit.lobes()[lobe]));
}

std::string FresnelOf(const FittedBrdf& fit, std::size_t lobe, std::size_t channel) {
  const Material& material = fit.material();
  const Fresnel fresnel = material.model.lobes[lobe].fresnel;
  std::vector<std::string> parameters;
  for (std::size_t k = 0; k < FresnelParameters(fresnel); ++k) {
    const std::size_t index = FirstFresnel(material.model, lobe) + k;
    parameters.push_back(FloatLiteral(material.parameters[index].values[channel]));
  }
  return ShaderFresnel(fresnel, parameters);
}

// Statements that need wi, wo; GLSL that is OSL but for a few names.
std::string ColourBody(const FittedBrdf& fit) {
  std::vector<double> diffuse = fit.diffuse();
  for (double& albedo : diffuse) albedo *= kInvPi;
  std::string text = fmt::format("  vec3 f_r = {};\n", Vector(diffuse));
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const auto at = [&](std::size_t c) { return FresnelOf(fit, l, diffuse.size() == 1 ? 0 : c); };
    text += fmt::format("  f_r += {} *\n         vec3({},\n              {},\n              {});\n", LobeCall(fit, l),
                        at(0), at(1), at(2));
  }
  return text;
}

std::string SpectrumBody(const FittedBrdf& fit) {
  std::string text;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    text += fmt::format("  float lobe{} = {};\n", l + 1, LobeCall(fit, l));
  }
  for (std::size_t c = 0; c < fit.material().channels.size(); ++c) {
    text += fmt::format("  f_r[{}] = {}", c, FloatLiteral(fit.diffuse()[c] * kInvPi));
    for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
      text += fmt::format(" + lobe{} * {}", l + 1, FresnelOf(fit, l, c));
    }
    text += ";\n";
  }
  return text;
}

}  // namespace

int ShaderFamily(const FittedLobe& lobe) { return FamilyOf(lobe.choices.ndf) == NdfFamily::kBeckmann ? 1 : 0; }
int ShaderMasking(const FittedLobe& lobe) { return static_cast<int>(lobe.choices.masking); }

std::string ShaderFresnel(Fresnel fresnel, const std::vector<std::string>& parameters) {
  switch (fresnel) {
    case Fresnel::kSchlick:
      return fmt::format("({0} + (1.0 - {0}) * lobefit_schlick(cos_d))", parameters[0]);
    case Fresnel::kConductor:
      return fmt::format("lobefit_conductor(cos_d, {}, {})", parameters[0], parameters[1]);
    case Fresnel::kDielectric:
      return fmt::format("lobefit_dielectric(cos_d, {})", parameters[0]);
    case Fresnel::kSchlickF82:
    case Fresnel::kCurve:  // refused before (RefuseUnknownTerms)
    case Fresnel::kNone:
      break;
  }
  return parameters[0];
}

std::string ShaderBody(const FittedBrdf& fit) { return fit.IsRgbOrGrey() ? ColourBody(fit) : SpectrumBody(fit); }

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
