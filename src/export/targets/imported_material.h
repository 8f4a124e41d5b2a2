// A material file as its renderer evaluates it.
#pragma once

#include <string>
#include <vector>

#include "lobefit/measurement/brdf_function.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct ImportedMaterial {
  std::string format;  // "pbrt", "mitsuba", "materialx", "openpbr", "gltf", "rgl", "merl", "json"
  // R, G, B for the text formats of renderers; else what the file holds.
  Channels channels;
  // f_r in 1/sr as the renderer of the format evaluates it, in a frame whose x is the tangent (the mesh's u, or x
  // turned by the angle that a comment of our exports states where the format has no rotation); 0 where a direction is
  // at or below the horizon. Safe from several threads.
  BrdfFunction brdf;
  std::vector<std::string> remarks;  // what was assumed, in words
};

}  // namespace lobefit
