// accuracy_table: measures the errors of the evaluation module and prints them as the Markdown tables of
// src/core/README.md.
//
//   bench_accuracy_table            the tables on stdout
//   bench_accuracy_table README     compares them with the tables in that file: exit 1 if an error is more than twice
//   as large as stated
//
// Two oracles. The reference tables were computed with 60 digits, with rows at hard corners. The sweeps evaluate the
// module's own formula templates in long double (64-bit mantissa) at many more random points: they see rounding, not
// wrong formulas.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "tests/support/paths.h"

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/core/ellipsoid/ellipsoid.h"
#include "lobefit/core/masking/lune.h"
#include "lobefit/core/radial/slope_distribution.h"
#include "lobefit/core/sel/sel.h"
#include "lobefit/math/directions.h"
#include "lobefit/math/rotation.h"
#include "lobefit/quantities/quantities.h"

namespace lobefit {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

// The figures of one row: `value` in eps times the condition number, `derivative` relative to the largest derivative of
// the same function.
struct Figures {
  double value = 0, derivative = 0;
};

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::size_t Find(const std::string& name) const {
    return std::find(columns.begin(), columns.end(), name) - columns.begin();
  }
  bool Has(const std::string& name) const { return Find(name) < columns.size(); }
  const std::string& Text(std::size_t row, const std::string& name) const { return rows[row].at(Find(name)); }
  double Number(std::size_t row, const std::string& name) const { return ParseDouble(Text(row, name)).value(); }
};

Table ReadTable(const std::string& name) {
  const FileBytes file(test::SourceDir() / "tests/data/reference" / (std::string(name) + ".csv"));
  Table table;
  LineReader lines(file.bytes());
  std::string_view line;
  while (lines.Next(&line)) {
    std::vector<std::string> fields;
    for (const std::string_view field : Split(line, ',')) fields.emplace_back(field);
    (table.columns.empty() ? table.columns : table.rows.emplace_back()) = fields;
  }
  return table;
}

std::string DerivedFrom(const std::string& column) {
  const std::size_t at = column.rfind("_d");
  return column[0] == 'd' && at != std::string::npos ? column.substr(1, at - 1) : "";
}

double Condition(const Table& table, std::size_t row, const std::string& function) {
  for (const std::string& name : {"cond_" + function, std::string("cond_sigma"), std::string("cond")}) {
    if (!table.Has(name)) continue;
    const double cond = table.Number(row, name);
    return std::isfinite(cond) ? std::fmax(1, cond) : std::numeric_limits<double>::infinity();
  }
  return 1;
}

Figures AgainstTable(const Quantity& quantity, const Table& table) {
  Figures figures;
  std::vector<double> in(quantity.inputs.size()), out(quantity.results.size());
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    for (std::size_t i = 0; i < in.size(); ++i) {
      const InputColumn& column = quantity.inputs[i];
      const std::string& text = table.Text(row, column.name);
      in[i] =
          column.words.empty()
              ? ParseDouble(text).value()
              : static_cast<double>(std::find(column.words.begin(), column.words.end(), text) - column.words.begin());
    }
    quantity.evaluate(in.data(), out.data());
    std::map<std::string, double> largest;
    for (const ResultColumn& column : quantity.results) {
      const double size = std::fabs(table.Number(row, column.name));
      if (size > largest[DerivedFrom(column.name)]) largest[DerivedFrom(column.name)] = size;
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
      const std::string& column = quantity.results[k].name;
      const std::string function = DerivedFrom(column);
      const double expected = table.Number(row, column);
      const double size = function.empty() ? std::fabs(expected) : largest[function];
      const double scale = size > 0 ? size : 1;
      const double error = std::fabs(out[k] - expected);
      if (!(error > 0) || quantity.results[k].is_flag) continue;
      const double cond = Condition(table, row, function.empty() ? column : function);
      if (function.empty()) {
        // A cross-section of the spherical Gaussian is meant absolutely: its tail reaches 1e-25.
        figures.value = std::fmax(figures.value, error / ((quantity.name == "sigma_sg" ? 1 : scale) * kEps * cond));
      } else {
        figures.derivative = std::fmax(figures.derivative, error / (scale * cond));
      }
    }
  }
  return figures;
}

std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

