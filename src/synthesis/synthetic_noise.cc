// The terms of Noise: their table, their words, and what they do.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/synthesis/random.h"
#include "lobefit/synthesis/synthesis.h"

namespace lobefit {
namespace {

// Streams of the random terms. The first is the seed itself.
enum Stream : std::uint64_t { kDrift = 1, kPoisson, kOutliers, kHoles, kMisalignment };

double OutsideFactor(const NoiseTerm& term) { return std::string(term.unit) == "deg" ? kPi / 180 : 1; }

void AddDrift(double deviation, std::uint64_t seed, Samples* samples) {
  RandomNumbers random(StreamSeed(seed, kDrift));
  std::map<std::array<double, 3>, double> gain;
  for (std::size_t i = 0; i < samples->size(); ++i) {
    const auto [entry, is_new] = gain.try_emplace({samples->wi_x[i], samples->wi_y[i], samples->wi_z[i]}, 0.0);
    if (is_new) entry->second = 1 + deviation * random.Normal();
    for (std::vector<double>& values : samples->values) values[i] *= entry->second;
  }
}

void AddOutliers(double share, std::uint64_t seed, Samples* samples) {
  RandomNumbers random(StreamSeed(seed, kOutliers));
  for (std::size_t i = 0; i < samples->size(); ++i) {
    const double hit = random.Uniform(), power = random.Uniform(-1, 1);
    if (hit >= share) continue;
    for (std::vector<double>& values : samples->values) values[i] *= std::pow(10, power);
  }
}

void MakeHoles(double share, std::uint64_t seed, Measurement* measurement) {
  RandomNumbers random(StreamSeed(seed, kHoles));
  std::vector<std::uint8_t> keep(measurement->samples.size());
  for (std::uint8_t& k : keep) k = random.Uniform() >= share ? 1 : 0;
  measurement->set_aside.Add(SetAsideReason::kHole,
                             static_cast<std::size_t>(std::count(keep.begin(), keep.end(), std::uint8_t{0})));
  measurement->samples.Keep(keep);
}

}  // namespace

const std::vector<NoiseTerm>& NoiseTerms() {
  static const std::vector<NoiseTerm> terms = {
      {"multiplicative", "1", &Noise::multiplicative, nullptr, 10, false, "standard deviation of a factor a value"},
      {"additive", "1/sr", &Noise::additive, nullptr, 1e6, false, "standard deviation of a term a value"},
      {"drift", "1", &Noise::drift, nullptr, 10, false, "standard deviation of a factor an incident direction"},
      {"poisson", "1/sr", &Noise::poisson, nullptr, 1e6, false, "f_r cos(theta_i) of one count"},
      {"outliers", "1", &Noise::outliers, nullptr, 1, false, "share of samples off by a factor of up to 10"},
      {"rectified", "flag", nullptr, &Noise::rectified, 1, false, "only the magnitude of a value is kept"},
      {"quantisation", "1/sr", &Noise::quantisation, nullptr, 1e6, false, "step of the values"},
      {"holes", "1", &Noise::holes, nullptr, 0.99, false, "share of samples that are missing"},
      {"aperture", "deg", &Noise::aperture, nullptr, 30, false, "half angle of the detector's disc"},
      {"across", "deg", &Noise::across, nullptr, 30, false, "half angle across of a rectangular detector"},
      {"source", "deg", &Noise::source, nullptr, 30, false, "half angle of the source's disc"},
      {"plain-mean", "flag", nullptr, &Noise::plain_mean, 1, false, "discs average f_r, not the flux"},
      {"misalignment-x", "deg", &Noise::misalignment_x, nullptr, 45, true, "turn of the sample about x"},
      {"misalignment-y", "deg", &Noise::misalignment_y, nullptr, 45, true, "turn of the sample about y"},
      {"misalignment", "deg", &Noise::misalignment, nullptr, 10, false,
       "standard deviation of turns about x and y, drawn once a measurement"},
  };
  return terms;
}

Noise ParseNoise(const std::string& text) {
  Noise noise;
  if (Trim(text).empty() || Trim(text) == "none") return noise;
  std::vector<std::string> names;
  for (const NoiseTerm& term : NoiseTerms()) names.emplace_back(term.name);
  for (const std::string_view piece : Split(text, ',')) {
    const std::size_t equals = piece.find('=');
    const std::string name(Trim(piece.substr(0, equals)));
    const auto found = std::find_if(NoiseTerms().begin(), NoiseTerms().end(),
                                    [&](const NoiseTerm& term) { return name == term.name; });
    if (found == NoiseTerms().end()) {
      throw UsageError(fmt::format("noise term '{}' is unknown{}; allowed: {}", Excerpt(name), DidYouMean(name, names),
                                   Join(names)));
    }
    if (found->flag != nullptr) {
      if (equals != std::string_view::npos)
        throw UsageError(fmt::format("noise term '{}' takes no value; write it alone", name));
      noise.*(found->flag) = true;
      continue;
    }
    const std::optional<double> value =
        equals == std::string_view::npos ? std::nullopt : ParseDouble(piece.substr(equals + 1));
    const double lowest = found->negative ? -found->highest : 0;
    if (!value || !(*value >= lowest && *value <= found->highest)) {
      throw UsageError(fmt::format(
          "noise term '{}': '{}' is not allowed; write {}=NUMBER with a number in [{:g}, {:g}]{}", name, Excerpt(piece),
          name, lowest, found->highest, std::string(found->unit) == "deg" ? " degrees" : ""));
    }
    noise.*(found->value) = *value * OutsideFactor(*found);
  }
  return noise;
}

std::string ToText(const Noise& noise) {
  std::vector<std::string> words;
  for (const NoiseTerm& term : NoiseTerms()) {
    if (term.flag != nullptr) {
      if (noise.*(term.flag)) words.emplace_back(term.name);
    } else if (noise.*(term.value) != 0) {
      words.push_back(fmt::format("{}={:.12g}", term.name, noise.*(term.value) / OutsideFactor(term)));
    }
  }
  return words.empty() ? "none" : Join(words, ",");
}

Noise DrawnNoise(const Noise& noise, std::uint64_t seed) {
  Noise drawn = noise;
  RandomNumbers random(StreamSeed(seed, kMisalignment));
  drawn.misalignment_x += noise.misalignment * random.Normal();
  drawn.misalignment_y += noise.misalignment * random.Normal();
  drawn.misalignment = 0;
  return drawn;
}

void AddNoise(const Noise& noise, std::uint64_t seed, Measurement* measurement) {
  Samples& samples = measurement->samples;
  if (noise.drift > 0) AddDrift(noise.drift, seed, &samples);
  if (noise.poisson > 0) {
    RandomNumbers random(StreamSeed(seed, kPoisson));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double unit = noise.poisson / samples.wi_z[i];
      for (std::vector<double>& values : samples.values) values[i] = unit * random.Poisson(values[i] / unit);
    }
  }
  RandomNumbers random(seed);
  for (std::size_t i = 0; i < samples.size() && (noise.multiplicative > 0 || noise.additive > 0); ++i) {
    for (std::vector<double>& values : samples.values) {
      if (noise.multiplicative > 0) values[i] *= 1 + noise.multiplicative * random.Normal();
      if (noise.additive > 0) values[i] += noise.additive * random.Normal();
    }
  }
  if (noise.outliers > 0) AddOutliers(noise.outliers, seed, &samples);
  for (std::vector<double>& values : samples.values) {
    for (double& value : values) {
      if (noise.rectified) value = std::fabs(value);
      if (noise.quantisation > 0) value = std::round(value / noise.quantisation) * noise.quantisation;
    }
  }
  if (noise.holes > 0) MakeHoles(noise.holes, seed, measurement);
}

}  // namespace lobefit
