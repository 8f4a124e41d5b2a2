// What every verb does with a job array that it prepared.
#pragma once

#include "lobefit/batch/slurm.h"

namespace lobefit {

// Writes the script and prints how it is sent, or sends it. Returns the exit code; throws as WriteArray and SendScript.
int WriteOrSend(const ArrayJob& job, bool send);

}  // namespace lobefit
