#include "lobefit/export/targets/materialx/write.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/file.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

// Reflectances up to here are a dielectric's over a coloured base, beyond a metal's.
constexpr double kMostDielectric = 0.16;
constexpr double kDefaultDielectric = 0.04;  // ior 1.5

double Mean(const Color3& color) { return (color[0] + color[1] + color[2]) / 3; }

// A unit vector as nodes: a combination of tangent, bitangent and normal of the mesh. Returns the nodes' text; the
// last one is called `name`.
std::string VectorNodes(const std::string& name, const Vec3& v) {
  const double parts[3] = {v.x, v.y, v.z};
  const char* axes[3] = {"mesh_tangent", "mesh_bitangent", "mesh_normal"};
  std::string text, sum;
  for (int i = 0; i < 3; ++i) {
    if (parts[i] == 0) continue;
    const std::string part = fmt::format("{}_{}", name, i);
    text += fmt::format(
        "  <multiply name=\"{}\" type=\"vector3\">\n    <input name=\"in1\" type=\"vector3\" nodename=\"{}\"/>\n"
        "    <input name=\"in2\" type=\"float\" value=\"{}\"/>\n  </multiply>\n",
        part, axes[i], Number9(parts[i]));
    if (!sum.empty()) {
      text += fmt::format(
          "  <add name=\"{0}_sum{1}\" type=\"vector3\">\n    <input name=\"in1\" type=\"vector3\" nodename=\"{2}\"/>\n"
          "    <input name=\"in2\" type=\"vector3\" nodename=\"{3}\"/>\n  </add>\n",
          name, i, sum, part);
      sum = fmt::format("{}_sum{}", name, i);
    } else {
      sum = part;
    }
  }
  return text + fmt::format(
                    "  <normalize name=\"{}\" type=\"vector3\">\n    <input name=\"in\" type=\"vector3\" "
                    "nodename=\"{}\"/>\n  </normalize>\n",
                    name, sum);
}

std::string MeshFrame() {
  std::string text;
  for (const char* axis : {"tangent", "bitangent", "normal"}) {
    text += fmt::format(
        "  <{0} name=\"mesh_{0}\" type=\"vector3\">\n    <input name=\"space\" type=\"string\" value=\"world\"/>\n"
        "  </{0}>\n",
        axis);
  }
  return text;
}

std::string Document(const WriteContext& context, const std::string& nodes) {
  return "<?xml version=\"1.0\"?>\n" + XmlComment(context.header) +
         "<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n" + nodes + "</materialx>\n";
}

// Nodes of the tangent and the normal where they are not the mesh's, and the inputs that name them.
struct FrameText {
  std::string nodes, tangent = "mesh_tangent", normal = "mesh_normal";
};
FrameText FrameNodes(const std::string& prefix, double rotation, const Vec3& normal) {
  FrameText frame;
  const bool tilted = normal.z < 1;
  if (tilted) {
    frame.normal = prefix + "_normal";
    frame.nodes += VectorNodes(frame.normal, normal);
  }
  if (rotation != 0 || tilted) {
    frame.tangent = prefix + "_tangent";
    // Made perpendicular to the normal here: the BSDF nodes take it as it is.
    const Vec3 along = {std::cos(rotation), std::sin(rotation), 0};
    frame.nodes += VectorNodes(frame.tangent, Normalized(along - Dot(along, normal) * normal));
  }
  return frame;
}

std::string LobeNode(const std::string& name, const SurfaceLobe& lobe, const FrameText& frame) {
  const bool conductor = lobe.fresnel.kind == SurfaceFresnel::Kind::kConductor;
  const char* node = conductor ? "conductor_bsdf" : "generalized_schlick_bsdf";
  const auto color = [](const char* input, const Color3& value) {
    return fmt::format("    <input name=\"{}\" type=\"color3\" value=\"{}\"/>\n", input, Numbers9(value, ", "));
  };
  return fmt::format("  <{} name=\"{}\" type=\"BSDF\">\n", node, name) +
         (conductor ? color("ior", lobe.fresnel.eta) + color("extinction", lobe.fresnel.k)
                    : color("color0", lobe.fresnel.f0) + color("color90", lobe.fresnel.f90)) +
         fmt::format(
             "    <input name=\"roughness\" type=\"vector2\" value=\"{}, {}\"/>\n"
             "    <input name=\"normal\" type=\"vector3\" nodename=\"{}\"/>\n"
             "    <input name=\"tangent\" type=\"vector3\" nodename=\"{}\"/>\n"
             "    <input name=\"distribution\" type=\"string\" value=\"ggx\"/>\n  </{}>\n",
             Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2), frame.normal, frame.tangent, node);
}

}  // namespace

