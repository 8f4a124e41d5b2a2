// Zemax BSDF Data Interchange text: one grid of azimuth and radial angle around the specular direction for each sample
// rotation and angle of incidence. Values are f_r in 1/sr without a cosine, degrees; 0 stands for "not measured" in the
// files that are around, which fill directions below the horizon and beyond the instrument's reach with it.
#include "lobefit/io/zemax/reader.h"

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Header {
  bool plane_symmetrical = false;
  bool tristimulus = false;
  std::string symmetry;
  std::vector<double> rotation, incidence, azimuth, radial;  // degrees
};

std::string OneOf(WordReader* words, const std::string& key, const std::vector<std::string>& allowed) {
  const std::string_view word = words->Word("the value of " + key);
  for (const std::string& candidate : allowed) {
    if (ToLower(word) == ToLower(candidate)) return candidate;
  }
  words->Fail(key + " is '" + Excerpt(word) + "'; allowed are " + Join(allowed) + DidYouMean(word, allowed));
}

void ReadScatterType(WordReader* words) {
  if (OneOf(words, "ScatterType", {"BRDF", "BTDF"}) == "BTDF") {
    words->Fail(
        "ScatterType is BTDF, transmission; only reflection (BRDF) can be fitted: export the BRDF of the sample");
  }
}

// Reads the keys up to the first section heading, which stays unread.
Header ReadHeader(WordReader* words) {
  static const std::vector<std::string> kKeys = {"Source",         "Symmetry",       "SpectralContent",
                                                 "ScatterType",    "SampleRotation", "AngleOfIncidence",
                                                 "ScatterAzimuth", "ScatterRadial"};
  Header header;
  std::map<std::string, std::size_t> seen;
  while (true) {
    const std::optional<std::string_view> heading = words->Peek();
    if (heading && (*heading == "Monochrome" || heading->substr(0, 11) == "Tristimulus")) break;
    const std::string key(words->Word("a key of the header or the heading Monochrome or TristimulusX"));
    const auto [first, is_new] = seen.emplace(key, words->line());
    if (!is_new)
      words->Fail("the key " + Excerpt(key) + " stands in line " + std::to_string(first->second) + " already");
    if (key == "Source") {
      words->Word("the value of Source");
    } else if (key == "Symmetry") {
      header.symmetry = OneOf(words, key, {"PlaneSymmetrical", "ASymmetrical", "ASymmetrical4D"});
      header.plane_symmetrical = header.symmetry == "PlaneSymmetrical";
    } else if (key == "SpectralContent") {
      header.tristimulus = OneOf(words, key, {"Monochrome", "XYZ"}) == "XYZ";
    } else if (key == "ScatterType") {
      ReadScatterType(words);
    } else if (key == "SampleRotation") {
      header.rotation = words->List("sample rotations", -360, 360);
    } else if (key == "AngleOfIncidence") {
      header.incidence = words->List("angles of incidence", 0, 90);
    } else if (key == "ScatterAzimuth") {
      header.azimuth = words->List("scatter azimuths", -360, 360);
    } else if (key == "ScatterRadial") {
      header.radial = words->List("scatter radial angles", 0, 180);
    } else {
      words->Fail("'" + Excerpt(key) + "' is not a key of the header" + DidYouMean(key, kKeys) + "; allowed are " +
                  Join(kKeys));
    }
  }
  for (const char* key : {"Symmetry", "AngleOfIncidence", "ScatterAzimuth", "ScatterRadial"}) {
    if (seen.count(key) == 0) {
      words->Next();
      words->Fail(std::string("the data begin, but the header has no ") + key + "; add it");
    }
  }
  if (header.rotation.empty()) header.rotation = {0};
  return header;
}

// The values of one section, rotation outermost, radial angle innermost.
struct Section {
  std::vector<double> values;
  std::vector<std::uint32_t> lines;
};

Section ReadSection(WordReader* words, const Header& header, std::size_t count) {
  Section section;
  section.values.reserve(count);
  section.lines.reserve(count);
  if (words->Word("DataBegin") != "DataBegin") words->Fail("the section should begin with DataBegin");
  const std::size_t block = header.azimuth.size() * header.radial.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i % block == 0) {
      const std::string_view tis = words->Word("TIS or DataEnd");
      if (tis != "TIS") {
        words->Fail("found '" + Excerpt(tis) + "' where TIS should begin grid " + std::to_string(i / block + 1) +
                    " of " + std::to_string(count / block) + ", one a sample rotation and angle of incidence, each " +
                    std::to_string(header.azimuth.size()) + " x " + std::to_string(header.radial.size()) + " values");
      }
      words->Number("TIS");
    }
    section.values.push_back(words->Number("a value of the grid"));
    section.lines.push_back(static_cast<std::uint32_t>(words->line()));
  }
  if (const std::string_view end = words->Word("DataEnd"); end != "DataEnd") {
    words->Fail("found '" + Excerpt(end) + "' where DataEnd should follow the " + std::to_string(count) +
                " values that the header announces");
  }
  return section;
}

