#include "lobefit/measurement/prepare/polarisation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/measurement/pair_index.h"

namespace lobefit {
namespace {

void KeepOne(const std::vector<std::uint8_t>& polarisation, std::size_t chosen, Measurement* measurement) {
  std::vector<std::uint8_t> keep(polarisation.size());
  std::size_t others = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    keep[i] = polarisation[i] == chosen ? 1 : 0;
    others += keep[i] == 0 ? 1 : 0;
  }
  measurement->samples.Keep(keep);
  measurement->set_aside.Add(SetAsideReason::kOutsideSelection, others);
}

// "ss", "s-p", "p/s", "p p": the light's and the viewer's, of the same two letters.
bool AreOfBothSides(const std::vector<std::string>& names) {
  std::set<std::string> pairs, letters;
  for (const std::string& name : names) {
    std::string pair;
    for (const char c : name) {
      if (std::isalpha(static_cast<unsigned char>(c)) != 0) pair += c;
    }
    if (pair.size() != 2) return false;
    letters.insert(pair.substr(0, 1));
    letters.insert(pair.substr(1));
    pairs.insert(std::move(pair));
  }
  return names.size() == 4 && pairs.size() == 4 && letters.size() == 2;
}

}  // namespace

bool IsUnpolarised(std::string_view name) {
  static constexpr std::array<std::string_view, 14> kNames = {"u",    "unpol",  "unpol.",  "unpolarized", "unpolarised",
                                                              "none", "random", "avg",     "average",     "mean",
                                                              "n",    "no",     "natural", "np"};
  return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

std::string AverageOverPolarisation(const std::vector<std::uint8_t>& polarisation,
                                    const std::vector<std::string>& names, Measurement* measurement) {
  if (names.size() < 2) return "";
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (!IsUnpolarised(names[n])) continue;
    KeepOne(polarisation, n, measurement);
    return "of the polarisations, that named '" + Excerpt(names[n]) + "' is used";
  }
  if (names.size() > 2 && !AreOfBothSides(names)) {
    std::vector<std::string> some;
    for (std::size_t n = 0; n < std::min<std::size_t>(names.size(), 6); ++n) some.push_back(Excerpt(names[n], 20));
    throw InputError("rows have " + std::to_string(names.size()) + " polarisations (" + Join(some) +
                     "); choose one with --where");
  }
  Samples& samples = measurement->samples;
  PairIndex index(samples.size());
  struct Group {
    std::size_t first = 0;
    std::array<std::size_t, 4> counts = {};
  };
  std::vector<Group> groups;
  std::vector<std::size_t> group_of(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    group_of[i] = index.FindOrAdd(samples.wi(i), samples.wo(i));
    if (group_of[i] == groups.size()) groups.push_back({i, {}});
    ++groups[group_of[i]].counts[polarisation[i]];
  }
  // Sums over the samples of a pair, each polarisation with half of the weight (four are the light's two times two
  // behind the sample), gathered at the pair's first sample.
  const auto average = [&](std::vector<double>* array) {
    std::vector<double> sums(groups.size(), 0);
    for (std::size_t i = 0; i < array->size(); ++i) {
      sums[group_of[i]] += 0.5 * (*array)[i] / static_cast<double>(groups[group_of[i]].counts[polarisation[i]]);
    }
    for (std::size_t g = 0; g < groups.size(); ++g) (*array)[groups[g].first] = sums[g];
  };
  for (std::vector<double>& values : samples.values) average(&values);
  if (!samples.weight.empty()) average(&samples.weight);
  std::vector<std::uint8_t> keep(samples.size(), 0);
  std::size_t incomplete = 0;
  for (const Group& group : groups) {
    const bool all = std::all_of(group.counts.begin(), group.counts.begin() + static_cast<std::ptrdiff_t>(names.size()),
                                 [](std::size_t count) { return count > 0; });
    keep[group.first] = all ? 1 : 0;
    incomplete += all ? 0 : 1;
  }
  samples.Keep(keep);
  measurement->set_aside.Add(SetAsideReason::kHole, incomplete);
  if (names.size() == 4) {
    return "half of the sum over the polarisations before and behind the sample (" + Excerpt(Join(names), 40) +
           ") is f_r of unpolarised light";
  }
  return "the rows of the polarisations '" + Excerpt(names[0]) + "' and '" + Excerpt(names[1]) +
         "' were averaged to f_r of unpolarised light";
}

}  // namespace lobefit
