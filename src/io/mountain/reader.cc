// pab-opto "Mountain" text: one incident direction a file, header keys in '#' lines, then rows theta phi value (or X Y
// Z) in degrees. Files that were joined are read as their parts. The incident direction points to the source, in the
// same coordinates as the rows. "DSF" values are f_r cos(theta_o); BSDF, BRDF and BTDF have no cosine. theta > 90
// degrees is the other side of the sample.
#include "lobefit/io/mountain/reader.h"

#include <cmath>
#include <string>
#include <vector>

#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Header {
  std::optional<ValueKind> kind;
  std::string kind_word;
  std::optional<double> theta, phi;  // degrees
  std::optional<double> up_phi;
  std::vector<std::string> comments;
  bool tristimulus = false;
  std::optional<std::pair<std::string, std::size_t>> points;  // text and line of the number of rows
};

void ReadFormatKey(const InputFile& file, std::size_t line, const std::vector<std::string_view>& fields,
                   Header* header) {
  static const std::vector<std::string> kKinds = {"DSF", "BSDF", "BRDF", "BTDF"};
  if (fields.size() != 4 || ToLower(fields[1]) != "theta" || ToLower(fields[2]) != "phi") {
    FailAtLine(file, line, "the format should be 'theta phi DSF' or 'theta phi BRDF'; other columns are not known");
  }
  header->kind_word = ToLower(fields[3]);
  for (const std::string& kind : kKinds) {
    if (header->kind_word == ToLower(kind)) {
      header->kind = kind == "DSF" ? ValueKind::kBrdfCosO : ValueKind::kBrdf;
      return;
    }
  }
  FailAtLine(file, line, "the format names the value '" + Excerpt(fields[3]) + "'; allowed are " + Join(kKinds));
}

double Angle(const InputFile& file, std::size_t line, const std::vector<std::string_view>& fields, std::size_t index,
             const char* what, double low, double high) {
  if (index >= fields.size())
    FailAtLine(file, line, std::string("the header key has no ") + what + "; add it in degrees");
  const double angle = FiniteNumberAt(file, line, fields[index], what);
  if (angle < low || angle > high) {
    FailAtLine(file, line,
               std::string(what) + " is " + FormatDouble(angle) + " degrees; allowed are " + FormatDouble(low) +
                   " to " + FormatDouble(high));
  }
  return angle;
}

void ReadHeaderLine(const InputFile& file, std::size_t line_number, std::string_view line, Header* header) {
  line.remove_prefix(1);
  const std::vector<std::string_view> fields = SplitBlanks(line);
  if (fields.empty()) return;
  std::string key = ToLower(fields[0]);
  if (key.back() == ':') key.pop_back();
  if (key == "format") {
    ReadFormatKey(file, line_number, fields, header);
  } else if (key == "intheta") {
    header->theta = Angle(file, line_number, fields, 1, "the incident polar angle", 0, 180);
  } else if (key == "inphi") {
    header->phi = Angle(file, line_number, fields, 1, "the incident azimuth", -360, 360);
  } else if (key == "incident_angle") {
    header->theta = Angle(file, line_number, fields, 1, "the incident polar angle", 0, 180);
    header->phi = Angle(file, line_number, fields, 2, "the incident azimuth", -360, 360);
  } else if (key == "upphi") {
    header->up_phi = Angle(file, line_number, fields, 1, "the azimuth of 'up'", -360, 360);
  } else if (key == "colorimetry") {
    const std::string name = fields.size() == 2 ? ToLower(fields[1]) : "";
    if (name != "cie-y" && name != "cie-xyz") {
      FailAtLine(file, line_number, "the colorimetry is '" + Excerpt(Trim(line)) + "'; allowed are CIE-Y and CIE-XYZ");
    }
    header->tristimulus = name == "cie-xyz";
  } else if (key == "datapoints_in_file" && fields.size() == 2) {
    header->points = {std::string(fields[1]), line_number};
  } else {
    header->comments.emplace_back(Trim(key == "comment" ? line.substr(line.find(fields[0]) + fields[0].size()) : line));
  }
}

void CheckHeader(const InputFile& file, std::size_t line, const Header& header) {
  if (!header.kind) {
    FailAtLine(file, line,
               "the rows begin, but the header has no '#format: theta phi DSF' (or BRDF), so that the "
               "cosine is not known; add it");
  }
  if (!header.theta || !header.phi) {
    FailAtLine(file, line,
               "the rows begin, but the header has no incident direction; add '#incident_angle THETA PHI' "
               "in degrees, towards the source");
  }
}

void CheckPoints(const InputFile& file, std::size_t line, const Header& header, std::size_t rows) {
  if (!header.points) return;
  const std::optional<long long> points = ParseInteger(header.points->first);
  if (points && *points >= 0 && static_cast<std::size_t>(*points) <= rows) return;
  FailAtLine(file, line,
             "the file ends after " + std::to_string(rows) + " rows, but line " +
                 std::to_string(header.points->second) + " announces " + Excerpt(header.points->first) +
                 " (#datapoints_in_file); it may be cut off");
}

