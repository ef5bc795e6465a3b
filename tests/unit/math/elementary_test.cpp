// The elementary functions (sin, cos, exp, log, pow and so on) whose bits are the same on every
// machine. Their errors are measured in units in the last place (ulp) against references of higher
// precision (oracle.h). An id such as Y4 in a test's name is that of a case in
// tests/hard_cases/cases.txt.

#include "renderlib/math/elementary.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <string>
#include <vector>

#include "renderlib/math/constants.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/unit/math/oracle.h"

namespace bandsaw {
namespace {

using test::Quad;

/// A function of one number and the range in which it is tested: uniform in [lo, hi], or uniform in
/// the logarithm.
struct Case {
  std::string name;
  double (*function)(double);
  Quad (*oracle)(Quad);
  double lo;
  double hi;
  bool logarithmic;
};

/// Returns the difference between x turns and the nearest whole number of quarter turns. It is in
/// [-1/8, 1/8] turns. Only this difference is passed to the reference function, whose own range
/// reduction is exact for small arguments.
Quad rest_of_turn(Quad x) {
  return x - static_cast<Quad>(std::nearbyint(4 * static_cast<double>(x))) / 4;
}

/// Returns the number of whole quarter turns in x turns, modulo 4.
int quarter_of_turn(Quad x) {
  return static_cast<int>(std::nearbyint(4 * static_cast<double>(x))) & 3;
}

/// Returns the sine of x turns.
Quad sin_turns_oracle(Quad x) {
  const Quad angle = 2 * test::pi() * rest_of_turn(x);
  switch (quarter_of_turn(x)) {
    case 0:
      return test::quad_sin(angle);
    case 1:
      return test::quad_cos(angle);
    case 2:
      return -test::quad_sin(angle);
    default:
      return -test::quad_cos(angle);
  }
}
Quad cos_turns_oracle(Quad x) { return sin_turns_oracle(x + Quad{1} / 4); }

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"sin_turns", [](double x) { return sincos_turns(x).sin; }, sin_turns_oracle, -3, 3, false},
      {"cos_turns", [](double x) { return sincos_turns(x).cos; }, cos_turns_oracle, -3, 3, false},
      {"sin_turns_small", [](double x) { return sincos_turns(x).sin; }, sin_turns_oracle, 1e-30, 1,
       true},
      {"sin_degrees", [](double x) { return sincos_degrees(x).sin; },
       [](Quad x) { return test::quad_sin(x * test::pi() / 180); }, -45, 45, false},
      {"cos_degrees", [](double x) { return sincos_degrees(x).cos; },
       [](Quad x) { return test::quad_cos(x * test::pi() / 180); }, -45, 45, false},
      {"tan_degrees", tan_degrees, [](Quad x) { return test::quad_tan(x * test::pi() / 180); }, -89,
       89, false},
      {"asin", asin, test::quad_asin, -1, 1, false},
      {"asin_small", asin, test::quad_asin, 1e-30, 1, true},
      {"acos", acos, test::quad_acos, -1, 1, false},
      {"acos_near_one", [](double x) { return acos(1 - x); },
       [](Quad x) { return test::quad_acos(static_cast<Quad>(1 - static_cast<double>(x))); }, 1e-16,
       1, true},
      {"atan2_right", [](double x) { return atan2(x, 1.7); },
       [](Quad x) { return test::quad_atan2(x, 1.7); }, 1e-30, 1e30, true},
      {"atan2_left", [](double x) { return atan2(x, -0.3); },
       [](Quad x) { return test::quad_atan2(x, -0.3); }, 1e-30, 1e30, true},
      {"atan2_below", [](double x) { return atan2(-2.5, x); },
       [](Quad x) { return test::quad_atan2(-2.5, x); }, -10, 10, false},
      {"exp", exp, test::quad_exp, -700, 709, false},
      {"exp_small", exp, test::quad_exp, 1e-30, 1, true},
      {"expm1", expm1, test::quad_expm1, -4, 4, false},
      {"expm1_wide", expm1, test::quad_expm1, -50, 709, false},
      {"expm1_small", expm1, test::quad_expm1, 1e-30, 1, true},
      {"log", log, test::quad_log, 1e-300, 1e300, true},
      {"log_near_one", log, test::quad_log, 0.5, 2, false},
      {"log1p", log1p, test::quad_log1p, -0.9999, 4, false},
      {"log1p_wide", log1p, test::quad_log1p, 1e-30, 1e30, true},
      {"log1p_negative", [](double x) { return log1p(-x); },
       [](Quad x) { return test::quad_log1p(-x); }, 1e-30, 1, true},
  };
  return all;
}

