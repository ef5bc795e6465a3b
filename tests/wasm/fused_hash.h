#pragma once

// Hash of results of fused operations (a b + c, rounded once; renderlib/math/fused.h). The hash
// must be equal in the native program and in WebAssembly. WebAssembly has no instruction for fused
// operations, so they are emulated there.

#include <bit>
#include <cmath>
#include <cstdint>

#include "renderlib/base/split_mix.h"
#include "renderlib/math/fused.h"
#include "renderlib/render/hash64.h"

namespace bandsaw::test {

/// Returns the hash. The operands of the first operation have random bits. All other operands are
/// random numbers of absolute values from 1 to 512 or products of such numbers, some of them scaled
/// down by a power of two. Many of these numbers have few significant bits. Some sums cancel, and
/// some results are very small. A result that is not a number counts as 1.
inline std::uint64_t fused_hash() {
  Hash64 hash;
  std::uint64_t state = 0;
  const auto bits = [&] { return split_mix(state += kSplitMixIncrement); };
  const auto add = [&](double value) { hash.add(std::isnan(value) ? 1.0 : value); };
  for (int i = 0; i < 200'000; ++i) {
    const auto any = [&] { return std::bit_cast<double>(bits()); };
    const double a = any();
    const double b = any();
    add(fused(a, b, any()));
    // Returns a number of random sign with an absolute value in [1, 512).
    const auto near_one = [&] {
      const std::uint64_t fraction = bits() >> 12 & ~std::uint64_t{0} << bits() % 53;
      const double x = std::bit_cast<double>(fraction | std::uint64_t{1023} << 52);
      return std::ldexp(x, static_cast<int>(bits() % 9)) * (bits() % 2 == 0 ? 1 : -1);
    };
    const double p = near_one();
    const double q = near_one();
    add(fused(p, q, near_one()));
    add(fused(p, q, near_one() * 0x1p-53));
    add(fused(p, q, -p * q));
    add(product_error(p, q, p * q));
    add(fused(p * 0x1p-500, q * 0x1p-500, near_one() * 0x1p-1020));
    const auto small = [&] { return static_cast<float>(near_one()); };
    const float r = small();
    const float s = small();
    add(fused(r, s, small()));
    add(fused(r, s, -r * s));
    add(fused(r * 0x1p-70f, s * 0x1p-70f, small() * 0x1p-140f));
  }
  return hash.value();
}

}  // namespace bandsaw::test
