#pragma once

// The seeds with which tests run simulated farms.

#include <cstdint>
#include <cstdlib>

#include "gtest/gtest.h"
#include "tests/support/environment.h"
#include "tests/support/sanitized.h"

namespace bandsaw::coordinator::sim {

/// Calls f(seed) for `seeds` consecutive seeds from `first` on, until a test fails. The environment
/// variable BANDSAW_SEEDS=n gives another number of seeds, and BANDSAW_SEED=n runs seed n alone.
/// Builds with a sanitizer run fewer seeds.
template <class F>
void for_seeds(std::uint64_t first, std::uint64_t seeds, F f) {
  if (std::getenv("BANDSAW_SEED") != nullptr) {
    f(test::number_from("BANDSAW_SEED", 0));
    return;
  }
  for (std::uint64_t seed = first;
       seed < first + test::number_from("BANDSAW_SEEDS", seeds / test::kSlower); ++seed) {
    f(seed);
    if (testing::Test::HasFailure()) {
      return;
    }
  }
}

}  // namespace bandsaw::coordinator::sim
