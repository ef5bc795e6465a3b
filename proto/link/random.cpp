// Takes random bytes from the kernel (getentropy).

#include "proto/link/random.h"

#include <sys/random.h>

#include <cstdlib>

#include "absl/strings/escaping.h"

namespace bandsaw::link {

std::string random_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  if (getentropy(bytes.data(), bytes.size()) != 0) {
    std::abort();  // does not happen: Linux returns up to 256 random bytes at any time
  }
  return bytes;
}

std::string random_hex(std::size_t count) { return absl::BytesToHexString(random_bytes(count)); }

std::string make_secret() { return absl::WebSafeBase64Escape(random_bytes(16)); }

}  // namespace bandsaw::link
