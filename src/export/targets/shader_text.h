// The fitted model as program text: GLSL that is OSL but for a few names.
#pragma once

#include <string>
#include <vector>

#include "lobefit/core/brdf/model.h"
#include "lobefit/export/targets/target.h"

namespace lobefit {

// The functions that every model's text calls, by the names lobefit_lobe, lobefit_schlick and so on.
extern const char* const kShaderLobeText;

// What f_r is and which way its directions point, one comment line.
extern const char* const kShaderContract;
// The half vector `h` and the cosine `cos_d`, of wi and wo.
extern const char* const kShaderHalfText;

// The body of a function of wi and wo after that: R, G, B or grey in `f_r`, or the values of the array `f_r`.
std::string ShaderBody(const FittedBrdf& fit);
// The Fresnel factor as an expression of `cos_d`, with the parameters as text.
std::string ShaderFresnel(Fresnel fresnel, const std::vector<std::string>& parameters);
// Numbers of a lobe's distribution and masking as kShaderLobeText takes them.
int ShaderFamily(const FittedLobe& lobe);
int ShaderMasking(const FittedLobe& lobe);

std::string Replaced(std::string text, const std::string& from, const std::string& to);

// The files of a text that is the model itself.
WrittenFiles WriteShader(const FittedBrdf& fit, const std::filesystem::path& path, const std::string& text);

}  // namespace lobefit
