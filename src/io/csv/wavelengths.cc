#include "lobefit/io/csv/wavelengths.h"

#include <cmath>

#include "lobefit/base/text.h"

namespace lobefit {

bool WavelengthTable::Add(const Row& row) {
  const auto [channel, is_new] = channels_.try_emplace(row.nm, columns_.size());
  if (is_new) columns_.emplace_back();
  std::vector<double>& column = columns_[channel->second];

  const auto open_sample = [&] {
    samples_.push_back({row.wi, row.wo, row.line});
    return static_cast<std::uint32_t>(samples_.size() - 1);
  };
  const std::size_t pair = pairs_.FindOrAdd(row.wi, row.wo);
  if (pair == first_sample_.size()) first_sample_.push_back(open_sample());
  std::uint32_t at = first_sample_[pair];
  while (at < column.size() && !std::isnan(column[at])) {
    if (!keep_repeats_) return false;
    if (samples_[at].next_repeat == 0) {
      const std::uint32_t opened = open_sample();
      samples_[at].next_repeat = opened;
    }
    at = samples_[at].next_repeat;
  }
  if (column.size() <= at) column.resize(at + std::size_t{1}, std::nan(""));
  column[at] = row.value;
  samples_[at].weights += weights_ == Weights::kSigma ? row.weight * row.weight : row.weight;
  ++samples_[at].rows;
  return true;
}

Channels WavelengthTable::ChannelNames() const {
  Channels channels;
  for (const auto& [nm, column] : channels_) {
    channels.names.push_back(FormatDouble(nm) + "nm");
    channels.wavelengths_nm.push_back(nm);
  }
  return channels;
}

void WavelengthTable::MoveTo(MeasurementBuilder* builder) const {
  std::vector<double> values(channels_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Sample& sample = samples_[i];
    if (sample.rows < channels_.size()) {
      builder->Skip(SetAsideReason::kHole);
      continue;
    }
    std::size_t channel = 0;
    for (const auto& [nm, column] : channels_) values[channel++] = columns_[column][i];
    if (!builder->Add(sample.wi, sample.wo, values.data(), sample.line) || weights_ == Weights::kNone) continue;
    const double mean = sample.weights / sample.rows;
    builder->measurement().samples.weight.push_back(weights_ == Weights::kSigma ? std::sqrt(mean) : mean);
  }
}

}  // namespace lobefit
