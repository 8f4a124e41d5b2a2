#include "lobefit/io/csv/rows/wavelengths.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostWavelengths = 4096;

}  // namespace

void WavelengthTable::Add(const Row& row) {
  const auto [number, is_new] = numbers_.try_emplace(row.nm, static_cast<std::uint32_t>(numbers_.size()));
  const std::size_t pair = pairs_.FindOrAdd(row.wi, row.wo);
  if (pair == pair_directions_.size()) pair_directions_.push_back({row.wi, row.wo});
  entries_.push_back({static_cast<std::uint32_t>(pair), number->second, row.line, row.value, row.weight});
}

WavelengthTable::Grouping WavelengthTable::Apart() const {
  Grouping apart;
  apart.channel.resize(numbers_.size());
  for (const auto& [nm, number] : numbers_) {
    apart.channel[number] = static_cast<std::uint32_t>(apart.nm.size());
    apart.nm.push_back(nm);
  }
  return apart;
}

WavelengthTable::Grouping WavelengthTable::Within(double tolerance_nm) const {
  Grouping grouping;
  grouping.channel.resize(numbers_.size());
  for (auto first = numbers_.begin(); first != numbers_.end();) {
    double sum = 0, count = 0;
    auto last = first;
    // Nanometres of rows are rounded to 1e-6.
    for (; last != numbers_.end() && last->first - first->first <= tolerance_nm + 1e-7; ++last, ++count) {
      grouping.channel[last->second] = static_cast<std::uint32_t>(grouping.nm.size());
      sum += last->first;
    }
    grouping.nm.push_back(std::round(sum / count * 1e4) / 1e4);
    first = last;
  }
  return grouping;
}

bool WavelengthTable::HasPairAtTwo(const Grouping& grouping) const {
  // Pair by pair: a table of pairs times channels may be far larger than the file.
  std::vector<std::size_t> next(pair_directions_.size() + 1, 0);
  for (const Entry& entry : entries_) ++next[entry.pair + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<const Entry*> by_pair(entries_.size());
  for (const Entry& entry : entries_) by_pair[next[entry.pair]++] = &entry;
  std::vector<const Entry*> last(grouping.nm.size(), nullptr);
  return std::any_of(by_pair.begin(), by_pair.end(), [&](const Entry* entry) {
    const Entry* before = std::exchange(last[grouping.channel[entry->wavelength]], entry);
    return before != nullptr && before->pair == entry->pair && before->wavelength != entry->wavelength;
  });
}

std::optional<WavelengthTable::Grouping> WavelengthTable::Wandering() const {
  constexpr double kMostWidth = 0.01;  // of the wavelength
  const std::vector<std::pair<double, std::uint32_t>> sorted(numbers_.begin(), numbers_.end());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < sorted.size(); ++i) gaps.push_back(sorted[i].first - sorted[i - 1].first);
  if (gaps.empty()) return std::nullopt;
  std::sort(gaps.begin(), gaps.end());
  // The largest jump between sizes of gaps tells those within a channel from those between channels.
  double between = std::numeric_limits<double>::infinity(), jump = 2;
  if (sorted.back().first - sorted.front().first > kMostWidth * sorted.front().first) {
    between = 0;
    for (std::size_t i = 1; i < gaps.size(); ++i) {
      if (gaps[i] <= jump * gaps[i - 1]) continue;
      jump = gaps[i] / gaps[i - 1];
      between = gaps[i];
    }
  }
  if (!(between > 0)) return std::nullopt;
  Grouping grouping;
  grouping.channel.resize(sorted.size());
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    double sum = 0;
    for (end = begin; end < sorted.size() && (end == begin || sorted[end].first - sorted[end - 1].first < between);
         ++end) {
      grouping.channel[sorted[end].second] = static_cast<std::uint32_t>(grouping.nm.size());
      sum += sorted[end].first;
    }
    const double width = sorted[end - 1].first - sorted[begin].first;
    if (2 * width >= between || width > kMostWidth * sorted[begin].first) return std::nullopt;
    // As many digits as the channels need to be told apart by.
    grouping.nm.push_back(std::round(sum / static_cast<double>(end - begin) * 100) / 100);
  }
  if (grouping.nm.size() > kMostWavelengths || HasPairAtTwo(grouping)) return std::nullopt;
  return grouping;
}

