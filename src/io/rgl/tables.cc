#include "lobefit/io/rgl/tables.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

[[noreturn]] void Fail(const TensorFile& file, const std::string& what) {
  throw InputError(file.path().string() + ": " + what);
}

enum class Holes { kForbidden, kAllowed };

RglGrid GetGrid(const TensorFile& file, const std::string& name, std::size_t ndim, Holes holes = Holes::kForbidden) {
  RglGrid grid;
  const TensorField& field = file.Get(name, TensorType::kFloat32, ndim);
  grid.shape.assign(field.shape.begin(), field.shape.end());
  if (grid.width() < 2 || grid.height() < 2) {
    Fail(file, "field '" + name + "' has shape " + field.ShapeText() + "; its last two extents must be at least 2");
  }
  grid.values = holes == Holes::kAllowed ? file.GetFloats(name, ndim) : file.GetFiniteFloats(name, ndim);
  return grid;
}

std::vector<float> GetAngles(const TensorFile& file, const std::string& name, double limit) {
  std::vector<float> angles = file.GetFiniteFloats(name, 1);
  if (angles.empty()) Fail(file, "field '" + name + "' is empty; it must list angles in radians");
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double angle = static_cast<double>(angles[i]);
    if ((i > 0 && angles[i] <= angles[i - 1]) || std::fabs(angle) > limit) {
      Fail(file, "field '" + name + "': element " + std::to_string(i) + " is " + FormatDouble(angle) +
                     "; the angles must increase and be in radians");
    }
  }
  return angles;
}

void CheckLeading(const TensorFile& file, const std::string& name, const RglGrid& grid, const RglTables& tables) {
  if (grid.shape[0] != tables.phi.size() || grid.shape[1] != tables.theta.size()) {
    Fail(file, "field '" + name + "' is for " + std::to_string(grid.shape[0]) + " x " + std::to_string(grid.shape[1]) +
                   " directions, but phi_i and theta_i have " + std::to_string(tables.phi.size()) + " and " +
                   std::to_string(tables.theta.size()) + " entries");
  }
}

void CheckDensity(const TensorFile& file, const std::string& name, const RglGrid& grid) {
  const std::size_t slice = grid.width() * grid.height();
  for (std::size_t begin = 0; begin < grid.values.size(); begin += slice) {
    double sum = 0;
    for (std::size_t i = begin; i < begin + slice; ++i) {
      if (grid.values[i] < 0) {
        Fail(file, "field '" + name + "': element " + std::to_string(i) + " is " +
                       FormatDouble(static_cast<double>(grid.values[i])) + "; a density must not be negative");
      }
      sum += static_cast<double>(grid.values[i]);
    }
    if (!(sum > 0)) {
      Fail(file, "field '" + name + "': slice " + std::to_string(begin / slice) +
                     " is zero everywhere; each direction needs a density");
    }
  }
}

// The mask of reliable nodes: one bit a node of the luminance table, most significant bit first.
std::vector<std::uint8_t> GetValid(const TensorFile& file, const RglTables& tables) {
  if (!file.Has("valid")) return {};
  const std::size_t nodes = tables.phi.size() * tables.theta.size() * tables.spectra.width() * tables.spectra.height();
  const TensorField& field = file.Get("valid", TensorType::kUint8, 1);
  if (field.count != (nodes + 7) / 8) {
    Fail(file, "field 'valid' has " + std::to_string(field.count) + " bytes; one bit for each of the " +
                   std::to_string(nodes) + " nodes takes " + std::to_string((nodes + 7) / 8));
  }
  std::vector<std::uint8_t> valid(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    valid[i] = (static_cast<unsigned char>(field.bytes[i / 8]) >> (7 - i % 8)) & 1;
  }
  return valid;
}

}  // namespace

RglTables ReadRglTables(const TensorFile& file) {
  RglTables tables;
  tables.phi = GetAngles(file, "phi_i", 4 * kPi);
  tables.theta = GetAngles(file, "theta_i", kPi / 2 + 1e-3);
  if (tables.theta[0] < 0) Fail(file, "field 'theta_i' begins with a negative angle; it must be in [0, pi/2]");
  tables.ndf = GetGrid(file, "ndf", 2);
  tables.sigma = GetGrid(file, "sigma", 2);
  tables.vndf = GetGrid(file, "vndf", 4);
  CheckLeading(file, "vndf", tables.vndf, tables);
  CheckDensity(file, "vndf", tables.vndf);
  tables.spectral = !file.Has("rgb");
  const std::string name = tables.spectral ? "spectra" : "rgb";
  tables.spectra = GetGrid(file, name, 5, Holes::kAllowed);
  CheckLeading(file, name, tables.spectra, tables);
  const std::size_t channels = tables.spectra.shape[2];
  if (tables.spectral) {
    tables.wavelengths = file.GetFiniteFloats("wavelengths", 1);
    if (tables.wavelengths.size() != channels) {
      Fail(file, "field 'spectra' has " + std::to_string(channels) + " channels, but 'wavelengths' has " +
                     std::to_string(tables.wavelengths.size()) + " entries");
    }
  } else if (channels != 3) {
    Fail(file, "field 'rgb' has " + std::to_string(channels) + " channels; it must have 3");
  }
  if (channels == 0) Fail(file, "field 'spectra' has no channel");
  const TensorField& jacobian = file.Get("jacobian", TensorType::kUint8, 1);
  tables.jacobian = jacobian.count == 0 || jacobian.bytes[0] != 0;
  tables.valid = GetValid(file, tables);
  return tables;
}

Channels RglChannels(const RglTables& tables) {
  Channels channels;
  if (!tables.spectral) {
    channels.names = {"R", "G", "B"};
    return channels;
  }
  for (const float wavelength : tables.wavelengths) {
    // Files hold nanometres as float32; a tenth of a picometre is below any spectrometer.
    const double nm = std::round(static_cast<double>(wavelength) * 1e4) / 1e4;
    channels.wavelengths_nm.push_back(nm);
    channels.names.push_back(FormatDouble(nm) + "nm");
  }
  return channels;
}

int RglReduction(const TensorFile& file, const RglTables& tables) {
  if (tables.isotropic()) return 1;
  const double span = static_cast<double>(tables.phi.back()) - static_cast<double>(tables.phi.front());
  const int reduction = static_cast<int>(std::lround(std::min(2 * kPi / span, 100.0)));
  if (reduction != 1 && reduction != 2 && reduction != 4) {
    Fail(file, "field 'phi_i' covers " + FormatDouble(RadiansToDegrees(span)) +
                   " degrees; a full circle, a half or a quarter of it is allowed");
  }
  return reduction;
}

}  // namespace lobefit
