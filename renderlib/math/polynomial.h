#pragma once

// Small pieces that the elementary functions share.

#include <cmath>
#include <cstddef>

namespace bandsaw {

/// c[0] + c[1] x + … + c[N-1] x^(N-1) by Horner's rule, one rounding a step; from c[I] on. Not a
/// loop: compilers leave it one.
template <std::size_t I = 0, std::size_t N>
inline double polynomial(double x, const double (&c)[N]) {
  if constexpr (I + 1 == N) {
    return c[I];
  } else {
    return std::fma(polynomial<I + 1>(x, c), x, c[I]);
  }
}

/// An unevaluated sum: hi is the sum rounded, lo the rest.
struct TwoDoubles {
  double hi;
  double lo;
};

/// a + b exactly; |a| >= |b| or a == 0 (Dekker 1971).
inline TwoDoubles fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// a + b exactly (Knuth, The Art of Computer Programming 2, section 4.2.2).
inline TwoDoubles two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

/// a b exactly.
inline TwoDoubles two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

}  // namespace bandsaw
