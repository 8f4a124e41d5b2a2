// RGL/EPFL `.bsdf`: a BRDF tabulated on nodes that a density of visible normals has warped [Dupuy and Jakob 2018]. The
// table's direction is the viewer in both renderers that read these files, and the value contains the cosine of the
// other direction, the light:
//   value(t, s) = f_r cos(theta_s) = table(p | t) ndf(u_m) / (4 sigma(u_t)),   p = warp^-1(u_m | t), m = half vector of
//   t and s.
// Each node of the table is one sample: p -> m by the warp -> s = 2 (m.t) m - t.
#include "lobefit/io/rgl/reader.h"

#include <algorithm>
#include <cmath>

#include "lobefit/io/rgl/angles.h"
#include "lobefit/io/rgl/azimuth_spread.h"
#include "lobefit/io/rgl/tables.h"
#include "lobefit/io/rgl/warp.h"
#include "lobefit/io/text/place.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// Solid angle of the table directions that lie nearer to theta[i] than to its neighbours, without the azimuth.
double IncidenceMeasure(const std::vector<float>& theta, std::size_t i) {
  if (theta.size() == 1) return 1;
  const auto at = [&](std::size_t k) { return static_cast<double>(theta[k]); };
  const double low = i == 0 ? at(0) : 0.5 * (at(i - 1) + at(i));
  const double high = i + 1 == theta.size() ? at(i) : 0.5 * (at(i) + at(i + 1));
  return std::max(std::cos(low) - std::cos(high), 1e-12);  // angles that float32 hardly tells apart
}

// Micro normals nearer to the surface's than this are it: a column of the table at u.x = 0.
constexpr double kAtNormal = 1e-9;

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

  Node At(std::size_t node) const { return At(PointOf(node)); }

  Node At(const Vec2& point) const {
    Node result = {};
    result.u = warp_.Sample(point, &result.pdf);
    result.theta_m = RglTheta(result.u.x);
    const Vec3 normal = FromSpherical(result.theta_m, RglPhi(result.u.y) + turn_);
    result.cos_m = Dot(normal, viewer_);
    result.light = Reflect(viewer_, normal);
    result.above = result.cos_m > 0 && result.light.z > kRglHorizon && viewer_.z > kRglHorizon;
    return result;
  }

  // Solid angle of the lights nearer to this node than to others, up to a factor; the cells of the first and last
  // column are half as wide and are measured at their middle, since at theta_m = 0 itself there is none.
  double SolidAngle(std::size_t node, const Node& at) const {
    const std::size_t width = tables_.spectra.width(), column = node % width;
    const bool first = column == 0, last = column + 1 == width;
    if (!first && !last) return Measure(at);
    const double inwards = 0.25 / static_cast<double>(width - 1);
    const Vec2 point = PointOf(node);
    return 0.5 * Measure(At(Vec2{point.x + (first ? inwards : -inwards), point.y}));
  }

  // Hands the usable nodes to the builder. `valid_bit` is the bit of the mask that means a reliable node. Nodes whose
  // half vector is the normal are one pair of directions, whatever their azimuth: their mean is one sample.
  void Read(std::uint8_t valid_bit, MeasurementBuilder* builder, std::size_t* at_normal) const {
    const double sigma = Bilinear(tables_.sigma.values.data(), tables_.sigma.width(), tables_.sigma.height(),
                                  {RglX(theta_), RglY(phi_)});
    const double cell = IncidenceMeasure(tables_.theta, index_ % tables_.theta.size());
    const std::size_t channels = tables_.spectra.shape[2];
    std::vector<double> values(channels), mean(channels, 0.0);
    std::size_t first = 0, count = 0;
    double measure = 0;
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
      Evaluate(i, node, sigma, &values);
      if (node.theta_m < kAtNormal) {
        if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) {
          builder->Skip(SetAsideReason::kNotFinite);
          continue;
        }
        if (count == 0) first = i;
        for (std::size_t c = 0; c < channels; ++c) mean[c] += values[c];
        measure += SolidAngle(i, node);
        ++count;
        continue;
      }
      if (!builder->Add(node.light, viewer_, values.data(), static_cast<std::uint32_t>(index))) continue;
      builder->measurement().samples.solid_angle.push_back(cell * SolidAngle(i, node));
    }
    if (count == 0) return;
    for (double& value : mean) value /= static_cast<double>(count);
    *at_normal += count - 1;
    for (std::size_t k = 1; k < count; ++k) builder->Skip(SetAsideReason::kDuplicate);
    const Node node = At(first);
    if (!builder->Add(node.light, viewer_, mean.data(), static_cast<std::uint32_t>(index_ * nodes() + first))) return;
    builder->measurement().samples.solid_angle.push_back(cell * measure);
  }

 private:
  void Evaluate(std::size_t i, const Node& node, double sigma, std::vector<double>* values) const {
    double factor = 1 / node.light.z;
    if (tables_.jacobian) {
      factor *= Bilinear(tables_.ndf.values.data(), tables_.ndf.width(), tables_.ndf.height(), node.u) / (4 * sigma);
    }
    const float* value = &tables_.spectra.values[index_ * values->size() * nodes() + i];
    for (std::size_t c = 0; c < values->size(); ++c) (*values)[c] = factor * static_cast<double>(value[c * nodes()]);
  }

  Vec2 PointOf(std::size_t node) const {
    const std::size_t width = tables_.spectra.width(), height = tables_.spectra.height();
    return {static_cast<double>(node % width) / static_cast<double>(width - 1),
            static_cast<double>(node / width) / static_cast<double>(height - 1)};
  }

  // d(light) = 4 (m.t) d(m), d(m) = Jacobian du, du = dp / pdf. Positive and finite whatever the file holds.
  static double Measure(const Node& node) {
    const double measure = RglNormalJacobian(node.u.x, node.theta_m) * 4 * std::max(0.0, node.cos_m) / node.pdf;
    return measure > kLeastMeasure && measure < 1 / kLeastMeasure ? measure : kLeastMeasure;
  }
  static constexpr double kLeastMeasure = 1e-12;

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

}  // namespace

