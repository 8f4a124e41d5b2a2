#include "lobefit/maps/textures/mtlx_images.h"

#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

// Inputs are names of nodes, or an output of one as "node.output".
struct Input {
  const char* name;
  std::string node;
  const char* type = "vector3";
};

std::string Node(const char* kind, const std::string& name, const char* type, std::initializer_list<Input> inputs) {
  std::string text = fmt::format("  <{} name=\"{}\" type=\"{}\">\n", kind, name, type);
  for (const Input& input : inputs) {
    const std::size_t dot = input.node.find('.');
    text += fmt::format("    <input name=\"{}\" type=\"{}\" nodename=\"{}\"{}/>\n", input.name, input.type,
                        input.node.substr(0, dot),
                        dot == std::string::npos ? "" : fmt::format(" output=\"{}\"", input.node.substr(dot + 1)));
  }
  return text + fmt::format("  </{}>\n", kind);
}

}  // namespace

std::string ImageNode(const std::string& name, const std::string& file, const std::string& type) {
  // Colours are linear, as the document says of all: 16-bit PNG is not sRGB.
  return fmt::format(
      "  <image name=\"{}\" type=\"{}\">\n    <input name=\"file\" type=\"filename\" value=\"{}\"{}/>\n"
      "    <input name=\"uaddressmode\" type=\"string\" value=\"clamp\"/>\n"
      "    <input name=\"vaddressmode\" type=\"string\" value=\"clamp\"/>\n  </image>\n",
      name, type, MarkupText(file), type == "color3" ? " colorspace=\"lin_rec709\"" : "");
}

std::string MapFrameNodes(const std::string& id, const std::string& name, bool directions) {
  const auto own = [&](const char* part) { return id + "_" + part; };
  std::string text = ImageNode(own("normal_map"), name + "_normal.png", "vector3") +
                     Node("normalmap", own("normal"), "vector3", {{"in", own("normal_map")}});
  std::string along = "mesh_tangent";
  if (directions) {
    text += ImageNode(own("direction_map"), name + "_direction.png", "vector3") +
            fmt::format(
                "  <subtract name=\"{0}_direction_half\" type=\"vector3\">\n    <input name=\"in1\" "
                "type=\"vector3\" nodename=\"{0}_direction_map\"/>\n    <input name=\"in2\" type=\"vector3\" "
                "value=\"0.5, 0.5, 0.5\"/>\n  </subtract>\n",
                id) +
            Node("separate3", own("direction"), "multioutput", {{"in", own("direction_half")}}) +
            Node("multiply", own("direction_x"), "vector3",
                 {{"in1", "mesh_tangent"}, {"in2", own("direction") + ".outx", "float"}}) +
            Node("multiply", own("direction_y"), "vector3",
                 {{"in1", "mesh_bitangent"}, {"in2", own("direction") + ".outy", "float"}}) +
            Node("add", own("along"), "vector3", {{"in1", own("direction_x")}, {"in2", own("direction_y")}});
    along = own("along");
  }
  // The BSDF nodes take the tangent as it is.
  return text + Node("dotproduct", own("lean"), "float", {{"in1", along}, {"in2", own("normal")}}) +
         Node("multiply", own("upright"), "vector3", {{"in1", own("normal")}, {"in2", own("lean"), "float"}}) +
         Node("subtract", own("flat"), "vector3", {{"in1", along}, {"in2", own("upright")}}) +
         Node("normalize", own("tangent"), "vector3", {{"in", own("flat")}});
}

Texture DirectionTexture() {
  return {"_direction.png", 3, 16, false,
          [](const TexelNumbers& texel) { return DirectionValue(texel.rotation, 0.5); }};
}

std::string MaterialNode(const std::string& id) {
  return fmt::format(
      "  <surfacematerial name=\"{0}\" type=\"material\">\n    <input name=\"surfaceshader\" type=\"surfaceshader\" "
      "nodename=\"{0}_surface\"/>\n  </surfacematerial>\n",
      id);
}

}  // namespace lobefit
