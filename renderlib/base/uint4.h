#pragma once

// Four unsigned integers of 32 bits at a time. Integers are exact on every machine, so the
// compiler's own vectors do.

#include <cstdint>

namespace bandsaw {

using UInt4 = std::uint32_t __attribute__((vector_size(16)));

/// Of each, the first bit last.
inline UInt4 reverse_bits(UInt4 x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

}  // namespace bandsaw
