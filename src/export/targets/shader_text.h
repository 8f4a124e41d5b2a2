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

// The functions that belong to the radial lobes of this fit; their names begin with `prefix`.
std::string ShaderFunctions(const FittedBrdf& fit, const std::string& prefix);
// The body of a function of wi and wo after that: R, G, B or grey in `f_r`, or the values of the array `f_r`.
std::string ShaderBody(const FittedBrdf& fit, const std::string& prefix);

// The expressions that it is made of, with the names of the parameters as text. The lobe without its Fresnel term, by
// the five `slopes` of lobefit_lobe:
std::string ShaderLobe(const FittedBrdf& fit, std::size_t lobe, const std::string& prefix, const std::string& slopes);
// Its Fresnel factor, of `cos_d`, a retro lobe's `cos_back` or a lobe's `cos_below` a coat:
std::string ShaderFresnel(const FittedBrdf& fit, std::size_t lobe, const std::vector<std::string>& parameters);
// The diffuse part; no parameter where there is none. `coat`: the parameters of the coat above it, if there is one.
std::string ShaderDiffuse(const FittedBrdf& fit, const std::vector<std::string>& parameters,
                          const std::vector<std::string>& coat);
// What the coat lets through, by its parameters.
std::string ShaderThrough(const FittedBrdf& fit, const std::vector<std::string>& coat);
// Statements for directions below a coat and for the mirrored light direction, where a lobe needs them.
std::string ShaderSetup(const FittedBrdf& fit, const std::string& coat_ior);

std::string Replaced(std::string text, const std::string& from, const std::string& to);

// The files of a text that is the model itself.
WrittenFiles WriteShader(const std::filesystem::path& path, const std::string& text);

}  // namespace lobefit
