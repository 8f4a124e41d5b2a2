#include "tasks/array_job.h"

#include "text/output.h"
#include <fmt/format.h>

#include "lobefit/base/error.h"

namespace lobefit {

int WriteOrSend(const ArrayJob& job, bool send) {
  const std::string script = WriteArray(job).string();
  if (send) {
    SendScript(script);
  } else {
    Print(fmt::format("Script:  {} ({} shards)\nSend it: sh {}\n", script, job.shards, ShellWord(script)));
  }
  return kExitDone;
}

}  // namespace lobefit
