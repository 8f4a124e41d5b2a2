// How much memory the tasks of a batch may take together.
#pragma once

#include <cstdint>
#include <string>

namespace lobefit {

// Bytes that fitting a file of so many bytes may need, with what the process has anyway for one more thread.
std::uint64_t MemoryOfFit(std::uint64_t file_bytes);

// Memory that this process may use: the least of the machine's, its control groups' and a Slurm job's share
// (SLURM_MEM_PER_NODE, SLURM_MEM_PER_CPU).
std::uint64_t AvailableMemory();

// "4G", "500M", "1.5g": bytes, in powers of 1024. Throws UsageError.
std::uint64_t ParseMemory(const std::string& text);

}  // namespace lobefit
