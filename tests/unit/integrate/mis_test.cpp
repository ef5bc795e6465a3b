// The weights of multiple importance sampling.

#include "renderlib/integrate/mis.h"

#include <gtest/gtest.h>

namespace bandsaw {
namespace {

TEST(Mis, PowerHeuristicDoesNotOverflow) {
  EXPECT_EQ(power_heuristic(1, 0), 1);
  EXPECT_EQ(power_heuristic(1e200, 1e200), 0.5);
  EXPECT_EQ(power_heuristic(1e-200, 1e200), 0);
  EXPECT_NEAR(power_heuristic(2, 1) + power_heuristic(1, 2), 1, 1e-16);
}

}  // namespace
}  // namespace bandsaw
