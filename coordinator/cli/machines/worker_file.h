#pragma once

// Finds and checks the programs of workers that are installed on this machine, one for each
// architecture. `serve` and `invite` hand them out to other machines; `doctor` lists them.

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// Returns the path of the program for `machine`. If that is the architecture of this machine, the
/// program lies in the folder of the running program. Otherwise it is
/// ../lib/bandsaw/bandsaw-worker-MACHINE relative to that folder. Build folders have the same
/// layout as installed programs.
std::string worker_program_path(Machine machine);

/// Checks that `bytes`, the contents of a whole file, are a worker's program for `machine`. The
/// program must be compatible with this coordinator (equal protocol and pixel version). Programs of
/// the same pixel version render the same pixels. Returns the program with its version and its
/// digest. Reads the ELF header and the wire::WorkerMark, a structure in each worker's program that
/// states the versions. Does not run the program. INVALID_ARGUMENT: the file is another program, or
/// is for another architecture. DATA_LOSS: the file is cut off. FAILED_PRECONDITION: the program
/// has another protocol or pixel version. The message of an error begins with a verb; the caller
/// puts the name of the file before it.
absl::StatusOr<WorkerProgram> checked_worker_program(std::string bytes, Machine machine);

/// Reads the program for `machine` and checks it. NOT_FOUND: it is not installed; the message says
/// how to provide it. Other errors: those of checked_worker_program(), and of reading a file.
absl::StatusOr<WorkerProgram> load_worker_program(Machine machine);

}  // namespace bandsaw::coordinator
