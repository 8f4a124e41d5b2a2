#include "lobefit/fit/objective/coordinates.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/error.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr const char* kSlopeNames[] = {"slope_x", "slope_y", "ln a", "b", "ln c"};
// Slopes of 10 are normals 84 degrees from the surface's; widths from 1e-4 (a mirror) to 10 (nearly uniform over the
// hemisphere).
constexpr double kSlopeLow[] = {-10, -10, -9.2103403719761836, -10, -9.2103403719761836};
constexpr double kSlopeHigh[] = {10, 10, 2.302585092994046, 10, 2.302585092994046};

// tau of the coefficients' prior. Without data a coefficient stays within it; 5 % noise and 40 samples determine those
// within the data to a tenth of it.
constexpr double kProfileSpread = 2;

double* Entry(Ellipsoid* ellipsoid, int i) {
  double* entries[] = {&ellipsoid->alpha_x, &ellipsoid->alpha_y, &ellipsoid->theta_x, &ellipsoid->theta_y,
                       &ellipsoid->theta_z};
  return entries[i];
}

}  // namespace

Layout::Layout(const Recipe& recipe, const std::vector<std::string>& channels)
    : recipe_(recipe), channels_(channels.size()), linear_(channels.size()) {
  const std::vector<Parameter> parameters = Parameters(recipe.model);
  for (std::size_t lobe = 0; lobe < recipe.model.lobes.size(); ++lobe) {
    AddShape(lobe, parameters, FirstParameter(recipe.model, lobe));
  }
  first_angle_ = coordinates_.size();
  if (recipe.instrument.alignment) AddAngles();
  first_half_angle_ = coordinates_.size();
  AddHalfAngles();
  shape_size_ = coordinates_.size();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].group != ParameterGroup::kShape) AddLinear(parameters[i], recipe.parameters[i], channels);
  }
  if (recipe.instrument.offset) AddOffset(channels);
  if (coordinates_.empty())
    throw InputError("recipe '" + recipe.name + "': every parameter is fixed; free at least one");
}

void Layout::AddShape(std::size_t lobe, const std::vector<Parameter>& parameters, std::size_t first_parameter) {
  Shape shape;
  shape.first = coordinates_.size();
  const Ndf ndf = recipe_.model.lobes[lobe].ndf;
  shape.tied = IsRound(ndf);
  if (IsInPlane(ndf)) shape.fixed[4] = -recipe_.plane_azimuth;
  bool restricted = shape.tied;
  for (std::size_t i = 0; i < 5; ++i) {
    const ParameterRecipe& entry = recipe_.parameters[first_parameter + i];
    if (!entry.fixed.empty()) shape.fixed[i] = entry.fixed[0];
    restricted = restricted || !entry.fixed.empty() || entry.low || entry.high;
  }
  const std::string prefix = lobe == 0 ? "" : "lobe" + std::to_string(lobe + 1) + ".";
  shape.slope = !restricted;
  if (shape.slope) {
    shape.entries = IsTilted(ndf) ? std::vector<int>{0, 1, 2, 3, 4} : std::vector<int>{2, 3, 4};
    for (const int i : shape.entries) coordinates_.push_back({prefix + kSlopeNames[i], kSlopeLow[i], kSlopeHigh[i]});
  } else {
    for (int i = 0; i < 5; ++i) {
      const Parameter& parameter = parameters[first_parameter + static_cast<std::size_t>(i)];
      const ParameterRecipe& entry = recipe_.parameters[first_parameter + static_cast<std::size_t>(i)];
      if (!parameter.free || !entry.fixed.empty()) continue;
      const double low = entry.low.value_or(parameter.low), high = entry.high.value_or(parameter.high);
      shape.entries.push_back(i);
      if (i < 2) {
        coordinates_.push_back({"ln " + parameter.name, std::log(low), std::log(high)});
      } else {
        coordinates_.push_back({parameter.name, low, high});
      }
    }
  }
  AddProfile(lobe, parameters, &shape);
  AddMean(lobe, &shape);
  shapes_.push_back(shape);
}

