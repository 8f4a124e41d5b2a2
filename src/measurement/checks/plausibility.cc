#include "lobefit/measurement/checks/plausibility.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <unordered_map>

#include "lobefit/base/text/text.h"
#include "lobefit/math/statistics.h"
#include "lobefit/measurement/incidence.h"

namespace lobefit {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

std::string Count(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

double MeanOfChannels(const Samples& samples, std::size_t i) {
  double sum = 0;
  for (const std::vector<double>& values : samples.values) sum += values[i];
  return sum / static_cast<double>(samples.values.size());
}

// At most so many samples are looked at, evenly chosen: conventions hold for the whole file.
constexpr std::size_t kMostSamples = 200000;

class Checks {
 public:
  explicit Checks(const Measurement& measurement) : samples_(measurement.samples) {
    const std::size_t stride = std::max<std::size_t>(1, samples_.size() / kMostSamples);
    for (std::size_t i = 0; i < samples_.size(); i += stride) chosen_.push_back(i);
  }

  std::vector<std::string> Run() {
    if (samples_.size() == 0) return {};
    Gather();
    CheckLight();
    CheckLevel();
    if (samples_.solid_angle.empty()) CheckPeaks();
    if (samples_.solid_angle.empty()) CheckMarks();
    if (!samples_.sigma.empty()) CheckSigma();
    return std::move(remarks_);
  }

 private:
  // Cells of one incidence, for an estimate of its albedo that does not depend on where samples lie densely, and what
  // lies about two directions.
  static constexpr int kRings = 9, kSectors = 12;
  struct Incidence {
    Vec3 wi;
    std::array<double, kRings* kSectors> sum = {};
    std::array<std::size_t, kRings* kSectors> count = {};
    double largest = -kInfinity, near_mirror = -kInfinity, near_light = -kInfinity;
    Vec3 brightest = {0, 0, 1};  // the viewer of the largest value
    bool has_mirror = false, has_light = false, out_of_plane = false;
    double least_theta_o = kInfinity, largest_theta_o = -kInfinity;
  };

  void Gather() {
    // Light from nearby directions counts as one; an isotropic table has no azimuths of it.
    std::unordered_map<std::int64_t, std::size_t> index;
    const double near = std::cos(12 * kPi / 180);
    for (const std::size_t i : chosen_) {
      const Vec3 wi = samples_.wi(i), wo = samples_.wo(i);
      constexpr std::int64_t kApart = 1 << 20;
      const std::int64_t key = kApart * std::lround(500 * wi.x) + std::lround(500 * wi.y);
      auto found = index.find(key);
      if (found == index.end()) {
        if (incidences_.size() >= 1024) continue;
        found = index.emplace(key, incidences_.size()).first;
        incidences_.push_back({wi});
      }
      Incidence& incidence = incidences_[found->second];
      const double value = MeanOfChannels(samples_, i), theta_o = std::acos(std::min(1.0, wo.z));
      // Round angles, at which instruments stop, lie off the bounds of the rings.
      const int ring = std::min(kRings - 1, static_cast<int>((theta_o + 0.1 * kPi / 180) * kRings / (kPi / 2)));
      const double turn = (std::atan2(wo.y, wo.x) - std::atan2(wi.y, wi.x)) / (2 * kPi);
      const int sector = std::min(kSectors - 1, static_cast<int>((turn - std::floor(turn)) * kSectors));
      const auto cell = static_cast<std::size_t>(ring * kSectors + sector);
      incidence.sum[cell] += value;
      ++incidence.count[cell];
      if (value > incidence.largest) incidence.brightest = wo;
      incidence.largest = std::max(incidence.largest, value);
      if (wo.z * wi.z - wo.x * wi.x - wo.y * wi.y > near) {
        incidence.has_mirror = true;
        incidence.near_mirror = std::max(incidence.near_mirror, value);
      }
      if (Dot(wi, wo) > near) {
        incidence.has_light = true;
        incidence.near_light = std::max(incidence.near_light, value);
      }
      incidence.out_of_plane = incidence.out_of_plane || std::fabs(wi.x * wo.y - wi.y * wo.x) > 0.05;
      const double side = wo.x * wi.x + wo.y * wi.y > 0 ? -1 : 1;
      incidence.least_theta_o = std::min(incidence.least_theta_o, side * theta_o);
      incidence.largest_theta_o = std::max(incidence.largest_theta_o, side * theta_o);
    }
  }

  void CheckLight() {
    std::size_t asked = 0, wrong = 0;
    for (const Incidence& incidence : incidences_) {
      // Nearer to the normal the two directions cannot be told apart.
      if (incidence.wi.z > std::cos(14 * kPi / 180) || !incidence.has_light || !incidence.has_mirror) continue;
      ++asked;
      if (incidence.near_light > 2 * std::max(incidence.near_mirror, 0.0) &&
          incidence.near_light >= 0.5 * incidence.largest)
        ++wrong;
    }
    if (asked == 0 || 3 * wrong < 2 * asked) return;
    remarks_.push_back("in " + std::to_string(wrong) + " of " + Count(asked, "incident direction") +
                       " the largest values lie about the light's own direction and none about the mirror's; if "
                       "azimuths or signed angles count from the specular side, use "
                       "--incident propagation (a retro-reflector looks like this too)");
  }

  // Lobes about the normal at every incidence are those of angles that count from the mirror direction; at the
  // complement of the mirror's polar angle, of angles that count from the surface. At grazing incidence lobes lie off
  // the mirror direction by themselves.
  void CheckPeaks() {
    std::size_t asked = 0, normal = 0, apart = 0, complement = 0;
    const double near = std::cos(8 * kPi / 180), degree = kPi / 180;
    for (const Incidence& incidence : incidences_) {
      const Vec3& wi = incidence.wi;
      const double theta = std::acos(std::min(1.0, wi.z));
      if (theta < 24 * degree || theta > 60 * degree) continue;
      if (!incidence.has_mirror || incidence.least_theta_o > -8 * degree) continue;
      const bool peak = incidence.largest > 1.25 * std::max(incidence.near_mirror, 0.0);
      ++asked;
      normal += peak && incidence.brightest.z > near ? 1 : 0;
      if (std::fabs(theta - kPi / 4) < 12 * degree) continue;  // its complement is near the mirror direction
      const double tangent = std::hypot(wi.x, wi.y), scale = wi.z / tangent;
      ++apart;
      complement += peak && Dot(incidence.brightest, {-wi.x * scale, -wi.y * scale, tangent}) > near ? 1 : 0;
    }
    if (asked > 0 && 3 * normal >= 2 * asked) {
      remarks_.push_back("in " + std::to_string(normal) + " of " + Count(asked, "incident direction") +
                         " the largest values lie about the normal and not the mirror direction: do the angles count "
                         "from that? --columns delta_theta=NAME");
    } else if (apart > 0 && 3 * complement >= 2 * apart) {
      remarks_.push_back("in " + std::to_string(complement) + " of " + Count(apart, "incident direction") +
                         " the largest values lie where the mirror direction would be, were one of the polar angles "
                         "counted from the surface: --columns elevation_o=NAME, or elevation_i=NAME");
    }
  }

  // Whether the samples of a ring leave no more than half a turn out.
  static bool GoesRound(const Incidence& incidence, std::size_t ring) {
    int gap = 0, widest = 0;
    for (int k = 0; k < 2 * kSectors; ++k) {
      gap = incidence.count[ring * kSectors + static_cast<std::size_t>(k % kSectors)] > 0 ? 0 : gap + 1;
      widest = std::max(widest, gap);
    }
    return widest <= kSectors / 2;
  }

  // Directional albedo from the means over rings; nothing where the samples do not cover the hemisphere.
  static double Albedo(const Incidence& incidence) {
    double albedo = 0, covered = 0;
    for (std::size_t r = 0; r < kRings; ++r) {
      const double low = std::sin(static_cast<double>(r) * kPi / 2 / kRings),
                   high = std::sin(static_cast<double>(r + 1) * kPi / 2 / kRings);
      const double projected = kPi * (high * high - low * low);
      double sum = 0, cells = 0;
      for (std::size_t k = r * kSectors; k < (r + 1) * kSectors; ++k) {
        if (incidence.count[k] == 0) continue;
        sum += incidence.sum[k] / static_cast<double>(incidence.count[k]);
        ++cells;
      }
      // Where only the neighbourhood of a peak was looked at, its mean is not the ring's.
      if (cells == 0 || !GoesRound(incidence, r)) continue;
      covered += projected;
      albedo += projected * sum / cells;
    }
    return incidence.out_of_plane && covered > 0.8 * kPi ? albedo : std::nan("");
  }

  void CheckLevel() {
    std::vector<double> values;
    std::size_t negative = 0;
    double largest = -kInfinity;
    for (const std::size_t i : chosen_) {
      values.push_back(MeanOfChannels(samples_, i));
      negative += values.back() < 0 ? 1 : 0;
      largest = std::max(largest, values.back());
    }
    if (values.size() < 5) return;
    if (10 * negative > 9 * values.size()) {
      remarks_.emplace_back("nearly all values are negative: are they logarithms or dB? --value-scale log10, ln or dB");
      return;
    }
    std::vector<double> albedos;
    for (const Incidence& incidence : incidences_) {
      const double albedo = Albedo(incidence);
      if (!std::isnan(albedo)) albedos.push_back(albedo);
    }
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 20), values.end());
    const double low = values[values.size() / 20];
    // What even the least values would reflect, were they all: of a plane of incidence no more can be said.
    double reflected = WideEnough() ? kPi * low : 0;
    if (!albedos.empty()) {
      std::nth_element(albedos.begin(), albedos.begin() + static_cast<std::ptrdiff_t>(albedos.size() / 2),
                       albedos.end());
      reflected = std::max(reflected, albedos[albedos.size() / 2]);
    }
    if (reflected > 1.33) {
      remarks_.push_back("an albedo of about " + Short(reflected) +
                         " means that more light leaves than arrives: are the values " + Guess(reflected, low));
    } else if (samples_.solid_angle.empty() && (largest == 1 || largest == 100) && samples_.values.size() == 1 &&
               low < 0.5 * largest) {
      remarks_.push_back("the largest value is exactly " + Short(largest) +
                         ": are they relative to the peak? Then their scale is not known; fit with --scale free");
    }
  }

