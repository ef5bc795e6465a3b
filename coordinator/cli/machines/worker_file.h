#pragma once

// The installed workers' programs, one for each architecture.

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// Returns the path of the program for `machine`: beside this program if it has the same
/// architecture, otherwise ../lib/bandsaw/bandsaw-worker-MACHINE relative to it. Build folders have
/// the same layout as installed programs.
std::string worker_program_path(Machine machine);

/// Checks that `bytes`, a whole file, are a worker for `machine` that is compatible with this
/// coordinator (equal protocol and pixel version). Reads the ELF header and the wire::WorkerMark;
/// runs nothing. INVALID_ARGUMENT: another program, or for another architecture. DATA_LOSS:
/// truncated. FAILED_PRECONDITION: another version. Messages begin with a verb; the caller names
/// the file.
absl::StatusOr<WorkerProgram> checked_worker_program(std::string bytes, Machine machine);

/// Reads the program for `machine` and checks it as above. NOT_FOUND: missing; the message says how
/// to provide it. Other errors as above, and as File.
absl::StatusOr<WorkerProgram> load_worker_program(Machine machine);

}  // namespace bandsaw::coordinator
