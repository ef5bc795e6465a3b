#pragma once

#include <map>
#include <optional>
#include <string>

#include "coordinator/web/worker_program.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// Digests of the programs that the dashboard hands out.
using WorkerDigests = std::map<Machine, wire::Digest>;

/// Returns a line for the POSIX shell of another machine, which needs curl: it downloads the worker
/// for the machine's architecture from the dashboard at `url` (without a path), checks its SHA-256
/// and starts it with the join string. If `programs` has none for the machine, the line prints
/// that, downloads nothing and fails. `programs` MUST NOT be empty. `public_key`: SHA-256 of the
/// server's public key, the only one that is accepted; std::nullopt for plain HTTP.
std::string worker_line(const std::string& url, const std::optional<wire::Digest>& public_key,
                        const WorkerDigests& programs, const std::string& join);

}  // namespace bandsaw::coordinator
