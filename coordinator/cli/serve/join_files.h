#pragma once

// The files with the farm's join strings, in the data folder.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

/// Returns `DATA/join` for workers, `DATA/farm` for users.
std::string join_file_of(const std::string& data_folder, link::Role role);

/// Writes the role's join string and returns it. `insecure`: without the certificate.
absl::StatusOr<std::string> write_join_file(const std::string& data_folder, link::Role role,
                                            const link::Identity& identity,
                                            const std::vector<std::string>& addresses,
                                            bool insecure);

/// Renews the secret in the identity and in the role's join string, if that file exists. Errors as
/// link::renew_secret. If writing the join string fails (`written`), the files differ until the
/// next `serve`.
absl::StatusOr<RenewedSecret> rotate_secret(const std::string& data_folder, link::Role role);

}  // namespace bandsaw::coordinator
