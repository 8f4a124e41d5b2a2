#include "lobefit/export/targets/mitsuba/write.h"

#include <fmt/format.h>

#include "lobefit/base/file.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

// A component in both spellings, and its share of the blend.
struct Component {
  std::string xml, python;
  double share;
};

std::string Indented(const std::string& text, const std::string& by) {
  std::string result = by;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += by;
  }
  return result;
}

Component LobeComponent(const SurfaceLobe& lobe) {
  Component component;
  component.share = lobe.weight;
  component.xml = fmt::format(
      "<bsdf type=\"roughconductor\">\n  <string name=\"distribution\" value=\"ggx\"/>\n"
      "  <float name=\"alpha_u\" value=\"{}\"/>\n  <float name=\"alpha_v\" value=\"{}\"/>\n"
      "  <rgb name=\"eta\" value=\"{}\"/>\n  <rgb name=\"k\" value=\"{}\"/>\n</bsdf>",
      Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2), Numbers9(lobe.fresnel.eta, ", "),
      Numbers9(lobe.fresnel.k, ", "));
  component.python = fmt::format(
      "{{'type': 'roughconductor', 'distribution': 'ggx', 'alpha_u': {}, 'alpha_v': {},\n"
      " 'eta': constant({}), 'k': constant({})}}",
      Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2), Numbers9(lobe.fresnel.eta, ", "),
      Numbers9(lobe.fresnel.k, ", "));
  return component;
}

void Tilt(const std::string& map, Component* component) {
  component->xml = fmt::format(
      "<bsdf type=\"normalmap\">\n  <texture type=\"bitmap\" name=\"normalmap\">\n"
      "    <string name=\"filename\" value=\"{}\"/>\n    <boolean name=\"raw\" value=\"true\"/>\n  </texture>\n"
      "  <boolean name=\"use_shadowing_function\" value=\"false\"/>\n{}\n</bsdf>",
      map, Indented(component->xml, "  "));
  component->python = fmt::format(
      "{{'type': 'normalmap', 'use_shadowing_function': False,\n 'normalmap': {{'type': 'bitmap', 'filename': "
      "os.path.join(folder, '{}'), 'raw': True}},\n 'nested_bsdf':\n{}}}",
      map, Indented(component->python, " "));
}

}  // namespace

Surface MitsubaSurface(const FittedBrdf& fit) {
  Surface surface;
  surface.masking = SurfaceMasking::kSeparable;
  const Shares shares = SharesOf(fit);
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    SurfaceLobe lobe = LobeOf(fit, l, shares.lobes[l]);
    lobe.rotation = CommonRotation(fit);
    lobe.fresnel = ConductorFresnelOf(fit, l, shares.lobes[l]);
    surface.lobes.push_back(lobe);
  }
  surface.diffuse = DiffuseOf(fit);
  return surface;
}

WrittenFiles WriteMitsuba(const FittedBrdf& fit, const WriteContext& context) {
  const Surface surface = MitsubaSurface(fit);
  const double rotation = CommonRotation(fit);
  WrittenFiles written;
  std::vector<Component> components;
  for (std::size_t l = 0; l < surface.lobes.size(); ++l) {
    components.push_back(LobeComponent(surface.lobes[l]));
    if (surface.lobes[l].normal.z < 1) {
      const std::filesystem::path map = context.File(fmt::format("_normal{}.png", l + 1));
      WriteFileAtomically(map, NormalMapPng(RotateZ(surface.lobes[l].normal, -rotation)));
      written.files.push_back(map);
      Tilt(map.filename().string(), &components.back());
    }
  }
  if (fit.HasDiffuse() || components.empty()) {
    const double share = SharesOf(fit).diffuse;
    Color3 reflectance = surface.diffuse;
    for (double& value : reflectance) value /= share;
    components.push_back({fmt::format("<bsdf type=\"diffuse\">\n  <rgb name=\"reflectance\" value=\"{}\"/>\n</bsdf>",
                                      Numbers9(reflectance, ", ")),
                          fmt::format("{{'type': 'diffuse', 'reflectance': {{'type': 'rgb', 'value': [{}]}}}}",
                                      Numbers9(reflectance, ", ")),
                          share});
  }
  // The weight of a blend is the share of its second.
  Component rest = components.back();
  for (std::size_t i = components.size() - 1; i-- > 0;) {
    const double share = components[i].share + rest.share;
    const std::string weight = Number9(rest.share / share);
    rest = {fmt::format("<bsdf type=\"blendbsdf\">\n  <float name=\"weight\" value=\"{}\"/>\n{}\n{}\n</bsdf>", weight,
                        Indented(components[i].xml, "  "), Indented(rest.xml, "  ")),
            fmt::format("{{'type': 'blendbsdf', 'weight': {},\n 'first':\n{},\n 'second':\n{}}}", weight,
                        Indented(components[i].python, " "), Indented(rest.python, " ")),
            share};
  }
  std::vector<std::string> header = context.header;
  for (const std::string& line : RotationComment(rotation)) header.push_back(line);
  std::string xml = rest.xml;
  xml.insert(5, fmt::format(" id=\"{}\"", Identifier(context.name)));
  const std::filesystem::path path = context.File(".mitsuba.xml"), python = context.File(".mitsuba.py");
  WriteFileAtomically(path, XmlComment(header) + "<scene version=\"3.0.0\">\n" + Indented(xml, "  ") + "\n</scene>\n");
  WriteFileAtomically(
      python, CommentLines(header, "#") + "import os\n\n\ndef material(mi, np):\n" +
                  "    \"\"\"The BSDF for mi.load_dict, of an rgb variant; mi and np are the modules mitsuba and "
                  "numpy.\"\"\"\n    folder = os.path.dirname(os.path.abspath(__file__))\n\n" +
                  "    def constant(*rgb):\n        pixel = mi.Bitmap(np.array([[rgb]], dtype=np.float32))\n" +
                  "        return {'type': 'bitmap', 'bitmap': pixel, 'raw': True}\n\n    return (\n" +
                  Indented(rest.python, "        ") + ")\n");
  written.files.insert(written.files.begin(), {path, python});
  written.brdf = InChannelsOf(fit, context.read_back(path).brdf);
  if (rotation != 0) {
    written.notes.push_back(fmt::format("turn the mesh's texture coordinates by {:.4g} degrees (the file says how)",
                                        RadiansToDegrees(rotation)));
  }
  return written;
}

}  // namespace lobefit
