#include "lobefit/fit/objective/reading.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

// A gain belongs to the directions within this angle of its own: incidences that lie nearer are one (incidence.h).
constexpr double kSameIncidence = 0.4 * kPi / 180;

std::shared_ptr<const LobeMeanRule> MeanRule(const Lobe& lobe, const LobeShape& shape, const Aperture& aperture) {
  if (!aperture.any()) return nullptr;
  return std::make_shared<const LobeMeanRule>(
      MakeLobeMeanRule(lobe, aperture, NarrowestWidth(shape.slope), kMeanCosine));
}

KernelModel SurfaceOf(const Material& material, const Aperture& aperture) {
  const Model& model = material.model;
  const ParameterValues values = material.Values();
  const std::size_t channels = material.channels.size();
  const std::vector<LobeShape> shapes = Reflectance(model, values, channels).shapes();
  KernelModel kernel;
  kernel.channels = channels;
  kernel.diffuse_kind = model.diffuse;
  for (std::size_t l = 0; l < model.lobes.size(); ++l) {
    KernelLobe& lobe = kernel.lobes.emplace_back();
    lobe.kind = model.lobes[l];
    lobe.shape = shapes[l];
    lobe.mean = MeanRule(lobe.kind, lobe.shape, aperture);
    const std::size_t first = FirstFresnel(model, l);
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t k = 0; k < FresnelParameters(lobe.kind.fresnel); ++k)
        lobe.fresnel.push_back(values[first + k][c]);
    }
  }
  const std::size_t size = DiffuseParameters(model.diffuse), first = values.size() - size;
  for (std::size_t c = 0; c < channels; ++c) {
    for (std::size_t k = 0; k < size; ++k) kernel.diffuse.push_back(values[first + k][c]);
  }
  return kernel;
}

}  // namespace

Reading::Reading(const Material& material, std::optional<Beam> held) : held_(held) {
  const InstrumentUsed instrument = material.instrument.value_or(InstrumentUsed{});
  model_ =
      SurfaceOf(material, {instrument.source, instrument.detector,
                           instrument.mean == "plain" ? ApertureMean::kPlain : ApertureMean::kFlux, instrument.across});
  if (!instrument.alignment.empty()) {
    turns_.azimuths = instrument.azimuths;
    model_.alignment.azimuths = instrument.azimuths;
    for (const InstrumentAngle& angle : instrument.alignment) model_.alignment.angles.push_back(angle.value);
  }
  for (const InstrumentOffset& offset : instrument.offset) model_.offset.push_back(offset.value);
  if (!held_ || instrument.gains.empty()) return;
  model_.gains = true;
  std::vector<IncidenceGain> gains = instrument.gains;
  std::sort(gains.begin(), gains.end(),
            [](const IncidenceGain& a, const IncidenceGain& b) { return a.theta_i > b.theta_i; });
  for (const IncidenceGain& gain : gains) {
    gain_directions_.push_back(FromSpherical(gain.theta_i, gain.phi_i));
    gains_.push_back(gain.gain);
  }
  gains_.push_back(1);
}

std::uint32_t Reading::GainOf(const Vec3& w) const {
  auto nearest = static_cast<std::uint32_t>(gain_directions_.size());
  double least = 2 * std::sin(kSameIncidence / 2);
  const double lowest = w.z - least;
  const auto begin = std::lower_bound(gain_directions_.begin(), gain_directions_.end(), lowest,
                                      [](const Vec3& direction, double z) { return direction.z < z; });
  for (auto at = begin; at != gain_directions_.end() && at->z <= w.z + least; ++at) {
    const double distance = Norm(*at - w);
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<std::uint32_t>(at - gain_directions_.begin());
  }
  return nearest;
}

void Reading::Evaluate(const DirectionArrays& directions, const double* sample_azimuth,
                       std::vector<std::vector<double>>* readings) const {
  KernelSamples samples = {};
  const double* const fields[] = {directions.wi_x, directions.wi_y, directions.wi_z,
                                  directions.wo_x, directions.wo_y, directions.wo_z};
  std::copy(std::begin(fields), std::end(fields), std::begin(samples.direction));
  samples.count = directions.count;
  std::vector<std::uint16_t> turn;
  if (sample_azimuth != nullptr && turns_.azimuths.size() > 1) {
    for (std::size_t i = 0; i < directions.count; ++i) turn.push_back(turns_.TurnOf(sample_azimuth[i]));
    samples.turn = turn.data();
  }
  std::vector<std::uint32_t> group;
  if (model_.gains) {
    const std::size_t side = *held_ == Beam::kLight ? 0 : 3;
    Vec3 last = {};
    for (std::size_t i = 0; i < directions.count; ++i) {
      // Samples of an incidence stand together.
      const Vec3 w = {fields[side][i], fields[side + 1][i], fields[side + 2][i]};
      const bool same = i > 0 && w.x == last.x && w.y == last.y && w.z == last.z;
      group.push_back(same ? group.back() : GainOf(w));
      last = w;
    }
    samples.gain_group = group.data();
    samples.gain = gains_.data();
  }
  ModelValues(samples, model_, 0, directions.count, readings);
}

}  // namespace lobefit
