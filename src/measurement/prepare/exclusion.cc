#include "lobefit/measurement/prepare/exclusion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

using Zone = Exclusion::Zone;

using Reason = LeftOutReason;

[[noreturn]] void Refuse(const std::string& text, std::string_view item) {
  throw UsageError("--exclude " + Excerpt(text, 100) + ": '" + Excerpt(item) +
                   "' is no zone; allowed are specular:DEG, retro:DEG, value<X, value>X, theta-i<DEG, theta-i>DEG, "
                   "theta-o<DEG, theta-o>DEG, with commas between");
}

std::optional<double> ParseAngle(std::string_view word) {
  double unit = kPi / 180;
  if (word.ends_with("deg")) {
    word.remove_suffix(3);
  } else if (word.ends_with("rad")) {
    word.remove_suffix(3);
    unit = 1;
  }
  const std::optional<double> number = ParseDouble(word);
  return number && std::isfinite(*number) && *number >= 0 ? std::optional(*number * unit) : std::nullopt;
}

// The reason for which a sample is excluded, if it is.
std::optional<Reason> ReasonFor(const std::vector<Exclusion>& exclusions, const Samples& samples, std::size_t i) {
  const Vec3 wi = samples.wi(i), wo = samples.wo(i);
  const double cos_specular = wo.z * wi.z - wo.x * wi.x - wo.y * wi.y, cos_retro = Dot(wi, wo);
  for (const Exclusion& exclusion : exclusions) {
    const double cosine = std::cos(exclusion.limit);
    const auto any = [&](auto&& holds) {
      return std::any_of(samples.values.begin(), samples.values.end(),
                         [&](const std::vector<double>& values) { return holds(values[i]); });
    };
    switch (exclusion.zone) {
      case Zone::kSpecular:
        if (cos_specular >= cosine) return Reason::kNearMirror;
        break;
      case Zone::kRetro:
        if (cos_retro >= cosine) return Reason::kNearLight;
        break;
      case Zone::kValueBelow:
        if (any([&](double value) { return value < exclusion.limit; })) return Reason::kByValue;
        break;
      case Zone::kValueAbove:
        if (any([&](double value) { return value > exclusion.limit; })) return Reason::kByValue;
        break;
      case Zone::kThetaIBelow:
        if (wi.z > cosine) return Reason::kByAngle;
        break;
      case Zone::kThetaIAbove:
        if (wi.z < cosine) return Reason::kByAngle;
        break;
      case Zone::kThetaOBelow:
        if (wo.z > cosine) return Reason::kByAngle;
        break;
      case Zone::kThetaOAbove:
        if (wo.z < cosine) return Reason::kByAngle;
        break;
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Exclusion> ParseExclusions(const std::string& text) {
  std::vector<Exclusion> exclusions;
  for (const std::string_view raw : Split(text, ',')) {
    std::string item;
    for (const char c : ToLower(Trim(raw))) {
      if (c != ' ') item += c == '_' ? '-' : c;
    }
    const std::size_t equals = item.find('=');
    const bool inclusive = equals != std::string::npos;  // ">=" and "<="
    if (inclusive) item.erase(equals, 1);
    const std::size_t mark = item.find_first_of(":<>");
    if (mark == std::string::npos) Refuse(text, raw);
    const std::string name = item.substr(0, mark);
    const char sign = item[mark];
    const std::string_view word = std::string_view(item).substr(mark + 1);
    Exclusion exclusion;
    if (sign == ':' && (name == "specular" || name == "retro")) {
      const std::optional<double> angle = ParseAngle(word);
      if (!angle || *angle > kPi) Refuse(text, raw);
      exclusion = {name == "specular" ? Zone::kSpecular : Zone::kRetro, *angle};
    } else if (sign != ':' && name == "value") {
      const std::optional<double> number = ParseDouble(word);
      if (!number || std::isnan(*number)) Refuse(text, raw);
      constexpr double kInfinity = std::numeric_limits<double>::infinity();
      const double limit = inclusive ? std::nextafter(*number, sign == '<' ? kInfinity : -kInfinity) : *number;
      exclusion = {sign == '<' ? Zone::kValueBelow : Zone::kValueAbove, limit};
    } else if (sign != ':' && (name == "theta-i" || name == "theta-o")) {
      const std::optional<double> angle = ParseAngle(word);
      if (!angle || *angle > kPi / 2) Refuse(text, raw);
      const bool light = name == "theta-i";
      exclusion = {sign == '<' ? (light ? Zone::kThetaIBelow : Zone::kThetaOBelow)
                               : (light ? Zone::kThetaIAbove : Zone::kThetaOAbove),
                   *angle};
      // Which side a sample at the limit itself is on must not depend on the rounding of its cosine.
      exclusion.limit += (sign == '<') != inclusive ? -1e-9 : 1e-9;
    } else {
      Refuse(text, raw);
    }
    exclusions.push_back(exclusion);
  }
  return exclusions;
}

void Apply(const std::vector<Exclusion>& exclusions, Measurement* measurement) {
  if (exclusions.empty()) return;
  Samples& samples = measurement->samples;
  std::vector<std::uint8_t> keep(samples.size(), 1);
  std::size_t kept = samples.size();
  std::array<std::size_t, kLeftOutWords.size()> counts = {};
  std::vector<LeftOut> left_out;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::optional<Reason> reason = ReasonFor(exclusions, samples, i);
    if (!reason) continue;
    keep[i] = 0;
    --kept;
    ++counts[static_cast<std::size_t>(*reason)];
    if (left_out.size() < kMostLeftOut) left_out.push_back({samples.wi(i), samples.wo(i), *reason});
  }
  if (kept == 0) {
    throw InputError(measurement->source + ": all of its " + std::to_string(samples.size()) +
                     " usable samples lie in the zones of --exclude; make them smaller");
  }
  if (kept == samples.size()) return;
  measurement->set_aside.Add(SetAsideReason::kOutsideSelection, samples.size() - kept);
  samples.Keep(keep);
  for (const LeftOut& one : left_out) measurement->LeaveOut(one.wi, one.wo, one.reason);
  std::vector<std::string> words;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    if (counts[r] > 0) words.push_back(std::to_string(counts[r]) + " " + kLeftOutWords[r]);
  }
  measurement->remarks.push_back("samples excluded: " + Join(words));
}

}  // namespace lobefit