  // Whether some incidence was looked at from 60 degrees of directions or more.
  bool WideEnough() const {
    return std::any_of(incidences_.begin(), incidences_.end(), [](const Incidence& incidence) {
      return incidence.largest_theta_o - incidence.least_theta_o > 60 * kPi / 180;
    });
  }

  static std::string Guess(double reflected, double low) {
    if (reflected < 2 * kPi && low > 0.1)
      return "pi f_r, a reflectance factor (--value-kind pi-f), or of an unknown scale (--scale free)?";
    if (reflected > 50 && reflected < 150 * kPi)
      return "in percent (--value-scale %, with --value-kind pi-f for a reflectance factor), or of an unknown scale, "
             "such as counts (--scale free)?";
    return "of an unknown scale, such as counts (--scale free)?";
  }

  void CheckMarks() {
    std::size_t zeros = 0, at_largest = 0, at_second = 0, at_least = 0;
    double largest = -kInfinity, second = -kInfinity, least = kInfinity, farthest = -1;
    std::map<double, std::size_t> marks;
    const std::vector<double>& values = samples_.values[0];
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = values[i];
      if (value > largest) {
        second = largest;
        at_second = at_largest;
        largest = value;
        at_largest = 0;
      } else if (value < largest && value > second) {
        second = value;
        at_second = 0;
      }
      if (value == largest) ++at_largest;
      if (value == second) ++at_second;
      if (value < least) {
        least = value;
        at_least = 0;
      }
      if (value == least) ++at_least;
      if (value == 0) {
        ++zeros;
        farthest = std::max(farthest, std::acos(std::clamp(Dot(samples_.wi(i), samples_.wo(i)), -1.0, 1.0)));
      }
      if (value == -1 || value == -99 || value == -999 || value == -9999 || value == -99999 || value == -32768 ||
          std::fabs(value) >= 1e15)
        ++marks[value];
    }
    // Other marks ("-32767", "-88.88") are known by what noise never does: the same number again and again, far below
    // what the largest value is above zero.
    if (at_least >= 3 && largest > 0 && -least > 3 * largest) marks.emplace(least, at_least);
    const std::size_t count = values.size();
    if (zeros >= 3 && 2 * zeros < count) {
      const double degrees = std::ceil(farthest * 180 / kPi);
      remarks_.push_back(Count(zeros, "sample") + (zeros == 1 ? " is" : " are") + " exactly 0" +
                         (degrees <= 25 ? ", all within " + Short(degrees) +
                                              " degrees of the light's own direction, which a detector shades"
                                        : "") +
                         ": if that stands for no value, use --no-value 0" +
                         (degrees <= 25 ? " or --exclude retro:" + Short(degrees)
                                        : "; if negative readings were set to 0, give them as they were read, for "
                                          "without them dim values come out too bright"));
    }
    for (const auto& [value, times] : marks) {
      remarks_.push_back(Count(times, "value") + (times == 1 ? " is " : " are ") + FormatDouble(value) +
                         ": if that stands for no value, use --no-value " + FormatDouble(value));
    }
    const bool saturated = at_largest >= 5 && 100 * at_largest > count && at_largest > 4 * at_second &&
                           2 * at_largest < count && largest > 0 && largest < 1e15;
    if (saturated) {
      remarks_.push_back(std::to_string(at_largest) + " samples share the largest value, " + FormatDouble(largest) +
                         ": if the detector saturates there, use --exclude \"value>=" + Short(largest * (1 - 1e-3)) +
                         "\"");
    }
  }

  // Ratios of stated standard deviations to the values: their median above 1 is hardly an instrument's.
  void CheckSigma() {
    std::vector<double> ratios;
    for (const std::size_t i : chosen_) {
      const double value = std::fabs(MeanOfChannels(samples_, i));
      if (value > 0) ratios.push_back(samples_.sigma[i] / value);
    }
    if (ratios.empty()) return;
    const double median = Median(std::move(ratios));
    if (median <= 1) return;
    remarks_.push_back("half of the stated uncertainties are above " + Short(100 * median) +
                       " % of the value: are they in another unit, such as percent? Write it into their name, as in "
                       "'uncertainty [%]'");
  }

  const Samples& samples_;
  std::vector<std::size_t> chosen_;
  std::vector<Incidence> incidences_;
  std::vector<std::string> remarks_;
};

}  // namespace

std::vector<std::string> FindImplausible(const Measurement& measurement) { return Checks(measurement).Run(); }

}  // namespace lobefit
