#pragma once

// Tests that sampled directions have the claimed pdf.

#include <cstddef>
#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/math/vec.h"

namespace bandsaw::test {

/// Calls `sample(u, v)` 10^5 times with uniform u and v in [0, 1) and counts the returned
/// directions in 10 x 20 cells of the sphere. Then compares the counts with the pdf by the
/// chi-squared test: the expected count of a cell follows from the integral of `density` over the
/// cell. `density`: the claimed pdf by solid angle. If `sample` returns a zero vector, this sample
/// is lost. If no sample is lost, `density` must integrate to 1 within 0.5 %; it may be a step
/// function. If some samples are lost, the integral of `density` is the probability that a sample
/// is not lost. `tests`: how often a test calls this function. The significance level is such that
/// all these calls together fail by chance with probability 0.01.
void expect_samples_match_density(absl::FunctionRef<Vec3(double, double)> sample,
                                  absl::FunctionRef<double(const Vec3&)> density,
                                  std::uint64_t seed, std::size_t tests = 1);

}  // namespace bandsaw::test
