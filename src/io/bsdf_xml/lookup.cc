#include "lobefit/io/bsdf_xml/lookup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "lobefit/base/text/text.h"
#include "lobefit/io/bsdf_xml/radiance_color.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

double InUnit(double position) { return std::clamp(position, 0.0, std::nextafter(1.0, 0.0)); }

// Where the cube of the tree holds the directions: the incident one is that of the propagation, opposite to the light,
// and a tree of rank 3 has it at the azimuth 0.
std::array<double, 4> PlaceOf(int rank, const Vec3& wi, const Vec3& wo) {
  const double sine = std::hypot(wi.x, wi.y);
  if (rank == 4) {
    const Vec2 in = DiskToSquare({-wi.x, -wi.y}), out = DiskToSquare({wo.x, wo.y});
    return {InUnit(in.x), InUnit(in.y), InUnit(out.x), InUnit(out.y)};
  }
  const double c = sine > 0 ? -wi.x / sine : 1, s = sine > 0 ? -wi.y / sine : 0;
  const Vec2 out = DiskToSquare({c * wo.x + s * wo.y, c * wo.y - s * wo.x});
  return {InUnit((1 - sine) / 2), InUnit(out.x), InUnit(out.y), 0};
}

}  // namespace

TensorTree ReadTree(const XmlFile& xml, const XmlBlock& block, int rank) {
  const pugi::xml_node basis = xml.OnlyChild(block.element, "AngleBasis");
  if (ToLower(xml.Text(basis)) != "lbnl/shirley-chiu") {
    xml.Fail(basis,
             "the AngleBasis of a tensor tree is '" + Excerpt(xml.Text(basis)) + "'; known is LBNL/Shirley-Chiu");
  }
  const pugi::xml_node element = xml.OnlyChild(block.element, "ScatteringData");
  const std::string_view text = xml.Text(element);
  if (text.empty()) xml.Fail(element, "<ScatteringData> is empty; a tensor tree in braces belongs here");
  return TensorTree(text, rank, [&](std::string_view place, const std::string& message) {
    FailAtLine(xml.file(), xml.Line(place), message);
  });
}

TreeLookup LookUpTensorTrees(const InputFile& file) {
  const XmlFile xml(file);
  const pugi::xml_node layer = xml.OnlyChild(xml.OnlyChild(xml.root(), "Optical"), "Layer");
  const pugi::xml_node definition = xml.OnlyChild(layer, "DataDefinition");
  const XmlStructure structure = ReadXmlStructure(xml, definition);
  if (!structure.is_tree) xml.Fail(definition, "its data are a matrix; a tensor tree is looked up");
  const XmlSide chosen = ChooseXmlSide(xml, layer, {});
  const XmlSelection selected = SelectXmlWavelengths(xml, chosen, structure, {});
  auto trees = std::make_shared<std::vector<TensorTree>>();
  for (const XmlBlock& block : selected.blocks) trees->push_back(ReadTree(xml, block, structure.rank));
  const auto look_up = [trees, yuv = selected.yuv, rank = structure.rank](const Vec3& wi, const Vec3& wo,
                                                                          double* values) {
    const std::array<double, 4> place = PlaceOf(rank, wi, wo);
    if (yuv) {
      const std::array<double, 3> rgb =
          RadianceRgb({(*trees)[0].At(place), (*trees)[1].At(place), (*trees)[2].At(place)});
      std::copy(rgb.begin(), rgb.end(), values);
    } else {
      for (std::size_t c = 0; c < trees->size(); ++c) values[c] = (*trees)[c].At(place);
    }
  };
  return {selected.channels, look_up};
}

}  // namespace lobefit
