#pragma once

// Building blocks of the elementary functions (elementary.h).

#include <cstddef>

#include "renderlib/math/fused.h"

namespace bandsaw {

/// Returns c[0] + c[1] x + … + c[N-1] x^(N-1) by Horner's rule, with one rounding per step. For the
/// recursion, `I` is the index of the first coefficient that is used. The function is recursive,
/// because compilers would not unroll a loop over the coefficients.
template <std::size_t I = 0, std::size_t N>
inline double polynomial(double x, const double (&c)[N]) {
  if constexpr (I + 1 == N) {
    return c[I];
  } else {
    return fused(polynomial<I + 1>(x, c), x, c[I]);
  }
}

/// Returns a b exactly, as the sum of two doubles.
inline TwoDoubles two_product(double a, double b) {
  const double product = a * b;
  return {product, product_error(a, b, product)};
}

}  // namespace bandsaw
