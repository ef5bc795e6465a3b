// Affine transforms: composition, rotation, inverse, normals.

#include "renderlib/math/transform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/math/constants.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

/// Returns the largest difference between elements of the two matrices.
double difference(const Transform& a, const Transform& b) {
  double worst = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      worst = std::max(worst, std::abs(a.m[i][j] - b.m[i][j]));
    }
  }
  return worst;
}

TEST(Transform, ComposesFromRightToLeft) {
  const Transform t = translation({1, 2, 3}) * scaling({2, 2, 2});
  EXPECT_EQ(t.point({1, 0, 0}), (Vec3{3, 2, 3}));
  EXPECT_EQ(t.direction({1, 0, 0}), (Vec3{2, 0, 0}));
}

TEST(Transform, RotatesCounterClockwise) {
  EXPECT_EQ(rotation({0, 0, 1}, 90).point({1, 0, 0}), (Vec3{0, 1, 0}));
  EXPECT_EQ(rotation({0, 5e-300, 0}, 90).point({0, 0, 1}), (Vec3{1, 0, 0}));
  EXPECT_EQ(rotation({1, 0, 0}, 180).point({0, 1, 0}), (Vec3{0, -1, 0}));
}

TEST(Transform, ComesBackAfterAWholeTurnInDegrees) {
  Transform t;
  for (int i = 0; i < 360; ++i) {
    t = rotation({1, 2, 3}, 1) * t;
  }
  EXPECT_LE(difference(t, Transform{}), 1e-13);
}

TEST(Transform, KeepsPointsThroughFarTranslations) {
  Transform t;
  for (int i = 0; i < 8; ++i) {
    t = translation({1e6, -1e6, 3e5}) * t;
  }
  for (int i = 0; i < 8; ++i) {
    t = translation({-1e6, 1e6, -3e5}) * t;
  }
  EXPECT_LE(max_abs(t.point({0.1, 0.2, 0.3}) - Vec3{0.1, 0.2, 0.3}), 1e-9);
}

TEST(Transform, IsUndoneByItsInverse) {
  test::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Transform t =
        translation(100 * test::random_point(random)) *
        rotation(test::random_direction(random), random.uniform(0, 360)) *
        scaling({random.uniform(0.1, 3), -random.uniform(0.1, 3), random.uniform(1, 9)});
    const auto back = inverse(t);
    ASSERT_TRUE(back);
    EXPECT_LE(difference(*back * t, Transform{}), 1e-12);
    EXPECT_LT(determinant(t), 0);
  }
}

TEST(Transform, InvertsAtAnyScale) {
  for (const double scale : {1e-150, 1e-20, 1e20, 1e150}) {
    const auto back = inverse(scaling({scale, scale, -scale}));
    ASSERT_TRUE(back) << scale;
    EXPECT_NEAR(back->m[2][2] * -scale, 1, 1e-15);
  }
}

// A transform also counts as singular if an element is not finite, or if the condition number of
// its matrix is above 1e12.
TEST(Transform, HasNoInverseWhenSingular) {
  EXPECT_FALSE(inverse(scaling({1, 0, 1})));
  EXPECT_FALSE(inverse(scaling({1, 1e-13, 1})));
  EXPECT_TRUE(inverse(scaling({1, 1e-11, 1})));
  EXPECT_FALSE(inverse(scaling({1, NAN, 1})));
  EXPECT_FALSE(inverse(scaling({kInfinity, 1, 1})));
  EXPECT_FALSE(inverse(translation({0, NAN, 1})));
  Transform shear;
  shear.m[0][1] = 1e8;
  EXPECT_FALSE(inverse(shear));
  Transform flat;
  flat.m = {{{1, 2, 3, 0}, {2, 4, 6, 0}, {0, 0, 1, 0}}};
  EXPECT_FALSE(inverse(flat));
}

// The normals of an ellipsoid have the direction of the gradient of its implicit function.
TEST(Transform, CarriesNormalsByTheInverseTranspose) {
  test::Random random(2);
  const Transform turn = rotation({1, 2, 3}, 40);
  const Vec3 axes = {1, 1, 1e-3};
  const auto to_object = inverse(turn * scaling(axes));
  ASSERT_TRUE(to_object);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = test::random_direction(random);
    const Vec3 gradient = turn.direction(normalize({n.x / axes.x, n.y / axes.y, n.z / axes.z}));
    const Vec3 carried = normalize(normal_to_world(*to_object, n));
    EXPECT_LE(length(cross(carried, gradient)), 1e-10);
    EXPECT_GT(dot(carried, gradient), 0);
  }
}

}  // namespace
}  // namespace bandsaw
