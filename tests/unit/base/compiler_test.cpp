// Tests the floating-point behaviour that the compiler options must ensure. An id such as Y1 in a
// test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>

#include "renderlib/base/float_mode.h"
#include "renderlib/base/pool.h"
#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

struct FloatPair {
  float x;
  float y;
};
struct DoublePair {
  double x;
  double y;
};

/// g++ 12.2 at -O2 breaks this function unless -fno-tree-slp-vectorize is given: it stores the
/// doubles that it read, without rounding them.
[[gnu::noinline]] void round_to_float(const double* in, DoublePair* out) {
  const FloatPair f{static_cast<float>(in[0]), static_cast<float>(in[1])};
  *out = DoublePair{f.x, f.y};
}

TEST(Compiler, Y1_KeepsTheRoundingOfNeighbouringFloats) {
  const double in[2] = {15.123456789, -3.0000000001};
  DoublePair out;
  // The compiler must not know the numbers. Otherwise it rounds them itself, correctly, and the
  // test cannot fail.
  const double* volatile unknown = in;
  round_to_float(unknown, &out);
  EXPECT_EQ(out.x, 15.123456954956055);
  EXPECT_EQ(out.y, -3.0);
  test::report_hard_case("Y1", "doubles are rounded when they become floats");
}

[[gnu::noinline]] double multiply_add(double a, double b, double c) { return a * b + c; }

TEST(Compiler, Y3_RoundsProductsBeforeItAdds) {
  volatile double unknown = 1 + 0x1p-30;
  const double a = unknown;
  // The square of a is 1 + 2^-29 + 2^-60. Rounding the product to double drops 2^-60.
  EXPECT_EQ(multiply_add(a, a, -(1 + 0x1p-29)), 0);
  EXPECT_EQ(std::fma(a, a, -(1 + 0x1p-29)), 0x1p-60);
  test::report_hard_case("Y3", "a product is rounded before a sum (no fused multiply-add)");
}

[[gnu::noinline]] double sum_of_three(double a, double b, double c) { return (a + b) + c; }

TEST(Compiler, DoesNotReorderSums) {
  volatile double unknown = 1e100;
  const double large = unknown;
  EXPECT_EQ(sum_of_three(large, -large, 1), 1);
  EXPECT_EQ(sum_of_three(1, large, -large), 0);
}

TEST(FloatingPointState, Y2_IsTheDefaultInEveryThread) {
  EXPECT_TRUE(float_mode_is_default());
  Pool pool(3);
  pool.parallel_for(30, [](std::int64_t) { EXPECT_TRUE(float_mode_is_default()); });
  test::report_hard_case("Y2", "default floating-point mode in every thread of a pool");
}

TEST(FloatingPointState, AnotherModeIsDetected) {
  const int before = std::fegetround();
  ASSERT_EQ(std::fesetround(FE_UPWARD), 0);
  const bool seen = !float_mode_is_default();
  ASSERT_EQ(std::fesetround(before), 0);
  EXPECT_TRUE(seen);
  EXPECT_TRUE(float_mode_is_default());
}

TEST(FloatingPointState, KeepsDenormals) {
  volatile double least = 0x1p-1022;
  const double half = least / 2;
  EXPECT_GT(half, 0);
  EXPECT_EQ(half * 2, least);
}

}  // namespace
}  // namespace bandsaw
