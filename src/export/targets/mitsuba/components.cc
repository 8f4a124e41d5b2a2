#include "lobefit/export/targets/mitsuba/components.h"

#include <fmt/format.h>

#include "lobefit/base/text/printable.h"
#include "lobefit/export/targets/spectra.h"
#include "lobefit/export/targets/text.h"

namespace lobefit {
namespace {

std::string ColorXml(const char* name, const Spectrum& values, const std::vector<double>& wavelengths_nm) {
  if (wavelengths_nm.empty()) return fmt::format("<rgb name=\"{}\" value=\"{}\"/>", name, Numbers9(values, ", "));
  const SpectrumNodes nodes = Continued({wavelengths_nm, values});
  std::string text;
  for (std::size_t k = 0; k < nodes.values.size(); ++k) {
    text += fmt::format("{}{}:{}", k == 0 ? "" : ", ", Number9(nodes.wavelengths_nm[k]), Number9(nodes.values[k]));
  }
  return fmt::format("<spectrum name=\"{}\" value=\"{}\"/>", name, text);
}

// In Python an rgb above 1 is refused, a picture of one pixel is not.
std::string ColorPython(const Spectrum& values, const std::vector<double>& wavelengths_nm) {
  if (wavelengths_nm.empty()) return fmt::format("constant({})", Numbers9(values, ", "));
  const SpectrumNodes nodes = Continued({wavelengths_nm, values});
  std::string text;
  for (std::size_t k = 0; k < nodes.values.size(); ++k) {
    text += fmt::format("{}({}, {})", k == 0 ? "" : ", ", Number9(nodes.wavelengths_nm[k]), Number9(nodes.values[k]));
  }
  return fmt::format("{{'type': 'spectrum', 'value': [{}]}}", text);
}

}  // namespace

std::string Indented(const std::string& text, const std::string& by) {
  std::string result = by;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += by;
  }
  return result;
}

MitsubaComponent MitsubaLobe(const SurfaceLobe& lobe, const std::vector<double>& wavelengths_nm) {
  MitsubaComponent component;
  component.share = lobe.weight;
  component.xml = fmt::format(
      "<bsdf type=\"roughconductor\">\n  <string name=\"distribution\" value=\"ggx\"/>\n"
      "  <float name=\"alpha_u\" value=\"{}\"/>\n  <float name=\"alpha_v\" value=\"{}\"/>\n  {}\n  {}\n</bsdf>",
      Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2), ColorXml("eta", lobe.fresnel.eta, wavelengths_nm),
      ColorXml("k", lobe.fresnel.k, wavelengths_nm));
  component.python = fmt::format(
      "{{'type': 'roughconductor', 'distribution': 'ggx', 'alpha_u': {}, 'alpha_v': {},\n 'eta': {}, 'k': {}}}",
      Number9(lobe.widths.alpha_1), Number9(lobe.widths.alpha_2), ColorPython(lobe.fresnel.eta, wavelengths_nm),
      ColorPython(lobe.fresnel.k, wavelengths_nm));
  return component;
}

MitsubaComponent MitsubaDiffuse(const Spectrum& reflectance, double share, const std::vector<double>& wavelengths_nm) {
  const std::string python = wavelengths_nm.empty()
                                 ? fmt::format("{{'type': 'rgb', 'value': [{}]}}", Numbers9(reflectance, ", "))
                                 : ColorPython(reflectance, wavelengths_nm);
  return {fmt::format("<bsdf type=\"diffuse\">\n  {}\n</bsdf>", ColorXml("reflectance", reflectance, wavelengths_nm)),
          fmt::format("{{'type': 'diffuse', 'reflectance': {}}}", python), share};
}

void Tilt(const std::string& map, const std::string& file, bool shadowing, MitsubaComponent* component) {
  component->xml = fmt::format(
      "<bsdf type=\"normalmap\">\n  <texture type=\"bitmap\" name=\"normalmap\">\n"
      "    <string name=\"filename\" value=\"{}\"/>\n    <boolean name=\"raw\" value=\"true\"/>\n  </texture>\n"
      "{}{}\n</bsdf>",
      MarkupText(map), shadowing ? "  <boolean name=\"use_shadowing_function\" value=\"false\"/>\n" : "",
      Indented(component->xml, "  "));
  component->python = fmt::format(
      "{{'type': 'normalmap', **shadowing,\n 'normalmap': {{'type': 'bitmap', 'filename': "
      "os.path.join(folder, {}), 'raw': True}},\n 'nested_bsdf':\n{}}}",
      PythonString(file), Indented(component->python, " "));
}

MitsubaComponent Blend(std::vector<MitsubaComponent> components) {
  MitsubaComponent rest = components.back();
  for (std::size_t i = components.size() - 1; i-- > 0;) {
    const double share = components[i].share + rest.share;
    const std::string weight = Number9(rest.share / share);
    rest = {fmt::format("<bsdf type=\"blendbsdf\">\n  <float name=\"weight\" value=\"{}\"/>\n{}\n{}\n</bsdf>", weight,
                        Indented(components[i].xml, "  "), Indented(rest.xml, "  ")),
            fmt::format("{{'type': 'blendbsdf', 'weight': {},\n 'first':\n{},\n 'second':\n{}}}", weight,
                        Indented(components[i].python, " "), Indented(rest.python, " ")),
            share};
  }
  return rest;
}

}  // namespace lobefit