// "alpha_x 1e-4 ... 1" of the inputs that are not components of directions, by magnitude where the sign varies.
std::string Ranges(const Quantity& quantity, const Table& table) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < quantity.inputs.size(); ++i) {
    const InputColumn& column = quantity.inputs[i];
    const bool direction = std::any_of(quantity.directions.begin(), quantity.directions.end(),
                                       [&](std::size_t first) { return i >= first && i < first + 3; });
    if (direction || !column.words.empty()) continue;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      low = std::fmin(low, table.Number(row, column.name));
      high = std::fmax(high, table.Number(row, column.name));
    }
    parts.push_back(column.name + " " + Short(low) + " to " + Short(high));
  }
  return Join(parts);
}

// One random point of a sweep: the value in double and in long double, and the condition number of the value.
struct Sample {
  double value;
  long double exact;
  double cond;
};

struct Sweep {
  std::string name, range;
  int samples;
  std::function<Sample(std::mt19937_64*)> draw;
};

double LogUniform(std::mt19937_64* random, double low, double high) {
  return std::exp(std::uniform_real_distribution<double>(std::log(low), std::log(high))(*random));
}
double Uniform(std::mt19937_64* random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(*random);
}
Vec3 Direction(std::mt19937_64* random) {
  std::normal_distribution<double> gauss;
  return Normalized(Vec3{gauss(*random), gauss(*random), gauss(*random)});
}
// Above the horizon; a quarter of them within 1e-6 to 0.05 of it.
Vec3 Upper(std::mt19937_64* random) {
  const double phi = Uniform(random, -kPi, kPi);
  const double z = Uniform(random, 0, 1) < 0.25 ? LogUniform(random, 1e-6, 0.05) : Uniform(random, 0, 1);
  const double s = std::sqrt((1 - z) * (1 + z));
  return {s * std::cos(phi), s * std::sin(phi), z};
}
Ellipsoid RandomEllipsoid(std::mt19937_64* random) {
  const double a = LogUniform(random, 1e-4, 1), b = LogUniform(random, 1e-4, 1), kind = Uniform(random, 0, 1);
  const double tilt = Uniform(random, 0, DegreesToRadians(80)), phi = Uniform(random, -kPi, kPi);
  // theta_x, theta_y such that the third axis is tilted by `tilt`.
  const double theta_y = std::asin(std::sin(tilt) * std::cos(phi));
  const double theta_x = std::atan2(std::sin(tilt) * std::sin(phi), std::cos(tilt));
  return {a, kind < 0.15 ? a : kind < 0.25 ? 1 : b, theta_x, theta_y, Uniform(random, -kPi, kPi)};
}
std::array<long double, 5> Long(const Ellipsoid& e) { return {e.alpha_x, e.alpha_y, e.theta_x, e.theta_y, e.theta_z}; }
Vec3T<long double> Long(const Vec3& w) { return {w.x, w.y, w.z}; }

double ConditionOf(double value, const Ellipsoid& e, const double* gradient, const Vec3& w, const Vec3& by_direction) {
  const double sum = std::fabs(e.alpha_x * gradient[0]) + std::fabs(e.alpha_y * gradient[1]) +
                     std::fabs(e.theta_x * gradient[2]) + std::fabs(e.theta_y * gradient[3]) +
                     std::fabs(e.theta_z * gradient[4]) + std::fabs(w.x * by_direction.x) +
                     std::fabs(w.y * by_direction.y) + std::fabs(w.z * by_direction.z);
  return std::fmax(1, sum / std::fabs(value));
}