Surface MaterialXSurface(const FittedBrdf& fit) {
  Surface surface;
  surface.masking = SurfaceMasking::kMeanAlpha;
  surface.energy_compensation = true;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    surface.lobes.push_back(LobeOf(fit, l, 1));
    if (fit.lobes()[l].choices.fresnel == Fresnel::kConductor) {
      surface.lobes.back().fresnel = ConductorFresnelOf(fit, l, 1);
    }
  }
  surface.diffuse = DiffuseOf(fit);
  return surface;
}

WrittenFiles WriteMaterialX(const FittedBrdf& fit, const WriteContext& context) {
  const Surface surface = MaterialXSurface(fit);
  const std::string id = Identifier(context.name);
  std::string nodes = MeshFrame(), sum;
  const auto add = [&](const std::string& bsdf) {
    if (sum.empty()) {
      sum = bsdf;
      return;
    }
    const std::string both = sum + "_and_" + bsdf.substr(id.size() + 1);
    nodes += fmt::format(
        "  <add name=\"{}\" type=\"BSDF\">\n    <input name=\"in1\" type=\"BSDF\" nodename=\"{}\"/>\n"
        "    <input name=\"in2\" type=\"BSDF\" nodename=\"{}\"/>\n  </add>\n",
        both, sum, bsdf);
    sum = both;
  };
  for (std::size_t l = 0; l < surface.lobes.size(); ++l) {
    const std::string name = fmt::format("{}_lobe{}", id, l + 1);
    const FrameText frame = FrameNodes(name, surface.lobes[l].rotation, surface.lobes[l].normal);
    nodes += frame.nodes + LobeNode(name, surface.lobes[l], frame);
    add(name);
  }
  if (fit.HasDiffuse() || surface.lobes.empty()) {
    nodes += fmt::format(
        "  <oren_nayar_diffuse_bsdf name=\"{}_diffuse\" type=\"BSDF\">\n"
        "    <input name=\"color\" type=\"color3\" value=\"{}\"/>\n"
        "    <input name=\"roughness\" type=\"float\" value=\"0\"/>\n  </oren_nayar_diffuse_bsdf>\n",
        id, Numbers9(surface.diffuse, ", "));
    add(id + "_diffuse");
  }
  nodes += fmt::format(
      "  <surface name=\"{0}_surface\" type=\"surfaceshader\">\n    <input name=\"bsdf\" type=\"BSDF\" "
      "nodename=\"{1}\"/>\n  </surface>\n  <surfacematerial name=\"{0}\" type=\"material\">\n    <input "
      "name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"{0}_surface\"/>\n  </surfacematerial>\n",
      id, sum);
  const std::filesystem::path path = context.File(".mtlx");
  WriteFileAtomically(path, Document(context, nodes));
  return {{path}, InChannelsOf(fit, context.read_back(path).brdf), false, {}};
}

MetalBase MetalBaseOf(const Color3& f0, const Color3& diffuse, double dielectric) {
  MetalBase result;
  const double f = Mean(f0), rho = Mean(diffuse);
  if (rho > 0) {
    // With m = 1 - metalness: m b (1 - dielectric) = rho and (1 - m) b + m dielectric = f, by bisection; the first
    // grows with m from 0.
    const auto base = [&](double m) { return (f - dielectric * m) / (1 - m); };
    double low = 0, high = std::min(0.99, 0.99 * f / dielectric);
    for (int i = 0; i < 60; ++i) {
      const double m = (low + high) / 2;
      (m * base(m) * (1 - dielectric) < rho ? low : high) = m;
    }
    // No base reflects more than all: the diffuse part gives way.
    for (double m = low; m > 0; m *= 0.99) {
      low = m;
      if (base(m) <= 1) break;
    }
    result.metalness = 1 - low;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const double m = 1 - result.metalness;
    result.base[c] = std::clamp((f0[c] - m * dielectric) / result.metalness, 0.0, 1.0);
  }
  return result;
}

