// What every reader shares: what a file leaves open (options), the file as readers see it, and a row of the table of
// formats.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/measurement/measurement.h"

namespace lobefit {

enum class AngleUnit { kDegrees, kRadians, kGon, kMilliradians, kArcMinutes, kArcSeconds };
// What the file's numbers are: f_r; f_r times the cosine of wo or of wi; pi f_r (reflectance factor); radiant intensity
// per incident flux, which is f_r cos(theta_o) too but per irradiance of the whole sample; pi f_r cos(theta_o) (a
// detector's reading relative to a white standard that faces it); pi f_r cos(theta_i) (radiance relative to a white
// standard lit along its normal, "I/F").
enum class ValueKind { kBrdf, kBrdfCosO, kBrdfCosI, kReflectanceFactor, kIntensity, kReading, kReflectanceCosI };
// Whether the file's incident direction points to the source (as here) or along the propagation of the light.
enum class IncidentSense { kTowardsSource, kPropagation };
enum class CellPosition { kCentre, kEdge };
// The side of the sample that is measured: the one whose normal is +z in the file's coordinates, or the other.
enum class Side { kFront, kBack };
// BSDF-XML: WINDOW calls "Front" what faces outdoors, which is the side away from the normal of Radiance's coordinates.
enum class XmlNaming { kWindow, kPlain };
// ALTA "#VS 2": the two extra columns are the ends of the interval (as its manual says) or distances from the value (as
// its code reads them).
enum class IntervalKind { kBounds, kOffsets };
// pab Mountain: azimuths as in the file, or turned so that the "up" direction of the header is +y, as Radiance does.
enum class MountainAzimuth { kFile, kUp };
// What becomes of rows whose pair of directions came before.
enum class RepeatedRows { kFirst, kMean };
// Numbers of UTIA files: f_r as they are, or f_r / 100 behind an sRGB curve (what some readers take them for).
enum class UtiaEncoding { kRaw, kSrgb };
// What the pixels of an EXR image are. kSlice: theta_h to the right, theta_d, both over 90 degrees, phi_d fixed;
// kSliceSqrt: the same with theta_h = (linear axis)^2 / (pi/2); kHemisphere: the viewers of one incident direction;
// kUtia: row = 48 i + j for the light at 15 i, 7.5 j degrees, columns likewise for the viewer.
enum class ExrAxes { kSlice, kSliceSqrt, kHemisphere, kUtia };
// Of a hemisphere on the image's square: radius theta / 90 degrees; sqrt(2) sin(theta / 2); or the whole square by the
// concentric map of the projected direction.
enum class ExrProjection { kEquidistant, kEqualArea, kConcentric };
// Whether theta_d of a slice grows upwards (as in image slices of BRDF Explorer) or downwards (as ALTA writes them).
enum class ExrRows { kUp, kDown };

// What files do not say and formats disagree on. Unset: the format's documented default, or what the file's header
// says. Every choice that a reader makes is echoed in Measurement::conventions under the option's name on the command
// line.
struct ReadOptions {
  // --noise-floor SIGMA (all): standard deviation of the reading f_r cos(theta_i), 1/sr; becomes weights.
  std::optional<double> noise_floor;
  // --repeated first|mean (csv): of a pair of directions that occurs again the first row is kept, or the mean of all
  // with their spread as weight.
  std::optional<RepeatedRows> repeated;  // Unset: first
  std::optional<AngleUnit> angle_unit;   // --angle-unit deg|rad|gon|mrad (csv, astm)
  std::optional<ValueKind>
      value_kind;  // --value-kind f|f-cos-o|f-cos-i|pi-f|intensity|pi-f-cos-o (csv, alta, astm, exr)
  std::optional<IncidentSense> incident_sense;  // --incident towards|propagation (csv, astm, fred)
  std::optional<std::string> value_column;      // --value-column NAME            (csv with several candidate columns)
  // --columns MEANING=COLUMN,... (csv): what columns mean whose names do not say it; io/csv/head/mapping.h.
  std::string columns;
  // --where COLUMN=VALUE,... (csv): only rows with these texts or numbers.
  std::string where;
  // --wavelength-tolerance NM (csv): wavelengths of rows that differ by no more are one channel.
  std::optional<double> wavelength_tolerance_nm;
  // --value-scale UNIT (csv): what the numbers are in: %, dB, log10, ln, 1e-3/sr, a.u.; io/text/units.h.
  std::string value_scale;
  // --no-value LIST (all): words (csv) and numbers that stand for no value.
  std::string no_value;
  // --exclude ZONES (all): what is set aside; measurement/prepare/exclusion.h.
  std::string exclude;
  // --channels CHOICE (all): which channels are used; measurement/spectrum.h. A sample needs values in those only.
  std::string channels;
  // What is stated behind the file's name, FILE:theta_i=30,sample-rotation=20: keys of a CSV's head; of other formats
  // sample-rotation only.
  std::vector<std::string> keys;
  CellPosition merl_cell = CellPosition::kCentre;  // --merl-cell centre|edge      (merl)
  // --side front|back (bsdf-xml, lighttools). Unset: front, or back where the file has only that.
  std::optional<Side> side;
  // --xml-naming window|plain (bsdf-xml). With "window", front reads the block "Reflection Back" and back "Reflection
  // Front".
  XmlNaming xml_naming = XmlNaming::kWindow;
  // --xml-wavelength NAME (bsdf-xml). Unset: Visible (with CIE-X and CIE-Z, or CIE-u and CIE-v, where they are there),
  // or all wavelengths that are numbers, or the only one in the file.
  std::optional<std::string> xml_wavelength;
  // --zemax-rotation-sign +1|-1 (zemax). The light's azimuth is this times SampleRotation; the format does not say
  // which, and the azimuth of a fitted grain changes sign with it.
  int zemax_rotation_sign = 1;
  // --lighttools-azimuth DEGREES (lighttools). Azimuth of the light where the plane of incidence (POI) is 0.
  double lighttools_azimuth_deg = 90;
  // --alta-interval bounds|offsets (alta). Unset: bounds where every value lies between its two columns, else offsets.
  std::optional<IntervalKind> alta_interval;
  MountainAzimuth mountain_azimuth = MountainAzimuth::kFile;  // --mountain-azimuth file|up (mountain)
  CellPosition mit_cell = CellPosition::kCentre;              // --mit-cell centre|edge     (mit)
  std::optional<double> mit_scale;                            // --mit-scale FACTOR         (mit). Unset: 10
  std::optional<int> mit_stride;  // --mit-stride N: every N-th azimuth (mit). Unset: what keeps 4 million cells at most
  UtiaEncoding utia_encoding = UtiaEncoding::kRaw;  // --utia-encoding raw|srgb   (utia)
  std::optional<double> utia_scale;                 // --utia-scale FACTOR        (utia). Unset: 1
  // EXR images. Unset: the file's attributes brdf.axes, brdf.projection, brdf.rows, brdf.phi_d, brdf.theta_i,
  // brdf.phi_i, brdf.value.
  std::optional<ExrAxes> exr_axes;              // --exr-axes slice|slice-sqrt|hemisphere|utia
  std::optional<ExrProjection> exr_projection;  // --exr-projection equidistant|equal-area|concentric
  std::optional<ExrRows> exr_rows;              // --exr-rows up|down
  std::optional<double> exr_phi_d_deg;          // --exr-phi-d DEGREES. Unset and not in the file: 90
  std::optional<double> exr_theta_i_deg;        // --exr-theta-i DEGREES
  std::optional<double> exr_phi_i_deg;          // --exr-phi-i DEGREES
};

// An input file as the readers see it: its name for messages and its bytes.
struct InputFile {
  std::filesystem::path path;
  std::string_view bytes;
};

// One file format. `recognise` looks at content only, never at the name; `read` throws InputError with the place in the
// file.
struct Format {
  const char* name;
  const char* description;
  bool (*recognise)(std::string_view bytes);
  Measurement (*read)(const InputFile& file, const ReadOptions& options);
};

}  // namespace lobefit
