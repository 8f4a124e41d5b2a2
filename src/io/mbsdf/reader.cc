// MDL .mbsdf: "NVIDIA ARC MBSDF V1", lines of metadata, a marker line, then uint32 type (0 scalar, 1 RGB), polar and
// azimuthal resolution and float32 values, little-endian, index channels * ((theta_i * n_theta + theta_o) * n_phi +
// phi). Polar cells are uniform over [0, pi/2), azimuth differences over [0, pi]; a value is f_r at the centre of its
// cell. Isotropic by construction. Negative values are noise of the measurement, not marks, and are kept.
#include "lobefit/io/mbsdf/reader.h"

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

constexpr std::string_view kMagic = "NVIDIA ARC MBSDF V";
constexpr std::size_t kBlockHeaderBytes = 12;

struct Block {
  std::size_t channels = 0, thetas = 0, phis = 0;
  std::string_view data;
};

std::uint32_t LoadU32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = (value << 8) | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

double LoadF32(std::string_view bytes, std::size_t at) {
  const std::uint32_t bits = LoadU32(bytes, at);
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

// The line that begins at *at, without its end; moves *at behind it. Fails where the file has no more line ends.
std::string_view TakeLine(const InputFile& file, std::size_t* at, const std::string& what) {
  const std::size_t end = file.bytes.find('\n', *at);
  if (end == std::string_view::npos) {
    FailAtByte(file, *at, what + " should stand here, ended by a newline; the file is cut off or not an MBSDF file");
  }
  const std::string_view line = file.bytes.substr(*at, end - *at);
  *at = end + 1;
  return line;
}

Block ReadBlock(const InputFile& file, std::size_t* at) {
  if (file.bytes.size() - *at < kBlockHeaderBytes) {
    FailAtByte(file, *at,
               "the 12 bytes type, polar and azimuthal resolution are cut off: the file ends at byte " +
                   std::to_string(file.bytes.size()) + "; fetch the file again");
  }
  const std::uint32_t type = LoadU32(file.bytes, *at);
  if (type > 1) {
    FailAtByte(file, *at, "the type of the values is " + std::to_string(type) + "; allowed are 0 (scalar) and 1 (RGB)");
  }
  Block block;
  block.channels = type == 0 ? 1 : 3;
  block.thetas = LoadU32(file.bytes, *at + 4);
  block.phis = LoadU32(file.bytes, *at + 8);
  if (block.thetas == 0 || block.phis == 0) {
    FailAtByte(file, *at + 4,
               "the resolution is " + std::to_string(block.thetas) + " polar x " + std::to_string(block.phis) +
                   " azimuthal cells; both must be at least 1");
  }
  *at += kBlockHeaderBytes;
  const std::optional<std::size_t> bytes =
      CheckedProduct({block.thetas, block.thetas, block.phis, block.channels, sizeof(float)});
  if (!bytes || *bytes > file.bytes.size() - *at) {
    FailAtByte(file, *at,
               std::to_string(block.thetas) + " x " + std::to_string(block.thetas) + " x " +
                   std::to_string(block.phis) + " cells x " + std::to_string(block.channels) +
                   " channels should follow, but the file has only " + std::to_string(file.bytes.size() - *at) +
                   " more bytes; fetch the file again");
  }
  block.data = file.bytes.substr(*at, *bytes);
  *at += *bytes;
  return block;
}

// Measure of the direction pairs of a cell: d(cos theta_i) d(cos theta_o), up to the azimuths, which are uniform.
double CellMeasure(std::size_t thetas, std::size_t i, std::size_t o) {
  const double step = kPi / 2 / static_cast<double>(thetas);
  const auto ring = [&](std::size_t k) {
    return std::cos(step * static_cast<double>(k)) - std::cos(step * static_cast<double>(k + 1));
  };
  return ring(i) * ring(o);
}

Measurement TakeCells(const Block& block) {
  MeasurementBuilder builder(
      {block.channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"}, {}});
  std::vector<double>& solid_angle = builder.measurement().samples.solid_angle;
  const double theta_step = kPi / 2 / static_cast<double>(block.thetas),
               phi_step = kPi / static_cast<double>(block.phis);
  std::size_t cell = 0;
  for (std::size_t i = 0; i < block.thetas; ++i) {
    const Vec3 wi = FromSpherical((static_cast<double>(i) + 0.5) * theta_step, 0);
    for (std::size_t o = 0; o < block.thetas; ++o) {
      const double measure = CellMeasure(block.thetas, i, o);
      for (std::size_t p = 0; p < block.phis; ++p, ++cell) {
        const Vec3 wo =
            FromSpherical((static_cast<double>(o) + 0.5) * theta_step, (static_cast<double>(p) + 0.5) * phi_step);
        std::array<double, 3> values = {};
        for (std::size_t c = 0; c < block.channels; ++c) {
          values[c] = LoadF32(block.data, sizeof(float) * (cell * block.channels + c));
        }
        if (builder.Add(wi, wo, values.data(), static_cast<std::uint32_t>(cell))) solid_angle.push_back(measure);
      }
    }
  }
  // The cells are different pairs by construction, so none repeats; Finish would only cost time on them.
  ScaleToMeanOne(&solid_angle);
  return std::move(builder.measurement());
}

}  // namespace

bool IsMbsdf(std::string_view bytes) { return bytes.substr(0, kMagic.size()) == kMagic; }

Measurement ReadMbsdf(const InputFile& file, const ReadOptions&) {
  std::size_t at = 0;
  const std::string_view version = TakeLine(file, &at, "the line 'NVIDIA ARC MBSDF V1'");
  if (version != "NVIDIA ARC MBSDF V1") {
    FailAtByte(file, 0, "the version line is '" + Excerpt(version) + "'; allowed is 'NVIDIA ARC MBSDF V1'");
  }
  std::optional<Block> reflection;
  bool transmission = false;
  while (at < file.bytes.size()) {
    const std::size_t line_at = at;
    const std::string_view line = TakeLine(file, &at, "a line of metadata or a marker MBSDF_DATA=");
    const bool is_reflection = line == "MBSDF_DATA=" || line == "MBSDF_DATA_REFLECTION=";
    if (!is_reflection && line != "MBSDF_DATA_TRANSMISSION=") {
      if (reflection || transmission) {
        FailAtByte(file, line_at,
                   "'" + Excerpt(line) +
                       "' stands after a block of data; allowed are another marker "
                       "MBSDF_DATA_... or the end of the file");
      }
      continue;
    }
    const Block block = ReadBlock(file, &at);
    if (is_reflection && reflection)
      FailAtByte(file, line_at, "a second block of reflection begins; only one is allowed");
    if (is_reflection) {
      reflection = block;
    } else {
      transmission = true;
    }
  }
  if (!reflection) {
    FailAtByte(file, at,
               transmission ? "the file ends and holds transmission only; only reflection can be fitted"
                            : "the file ends without a marker 'MBSDF_DATA=' or 'MBSDF_DATA_REFLECTION='; it "
                              "is cut off");
  }
  Measurement measurement = TakeCells(*reflection);
  measurement.isotropic = true;
  measurement.conventions["value-kind"] = "f (format)";
  measurement.conventions["incident"] = "towards (format)";
  if (transmission) measurement.remarks.push_back("the block of transmission was not read");
  return measurement;
}

}  // namespace lobefit
