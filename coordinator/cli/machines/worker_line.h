#pragma once

#include <map>
#include <optional>
#include <string>

#include "coordinator/web/worker_program.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// The digests of the programs that the dashboard hands out.
using WorkerDigests = std::map<Machine, wire::Digest>;

/// One line for the shell (POSIX) of another machine, which needs curl: gets the worker for the
/// machine's architecture from the dashboard at `url` (without a path), checks its SHA-256, starts
/// it with the join string. Where `programs` holds none for the machine, the line says so, fetches
/// nothing and fails. `programs` MUST NOT be empty. `public_key`: the SHA-256 of the server's, the
/// only one that is accepted then; nothing for plain HTTP.
std::string worker_line(const std::string& url, const std::optional<wire::Digest>& public_key,
                        const WorkerDigests& programs, const std::string& join);

}  // namespace bandsaw::coordinator