std::vector<Sweep> Sweeps() {
  const std::string shape = "alphas 1e-4 to 1 (some equal, some 1), tilt to 80 degrees, ";
  std::vector<Sweep> sweeps;
  sweeps.push_back({"EllipsoidD", shape + "wm within 0.05 to 10 alphas of the peak, and anywhere above the horizon",
                    200000, [](std::mt19937_64* random) {
                      const Ellipsoid e = RandomEllipsoid(random);
                      Vec3 m = Upper(random);
                      if (Uniform(random, 0, 1) < 0.6) {
                        std::normal_distribution<double> gauss;
                        const double f = LogUniform(random, 0.05, 10);
                        m = Normalized(Transposed(EllipsoidRotation(e)) *
                                       Vec3{f * e.alpha_x * gauss(*random), f * e.alpha_y * gauss(*random), 1});
                        m.z = std::fabs(m.z);
                      }
                      double g[5];
                      Vec3 dm;
                      const double value = EllipsoidD(e, m, g, &dm);
                      return Sample{value, EllipsoidDFormula(Long(e).data(), Long(m)), ConditionOf(value, e, g, m, dm)};
                    }});
  sweeps.push_back(
      {"EllipsoidSigma", shape + "u above the horizon to 1e-6", 200000, [](std::mt19937_64* random) {
         const Ellipsoid e = RandomEllipsoid(random);
         const Vec3 u = Upper(random);
         double g[5];
         Vec3 du;
         const double value = EllipsoidSigma(e, u, g, &du);
         return Sample{value, EllipsoidSigmaFormula(Long(e).data(), Long(u)), ConditionOf(value, e, g, u, du)};
       }});
  sweeps.push_back(
      {"EllipsoidLuneArea", shape + "u, v anywhere, some within 1e-8 of opposite", 200000, [](std::mt19937_64* random) {
         const Ellipsoid e = RandomEllipsoid(random);
         const Vec3 u = Direction(random);
         Vec3 v = Direction(random);
         if (Uniform(random, 0, 1) < 0.3) v = Normalized(-u + LogUniform(random, 1e-8, 0.1) * v);
         double g[5];
         Vec3 du, dv;
         const double value = EllipsoidLuneArea(e, u, v, g, &du, &dv);
         const double more = std::fabs(v.x * dv.x) + std::fabs(v.y * dv.y) + std::fabs(v.z * dv.z);
         return Sample{value, EllipsoidLuneAreaFormula(Long(e).data(), Long(u), Long(v)),
                       ConditionOf(value, e, g, u, du) + more / std::fabs(value)};
       }});
  sweeps.push_back(
      {"SelLobe", "alphas 1e-4 to 1, v anywhere and within 0.05 to 20 alphas of the axis or its opposite", 200000,
       [](std::mt19937_64* random) {
         const Ellipsoid e = RandomEllipsoid(random);
         Vec3 v = Direction(random);
         if (Uniform(random, 0, 1) < 0.6) {
           std::normal_distribution<double> gauss;
           const double f = LogUniform(random, 0.05, 20), sign = Uniform(random, 0, 1) < 0.8 ? 1 : -1;
           v = Normalized(Vec3{f * e.alpha_x * gauss(*random), f * e.alpha_y * gauss(*random), sign});
         }
         SelLobeGradient g;
         const double value = SelLobe(e.alpha_x, e.alpha_y, v, &g, SelKink::kAlphaXLarger);
         const double sum = std::fabs(e.alpha_x * g.dalpha_x) + std::fabs(e.alpha_y * g.dalpha_y) +
                            std::fabs(v.x * g.dv.x) + std::fabs(v.y * g.dv.y) + std::fabs(v.z * g.dv.z);
         return Sample{value, SelLobeFormula<long double>(e.alpha_x, e.alpha_y, Long(v)), std::fmax(1, sum / value)};
       }});
  sweeps.push_back(
      {"SlopeDistributionD",
       "Beckmann and GGX, alphas 1e-3 to 3, correlation to 0.99, slopes within 3 alphas of the mean", 200000,
       [](std::mt19937_64* random) {
         std::normal_distribution<double> gauss;
         SlopeDistribution s;
         s.family = Uniform(random, 0, 1) < 0.5 ? Family::kBeckmann : Family::kGgx;
         s.alpha_x = LogUniform(random, 1e-3, 3);
         s.alpha_y = LogUniform(random, 1e-3, 3);
         s.r = Uniform(random, -0.99, 0.99);
         s.slope_x = gauss(*random);
         s.slope_y = gauss(*random);
         const Vec3 m =
             Normalized(Vec3{-s.slope_x - s.alpha_x * gauss(*random), -s.slope_y - s.alpha_y * gauss(*random), 1});
         double g[5];
         Vec3 dm;
         const double value = SlopeDistributionD(s, m, g, &dm);
         const std::array<long double, 5> p = {s.alpha_x, s.alpha_y, s.r, s.slope_x, s.slope_y};
         const double sum = std::fabs(s.alpha_x * g[0]) + std::fabs(s.alpha_y * g[1]) + std::fabs(s.r * g[2]) +
                            std::fabs(s.slope_x * g[3]) + std::fabs(s.slope_y * g[4]) + std::fabs(m.x * dm.x) +
                            std::fabs(m.y * dm.y) + std::fabs(m.z * dm.z);
         return Sample{value, SlopeDistributionDFormula(s.family, p.data(), Long(m)), std::fmax(1, sum / value)};
       }});
  return sweeps;
}

