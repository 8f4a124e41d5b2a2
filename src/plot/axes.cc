#include "lobefit/plot/axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "lobefit/plot/style.h"

namespace lobefit {
namespace {

std::string TickLabel(double value, double step) {
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, std::fabs(value));
  const bool is_zero = std::string(text.data()).find_first_of("123456789") == std::string::npos;
  return (value < 0 && !is_zero ? "−" : "") + std::string(text.data());
}

std::vector<Tick> TicksAt(double low, double high, double step) {
  std::vector<Tick> ticks;
  const double slack = 1e-9 * (high - low);
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; ++k)
    ticks.push_back({k * step, TickLabel(k * step, step)});
  return ticks;
}

std::string PowerLabel(int exponent) {
  if (exponent == 0) return "1";
  if (exponent == 1) return "10";
  return "10^{" + std::string(exponent < 0 ? "−" : "") + std::to_string(std::abs(exponent)) + "}";
}

// Labels that keep clear of each other along a line, which is true at their index: powers of ten first, then those of 2
// and 5, then the others.
std::vector<bool> Legible(const Canvas& canvas, const std::vector<Tick>& ticks, const std::vector<double>& places,
                          bool logarithmic) {
  constexpr double kClear = 7;
  const auto rank = [logarithmic](double value) {
    if (!logarithmic) return 0;
    const long digit = std::lround(value / std::pow(10, std::floor(std::log10(value) + 1e-9)));
    return digit == 1 ? 0 : digit == 2 || digit == 5 ? 1 : 2;
  };
  std::vector<bool> legible(ticks.size(), false);
  std::vector<std::pair<double, double>> taken;
  for (int now = 0; now <= 2; ++now) {
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      if (ticks[i].label.empty() || rank(ticks[i].value) != now) continue;
      const double half = canvas.TextWidth(ticks[i].label, style::Tick(Align::kCenter)) / 2 + kClear / 2;
      const double low = places[i] - half, high = places[i] + half;
      legible[i] = std::none_of(taken.begin(), taken.end(),
                                [&](const auto& other) { return low < other.second && other.first < high; });
      if (legible[i]) taken.emplace_back(low, high);
    }
  }
  return legible;
}

double Fraction(const Range& range, double v) {
  if (range.logarithmic) return std::log(v / range.low) / std::log(range.high / range.low);
  return (v - range.low) / (range.high - range.low);
}

}  // namespace

std::vector<Tick> LinearTicks(double low, double high, int target) {
  if (!(high > low)) return {{low, TickLabel(low, std::max(std::fabs(low), 1.0) / 100)}};
  const double raw = (high - low) / std::max(1, target);
  const double power = std::pow(10, std::floor(std::log10(raw)));
  // The finest step that makes no more ticks than wanted, or the next finer one where less than three would be left.
  constexpr std::size_t kLeast = 3;
  std::vector<Tick> ticks;
  for (const double digit : {10.0, 5.0, 2.0, 1.0, 0.5}) {
    if (digit * power < raw * (1 - 1e-9) && ticks.size() >= kLeast) break;
    ticks = TicksAt(low, high, digit * power);
  }
  return ticks;
}

std::vector<Tick> AngleTicks(double low, double high, int target) {
  const double raw = (high - low) / std::max(1, target);
  if (raw < 1) return LinearTicks(low, high, target);
  for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0}) {
    if (step >= raw * (1 - 1e-9)) return TicksAt(low, high, step);
  }
  return TicksAt(low, high, 90);
}

std::vector<Tick> LogTicks(double low, double high, int target) {
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9)),
            last = static_cast<int>(std::ceil(std::log10(high) - 1e-9));
  const double decades = std::log10(high / low);
  const int stride = std::max(1, static_cast<int>(std::ceil(decades / std::max(1, target))));
  const double slack = 1 + 1e-9;
  const auto inside = [&](double v) { return v * slack >= low && v <= high * slack; };
  for (int e = first; e <= last; ++e) {
    const double power = std::pow(10, e);
    // Strides count from zero, so that 1 keeps its label.
    const bool plain = decades < 2 && std::abs(e) <= 3;  // beside labels such as 0.2
    if (inside(power)) ticks.push_back({power, plain ? TickLabel(power, power) : e % stride == 0 ? PowerLabel(e) : ""});
    for (int digit = 2; stride == 1 && digit < 10 && e < last; ++digit) {
      if (!inside(digit * power)) continue;
      const bool labelled = decades < 1 || (decades < 2 && (digit == 2 || digit == 5));
      ticks.push_back({digit * power, labelled ? TickLabel(digit * power, power) : ""});
    }
  }
  return ticks;
}

