#include "lobefit/fit/errors/sandwich.h"

#include <algorithm>
#include <optional>

#include <Eigen/Cholesky>

#include "lobefit/fit/errors/clusters.h"
#include "lobefit/fit/errors/sample_rows.h"
#include "lobefit/fit/objective/gains.h"
#include "lobefit/fit/search/symmetric_eigen.h"

namespace lobefit {
namespace {

using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;

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

// Rows of a piece in whitened coordinates.
struct WhitenedRows {
  std::vector<RowMajorMatrix> rows;  // [channel] samples x (border + own)
  SampleRows samples;
};

// What the solution moves by when one sample is left out.
class LeaveOneOut {
 public:
  explicit LeaveOneOut(const Bread& bread) : bread_(bread), y_(bread.border), term_(bread.border), q_(bread.border) {}

  // Of sample i of a piece, m entries. With k and o the border's and the own entries of a channel's row, the curvature
  // of the sample is the sum over channels of (k, o)^T (k, o) and c q q^T with q the sum of k r. Its own part is
  // inverted channel by channel; what is left is the border's,
  //   (1 - sum of w k k^T - c q q^T) y = sum of w r k,   w = 1 / (1 - o.o),   and a_own = w (r + k.y) o.
  void Evaluate(const WhitenedRows& piece, Eigen::Index i, double* to) {
    const std::size_t channels = piece.rows.size();
    const Eigen::Index border = bread_.border;
    w_.resize(channels);
    double size = 0;
    y_.setZero();
    q_.setZero();
    for (std::size_t c = 0; c < channels; ++c) {
      const ConstVectorMap k = Border(piece, c, i), o = Own(piece, c, i);
      const double left = 1 - o.squaredNorm(), r = piece.samples.residuals[c](i);
      w_[c] = left > kAlone ? 1 / left : 0;
      size += w_[c] * k.squaredNorm();
      y_ += w_[c] * r * k;
      q_ += r * k;
    }
    const double curvature = piece.samples.curvature(i);
    size += std::fabs(curvature) * q_.squaredNorm();
    if (size < 0.1) {
      Series(piece, i, curvature);
    } else if (border > 0) {
      Direct(piece, i, curvature);
    }
    std::copy_n(y_.data(), border, to);
    for (std::size_t c = 0; c < channels; ++c) {
      const double factor = w_[c] * (piece.samples.residuals[c](i) + Border(piece, c, i).dot(y_));
      const ConstVectorMap o = Own(piece, c, i);
      for (Eigen::Index j = 0; j < o.size(); ++j) to[bread_.first[c] + j] = factor * o(j);
    }
  }

 private:
  ConstVectorMap Border(const WhitenedRows& piece, std::size_t c, Eigen::Index i) const {
    return {piece.rows[c].row(i).data(), bread_.border};
  }
  ConstVectorMap Own(const WhitenedRows& piece, std::size_t c, Eigen::Index i) const {
    return {piece.rows[c].row(i).data() + bread_.border, bread_.own[c]};
  }

  void Series(const WhitenedRows& piece, Eigen::Index i, double curvature) {
    term_ = y_;
    while (term_.squaredNorm() > 1e-32 * y_.squaredNorm()) {
      next_ = curvature * q_.dot(term_) * q_;
      for (std::size_t c = 0; c < w_.size(); ++c) {
        const ConstVectorMap k = Border(piece, c, i);
        next_ += w_[c] * k.dot(term_) * k;
      }
      term_.swap(next_);
      y_ += term_;
    }
  }

  void Direct(const WhitenedRows& piece, Eigen::Index i, double curvature) {
    Eigen::MatrixXd left = Eigen::MatrixXd::Identity(bread_.border, bread_.border) - curvature * q_ * q_.transpose();
    for (std::size_t c = 0; c < w_.size(); ++c) {
      const ConstVectorMap k = Border(piece, c, i);
      left -= w_[c] * k * k.transpose();
    }
    const SymmetricEigen eigen = DecomposeSymmetric(left);
    const Eigen::VectorXd inverse = eigen.values.unaryExpr([](double x) { return x > kAlone ? 1 / x : 0.0; });
    y_ = eigen.vectors * (inverse.asDiagonal() * (eigen.vectors.transpose() * y_)).eval();
  }