bool IsRgl(std::string_view bytes) { return TensorFile::HasMagic(bytes); }

Measurement ReadRgl(const InputFile& file, const ReadOptions&) {
  const TensorFile tensors(file.path, file.bytes);
  const RglTables tables = ReadRglTables(tensors);
  const bool isotropic = tables.isotropic();
  const int reduction = RglReduction(tensors, tables);

  MeasurementBuilder builder(RglChannels(tables));
  const std::uint8_t valid_bit = tables.valid.empty() ? 1 : ValidBit(tables, isotropic);
  std::size_t at_normal = 0;
  for (std::size_t slice = 0; slice < tables.phi.size() * tables.theta.size(); ++slice) {
    Slice(tables, isotropic, slice).Read(valid_bit, &builder, &at_normal);
  }
  Measurement measurement = builder.Finish();
  if (measurement.samples.size() > 0) ScaleToMeanOne(&measurement.samples.solid_angle);
  measurement.isotropic = measurement.sample_at_rest = isotropic;
  measurement.conventions["rgl-table-direction"] = "viewer";
  measurement.listed_side = Beam::kViewer;
  if (!tables.valid.empty()) {
    measurement.conventions["rgl-valid"] =
        valid_bit == 1 ? "set bits are reliable (recognised)" : "set bits are unreliable (recognised)";
  }
  if (at_normal > 0) {
    measurement.remarks.push_back(
        "where the half vector is the normal, the rows of a slice are one pair of directions: "
        "their mean is taken (" +
        std::to_string(at_normal) + " more values)");
  }
  if (isotropic) {
    const AzimuthSpread spread = SpreadAtNormal(RglBrdf(file.path, file.bytes));
    if (spread.ratio > kAnisotropicSpread) {
      measurement.remarks.push_back(
          "isotropic by its format, but under a viewer at the normal f_r varies with the "
          "azimuth of the light, by a factor of " +
          FormatDouble(std::round(100 * spread.ratio) / 100) + " (most about azimuth " +
          FormatDouble(std::round(RadiansToDegrees(spread.largest))) +
          " degrees): the sample is anisotropic, and is fitted as such");
    }
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
