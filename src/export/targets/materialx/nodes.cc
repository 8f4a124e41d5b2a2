#include "lobefit/export/targets/materialx/nodes.h"

#include <cmath>

#include <fmt/format.h>

#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

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

}  // namespace

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

std::string MaterialXDocument(const WriteContext& context, const std::string& nodes) {
  return "<?xml version=\"1.0\"?>\n" + XmlComment(context.header) +
         "<materialx version=\"1.39\" colorspace=\"lin_rec709\">\n" + nodes + "</materialx>\n";
}

}  // namespace lobefit
