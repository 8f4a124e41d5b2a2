// The loader of Disney's BRDF Explorer on an exported file:
//   brdf_explorer FILE.brdf
// Says whether it is loaded, with how many parameters, and prints the BRDF function that the program gives its shaders
// to standard output, with the parameters as constants: text for a GLSL compiler.
#include <cstdio>

#include "BRDFAnalytic.h"

namespace {

class Loader : public BRDFAnalytic {
 public:
  using BRDFAnalytic::getBRDFFunction;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  Loader brdf;
  if (!brdf.loadBRDF(arguments[1])) {
    std::fprintf(stderr, "refused\n");
    return 1;
  }
  std::fprintf(stderr, "loaded, %d parameters\n", brdf.getParameterCount());
  std::printf("#version 410\n");
  for (int k = 0; k < brdf.getFloatParameterCount(); ++k) {
    const brdfFloatParam* parameter = brdf.getFloatParameter(k);
    std::printf("const float %s = %.9g;\n", parameter->name.c_str(), static_cast<double>(parameter->defaultVal));
  }
  for (int k = 0; k < brdf.getColorParameterCount(); ++k) {
    const brdfColorParam* parameter = brdf.getColorParameter(k);
    std::printf("const vec3 %s = vec3(%.9g, %.9g, %.9g);\n", parameter->name.c_str(),
                static_cast<double>(parameter->defaultVal[0]), static_cast<double>(parameter->defaultVal[1]),
                static_cast<double>(parameter->defaultVal[2]));
  }
  std::printf(
      "%s\nin vec3 a; in vec3 b; out vec4 c;\nvoid main() { c = vec4(BRDF(a, b, vec3(0.0, 0.0, 1.0), "
      "vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0)), 1.0); }\n",
      brdf.getBRDFFunction().c_str());
  return 0;
}
