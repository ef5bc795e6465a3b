// The light tree, which selects one of many lights with a probability near its contribution. An id
// such as L7 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/light/light_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderlib/light/light_choice.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Random;

/// Returns a random point of the cube from -size to size.
Vec3 random_point(Random& random, double size) {
  const double x = random.uniform(-size, size);
  const double y = random.uniform(-size, size);
  return {x, y, random.uniform(-size, size)};
}

/// Spheres, one- and two-sided flat lights and spots, in clusters, with powers over twelve decades.
std::vector<LightBound> lights_of_all_kinds(std::size_t count) {
  Random random(1);
  std::vector<LightBound> lights;
  Vec3 cluster;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 100 == 0) {
      cluster = random_point(random, 30);
    }
    LightBound light;
    light.ball = {cluster + random_point(random, 1), random.uniform(0, 0.1)};
    light.intensity = std::pow(10, random.uniform(-6, 6));
    if (i % 3 != 0) {
      light.axis = normalize(random_point(random, 1));
      light.cos_spread = i % 3 == 1 ? 1 : random.uniform(0, 1);
      light.cos_reach = i % 3 == 1 ? 0 : 1 - 1e-12;
      light.two_sided = i % 2 == 0;
      light.flat = i % 3 == 1;
    }
    lights.push_back(light);
  }
  return lights;
}

/// Two points of surfaces with their normals, and a point in a medium, which has no normal.
std::vector<Receiver> receivers() {
  return {{{0, 0, 0}, Vec3{0, 1, 0}}, {{20, -5, 3}, Vec3{1, 0, 0}}, {{0, 40, 0}, std::nullopt}};
}

TEST(LightTree, L7_ProbabilitiesOfManyLightsSumToAtMostOneAndOfSpheresToOne) {
  const std::vector<LightBound> lights = lights_of_all_kinds(100000);
  const LightTree tree(lights);
  {
    const Receiver receiver = receivers().front();
    double sum = 0;
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      const double probability = tree.probability(receiver, i);
      ASSERT_TRUE(probability > 0 || importance(lights[i], receiver) == 0) << i;
      sum += probability;
    }
    // The sum may be below 1. If lights face in all directions, the bound of a node of the tree may
    // be above 0 although neither half of the node can contribute. At such a node, no light is
    // selected.
    EXPECT_LE(sum, 1 + 1e-12);
    EXPECT_GE(sum, 0.5);
  }
  const Receiver all_around{{0, 0, 0}, std::nullopt};
  std::vector<LightBound> spheres = lights;
  for (LightBound& light : spheres) {
    light.cos_spread = -1;
    light.flat = false;
  }
  const LightTree of_spheres(spheres);
  double sum = 0;
  for (std::uint32_t i = 0; i < spheres.size(); ++i) {
    sum += of_spheres.probability(all_around, i);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  test::report_hard_case("L7", "100,000 probabilities add up to 1");
}

TEST(LightTree, L7_SelectionFrequenciesEqualProbabilities) {
  const std::vector<LightBound> lights = lights_of_all_kinds(20000);
  const LightTree tree(lights);
  constexpr int kSamples = 100000;
  for (const Receiver& receiver : receivers()) {
    std::vector<double> expected(lights.size() + 1);
    std::vector<std::uint64_t> counts(lights.size() + 1);
    for (std::uint32_t i = 0; i < lights.size(); ++i) {
      expected[i] = kSamples * tree.probability(receiver, i);
    }
    const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
    expected.back() = std::max(0.0, kSamples - sum);
    Random random(2);
    for (int i = 0; i < kSamples; ++i) {
      const auto choice = tree.choose(receiver, random.uniform());
      ++counts[choice ? choice->light : lights.size()];
      if (choice) {
        ASSERT_EQ(choice->probability, tree.probability(receiver, choice->light));
      }
    }
    if (expected.back() < 1e-6) {
      EXPECT_EQ(counts.back(), 0u);
      expected.back() = 0;
    }
    EXPECT_GT(test::chi_squared(counts, expected).p_value, test::sidak(0.01, 3));
  }
  test::report_hard_case("L7", "chi-squared test passes");
}

