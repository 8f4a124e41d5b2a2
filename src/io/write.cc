#include "lobefit/io/write.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/alta/writer.h"
#include "lobefit/io/bsdf_xml/writer.h"
#include "lobefit/io/compare_written.h"
#include "lobefit/io/csv/writer.h"
#include "lobefit/io/exr/writer.h"
#include "lobefit/io/merl/writer.h"
#include "lobefit/io/mountain/writer.h"
#include "lobefit/io/rgl/brdf.h"
#include "lobefit/io/series.h"
#include "lobefit/io/text/decoded_file.h"
#include "lobefit/math/directions.h"
#include "lobefit/measurement/checks/isotropy.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

using Path = std::filesystem::path;
using Paths = std::vector<Path>;

// Of the samples, those that an image holds: it shows the rest of them only through what is interpolated.
std::string SamplesOfImage(const Samples& samples, const ExrMap& map) {
  constexpr double kNear = 2 * kPi / 180;
  std::size_t near = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    near += map.DistanceTo(samples.wi(i), samples.wo(i)) <= kNear ? 1 : 0;
  return std::to_string(near) + " of " + std::to_string(samples.size()) +
         " samples lie within 2 degrees of what the image holds; it is interpolated between samples, and compared with "
         "that interpolation";
}

// A goniometer's directions for a function without samples.
Measurement Tabulated(const WriteSource& source) {
  GoniometerLayout layout;
  for (int theta = 0; theta <= 75; theta += 15) layout.polar_angles.push_back(DegreesToRadians(theta));
  const int azimuths = source.isotropic ? 1 : 8;
  for (int a = 0; a < azimuths; ++a) layout.azimuths.push_back(2 * kPi * a / azimuths);
  layout.detector_step = DegreesToRadians(5);
  return Synthesise(Goniometer(layout), source.channels, source.brdf, {}, 0);
}

template <class Write>
Paths WriteSamples(const WriteSource& source, const Path& path, Write&& write) {
  if (source.measurement != nullptr) {
    write(*source.measurement);
  } else {
    write(Tabulated(source));
  }
  return {path};
}

BrdfFunction FunctionOf(const WriteSource& source) {
  return source.brdf ? source.brdf : Interpolate(*source.measurement);
}

// For tables that have no mark for what was not measured: there f_r is that of the nearest covered pair on the way to
// the normal, in place of a value over a cosine that goes to zero.
BrdfFunction Continued(const BrdfFunction& brdf, const DirectionsPredicate& covers) {
  if (!covers) return brdf;
  return [brdf, covers](const Vec3& wi, const Vec3& wo, double* values) {
    constexpr int kSteps = 45;
    Vec3 light = wi, viewer = wo;
    for (int step = 1; step < kSteps && wi.z > 0 && wo.z > 0 && !covers(light, viewer); ++step) {
      if (covers(viewer, light)) {
        std::swap(light, viewer);
        break;
      }
      const double share = 1 - static_cast<double>(step) / kSteps;
      light = FromSpherical(share * PolarAngle(wi), Azimuth(wi));
      viewer = FromSpherical(share * PolarAngle(wo), Azimuth(wo));
    }
    brdf(light, viewer, values);
  };
}

Paths WriteCsvFormat(const WriteSource& source, const WriteOptions&, const Path& path) {
  RequireReadableChannels(source.channels);
  return WriteSamples(source, path, [&](const Measurement& measurement) { WriteCsv(measurement, {}, path); });
}

Paths WriteAltaFormat(const WriteSource& source, const WriteOptions&, const Path& path) {
  return WriteSamples(source, path, [&](const Measurement& measurement) { WriteAlta(measurement, path); });
}

Paths WriteMountainFormat(const WriteSource& source, const WriteOptions&, const Path& path) {
  if (source.measurement != nullptr && !(source.measurement->isotropic && source.brdf)) {
    return WriteMountain(*source.measurement, path);
  }
  return WriteMountain(Tabulated(source), path);
}

