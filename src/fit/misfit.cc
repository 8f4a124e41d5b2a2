#include "lobefit/fit/misfit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/core/off_center.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/student_t.h"

namespace lobefit {
namespace {

constexpr double kLevel = 0.01;
constexpr std::size_t kFewestSamples = 50, kMostSamples = 100000, kFewestIncidences = 6;
// A bin's mean over fewer independent groups has no standard error to speak of.
constexpr double kFewestGroups = 5;

// Edges between bins of each coordinate; a sample lies in one bin of each.
constexpr std::array<double, 9> kDistance = {0.25, 0.5, 0.75, 1, 1.5, 2, 3, 5, 8};  // widths of the lobe
constexpr std::array<double, 8> kThetaD = {10, 20, 30, 40, 50, 60, 70, 80};         // degrees
constexpr std::array<double, 3> kThetaI = {20, 40, 60};                             // degrees
constexpr std::size_t kSectors = 8;
constexpr double kLeastDistance = 0.25;  // nearer to the centre the azimuth says nothing
constexpr std::size_t kDistanceBins = kDistance.size() + 1, kThetaDBins = kThetaD.size() + 1,
                      kThetaIBins = kThetaI.size() + 1;
constexpr std::size_t kBins = kDistanceBins + kThetaDBins + kThetaIBins + kSectors;

template <std::size_t N>
std::size_t Place(const std::array<double, N>& edges, double x) {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), x) - edges.begin());
}

template <std::size_t N>
std::string Words(const std::array<double, N>& edges, std::size_t place, const char* name, const char* unit) {
  if (place == 0) return fmt::format("{} below {:g}{}", name, edges[0], unit);
  if (place == N) return fmt::format("{} above {:g}{}", name, edges[N - 1], unit);
  return fmt::format("{} from {:g} to {:g}{}", name, edges[place - 1], edges[place], unit);
}

std::string WordsOf(std::size_t bin) {
  if (bin < kDistanceBins)
    return Words(kDistance, bin, "half vectors at a distance from the lobe's centre", " of its widths");
  bin -= kDistanceBins;
  if (bin < kThetaDBins) return Words(kThetaD, bin, "theta_d", " degrees");
  bin -= kThetaDBins;
  if (bin < kThetaIBins) return Words(kThetaI, bin, "theta_i", " degrees");
  return fmt::format("half vectors towards {:.0f} degrees about the lobe's centre",
                     360.0 * (static_cast<double>(bin - kThetaIBins) + 0.5) / kSectors);
}

// The bins of one sample; kBins stands for none.
std::array<std::size_t, 4> BinsOf(const SlopeCoordinates& lobe, const Vec3& wi, const Vec3& wo) {
  const Vec3 h = HalfVector(wi, wo);
  const double* v = lobe.v;
  // Whitened slope, y = L^-1 (slope - mean).
  const double y1 = (-h.x / h.z - v[0]) * std::exp(-v[2]);
  const double y2 = (-h.y / h.z - v[1] - v[3] * y1) * std::exp(-v[4]);
  const double distance = std::hypot(y1, y2);
  const double theta_d = RadiansToDegrees(std::acos(std::min(1.0, Dot(wi, h))));
  const double theta_i = RadiansToDegrees(std::acos(std::min(1.0, wi.z)));
  std::size_t sector = kBins;
  if (distance >= kLeastDistance) {
    const double turn = std::atan2(y2, y1) / (2 * kPi);
    sector = kDistanceBins + kThetaDBins + kThetaIBins +
             std::min(kSectors - 1, static_cast<std::size_t>((turn < 0 ? turn + 1 : turn) * kSectors));
  }
  return {Place(kDistance, distance), kDistanceBins + Place(kThetaD, theta_d),
          kDistanceBins + kThetaDBins + Place(kThetaI, theta_i), sector};
}

