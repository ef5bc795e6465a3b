#pragma once

// Random bytes, unique ids and secrets.

#include <cstddef>
#include <string>

namespace bandsaw::link {

/// Returns `count` random bytes from the operating system's cryptographic generator. 0 < count <=
/// 256.
std::string random_bytes(std::size_t count);

/// Returns `count` random bytes as 2 x count hexadecimal digits, for unique ids.
std::string random_hex(std::size_t count);

/// Number of characters of a secret, which is 128 bits as base64url.
inline constexpr std::size_t kSecretLength = 22;
/// Returns a random secret for a join string (join.h).
std::string make_secret();

}  // namespace bandsaw::link
