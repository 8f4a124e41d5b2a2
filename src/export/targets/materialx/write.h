// MaterialX 1.39: generalized_schlick_bsdf or conductor_bsdf plus a diffuse BSDF; and the OpenPBR surface.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {

// Evaluated as MaterialX' own GLSL does: height-correlated masking of the mean width, energy compensation.
Surface MaterialXSurface(const FittedBrdf& fit);
WrittenFiles WriteMaterialX(const FittedBrdf& fit, const WriteContext& context);

// What an OpenPBR surface holds of a fit: one lobe, a base colour for metal and diffuse base alike.
struct OpenPbr {
  Color3 base_color = {0.8, 0.8, 0.8};
  double metalness = 0, ior = 1.5;
  RoughnessPair roughness = {0.3, 0};
  double rotation = 0;
  Vec3 normal = {0, 0, 1};
};
OpenPbr OpenPbrOf(const FittedBrdf& fit);
Surface OpenPbrSurface(const OpenPbr& parameters);
WrittenFiles WriteOpenPbr(const FittedBrdf& fit, const WriteContext& context);

// The first material of the document. Throws InputError.
struct MaterialXDocument {
  Surface surface;
  bool open_pbr = false;
};
MaterialXDocument ReadMaterialX(std::string_view bytes, const std::filesystem::path& path);

// Metalness and base colour with which a metal of that colour and a dielectric of reflectance `dielectric` over a
// diffuse base of the same colour have the reflectance f0 and the diffuse albedo, in the mean of the channels.
struct MetalBase {
  double metalness = 1;
  Color3 base = {0, 0, 0};
};
MetalBase MetalBaseOf(const Color3& f0, const Color3& diffuse, double dielectric);

}  // namespace lobefit
