// Radiance / WINDOW BSDF-XML: matrices over Klems or other angle bases, and tensor trees. Values are f_r in 1/sr
// without a cosine. WINDOW counts the incident azimuth along the propagation, so a mirror fills the matrix's diagonal:
// the light stands at the opposite of its patch. Coordinates: x right, y up, z out of the front; a measurement of the
// back is turned about y, so that the back's normal is +z.
#include "lobefit/io/bsdf_xml/reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "lobefit/io/bsdf_xml/angle_basis.h"
#include "lobefit/io/bsdf_xml/blocks.h"
#include "lobefit/io/bsdf_xml/lookup.h"
#include "lobefit/io/bsdf_xml/radiance_color.h"
#include "lobefit/io/bsdf_xml/tensor_tree.h"
#include "lobefit/io/text/place.h"
#include "lobefit/io/text/xml_file.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostPatchesInRing = 100000;

double BoundDegrees(const XmlFile& xml, pugi::xml_node block, const char* name) {
  const pugi::xml_node element = xml.OnlyChild(xml.OnlyChild(block, "ThetaBounds"), name);
  const double degrees = FiniteNumberAt(xml.file(), xml.Line(element), xml.Text(element), name);
  if (degrees < 0 || degrees > 90)
    xml.Fail(element, std::string(name) + " is " + FormatDouble(degrees) + "; allowed are 0 to 90");
  return degrees;
}

AngleBasis ReadBasis(const XmlFile& xml, pugi::xml_node element) {
  AngleBasis basis;
  basis.name = std::string(xml.Text(xml.OnlyChild(element, "AngleBasisName")));
  for (const pugi::xml_node block : element.children("AngleBasisBlock")) {
    const double lower = BoundDegrees(xml, block, "LowerTheta"), upper = BoundDegrees(xml, block, "UpperTheta");
    const pugi::xml_node count = xml.OnlyChild(block, "nPhis");
    const std::optional<long long> patches = ParseInteger(xml.Text(count));
    if (!patches || *patches < 1 || *patches > static_cast<long long>(kMostPatchesInRing)) {
      xml.Fail(count,
               "nPhis is '" + Excerpt(xml.Text(count)) + "'; allowed are 1 to " + std::to_string(kMostPatchesInRing));
    }
    const double expected = basis.rings.empty() ? 0 : basis.rings.back().upper_deg;
    if (std::fabs(lower - expected) > 1e-3 || !(upper > lower)) {
      xml.Fail(block, "the ring from " + FormatDouble(lower) + " to " + FormatDouble(upper) +
                          " degrees does not go on from " + FormatDouble(expected) + "; rings must follow each other");
    }
    basis.rings.push_back({expected, upper, static_cast<std::size_t>(*patches)});
  }
  if (basis.rings.empty()) xml.Fail(element, "the angle basis '" + Excerpt(basis.name) + "' has no AngleBasisBlock");
  return basis;
}

bool SameRings(const AngleBasis& a, const AngleBasis& b) {
  return a.rings.size() == b.rings.size() &&
         std::equal(a.rings.begin(), a.rings.end(), b.rings.begin(), [](const auto& x, const auto& y) {
           return x.patches == y.patches && std::fabs(x.upper_deg - y.upper_deg) < 1e-3;
         });
}

// The bases that the file may use, by their names in lower case: Klems' and those that it defines. A definition under
// Klems' name must be Klems'.
using Bases = std::map<std::string, AngleBasis>;

Bases ReadBases(const XmlFile& xml, pugi::xml_node definition) {
  Bases bases;
  for (const AngleBasis& basis : KlemsBases()) bases.emplace(ToLower(basis.name), basis);
  for (const pugi::xml_node element : definition.children("AngleBasis")) {
    AngleBasis basis = ReadBasis(xml, element);
    const auto [known, is_new] = bases.try_emplace(ToLower(basis.name), basis);
    if (!is_new && !SameRings(known->second, basis)) {
      xml.Fail(element, "the basis '" + Excerpt(basis.name) +
                            "' is defined with other rings than that name stands for; "
                            "give it another name");
    }
  }
  return bases;
}

const AngleBasis& FindBasis(const XmlFile& xml, pugi::xml_node block, const char* element_name, const Bases& bases) {
  constexpr std::size_t kMostNamed = 20;
  const pugi::xml_node element = xml.OnlyChild(block, element_name);
  const auto found = bases.find(ToLower(xml.Text(element)));
  if (found != bases.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [lower, basis] : bases) {
    if (names.size() < kMostNamed) names.push_back(Excerpt(basis.name));
  }
  const std::string more =
      bases.size() > names.size() ? " and " + std::to_string(bases.size() - names.size()) + " more" : "";
  xml.Fail(element,
           std::string(element_name) + " is '" + Excerpt(xml.Text(element)) + "'; known are " + Join(names) + more);
}