std::vector<Section> ReadSections(WordReader* words, const Header& header, std::size_t count) {
  const std::vector<std::string> headings =
      header.tristimulus ? std::vector<std::string>{"TristimulusX", "TristimulusY", "TristimulusZ"}
                         : std::vector<std::string>{"Monochrome"};
  std::vector<Section> sections(headings.size());
  for (std::size_t read = 0; read < headings.size(); ++read) {
    const std::string_view heading = words->Word("the heading of a section");
    std::size_t channel = 0;
    while (channel < headings.size() && heading != headings[channel]) ++channel;
    if (channel == headings.size()) {
      words->Fail("the section is headed '" + Excerpt(heading) + "'; SpectralContent allows " + Join(headings));
    }
    if (!sections[channel].values.empty()) words->Fail("the section " + headings[channel] + " is there twice");
    sections[channel] = ReadSection(words, header, count);
  }
  if (const std::optional<std::string_view> more = words->Next()) {
    words->Fail("'" + Excerpt(*more) + "' stands after the last section; nothing is allowed there");
  }
  return sections;
}

// Direction at angle `radial` from the specular direction; azimuth 0 points from it towards the normal, growing towards
// +y for light in the xz plane. All radians.
Vec3 AroundSpecular(double incidence, double azimuth, double radial) {
  const Vec3 specular = {-std::sin(incidence), 0, std::cos(incidence)};
  const Vec3 towards_normal = {std::cos(incidence), 0, std::sin(incidence)};
  const Vec3 side = {0, 1, 0};
  return std::cos(radial) * specular +
         std::sin(radial) * (std::cos(azimuth) * towards_normal + std::sin(azimuth) * side);
}

}  // namespace

bool IsZemax(std::string_view bytes) {
  const std::string_view head = Head(bytes);
  return HasLineWithFirstWord(head, "AngleOfIncidence") && HasLineWithFirstWord(head, "ScatterRadial");
}

Measurement ReadZemax(const InputFile& file, const ReadOptions& options) {
  WordReader words(file);
  const Header header = ReadHeader(&words);
  const std::optional<std::size_t> count =
      CheckedProduct({header.rotation.size(), header.incidence.size(), header.azimuth.size(), header.radial.size()});
  const std::size_t channels = header.tristimulus ? 3 : 1;
  words.ExpectRoomFor(count ? CheckedProduct({*count, channels}) : std::nullopt, "the grids");
  const std::vector<Section> sections = ReadSections(&words, header, *count);

  MeasurementBuilder builder(
      {header.tristimulus ? std::vector<std::string>{"X", "Y", "Z"} : std::vector<std::string>{"Y"}, {}});
  std::size_t cell = 0;
  for (const double rotation : header.rotation) {
    const double light_azimuth = DegreesToRadians(options.zemax_rotation_sign * rotation);
    for (const double incidence : header.incidence) {
      const Vec3 wi = FromSpherical(DegreesToRadians(incidence), light_azimuth);
      for (const double azimuth : header.azimuth) {
        for (const double radial : header.radial) {
          const Vec3 in_plane =
              AroundSpecular(DegreesToRadians(incidence), DegreesToRadians(azimuth), DegreesToRadians(radial));
          std::array<double, 3> values = {};
          bool hole = true;
          for (std::size_t c = 0; c < channels; ++c) {
            values[c] = sections[c].values[cell];
            hole = hole && values[c] == 0;
          }
          if (hole && IsAboveHorizon(in_plane) && IsAboveHorizon(wi)) {
            builder.Skip(SetAsideReason::kHole);
          } else {
            builder.Add(wi, RotateZ(in_plane, light_azimuth), values.data(), sections[0].lines[cell]);
          }
          ++cell;
        }
      }
    }
  }
  Measurement measurement = builder.Finish();
  measurement.isotropic = header.plane_symmetrical && header.rotation.size() == 1;
  measurement.conventions["angle-unit"] = "deg (format)";
  measurement.conventions["value-kind"] = "f (format)";
  measurement.conventions["zemax-rotation-sign"] = std::string(options.zemax_rotation_sign > 0 ? "+1" : "-1");
  measurement.conventions["symmetry"] =
      header.symmetry + (header.plane_symmetrical ? " (header; the mirrored half is not repeated)" : " (header)");
  measurement.conventions["hole"] = "0";
  return measurement;
}

}  // namespace lobefit
