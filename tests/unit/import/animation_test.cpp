// Curves and animations at given times, against their definitions.

#include "renderlib/import/animation/animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace bandsaw {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Returns a curve of single numbers. A cubic curve has three values for each key: the tangent
/// before the key, the value at the key, and the tangent after the key. The third argument of Curve
/// is how many numbers a value has: 1, 3 (a vector) or 4 (a quaternion).
Curve numbers(std::vector<double> times, std::vector<double> values, Interpolation interpolation) {
  return {std::move(times), std::move(values), 1, interpolation};
}

TEST(Curve, IsConstantBeforeTheFirstKeyAndAfterTheLast) {
  for (const Interpolation kind :
       {Interpolation::kLinear, Interpolation::kStep, Interpolation::kSmooth}) {
    const Curve curve = numbers({1, 3}, {10, 20}, kind);
    EXPECT_THAT(curve.at(-5), ElementsAre(10));
    EXPECT_THAT(curve.at(1), ElementsAre(10));
    EXPECT_THAT(curve.at(3), ElementsAre(20));
    EXPECT_THAT(curve.at(99), ElementsAre(20));
  }
}

TEST(Curve, LinearInterpolatesAndStepKeepsTheLastValue) {
  EXPECT_THAT(numbers({1, 3}, {10, 20}, Interpolation::kLinear).at(1.5), ElementsAre(12.5));
  EXPECT_THAT(numbers({1, 3}, {10, 20}, Interpolation::kStep).at(2.999), ElementsAre(10));
}

// x^3 has the tangents 0 at 0 and 12 at 2; Hermite splines reproduce every cubic polynomial.
TEST(Curve, CubicSplinesReproduceACubic) {
  const Curve curve = numbers({0, 2}, {0, 0, 0, 12, 8, 12}, Interpolation::kCubic);
  for (const double x : {0.0, 0.25, 1.0, 1.9, 2.0}) {
    EXPECT_NEAR(curve.at(x)[0], x * x * x, 1e-14) << x;
  }
}

// A smooth curve has the tangents of Catmull and Rom. For a parabola with evenly spaced keys, they
// are exact at all inner keys.
TEST(Curve, SmoothReproducesAParabolaBetweenInnerKeys) {
  const Curve curve = numbers({0, 1, 2, 3}, {0, 1, 4, 9}, Interpolation::kSmooth);
  for (const double x : {1.0, 1.3, 1.9, 2.0}) {
    EXPECT_NEAR(curve.at(x)[0], x * x, 1e-14) << x;
  }
}

TEST(Curve, RotationsTurnAtConstantSpeedAlongTheShortestArc) {
  // The sine and cosine of 45 degrees, half of a quarter turn.
  const double half = std::sqrt(0.5);
  // From no rotation to a quarter turn about y. The second quaternion is negated. A quaternion and
  // its negative are the same rotation.
  const Curve curve({0, 1}, {0, 0, 0, 1, 0, -half, 0, -half}, 4, Interpolation::kLinear);
  const Transform third = rotation(curve.rotation_at(1.0 / 3));
  const Transform expected = rotation({0, 1, 0}, 30);
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      EXPECT_NEAR(third.m[row][column], expected.m[row][column], 1e-12);
    }
  }
}

TEST(Curve, AZeroQuaternionIsNoRotation) {
  const Curve curve({0}, {0, 0, 0, 0}, 4, Interpolation::kLinear);
  EXPECT_EQ(curve.rotation_at(0), Quaternion{});
}

TEST(Curve, RestsWhereItsValueDoesNotChange) {
  const Curve curve = numbers({0, 1, 2, 3}, {5, 5, 6, 6}, Interpolation::kLinear);
  EXPECT_TRUE(curve.rests(-1, 0.9));
  EXPECT_TRUE(curve.rests(2, 9));
  EXPECT_FALSE(curve.rests(0.5, 1.5));
  EXPECT_TRUE(curve.rests(1.5, 1.5)) << "a curve must rest in an interval of length 0";
  EXPECT_FALSE(numbers({0, 1}, {0, 5, 1, 0, 5, 0}, Interpolation::kCubic).rests(0, 1))
      << "the keys are equal, but their tangents are not 0";
}

// The keys at 1 and 2 have the same value. Between them the curve is not constant, because the
// tangent at 2 depends on the key at 3.
TEST(Curve, ASmoothCurveMovesWhereATangentIsNotZero) {
  const Curve curve = numbers({0, 1, 2, 3, 4}, {5, 5, 5, 6, 6}, Interpolation::kSmooth);
  EXPECT_TRUE(curve.rests(-2, 0.9));
  EXPECT_THAT(curve.at(1.5), testing::Not(ElementsAre(5)));
  EXPECT_FALSE(curve.rests(1.1, 1.9));
  EXPECT_FALSE(curve.rests(3.1, 3.9));
  EXPECT_TRUE(curve.rests(4, 9));
}

// The translation has a curve, so its rest pose (1, 2, 3) is not used. The scale has no curve, so
// it stays 2.
TEST(NodeMotion, APropertyWithoutACurveKeepsItsRestPose) {
  NodeMotion motion;
  motion.translate = {1, 2, 3};
  motion.scale = {2, 2, 2};
  motion.translation = Curve({0, 1}, {0, 0, 0, 10, 0, 0}, 3, Interpolation::kLinear);
  EXPECT_EQ(motion.at(0.5).point({1, 1, 1}), (Vec3{7, 2, 2}));
  // The key at 1 is not inside the open interval (-1, 1).
  EXPECT_THAT(motion.times_between(-1, 1), ElementsAre(0));
  EXPECT_TRUE(motion.rests(1, 2));
}

TEST(AnimationChoice, FindsByNameOrTakesTheFirst) {
  const std::vector<std::string> names = {"walk", "jump"};
  EXPECT_EQ(*choose({}, names), std::nullopt);
  EXPECT_EQ(*choose({.name = "", .first = true}, names), 0u);
  EXPECT_EQ(*choose({.name = "", .first = true}, {}), std::nullopt);
  EXPECT_EQ(*choose({.name = "jump"}, names), 1u);
  EXPECT_THAT(std::string(choose({.name = "run"}, names).status().message()),
              HasSubstr("has no animation \"run\"; there are \"walk\", \"jump\""));
}

}  // namespace
}  // namespace bandsaw
