#include "lobefit/measurement/prepare/pool.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/statistics.h"
#include "lobefit/measurement/pair_index.h"
#include "lobefit/measurement/prepare/repeats.h"

namespace lobefit {
namespace {

[[noreturn]] void Refuse(const Measurement& a, const Measurement& b, const std::string& what) {
  throw InputError(a.source + " and " + b.source + " do not go together: " + what);
}

bool SameChannels(const Channels& a, const Channels& b) {
  if (a.names == b.names) return true;
  if (a.size() != b.size() || a.wavelengths_nm.empty() || b.wavelengths_nm.empty()) return false;
  // A lamp's wavelength is not the same to the last digit in each file.
  for (std::size_t c = 0; c < a.size(); ++c) {
    if (std::fabs(a.wavelengths_nm[c] - b.wavelengths_nm[c]) > 1e-3 * a.wavelengths_nm[c]) return false;
  }
  return true;
}

bool HasOneWavelength(const Measurement& part) {
  return part.channels.size() == 1 && part.channels.wavelengths_nm.size() == 1;
}

void RequireSameKind(const Measurement& a, const Measurement& b) {
  if (a.samples.solid_angle.empty() != b.samples.solid_angle.empty())
    Refuse(a, b, "one is a table of cells (" + a.format + "), the other a list of samples (" + b.format + ")");
  if (a.instrument != b.instrument)
    Refuse(a, b,
           "they state different half angles or means of the instrument; leave the keys source, detector, mean, drift, "
           "alignment, offset and noise "
           "out of the files, or fit each by itself");
  if (a.isotropic != b.isotropic)
    Refuse(a, b, "one is isotropic by construction, the other states azimuths of the light");
}

template <class T>
void MoveBehind(std::vector<T>* to, std::vector<T>&& from) {
  to->insert(to->end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

// Where some parts state a standard deviation and others do not, theirs is taken to be the middle one.
void FillSigma(Samples* a, Samples* b) {
  if (a->sigma.empty() && !b->sigma.empty()) a->sigma.assign(a->size(), Median(b->sigma));
  if (b->sigma.empty() && !a->sigma.empty()) b->sigma.assign(b->size(), Median(a->sigma));
}

void AppendSamples(Samples&& from, Samples* to) {
  FillSigma(to, &from);
  // A part without weights counts as the mean of those that have them, which is 1.
  if (to->weight.empty() && !from.weight.empty()) to->weight.assign(to->size(), 1.0);
  if (!to->weight.empty() && from.weight.empty()) from.weight.assign(from.size(), 1.0);
  if (to->sample_azimuth.empty() && !from.sample_azimuth.empty()) to->sample_azimuth.assign(to->size(), 0.0);
  if (!to->sample_azimuth.empty() && from.sample_azimuth.empty()) from.sample_azimuth.assign(from.size(), 0.0);
  MoveBehind(&to->file, std::move(from.file));
  MoveBehind(&to->sample_azimuth, std::move(from.sample_azimuth));
  MoveBehind(&to->wi_x, std::move(from.wi_x));
  MoveBehind(&to->wi_y, std::move(from.wi_y));
  MoveBehind(&to->wi_z, std::move(from.wi_z));
  MoveBehind(&to->wo_x, std::move(from.wo_x));
  MoveBehind(&to->wo_y, std::move(from.wo_y));
  MoveBehind(&to->wo_z, std::move(from.wo_z));
  for (std::size_t c = 0; c < to->values.size(); ++c) MoveBehind(&to->values[c], std::move(from.values[c]));
  MoveBehind(&to->weight, std::move(from.weight));
  MoveBehind(&to->sigma, std::move(from.sigma));
  MoveBehind(&to->solid_angle, std::move(from.solid_angle));
  MoveBehind(&to->origin, std::move(from.origin));
}

// Parts of one wavelength each as channels, ascending; a sample keeps the line of the first part that has it.
Samples JoinWavelengths(const std::vector<Measurement>& parts, const std::vector<std::size_t>& order) {
  Samples joined;
  joined.values.resize(parts.size());
  PairIndex index;
  std::vector<double> weights, variances;
  std::vector<std::size_t> counts;
  bool weighted = false, stated = true;
  for (std::size_t channel = 0; channel < order.size(); ++channel) {
    const Samples& samples = parts[order[channel]].samples;
    weighted = weighted || !samples.weight.empty();
    stated = stated && !samples.sigma.empty();
    const std::vector<double> none(parts.size(), std::nan(""));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::size_t at = index.FindOrAdd(samples.wi(i), samples.wo(i));
      if (at == joined.size()) {
        joined.Append(samples.wi(i), samples.wo(i), none.data(), samples.origin[i]);
        weights.push_back(0);
        variances.push_back(0);
        counts.push_back(0);
      }
      joined.values[channel][at] = samples.values[0][i];
      weights[at] += samples.weight.empty() ? 1.0 : samples.weight[i];
      if (stated) variances[at] += samples.sigma[i] * samples.sigma[i];
      ++counts[at];
    }
  }
  if (weighted) {
    for (std::size_t i = 0; i < weights.size(); ++i)
      joined.weight.push_back(weights[i] / static_cast<double>(counts[i]));
  }
  for (std::size_t i = 0; stated && i < variances.size(); ++i) {
    joined.sigma.push_back(std::sqrt(variances[i] / static_cast<double>(counts[i])));
  }
  return joined;
}

void MergeWords(const std::vector<Measurement>& parts, Measurement* pooled) {
  for (const Measurement& part : parts) {
    for (const auto& [name, value] : part.conventions) {
      std::string& all = pooled->conventions[name];
      if (all.empty()) {
        all = value;
        // Parts before this one that do not say it.
        for (const Measurement& other : parts) {
          if (&other == &part) break;
          all = "as each file states";
        }
      } else if (all != value) {
        all = "as each file states";
      }
    }
    for (const std::string& comment : part.comments) {
      const bool of_all = std::all_of(parts.begin(), parts.end(), [&](const Measurement& other) {
        return std::find(other.comments.begin(), other.comments.end(), comment) != other.comments.end();
      });
      if (!of_all) {
        pooled->comments.push_back(part.source + ": " + comment);
      } else if (&part == parts.data()) {
        pooled->comments.push_back(comment);
      }
    }
    for (const std::string& remark : part.remarks) {
      const std::string own = part.source + ": " + remark;
      const bool known = std::any_of(parts.begin(), parts.end(), [&](const Measurement& other) {
        return &other < &part && std::find(other.remarks.begin(), other.remarks.end(), remark) != other.remarks.end();
      });
      if (!known) pooled->remarks.push_back(own);
    }
  }
}

}  // namespace

Measurement Pool(std::vector<Measurement> parts, bool merge_repeated) {
  if (parts.size() == 1) return std::move(parts[0]);
  Measurement pooled;
  bool same = true;
  std::string digests;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    RequireSameKind(parts[0], parts[p]);
    same = same && SameChannels(parts[0].channels, parts[p].channels);
    digests += parts[p].sha256;
    for (const LeftOut& one : parts[p].left_out) pooled.LeaveOut(one.wi, one.wo, one.reason);
    for (int r = 0; r < kSetAsideReasons; ++r) {
      const auto reason = static_cast<SetAsideReason>(r);
      pooled.set_aside.Add(reason, parts[p].set_aside[reason]);
    }
  }
  MergeWords(parts, &pooled);
  pooled.isotropic = parts[0].isotropic;
  pooled.instrument = parts[0].instrument;
  pooled.format = parts[0].format;
  for (const Measurement& part : parts) {
    if (part.format != pooled.format) pooled.format = "several";
  }
  pooled.sha256 = Sha256Hex(digests);
  pooled.source = parts[0].source + " and " + std::to_string(parts.size() - 1) + " more";

