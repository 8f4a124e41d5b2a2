// A measured BRDF: samples as a structure of arrays, and what is known about them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lobefit/math/vec.h"
#include "lobefit/measurement/left_out.h"
#include "lobefit/measurement/set_aside.h"
#include "lobefit/measurement/stated_instrument.h"

namespace lobefit {

// What the values of a sample stand for.
struct Channels {
  // "R" "G" "B"; "Y" for one luminance-like channel; "X" "Y" "Z"; or wavelengths, "550nm".
  std::vector<std::string> names;
  // Wavelengths in nanometres, one a channel; empty where the channels are not wavelengths.
  std::vector<double> wavelengths_nm;

  std::size_t size() const { return names.size(); }
};

// Samples as a structure of arrays; all arrays have the same length or, where said, none.
struct Samples {
  // Unit directions away from the surface (n = +z): wi to the light, wo to the viewer; both above the horizon.
  std::vector<double> wi_x, wi_y, wi_z, wo_x, wo_y, wo_z;
  // values[channel][sample]: f_r in 1/sr, no cosine; finite; may be negative (noise).
  std::vector<std::vector<double>> values;
  // Statistical weight that the file gives, mean 1. Empty: all 1.
  std::vector<double> weight;
  // Stated standard deviation of f_r, 1/sr, for all channels: from the file, from repetitions, from the instrument's
  // floor. What it weighs depends on the metric of the fit and on the model's value there
  // (fit/objective/sigma_weights.h). Empty: not known.
  std::vector<double> sigma;
  // Measure of the sample's cell in the space of direction pairs (any constant factor), for weighting by solid angle.
  // Empty: not known, the file lists directions without cells.
  std::vector<double> solid_angle;
  // By how much the sample was turned about its normal on the stage, radians, where the file turned it as a whole;
  // directions are those of its frame. Empty: by nothing.
  std::vector<double> sample_azimuth;
  // Which of the files that were pooled it is from, from 0; a mean of repeats from several is of the first. Empty: one
  // file, or a file a channel.
  std::vector<std::uint32_t> file;
  // Where the sample stands in its file: line of a text file (from 1), index of the cell in a table (from 0).
  std::vector<std::uint32_t> origin;

  std::size_t size() const { return wi_x.size(); }
  Vec3 wi(std::size_t i) const { return {wi_x[i], wi_y[i], wi_z[i]}; }
  Vec3 wo(std::size_t i) const { return {wo_x[i], wo_y[i], wo_z[i]}; }

  // Resizes every array that is in use (values, and weight, sigma and solid_angle where not empty) to `count` samples.
  void Resize(std::size_t count);
  // Keeps the samples i with keep[i] != 0, in order.
  void Keep(const std::vector<std::uint8_t>& keep);
  // The samples at `indices`, in that order.
  Samples Subset(const std::vector<std::size_t>& indices) const;
  // Adds one sample; values[c] for each channel. Does not touch weight, sigma and solid_angle.
  void Append(const Vec3& wi, const Vec3& wo, const double* channel_values, std::uint32_t origin_index);
};

// A direction of a sample: the one to the light (wi) or the one to the viewer (wo).
enum class Beam { kLight, kViewer };

struct Measurement {
  void LeaveOut(const Vec3& wi, const Vec3& wo, LeftOutReason reason) {
    if (left_out.size() < kMostLeftOut) left_out.push_back({wi, wo, reason});
  }

  Channels channels;
  Samples samples;
  SetAside set_aside;
  // Of those, where they were that zones and marks of a user leave out: at most kMostLeftOut of 56 bytes each.
  std::vector<LeftOut> left_out;
  // True where the file cannot express a dependence on azimuth (MERL, isotropic tables): the fit then takes an
  // isotropic model.
  bool isotropic = false;
  // Isotropic by its format, but the sample lay still while one side swept the hemisphere: its anisotropy is in the
  // rows.
  bool sample_at_rest = false;
  // The side whose directions were set one after the other while the other side swept: an incidence's samples share it.
  Beam listed_side = Beam::kLight;
  // Name of the format as in `lobefit info` ("merl", "rgl", "csv", ...), file name without folder, SHA-256 of the file.
  std::string format;
  std::string source;
  std::string sha256;
  // What the file leaves open or states about itself, by option name, with where it came from: {"merl-cell", "centre
  // (default)"}.
  std::map<std::string, std::string> conventions;
  StatedInstrument instrument;
  // Comment lines and titles of the file that state nothing which was understood, as written, without their marks: for
  // who writes the measurement anew.
  std::vector<std::string> comments;
  // Remarks for people: rectified noise recognised, columns ignored.
  std::vector<std::string> remarks;
};

// Samples are appended one by one; what cannot be used is set aside and counted here.
class MeasurementBuilder {
 public:
  explicit MeasurementBuilder(Channels channels);
  // Directions of any length > 0, away from the surface; values in f_r, one a channel. A direction with z <= 0 is below
  // the horizon; a direction or value that is not finite is set aside as kNotFinite. Returns true where the sample was
  // taken.
  bool Add(const Vec3& wi, const Vec3& wo, const double* values, std::uint32_t origin_index);
  void Skip(SetAsideReason reason, std::size_t count = 1) { measurement_.set_aside.Add(reason, count); }
  Measurement& measurement() { return measurement_; }
  // Sets aside repeated pairs of directions (equal to 1e-9 rad; the first stays, unlike ones are said), hands all over.
  Measurement Finish();

 private:
  Measurement measurement_;
};

}  // namespace lobefit
