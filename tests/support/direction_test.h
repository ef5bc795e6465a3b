#pragma once

// Whether directions that are sampled have the density that is claimed.

#include <cstddef>
#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/math/vec.h"

namespace bandsaw::test {

/// Draws 10^5 directions and compares them with the density (by solid angle) integrated over 10 x
/// 20 cells of the sphere: chi-squared at level 0.01, and the density's integral within 0.5 % of 1
/// unless samples may be lost (a zero vector is a lost sample: then the integral is the chance of
/// one that is not). The density may be a step function.
/// `tests`: how many such tests share the level.
void expect_samples_match_density(absl::FunctionRef<Vec3(double, double)> sample,
                                  absl::FunctionRef<double(const Vec3&)> density,
                                  std::uint64_t seed, std::size_t tests = 1);

}  // namespace bandsaw::test
