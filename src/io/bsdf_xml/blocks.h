// What a BSDF-XML file holds and which part of it is read: layout, side, wavelengths.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobefit/io/text/format.h"
#include "lobefit/io/text/xml_file.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// How the data are laid out ("IncidentDataStructure").
struct XmlStructure {
  bool is_tree = false;
  int rank = 0;                    // of a tree
  bool incident_is_column = true;  // of a matrix: the incident patch runs fastest
};

XmlStructure ReadXmlStructure(const XmlFile& xml, pugi::xml_node definition);

// The block of one wavelength in the direction that is read.
struct XmlBlock {
  std::string wavelength;
  std::optional<double> nanometres;
  pugi::xml_node element;
};

// The blocks of the side that the options choose, and the name of their direction.
struct XmlSide {
  Side side = Side::kFront;
  std::string name;
  std::vector<XmlBlock> blocks;
};

// Fails where the layer has no block of that side, or two of one wavelength.
XmlSide ChooseXmlSide(const XmlFile& xml, pugi::xml_node layer, const ReadOptions& options);

// What is read: the channels of the measurement and, for each, its block. A tree in CIE Y, u', v' has these three
// blocks and the channels R, G, B.
struct XmlSelection {
  Channels channels;
  std::vector<XmlBlock> blocks;
  bool yuv = false;
};

// See ReadOptions::xml_wavelength.
XmlSelection SelectXmlWavelengths(const XmlFile& xml, const XmlSide& chosen, const XmlStructure& structure,
                                  const ReadOptions& options);

}  // namespace lobefit
