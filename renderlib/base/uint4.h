#pragma once

// Four unsigned integers of 32 bits at a time. Integer arithmetic is exact on every machine, so the
// compiler's own vectors are used.

#include <bit>
#include <cstdint>

namespace bandsaw {

using UInt4 = std::uint32_t __attribute__((vector_size(16)));
using Byte16 = std::uint8_t __attribute__((vector_size(16)));

/// Reverses the bits of each lane.
inline UInt4 reverse_bits(UInt4 x) {
  const auto bytes = std::bit_cast<Byte16>(x);
  x = std::bit_cast<UInt4>(
      __builtin_shufflevector(bytes, bytes, 3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12));
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

}  // namespace bandsaw