void Layout::AddProfile(std::size_t lobe, const std::vector<Parameter>& parameters, Shape* shape) {
  const std::size_t first = FirstParameter(recipe_.model, lobe) + kEllipseParameters;
  for (std::size_t k = 0; k + kEllipseParameters < ShapeParameters(recipe_.model.lobes[lobe]); ++k) {
    const Parameter& parameter = parameters[first + k];
    const ParameterRecipe& entry = recipe_.parameters[first + k];
    const double start = entry.start.empty() ? parameter.start : entry.start[0];
    shape->profile_start.push_back(entry.fixed.empty() ? start : entry.fixed[0]);
    if (!entry.fixed.empty()) continue;
    const double low = entry.low.value_or(parameter.low), high = entry.high.value_or(parameter.high);
    shape->profile.push_back(k);
    if (IsExponent(lobe)) {
      const double least = LeastExponent(lobe);
      coordinates_.push_back({least > 0 ? "ln(" + parameter.name + " - 3/2)" : "ln " + parameter.name,
                              std::log(low - least), std::log(high - least)});
    } else {
      coordinates_.push_back({parameter.name, low, high, 1 / (kProfileSpread * kProfileSpread)});
    }
  }
}

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

void Layout::AddMean(std::size_t lobe, Shape* shape) {
  const Aperture aperture = recipe_.widest_aperture();
  if (!aperture.any()) return;
  const Lobe& kind = recipe_.model.lobes[lobe];
  const double larger = std::max(aperture.source, aperture.detector),
               smaller = std::min(aperture.source, aperture.detector);
  double width = recipe_.instrument.finest_width > 0 ? recipe_.instrument.finest_width : smaller;
  if (!HasMeanInClosedForm(kind)) {
    width = larger / (2 * kMostRelativeWidth * kMeanCosine) * (1 + 1e-9);
    // Width coordinates: ln a and ln c, or ln alpha.
    for (std::size_t k = 0; k < shape->entries.size(); ++k) {
      const int i = shape->entries[k];
      if (shape->slope ? i != 2 && i != 4 : i >= 2) continue;
      Coordinate& coordinate = coordinates_[shape->first + k];
      coordinate.low = std::max(coordinate.low, std::log(width));
      if (coordinate.low < coordinate.high) continue;
      throw InputError("recipe '" + recipe_.name + "': the bounds of " + coordinate.name +
                       " allow no lobe that is wide enough for the aperture; allowed are widths above " +
                       std::to_string(width) + " with the distribution '" + NameOf(NdfChoices(), kind.ndf) +
                       "', any with GGX and Smith masking");
    }
  }
  shape->mean =
      std::make_shared<const LobeMeanRule>(MakeLobeMeanRule(kind, aperture, std::max(width, 1e-6), kMeanCosine));
}

void Layout::AddAngles() {
  const AlignmentRecipe& alignment = *recipe_.instrument.alignment;
  for (std::size_t k = 0; k < alignment.azimuths.size() + 1; ++k) {
    const double prior = k < 2 ? alignment.prior : alignment.prior_turn;
    const std::string name = k == 0 ? "e_x" : k == 1 ? "e_y" : "e_z[" + std::to_string(k) + "]";
    // Beyond them a prior of this width has no weight that matters.
    const double bound = std::min(20 * prior, kPi / 18);
    coordinates_.push_back({name, -bound, bound, 1 / (prior * prior), true});
  }
}

