#include "lobefit/fit/inference/misfit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "lobefit/core/ellipsoid/off_center.h"
#include "lobefit/fit/coordinates/arrow.h"
#include "lobefit/fit/errors/sample_rows.h"
#include "lobefit/fit/inference/times_inverse.h"
#include "lobefit/fit/metric/transform.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/student_t.h"

namespace lobefit {
namespace {

constexpr double kLevel = 0.01;
constexpr std::size_t kFewestSamples = 50, kFewestIncidences = 6;
// Operations for the samples that are looked at, samples x (channels x coordinates^2 + what a sample takes anyway): a
// few hundredths of a second.
constexpr double kMostWork = 2e7, kWorkOfSample = 100;
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

// Sums over one group of samples that may depend on each other: residuals and counts a bin, and J^T r.
struct Group {
  std::array<double, kBins> sum = {}, count = {};
  Eigen::VectorXd score;
};

struct Sums {
  std::vector<Group> groups;
  ArrowMatrix hessian;                // J^T J
  Eigen::MatrixXd bin_rows;           // bins x coordinates: sum of the rows of J in a bin
  double squares = 0, residuals = 0;  // of all residuals, and their number
};

// Coordinates that are not held at a bound.
std::vector<int> FreeCoordinates(const Layout& layout, const std::vector<double>& u, Eigen::Index* count) {
  std::vector<int> place(layout.size(), -1);
  *count = 0;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const Coordinate& coordinate = layout.coordinates()[i];
    const double slack = BoundSlack(coordinate);
    if (u[i] > coordinate.low + slack && u[i] < coordinate.high - slack) place[i] = static_cast<int>((*count)++);
  }
  return place;
}

// Of the coordinates that are not held, of which gains, the last, are the border's.
ArrowShape ShapeOf(const Layout& layout, const std::vector<int>& place, Eigen::Index free, Eigen::Index count) {
  const auto placed = [&place](const std::vector<int>& coordinates) {
    std::vector<int> known;
    for (const int i : coordinates) {
      if (place[static_cast<std::size_t>(i)] >= 0) known.push_back(place[static_cast<std::size_t>(i)]);
    }
    return known;
  };
  const ArrowShape all = ArrowShapeOf(layout);
  ArrowShape shape = {placed(all.border), {}};
  for (Eigen::Index gain = free; gain < count; ++gain) shape.border.push_back(static_cast<int>(gain));
  for (const std::vector<int>& own : all.own) shape.own.push_back(placed(own));
  return shape;
}

// A coordinate of a row of J in the arrow: within the border or within its channel's own.
struct Spot {
  bool border;
  Eigen::Index index;
};

std::vector<Spot> SpotsOf(const ArrowShape& shape, Eigen::Index count) {
  std::vector<Spot> spots(static_cast<std::size_t>(count));
  const auto put = [&spots](const std::vector<int>& coordinates, bool border) {
    for (std::size_t k = 0; k < coordinates.size(); ++k)
      spots[static_cast<std::size_t>(coordinates[k])] = {border, static_cast<Eigen::Index>(k)};
  };
  put(shape.border, true);
  for (const std::vector<int>& own : shape.own) put(own, false);
  return spots;
}

// Change of the residuals of a piece with the logarithm of all its values, [channel] as rows of `piece`: what a lamp
// that has drifted does to an incidence.
std::vector<Eigen::VectorXd> GainRows(const Problem& problem, const KernelModel& kernel, const Samples& samples,
                                      std::size_t begin, const SampleRows& piece) {
  const auto count = static_cast<std::size_t>(piece.root_rho.size());
  std::vector<std::vector<double>> f;
  ModelValues(problem.kernel_samples(), kernel, begin, begin + count, &f);
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> residual(count), slope(count);
  for (std::size_t c = 0; c < f.size(); ++c) {
    Residuals(kernel.transform, f[c].data(), samples.wi_z.data() + begin, samples.values[c].data() + begin, nullptr,
              count, residual.data(), slope.data());
    rows.emplace_back(piece.root_rho.size());
    for (std::size_t i = 0; i < count; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      rows[c](k) = std::sqrt(problem.Weight(begin + i)) * piece.root_rho(k) * slope[i] * f[c][i];
    }
  }
  return rows;
}

// Of every stride-th piece of 256 samples. Not `by_incidence`: samples are groups of their own, and each incidence has
// a gain as a further coordinate.
Sums SumBins(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Samples& samples,
             const Incidences& incidences, bool by_incidence, std::size_t stride) {
  const KernelModel kernel = layout.ToKernel(u.data());
  Eigen::Index free = 0;
  const std::vector<int> place = FreeCoordinates(layout, u, &free);
  const Eigen::Index n = free + (by_incidence ? 0 : static_cast<Eigen::Index>(incidences.wi.size()));
  Sums sums;
  sums.hessian = ArrowMatrix(ShapeOf(layout, place, free, n));
  const std::vector<Spot> spots = SpotsOf(sums.hessian.shape, n);
  sums.bin_rows.setZero(kBins, n);
  const Group empty = {{}, {}, Eigen::VectorXd::Zero(n)};
  if (by_incidence) {
    sums.groups.assign(incidences.wi.size(), empty);
  } else {
    sums.groups.reserve(std::min(problem.size(), (problem.size() / (kPiece * stride) + 1) * kPiece));
  }
  const std::vector<std::uint32_t> order = FileOrder(problem.size());
  RowEvaluator evaluator(problem.kernel_samples(), kernel);
  SampleRows piece;
  std::vector<Eigen::VectorXd> gains;
  std::vector<std::vector<int>> coordinates;
  for (std::size_t c = 0; c < problem.channels(); ++c) coordinates.push_back(layout.CoordinatesOfColumns(c));
  // A residual moves with its own channel's coordinates only: their products are few, whatever the number of channels.
  std::vector<std::pair<Eigen::Index, double>> row;
  const auto add_to_row = [&](Eigen::Index to, double value) {
    const auto known = std::find_if(row.begin(), row.end(), [&](const auto& entry) { return entry.first == to; });
    if (known == row.end()) {
      row.emplace_back(to, value);
    } else {
      known->second += value;
    }
  };
  Eigen::VectorXd rows(n);
  for (std::size_t begin = 0; begin < problem.size(); begin += kPiece * stride) {
    const std::size_t count = std::min(problem.size(), begin + kPiece) - begin;
    evaluator.Evaluate(order, begin, begin + count, &piece);
    if (!by_incidence) gains = GainRows(problem, kernel, samples, begin, piece);
    for (std::size_t i = 0; i < count; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const std::uint32_t incidence = incidences.group[begin + i];
      if (!by_incidence) sums.groups.push_back(empty);
      Group& group = by_incidence ? sums.groups[incidence] : sums.groups.back();
      double residual = 0;
      rows.setZero();
      for (std::size_t c = 0; c < coordinates.size(); ++c) {
        row.clear();
        for (std::size_t j = 0; j < coordinates[c].size(); ++j) {
          const int to = coordinates[c][j] < 0 ? -1 : place[static_cast<std::size_t>(coordinates[c][j])];
          if (to >= 0) add_to_row(to, piece.rows[c](k, static_cast<Eigen::Index>(j)));
        }
        if (!by_incidence) add_to_row(free + incidence, gains[c](k));
        const double r = piece.residuals[c](k);
        residual += r;
        sums.squares += r * r;
        sums.residuals += 1;
        for (const auto& [to, value] : row) {
          rows(to) += value;
          group.score(to) += r * value;
          const Spot at = spots[static_cast<std::size_t>(to)];
          for (const auto& [other, factor] : row) {
            const Spot beside = spots[static_cast<std::size_t>(other)];
            if (!at.border && beside.border) continue;  // its mirror image is kept
            Eigen::MatrixXd* block = !at.border      ? &sums.hessian.own[c]
                                     : beside.border ? &sums.hessian.border
                                                     : &sums.hessian.across[c];
            (*block)(at.index, beside.index) += value * factor;
          }
        }
      }
      for (const std::size_t bin :
           BinsOf(kernel.lobes.front().shape.slope, samples.wi(begin + i), samples.wo(begin + i))) {
        if (bin == kBins) continue;
        group.sum[bin] += residual;
        group.count[bin] += 1;
        sums.bin_rows.row(static_cast<Eigen::Index>(bin)) += rows.transpose();
      }
    }
  }
  return sums;
}

}  // namespace

