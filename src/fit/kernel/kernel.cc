#include "lobefit/fit/kernel/kernel.h"

#include <algorithm>
#include <unordered_map>

#include "lobefit/fit/kernel/kernel_arrays.h"
#include "lobefit/fit/kernel/kernel_block.h"

namespace lobefit {

std::size_t KernelModel::shape_columns() const {
  std::size_t sum = 0;
  for (const KernelLobe& lobe : lobes) sum += lobe.columns;
  return sum + alignment.angles.size() + half_angles.size();
}

std::size_t KernelModel::columns() const {
  std::size_t sum = shape_columns() + (diffuse.empty() ? 0 : DiffuseParameters(diffuse_kind)) +
                    (offset.empty() ? 0 : 1) + (gains ? 1 : 0) + 1;
  for (const KernelLobe& lobe : lobes) sum += FresnelParameters(lobe.kind.fresnel);
  return sum;
}

void Accumulate(const KernelSamples& samples, const KernelModel& model, bool gradient, std::size_t begin,
                std::size_t end, KernelSums* sums) {
  Block block(samples, model, gradient);
  const std::size_t columns = model.columns();
  if (gradient && sums->gram.empty())
    sums->gram.assign(model.channels, std::vector<double>(columns * (columns + 1) / 2, 0.0));
  const bool arrows = gradient && model.gains && samples.gain != nullptr;
  std::unordered_map<std::uint32_t, std::size_t> place;
  for (std::size_t i = begin; i < end; i += kBlock) {
    block.Evaluate(i, std::min(kBlock, end - i));
    sums->sum_rho += block.Residuals(i, &sums->sum_robust_weight);
    for (std::size_t c = 0; gradient && c < model.channels; ++c) {
      const double* from = block.Columns(c);
      arrays::AddGram(from, columns, block.padded(), kBlock, sums->gram[c].data());
      if (!arrows) continue;
      block.reading().AddGainProducts(c, from, columns, [&](std::uint32_t group) {
        const auto [found, is_new] = place.try_emplace(group, sums->arrows.size());
        if (is_new) sums->arrows.push_back({group, std::vector<double>(model.channels * columns, 0.0)});
        return sums->arrows[found->second].products.data() + c * columns;
      });
    }
  }
}

void SumGains(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
              GainSums* sums) {
  Block block(samples, model, false, true);
  double unused = 0;
  for (std::size_t i = begin; i < end; i += kBlock) {
    block.Evaluate(i, std::min(kBlock, end - i));
    sums->sum_of_squares += block.Residuals(i, &unused);
    for (std::size_t c = 0; c < model.channels; ++c) {
      block.reading().AddGainProducts(c, block.reading().gain_column(c), 1,
                                      [&](std::uint32_t g) { return &sums->curvature[g]; });
      block.reading().AddGainProducts(c, block.residual(c), 1, [&](std::uint32_t g) { return &sums->slope[g]; });
      for (std::size_t k = 0; k < block.padded(); ++k) {
        const double product = block.reading().gain_column(c)[k] * block.residual(c)[k];
        sums->weighted_squares += product * product;
      }
    }
  }
}

namespace {

// Calls each(place, count, channel, columns) for the columns of every block and channel of samples [begin, end);
// `place` counts from `begin`, columns are kBlock apart.
template <class Each>
void ForColumns(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
                const Each& each) {
  Block block(samples, model, true);
  double unused = 0;
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    block.Evaluate(i, count);
    block.Residuals(i, &unused);
    for (std::size_t c = 0; c < model.channels; ++c) each(i - begin, count, c, block.Columns(c));
  }
}

}  // namespace

void Scores(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
            std::vector<std::vector<double>>* scores) {
  const std::size_t shape = model.shape_columns(), residual_column = model.columns() - 1,
                    linear = residual_column - shape;
  scores->assign(shape + linear * model.channels, std::vector<double>(end - begin, 0.0));
  ForColumns(samples, model, begin, end, [&](std::size_t place, std::size_t count, std::size_t c, const double* from) {
    const double* residual = from + residual_column * kBlock;
    for (std::size_t j = 0; j < residual_column; ++j) {
      std::vector<double>& to = (*scores)[j < shape ? j : j + c * linear];
      for (std::size_t k = 0; k < count; ++k) to[place + k] += from[j * kBlock + k] * residual[k];
    }
  });
}

void Columns(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
             std::vector<std::vector<double>>* columns) {
  const std::size_t all = end - begin;
  columns->assign(model.channels, std::vector<double>(model.columns() * all));
  ForColumns(samples, model, begin, end, [&](std::size_t place, std::size_t count, std::size_t c, const double* from) {
    for (std::size_t j = 0; j < model.columns(); ++j)
      std::copy_n(from + j * kBlock, count, (*columns)[c].data() + j * all + place);
  });
}

void ModelValues(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
                 std::vector<std::vector<double>>* values) {
  values->assign(model.channels, std::vector<double>(end - begin));
  Block block(samples, model, false);
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    block.Evaluate(i, count);
    for (std::size_t c = 0; c < model.channels; ++c) {
      std::copy_n(block.f(c), count, (*values)[c].begin() + static_cast<std::ptrdiff_t>(i - begin));
    }
  }
}

}  // namespace lobefit
