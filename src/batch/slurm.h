// The same work on Slurm: a job array whose elements are shards, and a job after it that collects.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lobefit {

struct ArrayJob {
  std::string name;  // of the job
  std::size_t shards = 1;
  std::vector<std::string> shard;    // words of the command; "--shard I/N" is appended
  std::vector<std::string> collect;  // likewise, without anything appended
  std::filesystem::path folder;      // absolute; logs go to its folder "slurm"
  int threads = 1;                   // CPUs of an element, which then knows them whatever it sees of its node
};

// A script for sbatch, which run by a shell outside of a job sends itself and the collecting job:
// elements are requeued when their node dies, each knows the number of shards from the script (Slurm's own count
// shrinks where part of an array is sent again), get SIGTERM a minute before their time is over, and collecting waits
// for their end, good or bad.
std::string ArrayScript(const ArrayJob& job);

// Writes that script as FOLDER/array.sbatch and makes the folder of its logs. Returns its path; throws OutputError.
std::filesystem::path WriteArray(const ArrayJob& job);

// Sends such a script to Slurm and waits for sbatch's answer, which goes to stdout. Throws UsageError where there is no
// sbatch, InputError where it refuses.
void SendScript(const std::filesystem::path& script);

// A sensible number of shards: about a minute of work each, at most 1000 (Slurm's default allows 1001).
std::size_t DefaultShards(std::size_t tasks, double seconds);

}  // namespace lobefit
