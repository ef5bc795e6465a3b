// The eight-lane vectors: each operation gives the same bits as its plain implementation without
// SIMD instructions.

#include "renderlib/base/simd.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "renderlib/base/simd_plain.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

using Lanes = std::array<float, 8>;

/// Returns mostly a number in [-2, 2], and sometimes a special value (zero, infinity, NaN, a
/// denormal, 1) or a float of random bits.
float any_float(test::Random& random) {
  const float special[] = {0.0f,
                           -0.0f,
                           1.0f,
                           HUGE_VALF,
                           -HUGE_VALF,
                           std::nanf(""),
                           std::numeric_limits<float>::denorm_min()};
  switch (random.below(8)) {
    case 0:
      return special[random.below(7)];
    case 1:
      return std::bit_cast<float>(static_cast<std::uint32_t>(random.bits() >> 32));
    default:
      return static_cast<float>(random.uniform(-2, 2));
  }
}

Lanes any_lanes(test::Random& random) {
  Lanes lanes;
  for (float& x : lanes) {
    x = any_float(random);
  }
  return lanes;
}

/// Expects the same bits; all NaNs are equal.
void expect_same(const Lanes& a, const Lanes& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!std::isnan(a[i]) || !std::isnan(b[i])) {
      ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i]), std::bit_cast<std::uint32_t>(b[i])) << i;
    }
  }
}

template <class Float>
Lanes stored(const Float& x) {
  Lanes lanes;
  x.store(lanes.data());
  return lanes;
}

/// Returns the lanes. They are copied by to_bytes(), which writes the 32 bytes of the vector to any
/// object of this size; from_bytes() reads them.
template <class Float>
Lanes in_bytes(const Float& x) {
  Lanes lanes;
  x.to_bytes(lanes);
  return lanes;
}

/// Returns the values as int32; 0 in lanes whose conversion is not defined.
template <class Float>
std::array<std::int32_t, 8> truncated(const Float& x) {
  const Lanes all = stored(x);
  std::array<std::int32_t, 8> lanes;
  x.store_truncated(lanes.data());
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    lanes[i] = std::abs(all[i]) < 0x1p31f ? lanes[i] : 0;
  }
  return lanes;
}

TEST(Simd, PlainFusedMultiplyAddRoundsOnce) {
  test::Random random(1);
  for (int i = 0; i < 2'000'000; ++i) {
    const float a = any_float(random);
    const float b = any_float(random);
    // Half of the values are close to -a b, so that the sum nearly cancels.
    const float c = i % 2 == 0 ? any_float(random) : std::nextafter(-a * b, any_float(random));
    expect_same(Lanes{simd_plain::fused(a, b, c)}, Lanes{std::fma(a, b, c)});
  }
}

TEST(Simd, EveryOperationEqualsThePlainOne) {
  test::Random random(2);
  using simd_plain::Float8;
  using Fast = bandsaw::Float8;
  for (int i = 0; i < 100'000; ++i) {
    const Lanes a = any_lanes(random);
    const Lanes b = any_lanes(random);
    const Lanes c = any_lanes(random);
    const auto fast = [](const Lanes& x) { return Fast::load(x.data()); };
    const auto plain = [](const Lanes& x) { return Float8::load(x.data()); };
    expect_same(stored(fast(a) + fast(b)), stored(plain(a) + plain(b)));
    expect_same(stored(fast(a) - fast(b)), stored(plain(a) - plain(b)));
    expect_same(stored(fast(a) * fast(b)), stored(plain(a) * plain(b)));
    expect_same(stored(fast(a) / fast(b)), stored(plain(a) / plain(b)));
    expect_same(stored(fused(fast(a), fast(b), fast(c))),
                stored(fused(plain(a), plain(b), plain(c))));
    expect_same(stored(fused_minus(fast(a), fast(b), fast(c))),
                stored(fused_minus(plain(a), plain(b), plain(c))));
    expect_same(stored(min(fast(a), fast(b))), stored(min(plain(a), plain(b))));
    expect_same(stored(max(fast(a), fast(b))), stored(max(plain(a), plain(b))));
    expect_same(in_bytes(Fast::from_bytes(a)), in_bytes(Float8::from_bytes(a)));
    expect_same(stored(swap_halves(fast(a))), stored(swap_halves(plain(a))));
    ASSERT_EQ(truncated(fast(a)), truncated(plain(a)));
    expect_same(stored(abs(fast(a))), stored(abs(plain(a))));
    expect_same(stored(flip_by_sign(fast(a), fast(b))), stored(flip_by_sign(plain(a), plain(b))));
    ASSERT_EQ((fast(a) < fast(b)).bits(), (plain(a) < plain(b)).bits());
    ASSERT_EQ((fast(a) <= fast(b)).bits(), (plain(a) <= plain(b)).bits());
    ASSERT_EQ(((fast(a) < fast(b)) & (fast(b) < fast(c))).bits(),
              ((plain(a) < plain(b)) & (plain(b) < plain(c))).bits());
    ASSERT_EQ(((fast(a) < fast(b)) | (fast(b) < fast(c))).bits(),
              ((plain(a) < plain(b)) | (plain(b) < plain(c))).bits());
  }
}

// Where neither operand is less than the other operand, min and max must return the second operand,
// as the instructions of x86 do. NEON's instructions would return NaN if an operand is NaN, and
// would treat -0 as less than 0.
TEST(Simd, MinAndMaxReturnTheSecondOperandWhereNeitherIsLess) {
  const float nan = std::nanf("");
  const Lanes a = {nan, 1, nan, 0.0f, -0.0f, 2, nan, -HUGE_VALF};
  const Lanes b = {1, nan, nan, -0.0f, 0.0f, 2, HUGE_VALF, nan};
  const Float8 first = Float8::load(a.data());
  const Float8 second = Float8::load(b.data());
  Lanes expected = b;
  expect_same(stored(min(first, second)), expected);
  expect_same(stored(max(first, second)), expected);
  expected = a;
  expect_same(stored(min(second, first)), expected);
  expect_same(stored(max(second, first)), expected);
}

TEST(Simd, TruncatesTowardsZeroAndSwapsHalves) {
  const Lanes lanes = {-1.9f, 2.9f, -0.0f, 0x1p30f, 0.99f, -0x1p30f, 15, 16.5f};
  const std::array<std::int32_t, 8> expected = {-1, 2, 0, 1 << 30, 0, -(1 << 30), 15, 16};
  EXPECT_EQ(truncated(Float8::load(lanes.data())), expected);
  const Lanes numbers = {0, 1, 2, 3, 4, 5, 6, 7};
  expect_same(stored(swap_halves(Float8::from_bytes(numbers))), {4, 5, 6, 7, 0, 1, 2, 3});
}

}  // namespace
}  // namespace bandsaw
