#include "lobefit/export/targets/rgl/write.h"

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/brdf/lobe.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/spectra.h"
#include "lobefit/io/rgl/brdf.h"
#include "lobefit/io/rgl/writer.h"
#include "lobefit/measurement/spectrum.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostWavelengths = 32;

// The map of R G B to every third wavelength of the smooth spectrum, corrected so that the R G B of the result are
// those of the input.
ChannelMap ShortSpectrum(const Channels& rgb) {
  ChannelMap map = MakeChannelMap("spectrum", rgb);
  ChannelMap kept = {{}, {}, map.description};
  for (std::size_t k = 0; k < map.channels.size(); k += 3) {
    kept.channels.names.push_back(map.channels.names[k]);
    kept.channels.wavelengths_nm.push_back(map.channels.wavelengths_nm[k]);
    kept.matrix.push_back(map.matrix[k]);
  }
  const ChannelMap back = MakeChannelMap("rgb", kept.channels);
  Mat3 there = {};
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<double, 3> row = {};
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < kept.matrix.size(); ++k) row[j] += back.matrix[i][k] * kept.matrix[k][j];
    }
    there.row[i] = {row[0], row[1], row[2]};
  }
  // matrix <- matrix * there^-1, the inverse by cross products of rows.
  const Vec3 c0 = Cross(there.row[1], there.row[2]), c1 = Cross(there.row[2], there.row[0]),
             c2 = Cross(there.row[0], there.row[1]);
  const double determinant = Dot(there.row[0], c0);
  for (std::vector<double>& row : kept.matrix) {
    const Vec3 r = {row[0], row[1], row[2]};
    const Vec3 columns[3] = {c0, c1, c2};
    // (r * adjugate)_j: the inverse has the cross products as columns.
    const Vec3 product = {r.x * columns[0].x + r.y * columns[0].y + r.z * columns[0].z,
                          r.x * columns[1].x + r.y * columns[1].y + r.z * columns[1].z,
                          r.x * columns[2].x + r.y * columns[2].y + r.z * columns[2].z};
    row = {product.x / determinant, product.y / determinant, product.z / determinant};
  }
  return kept;
}

// Every k-th wavelength, so that at most kMostWavelengths are left.
ChannelMap FewerWavelengths(const Channels& channels) {
  const std::size_t step = (channels.size() + kMostWavelengths - 1) / kMostWavelengths;
  ChannelMap map;
  for (std::size_t k = 0; k < channels.size(); k += step) {
    map.channels.names.push_back(channels.names[k]);
    map.channels.wavelengths_nm.push_back(channels.wavelengths_nm[k]);
    map.matrix.emplace_back(channels.size(), 0.0);
    map.matrix.back()[k] = 1;
  }
  return map;
}

std::string Size(const std::filesystem::path& path) {
  return fmt::format("{:.1f} MB", static_cast<double>(std::filesystem::file_size(path)) / 1e6);
}

bool IsRglFile(std::string_view bytes) { return bytes.starts_with("tensor_file"); }

ImportedMaterial ReadRglFile(const InputFile& file) {
  const auto table = std::make_shared<const RglBrdf>(file.path, file.bytes);
  return {"rgl",
          table->channels(),
          [table](const Vec3& wi, const Vec3& wo, double* values) { table->Evaluate(wi, wo, values); },
          {}};
}

ImportedMaterial ReadFile(const std::filesystem::path& path) {
  const FileBytes file(path);
  return ReadRglFile({path, file.bytes()});
}

std::vector<Carried> CarriesRgl(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesTable(fit);
  if (fit.material().channels.size() > kMostWavelengths) {
    Mark(&rows, Feature::kChannels, Carries::kApproximately,
         "every k-th wavelength, linear between; R G B in the other file");
  } else if (fit.IsRgbOrGrey() && fit.material().channels.size() == 3) {
    Mark(&rows, Feature::kChannels, Carries::kApproximately,
         "exact in the rgb file; a smooth spectrum of the same R G B in the other");
  } else {
    Mark(&rows, Feature::kChannels, Carries::kExactly, "");
  }
  return rows;
}

std::string RefuseRgl(const FittedBrdf& fit) {
  if (fit.IsRgbOrGrey()) return "";
  try {
    MakeChannelMap("rgb", fit.channels());
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

}  // namespace

WrittenFiles WriteRglTarget(const FittedBrdf& fit, const WriteContext& context) {
  RglWriteOptions options;
  options.isotropic = fit.IsIsotropic();
  options.description = Join(context.header, "\n");
  const BrdfFunction brdf = fit.function();
  const Channels channels = fit.channels();
  std::vector<std::shared_ptr<const NormalDistribution>> distributions;
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    distributions.push_back(DistributionOf(fit.lobes()[l].choices, fit.reflectance().shapes()[l], nullptr));
  }
  if (!distributions.empty()) {
    options.normal_distribution = [distributions](const Vec3& wm) {
      double sum = 0;
      for (const auto& distribution : distributions) sum += distribution->D(wm);
      return sum;
    };
  }

  const std::filesystem::path rgb_path = context.File("_rgb.bsdf"), spectral_path = context.File("_spec.bsdf");
  const bool spectral = !channels.wavelengths_nm.empty();
  const bool grey = fit.IsRgbOrGrey() && channels.size() == 1;
  const ChannelMap to_rgb = grey ? ChannelMap{} : MakeChannelMap("rgb", channels);
  options.kind = RglKind::kRgb;
  WriteRgl(grey ? brdf : Apply(to_rgb, brdf, channels.size()), grey ? channels : to_rgb.channels, options, rgb_path);
  ChannelMap to_spectrum;
  if (spectral) to_spectrum = FewerWavelengths(channels);
  if (!spectral && !grey) {
    // R G B from X Y Z first, where the fit has those.
    to_spectrum = ShortSpectrum(to_rgb.channels);
  }
  options.kind = RglKind::kSpectral;
  const BrdfFunction rgb = grey ? brdf : Apply(to_rgb, brdf, channels.size());
  if (grey) {
    WriteRgl(brdf, channels, options, spectral_path);
  } else {
    WriteRgl(spectral ? Apply(to_spectrum, brdf, channels.size()) : Apply(to_spectrum, rgb, 3), to_spectrum.channels,
             options, spectral_path);
  }

  WrittenFiles written = {{rgb_path, spectral_path}, nullptr, false, {}};
  written.notes.push_back(fmt::format(
      "{} for Mitsuba's rgb variants ({}), {} for pbrt-v4 and Mitsuba's spectral variants ({})",
      rgb_path.filename().string(), Size(rgb_path), spectral_path.filename().string(), Size(spectral_path)));
  if (spectral) {
    const BrdfFunction table = ReadFile(spectral_path).brdf;
    written.brdf = AtWavelengths(table, to_spectrum.channels.wavelengths_nm, channels.wavelengths_nm);
  } else {
    written.brdf = InChannelsOf(fit, ReadFile(rgb_path).brdf);
  }
  return written;
}

Target RglTarget() {
  return {.name = "rgl",
          .description = "RGL/EPFL tables for Mitsuba 3 and pbrt-v4, tilt and rotation kept",
          .load =
              "Mitsuba: <bsdf type=\"measured\"><string name=\"filename\" value=\"{name}_rgb.bsdf\"/></bsdf>; "
              "pbrt-v4: Material \"measured\" \"string filename\" \"{name}_spec.bsdf\"",
          .refusal = RefuseRgl,
          .carries = CarriesRgl,
          .write = WriteRglTarget,
          .recognises = IsRglFile,
          .read = ReadRglFile};
}

}  // namespace lobefit
