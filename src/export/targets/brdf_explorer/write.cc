#include "lobefit/export/targets/brdf_explorer/write.h"

#include <fmt/format.h>

#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/shader_text.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

// The ellipsoid's slope coordinates, for the sliders; the last entry of the diagonal by the determinant, which does not
// cancel in single precision.
constexpr const char* kSlopeText = R"(
// Sine and cosine for -pi/2..pi/2 to single precision: those of GPUs may be off by 5e-4.
float lobefit_sin(float x) {
  float y = x * x;
  return x * (1.0 + y * (-1.0 / 6.0 + y * (1.0 / 120.0 + y * (-1.0 / 5040.0 + y * (1.0 / 362880.0 - y / 39916800.0)))));
}
float lobefit_cos(float x) { return lobefit_sin(1.57079633 - abs(x)); }
void lobefit_slopes(float ax, float ay, float tx_deg, float ty_deg, float tz_deg, out float slope_x, out float slope_y,
                    out float a, out float b, out float c) {
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
  slope_x = -(x2 * r1.x * r1.z + y2 * r2.x * r2.z + r3.x * r3.z) / m33;
  slope_y = -(x2 * r1.y * r1.z + y2 * r2.y * r2.z + r3.y * r3.z) / m33;
  float q11 = y2 * r1.y * r1.y + x2 * r2.y * r2.y + x2 * y2 * r3.y * r3.y;
  float q12 = -(y2 * r1.x * r1.y + x2 * r2.x * r2.y + x2 * y2 * r3.x * r3.y);
  a = sqrt(q11) / m33;
  b = q12 / (m33 * m33 * a);
  c = ax * ay / (m33 * sqrt(m33) * a);
}
)";

// Parameters of a profile are constants: the tables of its masking belong to them.
bool IsOfProfile(const FittedBrdf& fit, std::size_t parameter) {
  const Model& model = fit.material().model;
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    if (parameter >= FirstParameter(model, l) + kEllipseParameters && parameter < FirstFresnel(model, l)) return true;
  }
  return false;
}

WrittenFiles WriteBrdfExplorer(const FittedBrdf& fit, const WriteContext& context) {
  std::vector<std::string> header = context.header;
  const std::size_t parameters = fit.material().parameters.size();
  std::size_t constants = 0;
  for (std::size_t p = 0; p < parameters; ++p) constants += IsOfProfile(fit, p) ? 1 : 0;
  const char* const note = "the numbers of a profile have no sliders: the tables of the masking belong to them";
  if (constants > 0) header.emplace_back(note);
  WrittenFiles written = WriteShader(context.File(".brdf"), BrdfExplorerText(fit, header));
  if (constants > 0) written.notes.emplace_back(note);
  return written;
}

}  // namespace

std::string BrdfExplorerText(const FittedBrdf& fit, const std::vector<std::string>& header) {
  // The program reads the first line before it drops comments.
  std::string text = "analytic\n" + CommentLines(header, "#") + "\n::begin parameters\n";
  const std::vector<Parameter> parameters = Parameters(fit.material().model);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    if (IsOfProfile(fit, p)) continue;
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
  text += fmt::format("::end parameters\n\n::begin shader\n{}{}{}\n", kShaderLobeText, ShaderFunctions(fit, "lobefit_"),
                      kSlopeText);
  text += "vec3 BRDF(vec3 L, vec3 V, vec3 N, vec3 X, vec3 Y) {\n";
  text += "  vec3 wi = vec3(dot(L, X), dot(L, Y), dot(L, N)), wo = vec3(dot(V, X), dot(V, Y), dot(V, N));\n";
  text += "  if (wi.z <= 0.0 || wo.z <= 0.0) { return vec3(0.0); }\n";
  const Model& model = fit.material().model;
  const std::size_t coat = CoatOf(model);
  const auto names_of = [&](std::size_t first, std::size_t count, const char* channel) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < count; ++k) names.push_back(Identifier(parameters[first + k].json_name) + channel);
    return names;
  };
  const auto coat_names = [&](const char* channel) {
    return coat < model.lobes.size() ? names_of(FirstFresnel(model, coat), 2, channel) : std::vector<std::string>{};
  };
  text += kShaderHalfText + ShaderSetup(fit, coat < model.lobes.size() ? coat_names(".r")[0] : "") +
          "  float slope_x, slope_y, a, b, c;\n";
  // The names of `count` sliders from `first` on, in each of the three channels.
  const auto colour = [&](std::size_t first, std::size_t count, const auto& expression) {
    std::vector<std::string> channels;
    for (const char* channel : {".r", ".g", ".b"})
      channels.push_back(expression(names_of(first, count, channel), coat_names(channel)));
    return fmt::format("vec3({})", fmt::join(channels, ",\n              "));
  };
  text += fmt::format("  vec3 f_r = {};\n",
                      colour(FirstParameter(model, model.lobes.size()), DiffuseParameters(model.diffuse),
                             [&](const std::vector<std::string>& names, const std::vector<std::string>& of_coat) {
                               return ShaderDiffuse(fit, names, of_coat);
                             }));
  const auto add_lobe = [&](std::size_t l) {
    const std::string prefix = l == 0 ? "" : fmt::format("lobe{}_", l + 1);
    const Lobe& lobe = fit.lobes()[l].choices;
    // Where the distribution ties alpha_y, one slider moves both.
    text += fmt::format(
        "  lobefit_slopes({0}alpha_x, {0}{1}, {0}theta_x_deg, {0}theta_y_deg, {0}theta_z_deg, slope_x, slope_y, a, b, "
        "c);\n  f_r += {2} *\n         {3};\n",
        prefix, IsRound(lobe.ndf) ? "alpha_x" : "alpha_y", ShaderLobe(fit, l, "lobefit_", "slope_x, slope_y, a, b, c"),
        colour(FirstFresnel(model, l), FresnelParameters(lobe.fresnel),
               [&](const std::vector<std::string>& names, const std::vector<std::string>&) {
                 return ShaderFresnel(fit, l, names);
               }));
  };
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    if (l != coat) add_lobe(l);
  }
  if (coat < fit.lobes().size()) {
    text += fmt::format("  f_r *= {};\n",
                        colour(FirstFresnel(model, coat), 2,
                               [&](const std::vector<std::string>& names, const std::vector<std::string>&) {
                                 return ShaderThrough(fit, names);
                               }));
    add_lobe(coat);
  }
  return text + "  return f_r;\n}\n::end shader\n";
}

Target BrdfExplorerTarget() {
  return {.name = "brdf-explorer",
          .description = "Disney BRDF Explorer, parameters as sliders",
          .load = "brdf {name}.brdf",
          .rgb_only = true,
          .refusal = RefuseUnknownTerms,
          .carries = CarriesModelItself,
          .write = WriteBrdfExplorer};
}

}  // namespace lobefit
