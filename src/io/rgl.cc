// RGL/EPFL `.bsdf`: a BRDF tabulated on nodes that a density of visible normals has warped [Dupuy and Jakob 2018]. The
// table's direction is the viewer in both renderers that read these files, and the value contains the cosine of the
// other direction, the light:
//   value(t, s) = f_r cos(theta_s) = table(p | t) ndf(u_m) / (4 sigma(u_t)),   p = warp^-1(u_m | t), m = half vector of
//   t and s.
// Each node of the table is one sample: p -> m by the warp -> s = 2 (m.t) m - t.
#include <cmath>
#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/base/text.h"
#include "lobefit/io/formats.h"
#include "lobefit/io/rgl_angles.h"
#include "lobefit/io/tensor_file.h"
#include "lobefit/io/warp.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

struct Grid {
  std::vector<float> values;
  std::vector<std::size_t> shape;

  std::size_t width() const { return shape.back(); }
  std::size_t height() const { return shape[shape.size() - 2]; }
};

struct RglTables {
  std::vector<float> phi, theta, wavelengths;
  Grid ndf, sigma, vndf, spectra;
  bool spectral = false;
  bool jacobian = true;
  // One a node of the luminance table, or empty.
  std::vector<std::uint8_t> valid;
};

[[noreturn]] void Fail(const TensorFile& file, const std::string& what) {
  throw InputError(file.path().string() + ": " + what);
}

enum class Holes { kForbidden, kAllowed };