OpenPbr OpenPbrOf(const FittedBrdf& fit) {
  OpenPbr parameters;
  const Color3 diffuse = DiffuseOf(fit);
  const std::size_t strongest = StrongestLobe(fit);
  const SurfaceLobe lobe = LobeOf(fit, strongest, 1);
  parameters.roughness = OpenPbrRoughness(lobe.widths);
  parameters.rotation = lobe.rotation;
  parameters.normal = lobe.normal;
  const double f0 = Mean(lobe.fresnel.f0);
  if (fit.HasDiffuse() && *std::max_element(lobe.fresnel.f0.begin(), lobe.fresnel.f0.end()) <= kMostDielectric) {
    const double root = std::sqrt(std::max(f0, 0.0));
    parameters.ior = (1 + root) / (1 - root);
    for (std::size_t c = 0; c < 3; ++c) parameters.base_color[c] = std::min(1.0, diffuse[c] / (1 - f0));
    return parameters;
  }
  const MetalBase metal = MetalBaseOf(lobe.fresnel.f0, diffuse, kDefaultDielectric);
  parameters.metalness = metal.metalness;
  parameters.base_color = metal.base;
  return parameters;
}

Surface OpenPbrSurface(const OpenPbr& parameters) {
  Surface surface;
  surface.masking = SurfaceMasking::kMeanAlpha;
  surface.energy_compensation = true;
  SurfaceLobe lobe;
  lobe.widths = OpenPbrWidths(parameters.roughness);
  lobe.rotation = parameters.rotation;
  lobe.normal = parameters.normal;
  lobe.weight = parameters.metalness;
  lobe.fresnel.f0 = parameters.base_color;
  surface.lobes.push_back(lobe);
  lobe.weight = 1 - parameters.metalness;
  lobe.fresnel.kind = SurfaceFresnel::Kind::kDielectric;
  lobe.fresnel.eta = {parameters.ior, parameters.ior, parameters.ior};
  surface.lobes.push_back(lobe);
  surface.diffuse_normal = parameters.normal;
  surface.layering = Surface::Layering::kAlbedo;
  surface.layer_lobe = 1;
  for (std::size_t c = 0; c < 3; ++c) surface.diffuse[c] = (1 - parameters.metalness) * parameters.base_color[c];
  return surface;
}

WrittenFiles WriteOpenPbr(const FittedBrdf& fit, const WriteContext& context) {
  const OpenPbr parameters = OpenPbrOf(fit);
  const std::string id = Identifier(context.name);
  const FrameText frame = FrameNodes(id, parameters.rotation, parameters.normal);
  const auto real = [](const char* input, double value) {
    return fmt::format("    <input name=\"{}\" type=\"float\" value=\"{}\"/>\n", input, Number9(value));
  };
  const std::string nodes =
      MeshFrame() + frame.nodes + fmt::format("  <open_pbr_surface name=\"{}_surface\" type=\"surfaceshader\">\n", id) +
      fmt::format("    <input name=\"base_color\" type=\"color3\" value=\"{}\"/>\n",
                  Numbers9(parameters.base_color, ", ")) +
      real("base_metalness", parameters.metalness) + real("base_diffuse_roughness", 0) +
      real("specular_roughness", parameters.roughness.roughness) +
      real("specular_roughness_anisotropy", parameters.roughness.anisotropy) + real("specular_ior", parameters.ior) +
      fmt::format(
          "    <input name=\"geometry_normal\" type=\"vector3\" nodename=\"{}\"/>\n"
          "    <input name=\"geometry_tangent\" type=\"vector3\" nodename=\"{}\"/>\n  </open_pbr_surface>\n",
          frame.normal, frame.tangent) +
      fmt::format(
          "  <surfacematerial name=\"{0}\" type=\"material\">\n    <input name=\"surfaceshader\" "
          "type=\"surfaceshader\" nodename=\"{0}_surface\"/>\n  </surfacematerial>\n",
          id);
  const std::filesystem::path path = context.File(".openpbr.mtlx");
  WriteFileAtomically(path, Document(context, nodes));
  return {{path}, InChannelsOf(fit, context.read_back(path).brdf), false, {}};
}

}  // namespace lobefit