Misfit TestMisfit(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Samples& samples,
                  const Incidences& incidences) {
  Misfit misfit;
  if (problem.size() < kFewestSamples) return misfit;
  const std::size_t columns = layout.shape_size() + 3;
  const double work = static_cast<double>(problem.size()) *
                      (static_cast<double>(problem.channels() * columns * columns) + kWorkOfSample);
  const auto stride = static_cast<std::size_t>(std::ceil(work / kMostWork));
  const bool by_incidence = incidences.wi.size() >= kFewestIncidences;
  const Sums sums = SumBins(problem, layout, u, samples, incidences, by_incidence, stride);
  const double rms = std::sqrt(sums.squares / sums.residuals);
  if (!(rms > 1e-9)) return misfit;
  // The noise of all samples moves the parameters and with them the mean of a bin: a bin's sum is that of its residuals
  // less what they moved it.
  const Eigen::MatrixXd moved = TimesInverse(sums.bin_rows, sums.hessian);
  double least = 1;
  std::size_t tested = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    std::vector<double> cells;
    double sum = 0, count = 0, count2 = 0, residual = 0;
    for (const Group& group : sums.groups) {
      cells.push_back(group.sum[bin] - moved.row(static_cast<Eigen::Index>(bin)).dot(group.score));
      sum += cells.back();
      residual += group.sum[bin];
      count += group.count[bin];
      count2 += group.count[bin] * group.count[bin];
    }
    if (!(count > 0)) continue;
    const double groups = count * count / count2, mean = sum / count;
    if (groups < kFewestGroups) continue;
    double variance = 0;
    for (std::size_t g = 0; g < cells.size(); ++g) {
      const double excess = cells[g] - mean * sums.groups[g].count[bin];
      variance += excess * excess;
    }
    variance *= groups / (groups - 1);
    // What the parameters and gains follow wherever it goes leaves rounding.
    if (!(variance > 1e-12 * rms * rms * count)) continue;
    ++tested;
    const double t = sum / std::sqrt(variance);
    const double probability = std::isfinite(t) ? 2 * StudentTCdf(-std::fabs(t), groups - 1) : 1;
    if (probability >= least) continue;
    least = probability;
    misfit.where = WordsOf(bin);
    misfit.size = residual / count / (rms * static_cast<double>(problem.channels()));
  }
  misfit.tested = tested > 0;
  misfit.probability = std::min(1.0, least * static_cast<double>(tested));
  misfit.flagged = misfit.tested && misfit.probability < kLevel;
  return misfit;
}

std::string ToRemark(const Misfit& misfit) {
  return fmt::format(
      "misfit: the residuals are structured: their mean over {} is {:.2f} of their spread, which noise explains with "
      "probability {:.1g}; the model is not quite the one behind the data, and its intervals are too narrow",
      misfit.where, misfit.size, misfit.probability);
}

}  // namespace lobefit