  if (!same) {
    for (const Measurement& part : parts) {
      if (HasOneWavelength(part) && HasOneWavelength(parts[0])) continue;
      if (SameChannels(part.channels, parts[0].channels)) continue;
      Refuse(parts[0], part,
             "the channels are " + Excerpt(lobefit::Join(parts[0].channels.names), 60) + " and " +
                 Excerpt(lobefit::Join(part.channels.names), 60));
    }
    // Of one wavelength the parts come one after the other first.
    std::vector<Measurement> by_wavelength;
    for (Measurement& part : parts) {
      const auto known = std::find_if(by_wavelength.begin(), by_wavelength.end(), [&](const Measurement& other) {
        return SameChannels(other.channels, part.channels);
      });
      if (known == by_wavelength.end()) {
        by_wavelength.push_back(std::move(part));
      } else {
        AppendSamples(std::move(part.samples), &known->samples);
      }
    }
    std::vector<std::size_t> order(by_wavelength.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return by_wavelength[a].channels.wavelengths_nm[0] < by_wavelength[b].channels.wavelengths_nm[0];
    });
    for (const std::size_t p : order) {
      pooled.channels.names.push_back(by_wavelength[p].channels.names[0]);
      pooled.channels.wavelengths_nm.push_back(by_wavelength[p].channels.wavelengths_nm[0]);
    }
    pooled.samples = JoinWavelengths(by_wavelength, order);
    return pooled;
  }

  for (std::size_t p = 0; p < parts.size(); ++p)
    parts[p].samples.file.assign(parts[p].samples.size(), static_cast<std::uint32_t>(p));
  pooled.channels = parts[0].channels;
  pooled.samples = std::move(parts[0].samples);
  for (std::size_t p = 1; p < parts.size(); ++p) AppendSamples(std::move(parts[p].samples), &pooled.samples);
  if (merge_repeated) {
    const Repeats repeats = MergeRepeated(&pooled);
    if (repeats.pairs > 0) {
      pooled.remarks.push_back(std::to_string(repeats.samples) +
                               " samples of directions that several files have were merged to " +
                               std::to_string(repeats.pairs) + "; one scatters by " +
                               FormatDouble(std::round(1000 * repeats.relative_spread) / 10) + " % of their mean");
    }
    return pooled;
  }
  MeasurementBuilder builder(pooled.channels);
  builder.measurement() = std::move(pooled);
  return builder.Finish();
}

}  // namespace lobefit
