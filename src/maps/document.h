// NAME.maps.json: what the maps mean and what they came from.
#pragma once

#include <string>

#include "lobefit/maps/run.h"

namespace lobefit {

std::string MapsDocument(const Stack& stack, const MapsOptions& options, const MapsResult& result,
                         const std::string& digest, const std::string& command);

// What a program needs of the document beside maps. Throws InputError.
struct MapsRecord {
  bool calibrated = false;
  std::vector<std::size_t> left_out;  // from 0
  std::string stack;                  // its name
};
MapsRecord ReadMapsRecord(const std::filesystem::path& document);

}  // namespace lobefit