// Directions from the file's patterns: `incident` is the patch or disk position of the light's propagation, `exit` that
// of the scattered light, both with z > 0 and x, y in the front's coordinates.
struct Pair {
  Vec3 wi, wo;
};
Pair FromPatterns(const Vec3& incident, const Vec3& exit, Side side) {
  if (side == Side::kFront) return {{-incident.x, -incident.y, incident.z}, exit};
  return {{incident.x, -incident.y, incident.z}, {-exit.x, exit.y, exit.z}};
}

std::vector<double> ReadMatrix(const XmlFile& xml, const XmlBlock& block, std::size_t count) {
  const pugi::xml_node element = xml.OnlyChild(block.element, "ScatteringData");
  std::string_view text = xml.Text(element);
  const std::size_t first_line = text.empty() ? xml.Line(element) : xml.Line(text);
  const auto is_separator = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ','; };
  if (count > (text.size() + 1) / 2) {
    xml.Fail(element, "<ScatteringData> has " + std::to_string(text.size()) + " bytes, too few for " +
                          std::to_string(count) + " numbers of the angle bases; it may be cut off");
  }
  std::vector<double> values;
  values.reserve(count);
  std::size_t line = first_line, at = 0;
  while (at < text.size()) {
    if (is_separator(text[at])) {
      line += text[at++] == '\n' ? 1 : 0;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && !is_separator(text[end])) ++end;
    if (values.size() == count)
      FailAtLine(xml.file(), line, "more than the " + std::to_string(count) + " numbers of the angle bases");
    values.push_back(NumberAt(xml.file(), line, text.substr(at, end - at), "a value of <ScatteringData>"));
    at = end;
  }
  if (values.size() != count) {
    FailAtLine(xml.file(), line,
               "<ScatteringData> ends after " + std::to_string(values.size()) + " numbers; the angle bases need " +
                   std::to_string(count));
  }
  return values;
}

Measurement ReadMatrices(const XmlFile& xml, pugi::xml_node definition, const XmlStructure& structure,
                         const XmlSide& chosen, const XmlSelection& selected) {
  const Bases bases = ReadBases(xml, definition);
  const AngleBasis& incident_basis = FindBasis(xml, selected.blocks[0].element, "ColumnAngleBasis", bases);
  const AngleBasis& exit_basis = FindBasis(xml, selected.blocks[0].element, "RowAngleBasis", bases);
  const std::optional<std::size_t> count = CheckedProduct({incident_basis.size(), exit_basis.size()});
  if (!count) {
    xml.Fail(selected.blocks[0].element, "the angle bases have " + std::to_string(incident_basis.size()) + " x " +
                                             std::to_string(exit_basis.size()) + " patches, more than any file holds");
  }
  std::vector<std::vector<double>> values;
  for (const XmlBlock& block : selected.blocks) {
    if (&FindBasis(xml, block.element, "ColumnAngleBasis", bases) != &incident_basis ||
        &FindBasis(xml, block.element, "RowAngleBasis", bases) != &exit_basis) {
      xml.Fail(block.element, "the wavelength '" + Excerpt(block.wavelength) + "' has other angle bases than '" +
                                  Excerpt(selected.blocks[0].wavelength) + "'; choose one with --xml-wavelength");
    }
    values.push_back(ReadMatrix(xml, block, *count));
  }
  const std::vector<AngleBasis::Patch> incident = incident_basis.Patches(), exit = exit_basis.Patches();
  MeasurementBuilder builder(selected.channels);
  std::vector<double>& solid_angle = builder.measurement().samples.solid_angle;
  std::vector<double> sample(values.size());
  for (std::size_t cell = 0; cell < *count; ++cell) {
    const std::size_t i = structure.incident_is_column ? cell % incident.size() : cell / exit.size();
    const std::size_t o = structure.incident_is_column ? cell / incident.size() : cell % exit.size();
    const Pair pair = FromPatterns(incident[i].direction, exit[o].direction, chosen.side);
    for (std::size_t c = 0; c < values.size(); ++c) sample[c] = values[c][cell];
    if (builder.Add(pair.wi, pair.wo, sample.data(), static_cast<std::uint32_t>(cell))) {
      solid_angle.push_back(incident[i].solid_angle * exit[o].solid_angle);
    }
  }
  Measurement measurement = builder.Finish();
  measurement.conventions["basis"] = incident_basis.name + " x " + exit_basis.name + " (header)";
  return measurement;
}

