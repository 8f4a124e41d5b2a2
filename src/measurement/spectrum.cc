#include "lobefit/measurement/spectrum.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

using Triple = std::array<double, 3>;

constexpr int kFirstNm = 380, kLastNm = 780, kStepNm = 10;

// CIE 1931 2-degree colour matching functions (CIE 015) and the relative power of illuminant D65 (CIE 015), every 10
// nm.
struct ObserverRow {
  double x, y, z, d65;
};
constexpr std::array<ObserverRow, 41> kObserver = {{
    {0.001368, 0.000039, 0.006450, 49.9755}, {0.004243, 0.000120, 0.020050, 54.6482},
    {0.014310, 0.000396, 0.067850, 82.7549}, {0.043510, 0.001210, 0.207400, 91.4860},
    {0.134380, 0.004000, 0.645600, 93.4318}, {0.283900, 0.011600, 1.385600, 86.6823},
    {0.348280, 0.023000, 1.747060, 104.865}, {0.336200, 0.038000, 1.772110, 117.008},
    {0.290800, 0.060000, 1.669200, 117.812}, {0.195360, 0.090980, 1.287640, 114.861},
    {0.095640, 0.139020, 0.812950, 115.923}, {0.032010, 0.208020, 0.465180, 108.811},
    {0.004900, 0.323000, 0.272000, 109.354}, {0.009300, 0.503000, 0.158200, 107.802},
    {0.063270, 0.710000, 0.078250, 104.790}, {0.165500, 0.862000, 0.042160, 107.689},
    {0.290400, 0.954000, 0.020300, 104.405}, {0.433450, 0.994950, 0.008750, 104.046},
    {0.594500, 0.995000, 0.003900, 100.000}, {0.762100, 0.952000, 0.002100, 96.3342},
    {0.916300, 0.870000, 0.001650, 95.7880}, {1.026300, 0.757000, 0.001100, 88.6856},
    {1.062200, 0.631000, 0.000800, 90.0062}, {1.002600, 0.503000, 0.000340, 89.5991},
    {0.854450, 0.381000, 0.000190, 87.6987}, {0.642400, 0.265000, 0.000050, 83.2886},
    {0.447900, 0.175000, 0.000020, 83.6992}, {0.283500, 0.107000, 0.000000, 80.0268},
    {0.164900, 0.061000, 0.000000, 80.2146}, {0.087400, 0.032000, 0.000000, 82.2778},
    {0.046770, 0.017000, 0.000000, 78.2842}, {0.022700, 0.008210, 0.000000, 69.7213},
    {0.011359, 0.004102, 0.000000, 71.6091}, {0.005790, 0.002091, 0.000000, 74.3490},
    {0.002899, 0.001047, 0.000000, 61.6040}, {0.001440, 0.000520, 0.000000, 69.8856},
    {0.000690, 0.000249, 0.000000, 75.0870}, {0.000332, 0.000120, 0.000000, 63.5927},
    {0.000166, 0.000060, 0.000000, 46.4182}, {0.000083, 0.000030, 0.000000, 66.8054},
    {0.000042, 0.000015, 0.000000, 63.3828},
}};

constexpr double kXyzToRgb[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
constexpr double kRgbToXyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

Triple Multiplied(const double (&matrix)[3][3], const Triple& v) {
  Triple result = {};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) result[r] += matrix[r][c] * v[c];
  }
  return result;
}

// Colour matching functions by the cubic through four rows (the CIE recommends third order or higher for tables of 10
// nm), the illuminant linearly, as it is defined.
Triple UnscaledMatching(double nm) {
  if (nm < kFirstNm || nm > kLastNm) return {0, 0, 0};
  const double position = (nm - kFirstNm) / kStepNm;
  const std::size_t index = std::min(static_cast<std::size_t>(position), kObserver.size() - 2);
  const double t = position - static_cast<double>(index);
  const ObserverRow &a = kObserver[index], &b = kObserver[index + 1];
  const double power = (1 - t) * a.d65 + t * b.d65;
  std::array<double, 4> weight = {0, 1 - t, t, 0};
  const bool inside = index > 0 && index + 2 < kObserver.size();
  if (inside) {
    weight = {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
              (t + 1) * t * (t - 1) / 6};
  }
  Triple result = {};
  for (std::size_t k = 0; k < 4; ++k) {
    if (weight[k] == 0) continue;
    const ObserverRow& row = kObserver[index + k - 1];
    result[0] += weight[k] * row.x;
    result[1] += weight[k] * row.y;
    result[2] += weight[k] * row.z;
  }
  for (double& value : result) value *= power;
  return result;
}

