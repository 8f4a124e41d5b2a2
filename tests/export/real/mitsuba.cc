// Mitsuba 3's own parser and plugins on an exported file:
//   mitsuba VARIANT SCENE.xml TURN < rows
// VARIANT: scalar_rgb or scalar_spectral. The first shape of the scene has the BSDF. Each row begins with theta_i,
// phi_i, theta_o, phi_o in degrees. TURN: of the shape's texture coordinates about the normal, in
// degrees. Prints its f_r as linear sRGB, under D65 in the spectral variant, one line a row.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include <mitsuba/core/bitmap.h>
#include <mitsuba/core/fresolver.h>
#include <mitsuba/core/jit.h>
#include <mitsuba/core/logger.h>
#include <mitsuba/core/parser.h>
#include <mitsuba/core/spectrum.h>
#include <mitsuba/core/thread.h>
#include <mitsuba/core/util.h>
#include <mitsuba/render/bsdf.h>
#include <mitsuba/render/interaction.h>
#include <mitsuba/render/scene.h>
#include <mitsuba/render/shape.h>
#include <nanothread/nanothread.h>

using namespace mitsuba;

namespace {

Vector<float, 3> Direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * M_PI / 180, phi = phi_deg * M_PI / 180;
  return {static_cast<float>(std::sin(theta) * std::cos(phi)), static_cast<float>(std::sin(theta) * std::sin(phi)),
          static_cast<float>(std::cos(theta))};
}

// f_r: a BSDF of Mitsuba's has the cosine of its second direction.
template <typename Float, typename Spectrum>
Color<float, 3> Evaluate(const BSDF<Float, Spectrum>* bsdf, SurfaceInteraction<Float, Spectrum>* at,
                         const Vector<float, 3>& wi) {
  const BSDFContext context;
  const float cosine = wi.z();
  if constexpr (is_rgb_v<Spectrum>) {
    return bsdf->eval(context, *at, wi) / cosine;
  } else {
    Color<float, 3> xyz(0.f);
    float white = 0;
    constexpr int kSets = 32;
    constexpr float kStep = (MI_CIE_MAX - MI_CIE_MIN) / (4 * kSets);
    for (int set = 0; set < kSets; ++set) {
      for (int k = 0; k < 4; ++k) at->wavelengths[k] = MI_CIE_MIN + (4 * set + k + 0.5f) * kStep;
      const Spectrum value = bsdf->eval(context, *at, wi) / cosine;
      for (int k = 0; k < 4; ++k) {
        const float light = cie_d65<float>(at->wavelengths[k]);
        const Color<float, 3> matching = cie1931_xyz<float>(at->wavelengths[k]);
        xyz += value[k] * light * matching;
        white += light * matching.y();
      }
    }
    return xyz_to_srgb(Color<float, 3>(xyz / white));
  }
}

template <typename Float, typename Spectrum>
void Run(Object* object, double turn_deg) {
  auto* scene = dynamic_cast<Scene<Float, Spectrum>*>(object);
  if (scene == nullptr || scene->shapes().empty()) Throw("the scene has no shape");
  const BSDF<Float, Spectrum>* bsdf = scene->shapes()[0]->bsdf();
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream fields(line);
    double theta_i = 0, phi_i = 0, theta_o = 0, phi_o = 0;
    if (!(fields >> theta_i >> phi_i >> theta_o >> phi_o)) Throw("not a row: %s", line);
    auto at = dr::zeros<SurfaceInteraction<Float, Spectrum>>();
    at.uv = {0.5f, 0.5f};
    at.n = {0, 0, 1};
    at.sh_frame = Frame<Float>(at.n);
    at.sh_frame.s = at.dp_du = Direction(90, turn_deg);
    at.sh_frame.t = at.dp_dv = Direction(90, turn_deg + 90);
    at.wi = at.to_local(Direction(theta_o, phi_o));
    const Color<float, 3> rgb = Evaluate<Float, Spectrum>(bsdf, &at, at.to_local(Direction(theta_i, phi_i)));
    std::printf("%.9g %.9g %.9g\n", rgb[0], rgb[1], rgb[2]);
  }
}

template <typename Float, typename Spectrum>
void Start() {
  Scene<Float, Spectrum>::static_accel_initialization();
}

int Main(const std::string& variant, const std::string& path, double turn_deg) {
  Jit::static_initialization();
  Thread::static_initialization();
  Logger::static_initialization();
  Bitmap::static_initialization();
  librender_nop();
  Thread::thread()->logger()->set_log_level(Warn);
  pool_set_size(nullptr, 0);
  color_management_static_initialization(false, false);
  MI_INVOKE_VARIANT(variant, Start);
  file_resolver()->append(util::library_path().parent_path());
  // The folder of the main scene file, as the program does it.
  file_resolver()->append(fs::path(path).parent_path());
  parser::ParserConfig config(variant);
  parser::ParserState state = parser::parse_file(config, path);
  parser::transform_all(config, state);
  const std::vector<ref<Object>> objects = parser::instantiate(config, state);
  MI_INVOKE_VARIANT(variant, Run, const_cast<Object*>(objects[0].get()), turn_deg);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  try {
    return Main(arguments[1], arguments[2], std::atof(arguments[3]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
