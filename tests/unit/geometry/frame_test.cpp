// Moving frames, which are coordinate systems that move between keys. A key is a transform at one
// time. It is decomposed into scale, rotation and translation, which are interpolated. A Frame has
// the members parent, placement (its transform in the parent, applied after the motion) and keys.
// An id such as X7 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/geometry/frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/geometry/placement.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Random;

/// Returns the largest difference of two entries of the matrices.
double difference(const Transform& a, const Transform& b) {
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      most = std::max(most, std::abs(a.m[i][k] - b.m[i][k]));
    }
  }
  return most;
}

TEST(Quaternions, RepresentTheirRotations) {
  Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    // A third of the rotations are half turns, for which the trace is smallest.
    const double degrees = i % 3 == 0 ? 180 : random.uniform(-360, 360);
    const Transform turn = rotation(test::random_direction(random), degrees);
    const Quaternion q = quaternion(turn);
    ASSERT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-15);
    ASSERT_LE(difference(rotation(q), turn), 3e-15);
  }
}

TEST(Quaternions, InterpolateEvenlyAlongTheShorterArc) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 axis = test::random_direction(random);
    // The rotation from `a` to `b`, in degrees.
    const double whole = i == 0 ? 1e-12 : random.uniform(-179, 179);
    const Transform start = rotation(test::random_direction(random), random.uniform(0, 360));
    const Quaternion a = quaternion(start);
    const Quaternion b = quaternion(rotation(axis, whole) * start);
    ASSERT_NEAR(turn_between(a, b) * 360, std::abs(whole), 1e-12);
    for (const double u : {0.0, 0.25, 0.6, 1.0}) {
      ASSERT_LE(difference(rotation(slerp(a, b, u)), rotation(axis, whole * u) * start), 4e-15);
    }
  }
}

// 360 rotations by one degree about the same axis are the identity.
TEST(Transforms, X7_ManySmallRotationsDoNotDrift) {
  Transform sum;
  for (int i = 0; i < 360; ++i) {
    sum = rotation({1, 2, -0.5}, 1) * sum;
  }
  test::at_most("X7", "largest error of a matrix entry", difference(sum, {}), 1e-13);
}

// Eight nested placements lead far away and back.
TEST(Transforms, X4_ChainsOfPlacementsKeepTheirPrecision) {
  Transform chain;
  for (int i = 0; i < 8; ++i) {
    const Vec3 away = {1e6, -1e6, 1e6};
    chain = translation(-away) * translation(away) * chain;
  }
  const Vec3 p = {0.3, 0.7, -0.2};
  test::at_most("X4", "error of the point divided by the largest coordinate",
                length(chain.point(p) - p) / 1e6, 1e-9);
}

TEST(Frames, DecomposeIntoScaleRotationAndTranslation) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const double mirror = i % 2 == 0 ? 1 : -1;
    const Transform turn = rotation(test::random_direction(random), random.uniform(0, 360));
    const Transform whole =
        translation(10 * test::random_point(random)) * turn *
        scaling({mirror * random.uniform(0.01, 100), random.uniform(0.01, 100), 1});
    const auto pose = decompose(whole);
    ASSERT_TRUE(pose);
    const Transform again =
        translation(pose->translate) * rotation(pose->rotate) * scaling(pose->scale);
    ASSERT_LE(difference(again, whole), 1e-13 * 100);  // the largest scale is 100
  }
  // A transform that shears, and a singular one, cannot be decomposed.
  EXPECT_FALSE(decompose(rotation({0, 0, 1}, 45) * scaling({1, 2, 1}) * rotation({0, 0, 1}, 30)));
  EXPECT_FALSE(decompose(scaling({1, 0, 1})));
}

TEST(Frames, InterpolateScaleAndTranslationLinearly) {
  const Frame frame = {
      kNoFrame,
      {},
      {Key(1, translation({1, 0, 0}) * rotation({0, 1, 0}, 20)),
       Key(3, translation({5, 2, 0}) * rotation({0, 1, 0}, 100) * scaling({3, 1, 2}))}};
  const Transform middle = translation({3, 1, 0}) * rotation({0, 1, 0}, 60) * scaling({2, 1, 1.5});
  EXPECT_LE(difference(motion_at(frame, 2), middle), 1e-14);
  EXPECT_EQ(motion_at(frame, 1), frame.keys[0].at);
  EXPECT_EQ(motion_at(frame, 3), frame.keys[1].at);
  EXPECT_EQ(motion_at(frame, -7), frame.keys[0].at);
  EXPECT_EQ(motion_at(frame, 8), frame.keys[1].at);
}

// The rotation between mirrored keys is interpolated as between keys that are not mirrored.
TEST(Frames, MirroredKeysRotateLikeOthers) {
  const Transform mirror = scaling({-1, 1, 1});
  const Frame frame = {kNoFrame, {}, {Key(0, mirror), Key(1, rotation({0, 1, 0}, 90) * mirror)}};
  EXPECT_LE(difference(motion_at(frame, 0.5), rotation({0, 1, 0}, 45) * mirror), 1e-15);
}

TEST(Frames, MoveWithinFramesThatMove) {
  const std::vector<Frame> frames = {
      {kNoFrame, translation({0, 1, 0}), {Key(0, {}), Key(1, rotation({0, 0, 1}, 90))}},
      {FrameId{0}, translation({2, 0, 0}), {Key(0, {}), Key(1, translation({1, 0, 0}))}}};
  // At half time, the inner frame has moved from 2 to 2.5 along the x axis of the outer frame. The
  // outer frame is rotated by 45 degrees and stands at (0, 1, 0).
  const double s = 2.5 * std::sqrt(0.5);
  EXPECT_LE(length(frame_at(frames, FrameId{1}, 0.5).point({}) - Vec3{s, 1 + s, 0}), 1e-15);
}

}  // namespace
}  // namespace bandsaw
