// pbrt-v4's own parser and materials on an exported file:
//   pbrt SCENE TURN < rows
// SCENE is what stands after WorldBegin: `Include "NAME.pbrt"` or a Material of a measured file; file names count from
// the current folder, as they do from a main scene there. Each row begins with theta_i, phi_i, theta_o, phi_o in
// degrees. TURN: of the mesh's texture coordinates about the normal, in degrees. Prints the f_r of pbrt's BSDF as
// linear sRGB under D65, one line a row. A mixture, of which pbrt chooses one material at random, is the sum of its
// parts by their shares.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <pbrt/cameras.h>
#include <pbrt/interaction.h>
#include <pbrt/materials.h>
#include <pbrt/options.h>
#include <pbrt/parser.h>
#include <pbrt/samplers.h>
#include <pbrt/scene.h>
#include <pbrt/util/colorspace.h>
#include <pbrt/util/spectrum.h>

namespace {

using Parts = std::vector<std::pair<pbrt::Material, double>>;

// Keeps the amounts of mixtures and the material that is in force at the end.
class Builder : public pbrt::BasicSceneBuilder {
 public:
  using BasicSceneBuilder::BasicSceneBuilder;
  void MakeNamedMaterial(const std::string& name, pbrt::ParsedParameterVector parameters, pbrt::FileLoc at) override {
    for (const pbrt::ParsedParameter* parameter : parameters) {
      if (parameter->name == "amount") amounts[name] = parameter->floats[0];
    }
    BasicSceneBuilder::MakeNamedMaterial(name, std::move(parameters), at);
  }
  void NamedMaterial(const std::string& name, pbrt::FileLoc at) override {
    last = name;
    BasicSceneBuilder::NamedMaterial(name, at);
  }
  std::map<std::string, double> amounts;
  std::string last;
};

void Collect(const pbrt::Material& material, double share, const std::map<pbrt::Material, double>& amounts,
             Parts* parts) {
  if (!material.Is<pbrt::MixMaterial>()) {
    parts->push_back({material, share});
    return;
  }
  const pbrt::MixMaterial* mix = material.Cast<pbrt::MixMaterial>();
  const double amount = amounts.at(material);
  Collect(mix->GetMaterial(0), share * (1 - amount), amounts, parts);
  Collect(mix->GetMaterial(1), share * amount, amounts, parts);
}

Parts Load(const std::string& text, pbrt::BasicScene* scene) {
  Builder builder(scene);
  pbrt::ParseString(&builder, "WorldBegin\n" + text + "\n");
  pbrt::NamedTextures textures = scene->CreateTextures();
  std::map<std::string, pbrt::Material> named;
  std::vector<pbrt::Material> others;
  scene->CreateMaterials(textures, &named, &others);
  std::map<pbrt::Material, double> amounts;
  for (const auto& [name, amount] : builder.amounts) amounts[named.at(name)] = amount;
  Parts parts;
  Collect(builder.last.empty() ? others.back() : named.at(builder.last), 1, amounts, &parts);
  return parts;
}

pbrt::Vector3f Direction(double theta_deg, double phi_deg) {
  const double theta = theta_deg * M_PI / 180, phi = phi_deg * M_PI / 180;
  return pbrt::Vector3f(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const pbrt::Vector3f along = Direction(90, std::atof(arguments[2])), across(-along.y, along.x, 0);
  pbrt::PBRTOptions options;
  options.quiet = true;
  options.nThreads = 1;
  options.renderingSpace = pbrt::RenderingCoordinateSystem::World;
  pbrt::InitPBRT(options);
  pbrt::BasicScene scene;
  const Parts parts = Load(arguments[1], &scene);
  pbrt::Camera camera = scene.GetCamera();
  pbrt::Sampler sampler = scene.GetSampler();
  sampler.StartPixelSample(pbrt::Point2i(0, 0), 0);

  constexpr int kSets = 32;
  const pbrt::RGBColorSpace& srgb = *pbrt::RGBColorSpace::sRGB;
  pbrt::ScratchBuffer memory;
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream fields(line);
    double theta_i = 0, phi_i = 0, theta_o = 0, phi_o = 0;
    if (!(fields >> theta_i >> phi_i >> theta_o >> phi_o)) return 1;
    const pbrt::Vector3f wi = Direction(theta_i, phi_i), wo = Direction(theta_o, phi_o);
    double xyz[3] = {}, white = 0;
    for (int set = 0; set < kSets; ++set) {
      pbrt::SampledWavelengths lambda = pbrt::SampledWavelengths::SampleUniform((set + 0.5f) / kSets);
      pbrt::SampledSpectrum value(0.f);
      for (const auto& [material, share] : parts) {
        const pbrt::Point3fi origin(pbrt::Point3f(0, 0, 0));
        pbrt::SurfaceInteraction surface(origin, pbrt::Point2f(0.5f, 0.5f), wo, along, across, pbrt::Normal3f(0, 0, 0),
                                         pbrt::Normal3f(0, 0, 0), 0, false);
        surface.material = material;
        pbrt::RayDifferential ray(pbrt::Point3f(wo), -wo);
        ray.hasDifferentials = true;
        ray.rxOrigin = ray.ryOrigin = ray.o;
        ray.rxDirection = ray.ryDirection = ray.d;
        const pbrt::BSDF bsdf = surface.GetBSDF(ray, lambda, camera, memory, sampler);
        // Its integrators multiply by the cosine to the shading normal.
        value += static_cast<float>(share) * bsdf.f(wo, wi) * AbsDot(wi, surface.shading.n) / wi.z;
        memory.Reset();
      }
      const pbrt::SampledSpectrum light = srgb.illuminant.Sample(lambda);
      const pbrt::SampledSpectrum matching[3] = {pbrt::Spectra::X().Sample(lambda), pbrt::Spectra::Y().Sample(lambda),
                                                 pbrt::Spectra::Z().Sample(lambda)};
      for (int k = 0; k < pbrt::NSpectrumSamples; ++k) {
        white += light[k] * matching[1][k];
        for (int c = 0; c < 3; ++c) xyz[c] += value[k] * light[k] * matching[c][k];
      }
    }
    const pbrt::RGB rgb = srgb.ToRGB(pbrt::XYZ(xyz[0] / white, xyz[1] / white, xyz[2] / white));
    std::printf("%.9g %.9g %.9g\n", rgb.r, rgb.g, rgb.b);
  }
  return 0;
}
