#include "lobefit/export/targets/shaders/write.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/file.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

constexpr const char* kLobeText =
#include "lobefit/core/brdf/lobe.glsl.inc"
    ;

// The ellipsoid's slope coordinates, for the sliders; the last entry of the diagonal by the determinant, which does not
// cancel in single precision.
constexpr const char* kSlopeText = R"(
// Sine and cosine for -pi/2..pi/2 to single precision: those of GPUs may be off by 5e-4.
float lobefit_sin(float x) {
  float y = x * x;
  return x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + y * (1.0 / 362880.0 - y / 39916800.0)))));
}
float lobefit_cos(float x) { return lobefit_sin(1.57079633 - abs(x)); }
float lobefit_ellipsoid(vec3 wi, vec3 wo, vec3 h, float ax, float ay, float tx_deg, float ty_deg, float tz_deg,
                        int family, int masking) {
  float tx = radians(tx_deg);
  float ty = radians(ty_deg);
  float tz = radians(tz_deg);
  float cx = lobefit_cos(tx), sx = lobefit_sin(tx), cy = lobefit_cos(ty), sy = lobefit_sin(ty);
  float cz = lobefit_cos(tz), sz = lobefit_sin(tz);
  vec3 r1 = vec3(cy * cz, -cy * sz, sy);
  vec3 r2 = vec3(cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy);
  vec3 r3 = vec3(sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy);
  float x2 = ax * ax, y2 = ay * ay;
  float m33 = x2 * r1.z * r1.z + y2 * r2.z * r2.z + r3.z * r3.z;
  float slope_x = -(x2 * r1.x * r1.z + y2 * r2.x * r2.z + r3.x * r3.z) / m33;
  float slope_y = -(x2 * r1.y * r1.z + y2 * r2.y * r2.z + r3.y * r3.z) / m33;
  float q11 = y2 * r1.y * r1.y + x2 * r2.y * r2.y + x2 * y2 * r3.y * r3.y;
  float q12 = -(y2 * r1.x * r1.y + x2 * r2.x * r2.y + x2 * y2 * r3.x * r3.y);
  float a = sqrt(q11) / m33;
  float b = q12 / (m33 * m33 * a);
  float c = ax * ay / (m33 * sqrt(m33) * a);
  return lobefit_lobe(wi, wo, h, slope_x, slope_y, a, b, c, family, masking);
}
)";

std::string Vector(const std::vector<double>& values) {
  const auto at = [&](std::size_t c) { return FloatLiteral(values[values.size() == 1 ? 0 : c]); };
  return fmt::format("vec3({}, {}, {})", at(0), at(1), at(2));
}

int FamilyNumber(const FittedLobe& lobe) { return FamilyOf(lobe.choices.ndf) == NdfFamily::kBeckmann ? 1 : 0; }
int MaskingNumber(const FittedLobe& lobe) { return static_cast<int>(lobe.choices.masking); }

std::string LobeCall(const FittedBrdf& fit, std::size_t lobe) {
  const SlopeCoordinates& s = fit.reflectance().lobe_shapes()[lobe];
  return fmt::format("lobefit_lobe(wi, wo, h, {}, {}, {}, {}, {}, {}, {})", FloatLiteral(s.v[0]), FloatLiteral(s.v[1]),
                     FloatLiteral(std::exp(s.v[2])), FloatLiteral(s.v[3]), FloatLiteral(std::exp(s.v[4])),
                     FamilyNumber(fit.lobes()[lobe]), MaskingNumber(fit.lobes()[lobe]));
}

// The Fresnel factor as an expression of `cos_d`, with the parameters as text.
std::string FresnelText(Fresnel fresnel, const std::vector<std::string>& parameters) {
  switch (fresnel) {
    case Fresnel::kSchlick:
      return fmt::format("({0} + (1.0 - {0}) * lobefit_schlick(cos_d))", parameters[0]);
    case Fresnel::kConductor:
      return fmt::format("lobefit_conductor(cos_d, {}, {})", parameters[0], parameters[1]);
    case Fresnel::kDielectric:
      return fmt::format("lobefit_dielectric(cos_d, {})", parameters[0]);
    case Fresnel::kNone:
      break;
  }
  return parameters[0];
}

