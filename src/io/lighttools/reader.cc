// LightTools .bsdf text: blocks of one incidence, side, wavelength and scatter type, each a grid of absolute polar and
// azimuthal angles of the scattered direction, azimuth outermost. Values are f_r in 1/sr without a cosine, degrees; 0
// stands for "not measured". The light's azimuth at plane of incidence 0 is +y in the files that are around.
#include "lobefit/io/lighttools/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Header {
  bool plane_symmetrical = false;
  bool tristimulus = false;
  std::vector<double> azimuth, radial;  // degrees
  std::vector<std::string> ignored;
};

struct Block {
  double incidence = 0, plane = 0, wavelength = 0;  // degrees, nanometres
  Side side = Side::kFront;
  bool reflection = true;
  std::size_t tristimulus = 0;
  std::vector<double> values;
  std::vector<std::uint32_t> lines;
};

std::size_t OneOf(WordReader* words, const std::string& key, const std::vector<std::string>& allowed) {
  const std::string_view word = words->Word("the value of " + key);
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    if (ToLower(word) == ToLower(allowed[i])) return i;
  }
  words->Fail(key + " is '" + Excerpt(word) + "'; allowed are " + Join(allowed) + DidYouMean(word, allowed));
}

Header ReadHeader(WordReader* words) {
  Header header;
  std::map<std::string, std::size_t> seen;
  while (true) {
    const std::string key(words->Word("a key of the header or DataBegin"));
    if (key == "DataBegin") break;
    const auto [first, is_new] = seen.emplace(key, words->line());
    if (!is_new)
      words->Fail("the key " + Excerpt(key) + " stands in line " + std::to_string(first->second) + " already");
    if (key == "Symmetry") {
      header.plane_symmetrical = OneOf(words, key, {"PlaneSymmetrical", "Asymmetric", "Asymmetrical"}) == 0;
    } else if (key == "SpectralContent") {
      header.tristimulus = OneOf(words, key, {"Monochrome", "XYZ"}) == 1;
    } else if (key == "ScatterAzimuth") {
      header.azimuth = words->List("scatter azimuths", -360, 360);
    } else if (key == "ScatterRadial") {
      header.radial = words->List("scatter radial angles", 0, 180);
    } else {
      words->RestOfLine();
      header.ignored.push_back(Excerpt(key));
    }
  }
  for (const char* key : {"ScatterAzimuth", "ScatterRadial"}) {
    if (seen.count(key) == 0) words->Fail(std::string("the data begin, but the header has no ") + key + "; add it");
  }
  return header;
}

double Bounded(WordReader* words, const std::string& key, double low, double high) {
  const double number = words->FiniteNumber(key);
  if (number < low || number > high) {
    words->Fail(key + " is " + FormatDouble(number) + "; allowed are " + FormatDouble(low) + " to " +
                FormatDouble(high));
  }
  return number;
}

// Reads one block; false at DataEnd.
bool ReadBlock(WordReader* words, std::size_t cells, Block* block) {
  static const std::vector<std::string> kKeys = {"AOI", "POI", "Side", "Wavelength", "ScatterType", "TristimulusValue",
                                                 "TIS"};
  std::map<std::string, std::size_t> seen;
  while (true) {
    const std::string key(words->Word("a key of a data block or DataEnd"));
    if (key == "DataEnd" && seen.empty()) return false;
    const auto [first, is_new] = seen.emplace(key, words->line());
    if (!is_new)
      words->Fail("the key " + Excerpt(key) + " stands in line " + std::to_string(first->second) + " already");
    if (key == "AOI") {
      block->incidence = Bounded(words, key, 0, 90);
    } else if (key == "POI") {
      block->plane = Bounded(words, key, -360, 360);
    } else if (key == "Side") {
      block->side = OneOf(words, key, {"Front", "Back"}) == 0 ? Side::kFront : Side::kBack;
    } else if (key == "Wavelength") {
      block->wavelength = Bounded(words, key, 0, 1e6);
    } else if (key == "ScatterType") {
      block->reflection = OneOf(words, key, {"BRDF", "BTDF"}) == 0;
    } else if (key == "TristimulusValue") {
      block->tristimulus = OneOf(words, key, {"TrisX", "TrisY", "TrisZ"});
    } else if (key == "TIS") {
      words->Number(key);
      break;
    } else {
      words->Fail("'" + Excerpt(key) + "' is not a key of a data block" + DidYouMean(key, kKeys) + "; allowed are " +
                  Join(kKeys) + ", and DataEnd between blocks");
    }
  }
  if (seen.count("AOI") == 0) words->Fail("the block has no AOI before its values; add it");
  words->ExpectRoomFor(cells, "the block");
  block->values.reserve(cells);
  block->lines.reserve(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    block->values.push_back(words->Number("a value of the block"));
    block->lines.push_back(static_cast<std::uint32_t>(words->line()));
  }
  return true;
}

// Index of the block's channel among the sorted wavelengths, or its tristimulus value.
std::size_t ChannelOf(const Block& block, const Header& header, const std::vector<double>& wavelengths) {
  if (header.tristimulus) return block.tristimulus;
  const auto at = std::lower_bound(wavelengths.begin(), wavelengths.end(), block.wavelength);
  return static_cast<std::size_t>(at - wavelengths.begin());
}