TEST(LightTree, PrefersANearLightToEquallyBrightDistantOnes) {
  std::vector<LightBound> lights(1000);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    lights[i].ball = {{static_cast<double>(i), 1, 0}, 0.01};
    lights[i].intensity = 1;
  }
  const LightTree tree(lights);
  const Receiver receiver{{500, 0, 0}, Vec3{0, 1, 0}};
  // With the exact importance, light 500 would have the probability 1 / (sum over all integers k of
  // 1 / (k^2 + 1)^(3/2)), which is about 0.49. The tree's bounds are looser.
  EXPECT_GT(tree.probability(receiver, 500), 0.1);
  EXPECT_LT(tree.probability(receiver, 0), 1e-4);
}

TEST(LightTree, SelectsCoincidentLightsWithEqualProbability) {
  std::vector<LightBound> lights(50000);
  for (LightBound& light : lights) {
    light.ball = {{1, 2, 3}, 0.5};
    light.intensity = 2;
  }
  const LightTree tree(lights);
  EXPECT_NEAR(tree.probability({{0, 0, 0}, std::nullopt}, 777), 1.0 / 50000, 1e-6);
}

// The distance from the origin halves from light to light. A tree that halves the space at each
// level would have a level for each light.
TEST(LightTree, NestedLightsStayWithinTheMaximumDepth) {
  std::vector<LightBound> lights;
  for (int i = 0; i < 900; ++i) {
    LightBound light;
    light.ball = {{std::exp2(-i), 0, 0}, 0};
    light.intensity = 1;
    lights.push_back(light);
  }
  const LightTree tree(lights);
  double sum = 0;
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    sum += tree.probability({{0, 5, 0}, Vec3{0, -1, 0}}, i);
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

/// A light may be selected if and only if its ball overlaps the cone. The ball overlaps the cone if
/// the angle between the axis and the ball's centre (`off`) is below the sum of the cone's angle
/// (`angle`) and the angle at which the ball's radius is seen (`seen`). Cosines resolve angles of
/// 1.5e-8, so the test leaves out lights whose `off` is within 3e-8 of the sum.
TEST(LightChoice, AConeSelectsTheLightsThatOverlapIt) {
  Random random(4);
  int overlapping = 0;
  for (int i = 0; i < 20000; ++i) {
    const double angle = std::pow(10, random.uniform(-6, 0));
    const Cone cone{normalize(random_point(random, 1)), std::sin(angle), std::cos(angle)};
    const Receiver receiver{random_point(random, 5), std::nullopt, 0, &cone};
    const double off = std::min(random.uniform(0, 3) * angle, 3.0);
    const Vec3 aside = normalize(cross(cone.axis, random_point(random, 1)));
    const double distance = random.uniform(1, 9);
    const Vec3 towards = cone.axis * std::cos(off) + aside * std::sin(off);
    const double seen = angle * random.uniform(0, 1);
    const LightBound light{
        .ball = {receiver.position + towards * distance, distance * std::sin(seen)},
        .intensity = 1};
    if (std::abs(off - angle - seen) < 3e-8) {
      continue;
    }
    EXPECT_EQ(importance(light, receiver) > 0, off < angle + seen) << angle << " " << off;
    overlapping += off < angle + seen ? 1 : 0;
  }
  EXPECT_GT(overlapping, 5000);
  EXPECT_LT(overlapping, 15000);
}

TEST(LightChoice, DistantLightsCanBeChosenBesideThoseOfTheTree) {
  for (const std::size_t count : {3u, 300u}) {
    const std::vector<LightBound> local = lights_of_all_kinds(count);
    // The two distant lights have the powers 5 and 2 and the numbers `count` and `count` + 1.
    const LightChoice choice(local, {{5, Vec3{0, 1, 0}}, {2, std::nullopt}});
    const Receiver receiver{{0, 0, 0}, Vec3{0, 1, 0}};
    double sum = 0;
    for (std::size_t i = 0; i < count + 2; ++i) {
      sum += choice.probability(receiver, i);
    }
    EXPECT_LE(sum, 1 + 1e-12);
    EXPECT_GT(choice.probability(receiver, count), 0);
    EXPECT_NEAR(choice.probability(receiver, count) / choice.probability(receiver, count + 1), 2.5,
                1e-9);
    EXPECT_EQ(choice.probability({{0, 0, 0}, Vec3{0, -1, 0}}, count), 0)
        << "a light below the horizon must not be chosen";
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
      const auto chosen = choice.choose(receiver, random.uniform());
      if (chosen) {
        ASSERT_EQ(chosen->probability, choice.probability(receiver, chosen->light));
      }
    }
  }
  EXPECT_FALSE(LightChoice().choose(Receiver{{0, 0, 0}, std::nullopt}, 0.5));
}

}  // namespace
}  // namespace bandsaw