  const Bread& bread_;
  Eigen::VectorXd y_, term_, next_, q_;
  std::vector<double> w_;
};

// Adds the samples [begin, end) of a piece to a cluster.
void AddRows(const WhitenedRows& piece, Eigen::Index begin, Eigen::Index end, const Bread& bread, Cluster* cluster) {
  const Eigen::Index border = bread.border, count = end - begin;
  for (std::size_t c = 0; c < piece.rows.size(); ++c) {
    const auto rows = piece.rows[c].middleRows(begin, count);
    const auto k = rows.leftCols(border), o = rows.rightCols(bread.own[c]);
    const auto r = piece.samples.residuals[c].segment(begin, count);
    cluster->score.head(border).noalias() += k.transpose() * r;
    cluster->curvature.topLeftCorner(border, border).noalias() += k.transpose() * k;
    if (bread.own[c] == 0) continue;
    cluster->score.segment(bread.first[c], bread.own[c]).noalias() += o.transpose() * r;
    const Eigen::MatrixXd cross = o.transpose() * k;
    cluster->curvature.block(bread.first[c], 0, bread.own[c], border) += cross;
    cluster->curvature.block(0, bread.first[c], border, bread.own[c]) += cross.transpose();
    cluster->curvature.block(bread.first[c], bread.first[c], bread.own[c], bread.own[c]).noalias() += o.transpose() * o;
  }
  for (Eigen::Index i = begin; i < end; ++i) {
    if (piece.samples.curvature(i) == 0) continue;
    Eigen::VectorXd q = Eigen::VectorXd::Zero(border);
    for (std::size_t c = 0; c < piece.rows.size(); ++c)
      q += piece.samples.residuals[c](i) * piece.rows[c].row(i).transpose();
    cluster->curvature += piece.samples.curvature(i) * q * q.transpose();
  }
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
         const Incidences& incidences, const Eigen::MatrixXd& numbers)
      : problem_(problem),
        kernel_(layout.ToKernel(u.data())),
        bread_(bread),
        incidences_(incidences),
        numbers_(numbers),
        whiten_row_(bread.whiten_row.begin(), bread.whiten_row.end()),
        order_(IncidenceOrder(incidences)) {}

  Run Sum(std::size_t begin, std::size_t end) const {
    Run run;
    run.tally.emplace(numbers_, incidences_.wi.size(), bread_.residual_variance);
    const bool exact = run.tally->freedom().exact();
    RowEvaluator evaluator(problem_.kernel_samples(), kernel_);
    LeaveOneOut leave_one_out(bread_);
    WhitenedRows piece;
    piece.rows.resize(problem_.channels());
    Eigen::MatrixXd moves;
    Run::Part current = {incidences_.group[order_[begin]], Cluster(run.tally->freedom())};
    for (std::size_t first = begin; first < end; first += kPiece) {
      const std::size_t last = std::min(end, first + kPiece);
      evaluator.Evaluate(order_, first, last, &piece.samples);
      for (std::size_t c = 0; c < piece.rows.size(); ++c)
        piece.rows[c] = PieceTimes(piece.samples.rows[c], whiten_row_[c]);
      if (!bread_.lean.empty()) TakeOutGains(first, &piece);
      const auto count = static_cast<Eigen::Index>(last - first);
      moves.resize(bread_.size(), count);
      for (Eigen::Index i = 0; i < count; ++i) leave_one_out.Evaluate(piece, i, moves.col(i).data());
      const Eigen::ArrayXXd squares = run.tally->freedom().Squares(moves);
      if (!exact) run.tally->AddScatter(moves);
      for (Eigen::Index i = 0; i < count;) {
        const std::uint32_t group = incidences_.group[order_[first + static_cast<std::size_t>(i)]];
        Eigen::Index j = i + 1;
        while (j < count && incidences_.group[order_[first + static_cast<std::size_t>(j)]] == group) ++j;
        if (group != current.group) {
          Close(&current, &run);
          current.group = group;
        }
        AddRows(piece, i, j, bread_, &current.cluster);
        if (exact) current.cluster.scatter.selfadjointView<Eigen::Lower>().rankUpdate(moves.middleCols(i, j - i));
        current.cluster.squares += squares.middleRows(i, j - i).colwise().sum().transpose();
        current.cluster.fourths += squares.middleRows(i, j - i).square().colwise().sum().transpose();
        i = j;
      }
    }
    run.open.push_back(std::move(current));
    return run;
  }