Grid GetGrid(const TensorFile& file, const std::string& name, std::size_t ndim, Holes holes = Holes::kForbidden) {
  Grid grid;
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

void CheckLeading(const TensorFile& file, const std::string& name, const Grid& grid, const RglTables& tables) {
  if (grid.shape[0] != tables.phi.size() || grid.shape[1] != tables.theta.size()) {
    Fail(file, "field '" + name + "' is for " + std::to_string(grid.shape[0]) + " x " + std::to_string(grid.shape[1]) +
                   " directions, but phi_i and theta_i have " + std::to_string(tables.phi.size()) + " and " +
                   std::to_string(tables.theta.size()) + " entries");
  }
}

void CheckDensity(const TensorFile& file, const std::string& name, const Grid& grid) {
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

RglTables ReadTables(const TensorFile& file) {
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

Channels ChannelsOf(const RglTables& tables) {
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

// Solid angle of the table directions that lie nearer to theta[i] than to its neighbours, without the azimuth.
double IncidenceMeasure(const std::vector<float>& theta, std::size_t i) {
  if (theta.size() == 1) return 1;
  const auto at = [&](std::size_t k) { return static_cast<double>(theta[k]); };
  const double low = i == 0 ? at(0) : 0.5 * (at(i - 1) + at(i));
  const double high = i + 1 == theta.size() ? at(i) : 0.5 * (at(i) + at(i + 1));
  return std::cos(low) - std::cos(high);
}

// Directions nearer to the horizon than this (0.06 degrees) have no f_r: it is the table's value over a cosine that the
// table's float32 angles do not determine (many files end with theta_i = float(pi / 2)).
constexpr double kHorizon = 1e-3;

// One slice of the table: the nodes of one viewer's direction.
class Slice {
 public:
  Slice(const RglTables& tables, bool isotropic, std::size_t index)
      : tables_(tables),
        index_(index),
        theta_(static_cast<double>(tables.theta[index % tables.theta.size()])),
        phi_(static_cast<double>(tables.phi[index / tables.theta.size()])),
        turn_(isotropic ? phi_ : 0.0),
        viewer_(FromSpherical(theta_, phi_)),
        warp_(&tables.vndf.values[index * tables.vndf.width() * tables.vndf.height()], tables.vndf.width(),
              tables.vndf.height()) {}

  struct Node {
    Vec2 u;  // the micro normal on the unit square
    double theta_m, cos_m;
    double pdf;  // density of the warp at u
    Vec3 light;
    bool above;  // both directions above the horizon
  };

  std::size_t nodes() const { return tables_.spectra.width() * tables_.spectra.height(); }

  Node At(std::size_t node) const {
    const std::size_t width = tables_.spectra.width(), height = tables_.spectra.height();
    const Vec2 point = {static_cast<double>(node % width) / static_cast<double>(width - 1),
                        static_cast<double>(node / width) / static_cast<double>(height - 1)};
    Node result = {};
    result.u = warp_.Sample(point, &result.pdf);
    result.theta_m = RglTheta(result.u.x);
    const Vec3 normal = FromSpherical(result.theta_m, RglPhi(result.u.y) + turn_);
    result.cos_m = Dot(normal, viewer_);
    result.light = Reflect(viewer_, normal);
    result.above = result.cos_m > 0 && result.light.z > kHorizon && viewer_.z > kHorizon;
    return result;
  }

  // Hands the usable nodes to the builder. `valid_bit` is the bit of the mask that means a reliable node.
  void Read(std::uint8_t valid_bit, MeasurementBuilder* builder) const {
    const double sigma = Bilinear(tables_.sigma.values.data(), tables_.sigma.width(), tables_.sigma.height(),
                                  {RglX(theta_), RglY(phi_)});
    const double cell = IncidenceMeasure(tables_.theta, index_ % tables_.theta.size());
    std::vector<double> values(tables_.spectra.shape[2]);
    for (std::size_t i = 0; i < nodes(); ++i) {
      const Node node = At(i);
      const std::size_t index = index_ * nodes() + i;
      if (!node.above) {
        builder->Skip(SetAsideReason::kBelowHorizon);
        continue;
      }
      if (!tables_.valid.empty() && tables_.valid[index] != valid_bit) {
        builder->Skip(SetAsideReason::kFlagged);
        continue;
      }
      double factor = 1 / node.light.z;
      if (tables_.jacobian) {
        factor *= Bilinear(tables_.ndf.values.data(), tables_.ndf.width(), tables_.ndf.height(), node.u) / (4 * sigma);
      }
      const float* value = &tables_.spectra.values[index_ * values.size() * nodes() + i];
      for (std::size_t c = 0; c < values.size(); ++c) values[c] = factor * static_cast<double>(value[c * nodes()]);
      if (!builder->Add(node.light, viewer_, values.data(), static_cast<std::uint32_t>(index))) continue;
      const double measure = node.pdf > 0 ? RglNormalJacobian(node.u.x, node.theta_m) * 4 * node.cos_m / node.pdf : 0.0;
      builder->measurement().samples.solid_angle.push_back(cell * measure);
    }
  }

 private:
  const RglTables& tables_;
  std::size_t index_;
  double theta_, phi_, turn_;
  Vec3 viewer_;
  BilinearWarp warp_;
};

// Files of the database disagree on whether a set bit of `valid` marks a reliable or an unreliable node. Nodes whose
// light is below the horizon were never measured, so the bit that most of them carry is the one that means unreliable.
std::uint8_t ValidBit(const RglTables& tables, bool isotropic) {
  std::size_t below = 0, below_and_set = 0;
  for (std::size_t slice = 0; slice < tables.phi.size() * tables.theta.size(); ++slice) {
    const Slice reader(tables, isotropic, slice);
    for (std::size_t i = 0; i < reader.nodes(); ++i) {
      if (reader.At(i).light.z > 0) continue;
      ++below;
      below_and_set += tables.valid[slice * reader.nodes() + i];
    }
  }
  return 2 * below_and_set > below ? 0 : 1;
}

void NormalizeToMeanOne(std::vector<double>* measure) {
  double sum = 0;
  for (const double value : *measure) sum += value;
  if (!(sum > 0)) {
    measure->clear();
    return;
  }
  for (double& value : *measure) value *= static_cast<double>(measure->size()) / sum;
}

}  // namespace

bool IsRgl(std::string_view bytes) { return TensorFile::HasMagic(bytes); }

Measurement ReadRgl(const InputFile& file, const ReadOptions&) {
  const TensorFile tensors(file.path, file.bytes);
  const RglTables tables = ReadTables(tensors);
  const bool isotropic = tables.phi.size() <= 2;
  // Part of the circle that is stored: 1 all of it; 2 half of it, for a surface that a half turn leaves unchanged; 4 a
  // quarter of it, for one with two mirror planes.
  const double span = static_cast<double>(tables.phi.back()) - static_cast<double>(tables.phi.front());
  const int reduction = isotropic ? 1 : static_cast<int>(std::lround(std::min(2 * kPi / span, 100.0)));
  if (reduction != 1 && reduction != 2 && reduction != 4) {
    Fail(tensors, "field 'phi_i' covers " + FormatDouble(RadiansToDegrees(span)) +
                      " degrees; a full circle, a half or a quarter of it is allowed");
  }

  MeasurementBuilder builder(ChannelsOf(tables));
  const std::uint8_t valid_bit = tables.valid.empty() ? 1 : ValidBit(tables, isotropic);
  for (std::size_t slice = 0; slice < tables.phi.size() * tables.theta.size(); ++slice) {
    Slice(tables, isotropic, slice).Read(valid_bit, &builder);
  }
  Measurement measurement = builder.Finish();
  NormalizeToMeanOne(&measurement.samples.solid_angle);
  measurement.isotropic = isotropic;
  measurement.conventions["rgl-table-direction"] = "viewer";
  if (!tables.valid.empty()) {
    measurement.conventions["rgl-valid"] =
        valid_bit == 1 ? "set bits are reliable (recognised)" : "set bits are unreliable (recognised)";
  }
  if (reduction > 1) {
    measurement.conventions["rgl-reduction"] = std::to_string(reduction);
    measurement.remarks.push_back(
        reduction == 2
            ? "the file stores viewers in half a circle; the other half follows by a half turn of the surface and is "
              "not repeated"
            : "the file stores viewers in a quarter circle; the rest follows by two mirror planes and is not repeated");
  }
  return measurement;
}

}  // namespace lobefit
