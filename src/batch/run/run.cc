#include "lobefit/batch/run/run.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/batch/run/journal.h"
#include "lobefit/batch/run/memory_limit.h"
#include "lobefit/batch/run/task_files.h"

namespace lobefit {
namespace {

double PeakMegabytes(int who) {
  rusage usage = {};
  getrusage(who, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// The message with files as they were listed, which is the same on every machine.
std::string WithoutFolder(std::string message, const Task& task) {
  const std::string path = task.members.empty() ? task.path.string() : (task.path / "").string();
  const std::string listed = task.members.empty() ? task.file : "";
  for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path, at + listed.size()))
    message.replace(at, path.size(), listed);
  return message;
}

// The outcome of the work, whatever it throws.
Outcome Attempt(const Work& work, const Task& task, int threads) {
  try {
    return work(task, threads);
  } catch (const OutputError&) {
    throw;
  } catch (const Error& error) {
    return {TaskStatus::kFailed, error.exit_code(), error.what(), "", 0, "", {}};
  } catch (const std::bad_alloc&) {
    constexpr const char* kCure = "out of memory; choose a part of the file with --theta-i, or fewer --jobs";
    return {TaskStatus::kFailed, kExitOther, kCure, "", 0, "", {}};
  } catch (const std::exception& error) {
    return {TaskStatus::kFailed, kExitOther, error.what(), "", 0, "", {}};
  }
}

class Runner {
 public:
  Runner(const RunOptions& options, const std::filesystem::path& out, const Work& work, const Done& done)
      : options_(options), work_(work), done_(done), journal_(out / "segments") {}

  void Usual(const Task& task, int threads) {
    DoneRecord record = Begin(task, threads);
    Finish(task, &record, [&] { return Attempt(work_, task, threads); });
  }

  // In a process of its own: if it dies, this one is there to say so.
  void Alone(const Task& task) {
    DoneRecord record = Begin(task, options_.limits.threads);
    Finish(task, &record, [&] { return InChild(task); });
  }

  void Crashed(const Task& task) {
    DoneRecord record = Begin(task, 1);
    Commit(task, &record,
           {TaskStatus::kCrashed,
            kExitOther,
            "the process that fitted it died twice, perhaps for want of memory; --retry-failed tries again, by itself",
            "",
            0,
            "",
            {}});
  }

  void Close() { journal_.Close(); }

 private:
  DoneRecord Begin(const Task& task, int threads) {
    DoneRecord record;
    record.at = Now();
    record.id = task.id;
    record.settings = task.settings;
    record.stamps = StampsOf(task);
    record.threads = threads;
    journal_.Reserve();
    journal_.Append(ToLine(StartRecord{task.id, record.at, 0}));
    return record;
  }

  // A task whose results cannot be written, or are lost on their way to the disk, did not kill its process, and must
  // not be taken for one that did.
  void Finish(const Task& task, DoneRecord* record, const std::function<Outcome()>& attempt) {
    Outcome outcome;
    try {
      outcome = attempt();
    } catch (const OutputError&) {
      try {
        journal_.Append(EndedLine(task.id));
      } catch (const OutputError&) {
        // Where even that is impossible the task runs by itself next time.
      }
      throw;
    }
    journal_.Append(EndedLine(task.id));
    Commit(task, record, std::move(outcome));
  }

  void Commit(const Task& task, DoneRecord* record, Outcome outcome) {
    const double begun = record->at;
    record->at = Now();
    record->seconds = record->at - begun;
    record->status = outcome.status;
    record->exit_code = outcome.exit_code;
    record->message = WithoutFolder(outcome.message, task);
    record->document_bytes = outcome.document_bytes;
    record->row = std::move(outcome.row);
    record->picture = std::move(outcome.picture);
    record->picture_is_measured = outcome.picture_is_measured;
    record->sha256 = outcome.sha256.empty() ? ContentSha256(task) : outcome.sha256;
    record->key = TaskKey(record->sha256, task.settings);
    record->peak_mb = PeakMegabytes(RUSAGE_SELF);
    journal_.Commit(ToLine(*record), std::move(outcome.files));
    done_(*record);
  }

  // What the child says goes through a pipe as a line of a journal.
  Outcome InChild(const Task& task) {
    int ends[2];
    if (pipe(ends) != 0) throw OutputError(fmt::format("no pipe: {}", std::strerror(errno)));
    const pid_t parent = getpid(), child = fork();
    if (child < 0) throw OutputError(fmt::format("no process: {}", std::strerror(errno)));
    if (child == 0) {
      close(ends[0]);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      if (getppid() != parent) _exit(kExitOther);
      Speak(task, ends[1]);
    }
    close(ends[1]);
    std::string said;
    char buffer[65536];
    while (true) {
      const ssize_t count = read(ends[0], buffer, sizeof buffer);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      said.append(buffer, static_cast<std::size_t>(count));
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    return Heard(said, status);
  }

  [[noreturn]] void Speak(const Task& task, int pipe_end) {
    std::string text;
    try {
      Outcome outcome = Attempt(work_, task, options_.limits.threads);
      outcome.files.Commit();
      DoneRecord record;
      record.id = task.id;
      record.status = outcome.status;
      record.exit_code = outcome.exit_code;
      record.message = outcome.message;
      record.document_bytes = outcome.document_bytes;
      record.row = outcome.row;
      record.picture = outcome.picture;
      record.picture_is_measured = outcome.picture_is_measured;
      record.sha256 = outcome.sha256;
      text = "R" + ToLine(record);
    } catch (const std::exception& error) {
      text = std::string("W") + error.what();
    }
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t count = write(pipe_end, text.data() + at, text.size() - at);
      if (count <= 0 && errno != EINTR) break;
      if (count > 0) at += static_cast<std::size_t>(count);
    }
    // Without the destructors of the parent's objects.
    _exit(0);
  }

  static Outcome Heard(const std::string& said, int status) {
    if (said.starts_with("W")) throw OutputError(said.substr(1));
    if (said.starts_with("R") && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
      const DoneRecord record = DoneFromLine(std::string_view(said).substr(1));
      return {record.status,
              record.exit_code,
              record.message,
              record.row,
              record.document_bytes,
              record.sha256,
              {},
              record.picture,
              record.picture_is_measured};
    }
    const std::string how = WIFSIGNALED(status)
                                ? fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                                : fmt::format("exit code {}", WEXITSTATUS(status));
    return {TaskStatus::kCrashed,
            kExitOther,
            fmt::format("the process that fitted it died twice, at last by itself with {}, after {:.0f} MB{}", how,
                        PeakMegabytes(RUSAGE_CHILDREN),
                        WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL ? ": out of memory?" : ""),
            "",
            0,
            "",
            {}};
  }

  const RunOptions& options_;
  const Work& work_;
  const Done& done_;
  Journal journal_;
};

}  // namespace

void RunPlan(const Plan& plan, const RunOptions& options, const std::filesystem::path& out,
             const std::atomic<bool>& stop, const Work& work, const Done& done) {
  Runner runner(options, out, work, done);
  for (const Task* task : plan.crashed) runner.Crashed(*task);
  std::vector<std::uint64_t> memory;
  for (const Task* task : plan.usual) memory.push_back(MemoryOfFit(task->bytes));
  RunScheduled(memory, options.limits, stop,
               [&](std::size_t i, int threads) { runner.Usual(*plan.usual[i], threads); });
  for (const Task* task : plan.suspects) {
    if (stop) break;
    runner.Alone(*task);
  }
  runner.Close();
}

}  // namespace lobefit