double LuminanceSum() {
  static const double sum = [] {
    double total = 0;
    for (int nm = kFirstNm; nm <= kLastNm; ++nm) total += UnscaledMatching(nm)[1];
    return total;
  }();
  return sum;
}

// Share of each measured wavelength at `nm`: linear between neighbours, constant beyond the ends.
template <class Add>
void ForShares(const std::vector<double>& sorted, double nm, Add&& add) {
  const auto above = std::upper_bound(sorted.begin(), sorted.end(), nm);
  if (above == sorted.begin()) return add(std::size_t{0}, 1.0);
  if (above == sorted.end()) return add(sorted.size() - 1, 1.0);
  const std::size_t high = static_cast<std::size_t>(above - sorted.begin());
  const double t = (nm - sorted[high - 1]) / (sorted[high] - sorted[high - 1]);
  add(high - 1, 1 - t);
  add(high, t);
}

// Rows X, Y, Z, columns the wavelengths in their own order.
std::array<std::vector<double>, 3> XyzRows(const std::vector<double>& wavelengths) {
  std::vector<std::size_t> order(wavelengths.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return wavelengths[a] < wavelengths[b]; });
  std::vector<double> sorted;
  for (const std::size_t i : order) sorted.push_back(wavelengths[i]);
  std::array<std::vector<double>, 3> rows;
  for (std::vector<double>& row : rows) row.assign(wavelengths.size(), 0.0);
  for (int nm = kFirstNm; nm <= kLastNm; ++nm) {
    const Triple matching = WeightedMatching(nm);
    ForShares(sorted, nm, [&](std::size_t k, double share) {
      for (std::size_t r = 0; r < 3; ++r) rows[r][order[k]] += share * matching[r];
    });
  }
  return rows;
}

// Linear sRGB of a spectrum; each row is scaled so that a constant spectrum of 1 gives exactly 1.
std::array<std::vector<double>, 3> RgbRows(const std::vector<double>& wavelengths) {
  const std::array<std::vector<double>, 3> xyz = XyzRows(wavelengths);
  std::array<std::vector<double>, 3> rgb;
  for (std::size_t r = 0; r < 3; ++r) {
    rgb[r].assign(wavelengths.size(), 0.0);
    double white = 0;
    for (std::size_t k = 0; k < wavelengths.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) rgb[r][k] += kXyzToRgb[r][c] * xyz[c][k];
      white += rgb[r][k];
    }
    for (double& weight : rgb[r]) weight /= white;
  }
  return rgb;
}

bool Named(const Channels& channels, const char* a, const char* b, const char* c) {
  return channels.names == std::vector<std::string>{a, b, c};
}

[[noreturn]] void Refuse(const std::string& choice, const Channels& channels, const std::string& why) {
  throw UsageError("--channels " + Excerpt(choice) + ": " + why + "; the measurement has " +
                   Excerpt(Join(channels.names), 120));
}

void RequireVisible(const std::string& choice, const Channels& channels) {
  const auto& nm = channels.wavelengths_nm;
  if (nm.empty()) Refuse(choice, channels, "needs R G B, X Y Z or wavelengths");
  if (!CoversVisible(nm)) Refuse(choice, channels, "the wavelengths must cover 430 to 650 nm");
}

std::vector<std::vector<double>> Rows(const double (&matrix)[3][3]) {
  std::vector<std::vector<double>> rows;
  for (const auto& row : matrix) rows.emplace_back(row, row + 3);
  return rows;
}

ChannelMap ToRgb(const std::string& choice, const Channels& channels) {
  ChannelMap map = {{{"R", "G", "B"}, {}}, {}, "R G B as they are"};
  if (Named(channels, "R", "G", "B")) {
    map.matrix = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  } else if (Named(channels, "X", "Y", "Z")) {
    map.matrix = Rows(kXyzToRgb);
    map.description = "R G B from X Y Z (sRGB primaries)";
  } else {
    RequireVisible(choice, channels);
    for (std::vector<double>& row : RgbRows(channels.wavelengths_nm)) map.matrix.push_back(std::move(row));
    map.description = "R G B from " + std::to_string(channels.size()) +
                      " wavelengths (CIE 1931 2 deg, D65, linear between wavelengths, 380-780 nm, sRGB primaries)";
  }
  return map;
}

