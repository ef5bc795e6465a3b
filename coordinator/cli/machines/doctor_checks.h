#pragma once

// What `bandsaw doctor` looks at, one check a function. Each says what it found, and of a problem
// the cure.

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
/// The workers' programs that a coordinator here hands out to other machines. That there is none is
/// no problem; one that cannot be handed out is.
Check check_worker_programs();
/// Free, or taken by the farm that answers at one of `own`.
Check check_port(const std::string& listen, const std::vector<std::string>& own);

// The farm.
/// The join string that is named, of either role; nothing is named: NOT_FOUND.
absl::StatusOr<link::JoinString> doctor_join(const FarmOption& option, const std::string& folder);
/// Whom it reaches, the certificate, the secret, versions, clocks, the coordinator's disk.
std::vector<Check> check_farm(const link::JoinString& join);

// Pure parts of it. Times in seconds since 1970, sizes in bytes.
Check certificate_check(double from, double until, double now);
Check clock_check(double ours_before, double theirs, double ours_after);
Check versions_check(const farm::AboutReply& about);
Check room_check(const std::string& name, const std::string& where, std::uint64_t free_bytes);

}  // namespace bandsaw::coordinator
