#include "lobefit/fit/kernel.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lobefit/core/diffuse_facets.h"
#include "lobefit/core/lobe.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobefit/fit/kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h:
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace lobefit {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D64 = hn::ScalableTag<double>;
using V64 = hn::Vec<D64>;

HWY_INLINE V64 Load(const double* p) { return hn::LoadU(D64(), p); }
HWY_INLINE V64 Constant(double x) { return hn::Set(D64(), x); }

// Cube root by exp and log with one step of Newton's method; odd, 0 at 0.
HWY_INLINE V64 CubeRoot(V64 x) {
  const D64 d;
  const V64 magnitude = hn::Max(hn::Abs(x), Constant(1e-300));
  V64 y = hn::Exp(d, hn::Mul(hn::Log(d, magnitude), Constant(1.0 / 3)));
  const V64 y2 = hn::Mul(y, y);
  y = hn::Sub(y, hn::Div(hn::Sub(hn::Mul(y2, y), magnitude), hn::Mul(Constant(3), y2)));
  return hn::IfThenElse(hn::Eq(x, hn::Zero(d)), hn::Zero(d), hn::CopySign(y, x));
}

// T(f) and, where `slope` is not null, dT/df.
HWY_INLINE V64 ApplyTransform(Transform transform, V64 f, V64 cos_i, V64 target, V64* slope) {
  const D64 d;
  const V64 v = hn::Mul(f, cos_i);
  switch (transform) {
    case Transform::kLog1p:
      if (slope != nullptr) *slope = hn::Div(cos_i, hn::Add(Constant(1), v));
      return hn::Log1p(d, v);
    case Transform::kCubeRoot: {
      const V64 root = CubeRoot(v);
      if (slope != nullptr)
        *slope = hn::Div(cos_i, hn::Mul(Constant(3), hn::Max(hn::Mul(root, root), Constant(1e-200))));
      return root;
    }
    case Transform::kRelative: {
      const V64 inverse = hn::Div(Constant(1), target);
      if (slope != nullptr) *slope = inverse;
      return hn::Mul(f, inverse);
    }
    case Transform::kLinear:
      break;
  }
  if (slope != nullptr) *slope = cos_i;
  return v;
}

void TransformArrays(int transform, const double* f_r, const double* cos_i, std::size_t count, double* target) {
  const std::size_t lanes = hn::Lanes(D64());
  const V64 one = Constant(1);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::StoreU(ApplyTransform(static_cast<Transform>(transform), Load(f_r + i), Load(cos_i + i), one, nullptr), D64(),
               target + i);
  }
  if (i == count) return;
  constexpr std::size_t kMaxLanes = hn::MaxLanes(D64());
  double pad_f[kMaxLanes] = {}, pad_c[kMaxLanes] = {}, out[kMaxLanes];
  std::copy(f_r + i, f_r + count, pad_f);
  std::copy(cos_i + i, cos_i + count, pad_c);
  hn::StoreU(ApplyTransform(static_cast<Transform>(transform), Load(pad_f), Load(pad_c), one, nullptr), D64(), out);
  std::copy(out, out + (count - i), target + i);
}

// Schlick's factor of one channel, f0 + (1 - f0) p5, and its derivative 1 - p5, with p5 = (1 - cos_d)^5 (n a multiple
// of the lanes).
void SchlickArrays(const double* cos_d, double f0, std::size_t n, double* factor, double* derivative) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    const V64 x = hn::Sub(Constant(1), Load(cos_d + i));
    const V64 x2 = hn::Mul(x, x);
    const V64 p5 = hn::Mul(hn::Mul(x2, x2), x);
    hn::StoreU(hn::MulAdd(Constant(1 - f0), p5, Constant(f0)), D64(), factor + i);
    hn::StoreU(hn::Sub(Constant(1), p5), D64(), derivative + i);
  }
}

// to[k] = sum_j jacobian[j][k] from[j], arrays of n with the given strides.
void ContractArrays(const double* from, const double* jacobian, std::size_t columns, std::size_t n, std::size_t stride,
                    double* to) {
  for (std::size_t k = 0; k < columns; ++k) {
    for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
      V64 sum = hn::Zero(D64());
      for (std::size_t j = 0; j < 5; ++j)
        sum = hn::MulAdd(Constant(jacobian[j * columns + k]), Load(from + j * stride + i), sum);
      hn::StoreU(sum, D64(), to + k * stride + i);
    }
  }
}

// to += a * b.
void AddProductArrays(const double* a, const double* b, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64()))
    hn::StoreU(hn::MulAdd(Load(a + i), Load(b + i), Load(to + i)), D64(), to + i);
}

