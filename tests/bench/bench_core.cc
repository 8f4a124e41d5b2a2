// Evaluations a second of the GGX lobe of the BRDF, value and value + gradient in the five shape coordinates: scalar,
// SIMD, and with ceres::Jet, printed as ratios measured in one run on one thread.
//
// "Jets" are the same operations as the fast path with a Jet for a number and everything that does not depend on the
// sample taken out of the loop: the hardest competitor. "Jets, definition" is the formula as the tests have it, which
// is what a cost function for automatic differentiation would look like.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <ceres/jet.h>
#include <hwy/base.h>

#include "lobefit/core/brdf/ggx_lobe.h"
#include "lobefit/core/ndf/slope_ndf.h"

namespace lobefit {
namespace {

namespace jets {

using Jet = ceres::Jet<double, 5>;

inline Jet Root(const Jet& x) { return sqrt(x); }
inline Jet Constant(const Jet& /*like*/, double value) { return Jet(value); }
inline Jet SelectNegative(const Jet& x, const Jet& yes, const Jet& no) { return x < 0.0 ? yes : no; }

#include "lobefit/core/brdf/ggx_lobe-inl.h"

GgxLobeUniform<Jet> Uniform(const SlopeCoordinates& shape) {
  const Jet a = exp(Jet(shape.v[2], 2)), c = exp(Jet(shape.v[4], 4));
  return {Jet(shape.v[0], 0), Jet(shape.v[1], 1), a, Jet(shape.v[3], 3), c, 1.0 / a, 1.0 / c, 0.25 * kInvPi / (a * c)};
}

}  // namespace jets

// The block that the fit streams.
constexpr std::size_t kCount = 256;

struct Data {
  Data() {
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t k = 0; k < 2 * kCount; ++k) {
      const double cosine = 0.1 + 0.9 * uniform(engine), phi = 2 * kPi * uniform(engine);
      const double sine = std::sqrt(1 - cosine * cosine);
      x.push_back(sine * std::cos(phi));
      y.push_back(sine * std::sin(phi));
      z.push_back(cosine);
    }
    specular.resize(kCount);
    cos_d.resize(kCount);
    gradient.resize(5 * kCount);
  }
  Vec3 At(std::size_t k) const { return {x[k], y[k], z[k]}; }
  DirectionArrays Arrays() const {
    return {x.data(), y.data(), z.data(), x.data() + kCount, y.data() + kCount, z.data() + kCount, kCount};
  }
  std::vector<double> x, y, z, specular, cos_d, gradient;
};

const SlopeCoordinates kShape = SlopeCoordinatesFromEllipsoid({0.2, 0.35, 0.1, 0.05, 0.4});
constexpr Masking kMasking = Masking::kSmithSeparable;

void Scalar(benchmark::State& state, bool with_gradient) {
  Data data;
  for (auto _ : state) {
    for (std::size_t k = 0; k < kCount; ++k) {
      data.specular[k] = GgxLobe(data.At(k), data.At(k + kCount), kShape, kMasking, &data.cos_d[k],
                                 with_gradient ? &data.gradient[5 * k] : nullptr);
    }
    benchmark::DoNotOptimize(data.specular.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}

void Simd(benchmark::State& state, bool with_gradient) {
  Data data;
  for (auto _ : state) {
    GgxLobe(data.Arrays(), kShape, kMasking, data.specular.data(), data.cos_d.data(),
            with_gradient ? data.gradient.data() : nullptr);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}

// f(wi, wo) is a Jet; stores value and gradient.
template <class F>
void WithJets(benchmark::State& state, const F& f) {
  Data data;
  for (auto _ : state) {
    for (std::size_t k = 0; k < kCount; ++k) {
      const jets::Jet value = f(data.At(k), data.At(k + kCount));
      data.specular[k] = value.a;
      for (int j = 0; j < 5; ++j) data.gradient[5 * k + static_cast<std::size_t>(j)] = value.v[j];
    }
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kCount));
}

void JetsSameOperations(benchmark::State& state) {
  using jets::Jet;
  const jets::GgxLobeUniform<Jet> p = jets::Uniform(kShape);
  WithJets(state, [&](const Vec3& i, const Vec3& o) {
    Jet cos_d;
    Jet* const none = nullptr;
    return jets::GgxSpecular<false, Masking::kSmithSeparable>(p, Jet(i.x), Jet(i.y), Jet(i.z), Jet(o.x), Jet(o.y),
                                                              Jet(o.z), &cos_d, none);
  });
}

void JetsDefinition(benchmark::State& state) {
  using jets::Jet;
  Jet v[5];
  for (int j = 0; j < 5; ++j) v[j] = Jet(kShape.v[j], j);
  WithJets(state, [&](const Vec3& i, const Vec3& o) {
    const auto constant = [](const Vec3& w) { return Vec3T<Jet>{Jet(w.x), Jet(w.y), Jet(w.z)}; };
    Jet xi = SlopeSigmaFormula(v, constant(i)), xo = SlopeSigmaFormula(v, constant(o));
    if (xi < i.z) xi = Jet(i.z);
    if (xo < o.z) xo = Jet(o.z);
    return SlopeDFormula(v, constant(Normalized(i + o))) / (4.0 * xi * xo);
  });
}

// Keeps evaluations a second of CPU by name.
class Rates : public benchmark::ConsoleReporter {
 public:
  Rates() : benchmark::ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const auto found = run.counters.find("items_per_second");
      if (found != run.counters.end()) rate[run.benchmark_name()] = found->second.value;
    }
    ConsoleReporter::ReportRuns(runs);
  }
  std::map<std::string, double> rate;
};

int Main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RegisterBenchmark("scalar value", [](auto& state) { Scalar(state, false); });
  benchmark::RegisterBenchmark("scalar value+gradient", [](auto& state) { Scalar(state, true); });
  benchmark::RegisterBenchmark("SIMD value", [](auto& state) { Simd(state, false); });
  benchmark::RegisterBenchmark("SIMD value+gradient", [](auto& state) { Simd(state, true); });
  benchmark::RegisterBenchmark("Jets", JetsSameOperations);
  benchmark::RegisterBenchmark("Jets, definition", JetsDefinition);
  Rates rates;
  benchmark::RunSpecifiedBenchmarks(&rates);
  std::printf("\n%-24s %14s %10s %18s\n", "one thread", "M evaluations/s", "x Jets", "x Jets, definition");
  for (const auto& [name, rate] : rates.rate) {
    std::printf("%-24s %14.1f %10.1f %18.1f\n", name.c_str(), rate * 1e-6, rate / rates.rate["Jets"],
                rate / rates.rate["Jets, definition"]);
  }
  return 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) { return lobefit::Main(argc, argv); }