ChannelMap ToLuminance(const std::string& choice, const Channels& channels) {
  ChannelMap map = {{{"Y"}, {}}, {}, "luminance"};
  if (Named(channels, "R", "G", "B")) {
    map.matrix = {{kRgbToXyz[1][0], kRgbToXyz[1][1], kRgbToXyz[1][2]}};
    map.description = "luminance from R G B (sRGB primaries)";
  } else if (Named(channels, "X", "Y", "Z")) {
    map.matrix = {{0, 1, 0}};
  } else if (channels.size() == 1 && channels.wavelengths_nm.empty()) {
    map.matrix = {{1}};
  } else {
    RequireVisible(choice, channels);
    map.matrix = {XyzRows(channels.wavelengths_nm)[1]};
    map.description = "luminance from " + std::to_string(channels.size()) +
                      " wavelengths (CIE 1931 2 deg, D65, linear between wavelengths, 380-780 nm)";
  }
  return map;
}

// Three bands that add up to 1 at every wavelength, with ramps of 40 nm about 490 and 580 nm.
Triple Bands(double nm) {
  const double blue = std::clamp((510 - nm) / 40, 0.0, 1.0);
  const double red = std::clamp((nm - 560) / 40, 0.0, 1.0);
  return {red, 1 - red - blue, blue};
}

ChannelMap ToSpectrum(const std::string& choice, const Channels& channels) {
  if (!Named(channels, "R", "G", "B")) Refuse(choice, channels, "needs R G B");
  ChannelMap map = {{}, {}, "400 to 700 nm from R G B (three smooth bands with these R G B)"};
  for (int nm = 400; nm <= 700; nm += 10) {
    map.channels.wavelengths_nm.push_back(nm);
    map.channels.names.push_back(std::to_string(nm) + "nm");
  }
  // m[r][band] = R G B of each band; its inverse gives the bands' heights.
  const std::array<std::vector<double>, 3> rgb = RgbRows(map.channels.wavelengths_nm);
  double m[3][3] = {};
  for (std::size_t k = 0; k < map.channels.size(); ++k) {
    const Triple bands = Bands(map.channels.wavelengths_nm[k]);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t b = 0; b < 3; ++b) m[r][b] += rgb[r][k] * bands[b];
    }
  }
  const auto cofactor = [&](std::size_t i, std::size_t j) {
    const std::size_t a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  for (const double nm : map.channels.wavelengths_nm) {
    const Triple bands = Bands(nm);
    std::vector<double> row(3, 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t b = 0; b < 3; ++b) row[c] += bands[b] * cofactor(c, b) / determinant;
    }
    map.matrix.push_back(std::move(row));
  }
  return map;
}

void AddChannel(const Channels& channels, std::size_t index, ChannelMap* map) {
  map->channels.names.push_back(channels.names[index]);
  if (!channels.wavelengths_nm.empty()) map->channels.wavelengths_nm.push_back(channels.wavelengths_nm[index]);
  std::vector<double> row(channels.size(), 0.0);
  row[index] = 1;
  map->matrix.push_back(std::move(row));
}

// Whether a piece of a list means the channel: its name, its wavelength, or a range of wavelengths.
bool Means(std::string_view piece, const Channels& channels, std::size_t index) {
  if (ToLower(piece) == ToLower(channels.names[index])) return true;
  if (channels.wavelengths_nm.empty()) return false;
  const double nm = channels.wavelengths_nm[index];
  const auto number = [](std::string_view text) {
    text = Trim(text);
    if (text.ends_with("nm")) text.remove_suffix(2);
    return ParseDouble(text);
  };
  const std::size_t colon = piece.find(':');
  if (colon != std::string_view::npos) {
    const std::optional<double> low = number(piece.substr(0, colon)), high = number(piece.substr(colon + 1));
    return low && high && nm >= *low - 1e-6 && nm <= *high + 1e-6;
  }
  const std::optional<double> wanted = number(piece);
  return wanted && std::fabs(*wanted - nm) < 0.5;
}