std::string FresnelOf(const FittedBrdf& fit, std::size_t lobe, std::size_t channel) {
  const Material& material = fit.material();
  const Fresnel fresnel = material.model.lobes[lobe].fresnel;
  std::vector<std::string> parameters;
  for (std::size_t k = 0; k < FresnelParameters(fresnel); ++k) {
    const std::size_t index = FirstParameter(material.model, lobe) + kShapeParameters + k;
    parameters.push_back(FloatLiteral(material.parameters[index].values[channel]));
  }
  return FresnelText(fresnel, parameters);
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

constexpr const char* kContract =
    "f_r in 1/sr, without a cosine. wi points to the light, wo to the viewer, unit vectors in the frame of tangent, "
    "bitangent and normal.";
constexpr const char* kHalf = "  vec3 h = normalize(wi + wo);\n  float cos_d = dot(wi, h);\n";

std::string FunctionText(const FittedBrdf& fit, bool osl) {
  const std::size_t channels = fit.material().channels.size();
  std::string text = kLobeText + fmt::format("// {}\n", kContract);
  if (fit.IsRgbOrGrey()) {
    text +=
        "vec3 lobefit_f_r(vec3 wi, vec3 wo) {\n  if (wi[2] <= 0.0 || wo[2] <= 0.0) { return vec3(0.0, 0.0, 0.0); }\n";
    text += kHalf + ColourBody(fit) + "  return f_r;\n}\n";
  } else {
    text += fmt::format("// Channels: ");
    for (const std::string& channel : fit.material().channels) text += channel + " ";
    text +=
        fmt::format("\nvoid lobefit_f_r(vec3 wi, vec3 wo, {} float f_r[{}]) {{\n", osl ? "output" : "out", channels);
    text += fmt::format("  for (int k = 0; k < {}; ++k) {{ f_r[k] = 0.0; }}\n", channels);
    text += "  if (wi[2] <= 0.0 || wo[2] <= 0.0) { return; }\n";
    text += kHalf + SpectrumBody(fit) + "}\n";
  }
  return text;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

WrittenFiles Write(const FittedBrdf& fit, const std::filesystem::path& path, const std::string& text) {
  WriteFileAtomically(path, text);
  return {{path}, fit.function(), true, {"the error is not measured: the text is the model, in single precision"}};
}

}  // namespace

std::string GlslText(const FittedBrdf& fit, const std::vector<std::string>& header) {
  return CommentLines(header, "//") + FunctionText(fit, false);
}

std::string OslText(const FittedBrdf& fit, const std::string& name, const std::vector<std::string>& header) {
  std::string text =
      CommentLines(header, "//") + Replaced(Replaced(FunctionText(fit, true), "vec3", "vector"), "atan(", "atan2(");
  const std::string inputs = "vector wi = vector(0.0, 0.0, 1.0), vector wo = vector(0.0, 0.0, 1.0)";
  if (fit.IsRgbOrGrey()) {
    return text + fmt::format(
                      "shader {}({}, output color f_r = 0) {{\n  vector f = lobefit_f_r(wi, wo);\n"
                      "  f_r = color(f[0], f[1], f[2]);\n}}\n",
                      Identifier(name), inputs);
  }
  const std::size_t channels = fit.material().channels.size();
  return text + fmt::format("shader {}({}, output float f_r[{}] = {{ 0.0 }}) {{\n  lobefit_f_r(wi, wo, f_r);\n}}\n",
                            Identifier(name), inputs, channels);
}

std::string BrdfExplorerText(const FittedBrdf& fit, const std::vector<std::string>& header) {
  std::string text = CommentLines(header, "#") + "analytic\n\n::begin parameters\n";
  const std::vector<Parameter> parameters = Parameters(fit.material().model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    const std::vector<double>& values = fit.material().parameters[p].values;
    const double factor = 1 / InsideFactor(parameter);
    const std::string name = Identifier(parameter.json_name);
    if (parameter.per_channel) {
      const auto at = [&](std::size_t c) { return FloatLiteral(values[values.size() == 1 ? 0 : c]); };
      text += fmt::format("color {} {} {} {}\n", name, at(0), at(1), at(2));
    } else {
      text += fmt::format("float {} {} {} {}\n", name, FloatLiteral(parameter.low * factor),
                          FloatLiteral(parameter.high * factor), FloatLiteral(values[0] * factor));
    }
  }
  text += fmt::format("::end parameters\n\n::begin shader\n{}{}\n", kLobeText, kSlopeText);
  text += "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) {\n";
  text += "  vec3 wi = vec3(dot(L, X), dot(L, Y), dot(L, N)), wo = vec3(dot(V, X), dot(V, Y), dot(V, N));\n";
  text += "  if (wi.z <= 0.0 || wo.z <= 0.0) { return vec3(0.0); }\n";
  text += kHalf;
  text += fit.material().model.diffuse == Diffuse::kLambert ? "  vec3 f_r = diffuse / 3.14159265358979;\n"
                                                            : "  vec3 f_r = vec3(0.0);\n";
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    const std::string prefix = l == 0 ? "" : fmt::format("lobe{}_", l + 1);
    const FittedLobe& lobe = fit.lobes()[l];
    // Where the distribution ties alpha_y, one slider moves both.
    const bool tied = IsRound(lobe.choices.ndf);
    text += fmt::format(
        "  f_r += lobefit_ellipsoid(wi, wo, h, {0}alpha_x, {0}{1}, {0}theta_x_deg, {0}theta_y_deg, {0}theta_z_deg, "
        "{2}, "
        "{3}) *\n         vec3(",
        prefix, tied ? "alpha_x" : "alpha_y", FamilyNumber(lobe), MaskingNumber(lobe));
    for (const char* channel : {".r", ".g", ".b"}) {
      std::vector<std::string> names;
      const std::size_t first = FirstParameter(fit.material().model, l) + kShapeParameters;
      for (std::size_t k = 0; k < FresnelParameters(lobe.choices.fresnel); ++k) {
        names.push_back(Identifier(parameters[first + k].name) + channel);
      }
      text += FresnelText(lobe.choices.fresnel, names) + (channel[1] == 'b' ? ");\n" : ", ");
    }
  }
  return text + "  return f_r;\n}\n::end shader\n";
}

WrittenFiles WriteGlsl(const FittedBrdf& fit, const WriteContext& context) {
  return Write(fit, context.File(".glsl"), GlslText(fit, context.header));
}

WrittenFiles WriteOsl(const FittedBrdf& fit, const WriteContext& context) {
  return Write(fit, context.File(".osl"), OslText(fit, context.name, context.header));
}

WrittenFiles WriteBrdfExplorer(const FittedBrdf& fit, const WriteContext& context) {
  return Write(fit, context.File(".brdf"), BrdfExplorerText(fit, context.header));
}

}  // namespace lobefit
