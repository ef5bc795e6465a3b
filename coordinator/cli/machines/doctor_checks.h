#pragma once

// The checks of `bandsaw doctor`, one function each. A check states what it found and, for a
// problem, the remedy.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "proto/farm.pb.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// The result of a check: one line of output.
struct Check {
  std::string name;
  bool ok = true;
  std::string found;  ///< what was found and, for a problem, the remedy; one line
};

/// The results of the checks of a farm.
struct FarmChecks {
  std::vector<Check> checks;
  std::string answered;  ///< HOST:PORT at which the farm answered; empty: at none
};

// Checks of this machine.

/// Checks that the coordinator's data folder (or its nearest existing parent) can be written and
/// has at least 1 GiB free.
Check check_data_folder(const std::string& folder);
/// Checks that at least 1 GiB of memory is available.
Check check_memory();
/// Checks that the importer, bandsaw-import, is installed.
Check check_import_program();
/// Checks the workers' programs that a coordinator on this machine hands out to other machines. A
/// missing program is not a problem. A program that cannot be handed out (damaged, or of another
/// version or architecture) is a problem.
Check check_worker_programs();
/// Checks that the port of `listen` (HOST:PORT) is free, or taken by the farm. `answered`: the
/// address at which the farm answers; empty: at none. `own`: all addresses of its join string. The
/// farm has the port if it answers on this machine at the port of `listen`, and if `listen` is one
/// of `own` or stands for all addresses of the machine (0.0.0.0 or [::]).
Check check_port(const std::string& listen, const std::string& answered,
                 const std::vector<std::string>& own);

// Checks of the farm.

/// Returns the join string (a line with the addresses of a farm and a secret) of users or of
/// workers. It is taken from the option, from the variables BANDSAW_FARM and BANDSAW_JOIN, or from
/// the data folder `folder`, in this order. NOT_FOUND: none of these places has a join string.
/// Other errors: the text is no join string, or its file cannot be read.
absl::StatusOr<link::JoinString> doctor_join(const FarmOption& option, const std::string& folder);
/// Checks the connection, the certificate, the secret, versions, clocks and the coordinator's disk.
/// If the farm cannot be reached, the result is a single check that has failed.
FarmChecks check_farm(const link::JoinString& join);

// Pure parts of these checks. Times are in seconds since 1970, sizes in bytes.

/// Checks that a certificate that is valid from `from` to `until` is valid `now`.
Check certificate_check(double from, double until, double now);
/// Checks that the coordinator's clock is at most a minute from this machine's. `theirs` was read
/// between the two times of this machine.
Check clock_check(double ours_before, double theirs, double ours_after);
/// Checks that the coordinator has the protocol and the pixel version of this program. Programs of
/// the same pixel version render the same pixels.
Check versions_check(const farm::AboutReply& about);
/// Checks that at least 1 GiB is free. `name`: the name of the check. `where`: the folder that the
/// text names.
Check disk_space_check(const std::string& name, const std::string& where, std::uint64_t free_bytes);

}  // namespace bandsaw::coordinator
