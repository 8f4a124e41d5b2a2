#include "lobefit/synthesis/instrument.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "lobefit/math/directions.h"
#include "lobefit/math/quadrature.h"

namespace lobefit {
namespace {

// Rules for discs of 1, 2, 4, 8 and 16 lobe widths.
constexpr std::size_t kLevels = 5;
// The finest at which both discs are swept independently.
constexpr std::size_t kFinestOfBoth = 1;
constexpr std::size_t kLevelsOfBoth = 4;

// Directions over a disc: the multiples of w, e3 x w and e3 (SetDiscMultiples), and the share of the disc.
struct DiscDirection {
  double by[3], weight;
};

std::vector<DiscDirection> DiscDirections(double tau, const std::vector<DiscPoint>& points) {
  std::vector<DiscDirection> all;
  for (const DiscPoint& point : points) {
    DiscDirection& d = all.emplace_back();
    SetDiscMultiples(point, std::sqrt(2 * tau), d.by);
    d.weight = point.weight;
  }
  return all;
}

Vec3 Moved(const DiscDirection& d, const Vec3& w, const Vec3& e3) {
  return d.by[0] * w + d.by[1] * Cross(e3, w) + d.by[2] * e3;
}

// One pair of directions in place of the pair that was asked for.
struct PairDirection {
  DiscDirection i, o;
};

class ApertureMeanFunction {
 public:
  ApertureMeanFunction(BrdfFunction brdf, const Aperture& aperture, std::size_t channels, double lobe_width)
      : brdf_(std::move(brdf)), aperture_(aperture), channels_(channels), lobe_width_(lobe_width) {
    const double s = DiscTau(aperture.source), d = DiscTau(aperture.detector);
    const bool both = s > 0 && d > 0;
    levels_ = both ? kLevelsOfBoth : kLevels;
    for (std::size_t level = 0; level < levels_; ++level) {
      const int widths = 1 << level;
      const std::vector<DiscPoint> points = DiscRings(4 + 5 * widths, 12 + 14 * widths);
      if (!both) {
        AddConcentric({{s + d, 1.0}}, points, level);
        continue;
      }
      if (level > kFinestOfBoth) {
        AddConcentric(
            DiscNodes(aperture,
                      DiscNodeCount(aperture, 0.5 * std::min(aperture.source, aperture.detector) / widths, 1)),
            points, level);
        continue;
      }
      const std::vector<DiscPoint> coarse = DiscRings(3 + 3 * widths, 8 + 8 * widths);
      for (const DiscDirection& i : DiscDirections(s, coarse)) {
        for (const DiscDirection& o : DiscDirections(d, coarse)) rules_[level].push_back({i, o});
      }
    }
  }

  void operator()(const Vec3& wi, const Vec3& wo, double* values) const {
    const PairFrame frame = FrameOf({wi, wo});
    const double widest = std::max(aperture_.source, aperture_.detector);
    const double widths = RelativeDiscWidth(widest, lobe_width_, std::sqrt(0.5 * frame.h2));
    std::size_t level = 0;
    while (level + 1 < levels_ && widths > (1 << level)) ++level;
    std::vector<double> one(channels_);
    std::fill(values, values + channels_, 0.0);
    double total = 0;
    const bool flux = aperture_.mean == ApertureMean::kFlux;
    for (const PairDirection& pair : rules_[level]) {
      const Vec3 i = Moved(pair.i, wi, frame.e3), o = Moved(pair.o, wo, frame.e3);
      if (!(i.z > 0 && o.z > 0)) continue;
      brdf_(i, o, one.data());
      const double share = pair.i.weight * pair.o.weight;
      total += share;
      for (std::size_t c = 0; c < channels_; ++c) values[c] += share * one[c] * (flux ? i.z * o.z : 1.0);
    }
    // <cos> over a whole disc is cos^2(half angle / 2) of that of its centre.
    const double norm =
        flux ? wi.z * wo.z * (1 - 0.5 * DiscTau(aperture_.source)) * (1 - 0.5 * DiscTau(aperture_.detector)) : total;
    for (std::size_t c = 0; c < channels_ && norm > 0; ++c) values[c] /= norm;
  }

