#include "lobefit/core/instrument/mean_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// The least rings x azimuths that keep 1e-3 of the peak, for GGX, which is harder than Beckmann.
struct CubatureSize {
  double relative_width;
  int rings, azimuths;  // rings 0: the seven points
};
constexpr CubatureSize kOneDisc[] = {{0.3, 0, 0}, {1, 3, 8}, {kMostRelativeWidth, 6, 16}};
// For each node of the smaller disc's mixture.
constexpr CubatureSize kTwoDiscs[] = {{0.5, 4, 12}, {1, 6, 16}, {kMostRelativeWidth, 8, 24}};

Vec3 Combined(const double* by, const Vec3& w, const Vec3& e3) { return by[0] * w + by[1] * Cross(e3, w) + by[2] * e3; }

// Directions of all points of a few samples, structure of arrays.
constexpr std::size_t kSamplesAtOnce = 16;

// The disc about the mirrored light is the mirrored disc: a retro lobe's mean is that of the lobe seen from there.
void MeanOfMirrored(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape,
                    const LobeMeanRule& rule, const LobeMeans& means) {
  std::vector<double> x(directions.wi_x, directions.wi_x + directions.count),
      y(directions.wi_y, directions.wi_y + directions.count);
  for (double& v : x) v = -v;
  for (double& v : y) v = -v;
  DirectionArrays mirrored = directions;
  mirrored.wi_x = x.data();
  mirrored.wi_y = y.data();
  Lobe forward = lobe;
  forward.direction = LobeDirection::kSpecular;
  MeanLobe(mirrored, forward, shape, rule, means);
}

void SetRegion(const Aperture& aperture, LobeMeanRule* rule) {
  rule->region = nullptr;
  if (aperture.mean != ApertureMean::kFlux) return;
  if (aperture.across > 0) {
    rule->region = std::make_shared<const DirectionRegion>(RectangleRegion(aperture.detector, aperture.across));
    rule->cut_below = 1;
    rule->reach = std::sin(std::hypot(aperture.detector, aperture.across));
  } else if (aperture.source == 0 || aperture.detector == 0) {
    const double half_angle = std::max(aperture.source, aperture.detector);
    rule->region = std::make_shared<const DirectionRegion>(DiscRegion(half_angle));
    rule->cut_below = rule->reach = std::sin(half_angle);
  }
  rule->region_of_source = aperture.detector == 0;
}

// Calls each(i, direction of the region's side, the other one) where the mean is over the rule's region.
template <class Each>
void ForRegion(const DirectionArrays& d, const LobeMeanRule& rule, const Each& each) {
  const double* cosine = rule.region_of_source ? d.wi_z : d.wo_z;
  for (std::size_t i = 0; rule.region != nullptr && i < d.count; ++i) {
    if (!(cosine[i] <= rule.cut_below)) continue;
    const Vec3 wi = {d.wi_x[i], d.wi_y[i], d.wi_z[i]}, wo = {d.wo_x[i], d.wo_y[i], d.wo_z[i]};
    each(i, rule.region_of_source ? wi : wo, rule.region_of_source ? wo : wi);
  }
}

void MeansOverRegion(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape,
                     const LobeMeanRule& rule, const LobeMeans& means) {
  ForRegion(directions, rule, [&](std::size_t i, const Vec3& spread, const Vec3& point) {
    double gradient[5], argument_gradient[5];
    means.specular[i] =
        GgxRegionMean(point, spread, shape.slope, lobe.masking, *rule.region, rule.argument, &means.argument[i],
                      means.gradient != nullptr ? gradient : nullptr, argument_gradient);
    for (std::size_t j = 0; means.gradient != nullptr && j < 5; ++j) {
      means.gradient[j * directions.count + i] = gradient[j];
      means.argument_gradient[j * directions.count + i] = argument_gradient[j];
    }
  });
}

}  // namespace

bool HasMeanInClosedForm(const Lobe& lobe) {
  return FamilyOf(lobe.ndf) == Family::kGgx && lobe.masking <= Masking::kSmithHeight;
}

LobeMeanRule MakeLobeMeanRule(const Lobe& lobe, const Aperture& aperture, double alpha, double cos_d) {
  LobeMeanRule rule;
  rule.closed_form = HasMeanInClosedForm(lobe);
  rule.argument = lobe.fresnel == Fresnel::kSchlick || lobe.fresnel == Fresnel::kNone ? FresnelArgument::kSchlickPower
                                                                                      : FresnelArgument::kCosine;
  const double s = DiscTau(aperture.source), d = DiscTau(aperture.detector);
  rule.relative_width = RelativeDiscWidth(std::hypot(aperture.source, aperture.detector), alpha, cos_d);
  rule.nodes = DiscNodeCount(aperture, alpha, cos_d);
  if (rule.closed_form) return WithDiscs(rule, aperture);
  const bool both = s > 0 && d > 0;
  if (aperture.across > 0) {
    throw InputError(fmt::format(
        "a rectangular detector is averaged over in closed form, which the distribution '{}' with its masking has not: "
        "fit a GGX distribution with Smith masking, or give the detector as a disc of the same solid angle",
        NameOf(NdfChoices(), lobe.ndf)));
  }
  const double widest = RelativeDiscWidth(std::max(aperture.source, aperture.detector), alpha, cos_d);
  if (widest > kMostRelativeWidth) {
    throw InputError(fmt::format(
        "an aperture of {:.3g} degrees (half angle) is {:.1f} times as wide as a lobe of width {:.3g} with the "
        "distribution '{}': allowed are {:g} times; raise the lower bound of its width, or fit a GGX distribution with "
        "Smith masking, whose mean has a closed form",
        RadiansToDegrees(std::max(aperture.source, aperture.detector)), widest, alpha, NameOf(NdfChoices(), lobe.ndf),
        kMostRelativeWidth));
  }
  const CubatureSize* size = both ? kTwoDiscs : kOneDisc;
  while (size->relative_width < widest) ++size;
  rule.rings = size->rings;
  rule.azimuths = size->azimuths;
  if (both) rule.nodes = std::max(3, rule.nodes);
  return WithDiscs(rule, aperture);
}

