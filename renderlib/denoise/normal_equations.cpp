// Weighted least squares for eight centres of the fit (fit.h) at a time: add() adds a pixel to the
// normal equations, solve() solves them by the factorisation L D L^T. A ridge keeps them regular.

#include "renderlib/denoise/fit_parts.h"

namespace bandsaw {
namespace {

/// The ridge is this many times the sum of the weights. Without it, a guide that is constant in the
/// window would make the equations singular.
constexpr float kRidge = 1e-5f;
/// Minimum of an element of D, relative to the diagonal element of the matrix. Smaller elements are
/// only rounding errors and are replaced by this minimum.
constexpr float kMinPivot = 1e-6f;

/// A symmetric matrix as L D L^T: D on the diagonal, L below it.
using Factors = Float8[kTerms][kTerms];

/// Replaces the lower triangle of a matrix by its factors. `inverse` receives 1 / D.
void factorize(Factors& a, Float8 (&inverse)[kTerms]) {
  for (std::size_t j = 0; j < kTerms; ++j) {
    const Float8 least = a[j][j] * Float8(kMinPivot) + Float8(1e-30f);
    Float8 scaled[kTerms];
    for (std::size_t k = 0; k < j; ++k) {
      scaled[k] = a[j][k] * a[k][k];
      a[j][j] = a[j][j] - a[j][k] * scaled[k];
    }
    a[j][j] = max(a[j][j], least);
    inverse[j] = Float8(1.0f) / a[j][j];
    for (std::size_t i = j + 1; i < kTerms; ++i) {
      for (std::size_t k = 0; k < j; ++k) {
        a[i][j] = a[i][j] - a[i][k] * scaled[k];
      }
      a[i][j] = a[i][j] * inverse[j];
    }
  }
}

}  // namespace

NormalEquations::NormalEquations() {
  for (Float8& product : products) {
    product = Float8(0.0f);
  }
  for (auto& value : values) {
    for (Float8& channel : value) {
      channel = Float8(0.0f);
    }
  }
}

void NormalEquations::add(const Float8& weight, const Float8 (&terms)[kTerms],
                          const Float8 (&value)[3]) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < kTerms; ++i) {
    const Float8 weighted = weight * terms[i];
    for (std::size_t j = i; j < kTerms; ++j, ++at) {
      products[at] = products[at] + weighted * terms[j];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      values[i][c] = values[i][c] + weighted * value[c];
    }
  }
}

void NormalEquations::add_ridge() {
  // The first term is 1, so products[0] is the sum of the weights.
  const Float8 ridge = products[0] * Float8(kRidge);
  std::size_t at = kTerms;
  for (std::size_t i = 1; i < kTerms; ++i) {
    products[at] = products[at] + ridge;
    at += kTerms - i;
  }
}

void NormalEquations::solve() {
  Factors a;
  std::size_t at = 0;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = i; j < kTerms; ++j) {
      a[j][i] = products[at++];
    }
  }
  Float8 inverse[kTerms];
  factorize(a, inverse);
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        values[i][c] = values[i][c] - a[i][k] * values[k][c];
      }
    }
    for (std::size_t i = kTerms; i-- > 0;) {
      values[i][c] = values[i][c] * inverse[i];
      for (std::size_t k = i + 1; k < kTerms; ++k) {
        values[i][c] = values[i][c] - a[k][i] * values[k][c];
      }
    }
  }
}

}  // namespace bandsaw
