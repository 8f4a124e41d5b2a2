#include "lobefit/batch/slurm.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// A word as every shell takes it back.
std::string Quoted(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./,=+:%@").find(c) != std::string_view::npos;
  });
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string Words(const std::vector<std::string>& words) {
  std::vector<std::string> quoted;
  for (const std::string& word : words) quoted.push_back(Quoted(word));
  return Join(quoted, " ");
}

}  // namespace

std::string ArrayScript(const ArrayJob& job) {
  const std::string logs = (job.folder / "slurm").string();
  std::string text = "#!/bin/sh\n";
  text += fmt::format("#SBATCH --job-name={}\n", job.name);
  text += fmt::format("#SBATCH --array=1-{}\n", job.shards);
  text += "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --signal=B:TERM@60\n";
  text += fmt::format("#SBATCH --output=\"{}/%A_%a.txt\"\n", logs);
  text += fmt::format("#SBATCH --cpus-per-task={}\n", job.threads);
  text += fmt::format(
      R"(# An element of the array does one of {0} shards. Outside of a job this script sends the array and, after
# it, the job that collects: sh array.sbatch [options of sbatch for both].
if [ -n "$SLURM_ARRAY_TASK_ID" ]; then
  exec {1} --shard "$SLURM_ARRAY_TASK_ID/{0}"
fi
set -e
mkdir -p {2}
array=$(sbatch --parsable "$@" {3})
echo "array job $array, {0} shards"
collect=$(sbatch --parsable "$@" --job-name={4}-collect --dependency="afterany:${{array%%;*}}" --output={2}/collect_%j.txt --wrap={5})
echo "collecting job $collect, after it"
)",
      job.shards, Words(job.shard), Quoted(logs), Quoted((job.folder / "array.sbatch").string()), job.name,
      Quoted("exec " + Words(job.collect)));
  return text;
}

std::filesystem::path WriteArray(const ArrayJob& job) {
  const std::filesystem::path script = job.folder / "array.sbatch";
  MakeFolder(job.folder / "slurm");
  WriteFileAtomically(script, ArrayScript(job));
  return script;
}

void SendScript(const std::filesystem::path& script) {
  std::string path = script.string();
  char shell[] = "sh";
  char* arguments[] = {shell, path.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  if (std::system("command -v sbatch >/dev/null 2>&1") != 0)
    throw UsageError(fmt::format("--submit: there is no sbatch here; on a host of the cluster: sh {}", path));
  if (posix_spawnp(&child, shell, nullptr, nullptr, arguments, environ) != 0 || waitpid(child, &status, 0) != child ||
      status != 0) {
    throw InputError(fmt::format("{}: was not accepted by Slurm, see above; try: sh {}", path, path));
  }
}

std::size_t DefaultShards(std::size_t tasks, double seconds) {
  constexpr double kShardSeconds = 60, kMost = 1000;
  const double wanted = std::clamp(std::ceil(seconds / kShardSeconds), 1.0, kMost);
  return std::min(std::max<std::size_t>(tasks, 1), static_cast<std::size_t>(wanted));
}

}  // namespace lobefit
