#pragma once

// The worker that lies beside this program, and the line that brings it to another machine.

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/web/worker_program.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// Reads it and asks it for its version. NOT_FOUND: it does not lie there. FAILED_PRECONDITION: it
/// does not run here. Others as File.
absl::StatusOr<WorkerProgram> load_worker_program();

/// What to paste into a shell of another machine, which needs curl: gets the worker from the
/// dashboard at `url` (without a path), checks it, starts it with the join string. `public_key`:
/// the SHA-256 of the server's, which is the only one taken then; nothing for plain HTTP.
std::string worker_line(const std::string& url, const std::optional<wire::Digest>& public_key,
                        const wire::Digest& program, const std::string& join);

}  // namespace bandsaw::coordinator
