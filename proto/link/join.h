#pragma once

// The join string: one line with everything that a machine needs to connect to a farm.
//
//   bsw1-w-192.168.1.5:7878,10.0.0.5:7878-<43>-<22>
//   format version; role (w: worker, f: farm user); addresses;
//   SHA-256 of the certificate in base64url (43 characters);
//   secret of 128 bits in base64url (22 characters)
//
// An IPv6 address is written in brackets. A coordinator without TLS (--insecure) writes "plain"
// instead of the digest. The string of farm users also names the dashboard, for programs that speak
// HTTP (deploy/python/bandsaw.py). The dashboard is written directly after the addresses:
//
//   bsw1-f-192.168.1.5:7878+8787-…             port 8787 of the hosts in the addresses
//   bsw1-f-192.168.1.5:7878+127.0.0.1:8787-…   host and port of the dashboard

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "proto/wire/digest.h"

namespace bandsaw::link {

enum class Role { kWorker, kFarm };

struct JoinString {
  Role role = Role::kWorker;
  std::vector<std::string> addresses;       ///< host:port, tried in order; 1 to 8
  std::string web = {};                     ///< port or host:port of the dashboard; empty: none
  std::optional<wire::Digest> certificate;  ///< digest of the DER form; std::nullopt: plaintext
  std::string secret;                       ///< base64url, 22 characters

  std::string text() const;
};

/// Parses a join string. INVALID_ARGUMENT with the reason; the message never contains the secret.
absl::StatusOr<JoinString> parse_join_string(const std::string& text);

/// Reads a join string: `text` is a join string, the name of a file that contains one, or "-" for
/// standard input.
absl::StatusOr<JoinString> join_string_from(const std::string& text);

/// Overwrites the join strings in the process's arguments, because every user of the machine can
/// list the arguments while the process runs. MUST be called after the arguments are parsed.
void hide_join_strings(absl::Span<char* const> arguments);

}  // namespace bandsaw::link
