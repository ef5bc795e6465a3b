#pragma once

// The coordinator's key, certificate and secrets, made at first start under the data folder (mode
// 0600).

#include <string>

#include "absl/status/statusor.h"
#include "proto/link/join.h"
#include "proto/wire/digest.h"

namespace bandsaw::link {

struct Identity {
  std::string key_pem;
  std::string certificate_pem;
  wire::Digest certificate_digest;  ///< SHA-256 of the DER form
  std::string worker_secret;
  std::string farm_secret;
};

/// Loads `folder`/identity, or makes a new one (EC P-256, self-signed, for the name kServerName).
/// DATA_LOSS: there is one that cannot be read.
absl::StatusOr<Identity> load_or_make_identity(const std::string& folder);

/// A new secret for one role, written before it is returned; the other role's and the certificate
/// stay. NOT_FOUND: the folder has no identity.
absl::StatusOr<Identity> renew_secret(const std::string& folder, Role role);

/// The name in the certificate; clients set it as the expected name, so that addresses may change.
inline constexpr char kServerName[] = "bandsaw";

/// Which role a secret opens, compared in constant time. UNAUTHENTICATED.
absl::StatusOr<Role> role_of_secret(const Identity& identity, const std::string& secret);

}  // namespace bandsaw::link
