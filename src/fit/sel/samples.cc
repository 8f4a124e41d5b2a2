#include "lobefit/fit/sel/samples.h"

namespace lobefit {

SelSamples SelSamples::Subset(const std::vector<std::size_t>& indices) const {
  SelSamples subset;
  subset.f_r.resize(channels());
  for (const std::size_t i : indices) {
    subset.v.push_back(v[i]);
    subset.cos_i.push_back(cos_i[i]);
    subset.cos_o.push_back(cos_o[i]);
    subset.weight.push_back(weight[i]);
    for (std::size_t c = 0; c < channels(); ++c) subset.f_r[c].push_back(f_r[c][i]);
  }
  return subset;
}

SelSamples SelSamples::WithMirrorImages() const {
  std::vector<std::size_t> twice;
  for (std::size_t i = 0; i < size(); ++i) twice.insert(twice.end(), {i, i});
  SelSamples both = Subset(twice);
  for (std::size_t i = 1; i < both.size(); i += 2) both.v[i].y = -both.v[i].y;
  return both;
}

SelSamples SelSamples::Mean() const {
  SelSamples mean = *this;
  mean.f_r.assign(1, std::vector<double>(size(), 0.0));
  for (const std::vector<double>& values : f_r) {
    for (std::size_t i = 0; i < size(); ++i) mean.f_r[0][i] += values[i] / static_cast<double>(channels());
  }
  return mean;
}

}  // namespace lobefit
