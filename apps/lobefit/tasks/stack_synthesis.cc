#include "tasks/stack_synthesis.h"

#include <memory>

#include "options/number_option.h"
#include "text/output.h"
#include <fmt/format.h>

#include "lobefit/maps/document.h"
#include "lobefit/maps/stack/layouts.h"
#include "lobefit/maps/synthetic/hills.h"
#include "lobefit/maps/synthetic/write_stack.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

std::filesystem::path DocumentOf(const std::filesystem::path& maps) {
  return std::filesystem::path(maps).replace_extension(".json");
}

}  // namespace

void StackSynthesisOptions::AddTo(CLI::App* app) {
  const char* what = "Image stack";
  app->add_flag("--stack", wanted_, "write an image stack with its truth into the folder --out")->group(what);
  app->add_option("--lights", lights_, "number of lights of a dome, or a light file (.lp) (default 96)")->group(what);
  app->add_option("--light-theta-max", light_theta_max_deg_,
                  "polar angle of the lowest light of the dome, degrees (default 65)")
      ->check(Within(5, 89))
      ->group(what);
  app->add_option("--light-distance", light_distance_,
                  "distance of the lights, in widths of the picture (default: far away)")
      ->check(Within(0.6, 1000))
      ->group(what);
  app->add_option("--camera-distance", camera_distance_,
                  "distance of a camera above the middle, in widths of the picture (default: far away)")
      ->check(Within(0.6, 1000))
      ->group(what);
  app->add_option("--size", size_, "texels a side of hills (default 64)")->check(CLI::Range(8, 8192))->group(what);
  app->add_option("--steepness", steepness_, "factor of the height of hills (default 1)")
      ->check(Within(0, 5))
      ->group(what);
  app->add_option("--bits", bits_, "16: PNG (default); 32: OpenEXR")->check(CLI::IsMember({16, 32}))->group(what);
  app->add_flag("--cast-shadows", shadows_, "hills shade each other")->group(what);
}

int StackSynthesisOptions::Write(const std::string& source, const SynthesisOptions& synthesis,
                                 const std::string& out) const {
  StackSynthesis stack;
  stack.noise = synthesis.ChosenNoise(), stack.seed = synthesis.seed(), stack.bits = bits_;
  stack.distance = light_distance_, stack.camera_distance = camera_distance_;
  if (const std::optional<long long> count = ParseInteger(lights_)) {
    if (*count < 4 || *count > 4096) throw UsageError("--lights: 4 to 4096 lights are expected");
    stack.lights = DomeLights(static_cast<std::size_t>(*count), light_theta_max_deg_ * kPi / 180);
  } else {
    for (const StackLight& light : ReadLightFile(lights_).stack.lights) stack.lights.push_back(light.direction);
  }
  auto hills = std::make_shared<Hills>();
  if (source == "hills" || source == "brushed-hills") {
    *hills = MakeHills(size_, source == "hills" ? MapLobe::kGgx : MapLobe::kGgxAnisotropic, steepness_);
    if (shadows_) {
      stack.shadow = [=](std::size_t texel, const Vec3& light) { return InCastShadow(*hills, texel, light); };
    }
  } else {
    if (shadows_) throw UsageError("--cast-shadows needs heights, which only hills and brushed-hills have");
    hills->maps = ReadMapsExr(source);
    stack.calibrated = ReadMapsRecord(DocumentOf(source)).calibrated;
    stack.fallback = MedianFallback(hills->maps);
  }
  WriteStack(hills->maps, stack, out);
  Print(fmt::format("{}: {} lights, {} x {}\n", PrintableName(out), stack.lights.size(), hills->maps.rows.width,
                    hills->maps.rows.rows));
  return kExitDone;
}

}  // namespace lobefit