std::string Report() {
  std::string text =
      "Against the reference tables (60 digits; inputs at random and at hard corners). Values: largest |error| / (eps "
      "|value| max(1, cond)), "
      "cond the\namplification of input rounding where the table has it; `sigma_sg`: |error| / eps. Derivatives: "
      "largest |error| relative to "
      "the largest derivative\nof the same function in the row, over max(1, cond).\n\n"
      "| quantity | rows | range of the inputs | value, eps | derivative, relative |\n|---|---|---|---|---|\n";
  for (const Quantity& quantity : Quantities()) {
    const Table table = ReadTable(quantity.name);
    const Figures figures = AgainstTable(quantity, table);
    text += "| " + quantity.name + " | " + std::to_string(table.rows.size()) + " | " + Ranges(quantity, table) + " | " +
            Short(figures.value) + " | " + Short(figures.derivative) + " |\n";
  }
  text +=
      "\nSweeps against the same formulas in long double. Well conditioned: points of cond < 10, error in units of the "
      "last place.\n\n"
      "| function | points | range | value, eps max(1, cond) | well conditioned, ulp |\n|---|---|---|---|---|\n";
  for (const Sweep& sweep : Sweeps()) {
    std::mt19937_64 random(2024);
    double worst = 0, worst_ulp = 0;
    for (int i = 0; i < sweep.samples; ++i) {
      const Sample sample = sweep.draw(&random);
      if (!(sample.exact > 1e-300L) || !std::isfinite(sample.cond)) continue;
      const auto error = static_cast<double>(std::fabs(static_cast<long double>(sample.value) - sample.exact));
      const auto exact = static_cast<double>(sample.exact);
      worst = std::fmax(worst, error / (exact * kEps * sample.cond));
      if (sample.cond < 10) worst_ulp = std::fmax(worst_ulp, error / (std::nextafter(exact, 2 * exact) - exact));
    }
    text += "| " + sweep.name + " | " + std::to_string(sweep.samples) + " | " + sweep.range + " | " + Short(worst) +
            " | " + Short(worst_ulp) + " |\n";
  }
  return text;
}

// The two figures at the end of every row, by the row's name.
std::map<std::string, std::array<double, 2>> FiguresOf(std::string_view text) {
  std::map<std::string, std::array<double, 2>> figures;
  LineReader lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    const std::vector<std::string_view> cells = Split(line, '|');
    if (cells.size() != 7) continue;
    const std::optional<double> value = ParseDouble(cells[4]), other = ParseDouble(cells[5]);
    if (value.has_value() && other.has_value()) figures[std::string(Trim(cells[1]))] = {*value, *other};
  }
  return figures;
}

int Compare(const std::string& path, const std::string& report) {
  const FileBytes file(path);
  const auto stated = FiguresOf(file.bytes());
  int failures = 0;
  for (const auto& [name, figures] : FiguresOf(report)) {
    const auto it = stated.find(name);
    for (int i = 0; i < 2; ++i) {
      if (it != stated.end() && figures[i] <= 2 * it->second[i] + 1e-16) continue;
      std::printf("%s: %s, %s in %s\n", name.c_str(), Short(figures[i]).c_str(),
                  it == stated.end() ? "missing" : ("stated " + Short(it->second[i])).c_str(), path.c_str());
      ++failures;
    }
  }
  if (failures > 0) std::printf("To renew the tables: bench_accuracy_table, between the two marks of the file.\n");
  return failures > 0 ? 1 : 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) {
  const std::string report = lobefit::Report();
  if (argc > 1) return lobefit::Compare(argv[1], report);
  std::fputs(report.c_str(), stdout);
  return 0;
}