// Projected incident solid angle of a cell along the first axis of an isotropic tree, sin(theta_i) = 1 - 2 u; the part
// u > 1/2 of the axis is not used.
struct Ring {
  double sine, projected;
};
std::optional<Ring> IsotropicRing(double low, double edge) {
  const double high = std::min(low + edge, 0.5);
  if (high <= low) return std::nullopt;
  const double outer = 1 - 2 * low, inner = 1 - 2 * high;
  return Ring{(outer + inner) / 2, outer * outer - inner * inner};
}

Measurement ReadTrees(const XmlFile& xml, const XmlStructure& structure, const XmlSide& chosen,
                      const XmlSelection& selected) {
  std::vector<TensorTree> trees;
  for (const XmlBlock& block : selected.blocks) trees.push_back(ReadTree(xml, block, structure.rank));
  MeasurementBuilder builder(selected.channels);
  std::vector<double>& solid_angle = builder.measurement().samples.solid_angle;
  std::vector<double> values(selected.channels.size());
  trees[0].ForEachCell([&](const TensorTree::Cell& cell) {
    std::array<double, 4> centre = {};
    for (std::size_t axis = 0; axis < 4; ++axis) centre[axis] = cell.corner[axis] + cell.edge / 2;
    Vec3 incident = {}, exit = {};
    double measure = cell.edge * cell.edge;
    if (structure.rank == 3) {
      const std::optional<Ring> ring = IsotropicRing(cell.corner[0], cell.edge);
      if (!ring) return;
      centre[0] = (1 - ring->sine) / 2;
      incident = OnHemisphere({ring->sine, 0});
      exit = OnHemisphere(SquareToDisk({centre[1], centre[2]}));
      measure *= ring->projected;
    } else {
      incident = OnHemisphere(SquareToDisk({centre[0], centre[1]}));
      exit = OnHemisphere(SquareToDisk({centre[2], centre[3]}));
      measure *= cell.edge * cell.edge;
    }
    if (selected.yuv) {
      const double u = trees[1].At(centre), v = trees[2].At(centre);
      const std::array<double, 3> rgb = RadianceRgb({cell.value, u, v});
      values.assign(rgb.begin(), rgb.end());
    } else {
      values[0] = cell.value;
      for (std::size_t c = 1; c < trees.size(); ++c) values[c] = trees[c].At(centre);
    }
    const Pair pair = FromPatterns(incident, exit, chosen.side);
    if (builder.Add(pair.wi, pair.wo, values.data(), static_cast<std::uint32_t>(cell.index))) {
      solid_angle.push_back(measure / (incident.z * exit.z));
    }
  });
  Measurement measurement = builder.Finish();
  measurement.isotropic = structure.rank == 3;
  measurement.conventions["basis"] = "LBNL/Shirley-Chiu, rank " + std::to_string(structure.rank) + " (header)";
  return measurement;
}

}  // namespace

bool IsBsdfXml(std::string_view bytes) {
  const std::string_view head = Trim(Head(bytes).substr(bytes.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0));
  return head.substr(0, 1) == "<" && head.find("<WindowElement") != std::string_view::npos;
}

Measurement ReadBsdfXml(const InputFile& file, const ReadOptions& options) {
  const XmlFile xml(file);
  if (const std::string_view name = xml.root().name(); name != "WindowElement") {
    xml.Fail(xml.root(),
             std::string("the outermost element is <") + Excerpt(name) + ">; a BSDF file has <WindowElement>");
  }
  const pugi::xml_node layer = xml.OnlyChild(xml.OnlyChild(xml.root(), "Optical"), "Layer");
  const pugi::xml_node definition = xml.OnlyChild(layer, "DataDefinition");
  const XmlStructure structure = ReadXmlStructure(xml, definition);
  const XmlSide chosen = ChooseXmlSide(xml, layer, options);
  const XmlSelection selected = SelectXmlWavelengths(xml, chosen, structure, options);
  Measurement measurement = structure.is_tree ? ReadTrees(xml, structure, chosen, selected)
                                              : ReadMatrices(xml, definition, structure, chosen, selected);
  ScaleToMeanOne(&measurement.samples.solid_angle);
  measurement.conventions["value-kind"] = "f (format)";
  measurement.conventions["incident"] = "propagation (format)";
  measurement.conventions["side"] = std::string(chosen.side == Side::kFront ? "front" : "back") + " (block '" +
                                    chosen.name + "'" + (options.side ? "" : ", default") + ")";
  measurement.conventions["xml-naming"] = options.xml_naming == XmlNaming::kWindow ? "window" : "plain";
  measurement.conventions["xml-wavelength"] = Join([&] {
    std::vector<std::string> names;
    for (const XmlBlock& block : selected.blocks) names.push_back(block.wavelength);
    return names;
  }());
  return measurement;
}

}  // namespace lobefit