LobeMeanRule WithDiscs(const LobeMeanRule& rule, const Aperture& aperture) {
  LobeMeanRule moved = rule;
  moved.ggx = MakeGgxMeanRule(aperture, rule.nodes, rule.argument);
  moved.points.clear();
  if (rule.closed_form) {
    SetRegion(aperture, &moved);
    return moved;
  }
  const std::vector<DiscPoint> points = rule.rings == 0 ? SevenDiscPoints() : DiscRings(rule.rings, rule.azimuths);
  for (const DiscNode& node : DiscNodes(aperture, rule.nodes)) {
    const double chord = std::sqrt(2 * node.tau);
    for (const DiscPoint& point : points) {
      GgxMeanRule::Point& to = moved.points.emplace_back();
      SetDiscMultiples(point, moved.ggx.detector_share * chord, to.o);
      SetDiscMultiples(point, (1 - moved.ggx.detector_share) * chord, to.i);
      to.weight = node.weight * point.weight;
    }
  }
  return moved;
}

void ConstantMeans(const DirectionArrays& directions, const LobeMeanRule& rule, double* factor) {
  std::fill_n(factor, directions.count, 1.0);
  ForRegion(directions, rule, [&](std::size_t i, const Vec3& spread, const Vec3&) {
    if (spread.z <= rule.reach) factor[i] = ConstantMean(spread, *rule.region);
  });
}

void MeanLobe(const DirectionArrays& directions, const Lobe& lobe, const LobeShape& shape, const LobeMeanRule& rule,
              const LobeMeans& means) {
  if (lobe.direction == LobeDirection::kRetro) return MeanOfMirrored(directions, lobe, shape, rule, means);
  if (rule.closed_form) {
    GgxMeanLobe(directions, shape.slope, lobe.masking, rule.ggx, means);
    return MeansOverRegion(directions, lobe, shape, rule, means);
  }
  const bool derivatives = means.gradient != nullptr;
  const std::size_t size = ShapeParameters(lobe);
  const std::size_t per_sample = rule.points.size(), most = per_sample * kSamplesAtOnce;
  std::array<std::vector<double>, 6> moved;
  for (std::vector<double>& field : moved) field.resize(most);
  std::vector<double> specular(most), cos_d(most), gradient(derivatives ? size * most : 0);
  std::vector<double> dsum(size), dmoment(size);
  const DirectionArrays& from = directions;
  for (std::size_t begin = 0; begin < from.count; begin += kSamplesAtOnce) {
    const std::size_t samples = std::min(kSamplesAtOnce, from.count - begin), count = samples * per_sample;
    for (std::size_t k = 0; k < samples; ++k) {
      const std::size_t i = begin + k;
      const Vec3 wi = {from.wi_x[i], from.wi_y[i], from.wi_z[i]}, wo = {from.wo_x[i], from.wo_y[i], from.wo_z[i]};
      const Vec3 e3 = FrameOf({wi, wo}).e3;
      for (std::size_t q = 0; q < per_sample; ++q) {
        const Vec3 a = Combined(rule.points[q].i, wi, e3), b = Combined(rule.points[q].o, wo, e3);
        const double all[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
        for (std::size_t f = 0; f < 6; ++f) moved[f][k * per_sample + q] = all[f];
      }
    }
    SpecularLobe(
        {moved[0].data(), moved[1].data(), moved[2].data(), moved[3].data(), moved[4].data(), moved[5].data(), count},
        lobe, shape, specular.data(), cos_d.data(), derivatives ? gradient.data() : nullptr);
    for (std::size_t k = 0; k < samples; ++k) {
      double sum = 0, moment = 0;
      std::fill(dsum.begin(), dsum.end(), 0.0);
      std::fill(dmoment.begin(), dmoment.end(), 0.0);
      for (std::size_t q = 0; q < per_sample; ++q) {
        const std::size_t at = k * per_sample + q;
        const double weight = rule.points[q].weight * (rule.ggx.flux ? moved[2][at] * moved[5][at] : 1.0);
        const double x = 1 - cos_d[at];
        const double argument = rule.argument == FresnelArgument::kCosine ? cos_d[at] : x * x * (x * x) * x;
        sum += weight * specular[at];
        moment += weight * specular[at] * argument;
        for (std::size_t j = 0; derivatives && j < size; ++j) {
          const double d = weight * gradient[j * count + at];
          dsum[j] += d;
          dmoment[j] += d * argument;
        }
      }
      const std::size_t i = begin + k;
      const double scale = rule.ggx.flux ? rule.ggx.inverse_cosines / (from.wi_z[i] * from.wo_z[i]) : 1.0;
      means.specular[i] = scale * sum;
      // A lobe that reflects nothing here has no mean argument: any will do.
      means.argument[i] = sum > 0 ? moment / sum : 0.0;
      for (std::size_t j = 0; derivatives && j < size; ++j) {
        means.gradient[j * from.count + i] = scale * dsum[j];
        means.argument_gradient[j * from.count + i] = sum > 0 ? (dmoment[j] - means.argument[i] * dsum[j]) / sum : 0.0;
      }
    }
  }
}

}  // namespace lobefit