 private:
  // Both directions moved together.
  void AddConcentric(const std::vector<DiscNode>& nodes, const std::vector<DiscPoint>& points, std::size_t level) {
    const double share = DetectorShare(aperture_);
    for (const DiscNode& node : nodes) {
      for (const DiscPoint& point : points) {
        PairDirection& pair = rules_[level].emplace_back();
        SetDiscMultiples(point, (1 - share) * std::sqrt(2 * node.tau), pair.i.by);
        SetDiscMultiples(point, share * std::sqrt(2 * node.tau), pair.o.by);
        pair.i.weight = node.weight;
        pair.o.weight = point.weight;
      }
    }
  }

  BrdfFunction brdf_;
  Aperture aperture_;
  std::size_t channels_;
  double lobe_width_;
  std::size_t levels_ = 0;
  std::array<std::vector<PairDirection>, kLevels> rules_;
};

// Over a flat rectangle that faces the sample, by Gauss-Legendre nodes of its plane.
class RectangleMeanFunction {
 public:
  RectangleMeanFunction(BrdfFunction brdf, const Aperture& aperture, std::size_t channels, double lobe_width)
      : brdf_(std::move(brdf)), channels_(channels), flux_(aperture.mean == ApertureMean::kFlux) {
    const auto nodes = [lobe_width](double half_angle) {
      constexpr int kMost = 96;
      return std::min(kMost, 12 + static_cast<int>(std::lround(12 * half_angle / lobe_width)));
    };
    const double along = std::tan(aperture.detector), across = std::tan(aperture.across);
    const QuadratureRule x = GaussLegendre(nodes(aperture.detector)), y = GaussLegendre(nodes(aperture.across));
    for (std::size_t a = 0; a < x.nodes.size(); ++a) {
      for (std::size_t b = 0; b < y.nodes.size(); ++b) {
        const Vec3 at = {1, along * x.nodes[a], across * y.nodes[b]};
        const double length = Norm(at), weight = x.weights[a] * y.weights[b] / (length * length * length);
        points_.push_back({{at.x / length, at.y / length, at.z / length}, weight});
        cosine_ += weight / length;
      }
    }
  }

  void operator()(const Vec3& wi, const Vec3& wo, double* values) const {
    const double sine = std::hypot(wo.x, wo.y);
    const Vec3 across = sine > 1e-9 ? Vec3{-wo.y / sine, wo.x / sine, 0} : Vec3{0, 1, 0}, along = Cross(across, wo);
    std::vector<double> one(channels_);
    std::fill(values, values + channels_, 0.0);
    double above = 0;
    for (const DiscDirection& point : points_) {
      const Vec3 o = point.by[0] * wo + point.by[1] * along + point.by[2] * across;
      if (!(o.z > 0)) continue;
      brdf_(wi, o, one.data());
      above += point.weight;
      for (std::size_t c = 0; c < channels_; ++c) values[c] += point.weight * one[c] * (flux_ ? o.z : 1.0);
    }
    const double norm = flux_ ? cosine_ * wo.z : above;
    for (std::size_t c = 0; c < channels_ && norm > 0; ++c) values[c] /= norm;
  }

 private:
  BrdfFunction brdf_;
  std::size_t channels_;
  bool flux_;
  double cosine_ = 0;  // integral of w'.w over the nodes
  std::vector<DiscDirection> points_;
};

}  // namespace

BrdfFunction WithAperture(const BrdfFunction& brdf, const Aperture& aperture, std::size_t channels, double lobe_width) {
  if (!aperture.any()) return brdf;
  if (aperture.across > 0) {
    const auto mean = std::make_shared<const RectangleMeanFunction>(brdf, aperture, channels, lobe_width);
    return [mean](const Vec3& wi, const Vec3& wo, double* values) { (*mean)(wi, wo, values); };
  }
  const auto mean = std::make_shared<const ApertureMeanFunction>(brdf, aperture, channels, lobe_width);
  return [mean](const Vec3& wi, const Vec3& wo, double* values) { (*mean)(wi, wo, values); };
}

BrdfFunction WithMisalignment(const BrdfFunction& brdf, double about_x, double about_y, std::size_t channels) {
  return [=](const Vec3& wi, const Vec3& wo, double* values) {
    // The sample turned one way is the directions turned the other way in its frame.
    const Vec3 sample_wi = RotateX(RotateY(wi, -about_y), -about_x),
               sample_wo = RotateX(RotateY(wo, -about_y), -about_x);
    if (sample_wi.z > 0 && sample_wo.z > 0) {
      brdf(sample_wi, sample_wo, values);
    } else {
      std::fill(values, values + channels, 0.0);
    }
  };
}

}  // namespace lobefit