// The head of a part that follows rows: all of it where the kind of value is said again, else what changes; a comment
// changes nothing.
Header HeadOfPart(const Header& before, const Header& part) {
  if (part.kind) return part;
  Header head = before;
  if (part.theta) head.theta = part.theta;
  if (part.phi) head.phi = part.phi;
  if (part.up_phi) head.up_phi = part.up_phi;
  head.points = part.points;
  return head;
}

void RequireSameValues(const InputFile& file, std::size_t line, const Header& first, const Header& part) {
  if (part.kind_word != first.kind_word || part.tristimulus != first.tristimulus) {
    FailAtLine(file, line,
               "the rows begin to hold other values than those above (#format, #colorimetry); put the parts into files "
               "of their own");
  }
}

}  // namespace

bool IsMountain(std::string_view bytes) {
  const std::string_view head = Head(bytes);
  if (head.substr(0, 1) != "#") return false;
  return HasLineWithFirstWord(head, "#format:") || HasLineWithFirstWord(head, "#intheta") ||
         HasLineWithFirstWord(head, "#incident_angle");
}

Measurement ReadMountain(const InputFile& file, const ReadOptions& options) {
  Header header, part;
  std::optional<MeasurementBuilder> builder;
  std::vector<std::string> comments;
  Header first;
  std::size_t rows = 0, transmitted = 0, part_rows = 0;
  bool in_head = true;
  bool back = false;
  double turn = 0;
  Vec3 wi = {0, 0, 1};
  // A sample lit from behind is turned about y, so that its back normal is +z.
  const auto turned = [&](const Vec3& w) { return back ? Vec3{-w.x, w.y, -w.z} : w; };

  LineReader lines(file.bytes);
  std::string_view line;
  while (lines.Next(&line)) {
    const std::size_t at = lines.line_number();
    if (Trim(line).empty()) continue;
    if (line[0] == '#') {
      if (!in_head) part = {};
      in_head = true;
      part.comments.clear();
      ReadHeaderLine(file, at, line, &part);
      comments.insert(comments.end(), part.comments.begin(), part.comments.end());
      continue;
    }
    if (in_head) {
      in_head = false;
      const bool begins = part.kind || part.theta || part.phi || part.points;
      if (builder && begins) {
        CheckPoints(file, at, header, part_rows);
        part_rows = 0;
      }
      header = !builder ? part : begins ? HeadOfPart(header, part) : header;
      CheckHeader(file, at, header);
      if (!builder) {
        first = header;
        builder.emplace(
            Channels{header.tristimulus ? std::vector<std::string>{"X", "Y", "Z"} : std::vector<std::string>{"Y"}, {}});
      }
      RequireSameValues(file, at, first, header);
      if (options.mountain_azimuth == MountainAzimuth::kUp) turn = 90 - header.up_phi.value_or(0);
      back = *header.theta > 90;
      wi = turned(FromSpherical(DegreesToRadians(*header.theta), DegreesToRadians(*header.phi + turn)));
    }
    const std::vector<std::string_view> fields = SplitBlanks(line);
    const std::size_t channels = builder->measurement().channels.size();
    if (fields.size() != 2 + channels) {
      FailAtLine(file, at,
                 "has " + std::to_string(fields.size()) + " fields; the header announces theta phi and " +
                     std::to_string(channels) + (channels == 1 ? " value" : " values X Y Z"));
    }
    const double theta = Angle(file, at, fields, 0, "theta", 0, 180);
    const double phi = Angle(file, at, fields, 1, "phi", -720, 720);
    const Vec3 wo = turned(FromSpherical(DegreesToRadians(theta), DegreesToRadians(phi + turn)));
    const double factor = BrdfFactor(*header.kind, wi.z, wo.z);
    double values[3] = {};
    for (std::size_t c = 0; c < channels; ++c) values[c] = factor * NumberAt(file, at, fields[2 + c], "value");
    if (!IsAboveHorizon(wo)) ++transmitted;
    builder->Add(wi, wo, values, static_cast<std::uint32_t>(at));
    ++rows;
    ++part_rows;
  }
  const std::size_t last = std::max<std::size_t>(lines.line_number(), 1);
  if (!builder) FailAtLine(file, last, "the file ends after its header; it has no rows and may be cut off");
  if (in_head && (part.kind || part.theta || part.phi))
    FailAtLine(file, last, "the file ends after the header of a part; it has no rows and may be cut off");
  CheckPoints(file, last, header, part_rows);
  Measurement measurement = builder->Finish();
  if (header.kind_word == "btdf" || transmitted == rows) {
    FailAtLine(file, last,
               "the file holds transmission (number of rows " + std::to_string(rows) +
                   ", all on the side away from the light or the format is BTDF); only reflection can "
                   "be fitted");
  }
  measurement.comments = std::move(comments);
  measurement.conventions["angle-unit"] = "deg (format)";
  measurement.conventions["value-kind"] = Name(*header.kind) + " (header)";
  measurement.conventions["incident"] = "towards (format)";
  measurement.conventions["side"] = back ? "back (header; turned about y)" : "front (header)";
  measurement.conventions["mountain-azimuth"] =
      options.mountain_azimuth == MountainAzimuth::kUp
          ? "up (phi " + FormatDouble(header.up_phi.value_or(0)) + (header.up_phi ? ", header" : ", default") + ")"
          : "file";
  return measurement;
}

}  // namespace lobefit