Range LogRangeAround(double low, double high) {
  const auto step_below = [](double v) {
    const double power = std::pow(10, std::floor(std::log10(v) + 1e-9));
    return v * (1 + 1e-9) >= 5 * power ? 5 * power : v * (1 + 1e-9) >= 2 * power ? 2 * power : power;
  };
  if (std::log10(high / low) > 3)
    return {std::pow(10, std::floor(std::log10(low) + 1e-9)), std::pow(10, std::ceil(std::log10(high) - 1e-9)), true};
  const double below = step_below(low);
  double above = step_below(high);
  if (above < high * (1 - 1e-9)) above = step_below(above * 2.6);
  return {below, above > below ? above : 2 * below, true};
}

double Axes::MapX(double x) const { return frame_.x + frame_.width * Fraction(x_, x); }
double Axes::MapY(double y) const { return frame_.bottom() - frame_.height * Fraction(y_, y); }

void Axes::DrawGrid(Canvas* canvas, const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks) const {
  const Stroke stroke = {style::kGrid, 0.5};
  for (const Tick& tick : x_ticks) {
    const double x = MapX(tick.value);
    if (!tick.label.empty() && x > frame_.x + 1 && x < frame_.right() - 1)
      canvas->Line({x, frame_.y}, {x, frame_.bottom()}, stroke);
  }
  for (const Tick& tick : y_ticks) {
    const double y = MapY(tick.value);
    if (!tick.label.empty() && y > frame_.y + 1 && y < frame_.bottom() - 1)
      canvas->Line({frame_.x, y}, {frame_.right(), y}, stroke);
  }
}

void Axes::DrawFrame(Canvas* canvas, const std::vector<Tick>& x_ticks, const std::vector<Tick>& y_ticks, bool x_labels,
                     bool y_labels) const {
  const Stroke line = {style::kSecondary, 0.5};
  canvas->Frame(frame_, line);
  std::vector<double> places;
  for (const Tick& tick : x_ticks) places.push_back(MapX(tick.value));
  const std::vector<bool> legible = Legible(*canvas, x_ticks, places, x_.logarithmic);
  for (std::size_t i = 0; i < x_ticks.size(); ++i) {
    const Tick& tick = x_ticks[i];
    const double x = places[i], length = tick.label.empty() ? 2.5 : 4;
    canvas->Line({x, frame_.bottom()}, {x, frame_.bottom() - length}, line);
    if (!x_labels || !legible[i]) continue;
    TextStyle text = style::Tick(Align::kCenter);
    text.baseline = Baseline::kTop;
    canvas->Text({x, frame_.bottom() + 5}, tick.label, text);
  }
  for (const Tick& tick : y_ticks) {
    const double y = MapY(tick.value), length = tick.label.empty() ? 2.5 : 4;
    canvas->Line({frame_.x, y}, {frame_.x + length, y}, line);
    if (y_labels && !tick.label.empty()) canvas->Text({frame_.x - 5, y}, tick.label, style::Tick(Align::kRight));
  }
}

void Axes::DrawXLabel(Canvas* canvas, const std::string& label) const {
  canvas->Text({frame_.center().x, frame_.bottom() + 34}, label,
               {.size = style::kBodySize, .color = style::kInk, .align = Align::kCenter, .markup = true});
}

void Axes::DrawYLabel(Canvas* canvas, const std::string& label, double y_label_room) const {
  canvas->Text(
      {frame_.x - y_label_room, frame_.center().y}, label,
      {.size = style::kBodySize, .color = style::kInk, .align = Align::kCenter, .markup = true, .upwards = true});
}

void DrawColorScale(Canvas* canvas, const Box& box, Rgb (*color)(double), const Range& range,
                    const std::vector<Tick>& ticks, const std::string& label) {
  const int steps = std::max(2, static_cast<int>(std::lround(box.width * canvas->scale())));
  for (int i = 0; i < steps; ++i) {
    const double x = box.x + box.width * i / steps;
    canvas->Fill({x, box.y, box.width / steps, box.height}, color((i + 0.5) / steps));
  }
  std::vector<double> places;
  for (const Tick& tick : ticks) places.push_back(box.x + box.width * Fraction(range, tick.value));
  const std::vector<bool> legible = Legible(*canvas, ticks, places, range.logarithmic);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    if (ticks[i].label.empty()) continue;
    canvas->Line({places[i], box.bottom()}, {places[i], box.bottom() + 3}, {style::kFaint, 1});
    TextStyle text = style::Tick(Align::kCenter);
    text.baseline = Baseline::kTop;
    if (legible[i]) canvas->Text({places[i], box.bottom() + 5}, ticks[i].label, text);
  }
  if (!label.empty())
    canvas->Text({box.center().x, box.y - 5}, label,
                 {.size = style::kNoteSize, .color = style::kSecondary, .align = Align::kCenter, .markup = true});
}

}  // namespace lobefit
