// Reading speed: rows a second of a goniometer CSV, milliseconds of a MERL table. Figures are the least of a few
// passes, in processor time of all threads and by the clock; ctest only sees that it runs.
//   bench_io [ROWS]   rows of the CSV, default 10^6
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <random>
#include <string>

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

void WriteRows(std::size_t rows, const std::filesystem::path& path) {
  std::mt19937 random(1);
  std::string text = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,R,G,B\n";
  // Fixed decimals, as instruments write.
  const auto number = [&](unsigned below, int decimals) {
    const unsigned unit = decimals == 3 ? 1000 : 100000, value = random() % (below * unit);
    return fmt::format("{}.{:0{}}", value / unit, value % unit, decimals);
  };
  for (std::size_t i = 0; i < rows; ++i) {
    // A light stays for many rows, as in a scan.
    text += std::to_string(5 * (i / 10000 % 16)) + "," + std::to_string(30 * (i / 160000)) + "," + number(85, 3) + "," +
            number(360, 3) + "," + number(1, 5) + "," + number(1, 5) + "," + number(1, 5) + "\n";
  }
  WriteFileAtomically(path, text);
}

int Main(int argc, char** argv) {
  const std::size_t rows = argc > 1 ? static_cast<std::size_t>(ParseInteger(argv[1]).value_or(1000000)) : 1000000;
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("lobefit_bench_io_" + std::to_string(getpid()));
  WriteRows(rows, path);
  const Time csv = LeastTime(path, 5);
  std::printf("csv   %zu rows in %.3f s of processor time, %.3f s by the clock: %.3g rows/s\n", rows, csv.processor,
              csv.clock, static_cast<double>(rows) / csv.processor);
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