// A piece of a list as it is compared with the others: "R" is "r", "550nm" is "550".
std::string PlainPiece(std::string_view piece) {
  std::string plain = ToLower(piece);
  if (plain.ends_with("nm") && ParseDouble(Trim(std::string_view(plain).substr(0, plain.size() - 2))))
    plain = std::string(Trim(std::string_view(plain).substr(0, plain.size() - 2)));
  return plain;
}

// Ranges may overlap; a piece that stands there twice is a slip of whoever wrote the list.
ChannelMap FromList(const std::string& choice, const Channels& channels) {
  ChannelMap map = {{}, {}, "chosen: " + choice};
  std::vector<bool> taken(channels.size(), false);
  std::set<std::string> pieces;
  for (const std::string_view part : Split(choice, ',')) {
    const std::string_view piece = Trim(part);
    if (!pieces.insert(PlainPiece(piece)).second) Refuse(choice, channels, "'" + Excerpt(piece) + "' is named twice");
    bool found = false;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      if (!Means(piece, channels, i)) continue;
      found = true;
      if (!taken[i]) AddChannel(channels, i, &map);
      taken[i] = true;
    }
    if (!found) {
      Refuse(choice, channels,
             "'" + Excerpt(piece) +
                 "' is no channel; allowed are rgb, luminance, spectrum, all, names, wavelengths in nm and ranges of "
                 "them");
    }
  }
  return map;
}

}  // namespace

Channels ChannelsNamed(std::vector<std::string> names) {
  Channels channels = {std::move(names), {}};
  for (const std::string_view name : channels.names) {
    const std::optional<double> nm = name.ends_with("nm") ? ParseDouble(name.substr(0, name.size() - 2)) : std::nullopt;
    if (!nm || !(*nm > 0)) return {std::move(channels.names), {}};
    channels.wavelengths_nm.push_back(*nm);
  }
  return channels;
}

bool CoversVisible(const std::vector<double>& wavelengths_nm) {
  const auto [low, high] = std::minmax_element(wavelengths_nm.begin(), wavelengths_nm.end());
  return !wavelengths_nm.empty() && *low <= 430 && *high >= 650;
}

Triple SrgbFromXyz(const Triple& xyz) { return Multiplied(kXyzToRgb, xyz); }
Triple XyzFromSrgb(const Triple& rgb) { return Multiplied(kRgbToXyz, rgb); }

Triple WeightedMatching(double nm) {
  Triple matching = UnscaledMatching(nm);
  for (double& value : matching) value /= LuminanceSum();
  return matching;
}

ChannelMap MakeChannelMap(const std::string& choice, const Channels& channels) {
  const std::string word = ToLower(Trim(choice));
  if (word == "rgb") return ToRgb(choice, channels);
  if (word == "luminance") return ToLuminance(choice, channels);
  if (word == "spectrum") return ToSpectrum(choice, channels);
  if (word != "all") return FromList(choice, channels);
  ChannelMap map = {{}, {}, "all"};
  for (std::size_t i = 0; i < channels.size(); ++i) AddChannel(channels, i, &map);
  return map;
}

void Apply(const ChannelMap& map, Measurement* measurement) {
  const std::size_t count = measurement->samples.size();
  std::vector<std::vector<double>> values;
  for (const std::vector<double>& row : map.matrix) {
    std::vector<double>& channel = values.emplace_back(count, 0.0);
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (row[k] == 0) continue;
      const std::vector<double>& from = measurement->samples.values[k];
      for (std::size_t i = 0; i < count; ++i) channel[i] += row[k] * from[i];
    }
  }
  measurement->samples.values = std::move(values);
  measurement->channels = map.channels;
  measurement->conventions["channels"] = map.description;
}

BrdfFunction Apply(const ChannelMap& map, const BrdfFunction& brdf, std::size_t channels_before) {
  return [matrix = map.matrix, brdf, channels_before](const Vec3& wi, const Vec3& wo, double* values) {
    std::vector<double> before(channels_before);
    brdf(wi, wo, before.data());
    for (std::size_t r = 0; r < matrix.size(); ++r) {
      values[r] = 0;
      for (std::size_t k = 0; k < channels_before; ++k) values[r] += matrix[r][k] * before[k];
    }
  };
}

}  // namespace lobefit
