#pragma once

// Tests that sampled directions have the claimed pdf.

#include <cstddef>
#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/math/vec.h"

namespace bandsaw::test {

/// Draws 10^5 directions and compares them with the pdf (by solid angle) integrated over 10 x 20
/// cells of the sphere: chi-squared at level 0.01. Also expects the integral of the pdf to be
/// within 0.5 % of 1, unless samples may be lost: a zero vector is a lost sample, and the integral
/// is then the probability of a sample that is not lost. The pdf may be a step function. `tests`:
/// number of such tests that share the level.
void expect_samples_match_density(absl::FunctionRef<Vec3(double, double)> sample,
                                  absl::FunctionRef<double(const Vec3&)> density,
                                  std::uint64_t seed, std::size_t tests = 1);

}  // namespace bandsaw::test
