#pragma once

// The one line that lets a machine join, and what it holds.
//
//   bsw1-w-192.168.1.5:7878,10.0.0.5:7878-<43>-<22>
//   form, role (w worker, f farm user), addresses, base64url of the certificate's SHA-256,
//   base64url of the secret (128 bits)
//
// An IPv6 address is written in brackets. A coordinator without TLS (--insecure) writes "plain" for
// the digest.

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
  std::optional<wire::Digest> certificate;  ///< of the DER form; nothing: plaintext
  std::string secret;                       ///< base64url, 22 characters

  std::string text() const;
};

/// INVALID_ARGUMENT saying what is wrong with it, never echoing the secret.
absl::StatusOr<JoinString> parse_join_string(const std::string& text);

/// `text` is a join string, or the name of a file that holds one, or "-" for standard input.
absl::StatusOr<JoinString> join_string_from(const std::string& text);

/// Writes over the join strings among a process's own arguments, which every user of the machine
/// can list while it runs. To be called once they are parsed.
void hide_join_strings(absl::Span<char* const> arguments);

}  // namespace bandsaw::link
