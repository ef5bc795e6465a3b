#pragma once

// The seeds of simulated farms.

#include <cstdint>
#include <cstdlib>

#include "gtest/gtest.h"
#include "tests/support/environment.h"
#include "tests/support/sanitized.h"

namespace bandsaw::coordinator::sim {

/// Calls f for `seeds` seeds from `first` on, or for the seeds that the environment specifies.
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
