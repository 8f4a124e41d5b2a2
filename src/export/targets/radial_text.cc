#include "lobefit/export/targets/radial_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "lobefit/export/targets/text.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

constexpr std::size_t kNodes = 6;       // of a polynomial: the fifth degree
constexpr double kAccuracy = 2e-7;      // what single precision shows
constexpr double kShortest = 1.0 / 64;  // piece
constexpr double kTailFrom = 32;        // a; from there on M is a power of a but for 1/a^4
constexpr double kNothing = 1e-9;

// The polynomial through the function at Chebyshev's points of [from, to], in x - from.
std::vector<double> Interpolate(const std::function<double(double)>& f, double from, double to) {
  std::array<double, kNodes> x, divided;
  for (std::size_t k = 0; k < kNodes; ++k) {
    x[k] = 0.5 * (to - from) * (1 - std::cos(kPi * (static_cast<double>(k) + 0.5) / kNodes));
    divided[k] = f(from + x[k]);
  }
  for (std::size_t level = 1; level < kNodes; ++level) {
    for (std::size_t k = kNodes; k-- > level;) divided[k] = (divided[k] - divided[k - 1]) / (x[k] - x[k - level]);
  }
  // Newton's form multiplied out.
  std::vector<double> powers(kNodes, 0.0);
  for (std::size_t k = kNodes; k-- > 0;) {
    for (std::size_t p = kNodes - 1; p > 0; --p) powers[p] = powers[p - 1] - x[k] * powers[p];
    powers[0] = divided[k] - x[k] * powers[0];
  }
  return powers;
}

double At(const std::vector<double>& powers, double x) {
  double value = 0;
  for (std::size_t p = powers.size(); p-- > 0;) value = powers[p] + x * value;
  return value;
}

void AddPieces(const std::function<double(double)>& f, double from, double to, PiecewisePolynomial* result) {
  const std::vector<double> powers = Interpolate(f, from, to);
  double worst = 0;
  for (int k = 0; k <= 2 * static_cast<int>(kNodes); ++k) {
    const double x = (to - from) * k / (2.0 * kNodes), wanted = f(from + x);
    worst = std::max(worst, std::abs(At(powers, x) - wanted) / std::max(1.0, wanted));
  }
  if (worst > kAccuracy && to - from > kShortest) {
    AddPieces(f, from, 0.5 * (from + to), result);
    AddPieces(f, 0.5 * (from + to), to, result);
    return;
  }
  result->from.push_back(from);
  result->coefficients.push_back(powers);
}

// "if (x < b) { value = ...; } else ..." of all pieces; they assign to `value`.
std::string PiecesText(const PiecewisePolynomial& pieces, const std::string& variable) {
  std::string text;
  for (std::size_t i = 0; i < pieces.from.size(); ++i) {
    const std::vector<double>& c = pieces.coefficients[i];
    std::size_t terms = c.size();
    while (terms > 1 && c[terms - 1] == 0) --terms;
    std::string polynomial = FloatLiteral(c[terms - 1]);
    for (std::size_t p = terms - 1; p-- > 0;) polynomial = fmt::format("{} + x * ({})", FloatLiteral(c[p]), polynomial);
    const std::string statements =
        fmt::format("{{ x = {} - {}; value = {}; }}\n", variable, FloatLiteral(pieces.from[i]), polynomial);
    const bool last = i + 1 == pieces.from.size();
    text += i == 0 ? "  " : "  else ";
    text += last ? statements : fmt::format("if ({} < {}) {}", variable, FloatLiteral(pieces.from[i + 1]), statements);
  }
  return text;
}

}  // namespace

PiecewisePolynomial ProfileExcess(const Profile& profile) {
  const ProfileSpline& spline = profile.spline();
  const std::size_t size = spline.size();
  PiecewisePolynomial result;
  for (std::size_t i = 0; i < spline.intervals(); ++i) {
    std::vector<double> cubic(4, 0.0);
    for (std::size_t p = 0; p < 4; ++p) {
      for (std::size_t k = 0; k < size; ++k) cubic[p] += profile.q()[k] * spline.Coefficients(i)[p * size + k];
    }
    cubic[0] -= std::log1p(profile.mass_excess());
    result.from.push_back(spline.Left(i));
    result.coefficients.push_back(cubic);
  }
  return result;
}

MaskingRatio MaskingRatioOf(const Lobe& lobe, const LobeShape& shape) {
  const ProfileMasking& masking = *shape.masking;
  // Student's M(a) is scale M(a / scale) of the power law.
  const double scale = FamilyOf(lobe.ndf) == Family::kStudent ? std::sqrt(shape.exponent - 1) : 1;
  std::vector<double> row(masking.stride());
  const auto ratio = [&](double w) {
    const double a = std::sinh(w) / scale;
    masking.Differences(&a, 1, nullptr, row.data());
    const double ggx = 0.5 / (a + std::sqrt(1 + a * a));
    return 2 * std::exp(w) * scale * std::max(0.0, ggx + row[0]);
  };
  MaskingRatio result;
  std::vector<double> breaks;
  for (const double knot : masking.profile().spline().knots()) breaks.push_back(std::asinh(scale * knot));
  const double tail_from = std::asinh(kTailFrom * scale);
  if (breaks.back() < tail_from) breaks.push_back(tail_from);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) AddPieces(ratio, breaks[i], breaks[i + 1], &result.pieces);
  const double end = result.end = breaks.back(), at_end = ratio(end);
  if (at_end < kNothing) return result;
  const double slope = 4 - 2 * masking.profile().tail_exponent(), step = 2;
  const double near = std::exp(-2 * end), far = std::exp(-2 * (end + step));
  const double bend = (std::log(at_end / ratio(end + step)) + slope * step) / (near - far);
  result.tail = {std::log(at_end) - bend * near, slope, bend};
  return result;
}

bool IsRadial(const Lobe& lobe) {
  const Family family = FamilyOf(lobe.ndf);
  return family == Family::kProfile || family == Family::kStudent;
}

std::string RadialFunctions(const std::string& prefix, const Lobe& lobe, const LobeShape& shape) {
  std::string text;
  if (FamilyOf(lobe.ndf) == Family::kStudent) {
    text = fmt::format("float {}excess(float u) {{ return 2.0 * u - {} * log(1.0 + (exp(u) - 1.0) / {}); }}\n", prefix,
                       FloatLiteral(shape.exponent), FloatLiteral(shape.exponent - 1));
  } else {
    text = fmt::format("float {}excess(float u) {{\n  float x = 0.0;\n  float value = 0.0;\n{}  return value;\n}}\n",
                       prefix, PiecesText(ProfileExcess(shape.masking->profile()), "u"));
  }
  const MaskingRatio ratio = MaskingRatioOf(lobe, shape);
  const std::string tail = ratio.tail.empty() ? "0.0"
                                              : fmt::format("exp({} + {} * (w - {}) + {} * exp(-2.0 * w))",
                                                            FloatLiteral(ratio.tail[0]), FloatLiteral(ratio.tail[1]),
                                                            FloatLiteral(ratio.end), FloatLiteral(ratio.tail[2]));
  return text + fmt::format(
                    "float {}ratio(float w) {{\n  float x = 0.0;\n  float value = 0.0;\n  if (w >= {}) {{ value = {}; "
                    "}} else\n{}  return value;\n}}\n",
                    prefix, FloatLiteral(ratio.end), tail, PiecesText(ratio.pieces, "w"));
}

}  // namespace lobefit
