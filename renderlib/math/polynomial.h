#pragma once

// Building blocks of the elementary functions.

#include <cmath>
#include <cstddef>

namespace bandsaw {

/// Returns c[0] + c[1] x + … + c[N-1] x^(N-1), from c[I] on, by Horner's rule with one rounding per
/// step. Recursive, because compilers do not unroll the loop.
template <std::size_t I = 0, std::size_t N>
inline double polynomial(double x, const double (&c)[N]) {
  if constexpr (I + 1 == N) {
    return c[I];
  } else {
    return std::fma(polynomial<I + 1>(x, c), x, c[I]);
  }
}

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

/// Returns a b exactly.
inline TwoDoubles two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

}  // namespace bandsaw