Measurement WavelengthTable::Gather(bool keep_repeats, std::optional<double> tolerance_nm) const {
  constexpr std::size_t kMostValues = std::size_t{1} << 28;
  // Where most of the values would be unknown.
  constexpr std::size_t kMostSparse = std::size_t{1} << 24, kMostPerRow = 16;
  const std::optional<Grouping> wandering = tolerance_nm ? Within(*tolerance_nm) : Wandering();
  const Grouping grouping = wandering ? *wandering : Apart();
  const std::size_t channels = grouping.nm.size();
  if (channels > kMostWavelengths) {
    throw InputError(std::to_string(channels) + " different wavelengths at " + std::to_string(pair_directions_.size()) +
                     " pairs of directions; at most " + std::to_string(kMostWavelengths) +
                     " channels are read: if the wavelength wanders from row to row, --wavelength-tolerance NM makes "
                     "one channel of those that differ by no more");
  }
  if (channels > 0 && pair_directions_.size() > kMostValues / channels) {
    throw InputError(std::to_string(channels) + " wavelengths at " + std::to_string(pair_directions_.size()) +
                     " pairs of directions are more values than are read; choose rows with --where");
  }
  const std::size_t cells = channels * pair_directions_.size();
  if (cells > kMostSparse && cells / kMostPerRow > entries_.size()) {
    throw InputError(std::to_string(channels) + " wavelengths at " + std::to_string(pair_directions_.size()) +
                     " pairs of directions, but only " + std::to_string(entries_.size()) +
                     " rows: most pairs lack most wavelengths; choose those of one wavelength with --where, or make "
                     "one channel of wavelengths that wander with --wavelength-tolerance NM");
  }
  struct Sample {
    std::uint32_t pair = 0, line = 0, rows = 0, next = 0;  // next: of the same pair, 0 is none
    double weights = 0;
    bool is_repeat = false;
  };
  std::vector<Sample> samples;
  std::vector<double> values;
  std::vector<std::uint8_t> present;
  std::vector<std::uint32_t> first(pair_directions_.size(), std::numeric_limits<std::uint32_t>::max());
  const auto open_sample = [&](const Entry& entry) {
    samples.push_back({entry.pair, entry.line});
    values.resize(values.size() + channels, std::nan(""));
    present.resize(present.size() + channels, 0);
    return static_cast<std::uint32_t>(samples.size() - 1);
  };
  Channels names;
  for (const double nm : grouping.nm) {
    names.names.push_back(FormatDouble(nm) + "nm");
    names.wavelengths_nm.push_back(nm);
  }
  MeasurementBuilder builder(std::move(names));
  for (const Entry& entry : entries_) {
    const std::size_t channel = grouping.channel[entry.wavelength];
    if (first[entry.pair] == std::numeric_limits<std::uint32_t>::max()) first[entry.pair] = open_sample(entry);
    std::uint32_t at = first[entry.pair];
    bool repeated = false;
    while (present[at * channels + channel] != 0) {
      repeated = true;
      if (!keep_repeats) break;
      if (samples[at].next == 0) {
        const std::uint32_t opened = open_sample(entry);
        samples[opened].is_repeat = true;
        samples[at].next = opened;
      }
      at = samples[at].next;
    }
    if (repeated && !keep_repeats) {
      builder.Skip(SetAsideReason::kDuplicate);
      continue;
    }
    values[at * channels + channel] = entry.value;
    present[at * channels + channel] = 1;
    samples[at].weights += weights_ == Weights::kSigma ? entry.weight * entry.weight : entry.weight;
    ++samples[at].rows;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Pair& pair = pair_directions_[samples[i].pair];
    // A repeat that lacks a wavelength would make that of the mean unknown.
    if (samples[i].is_repeat && samples[i].rows < channels) {
      builder.Skip(SetAsideReason::kHole);
      continue;
    }
    if (!builder.Add(pair.wi, pair.wo, values.data() + i * channels, samples[i].line) || weights_ == Weights::kNone)
      continue;
    const double mean = samples[i].weights / samples[i].rows;
    builder.measurement().samples.weight.push_back(weights_ == Weights::kSigma ? std::sqrt(mean) : mean);
  }
  return std::move(builder.measurement());
}

}  // namespace lobefit
