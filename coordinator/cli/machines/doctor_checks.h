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

struct Check {
  std::string name;
  bool ok = true;
  std::string found;  ///< one line
};

// This machine.
Check check_data_folder(const std::string& folder);
Check check_memory();
Check check_import_program();
/// Checks the workers' programs that a coordinator on this machine hands out. A missing program is
/// not a problem. A program that cannot be handed out (damaged, or of another version or
/// architecture) is a problem.
Check check_worker_programs();
/// Checks that the port is free, or taken by the farm that answers at one of `own`.
Check check_port(const std::string& listen, const std::vector<std::string>& own);

// The farm.
/// Returns the given join string, of either role. NOT_FOUND: none is given.
absl::StatusOr<link::JoinString> doctor_join(const FarmOption& option, const std::string& folder);
/// Checks the connection, the certificate, the secret, versions, clocks and the coordinator's disk.
std::vector<Check> check_farm(const link::JoinString& join);

// Pure parts of these checks. Times in seconds since 1970, sizes in bytes.
Check certificate_check(double from, double until, double now);
Check clock_check(double ours_before, double theirs, double ours_after);
Check versions_check(const farm::AboutReply& about);
Check disk_space_check(const std::string& name, const std::string& where, std::uint64_t free_bytes);

}  // namespace bandsaw::coordinator
