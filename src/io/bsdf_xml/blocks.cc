#include "lobefit/io/bsdf_xml/blocks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

std::optional<double> Nanometres(const XmlFile& xml, pugi::xml_node wavelength) {
  const std::string unit = ToLower(wavelength.attribute("unit").value());
  const std::optional<double> number = ParseDouble(xml.Text(wavelength));
  if (!number || !(*number > 0) || !std::isfinite(*number)) return std::nullopt;
  if (unit == "nanometer" || unit == "nm") return number;
  if (unit == "micron" || unit == "micrometer" || unit == "um") return *number * 1000;
  return std::nullopt;
}

// Blocks by lower-case name of the direction ("reflection front").
std::map<std::string, std::vector<XmlBlock>> ReadBlocks(const XmlFile& xml, pugi::xml_node layer) {
  constexpr std::size_t kMostBlocks = 4096;
  std::map<std::string, std::vector<XmlBlock>> by_direction;
  std::map<std::pair<std::string, std::string>, pugi::xml_node> known;
  for (const pugi::xml_node data : layer.children("WavelengthData")) {
    const pugi::xml_node wavelength = xml.OnlyChild(data, "Wavelength");
    for (const pugi::xml_node element : data.children("WavelengthDataBlock")) {
      XmlBlock block = {std::string(xml.Text(wavelength)), Nanometres(xml, wavelength), element};
      const std::string direction = ToLower(xml.Text(xml.OnlyChild(element, "WavelengthDataDirection")));
      const auto [first, is_new] = known.emplace(std::pair(direction, ToLower(block.wavelength)), element);
      if (!is_new) {
        xml.Fail(element, "a second block of the same direction and wavelength '" + Excerpt(block.wavelength) +
                              "'; the first one is in line " + std::to_string(xml.Line(first->second)));
      }
      if (known.size() > kMostBlocks)
        xml.Fail(element, "is block " + std::to_string(known.size()) + "; at most " + std::to_string(kMostBlocks) +
                              " blocks of wavelengths are read");
      by_direction[direction].push_back(std::move(block));
    }
  }
  return by_direction;
}

}  // namespace

XmlStructure ReadXmlStructure(const XmlFile& xml, pugi::xml_node definition) {
  const pugi::xml_node element = xml.OnlyChild(definition, "IncidentDataStructure");
  const std::string name = ToLower(xml.Text(element));
  if (name == "columns") return {false, 0, true};
  if (name == "rows") return {false, 0, false};
  if (name == "tensortree3") return {true, 3, true};
  if (name == "tensortree4") return {true, 4, true};
  xml.Fail(element, "the IncidentDataStructure is '" + Excerpt(xml.Text(element)) +
                        "'; allowed are Columns, Rows, TensorTree3 and TensorTree4");
}

XmlSide ChooseXmlSide(const XmlFile& xml, pugi::xml_node layer, const ReadOptions& options) {
  const std::map<std::string, std::vector<XmlBlock>> by_direction = ReadBlocks(xml, layer);
  const auto name_of = [&](Side side) {
    return (side == Side::kFront) == (options.xml_naming == XmlNaming::kPlain) ? "Reflection Front" : "Reflection Back";
  };
  const auto has = [&](Side side) { return by_direction.count(ToLower(name_of(side))) > 0; };
  XmlSide chosen;
  chosen.side = options.side.value_or(has(Side::kFront) || !has(Side::kBack) ? Side::kFront : Side::kBack);
  chosen.name = name_of(chosen.side);
  if (!has(chosen.side)) {
    std::vector<std::string> present;
    for (const auto& [direction, blocks] : by_direction) present.push_back("'" + Excerpt(direction) + "'");
    xml.Fail(layer,
             "<Layer> has no data block '" + chosen.name + "'" +
                 (options.side ? "; choose the other --side or --xml-naming" : "; only reflection can be fitted") +
                 ". It has " + (present.empty() ? "no block at all" : Join(present)));
  }
  chosen.blocks = by_direction.at(ToLower(chosen.name));
  return chosen;
}

XmlSelection SelectXmlWavelengths(const XmlFile& xml, const XmlSide& chosen, const XmlStructure& structure,
                                  const ReadOptions& options) {
  const auto find = [&](const std::string& name) -> const XmlBlock* {
    for (const XmlBlock& block : chosen.blocks) {
      if (ToLower(block.wavelength) == ToLower(name)) return &block;
    }
    return nullptr;
  };
  const auto one = [](const XmlBlock& block) {
    XmlSelection selected = {{{ToLower(block.wavelength) == "visible" ? "Y" : block.wavelength}, {}}, {block}, false};
    if (block.nanometres) selected.channels = {{FormatDouble(*block.nanometres) + "nm"}, {*block.nanometres}};
    return selected;
  };
  std::vector<std::string> names;
  names.reserve(chosen.blocks.size());
  for (const XmlBlock& block : chosen.blocks) names.push_back(block.wavelength);
  if (options.xml_wavelength) {
    if (const XmlBlock* block = find(*options.xml_wavelength)) return one(*block);
    FailAtLine(xml.file(), xml.Line(chosen.blocks.front().element),
               "--xml-wavelength " + *options.xml_wavelength + ": the blocks '" + chosen.name +
                   "' have the wavelengths " + Join(names));
  }
  if (const XmlBlock* visible = find("Visible")) {
    const XmlBlock* first = find(structure.is_tree ? "CIE-u" : "CIE-X");
    const XmlBlock* second = find(structure.is_tree ? "CIE-v" : "CIE-Z");
    if (first == nullptr || second == nullptr) return one(*visible);
    // Trees of u', v' are Radiance's, with its colours.
    if (structure.is_tree) return {{{"R", "G", "B"}, {}}, {*visible, *first, *second}, true};
    return {{{"X", "Y", "Z"}, {}}, {*first, *visible, *second}, false};
  }
  if (chosen.blocks.size() == 1) return one(chosen.blocks.front());
  std::vector<XmlBlock> sorted = chosen.blocks;
  if (!std::all_of(sorted.begin(), sorted.end(), [](const XmlBlock& block) { return block.nanometres.has_value(); })) {
    FailAtLine(xml.file(), xml.Line(chosen.blocks.front().element),
               "the blocks '" + chosen.name + "' have the wavelengths " + Join(names) +
                   ", none of them Visible; choose one with --xml-wavelength");
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const XmlBlock& a, const XmlBlock& b) { return *a.nanometres < *b.nanometres; });
  XmlSelection selected;
  for (const XmlBlock& block : sorted) {
    selected.channels.names.push_back(FormatDouble(*block.nanometres) + "nm");
    selected.channels.wavelengths_nm.push_back(*block.nanometres);
    selected.blocks.push_back(block);
  }
  return selected;
}

}  // namespace lobefit
