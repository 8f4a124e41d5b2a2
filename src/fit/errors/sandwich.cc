#include "lobefit/fit/errors/sandwich.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "lobefit/fit/errors/clusters.h"
#include "lobefit/fit/errors/leave_one_out.h"
#include "lobefit/fit/errors/sample_rows.h"
#include "lobefit/fit/kernel/product_sums.h"
#include "lobefit/fit/objective/gains.h"

namespace lobefit {
namespace {

// Bytes of the sums that are held at a time.
constexpr double kMostBytes = 64e6;

// Samples sorted by incidence, in the order of the file within one.
std::vector<std::uint32_t> IncidenceOrder(const Incidences& incidences) {
  std::vector<std::uint32_t> next(incidences.wi.size() + 1, 0), order(incidences.group.size());
  for (const std::uint32_t group : incidences.group) ++next[group + 1];
  for (std::size_t g = 1; g < next.size(); ++g) next[g] += next[g - 1];
  for (std::size_t i = 0; i < order.size(); ++i) order[next[incidences.group[i]]++] = static_cast<std::uint32_t>(i);
  return order;
}

// Sums of one run of samples in the order of incidences. Its first and last incidence may go on in the neighbouring
// runs.
struct Run {
  struct Part {
    std::uint32_t group = 0;
    Cluster cluster;
  };
  std::optional<ClusterTally> tally;  // of the incidences between
  std::vector<Part> open;             // the first and, where it is another, the last
};

class Filler {
 public:
  Filler(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Bread& bread,
         const Incidences& incidences, const SparseColumns& numbers)
      : problem_(problem),
        kernel_(layout.ToKernel(u.data())),
        bread_(bread),
        incidences_(incidences),
        numbers_(numbers),
        whiten_row_(bread.whiten_row.begin(), bread.whiten_row.end()),
        order_(IncidenceOrder(incidences)) {}

  Run Sum(std::size_t begin, std::size_t end) const {
    Run run;
    run.tally.emplace(bread_.form, numbers_, incidences_.wi.size(), bread_.residual_variance);
    const bool exact = run.tally->freedom().exact();
    RowEvaluator evaluator(problem_.kernel_samples(), kernel_);
    LeaveOneOut leave_one_out(bread_);
    WhitenedPiece piece;
    piece.rows.resize(problem_.channels());
    ProductSums products;
    Run::Part current = {incidences_.group[order_[begin]], Cluster(run.tally->freedom())};
    for (std::size_t first = begin; first < end; first += kPiece) {
      const std::size_t last = std::min(end, first + kPiece);
      evaluator.Evaluate(order_, first, last, &piece.samples);
      for (std::size_t c = 0; c < piece.rows.size(); ++c)
        piece.rows[c] = PieceTimes(piece.samples.rows[c], whiten_row_[c]);
      if (!bread_.lean.empty()) TakeOutGains(first, &piece);
      const Eigen::Index count = piece.count();
      const Eigen::MatrixXd& moves = leave_one_out.Evaluate(piece);
      const Eigen::ArrayXXd squares = run.tally->freedom().Squares(moves);
      if (!exact) run.tally->AddScatter(moves, count, &products);
      for (Eigen::Index i = 0; i < count;) {
        const std::uint32_t group = incidences_.group[order_[first + static_cast<std::size_t>(i)]];
        Eigen::Index j = i + 1;
        while (j < count && incidences_.group[order_[first + static_cast<std::size_t>(j)]] == group) ++j;
        if (group != current.group) {
          Close(&current, &run);
          current.group = group;
        }
        AddSamples(piece, i, j, &products, &current.cluster);
        if (exact) current.cluster.scatter.AddScatter(moves, i, j, count, &products);
        current.cluster.squares += squares.middleRows(i, j - i).colwise().sum().transpose();
        current.cluster.fourths += squares.middleRows(i, j - i).square().colwise().sum().transpose();
        i = j;
      }
    }
    run.open.push_back(std::move(current));
    return run;
  }

  // An incidence with the prior of its gain.
  Cluster Whole(Run::Part part) const {
    Cluster cluster = std::move(part.cluster);
    if (bread_.lean.empty()) return cluster;
    const Gains& gains = *problem_.gains();
    const Eigen::VectorXd& lean = bread_.lean[part.group];
    cluster.curvature.AddToBorder(lean, gains.precision());
    cluster.score -= gains.precision() * gains.logarithms()[part.group] * lean;
    return cluster;
  }

 private:
  // With gains all columns are the border's.
  void TakeOutGains(std::size_t first, WhitenedPiece* piece) const {
    for (std::size_t c = 0; c < piece->rows.size(); ++c) {
      const Eigen::MatrixXd& rows = piece->samples.rows[c];
      for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const std::uint32_t group = incidences_.group[order_[first + static_cast<std::size_t>(i)]];
        piece->rows[c].row(i) -= rows(i, rows.cols() - 1) * bread_.lean[group].transpose();
      }
    }
  }

