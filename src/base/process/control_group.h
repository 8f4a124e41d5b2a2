// Limits that the control groups of this process set (containers, Slurm, systemd).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace lobefit {

// Processors: quota over period of the strictest group above the process, not rounded. Nothing: no limit, or no control
// groups here. `root` is /sys/fs/cgroup and `self` /proc/self/cgroup, but for tests.
std::optional<double> ControlGroupProcessors(const std::filesystem::path& root = "/sys/fs/cgroup",
                                             const std::filesystem::path& self = "/proc/self/cgroup");
// Bytes of memory, likewise.
std::optional<std::uint64_t> ControlGroupMemory(const std::filesystem::path& root = "/sys/fs/cgroup",
                                                const std::filesystem::path& self = "/proc/self/cgroup");

}  // namespace lobefit
