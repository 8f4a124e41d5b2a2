#include "lobefit/fit/errors/file_clusters.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <Eigen/Core>

#include "lobefit/fit/errors/bread.h"
#include "lobefit/fit/errors/clusters.h"
#include "lobefit/fit/errors/entries.h"
#include "lobefit/fit/errors/sandwich.h"

namespace lobefit {
namespace {

// Groups of samples by anything: FillSandwich asks how many there are and which is whose.
Incidences Groups(std::size_t count, std::vector<std::uint32_t> group) {
  return {std::vector<Vec3>(count, Vec3{0, 0, 1}), std::move(group)};
}

Incidences ByFile(const std::vector<std::uint32_t>& files) {
  std::map<std::uint32_t, std::uint32_t> index;
  std::vector<std::uint32_t> group;
  for (const std::uint32_t file : files)
    group.push_back(index.try_emplace(file, static_cast<std::uint32_t>(index.size())).first->second);
  return Groups(index.size(), std::move(group));
}

Incidences Intersection(const Incidences& a, const Incidences& b) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> index;
  std::vector<std::uint32_t> group;
  for (std::size_t i = 0; i < a.group.size(); ++i) {
    const auto next = static_cast<std::uint32_t>(index.size());
    group.push_back(index.try_emplace({a.group[i], b.group[i]}, next).first->second);
  }
  return Groups(index.size(), std::move(group));
}

struct OneWay {
  Eigen::VectorXd variance, freedom;
};

}  // namespace

FileErrors EstimateErrorsByFile(const Problem& problem, const Layout& layout, const std::vector<double>& u,
                                const Incidences& incidences, const std::vector<std::uint32_t>& files,
                                ThreadPool* pool) {
  FileErrors errors;
  if (files.empty() || problem.gains() != nullptr) return errors;
  const Incidences by_file = ByFile(files), both = Intersection(incidences, by_file);
  const std::size_t file_count = by_file.wi.size(), both_count = both.wi.size();
  if (file_count < 2 || both_count == file_count) return errors;

  const Bread bread = FactorBread(problem, layout, u, pool);
  const ReportedEntries entries = EntriesOf(layout, u, bread);
  const SparseColumns numbers = UnitColumns(entries.rows);
  const auto one_way = [&](const Incidences& groups) {
    const Filling filling = FillSandwich(problem, layout, u, bread, groups, numbers, pool);
    OneWay way = {Eigen::VectorXd(entries.rows.rows()), filling.clusters_freedom};
    for (Eigen::Index row = 0; row < entries.rows.rows(); ++row) {
      way.variance(row) = filling.clusters.Quadratic(entries.rows.row(row).transpose());
    }
    return way;
  };
  OneWay total = one_way(by_file);
  if (both_count > incidences.wi.size()) {
    const OneWay incidence = one_way(incidences), shared = one_way(both);
    const Eigen::VectorXd sum = total.variance + incidence.variance - shared.variance;
    total.variance = sum.cwiseMax(total.variance).cwiseMax(incidence.variance);
    total.freedom = total.freedom.cwiseMin(incidence.freedom);
  }
  for (Eigen::Index row = 0; row < entries.rows.rows(); ++row) {
    errors.variance.push_back(total.variance(row));
    errors.freedom.push_back(total.freedom(row));
  }
  for (const Eigen::Index row : entries.without_error)
    errors.variance[static_cast<std::size_t>(row)] = std::numeric_limits<double>::quiet_NaN();
  return errors;
}

}  // namespace lobefit