// The samples of one azimuth as those of an isotropic surface. A table of `format` over (theta_h, theta_d, phi_d) can
// be filled from them only where they come near every part of it; in a plane they do not.
BrdfFunction IsotropicFunction(const Measurement& measurement, const std::string& format) {
  constexpr double kNear = 10 * kPi / 180, kGrazing = 75 * kPi / 180, kLeastShare = 0.9;
  constexpr int kSteps = 12;
  Measurement isotropic = measurement;
  isotropic.isotropic = true;
  const Interpolator samples(isotropic);
  std::array<int, 3> near = {}, all = {};  // by thirds of theta_d
  for (int cell = 0; cell < kSteps * kSteps * kSteps; ++cell) {
    const auto at = [&](int index) { return (index % kSteps + 0.5) / kSteps; };
    const int d = cell / kSteps % kSteps;
    Vec3 wi, wo;
    FromHalfDifference({at(cell / kSteps / kSteps) * kPi / 2, 0, at(d) * kPi / 2, at(cell) * kPi}, &wi, &wo);
    if (wi.z < std::cos(kGrazing) || wo.z < std::cos(kGrazing)) continue;
    const auto third = static_cast<std::size_t>(3 * d / kSteps);
    ++all[third];
    near[third] += samples.Nearest(wi, wo, kNear) || samples.Nearest(wo, wi, kNear) ? 1 : 0;
  }
  const int all_cells = all[0] + all[1] + all[2], near_cells = near[0] + near[1] + near[2];
  if (near_cells < kLeastShare * all_cells) {
    std::string shares;
    for (std::size_t third = 0; third < 3; ++third) {
      shares += (third == 0 ? "" : ", ") + std::to_string(30 * third) + " to " + std::to_string(30 * third + 30) +
                ": " + std::to_string(100 * near[third] / std::max(1, all[third])) + " %";
    }
    throw UsageError(
        format +
        " cannot be filled from this measurement: light from one azimuth is taken as that of an isotropic surface, but "
        "only " +
        std::to_string(100 * near_cells / all_cells) +
        " % of the table (to 75 degrees) lies within 10 degrees of a sample; by theta_d in degrees, " + shares +
        "; measure more incidences and out of their plane, or write it as alta or csv");
  }
  return Interpolate(isotropic);
}

Paths WriteMerlFormat(const WriteSource& source, const WriteOptions& options, const Path& path) {
  const bool by_azimuth = source.measurement != nullptr && HasOneAzimuth(source.measurement->samples);
  // By construction the function does not depend on the azimuth, whatever interpolation or a table's own rows make of
  // the mirror direction, where phi_d is not defined.
  const double tolerance = by_azimuth || source.isotropic ? std::numeric_limits<double>::infinity() : 1e-3;
  WriteMerl(by_azimuth ? IsotropicFunction(*source.measurement, "a MERL table") : FunctionOf(source), source.channels,
            {options.merl_cell, tolerance, source.covers}, path);
  return {path};
}

// The function for a table that keeps the azimuth of the sample. From light at one azimuth it would be extrapolated all
// round, unless the surface is isotropic.
BrdfFunction FunctionOfAllAzimuths(const WriteSource& source, const std::string& format) {
  if (source.measurement == nullptr || !HasOneAzimuth(source.measurement->samples)) return FunctionOf(source);
  if (!source.isotropic) {
    throw UsageError(
        "the light of this measurement has one azimuth, and " + format +
        " holds f_r at all of them: if the sample is isotropic, say so with --isotropic; else measure more "
        "azimuths, or write it as csv or alta");
  }
  return IsotropicFunction(*source.measurement, format);
}

Paths WriteRglFormat(const WriteSource& source, const WriteOptions& options, const Path& path) {
  RglWriteOptions rgl = options.rgl;
  rgl.isotropic = source.isotropic;
  if (source.measurement != nullptr) {
    rgl.description = "lobefit, from " + source.measurement->source;
    for (const std::string& comment : source.measurement->comments) rgl.description += "\n" + comment;
  }
  WriteRgl(FunctionOfAllAzimuths(source, "an RGL table"), source.channels, rgl, path);
  return {path};
}

Paths WriteExrFormat(const WriteSource& source, const WriteOptions& options, const Path& path) {
  const bool utia = options.exr.axes == ExrAxes::kUtia;
  const std::size_t size = utia ? 288 : options.exr_size;
  WriteExr(FunctionOf(source), source.channels, options.exr, size, size,
           source.measurement != nullptr ? source.measurement->source : "", path);
  return {path};
}

