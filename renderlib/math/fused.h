#pragma once

// Fused multiplication and addition, which is a b + c with one rounding: std::fma where processors
// have the instruction. WebAssembly has none, so there the functions are emulated, with the same
// bits.

#include <bit>
#include <cmath>
#include <cstdint>

#include "renderlib/base/simd_plain.h"

namespace bandsaw {

/// An unevaluated sum: hi is the rounded sum, lo the remainder.
struct TwoDoubles {
  double hi;
  double lo;
};

/// Returns a + b exactly; requires |a| >= |b| or a == 0 (Dekker 1971).
inline TwoDoubles fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Returns a + b exactly (Knuth, The Art of Computer Programming 2, section 4.2.2).
inline TwoDoubles two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

namespace emulated {

/// If a product is smaller than this, its rounding error may not be representable as a double.
inline constexpr double kLeastProduct = 0x1p-900;

/// Returns x as the sum of two numbers of at most 26 bits. If x is close to the largest double, the
/// result is infinity and NaN.
inline TwoDoubles halves(double x) {
  constexpr std::uint64_t kLow = (std::uint64_t{1} << 27) - 1;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const auto hi = std::bit_cast<double>((bits + (std::uint64_t{1} << 26)) & ~kLow);
  return {hi, x - hi};
}

/// Returns a b - product, where `product` is a b rounded and |product| is at least kLeastProduct
/// (Dekker 1971).
inline double error_of_product(double a, double b, double product) {
  const TwoDoubles p = halves(a);
  const TwoDoubles q = halves(b);
  return ((p.hi * q.hi - product) + p.hi * q.lo + p.lo * q.hi) + p.lo * q.lo;
}

/// Handles the rare cases of fma(). Takes the parameters of fma() and numbers that fma() has
/// computed from them.
[[gnu::noinline]] inline double careful_fma(double a, double b, double c, double product,
                                            double error, double sum) {
  if (a == 0 || b == 0) {
    return product + c;
  }
  if (!(std::abs(product) > kLeastProduct && std::abs(sum) < 0x1p1000)) {
    return std::fma(a, b, c);  // slow, by integers
  }
  const TwoDoubles head = two_sum(product, c);
  const TwoDoubles rest = two_sum(head.lo, error);
  auto bits = std::bit_cast<std::uint64_t>(rest.hi);
  if (rest.lo != 0) {
    // Rounds to odd: the last bit, which is 0, becomes 1 by a step towards the exact sum.
    bits += (rest.lo > 0) == (rest.hi > 0) ? std::uint64_t{1} : ~std::uint64_t{0};
  }
  return head.hi + std::bit_cast<double>(bits);
}

/// Returns a b + c, rounded once. The exact sum is head.hi + (head.lo + error), and `rest` is
/// head.lo + error, rounded. If head.lo is 0, `rest` is exact, and the sum is rounded only once.
/// Otherwise nothing was cancelled, and `rest` is below two units in the last place of head.hi.
/// Then the rounding of `rest` changes the result only if head.hi + rest lies in the middle between
/// two doubles, which implies that `rest` has only a few bits. In that case careful_fma() rounds
/// `rest` to odd, which gives the right result (Boldo, Melquiond 2008, "Emulation of FMA and
/// correctly rounded sums: proved algorithms using rounding to odd").
inline double fma(double a, double b, double c) {
  const double product = a * b;
  const double error = error_of_product(a, b, product);
  const TwoDoubles head = two_sum(product, c);
  const double rest = head.lo + error;
  const double sum = head.hi + rest;
  if (static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(rest)) == 0 ||
      !(std::abs(product) > kLeastProduct) || !(std::abs(sum) < 0x1p1000)) [[unlikely]] {
    return careful_fma(a, b, c, product, error, sum);
  }
  return sum;
}

/// Returns a b - product, where `product` is a b rounded. The result is exact if the difference is
/// a double; otherwise the difference is rounded. An exact zero is +0.
inline double product_error(double a, double b, double product) {
  const double error = error_of_product(a, b, product);
  if (!(std::abs(product) > kLeastProduct) || !(std::abs(error) < 0x1p900)) [[unlikely]] {
    return a == 0 || b == 0 ? product - product : std::fma(a, b, -product);
  }
  return error;
}

}  // namespace emulated

#if defined(__wasm__)
using emulated::product_error;
inline double fused(double a, double b, double c) { return emulated::fma(a, b, c); }
inline float fused(float a, float b, float c) { return simd_plain::fused(a, b, c); }
#else
/// Returns a b - product, rounded once, where `product` is a b rounded. The result is exact unless
/// it underflows.
inline double product_error(double a, double b, double product) { return std::fma(a, b, -product); }
/// These functions return a b + c, rounded once.
inline double fused(double a, double b, double c) { return std::fma(a, b, c); }
inline float fused(float a, float b, float c) { return std::fma(a, b, c); }
#endif

}  // namespace bandsaw
