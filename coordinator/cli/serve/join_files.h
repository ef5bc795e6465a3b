#pragma once

// The files with the farm's join strings, in the data folder.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/identity.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// Returns `DATA/join` for workers, `DATA/farm` for users.
std::string join_file_of(const std::string& data_folder, link::Role role);

/// Returns the join string of a role. `insecure`: without the certificate.
link::JoinString join_string(link::Role role, const link::Identity& identity,
                             const std::vector<std::string>& addresses, bool insecure);

/// Writes the join string to its role's file, unless the file already has it. RESOURCE_EXHAUSTED:
/// the disk is full; the file is unchanged.
absl::Status write_join_file(const std::string& data_folder, const link::JoinString& join);

/// Renews the secret in the identity and in the role's join string, if that file exists. Errors as
/// link::renew_secret. If writing the join string fails (`written`), the files differ until the
/// next `serve`.
absl::StatusOr<RenewedSecret> rotate_secret(const std::string& data_folder, link::Role role);

}  // namespace bandsaw::coordinator