Paths WriteTensorTreeFormat(const WriteSource& source, const WriteOptions& options, const Path& path) {
  TensorTreeOptions tree;
  tree.isotropic = source.isotropic;
  tree.log2_resolution = options.tensor_tree_log2;
  WriteTensorTree(FunctionOfAllAzimuths(source, "a tensor tree"), source.channels, tree, path);
  return {path};
}

std::string Percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g %%", 100 * fraction);
  return text;
}

// What is known of the samples beside their values.
void AddWordsOfSamples(const Measurement& measurement, const std::string& format, Conversion* conversion) {
  const Samples& samples = measurement.samples;
  std::vector<std::string>& losses = conversion->losses;
  const bool csv = format == "csv", rows = csv || format == "alta";
  if (!samples.weight.empty() && (!rows || (!csv && !samples.sigma.empty())))
    losses.emplace_back("the weights of the samples are not written");
  if (!samples.sigma.empty() && (!rows || (csv && !samples.weight.empty())))
    losses.emplace_back("the standard deviations of the samples are not written");
  const bool comments = rows || format == "mountain" || format == "rgl";
  if (!measurement.comments.empty() && !comments)
    losses.push_back(std::to_string(measurement.comments.size()) + " comment lines of the file are not written");
  if (measurement.instrument != StatedInstrument{} && !csv)
    losses.emplace_back("what the file states of the instrument is not written");
  if (measurement.isotropic && (rows || format == "mountain"))
    losses.emplace_back("that the sample is isotropic is not written: the rows have one azimuth of the light");
  if (std::any_of(samples.sample_azimuth.begin(), samples.sample_azimuth.end(), [](double a) { return a != 0; }))
    losses.emplace_back("by how much the sample was turned is not written: directions are those of its frame");
  const std::string mark = "columns not used: ";
  for (const std::string& remark : measurement.remarks) {
    const std::size_t at = remark.find(mark);
    if (at != std::string::npos) losses.push_back("columns are not written: " + remark.substr(at + mark.size()));
  }
}

// What the target leaves out by its nature.
void AddWords(const WriteSource& source, const WriteFormat& format, const WriteOptions& options,
              Conversion* conversion) {
  const std::string name = format.name;
  if (format.is_grid) {
    conversion->losses.push_back(source.brdf ? "resampled to the grid of the format"
                                             : "samples interpolated to the grid of the format");
  }
  if (source.measurement != nullptr) AddWordsOfSamples(*source.measurement, name, conversion);
  if (source.measurement != nullptr && source.measurement->set_aside.total() > 0) {
    conversion->losses.push_back(std::to_string(source.measurement->set_aside.total()) +
                                 " samples that were set aside in reading are not written");
  }
  if ((name == "alta" || name == "mountain") && !source.channels.wavelengths_nm.empty()) {
    conversion->losses.emplace_back("the format has no place for wavelengths");
  }
  if (name == "exr") {
    conversion->losses.emplace_back(options.exr.axes == ExrAxes::kHemisphere ? "only one incident direction"
                                    : options.exr.axes == ExrAxes::kUtia
                                        ? "directions beyond 75 degrees are left out"
                                        : "only one phi_d, and no dependence on the azimuth of the sample");
  }
  if (name == "mountain" && source.channels.names == std::vector<std::string>{"R", "G", "B"}) {
    conversion->losses.emplace_back("R G B became CIE X Y Z (sRGB primaries)");
  }
  if (name == "tensor-tree" && source.channels.names == std::vector<std::string>{"R", "G", "B"}) {
    conversion->losses.emplace_back("R G B became CIE Y, u', v' of Radiance's primaries and white");
  }
}

}  // namespace

const std::vector<WriteFormat>& WriteFormats() {
  static const std::vector<WriteFormat> formats = {
      {"csv", "csv", "rows of directions and values", false, WriteCsvFormat},
      {"alta", "alta", "ALTA text", false, WriteAltaFormat},
      {"mountain", "txt", "pab-opto Mountain text, one file an incidence", false, WriteMountainFormat},
      {"merl", "binary", "MERL table, isotropic R G B only", true, WriteMerlFormat},
      {"rgl", "bsdf", "RGL/EPFL measured material of Mitsuba 3 and pbrt-v4", true, WriteRglFormat},
      {"exr", "exr", "OpenEXR slice or hemisphere", true, WriteExrFormat},
      {"tensor-tree", "xml", "BSDF-XML tensor tree of Radiance", true, WriteTensorTreeFormat},
  };
  return formats;
}