// to += factor * a.
void AddScaledArrays(const double* a, double factor, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64()))
    hn::StoreU(hn::MulAdd(Constant(factor), Load(a + i), Load(to + i)), D64(), to + i);
}

// residual = sqrt_weight (T(f) - target), slope = sqrt_weight dT/df (null: not wanted).
void ResidualArrays(int transform, const double* f, const double* cos_i, const double* target,
                    const double* sqrt_weight, std::size_t n, double* residual, double* slope) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    V64 g = hn::Zero(D64());
    const V64 w = Load(sqrt_weight + i), t = Load(target + i);
    const V64 value = ApplyTransform(static_cast<Transform>(transform), Load(f + i), Load(cos_i + i), t,
                                     slope != nullptr ? &g : nullptr);
    const V64 reference = static_cast<Transform>(transform) == Transform::kRelative ? Constant(1) : t;
    hn::StoreU(hn::Mul(w, hn::Sub(value, reference)), D64(), residual + i);
    if (slope != nullptr) hn::StoreU(hn::Mul(w, g), D64(), slope + i);
  }
}

// Shape columns of one lobe and channel: to[k] = slope * factor * gradient[k], plus slope * albedo *
// diffuse_gradient[k] where that is not null.
void ShapeColumnArrays(const double* slope, const double* factor, const double* gradient, double albedo,
                       const double* diffuse_gradient, std::size_t columns, std::size_t n, std::size_t stride,
                       double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) {
    const V64 s = Load(slope + i), product = hn::Mul(s, Load(factor + i));
    for (std::size_t k = 0; k < columns; ++k) {
      V64 column = hn::Mul(product, Load(gradient + k * stride + i));
      if (diffuse_gradient != nullptr)
        column = hn::MulAdd(hn::Mul(s, Constant(albedo)), Load(diffuse_gradient + k * stride + i), column);
      hn::StoreU(column, D64(), to + k * stride + i);
    }
  }
}

// to = a * b * c.
void ProductArrays(const double* a, const double* b, const double* c, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64()))
    hn::StoreU(hn::Mul(hn::Mul(Load(a + i), Load(b + i)), Load(c + i)), D64(), to + i);
}

void MultiplyArrays(const double* a, const double* b, std::size_t n, double* to) {
  for (std::size_t i = 0; i < n; i += hn::Lanes(D64())) hn::StoreU(hn::Mul(Load(a + i), Load(b + i)), D64(), to + i);
}