void Layout::AddHalfAngles() {
  const auto add = [this](const char* name, double half_angle, const std::optional<double>& prior) {
    if (!prior) return;
    // A disc of no width is a point, at which nothing tells its half angle.
    constexpr double kLeast = 0.1;
    const double low = -std::min(kMostHalfAngleSigmas * *prior, (1 - kLeast) * half_angle),
                 high = std::min(kMostHalfAngleSigmas * *prior, kLargestHalfAngle - half_angle);
    coordinates_.push_back({name, low, high, 1 / (*prior * *prior), true});
  };
  const Aperture aperture = recipe_.aperture();
  add("source", aperture.source, recipe_.instrument.source_prior);
  add("detector", aperture.detector, recipe_.instrument.detector_prior);
}

Aperture Layout::ApertureAt(const double* u) const {
  Aperture aperture = recipe_.aperture();
  std::size_t next = first_half_angle_;
  if (recipe_.instrument.source_prior) aperture.source += u[next++];
  if (recipe_.instrument.detector_prior) aperture.detector += u[next];
  return aperture;
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

void Layout::AddOffset(const std::vector<std::string>& channels) {
  constexpr double kMostOffset = 1e6;
  for (std::size_t c = 0; c < channels_; ++c) {
    linear_[c].push_back({static_cast<int>(coordinates_.size()), 0, 0});
    coordinates_.push_back({"offset[" + channels[c] + "]", -kMostOffset, kMostOffset});
  }
}

void Layout::AddLinear(const Parameter& parameter, const ParameterRecipe& entry,
                       const std::vector<std::string>& channels) {
  const double low = entry.low.value_or(parameter.low), high = entry.high.value_or(parameter.high);
  for (std::size_t c = 0; c < channels_; ++c) {
    Linear linear;
    linear.start = entry.start.empty() ? parameter.start : entry.start[std::min(c, entry.start.size() - 1)];
    if (!parameter.free && !entry.free && entry.fixed.empty()) {
      linear.value = parameter.start;
    } else if (!entry.fixed.empty()) {
      if (entry.fixed.size() != 1 && entry.fixed.size() != channels_) {
        throw InputError("recipe '" + recipe_.name + "': '" + parameter.json_name + "' is fixed to " +
                         std::to_string(entry.fixed.size()) + " values, the measurement has " +
                         std::to_string(channels_) + " channels");
      }
      linear.value = entry.fixed[entry.fixed.size() == 1 ? 0 : c];
    } else if (entry.shared && c > 0) {
      linear.index = linear_[0].back().index;
    } else {
      linear.index = static_cast<int>(coordinates_.size());
      coordinates_.push_back({parameter.name + (entry.shared ? "" : "[" + channels[c] + "]"), low, high});
    }
    linear_[c].push_back(linear);
  }
}

Ellipsoid Layout::EllipsoidAt(const Shape& shape, const double* u) const {
  Ellipsoid ellipsoid = {shape.fixed[0], shape.fixed[1], shape.fixed[2], shape.fixed[3], shape.fixed[4]};
  for (std::size_t k = 0; k < shape.entries.size(); ++k) {
    const int i = shape.entries[k];
    *Entry(&ellipsoid, i) = i < 2 ? std::exp(u[shape.first + k]) : u[shape.first + k];
  }
  if (shape.tied) ellipsoid.alpha_y = ellipsoid.alpha_x;
  return ellipsoid;
}

void Layout::SetEllipsoid(const Shape& shape, const Ellipsoid& ellipsoid, std::vector<double>* u) const {
  Ellipsoid entries = ellipsoid;
  const SlopeCoordinates slope = shape.slope ? SlopeCoordinatesFromEllipsoid(ellipsoid) : SlopeCoordinates();
  for (std::size_t k = 0; k < shape.entries.size(); ++k) {
    const int i = shape.entries[k];
    const double entry = *Entry(&entries, i);
    (*u)[shape.first + k] = shape.slope ? slope.v[i] : (i < 2 ? std::log(entry) : entry);
  }
}

SlopeCoordinates Layout::SlopeAt(const Shape& shape, const double* u) const {
  SlopeCoordinates slope;
  for (std::size_t k = 0; k < shape.entries.size(); ++k) slope.v[shape.entries[k]] = u[shape.first + k];
  return slope;
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

std::vector<int> Layout::CoordinatesOfColumns(std::size_t c) const {
  std::vector<int> index;
  for (std::size_t k = 0; k < shape_size_; ++k) index.push_back(static_cast<int>(k));
  for (const Linear& linear : linear_[c]) index.push_back(linear.index);
  if (recipe_.instrument.drift) index.push_back(-1);
  return index;
}

template <class Add>
void Layout::GatherEntries(const KernelSums& sums, std::size_t dropped, const Add& add,
                           Eigen::VectorXd* gradient) const {
  gradient->setZero(static_cast<Eigen::Index>(size()));
  for (std::size_t c = 0; c < channels_; ++c) {
    // -2 for the residual.
    std::vector<int> index = CoordinatesOfColumns(c);
    index.erase(index.begin(), index.begin() + static_cast<std::ptrdiff_t>(dropped));
    index.push_back(-2);
    const double* entry = sums.gram[c].data();
    for (std::size_t i = 0; i < index.size(); ++i) {
      for (std::size_t j = i; j < index.size(); ++j, ++entry) {
        if (index[i] < 0) continue;
        if (index[j] == -2) {
          (*gradient)(index[i]) += *entry;
        } else if (index[j] >= 0) {
          add(c, index[i], index[j], *entry);
        }
      }
    }
  }
  for (std::size_t k = 0; k < sums.prior_slope.size(); ++k) {
    if (sums.prior_curvature[k] != 0) add(0, static_cast<int>(k), static_cast<int>(k), sums.prior_curvature[k]);
    (*gradient)(static_cast<Eigen::Index>(k)) += sums.prior_slope[k];
  }
}

void Layout::Gather(const KernelSums& sums, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
  hessian->setZero(static_cast<Eigen::Index>(size()), static_cast<Eigen::Index>(size()));
  const auto add = [hessian](std::size_t, int i, int j, double value) {
    (*hessian)(i, j) += value;
    // A shared amplitude may meet itself in one channel only on the diagonal.
    if (i != j) (*hessian)(j, i) += value;
  };
  GatherEntries(sums, 0, add, gradient);
}

void Layout::Gather(const KernelSums& sums, ArrowMatrix* hessian, Eigen::VectorXd* gradient,
                    std::size_t dropped) const {
  *hessian = ArrowMatrix(ArrowShapeOf(*this));
  // Place of each coordinate in its part; below 0: in the border, from -1 on.
  std::vector<Eigen::Index> place(size());
  const ArrowShape& shape = hessian->shape;
  for (std::size_t k = 0; k < shape.border.size(); ++k)
    place[static_cast<std::size_t>(shape.border[k])] = -1 - static_cast<Eigen::Index>(k);
  for (const std::vector<int>& own : shape.own) {
    for (std::size_t k = 0; k < own.size(); ++k) place[static_cast<std::size_t>(own[k])] = static_cast<Eigen::Index>(k);
  }
  const auto add = [hessian, &place](std::size_t c, int i, int j, double value) {
    const Eigen::Index p = place[static_cast<std::size_t>(i)], q = place[static_cast<std::size_t>(j)];
    if (p >= 0 && q >= 0) {
      hessian->own[c](p, q) += value;
      if (i != j) hessian->own[c](q, p) += value;
    } else if (p < 0 && q < 0) {
      hessian->border(-1 - p, -1 - q) += value;
      if (i != j) hessian->border(-1 - q, -1 - p) += value;
    } else {
      hessian->across[c](p < 0 ? -1 - p : -1 - q, p < 0 ? q : p) += value;
    }
  };
  GatherEntries(sums, dropped, add, gradient);
}

std::vector<std::vector<double>> Layout::GatherScores(const std::vector<std::vector<double>>& scores) const {
  const std::size_t count = scores.empty() ? 0 : scores[0].size();
  std::vector<std::vector<double>> gathered(size(), std::vector<double>(count, 0.0));
  const auto add = [&](const std::vector<double>& from, std::size_t to) {
    for (std::size_t i = 0; i < count; ++i) gathered[to][i] += from[i];
  };
  for (std::size_t k = 0; k < shape_size_; ++k) add(scores[k], k);
  for (std::size_t c = 0; c < channels_; ++c) {
    for (std::size_t k = 0; k < linear_[c].size(); ++k) {
      if (linear_[c][k].index >= 0)
        add(scores[shape_size_ + c * linear_[c].size() + k], static_cast<std::size_t>(linear_[c][k].index));
    }
  }
  return gathered;
}

ParameterValues Layout::Report(const double* u) const {
  ParameterValues values;
  std::size_t next = 0;
  const auto add_linear = [&] {
    std::vector<double> entries;
    for (std::size_t c = 0; c < channels_; ++c) entries.push_back(Value(linear_[c][next], u));
    values.push_back(entries);
    ++next;
  };
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    const Shape& shape = shapes_[l];
    Ellipsoid ellipsoid = shape.slope ? EllipsoidFromSlopeCoordinates(SlopeAt(shape, u)) : EllipsoidAt(shape, u);
    for (int i = 0; i < 5; ++i) values.push_back({*Entry(&ellipsoid, i)});
    for (const double value : ProfileAt(l, u)) values.push_back({value});
    for (std::size_t k = 0; k < FresnelParameters(recipe_.model.lobes[l].fresnel); ++k) add_linear();
  }
  for (std::size_t k = 0; k < DiffuseParameters(recipe_.model.diffuse); ++k) add_linear();
  return values;
}

Eigen::MatrixXd Layout::ReportJacobian(const double* u) const {
  std::size_t rows = linear_[0].size() * channels_ + shape_size_ - first_angle_;
  for (const Lobe& lobe : recipe_.model.lobes) rows += ShapeParameters(lobe);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(size()));
  Eigen::Index row = 0;
  std::size_t next = 0;
  const auto add_linear = [&] {
    for (std::size_t c = 0; c < channels_; ++c, ++row) {
      if (linear_[c][next].index >= 0) jacobian(row, linear_[c][next].index) = 1;
    }
    ++next;
  };
  for (std::size_t l = 0; l < shapes_.size(); ++l) {
    const Shape& shape = shapes_[l];
    double slope_jacobian[25];
    if (shape.slope) EllipsoidFromSlopeCoordinates(SlopeAt(shape, u), slope_jacobian);
    Ellipsoid ellipsoid = EllipsoidAt(shape, u);
    for (std::size_t k = 0; k < shape.entries.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(shape.first + k);
      const int i = shape.entries[k];
      if (shape.slope) {
        for (int j = 0; j < 5; ++j) jacobian(row + j, column) = slope_jacobian[5 * j + i];
      } else {
        jacobian(row + i, column) = i < 2 ? *Entry(&ellipsoid, i) : 1.0;
        if (i == 0 && shape.tied) jacobian(row + 1, column) = ellipsoid.alpha_y;
      }
    }
    row += 5;
    std::vector<double> slopes;
    const std::vector<double> profile = ProfileAt(l, u, &slopes);
    for (std::size_t k = 0; k < shape.profile.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(shape.first + shape.entries.size() + k);
      jacobian(row + static_cast<Eigen::Index>(shape.profile[k]), column) = slopes[k];
    }
    row += static_cast<Eigen::Index>(profile.size());
    for (std::size_t k = 0; k < FresnelParameters(recipe_.model.lobes[l].fresnel); ++k) add_linear();
  }
  for (std::size_t k = 0; k < DiffuseParameters(recipe_.model.diffuse); ++k) add_linear();
  for (std::size_t k = first_angle_; k < shape_size_; ++k, ++row) jacobian(row, static_cast<Eigen::Index>(k)) = 1;
  if (recipe_.instrument.offset) add_linear();
  return jacobian;
}

}  // namespace lobefit
