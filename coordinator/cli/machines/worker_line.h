#pragma once

// Makes the line that a user pastes into the shell of another machine to start a worker there. The
// dashboard and `serve` show it.

#include <map>
#include <optional>
#include <string>

#include "coordinator/web/worker_program.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// SHA-256 of the workers' programs that the dashboard hands out, for each architecture.
using WorkerDigests = std::map<Machine, wire::Digest>;

/// Returns the line, for a POSIX shell with curl. It downloads the worker for the machine's
/// architecture from the dashboard at `url` (without a path), checks its SHA-256 and starts it with
/// the join string `join` (the addresses of the farm and a secret). If `programs` has no digest for
/// the architecture, the line prints an error, downloads nothing and fails. `programs` MUST NOT be
/// empty. `public_key`: SHA-256 of the server's public key; curl accepts no other server.
/// std::nullopt: `url` is plain HTTP.
std::string worker_line(const std::string& url, const std::optional<wire::Digest>& public_key,
                        const WorkerDigests& programs, const std::string& join);

}  // namespace bandsaw::coordinator
