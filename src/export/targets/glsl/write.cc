#include "lobefit/export/targets/glsl/write.h"

#include <fmt/format.h>

#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/sel/document.h"
#include "lobefit/export/targets/shader_text.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

WrittenFiles WriteGlsl(const FittedBrdf& fit, const WriteContext& context) {
  return WriteShader(context.File(".glsl"), GlslText(fit, context.name, context.header));
}

}  // namespace

std::string GlslText(const FittedBrdf& fit, const std::string& name, const std::vector<std::string>& header) {
  const std::string prefix = GlslPrefix(name), own = prefix + "f_r";
  std::string text =
      CommentLines(header, "//") +
      fmt::format("#ifndef LOBEFIT_LOBE\n#define LOBEFIT_LOBE{}#endif\n// {}\n", kShaderLobeText, kShaderContract) +
      ShaderFunctions(fit, prefix);
  if (fit.IsRgbOrGrey()) {
    text += fmt::format("vec3 {}(vec3 wi, vec3 wo) {{\n  if (wi[2] <= 0.0 || wo[2] <= 0.0) {{ return vec3(0.0); }}\n",
                        own) +
            kShaderHalfText + ShaderBody(fit, prefix) + "  return f_r;\n}\n";
  } else {
    const std::size_t channels = fit.material().channels.size();
    text += "// Channels:";
    for (const std::string& channel : fit.material().channels) text += " " + channel;
    text += fmt::format(
                "\nvoid {0}(vec3 wi, vec3 wo, out float f_r[{1}]) {{\n  for (int k = 0; k < {1}; ++k) {{ f_r[k] = "
                "0.0; }}\n  if (wi[2] <= 0.0 || wo[2] <= 0.0) {{ return; }}\n",
                own, channels) +
            kShaderHalfText + ShaderBody(fit, prefix) + "}\n";
  }
  return text + GlslShortName("f_r", own);
}

Target GlslTarget() {
  return {.name = "glsl",
          .description = "GLSL function of the exact model",
          .load =
              "f_r = {glsl}f_r(wi, wo), directions in the tangent frame; lobefit_f_r is that of the shader's "
              "first file",
          .refusal = RefuseUnknownTerms,
          .carries = CarriesModelItself,
          .write = WriteGlsl,
          .write_sel = WriteSelGlsl};
}

}  // namespace lobefit