  // Adds the score and the curvature of samples [begin, end) of a piece.
  void AddSamples(const WhitenedPiece& piece, Eigen::Index begin, Eigen::Index end, ProductSums* products,
                  Cluster* cluster) const {
    const Eigen::Index border = bread_.form.border, count = end - begin;
    for (std::size_t c = 0; c < piece.rows.size(); ++c) {
      const auto own = [&](Eigen::Index j) { return j < border ? j : bread_.form.first[c] + j - border; };
      const auto r = piece.samples.residuals[c].segment(begin, count);
      for (Eigen::Index j = 0; j < piece.rows[c].cols(); ++j)
        cluster->score(own(j)) += piece.rows[c].col(j).segment(begin, count).dot(r);
      products->Sum(piece.rows[c], begin, end, piece.count());
      cluster->curvature.AddChannel(c, *products);
    }
    for (Eigen::Index i = begin; i < end; ++i) {
      if (piece.samples.curvature(i) == 0) continue;
      Eigen::VectorXd q = Eigen::VectorXd::Zero(border);
      for (std::size_t c = 0; c < piece.rows.size(); ++c)
        q += piece.samples.residuals[c](i) * piece.rows[c].row(i).transpose();
      cluster->curvature.AddToBorder(q, piece.samples.curvature(i));
    }
  }

  // Ends an incidence within a run.
  void Close(Run::Part* part, Run* run) const {
    if (run->open.empty()) {
      run->open.push_back(std::move(*part));
    } else {
      run->tally->Add(Whole(std::move(*part)));
    }
    part->cluster = Cluster(run->tally->freedom());
  }

  const Problem& problem_;
  const KernelModel kernel_;
  const Bread& bread_;
  const Incidences& incidences_;
  const SparseColumns& numbers_;
  const std::vector<RowMajorMatrix> whiten_row_;
  const std::vector<std::uint32_t> order_;
};

// Adds the variance that a prior gives: known, not estimated from samples or clusters.
void AddKnown(const Eigen::MatrixXd& prior, const SparseColumns& numbers, WhitenedMatrix* filling,
              Eigen::VectorXd* freedom) {
  if (prior.isZero(0)) return;
  for (Eigen::Index k = 0; k < numbers.cols(); ++k) {
    const Eigen::VectorXd of_border = Eigen::VectorXd(numbers.col(k)).head(prior.rows());
    const double known = of_border.dot(prior * of_border);
    const double estimated = filling->Quadratic(numbers.col(k));
    if (known > 0 && estimated > 0) (*freedom)(k) *= (1 + known / estimated) * (1 + known / estimated);
  }
  filling->AddToBorder(prior);
}

}  // namespace

SparseColumns UnitColumns(const SparseRows& rows) {
  SparseColumns columns = rows.transpose();
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    const double length = columns.col(k).norm();
    if (length > 0) columns.col(k) /= length;
  }
  return columns;
}

Filling FillSandwich(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Bread& bread,
                     const Incidences& incidences, const SparseColumns& numbers, ThreadPool* pool) {
  const Filler filler(problem, layout, u, bread, incidences, numbers);
  const std::size_t runs = RunCount(problem.size());
  const auto m = static_cast<double>(bread.form.size);
  const double pairs = m * static_cast<double>(bread.form.full ? bread.form.size : bread.form.border);
  const auto at_a_time = static_cast<std::size_t>(std::clamp(kMostBytes / (32 * pairs + 1), 2.0, 64.0));
  ClusterTally tally(bread.form, numbers, incidences.wi.size(), bread.residual_variance);
  std::optional<Run::Part> open;
  for (std::size_t first = 0; first < runs; first += at_a_time) {
    std::vector<Run> sums(std::min(runs - first, at_a_time));
    pool->Run(sums.size(), [&](std::size_t k) {
      sums[k] = filler.Sum(RunBegin(problem.size(), first + k), RunBegin(problem.size(), first + k + 1));
    });
    for (Run& run : sums) {
      for (Run::Part& part : run.open) {
        if (open && open->group == part.group) {
          open->cluster.Add(part.cluster);
        } else {
          if (open) tally.Add(filler.Whole(std::move(*open)));
          open = std::move(part);
        }
      }
      tally.Merge(*run.tally);
    }
  }
  if (open) tally.Add(filler.Whole(std::move(*open)));
  Filling filling = {tally.scatter(), tally.freedom().OfSamples(), tally.filling(),
                     tally.freedom().OfClusters(tally.scatter())};
  AddKnown(bread.prior_of_gains + bread.prior_of_coordinates, numbers, &filling.samples, &filling.samples_freedom);
  AddKnown(bread.prior_of_coordinates, numbers, &filling.clusters, &filling.clusters_freedom);
  return filling;
}

}  // namespace lobefit
