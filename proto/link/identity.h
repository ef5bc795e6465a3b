#pragma once

// The farm's identity: the coordinator's TLS key and certificate, and the secrets of workers and of
// users. It is created in the coordinator's data folder at the first start (file mode 0600).

#include <string>

#include "absl/status/statusor.h"
#include "proto/link/join.h"
#include "proto/wire/digest.h"

namespace bandsaw::link {

struct Identity {
  std::string key_pem;
  std::string certificate_pem;
  wire::Digest certificate_digest;  ///< SHA-256 of the DER form
  std::string worker_secret;        ///< base64url, 22 characters, as farm_secret
  std::string farm_secret;          ///< the secret of users
};

/// Loads `folder`/identity, or creates a new one (EC P-256, self-signed, for the name kServerName).
/// DATA_LOSS: the file exists but cannot be parsed. PERMISSION_DENIED: others may read it.
absl::StatusOr<Identity> load_or_make_identity(const std::string& folder);

/// Creates a new secret for one role and writes it to the file before returning. The other role's
/// secret and the certificate do not change. NOT_FOUND: the folder has no identity.
absl::StatusOr<Identity> renew_secret(const std::string& folder, Role role);

/// Host name in the certificate. Clients expect this name at every address, so addresses may
/// change.
inline constexpr char kServerName[] = "bandsaw";

/// Returns the role to which a secret belongs. Compares in constant time. UNAUTHENTICATED: the
/// secret belongs to no role.
absl::StatusOr<Role> role_of_secret(const Identity& identity, const std::string& secret);

/// Returns true if the secrets are equal. The time that the comparison takes reveals nothing except
/// the lengths of the secrets.
bool is_same_secret(const std::string& a, const std::string& b);

}  // namespace bandsaw::link
