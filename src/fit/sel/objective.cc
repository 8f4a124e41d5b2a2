#include "lobefit/fit/sel/objective.h"

#include <algorithm>
#include <cmath>

namespace lobefit {
namespace {

// Limits of the coordinates: alpha_x from 1e-3 to 0.999, aspect to 1:126, offsets to 57 degrees.
constexpr double kMaxT = 6.9, kMaxS = 2.2, kMaxOffset = 1, kMinLog = -40;
// An amplitude is at most this times the brightest sample: the most that lets a sample two widths from the axis be the
// brightest. Without the limit lobes narrower than the samples' spacing, and up to 1e8 times as bright, hid between
// them: on six files of the RGL database the table's error under cosine-l2 was 2 to 1000 times larger.
constexpr double kMostOverSamples = 4;
constexpr Eigen::Index kShape = SelObjective::kShape;

SelShape ShapeAt(const SelObjective::Coordinates& u, Eigen::Index lobe) {
  const double* x = u.data() + kShape * lobe;
  SelShape shape;
  shape.alpha_x = 1 / (1 + std::exp(-x[0]));
  shape.alpha_y = shape.alpha_x * std::exp(-x[1] * x[1]);
  shape.offset_in = x[2];
  shape.offset_across = x[3];
  shape.psi = x[4];
  return shape;
}

// What pulls compare (SelPull).
using Features = std::array<double, 5>;
Features FeaturesOf(const SelShape& shape) {
  const double x = std::log(shape.alpha_x), y = std::log(shape.alpha_y), half = 0.5 * (x - y);
  return {0.5 * (x + y), half * std::cos(2 * shape.psi), half * std::sin(2 * shape.psi), shape.offset_in,
          shape.offset_across};
}

}  // namespace

struct SelObjective::Prepared {
  Prepared(const Coordinates& u, Eigen::Index lobe_count, Eigen::Index channels)
      : linear(u.tail((lobe_count + 1) * channels).array().exp()) {
    for (Eigen::Index l = 0; l < lobe_count; ++l) {
      shapes.push_back(ShapeAt(u, l));
      lobes.emplace_back(shapes.back());
      s.push_back(u(kShape * l + 1));
    }
  }
  std::vector<SelShape> shapes;
  std::vector<SelLobeInFrame> lobes;
  std::vector<double> s;
  Eigen::VectorXd linear;  // amplitudes, then constants
};

SelObjective::SelObjective(const SelSamples& samples, std::size_t lobes, const SelSliceOptions& options,
                           const std::vector<SelPull>& pulls)
    : samples_(samples),
      options_(options),
      pulls_(pulls),
      lobes_(static_cast<Eigen::Index>(lobes)),
      channels_(static_cast<Eigen::Index>(samples.channels())) {
  for (std::size_t c = 0; c < samples.channels(); ++c) {
    double brightest = 1e-12;
    for (std::size_t i = 0; i < samples.size(); ++i)
      brightest = std::max(brightest, samples.Value(options.quantity, c, i));
    most_.push_back(std::log(kMostOverSamples * brightest));
  }
}

double SelObjective::High(Eigen::Index k) const {
  if (k >= kShape * lobes_) return most_[static_cast<std::size_t>((k - kShape * lobes_) % channels_)];
  constexpr double kHigh[kShape] = {kMaxT, kMaxS, kMaxOffset, kMaxOffset, 1e9};
  return kHigh[k % kShape];
}

double SelObjective::Low(Eigen::Index k) const { return k >= kShape * lobes_ ? kMinLog : -High(k); }

SelObjective::Coordinates SelObjective::Low() const {
  return Coordinates::NullaryExpr(size(), [this](Eigen::Index k) { return Low(k); });
}

SelObjective::Coordinates SelObjective::High() const {
  return Coordinates::NullaryExpr(size(), [this](Eigen::Index k) { return High(k); });
}

bool SelObjective::IsAtLimit(const Coordinates& u) const {
  for (Eigen::Index k = 0; k < size(); ++k) {
    if (u(k) >= High(k) || (k < kShape * lobes_ && u(k) <= Low(k))) return true;
  }
  return false;
}

SelObjective::Coordinates SelObjective::From(const SelSlice& slice) const {
  Coordinates u(size());
  for (Eigen::Index l = 0; l < lobes_; ++l) {
    const SelShape& shape = slice.lobes[static_cast<std::size_t>(l)];
    const double alpha = std::clamp(shape.alpha_x, 1e-3, 0.999);
    u(kShape * l) = std::log(alpha / (1 - alpha));
    u(kShape * l + 1) = std::sqrt(std::max(0.0, std::log(shape.alpha_x / shape.alpha_y)));
    u(kShape * l + 2) = shape.offset_in;
    u(kShape * l + 3) = shape.offset_across;
    u(kShape * l + 4) = shape.psi;
    for (Eigen::Index c = 0; c < channels_; ++c)
      u(Amplitude(l, c)) = std::log(slice.amplitude[static_cast<std::size_t>(l)][static_cast<std::size_t>(c)]);
  }
  for (Eigen::Index c = 0; c < channels_; ++c) u(Constant(c)) = std::log(slice.constant[static_cast<std::size_t>(c)]);
  return u.cwiseMax(Low()).cwiseMin(High());
}

SelSlice SelObjective::ToSlice(const Coordinates& u) const {
  SelSlice slice;
  for (Eigen::Index l = 0; l < lobes_; ++l) {
    SelShape shape = ShapeAt(u, l);
    shape.psi = std::remainder(shape.psi, kPi);
    slice.lobes.push_back(shape);
    slice.amplitude.emplace_back();
    for (Eigen::Index c = 0; c < channels_; ++c) slice.amplitude.back().push_back(std::exp(u(Amplitude(l, c))));
  }
  for (Eigen::Index c = 0; c < channels_; ++c) slice.constant.push_back(std::exp(u(Constant(c))));
  return slice;
}

void SelObjective::EvaluateLobes(const Prepared& at, std::size_t sample, bool derivatives, LobeValues* values) const {
  for (std::size_t l = 0; l < at.lobes.size(); ++l) {
    double by[kShape];
    values->k[l] = at.lobes[l].Evaluate(samples_.v[sample], derivatives ? by : nullptr);
    if (!derivatives) continue;
    const SelShape& shape = at.shapes[l];
    const double s = at.s[l];
    values->dk[l] = {(1 - shape.alpha_x) * (by[0] * shape.alpha_x + by[1] * shape.alpha_y),
                     -2 * s * shape.alpha_y * by[1], by[2], by[3], by[4]};
  }
}

void SelObjective::AddGram(const ProductSums& sums, Eigen::Index channel, Eigen::MatrixXd* hessian) const {
  const auto coordinate = [&](Eigen::Index column) {
    const Eigen::Index own = column - kShape * lobes_;
    return own < 0 ? column : Amplitude(own, channel);
  };
  sums.ForEach([&](Eigen::Index j, Eigen::Index k, double sum) {
    const Eigen::Index row = coordinate(j), column = coordinate(k);
    (*hessian)(row, column) += sum;
    if (row != column) (*hessian)(column, row) += sum;
  });
}

void SelObjective::AddGram(const ProductSums& sums, Eigen::Index channel, ArrowMatrix* hessian) const {
  const auto c = static_cast<std::size_t>(channel);
  const Eigen::Index border = kShape * lobes_;
  sums.ForEach([&](Eigen::Index j, Eigen::Index k, double sum) {  // j <= k
    if (j < border && k >= border) {
      hessian->across[c](j, k - border) += sum;
      return;
    }
    const Eigen::Index first = j < border ? 0 : border;
    Eigen::MatrixXd* block = j < border ? &hessian->border : &hessian->own[c];
    (*block)(j - first, k - first) += sum;
    if (j != k) (*block)(k - first, j - first) += sum;
  });
}

ArrowMatrix SelObjective::EmptyArrow() const {
  ArrowShape shape;
  for (Eigen::Index k = 0; k < kShape * lobes_; ++k) shape.border.push_back(static_cast<int>(k));
  for (Eigen::Index c = 0; c < channels_; ++c) {
    shape.own.emplace_back();
    for (Eigen::Index l = 0; l <= lobes_; ++l) shape.own.back().push_back(static_cast<int>(Amplitude(l, c)));
  }
  return ArrowMatrix(shape);
}

double SelObjective::SumSquares(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
  if (hessian != nullptr) hessian->setZero(size(), size());
  return Sum(u, hessian, gradient);
}

double SelObjective::SumSquares(const Coordinates& u, ArrowMatrix* hessian, Eigen::VectorXd* gradient) const {
  *hessian = EmptyArrow();
  return Sum(u, hessian, gradient);
}

template <class Gram>
double SelObjective::Sum(const Coordinates& u, Gram* hessian, Eigen::VectorXd* gradient) const {
  const Prepared at(u, lobes_, channels_);
  const bool wanted = hessian != nullptr;
  if (wanted) gradient->setZero(size());
  // Rows of the Jacobian times the roots of the weights, of one channel: by the shapes of all lobes, then by its
  // amplitudes and its constant.
  const Eigen::Index shapes = kShape * lobes_, columns = shapes + lobes_ + 1;
  Eigen::MatrixXd rows;
  Eigen::VectorXd weighed;
  ProductSums products;
  const LobeValues empty = {std::vector<double>(at.lobes.size()),
                            std::vector<std::array<double, kShape>>(at.lobes.size())};
  constexpr std::size_t kPiece = 64;
  std::vector<LobeValues> values(std::min(kPiece, samples_.size()), empty);
  std::array<double, kPiece> to_f = {}, f = {}, residual = {}, slope = {};
  double sum = 0;
  for (std::size_t begin = 0; begin < samples_.size(); begin += kPiece) {
    const std::size_t count = std::min(kPiece, samples_.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      EvaluateLobes(at, begin + i, wanted, &values[i]);
      to_f[i] = options_.quantity == SelQuantity::kBrdf ? 1.0 : 1 / samples_.cos_o[begin + i];
    }
    for (Eigen::Index c = 0; c < channels_; ++c) {
      for (std::size_t i = 0; i < count; ++i) {
        double g = at.linear(lobes_ * channels_ + c);
        for (Eigen::Index l = 0; l < lobes_; ++l)
          g += at.linear(l * channels_ + c) * values[i].k[static_cast<std::size_t>(l)];
        f[i] = g * to_f[i];
      }
      Residuals(options_.transform, f.data(), samples_.cos_i.data() + begin,
                samples_.f_r[static_cast<std::size_t>(c)].data() + begin, nullptr, count, residual.data(),
                slope.data());
      for (std::size_t i = 0; i < count; ++i) sum += samples_.weight[begin + i] * residual[i] * residual[i];
      if (!wanted) continue;
      rows.setZero(static_cast<Eigen::Index>((count + 7) / 8 * 8), columns);
      weighed.resize(static_cast<Eigen::Index>(count));
      for (std::size_t i = 0; i < count; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const double root = std::sqrt(samples_.weight[begin + i]), factor = root * slope[i] * to_f[i];
        weighed(row) = root * residual[i];
        for (Eigen::Index l = 0; l < lobes_; ++l) {
          const auto lobe = static_cast<std::size_t>(l);
          const double a = at.linear(l * channels_ + c) * factor;
          for (Eigen::Index j = 0; j < kShape; ++j)
            rows(row, kShape * l + j) = a * values[i].dk[lobe][static_cast<std::size_t>(j)];
          rows(row, shapes + l) = a * values[i].k[lobe];
        }
        rows(row, shapes + lobes_) = at.linear(lobes_ * channels_ + c) * factor;
      }
      const Eigen::VectorXd slopes = rows.topRows(weighed.size()).transpose() * weighed;
      gradient->head(shapes) += slopes.head(shapes);
      for (Eigen::Index l = 0; l <= lobes_; ++l) (*gradient)(Amplitude(l, c)) += slopes(shapes + l);
      products.Sum(rows, 0, weighed.size(), weighed.size());
      AddGram(products, c, hessian);
    }
  }
  return sum;
}

void SelObjective::AddPull(const SelPull& pull, Eigen::Index lobe, const Coordinates& u, double* sum,
                           Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
  const SelShape shape = ShapeAt(u, lobe);
  const Features mine = FeaturesOf(shape), theirs = FeaturesOf((*pull.shapes)[static_cast<std::size_t>(lobe)]);
  const double s = u(kShape * lobe + 1), cosine = std::cos(2 * shape.psi), sine = std::sin(2 * shape.psi);
  // d(features) / d(t, s, offsets, psi).
  const double jacobian[5][kShape] = {{1 - shape.alpha_x, -s, 0, 0, 0},
                                      {0, s * cosine, 0, 0, -s * s * sine},
                                      {0, s * sine, 0, 0, s * s * cosine},
                                      {0, 0, 1, 0, 0},
                                      {0, 0, 0, 1, 0}};
  for (std::size_t f = 0; f < 5; ++f) {
    const double difference = mine[f] - theirs[f];
    *sum += pull.weight * difference * difference;
    if (hessian == nullptr) continue;
    for (Eigen::Index p = 0; p < kShape; ++p) {
      (*gradient)(kShape * lobe + p) += pull.weight * jacobian[f][p] * difference;
      for (Eigen::Index q = 0; q < kShape; ++q)
        (*hessian)(kShape * lobe + p, kShape * lobe + q) += pull.weight * jacobian[f][p] * jacobian[f][q];
    }
  }
}

double SelObjective::Pulls(const Coordinates& u, Eigen::MatrixXd* hessian, Eigen::VectorXd* gradient) const {
  double sum = 0;
  for (const SelPull& pull : pulls_) {
    for (Eigen::Index l = 0; l < lobes_; ++l) AddPull(pull, l, u, &sum, hessian, gradient);
  }
  return sum;
}

}  // namespace lobefit