  // An incidence with the prior of its gain.
  Cluster Whole(const Run::Part& part) const {
    Cluster cluster = part.cluster;
    if (bread_.lean.empty()) return cluster;
    const Gains& gains = *problem_.gains();
    const Eigen::VectorXd& lean = bread_.lean[part.group];
    cluster.curvature += gains.precision() * lean * lean.transpose();
    cluster.score -= gains.precision() * gains.logarithms()[part.group] * lean;
    return cluster;
  }

 private:
  // With gains all columns are the border's.
  void TakeOutGains(std::size_t first, WhitenedRows* piece) const {
    for (std::size_t c = 0; c < piece->rows.size(); ++c) {
      const Eigen::MatrixXd& rows = piece->samples.rows[c];
      for (Eigen::Index i = 0; i < rows.rows(); ++i) {
        const std::uint32_t group = incidences_.group[order_[first + static_cast<std::size_t>(i)]];
        piece->rows[c].row(i) -= rows(i, rows.cols() - 1) * bread_.lean[group].transpose();
      }
    }
  }

  // Ends an incidence within a run.
  void Close(Run::Part* part, Run* run) const {
    if (run->open.empty()) {
      run->open.push_back(*part);
    } else {
      run->tally->Add(Whole(*part));
    }
    part->cluster = Cluster(run->tally->freedom());
  }

  const Problem& problem_;
  const KernelModel kernel_;
  const Bread& bread_;
  const Incidences& incidences_;
  const Eigen::MatrixXd& numbers_;
  const std::vector<RowMajorMatrix> whiten_row_;
  const std::vector<std::uint32_t> order_;
};

Eigen::MatrixXd Symmetric(const Eigen::MatrixXd& lower) {
  return Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>());
}

// Adds the variance that a prior gives: known, not estimated from samples or clusters.
void AddKnown(const Eigen::MatrixXd& prior, const Eigen::MatrixXd& numbers, Eigen::MatrixXd* filling,
              Eigen::VectorXd* freedom) {
  if (prior.isZero(0)) return;
  for (Eigen::Index k = 0; k < numbers.cols(); ++k) {
    const double known = numbers.col(k).dot(prior * numbers.col(k));
    const double estimated = numbers.col(k).dot(*filling * numbers.col(k));
    if (known > 0 && estimated > 0) (*freedom)(k) *= (1 + known / estimated) * (1 + known / estimated);
  }
  *filling += prior;
}

}  // namespace

Filling FillSandwich(const Problem& problem, const Layout& layout, const std::vector<double>& u, const Bread& bread,
                     const Incidences& incidences, const Eigen::MatrixXd& numbers, ThreadPool* pool) {
  const Filler filler(problem, layout, u, bread, incidences, numbers);
  const std::size_t runs = RunCount(problem.size());
  const auto m = static_cast<double>(bread.size());
  const auto at_a_time = static_cast<std::size_t>(std::clamp(kMostBytes / (32 * m * m + 1), 2.0, 64.0));
  ClusterTally tally(numbers, incidences.wi.size(), bread.residual_variance);
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
          if (open) tally.Add(filler.Whole(*open));
          open = std::move(part);
        }
      }
      tally.Merge(*run.tally);
    }
  }
  if (open) tally.Add(filler.Whole(*open));
  Filling filling = {Symmetric(tally.scatter()), tally.freedom().OfSamples(), Symmetric(tally.filling()),
                     tally.freedom().OfClusters(tally.scatter())};
  AddKnown(bread.prior_of_gains + bread.prior_of_coordinates, numbers, &filling.samples, &filling.samples_freedom);
  AddKnown(bread.prior_of_coordinates, numbers, &filling.clusters, &filling.clusters_freedom);
  return filling;
}

}  // namespace lobefit
