#pragma once

// The workers' programs that lie with this one, for each architecture.

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// Where the program for `machine` lies: beside this one where it is of the same architecture, else
/// ../lib/bandsaw/bandsaw-worker-MACHINE from there; in a build folder as installed.
std::string worker_program_path(Machine machine);

/// What `bytes`, a whole file, are: a worker for `machine` that fits this coordinator (equal
/// protocol and pixel version). Known from the file alone, by its ELF header and its
/// wire::WorkerMark; nothing is run. INVALID_ARGUMENT: another program, or for another
/// architecture. DATA_LOSS: cut off. FAILED_PRECONDITION: of another version. Messages begin with a
/// verb; the caller names the file.
absl::StatusOr<WorkerProgram> checked_worker_program(std::string bytes, Machine machine);

/// Reads the program for `machine` and checks it as above. NOT_FOUND: it does not lie there; the
/// message says how to provide it. Others as above, and as File.
absl::StatusOr<WorkerProgram> load_worker_program(Machine machine);

}  // namespace bandsaw::coordinator
