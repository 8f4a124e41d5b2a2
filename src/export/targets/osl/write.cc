#include "lobefit/export/targets/osl/write.h"

#include <fmt/format.h>

#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/shader_text.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

constexpr const char* kNoClosure =
    "a function of two directions, no closure: OSL's renderers shade with closures, so that none can use it as a "
    "material; testshade and shaders that ask for f_r can";

std::string FunctionText(const FittedBrdf& fit) {
  const std::string prefix = "lobefit_";
  std::string text = kShaderLobeText + fmt::format("// {}\n", kShaderContract) + ShaderFunctions(fit, prefix);
  if (fit.IsRgbOrGrey()) {
    return text +
           "vec3 lobefit_f_r(vec3 wi, vec3 wo) {\n  if (wi[2] <= 0.0 || wo[2] <= 0.0) { return vec3(0.0, 0.0, 0.0); "
           "}\n" +
           kShaderHalfText + ShaderBody(fit, prefix) + "  return f_r;\n}\n";
  }
  const std::size_t channels = fit.material().channels.size();
  text += "// Channels:";
  for (const std::string& channel : fit.material().channels) text += " " + channel;
  return text +
         fmt::format(
             "\nvoid lobefit_f_r(vec3 wi, vec3 wo, output float f_r[{0}]) {{\n  for (int k = 0; k < {0}; ++k) {{ "
             "f_r[k] = 0.0; }}\n  if (wi[2] <= 0.0 || wo[2] <= 0.0) {{ return; }}\n",
             channels) +
         kShaderHalfText + ShaderBody(fit, prefix) + "}\n";
}

WrittenFiles WriteOsl(const FittedBrdf& fit, const WriteContext& context) {
  std::vector<std::string> header = context.header;
  header.emplace_back(kNoClosure);
  WrittenFiles written = WriteShader(context.File(".osl"), OslText(fit, context.name, header));
  written.notes.emplace_back(kNoClosure);
  return written;
}

}  // namespace

std::string OslText(const FittedBrdf& fit, const std::string& name, const std::vector<std::string>& header) {
  std::string text =
      CommentLines(header, "//") + Replaced(Replaced(FunctionText(fit), "vec3", "vector"), "atan(", "atan2(");
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

Target OslTarget() {
  return {.name = "osl",
          .description = "OSL function and shader of the exact model, no closure",
          .load = "oslc -I(folder of stdosl.h) {name}.osl; f_r = lobefit_f_r(wi, wo)",
          .refusal = RefuseUnknownTerms,
          .carries = CarriesModelItself,
          .write = WriteOsl};
}

}  // namespace lobefit
