#pragma once

// Writes the files with the farm's join strings into the data folder, for `serve` and `secret
// rotate`. A join string is a line with the addresses of the farm, the digest of its certificate
// and the secret of a role (workers or users).

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/identity.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// Returns the path of a role's file: `DATA/join` for workers, `DATA/farm` for users.
std::string join_file_of(const std::string& data_folder, link::Role role);

/// Returns the join string of a role. `insecure`: it has no digest of a certificate, because the
/// farm does not encrypt.
link::JoinString join_string(link::Role role, const link::Identity& identity,
                             const std::vector<std::string>& addresses, bool insecure);

/// Writes the join string to its role's file, unless the file already has it. RESOURCE_EXHAUSTED:
/// the disk is full; the file is unchanged.
absl::Status write_join_file(const std::string& data_folder, const link::JoinString& join);

/// Renews the secret of a role in the identity (the file with the farm's certificate and secrets).
/// Then writes the role's join string with the new secret to the file of this role. `present` is
/// the join string of the running coordinator. The secret in `present` may be an old one, and is
/// not used. If no coordinator runs, `present` is std::nullopt, and the join string in the file is
/// used. If this file is missing or damaged, the addresses are unknown. Then no join string is
/// written, RenewedSecret::join_file is empty, and the next `serve` writes the file. Errors: those
/// of link::renew_secret. If only the join string could not be written, RenewedSecret::written has
/// the error.
absl::StatusOr<RenewedSecret> rotate_secret(const std::string& data_folder, link::Role role,
                                            std::optional<link::JoinString> present);

}  // namespace bandsaw::coordinator
