// Reading speed: rows a second of a goniometer's CSV in the shapes that people have, milliseconds of a MERL table.
// Figures are the least of a few passes, in processor time of all threads and by the clock; ctest only sees that it
// runs.
//   bench_io [ROWS]   rows of the CSV, default 10^6
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/merl/writer.h"
#include "lobefit/io/read.h"

namespace lobefit {
namespace {

struct Time {
  double processor = 1e9, clock = 1e9;
};

Time LeastTime(const std::filesystem::path& path, int passes) {
  Time least;
  for (int pass = 0; pass < passes; ++pass) {
    const std::clock_t processor = std::clock();
    const auto clock = std::chrono::steady_clock::now();
    ReadMeasurement(path);
    least.processor = std::min(least.processor, static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
    least.clock =
        std::min(least.clock, std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count());
  }
  return least;
}

// How a table is written.
struct Shape {
  const char* name;
  const char* names;
  std::vector<int> decimals;  // of the fields behind the light's angles: 3 of an angle, 5 of a value
  char separator = ',', mark = '.';
  const char* quote = "";
};

std::string Text(const Shape& shape, std::size_t rows) {
  std::mt19937 random(1);
  std::string text;
  for (const char* c = shape.names; *c != 0; ++c) text += *c == ',' ? shape.separator : *c;
  text += '\n';
  // Fixed decimals, as instruments write.
  const auto number = [&](unsigned below, int decimals) {
    const unsigned unit = decimals == 3 ? 1000 : 100000, value = 1 + random() % (below * unit - 1);
    return fmt::format("{}{}{:0{}}", value / unit, shape.mark, value % unit, decimals);
  };
  for (std::size_t i = 0; i < rows; ++i) {
    const auto add = [&](const std::string& field) { text += shape.quote + field + shape.quote; };
    // A light stays for many rows, as in a scan.
    add(std::to_string(5 * (i / 10000 % 16)));
    text += shape.separator;
    add(std::to_string(30 * (i / 160000)));
    bool polar = true;
    for (const int decimals : shape.decimals) {
      text += shape.separator;
      add(number(decimals == 5 ? 1 : polar ? 85 : 360, decimals));
      polar = false;
    }
    text += '\n';
  }
  return text;
}

void Report(const char* name, std::size_t rows, const Time& time) {
  std::printf("csv   %-22s %zu rows in %.3f s of processor time, %.3f s by the clock: %.3g rows/s\n", name, rows,
              time.processor, time.clock, static_cast<double>(rows) / time.processor);
}

int Main(int argc, char** argv) {
  const std::size_t rows = argc > 1 ? static_cast<std::size_t>(ParseInteger(argv[1]).value_or(1000000)) : 1000000;
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("lobefit_bench_io_" + std::to_string(getpid()));
  constexpr char kRgb[] = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R,G,B";
  const std::vector<int> rgb = {3, 3, 5, 5, 5};
  for (const Shape& shape :
       {Shape{"three channels", kRgb, rgb},
        Shape{"with uncertainties", "theta_i,phi_i,theta_o,phi_o,brdf,sigma", {3, 3, 5, 5}},
        Shape{"decimal commas", kRgb, rgb, ';', ','}, Shape{"quoted cells", kRgb, rgb, ',', '.', "\""}}) {
    WriteFileAtomically(path, Text(shape, rows));
    Report(shape.name, rows, LeastTime(path, 5));
  }
  WriteMerl([](const Vec3&, const Vec3&, double* values) { std::fill(values, values + 3, 0.5); }, {{"R", "G", "B"}, {}},
            {}, path);
  const Time merl = LeastTime(path, 5);
  std::printf("merl  %.1f ms of processor time, %.1f ms by the clock\n", 1e3 * merl.processor, 1e3 * merl.clock);
  std::filesystem::remove(path);
  return 0;
}

}  // namespace
}  // namespace lobefit

int main(int argc, char** argv) { return lobefit::Main(argc, argv); }