// Residuals, summed over channels, of every stride-th piece of 1024 samples.
std::vector<double> Residuals(const Problem& problem, const KernelModel& kernel, std::size_t stride) {
  const KernelSamples& samples = problem.kernel_samples();
  std::vector<double> residuals;
  constexpr std::size_t kPiece = 1024;
  std::vector<std::vector<double>> f;
  std::vector<double> model;
  for (std::size_t begin = 0; begin < problem.size(); begin += kPiece * stride) {
    const std::size_t end = std::min(problem.size(), begin + kPiece);
    ModelValues(samples, kernel, begin, end, &f);
    model.resize(end - begin);
    std::vector<double> sum(end - begin, 0.0);
    for (std::size_t c = 0; c < f.size(); ++c) {
      const double* target = samples.target[c] + begin;
      TransformMeasured(kernel.transform, f[c].data(), samples.direction[2] + begin, end - begin, model.data());
      for (std::size_t i = 0; i < sum.size(); ++i) {
        double r = model[i] - target[i];
        if (kernel.transform == Transform::kRelative) r /= target[i];
        sum[i] += r;
      }
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
      residuals.push_back(samples.sqrt_weight == nullptr ? sum[i] : sum[i] * samples.sqrt_weight[begin + i]);
  }
  return residuals;
}

// Sums of one bin over one group of samples that may depend on each other.
struct Cell {
  double sum = 0, count = 0;
};

}  // namespace

Misfit TestMisfit(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Samples& samples,
                  const Incidences& incidences) {
  Misfit misfit;
  if (problem.size() < kFewestSamples) return misfit;
  const KernelModel kernel = layout.ToKernel(u.data());
  const SlopeCoordinates& lobe = kernel.lobes.front().shape;
  // Every stride-th piece of 1024 samples.
  constexpr std::size_t kPiece = 1024;
  const std::size_t stride = (problem.size() + kMostSamples - 1) / kMostSamples;
  const std::vector<double> residuals = Residuals(problem, kernel, stride);
  double squares = 0;
  for (const double r : residuals) squares += r * r;
  const double rms = std::sqrt(squares / static_cast<double>(residuals.size()));
  if (!(rms > 1e-9)) return misfit;

  const bool by_incidence = incidences.wi.size() >= kFewestIncidences;
  std::array<std::vector<Cell>, kBins> cells;
  if (by_incidence) {
    for (std::vector<Cell>& bin : cells) bin.resize(incidences.wi.size());
  }
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    const std::size_t i = k / kPiece * kPiece * stride + k % kPiece;
    for (const std::size_t bin : BinsOf(lobe, samples.wi(i), samples.wo(i))) {
      if (bin == kBins) continue;
      if (!by_incidence) cells[bin].emplace_back();
      Cell& cell = by_incidence ? cells[bin][incidences.group[i]] : cells[bin].back();
      cell.sum += residuals[k];
      cell.count += 1;
    }
  }
  double least = 1;
  std::size_t tested = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    double sum = 0, count = 0, count2 = 0;
    for (const Cell& cell : cells[bin]) {
      sum += cell.sum;
      count += cell.count;
      count2 += cell.count * cell.count;
    }
    if (!(count > 0)) continue;
    const double groups = count * count / count2, mean = sum / count;
    if (groups < kFewestGroups) continue;
    ++tested;
    double variance = 0;
    for (const Cell& cell : cells[bin]) {
      const double excess = cell.sum - mean * cell.count;
      variance += excess * excess;
    }
    variance *= groups / (groups - 1);
    const double t = sum / std::sqrt(variance);
    const double probability = std::isfinite(t) ? 2 * StudentTCdf(-std::fabs(t), groups - 1) : 1;
    if (probability >= least) continue;
    least = probability;
    misfit.where = WordsOf(bin);
    misfit.size = mean / rms;
  }
  misfit.tested = tested > 0;
  misfit.probability = std::min(1.0, least * static_cast<double>(tested));
  misfit.flagged = misfit.tested && misfit.probability < kLevel;
  return misfit;
}

}  // namespace lobefit