/// Returns a random argument of the function.
double draw(const Case& c, test::Random& random) {
  return c.logarithmic ? std::exp(random.uniform(std::log(c.lo), std::log(c.hi)))
                       : random.uniform(c.lo, c.hi);
}

class Elementary : public testing::TestWithParam<Case> {};

TEST_P(Elementary, ErrorIsWithinTwoUnitsInTheLastPlace) {
  const Case& c = GetParam();
  test::Random random(17);
  double worst = 0;
  for (int i = 0; i < 30000; ++i) {
    const double x = draw(c, random);
    const double error = test::error_in_ulps(c.function(x), c.oracle(x));
    ASSERT_LE(error, 2) << "at " << x;
    worst = std::max(worst, error);
  }
  RecordProperty("worst_ulps", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(, Elementary, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.name; });

TEST(ElementaryPow, IsExactEnoughForColours) {
  test::Random random(18);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::exp(random.uniform(-10, 10));
    const double y = random.uniform(-6.9, 6.9);
    const Quad truth = test::quad_pow(x, y);
    const double value = pow(x, y);
    ASSERT_LE(static_cast<double>(test::quad_abs(static_cast<Quad>(value) - truth) / truth), 1e-14)
        << x << " to the " << y;
  }
}

// A negative base is an exception: the result is NaN, where the standard gives 1 for (-1)^2.
TEST(ElementaryPow, HasTheLimitsOfTheStandardExceptForNegativeBases) {
  EXPECT_EQ(pow(0, 0), 1);
  EXPECT_EQ(pow(0, 2.4), 0);
  EXPECT_EQ(pow(0, -1), kInfinity);
  EXPECT_EQ(pow(1, 1e300), 1);
  EXPECT_EQ(pow(kInfinity, 0.5), kInfinity);
  EXPECT_EQ(pow(kInfinity, -0.5), 0);
  EXPECT_EQ(pow(0.5, kInfinity), 0);
  EXPECT_EQ(pow(2, 2000), kInfinity);
  EXPECT_EQ(pow(2, -2000), 0);
  EXPECT_TRUE(std::isnan(pow(-1, 2)));
}

TEST(ElementarySinCos, IsExactAtQuarters) {
  for (int k = -9; k <= 9; ++k) {
    const int quarter = ((k % 4) + 4) % 4;
    const double s = quarter == 1 ? 1 : quarter == 3 ? -1 : 0;
    const double c = quarter == 0 ? 1 : quarter == 2 ? -1 : 0;
    EXPECT_EQ(sincos_turns(k / 4.0).sin, s);
    EXPECT_EQ(sincos_turns(k / 4.0).cos, c);
    EXPECT_EQ(sincos_degrees(90.0 * k).sin, s);
    EXPECT_EQ(sincos_degrees(90.0 * k).cos, c);
  }
}

TEST(ElementarySinCos, TakesAnyFiniteAngle) {
  EXPECT_EQ(sincos_turns(0x1p60).cos, 1);
  EXPECT_EQ(sincos_turns(-1.7e308).sin, 0);
  EXPECT_EQ(sincos_turns(1e15 + 0.25).sin, 1);
  EXPECT_EQ(sincos_degrees(360e12 + 90).sin, 1);
  EXPECT_NEAR(sincos_degrees(1e6 * 360 + 30).sin, 0.5, 1e-15);
  EXPECT_TRUE(std::isnan(sincos_turns(kInfinity).sin));
  EXPECT_TRUE(std::isnan(sincos_degrees(std::nan("")).cos));
}

