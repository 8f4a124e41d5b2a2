#include "lobefit/batch/run/memory_limit.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/process/control_group.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::uint64_t kMegabyte = std::uint64_t{1} << 20;

std::optional<std::uint64_t> Environment(const char* name) {
  const char* text = std::getenv(name);
  const std::optional<long long> value = text != nullptr ? ParseInteger(text) : std::nullopt;
  if (!value || *value <= 0) return std::nullopt;
  return static_cast<std::uint64_t>(*value);
}

}  // namespace

std::uint64_t MemoryOfFit(std::uint64_t file_bytes) { return 10 * kMegabyte + 5 * file_bytes; }

std::uint64_t AvailableMemory() {
  std::uint64_t bytes =
      static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGE_SIZE));
  if (const std::optional<std::uint64_t> group = ControlGroupMemory()) bytes = std::min(bytes, *group);
  if (const std::optional<std::uint64_t> node = Environment("SLURM_MEM_PER_NODE"))
    bytes = std::min(bytes, *node * kMegabyte);
  if (const std::optional<std::uint64_t> cpu = Environment("SLURM_MEM_PER_CPU"))
    bytes = std::min(bytes, *cpu * kMegabyte * Environment("SLURM_CPUS_PER_TASK").value_or(1));
  return bytes;
}

std::uint64_t ParseMemory(const std::string& text) {
  const std::string units = "kmgt";
  const std::string lower = ToLower(Trim(text));
  const std::size_t unit = lower.empty() ? std::string::npos : units.find(lower.back());
  const std::optional<double> number =
      unit == std::string::npos ? std::nullopt : ParseDouble(std::string_view(lower).substr(0, lower.size() - 1));
  double bytes = number.value_or(0);
  for (std::size_t i = 0; unit != std::string::npos && i <= unit; ++i) bytes *= 1024;
  if (!(bytes >= static_cast<double>(kMegabyte) && bytes < 1e18)) {
    throw UsageError(fmt::format("--memory {}: is no amount from 1M up; write 500M or 4G", Excerpt(text)));
  }
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace lobefit
