#pragma once

#include <cstddef>
#include <string>

namespace bandsaw::link {

/// Returns `count` random bytes from the operating system's cryptographic generator. 0 < count <=
/// 256.
std::string random_bytes(std::size_t count);

/// Returns `count` random bytes as 2 x count hexadecimal digits, for unique ids.
std::string random_hex(std::size_t count);

/// Characters of a secret: 128 bits as base64url.
inline constexpr std::size_t kSecretLength = 22;
/// Returns a random secret.
std::string make_secret();

}  // namespace bandsaw::link
