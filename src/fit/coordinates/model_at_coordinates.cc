// The model that a point of the solver describes, and the point of a model.
#include <algorithm>
#include <cmath>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/coordinates/ellipsoid_entry.h"

namespace lobefit {

std::vector<double> Layout::ProfileAt(std::size_t lobe, const double* u, std::vector<double>* slopes) const {
  const Shape& shape = shapes_[lobe];
  std::vector<double> values = shape.profile_start;
  for (std::size_t k = 0; k < shape.profile.size(); ++k) {
    const double x = u[shape.first + shape.entries.size() + k];
    values[shape.profile[k]] = IsExponent(lobe) ? LeastExponent(lobe) + std::exp(x) : x;
    if (slopes != nullptr) slopes->push_back(IsExponent(lobe) ? std::exp(x) : 1.0);
  }
  return values;
}

Aperture Layout::ApertureAt(const double* u) const {
  Aperture aperture = recipe_.aperture();
  std::size_t next = first_half_angle_;
  if (recipe_.instrument.source_prior) aperture.source += u[next++];
  if (recipe_.instrument.detector_prior) aperture.detector += u[next];
  return aperture;
}

Ellipsoid Layout::EllipsoidAt(const Shape& shape, const double* u) const {
  Ellipsoid ellipsoid = {shape.fixed[0], shape.fixed[1], shape.fixed[2], shape.fixed[3], shape.fixed[4]};
  for (std::size_t k = 0; k < shape.entries.size(); ++k) {
    const int i = shape.entries[k];
    *EllipsoidEntry(&ellipsoid, i) = i < 2 ? std::exp(u[shape.first + k]) : u[shape.first + k];
  }
  if (shape.tied) ellipsoid.alpha_y = ellipsoid.alpha_x;
  return ellipsoid;
}

SlopeCoordinates Layout::SlopeAt(const Shape& shape, const double* u) const {
  SlopeCoordinates slope;
  for (std::size_t k = 0; k < shape.entries.size(); ++k) slope.v[shape.entries[k]] = u[shape.first + k];
  return slope;
}

void Layout::SetDiscs(const double* u, KernelModel* kernel) const {
  if (first_half_angle_ == shape_size_) return;
  const auto rules = [&](const std::vector<double>& at) {
    std::vector<std::shared_ptr<const LobeMeanRule>> all;
    for (const Shape& shape : shapes_)
      all.push_back(std::make_shared<const LobeMeanRule>(WithDiscs(*shape.mean, ApertureAt(at.data()))));
    return all;
  };
  std::vector<double> at(u, u + size());
  const std::vector<std::shared_ptr<const LobeMeanRule>> here = rules(at);
  for (std::size_t l = 0; l < here.size(); ++l) kernel->lobes[l].mean = here[l];
  // Off by 1e-8 of the derivative of a lobe a tenth as wide as the disc.
  constexpr double kStep = 1e-5;
  for (std::size_t k = first_half_angle_; k < shape_size_; ++k) {
    KernelHalfAngle half_angle;
    half_angle.step = kStep * (k == first_half_angle_ && recipe_.instrument.source_prior ? ApertureAt(u).source
                                                                                         : ApertureAt(u).detector);
    at[k] = u[k] - half_angle.step;
    half_angle.below = rules(at);
    at[k] = u[k] + half_angle.step;
    half_angle.above = rules(at);
    at[k] = u[k];
    kernel->half_angles.push_back(std::move(half_angle));
  }
}

KernelModel Layout::ToKernel(const double* u) const {
  KernelModel kernel;
  kernel.transform = TransformOf(recipe_.metric, recipe_.noise);
  kernel.loss = recipe_.loss;
  kernel.loss_scale = recipe_.loss_scale;
  kernel.gains = recipe_.instrument.drift.has_value();
  if (recipe_.instrument.alignment)
    kernel.alignment = {recipe_.instrument.alignment->azimuths, {u + first_angle_, u + first_half_angle_}};
  for (std::size_t c = 0; recipe_.instrument.offset && c < channels_; ++c)
    kernel.offset.push_back(Value(linear_[c].back(), u));
  kernel.diffuse_kind = recipe_.model.diffuse;
  kernel.channels = channels_;
  if (std::any_of(coordinates_.begin(), coordinates_.end(), [](const Coordinate& c) { return c.prior > 0; })) {
    for (const Coordinate& coordinate : coordinates_) kernel.prior.push_back(coordinate.prior);
    kernel.coordinates.assign(u, u + size());
  }
  std::size_t first_linear = 0;
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    const Shape& shape = shapes_[l];
    KernelLobe lobe;
    lobe.kind = recipe_.model.lobes[l];
    lobe.mean = shape.mean;
    lobe.columns = shape.columns();
    lobe.jacobian.assign(ShapeParameters(lobe.kind) * lobe.columns, 0.0);
    SlopeCoordinates slope;
    if (shape.slope) {
      slope = SlopeAt(shape, u);
      for (std::size_t k = 0; k < shape.entries.size(); ++k)
        lobe.jacobian[static_cast<std::size_t>(shape.entries[k]) * lobe.columns + k] = 1;
    } else {
      const Ellipsoid ellipsoid = EllipsoidAt(shape, u);
      double jacobian[25];
      slope = SlopeCoordinatesFromEllipsoid(ellipsoid, jacobian);
      for (std::size_t j = 0; j < 5; ++j) {
        for (std::size_t k = 0; k < shape.entries.size(); ++k) {
          const int i = shape.entries[k];
          double derivative = jacobian[5 * j + static_cast<std::size_t>(i)];
          if (i == 0 && shape.tied) derivative += jacobian[5 * j + 1];
          if (i == 0) derivative *= ellipsoid.alpha_x;
          if (i == 1) derivative *= ellipsoid.alpha_y;
          lobe.jacobian[j * lobe.columns + k] = derivative;
        }
      }
    }
    std::vector<double> slopes;
    lobe.shape = LobeShape(lobe.kind, slope, ProfileAt(l, u, &slopes));
    for (std::size_t k = 0; k < shape.profile.size(); ++k)
      lobe.jacobian[(kEllipseParameters + shape.profile[k]) * lobe.columns + shape.entries.size() + k] = slopes[k];
    const std::size_t size = FresnelParameters(lobe.kind.fresnel);
    for (std::size_t c = 0; c < channels_; ++c) {
      for (std::size_t k = 0; k < size; ++k) lobe.fresnel.push_back(Value(linear_[c][first_linear + k], u));
    }
    first_linear += size;
    kernel.lobes.push_back(lobe);
  }
  SetDiscs(u, &kernel);
  const std::size_t diffuse_size = DiffuseParameters(recipe_.model.diffuse);
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t k = 0; k < diffuse_size; ++k) kernel.diffuse.push_back(Value(linear_[c][first_linear + k], u));
  }
  return kernel;
}