const WriteFormat& FindWriteFormat(const std::optional<std::string>& name, const std::filesystem::path& path) {
  std::vector<std::string> names;
  const std::string extension = ToLower(path.extension().string());
  for (const WriteFormat& format : WriteFormats()) {
    if (name ? *name == format.name : extension == std::string(".") + format.extension) return format;
    names.push_back(std::string(format.name) + " (." + format.extension + ")");
  }
  throw UsageError(name ? "the format '" + Excerpt(*name) + "' cannot be written; allowed are " + Join(names)
                        : path.string() +
                              ": the name does not say which format to write; choose one with --to: " + Join(names));
}

TabulatedFunction TabulatedBrdf(const std::filesystem::path& path, const Measurement& measurement) {
  if (measurement.format != "rgl") return {};
  const DecodedFile file(path);
  const auto brdf = std::make_shared<const RglBrdf>(path, file.bytes());
  return {[brdf](const Vec3& wi, const Vec3& wo, double* values) { brdf->Evaluate(wi, wo, values); },
          [brdf](const Vec3& wi, const Vec3& wo) { return brdf->Covers(wi, wo); }};
}

Conversion Convert(const WriteSource& source, const WriteFormat& format, const WriteOptions& options,
                   const std::filesystem::path& path) {
  Conversion conversion;
  WriteSource with_function = source;
  // Interpolated once, for writing and for comparing.
  if (format.is_grid && !source.brdf) with_function.brdf = Interpolate(*source.measurement);
  const bool has_mark = std::string_view(format.name) == "merl";
  if (format.is_grid && !has_mark) with_function.brdf = Continued(with_function.brdf, source.covers);
  conversion.files = format.write(with_function, options, path);
  AddWords(source, format, options, &conversion);
  // Opening a pipe again would wait for ever, or take what the program was given on standard input for the result.
  if (IsStream(path)) {
    conversion.not_compared = "what went into a pipe or device is not read back";
    return conversion;
  }

  ReadOptions read;
  read.merl_cell = options.merl_cell;
  std::vector<std::string> names;
  for (const std::filesystem::path& file : conversion.files) names.push_back(file.string());
  const Measurement back = ReadSeries(names, read);
  if (has_mark && back.set_aside[SetAsideReason::kHole] > 0) {
    conversion.losses.push_back(std::to_string(back.set_aside[SetAsideReason::kHole]) +
                                " cells above the horizon are marked as not measured: the file holds nothing there, "
                                "beyond its polar angles or beside nodes below the horizon");
  }
  const Measurement original = source.measurement != nullptr ? *source.measurement : Tabulated(source);
  if (back.format == "exr" && options.exr.axes != ExrAxes::kUtia) {
    // Only what the image holds can be compared.
    if (source.measurement != nullptr)
      conversion.losses.push_back(SamplesOfImage(source.measurement->samples, options.exr));
    conversion.difference = CompareWith(back, FunctionOf(with_function));
  } else {
    const BrdfFunction tabulated = names.size() == 1 ? TabulatedBrdf(conversion.files[0], back).brdf : nullptr;
    const WrittenDifference written = CompareWritten(original, back, format.is_grid, tabulated);
    conversion.difference = written.difference;
    conversion.not_compared = written.reason;
  }
  if (conversion.difference.compared == 0) {
    if (conversion.not_compared.empty())
      conversion.not_compared = "no value of the written file stands for one of the measurement";
    conversion.losses.push_back("how much cannot be said: " + conversion.not_compared);
  } else if (conversion.difference.maximum > 0) {
    conversion.losses.push_back("relative difference: median " + Percent(conversion.difference.median) +
                                ", 90 % of the samples within " + Percent(conversion.difference.percentile_90) +
                                ", at most " + Percent(conversion.difference.maximum));
  }
  return conversion;
}

}  // namespace lobefit
