// The emulation of fma for WebAssembly, compared with std::fma, which the processor or the C
// library computes.

#include "renderlib/math/fused.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bandsaw {
namespace {

using Bits = std::uint64_t;

/// Returns true if a and b have the same bits, or if both are NaN.
bool same(double a, double b) {
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b) || (std::isnan(a) && std::isnan(b));
}

/// Expects that the emulation gives the bits of std::fma: for a b + c, and for the rounding error
/// of the product a b.
void expect_same(double a, double b, double c) {
  ASSERT_TRUE(same(emulated::fma(a, b, c), std::fma(a, b, c)))
      << std::hexfloat << a << " " << b << " " << c << ": " << emulated::fma(a, b, c);
  const double product = a * b;
  ASSERT_TRUE(same(emulated::product_error(a, b, product), std::fma(a, b, -product)))
      << std::hexfloat << a << " " << b << ": " << emulated::product_error(a, b, product);
}

class Numbers {
 public:
  /// A number with any bits.
  double any() { return std::bit_cast<double>(random_()); }
  /// A number of either sign, whose absolute value is in [2^-reach, 2^(reach + 1)). Half of these
  /// numbers have few significant bits, so that their sums and products are exact or lie in the
  /// middle between two doubles.
  double near_one(int reach) {
    Bits fraction = random_() >> 12;
    if (random_() % 2 == 0) {
      fraction &= ~Bits{0} << (random_() % 53);
    }
    const int exponent =
        static_cast<int>(random_() % (2 * static_cast<unsigned>(reach) + 1)) - reach;
    const double size = std::ldexp(1 + static_cast<double>(fraction) * 0x1p-52, exponent);
    return random_() % 2 == 0 ? size : -size;
  }
  Bits below(Bits count) { return random_() % count; }

 private:
  std::mt19937_64 random_{20261125};
};

TEST(EmulatedFma, EqualsFmaForSpecialNumbers) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kMax = std::numeric_limits<double>::max();
  std::vector<double> numbers = {
      0,   1,          1 + 0x1p-52,     0x1p-1074, 0x1p-1022,   0x1p-900, 0x1p-450,
      3,   0x1p27 + 1, 0x1p500,         0x1p1000,  kMax,        0x1p-538, kInf,
      0.1, 1 / 3.0,    std::sqrt(kMax), 0x1.8p-52, std::nan("")};
  const std::size_t count = numbers.size();
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(-numbers[i]);
  }
  for (const double a : numbers) {
    for (const double b : numbers) {
      for (const double c : numbers) {
        expect_same(a, b, c);
      }
      expect_same(a, b, -a * b);
    }
  }
}

TEST(EmulatedFma, EqualsFmaForAnyNumbers) {
  Numbers numbers;
  for (int i = 0; i < 1'000'000; ++i) {
    expect_same(numbers.any(), numbers.any(), numbers.any());
    expect_same(numbers.near_one(600), numbers.near_one(600), numbers.near_one(1000));
  }
}

TEST(EmulatedFma, EqualsFmaIfNumbersHaveSimilarSizes) {
  Numbers numbers;
  for (int i = 0; i < 2'000'000; ++i) {
    const double a = numbers.near_one(2);
    const double b = numbers.near_one(2);
    expect_same(a, b, numbers.near_one(2));
    expect_same(a, b, numbers.near_one(110));
  }
}

TEST(EmulatedFma, EqualsFmaIfTheProductIsCancelled) {
  Numbers numbers;
  for (int i = 0; i < 1'000'000; ++i) {
    const double a = numbers.near_one(40);
    const double b = numbers.near_one(40);
    double c = -a * b;
    expect_same(a, b, c);
    for (Bits steps = numbers.below(4); steps > 0; --steps) {
      c = std::nextafter(c, numbers.below(2) == 0 ? 0 : 2 * c);
    }
    expect_same(a, b, c);
  }
}

/// c + product lies in the middle between two doubles, or differs from the middle by much less than
/// the last bit of a double.
TEST(EmulatedFma, EqualsFmaIfTheSumIsNearAMiddle) {
  Numbers numbers;
  for (int i = 0; i < 1'000'000; ++i) {
    const double c = numbers.near_one(3);
    const double half = std::ldexp(1.0, std::ilogb(c) - 53);
    // The products are about half the last bit of c. For example, 2^k (1 + x) (1 - x) with a small
    // x is exactly 2^k (1 - x^2).
    const double x = std::ldexp(1.0, -static_cast<int>(numbers.below(53)));
    expect_same(half * (1 + x), 1 - x, c);
    expect_same(half * (1 + x), 1 + x, c);
    const auto odd = static_cast<double>(2 * numbers.below(64) + 1);
    expect_same(half * odd, 1, c);
    expect_same(half * odd * (1 + x), 1 - x, -c);
    expect_same(half * odd, 1 + x * 0x1p-52 * odd, c);
  }
}

TEST(EmulatedFma, EqualsFmaNearOverflowAndUnderflow) {
  Numbers numbers;
  for (int i = 0; i < 300'000; ++i) {
    const double a = numbers.near_one(30);
    const double b = numbers.near_one(30);
    const double c = numbers.near_one(30);
    for (const double scale : {0x1p500, 0x1p505, 0x1p-450, 0x1p-455, 0x1p-500, 0x1p-530}) {
      expect_same(a * scale, b * scale, c * scale * scale);
      expect_same(a * scale, b * scale, c * scale);
      expect_same(a * scale, b, c * scale);
    }
  }
}

}  // namespace
}  // namespace bandsaw
