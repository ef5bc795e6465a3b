#pragma once

// Bytes for tests of transfers in chunks: chunks from different offsets differ, so a chunk that is
// lost, repeated or at a wrong place is noticed.

#include <cstddef>
#include <string>

namespace bandsaw::test {

/// Returns `size` bytes. Each byte depends only on the low 21 bits of its offset, so the pattern
/// repeats after 2 MiB. Each offset is multiplied by 2^32 divided by the golden ratio, so that
/// neighbouring offsets give different bytes.
inline std::string pattern(std::size_t size) {
  std::string bytes(size, '\0');
  for (std::size_t i = 0; i < size; ++i) {
    bytes[i] = static_cast<char>(i * 2654435761U >> 13);
  }
  return bytes;
}

}  // namespace bandsaw::test