std::size_t Layout::DropShapes(KernelModel* kernel) const {
  if (first_angle_ < shape_size_) return 0;
  for (KernelLobe& lobe : kernel->lobes) {
    lobe.columns = 0;
    lobe.jacobian.clear();
  }
  return shape_size_;
}

void Layout::SetEllipsoid(const Shape& shape, const Ellipsoid& ellipsoid, std::vector<double>* u) const {
  Ellipsoid entries = ellipsoid;
  const SlopeCoordinates slope = shape.slope ? SlopeCoordinatesFromEllipsoid(ellipsoid) : SlopeCoordinates();
  for (std::size_t k = 0; k < shape.entries.size(); ++k) {
    const int i = shape.entries[k];
    const double entry = *EllipsoidEntry(&entries, i);
    (*u)[shape.first + k] = shape.slope ? slope.v[i] : (i < 2 ? std::log(entry) : entry);
  }
}

std::vector<double> Layout::FromShapes(const std::vector<Ellipsoid>& shapes) const {
  std::vector<double> u(size(), 0.0);
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    SetEllipsoid(shapes_[l], shapes[l], &u);
    for (std::size_t k = 0; k < shapes_[l].profile.size(); ++k) {
      const double start = shapes_[l].profile_start[shapes_[l].profile[k]];
      u[shapes_[l].first + shapes_[l].entries.size() + k] = IsExponent(l) ? std::log(start - LeastExponent(l)) : start;
    }
  }
  for (const std::vector<Linear>& channel : linear_) {
    for (const Linear& linear : channel) {
      if (linear.index >= 0) u[static_cast<std::size_t>(linear.index)] = linear.start;
    }
  }
  for (std::size_t i = 0; i < u.size(); ++i) u[i] = std::clamp(u[i], coordinates_[i].low, coordinates_[i].high);
  return u;
}

void Layout::CopyProfiles(const std::vector<double>& from, std::vector<double>* to) const {
  for (const Shape& shape : shapes_) {
    const std::size_t first = shape.first + shape.entries.size();
    for (std::size_t k = first; k < shape.first + shape.columns(); ++k) (*to)[k] = from[k];
  }
}

}  // namespace lobefit
