// RowTimes: the render time of each row of an image. It is measured for the rows of bands and
// interpolated for the other rows.

#include "coordinator/scheduler/model/row_costs.h"

#include "gtest/gtest.h"

namespace bandsaw::coordinator {
namespace {

TEST(RowTimes, AreZeroBeforeAnyMeasurement) {
  const RowTimes times(10);
  EXPECT_FALSE(times.measured());
  EXPECT_EQ(times.of_all(), 0);
}

TEST(RowTimes, AreInterpolatedBetweenMeasuredRows) {
  RowTimes times(12);
  times.measure({2, 4}, 2);  // 1 for each row
  times.measure({7, 8}, 5);
  EXPECT_DOUBLE_EQ(times.of({2, 4}), 2);
  EXPECT_DOUBLE_EQ(times.of({4, 7}), 2 + 3 + 4);
  EXPECT_DOUBLE_EQ(times.of({5, 6}), 3) << "a range within a gap is interpolated, too";
  EXPECT_DOUBLE_EQ(times.of({0, 2}), 2) << "rows above the first measured row take its time";
  EXPECT_DOUBLE_EQ(times.of({8, 12}), 20) << "rows below the last measured row take its time";
}

TEST(RowTimes, AverageTwoMeasurements) {
  RowTimes times(1);
  times.measure({0, 1}, 2);
  times.measure({0, 1}, 4);
  EXPECT_DOUBLE_EQ(times.of_all(), 3);
}

TEST(RowTimes, ScaleWithTheShareOfSamples) {
  RowTimes times(64);
  times.measure({0, 64}, 64);
  // The share of a row of tiles (16 rows) is the number of its samples, divided by the number of
  // its samples with uniform sampling. The 64 rows use the first four entries of `shares`.
  std::vector<float> shares(64 / 8, 0.5F);
  EXPECT_DOUBLE_EQ(times.of_all() / 2, times.of({0, 64}, shares));
}

}  // namespace
}  // namespace bandsaw::coordinator