TEST(ElementaryAtan2, HasTheRightQuadrantsAndEnds) {
  EXPECT_EQ(atan2(0, 0), 0);
  EXPECT_EQ(atan2(0, 1), 0);
  EXPECT_EQ(atan2(0, -1), kPi);
  EXPECT_EQ(atan2(-0.0, -1), kPi);
  EXPECT_EQ(atan2(1, 0), kPi / 2);
  EXPECT_EQ(atan2(-1, 0), -kPi / 2);
  EXPECT_EQ(atan2(1, 1), kPi / 4);
  EXPECT_EQ(atan2(-1, -1), -3 * (kPi / 4));
  EXPECT_EQ(atan2(kInfinity, 1), kPi / 2);
  EXPECT_EQ(atan2(1, kInfinity), 0);
  EXPECT_EQ(atan2(kInfinity, kInfinity), kPi / 4);
  EXPECT_EQ(atan2(1.5e308, 1.5e308), kPi / 4);
  EXPECT_EQ(atan2(3e-320, 3e-320), kPi / 4);
  EXPECT_TRUE(std::isnan(atan2(std::nan(""), 1)));
}

TEST(ElementaryArcs, ClampTheirArgument) {
  EXPECT_EQ(asin(1 + 1e-15), kPi / 2);
  EXPECT_EQ(asin(-2), -kPi / 2);
  EXPECT_EQ(acos(1 + 1e-15), 0);
  EXPECT_EQ(acos(-2), kPi);
  EXPECT_EQ(acos(0), kPi / 2);
  EXPECT_EQ(asin(0), 0);
}

TEST(ElementaryExp, HasTheLimitsOfTheStandard) {
  EXPECT_EQ(exp(0), 1);
  EXPECT_EQ(exp(1000), kInfinity);
  EXPECT_EQ(exp(709.79), kInfinity);
  EXPECT_EQ(exp(-1000), 0);
  EXPECT_EQ(exp(-kInfinity), 0);
  EXPECT_GT(exp(-745), 0);
  EXPECT_EQ(expm1(0), 0);
  EXPECT_EQ(expm1(-1000), -1);
  EXPECT_EQ(expm1(kInfinity), kInfinity);
  EXPECT_EQ(log(1), 0);
  EXPECT_EQ(log(0), -kInfinity);
  EXPECT_EQ(log(kInfinity), kInfinity);
  EXPECT_TRUE(std::isnan(log(-1)));
  EXPECT_EQ(log1p(-1), -kInfinity);
  EXPECT_EQ(log1p(0), 0);
  EXPECT_NEAR(log(5e-324), -744.4400719213812, 1e-12);
}

/// FNV-1a over the bits of a value.
void hash_in(std::uint64_t& hash, double value) {
  hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3u;
}

/// The hash is the same for every compiler, CPU and C library. It changes only together with the
/// pixel version, which is raised by every change that alters pixels.
TEST(ElementaryBits, Y4_HaveTheRecordedHash) {
  test::Random random(19);
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const Case& c : cases()) {
    for (int i = 0; i < 20000; ++i) {
      // The inputs are made without the C library's exp and log, whose bits differ.
      const double u = random.uniform();
      const double x = c.logarithmic ? u * u * u * u * u * u * u * u : c.lo + (c.hi - c.lo) * u;
      hash_in(hash, c.function(x));
    }
  }
  for (int i = 0; i < 20000; ++i) {
    const double x = random.uniform();
    hash_in(hash, pow(x, random.uniform(-3, 3)));
  }
  EXPECT_EQ(hash, 11035229411989415933u);
  test::report_hard_case("Y4", "the hash of all results equals the recorded hash");
}

}  // namespace
}  // namespace bandsaw