// Adds the upper triangle of the Gram matrix of `columns` arrays to `gram`, row by row.
void GramArrays(const double* columns, std::size_t count, std::size_t n, std::size_t stride, double* gram) {
  const D64 d;
  for (std::size_t i = 0; i < count; ++i) {
    const double* a = columns + i * stride;
    std::size_t j = i;
    for (; j + 4 <= count; j += 4) {
      const double* b = columns + j * stride;
      V64 s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0;
      for (std::size_t k = 0; k < n; k += hn::Lanes(d)) {
        const V64 x = Load(a + k);
        s0 = hn::MulAdd(x, Load(b + k), s0);
        s1 = hn::MulAdd(x, Load(b + stride + k), s1);
        s2 = hn::MulAdd(x, Load(b + 2 * stride + k), s2);
        s3 = hn::MulAdd(x, Load(b + 3 * stride + k), s3);
      }
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s0));
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s1));
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s2));
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s3));
    }
    for (; j < count; ++j) {
      const double* b = columns + j * stride;
      V64 s0 = hn::Zero(d);
      for (std::size_t k = 0; k < n; k += hn::Lanes(d)) s0 = hn::MulAdd(Load(a + k), Load(b + k), s0);
      *gram++ += hn::GetLane(hn::SumOfLanes(d, s0));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace lobefit
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobefit {
namespace {

HWY_EXPORT(TransformArrays);
HWY_EXPORT(SchlickArrays);
HWY_EXPORT(ContractArrays);
HWY_EXPORT(AddProductArrays);
HWY_EXPORT(AddScaledArrays);
HWY_EXPORT(ResidualArrays);
HWY_EXPORT(ShapeColumnArrays);
HWY_EXPORT(ProductArrays);
HWY_EXPORT(MultiplyArrays);
HWY_EXPORT(GramArrays);

// 256 samples: the columns of one channel of a one-lobe model take 16 KB, half of a first-level cache.
constexpr std::size_t kBlock = 256;

double Rho(Loss loss, double scale, double s, double* weight) {
  const double a2 = scale * scale;
  switch (loss) {
    case Loss::kHuber: {
      if (s <= a2) break;
      const double r = std::sqrt(s);
      *weight = scale / r;
      return 2 * scale * r - a2;
    }
    case Loss::kCauchy:
      *weight = 1 / (1 + s / a2);
      return a2 * std::log1p(s / a2);
    case Loss::kTukey: {
      const double t = s < a2 ? 1 - s / a2 : 0;
      *weight = t * t;
      return a2 / 3 * (1 - t * t * t);
    }
    case Loss::kNone:
      break;
  }
  *weight = 1;
  return s;
}

// One block of samples: the model's values, residuals and columns. Arrays of kBlock, padded so that pads add nothing to
// any sum.
class Block {
 public:
  Block(const KernelSamples& samples, const KernelModel& model, bool gradient)
      : samples_(samples), model_(model), gradient_(gradient) {
    const std::size_t lobes = model.lobes.size(), channels = model.channels;
    specular_.assign(lobes * kBlock, 0);
    gradients_.assign(gradient ? 5 * kBlock : 0, 0);
    contracted_.assign(gradient ? (lobes + 1) * 5 * kBlock : 0, 0);
    cos_d_.assign(kBlock, 0);
    diffuse_.assign(kBlock, kInvPi);
    ones_.assign(kBlock, 1);
    for (const KernelLobe& lobe : model.lobes) {
      first_fresnel_.push_back(fresnel_size_);
      fresnel_size_ += FresnelParameters(lobe.kind.fresnel);
    }
    factor_.assign(channels * lobes * kBlock, 1);
    factor_gradient_.assign(channels * fresnel_size_ * kBlock, 1);
    f_.assign(channels * kBlock, 0);
    residual_.assign(channels * kBlock, 0);
    slope_.assign(gradient ? channels * kBlock : 0, 0);
    columns_.assign(gradient ? model.columns() * kBlock : 0, 0);
    if (model.diffuse_kind == Diffuse::kMicrofacet && !model.diffuse.empty())
      facets_.emplace(model.lobes[0].kind, model.lobes[0].shape);
  }

  // Values of samples [begin, begin + count), count <= kBlock.
  void Evaluate(std::size_t begin, std::size_t count) {
    count_ = count;
    padded_ = (count + 7) / 8 * 8;  // no target has more than 8 lanes
    DirectionArrays directions = {};
    const double** fields[] = {&directions.wi_x, &directions.wi_y, &directions.wi_z,
                               &directions.wo_x, &directions.wo_y, &directions.wo_z};
    for (std::size_t k = 0; k < 6; ++k) *fields[k] = samples_.direction[k] + begin;
    directions.count = count;
    cos_i_ = Padded(directions.wi_z, 0.0, &cos_i_pad_);
    for (std::size_t l = 0; l < model_.lobes.size(); ++l) EvaluateLobe(l, directions);
    if (facets_) {
      facets_->Evaluate(directions, diffuse_.data(), gradient_ ? gradients_.data() : nullptr);
      std::fill(diffuse_.begin() + static_cast<std::ptrdiff_t>(count_), diffuse_.end(), 0.0);
      if (gradient_) ContractGradients(0, diffuse_contracted());
    }
    for (std::size_t c = 0; c < model_.channels; ++c) {
      double* f = f_.data() + c * kBlock;
      std::fill_n(f, padded_, 0.0);
      if (!model_.diffuse.empty()) {
        HWY_DYNAMIC_DISPATCH(AddScaledArrays)(diffuse_.data(), model_.diffuse[c], padded_, f);
      }
      for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
        EvaluateFresnel(l, c);
        HWY_DYNAMIC_DISPATCH(AddProductArrays)(specular_.data() + l * kBlock, factor(c, l), padded_, f);
      }
    }
  }

  // Residuals (and slopes), reweighted by the loss. Returns the sum of rho.
  double Residuals(std::size_t begin, double* sum_robust_weight) {
    const double* sqrt_weight =
        Padded(samples_.sqrt_weight != nullptr ? samples_.sqrt_weight + begin : ones_.data(), 0.0, &sqrt_weight_pad_);
    for (std::size_t c = 0; c < model_.channels; ++c) {
      const double* target = Padded(samples_.target[c] + begin, 1.0, &target_pad_);
      HWY_DYNAMIC_DISPATCH(ResidualArrays)
      (static_cast<int>(model_.transform), f_.data() + c * kBlock, cos_i_, target, sqrt_weight, padded_,
       residual_.data() + c * kBlock, gradient_ ? slope_.data() + c * kBlock : nullptr);
    }
    double sum = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      double s = 0, weight = 1;
      for (std::size_t c = 0; c < model_.channels; ++c) s += residual_[c * kBlock + i] * residual_[c * kBlock + i];
      sum += Rho(model_.loss, model_.loss_scale, s, &weight);
      *sum_robust_weight += weight;
      if (model_.loss == Loss::kNone) continue;
      const double root = std::sqrt(weight);
      for (std::size_t c = 0; c < model_.channels; ++c) {
        residual_[c * kBlock + i] *= root;
        if (gradient_) slope_[c * kBlock + i] *= root;
      }
    }
    return sum;
  }

  // Columns of one channel, kBlock apart; the last is the residual.
  const std::vector<double>& Columns(std::size_t c) {
    const double* slope = slope_.data() + c * kBlock;
    double* to = columns_.data();
    for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
      const bool facets = facets_ && l == 0;
      HWY_DYNAMIC_DISPATCH(ShapeColumnArrays)
      (slope, factor(c, l), contracted_.data() + l * 5 * kBlock, facets ? model_.diffuse[c] : 0.0,
       facets ? diffuse_contracted() : nullptr, model_.lobes[l].columns, padded_, kBlock, to);
      to += model_.lobes[l].columns * kBlock;
    }
    for (std::size_t l = 0; l < model_.lobes.size(); ++l) {
      for (std::size_t k = 0; k < FresnelParameters(model_.lobes[l].kind.fresnel); ++k, to += kBlock) {
        HWY_DYNAMIC_DISPATCH(ProductArrays)
        (slope, specular_.data() + l * kBlock, factor_gradient(c, first_fresnel_[l] + k), padded_, to);
      }
    }
    if (!model_.diffuse.empty()) {
      HWY_DYNAMIC_DISPATCH(MultiplyArrays)(slope, diffuse_.data(), padded_, to);
      to += kBlock;
    }
    std::copy_n(residual_.data() + c * kBlock, padded_, to);
    return columns_;
  }

  std::size_t padded() const { return padded_; }
  const double* f(std::size_t c) const { return f_.data() + c * kBlock; }

 private:
  void EvaluateLobe(std::size_t l, const DirectionArrays& directions) {
    const KernelLobe& lobe = model_.lobes[l];
    double* specular = specular_.data() + l * kBlock;
    SpecularLobe(directions, lobe.kind, lobe.shape, specular, cos_d_.data(), gradient_ ? gradients_.data() : nullptr);
    std::fill(specular + count_, specular + padded_, 0.0);
    std::fill(cos_d_.begin() + static_cast<std::ptrdiff_t>(count_), cos_d_.end(), 1.0);
    if (gradient_) ContractGradients(l, contracted_.data() + l * 5 * kBlock);
  }

  // gradients_, by slope coordinates, to the solver's coordinates of lobe l. They were written with a stride of
  // `count_`: the last, shorter block is spread to kBlock first.
  void ContractGradients(std::size_t l, double* to) {
    double* gradients = gradients_.data();
    for (std::size_t j = 5; j-- > 0 && count_ < kBlock;) {
      std::copy_backward(gradients + j * count_, gradients + (j + 1) * count_, gradients + j * kBlock + count_);
      std::fill(gradients + j * kBlock + count_, gradients + j * kBlock + padded_, 0.0);
    }
    HWY_DYNAMIC_DISPATCH(ContractArrays)
    (gradients, model_.lobes[l].jacobian.data(), model_.lobes[l].columns, padded_, kBlock, to);
  }

  // Fresnel factor of lobe l in channel c, and its derivatives.
  void EvaluateFresnel(std::size_t l, std::size_t c) {
    const KernelLobe& lobe = model_.lobes[l];
    const std::size_t size = FresnelParameters(lobe.kind.fresnel);
    const double* parameters = lobe.fresnel.data() + c * size;
    double* value = factor(c, l);
    if (lobe.kind.fresnel == Fresnel::kSchlick) {
      HWY_DYNAMIC_DISPATCH(SchlickArrays)
      (cos_d_.data(), parameters[0], padded_, value, factor_gradient(c, first_fresnel_[l]));
    } else if (lobe.kind.fresnel == Fresnel::kNone) {
      std::fill_n(value, padded_, parameters[0]);  // its derivative is 1 from the start
    } else {
      for (std::size_t i = 0; i < padded_; ++i) {
        double dF[kMaxFresnelParameters];
        value[i] = FresnelFactor(lobe.kind.fresnel, parameters, cos_d_[i], gradient_ ? dF : nullptr);
        for (std::size_t k = 0; gradient_ && k < size; ++k) factor_gradient(c, first_fresnel_[l] + k)[i] = dF[k];
      }
    }
  }

  double* factor(std::size_t c, std::size_t l) { return factor_.data() + (c * model_.lobes.size() + l) * kBlock; }
  double* factor_gradient(std::size_t c, std::size_t k) {
    return factor_gradient_.data() + (c * fresnel_size_ + k) * kBlock;
  }
  double* diffuse_contracted() { return contracted_.data() + model_.lobes.size() * 5 * kBlock; }

  // An input array of this block: in place where the block is full, else a copy with `pad` behind it.
  const double* Padded(const double* from, double pad, std::vector<double>* copy) const {
    if (padded_ == count_) return from;
    copy->assign(from, from + count_);
    copy->resize(padded_, pad);
    return copy->data();
  }

  const KernelSamples& samples_;
  const KernelModel& model_;
  const bool gradient_;
  std::size_t count_ = 0, padded_ = 0;
  const double* cos_i_ = nullptr;
  std::optional<DiffuseFacets> facets_;
  std::size_t fresnel_size_ = 0;            // of all lobes
  std::vector<std::size_t> first_fresnel_;  // of each lobe
  std::vector<double> specular_, gradients_, contracted_, cos_d_, factor_, factor_gradient_, diffuse_;
  std::vector<double> f_, residual_, slope_, columns_, ones_;
  std::vector<double> cos_i_pad_, sqrt_weight_pad_, target_pad_;
};

}  // namespace

