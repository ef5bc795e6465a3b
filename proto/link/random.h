#pragma once

#include <cstddef>
#include <string>

namespace bandsaw::link {

/// So many bytes that nobody can guess, from the system. 0 < count <= 256.
std::string random_bytes(std::size_t count);

/// The same as 2 x count hexadecimal digits: a name that nobody else chooses.
std::string random_hex(std::size_t count);

/// 128 random bits as 22 characters of base64url.
std::string make_secret();

}  // namespace bandsaw::link