Channels ChannelsOf(const Header& header, const std::vector<double>& wavelengths) {
  if (header.tristimulus) return {{"X", "Y", "Z"}, {}};
  if (wavelengths.size() == 1 && wavelengths[0] == 0) return {{"Y"}, {}};
  Channels channels;
  for (const double wavelength : wavelengths) {
    channels.names.push_back(FormatDouble(wavelength) + "nm");
    channels.wavelengths_nm.push_back(wavelength);
  }
  return channels;
}

}  // namespace

bool IsLightTools(std::string_view bytes) {
  const std::string_view head = Head(bytes);
  return HasLineWithFirstWord(head, "ScatterRadial") && HasLineWithFirstWord(head, "DataBegin") &&
         HasLineWithFirstWord(head, "AOI");
}

Measurement ReadLightTools(const InputFile& file, const ReadOptions& options) {
  WordReader words(file);
  const Header header = ReadHeader(&words);
  const std::optional<std::size_t> cells = CheckedProduct({header.azimuth.size(), header.radial.size()});
  words.ExpectRoomFor(cells, "one block");

  std::vector<Block> reflection[2];
  std::size_t transmission = 0;
  for (Block block; ReadBlock(&words, *cells, &block); block = {}) {
    if (!block.reflection) {
      ++transmission;
    } else {
      reflection[block.side == Side::kFront ? 0 : 1].push_back(std::move(block));
    }
  }
  if (const std::optional<std::string_view> more = words.Next()) {
    words.Fail("'" + Excerpt(*more) + "' stands after DataEnd; nothing is allowed there");
  }
  const Side side = options.side.value_or(reflection[0].empty() ? Side::kBack : Side::kFront);
  const std::vector<Block>& blocks = reflection[side == Side::kFront ? 0 : 1];
  if (blocks.empty()) {
    words.Fail("the file has no block of reflection (ScatterType BRDF) of the " +
               std::string(options.side ? side == Side::kFront ? "front; try --side back" : "back; try --side front"
                                        : "front or back; only reflection can be fitted"));
  }
  std::vector<double> wavelengths;
  wavelengths.reserve(blocks.size());
  for (const Block& block : blocks) wavelengths.push_back(block.wavelength);
  std::sort(wavelengths.begin(), wavelengths.end());
  wavelengths.erase(std::unique(wavelengths.begin(), wavelengths.end()), wavelengths.end());
  if (header.tristimulus) wavelengths.resize(3);

  // The blocks of one incidence, one a channel.
  std::map<std::pair<double, double>, std::vector<const Block*>> incidences;
  for (const Block& block : blocks) {
    std::vector<const Block*>& channels = incidences[{block.incidence, block.plane}];
    channels.resize(wavelengths.size(), nullptr);
    const Block*& slot = channels[ChannelOf(block, header, wavelengths)];
    if (slot != nullptr) {
      FailAtLine(file, block.lines.front(),
                 "a block of the same incidence, side and channel begins in line " +
                     std::to_string(slot->lines.front()) + " already");
    }
    slot = &block;
  }

  MeasurementBuilder builder(ChannelsOf(header, wavelengths));
  std::vector<double> values(wavelengths.size());
  bool one_plane = true;
  for (const auto& [angles, channels] : incidences) {
    one_plane = one_plane && angles.second == incidences.begin()->first.second;
    const auto missing = std::find(channels.begin(), channels.end(), nullptr);
    if (missing != channels.end()) {
      const Block* present =
          *std::find_if(channels.begin(), channels.end(), [](const Block* b) { return b != nullptr; });
      FailAtLine(file, present->lines.front(),
                 "the incidence AOI " + FormatDouble(angles.first) + ", POI " + FormatDouble(angles.second) +
                     " has no block for channel " +
                     builder.measurement().channels.names[static_cast<std::size_t>(missing - channels.begin())] +
                     "; each incidence needs all channels");
    }
    const Vec3 wi =
        FromSpherical(DegreesToRadians(angles.first), DegreesToRadians(options.lighttools_azimuth_deg + angles.second));
    std::size_t cell = 0;
    for (const double azimuth : header.azimuth) {
      for (const double radial : header.radial) {
        const Vec3 wo = FromSpherical(DegreesToRadians(radial), DegreesToRadians(azimuth));
        bool hole = true;
        for (std::size_t c = 0; c < values.size(); ++c) {
          values[c] = channels[c]->values[cell];
          hole = hole && values[c] == 0;
        }
        if (hole && IsAboveHorizon(wi) && IsAboveHorizon(wo)) {
          builder.Skip(SetAsideReason::kHole);
        } else {
          builder.Add(wi, wo, values.data(), channels[0]->lines[cell]);
        }
        ++cell;
      }
    }
  }
  Measurement measurement = builder.Finish();
  measurement.isotropic = header.plane_symmetrical && one_plane;
  measurement.conventions["angle-unit"] = "deg (format)";
  measurement.conventions["value-kind"] = "f (format)";
  measurement.conventions["side"] =
      std::string(side == Side::kFront ? "front" : "back") + (options.side ? "" : " (default)");
  measurement.conventions["lighttools-azimuth"] = FormatDouble(options.lighttools_azimuth_deg) + " degrees";
  measurement.conventions["hole"] = "0";
  if (transmission > 0) {
    measurement.remarks.push_back(std::to_string(transmission) + " blocks of transmission (BTDF) were not read");
  }
  const std::size_t others = reflection[side == Side::kFront ? 1 : 0].size();
  if (others > 0) measurement.remarks.push_back(std::to_string(others) + " blocks of the other side were not read");
  if (!header.ignored.empty()) {
    measurement.remarks.push_back("keys of the header that are not known were ignored: " + Join(header.ignored));
  }
  return measurement;
}

}  // namespace lobefit