Transform TransformOf(Metric metric) {
  switch (metric) {
    case Metric::kCubeRoot:
      return Transform::kCubeRoot;
    case Metric::kRelative:
      return Transform::kRelative;
    case Metric::kCosineL2:
    case Metric::kNgan:
      return Transform::kLinear;
    case Metric::kLog:
    case Metric::kLowLog:
      break;
  }
  return Transform::kLog1p;
}

std::size_t KernelModel::shape_columns() const {
  std::size_t sum = 0;
  for (const KernelLobe& lobe : lobes) sum += lobe.columns;
  return sum;
}

std::size_t KernelModel::columns() const {
  std::size_t sum = shape_columns() + (diffuse.empty() ? 0 : 1) + 1;
  for (const KernelLobe& lobe : lobes) sum += FresnelParameters(lobe.kind.fresnel);
  return sum;
}

void TransformMeasured(Transform transform, const double* f_r, const double* cos_theta_i, std::size_t count,
                       double* target) {
  if (transform == Transform::kRelative) {
    std::copy_n(f_r, count, target);
    return;
  }
  HWY_DYNAMIC_DISPATCH(TransformArrays)(static_cast<int>(transform), f_r, cos_theta_i, count, target);
}

void Accumulate(const KernelSamples& samples, const KernelModel& model, bool gradient, std::size_t begin,
                std::size_t end, KernelSums* sums) {
  Block block(samples, model, gradient);
  const std::size_t columns = model.columns();
  if (gradient && sums->gram.empty())
    sums->gram.assign(model.channels, std::vector<double>(columns * (columns + 1) / 2, 0.0));
  for (std::size_t i = begin; i < end; i += kBlock) {
    block.Evaluate(i, std::min(kBlock, end - i));
    sums->sum_rho += block.Residuals(i, &sums->sum_robust_weight);
    for (std::size_t c = 0; gradient && c < model.channels; ++c) {
      HWY_DYNAMIC_DISPATCH(GramArrays)(block.Columns(c).data(), columns, block.padded(), kBlock, sums->gram[c].data());
    }
  }
}

void Scores(const KernelSamples& samples, const KernelModel& model, std::size_t begin, std::size_t end,
            std::vector<std::vector<double>>* scores) {
  const std::size_t shape = model.shape_columns(), residual_column = model.columns() - 1,
                    linear = residual_column - shape;
  scores->assign(shape + linear * model.channels, std::vector<double>(end - begin, 0.0));
  Block block(samples, model, true);
  double unused = 0;
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    block.Evaluate(i, count);
    block.Residuals(i, &unused);
    for (std::size_t c = 0; c < model.channels; ++c) {
      const std::vector<double>& columns = block.Columns(c);
      const double* residual = columns.data() + residual_column * kBlock;
      for (std::size_t j = 0; j < residual_column; ++j) {
        std::vector<double>& to = (*scores)[j < shape ? j : j + c * linear];
        for (std::size_t k = 0; k < count; ++k) to[i - begin + k] += columns[j * kBlock + k] * residual[k];
      }
    }
  }
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
#endif  // HWY_ONCE
