// Compares the light in closed rooms with form factors, with the balance of energy, and with a
// radiosity solution. In rooms of plane walls the measured values are means over whole surfaces.
// All measured values may differ by at most 4 standard errors.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "renderlib/math/constants.h"
#include "tests/statistical/estimate.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// A parallelogram whose front (u x v) faces the inside of the room.
struct Wall {
  Vec3 corner;
  Vec3 u;
  Vec3 v;

  Vec3 normal() const { return normalize(cross(u, v)); }
  double area() const { return length(cross(u, v)); }
};

/// Returns the walls of [0, x] x [0, y] x [0, z], facing inwards: floor, ceiling, left, right,
/// back, front.
std::array<Wall, 6> room(double x, double y, double z) {
  return {Wall{{0, 0, 0}, {0, 0, z}, {x, 0, 0}}, Wall{{0, y, 0}, {x, 0, 0}, {0, 0, z}},
          Wall{{0, 0, 0}, {0, y, 0}, {0, 0, z}}, Wall{{x, 0, 0}, {0, 0, z}, {0, y, 0}},
          Wall{{0, 0, 0}, {x, 0, 0}, {0, y, 0}}, Wall{{0, 0, z}, {0, y, 0}, {x, 0, 0}}};
}

void add(SceneMaker& maker, const Wall& wall, MaterialId material) {
  maker.quad(wall.corner, wall.u, wall.v, material);
}

/// Returns the radiance that the wall sends along its normal, averaged over the points of the wall.
/// The moments are over 32 seeds.
Moments mean_radiance(const Scene& scene, const Wall& wall, const PathOptions& options,
                      std::uint64_t samples) {
  Moments means;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const PixelSampler sampler(seed, 3, 5);
    double sum = 0;
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      const Sample4 at = sampler.group(sample, kGroupCamera);
      const Vec3 point = wall.corner + wall.u * at[0] + wall.v * at[1];
      const Ray ray{.origin = point + wall.normal() * 1e-6, .direction = -wall.normal()};
      sum += path_radiance(scene, ray, sampler, sample, options, counts).g;
    }
    means.add(sum / static_cast<double>(samples));
  }
  return means;
}

/// Expects the value within 4 standard errors. `slack`: relative error that is accepted in
/// addition.
void expect_mean(const Moments& seen, double expected, double slack = 2e-6) {
  EXPECT_NEAR(seen.mean(), expected, 4 * seen.standard_error() + slack * expected);
  EXPECT_LE(seen.standard_error(), 1e-3 * expected);
}

/// The ceiling emits the radiance 1. So the radiance of a white wall is the form factor between
/// this wall and the ceiling. In a cube the form factor is 0.1998 for opposite faces and 0.2000 for
/// adjacent faces.
TEST(Enclosure, OfACubeHasItsFormFactors) {
  const std::array<Wall, 6> walls = room(1, 1, 1);
  for (const auto& [receiver, factor] :
       {std::pair(0, 0.199824895698387), std::pair(2, 0.200043776075403),
        std::pair(5, 0.200043776075403)}) {
    SceneMaker maker;
    add(maker, walls[1], maker.lamp(1));
    add(maker, walls[static_cast<std::size_t>(receiver)], maker.diffuse(1));
    expect_mean(mean_radiance(*maker.build(), walls[static_cast<std::size_t>(receiver)],
                              {.max_depth = 1}, 8192),
                factor);
  }
}

/// A light of intensity I is in the middle of a sphere of radius R. The direct irradiance of the
/// wall is I / R^2, and interreflection multiplies it by 1 / (1 - rho). The radiance of the wall is
/// its irradiance times rho / pi. With I = 4 pi, R = 2 and rho = 0.5 this radiance is 1.
TEST(Enclosure, OfASphereAroundAPointLightHasTheClosedForm) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 2, maker.diffuse(0.5f));
  maker.scene.lights = {PointLight{{0, 0, 0}, gray(4 * static_cast<float>(kPi))}};
  const Ray ray{.origin = {0.1, 0.2, 0.3}, .direction = {0.6, 0, 0.8}};
  const Moments seen = test::radiance_along(*maker.build(), ray, {.max_depth = 1000}, 2048);
  EXPECT_NEAR(seen.mean(), 1, 4 * seen.standard_error() + 2e-6);
  EXPECT_LE(seen.standard_error(), 1e-3);
}

/// Expects that all surfaces together absorb the light's flux. The surfaces are the walls of a room
/// and the sides of a block that floats in the room. The absorbed flux is the sum of (1 - rho) E A
/// over all surfaces. `albedos`: the albedos of the six walls, and then the albedo of the block.
void expect_balance(const std::array<float, 7>& albedos, std::uint64_t samples) {
  SceneMaker maker;
  std::vector<std::pair<Wall, float>> surfaces;
  const std::array<Wall, 6> walls = room(2, 1.5, 3);
  for (std::size_t i = 0; i < 6; ++i) {
    surfaces.emplace_back(walls[i], albedos[i]);
  }
  for (Wall side : room(0.5, 0.6, 0.7)) {
    side.corner = side.corner + Vec3{0.3, 0.2, 0.4};
    std::swap(side.u, side.v);  // faces outwards
    surfaces.emplace_back(side, albedos[6]);
  }
  for (const auto& [wall, albedo] : surfaces) {
    add(maker, wall, maker.diffuse(albedo));
  }
  const float intensity = 3;
  maker.scene.lights = {PointLight{{1.4, 0.9, 1.7}, gray(intensity)}};
  const auto scene = maker.build();
  double sum = 0;
  double variance = 0;
  for (const auto& [wall, albedo] : surfaces) {
    const Moments seen = mean_radiance(*scene, wall, {.max_depth = 1000}, samples);
    const double scale = (1 - double{albedo}) * kPi / double{albedo} * wall.area();
    sum += scale * seen.mean();
    variance += std::pow(scale * seen.standard_error(), 2);
  }
  const double flux = 4 * kPi * double{intensity};
  EXPECT_NEAR(sum, flux, 4 * std::sqrt(variance) + 2e-6 * flux);
  EXPECT_LE(std::sqrt(variance), 1e-3 * flux);
}

TEST(Enclosure, OfOneAlbedoAbsorbsTheFluxOfTheLight) {
  const float rho = 0.6f;
  expect_balance({rho, rho, rho, rho, rho, rho, rho}, 2048);
}

TEST(Enclosure, OfManyAlbedosAbsorbsTheFluxOfTheLight) {
  expect_balance({0.8f, 0.7f, 0.4f, 0.5f, 0.75f, 0.45f, 0.6f}, 4096);
}

/// Returns E / L at a point with a normal, for a lamp that is a parallelogram in front of the
/// point, by Lambert's formula.
double irradiance_of(const Wall& lamp, const Vec3& point, const Vec3& normal) {
  const std::array<Vec3, 4> corners = {lamp.corner, lamp.corner + lamp.u,
                                       lamp.corner + lamp.u + lamp.v, lamp.corner + lamp.v};
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = corners[i] - point;
    const Vec3 b = corners[(i + 1) % 4] - point;
    const Vec3 across = cross(a, b);
    const double size = length(across);
    sum += size > 0 ? std::atan2(size, dot(a, b)) * dot(across, normal) / size : 0;
  }
  return std::abs(sum) / 2;
}

/// Solves radiosity with finite elements: each wall has n x n patches, and the form factor from the
/// middle of one patch to another patch is in closed form. The ceiling emits the radiance 1.
/// Returns the mean radiance of each wall.
std::array<double, 6> radiosity(const std::array<Wall, 6>& walls,
                                const std::array<float, 6>& albedos, int n) {
  std::vector<Wall> patches;
  for (const Wall& wall : walls) {
    for (int i = 0; i < n * n; ++i) {
      const Vec3 u = wall.u / n;
      const Vec3 v = wall.v / n;
      patches.push_back({wall.corner + u * (i % n) + v * (i / n), u, v});
    }
  }
  const auto wall_of = [&](std::size_t patch) { return patch / static_cast<std::size_t>(n * n); };
  const std::size_t size = patches.size();
  std::vector<double> factors(size * size, 0);
  for (std::size_t i = 0; i < size; ++i) {
    const Vec3 middle = patches[i].corner + (patches[i].u + patches[i].v) / 2;
    for (std::size_t j = 0; j < size; ++j) {
      if (wall_of(i) != wall_of(j)) {
        factors[i * size + j] = irradiance_of(patches[j], middle, patches[i].normal()) / kPi;
      }
    }
  }
  std::vector<double> sent(size, 0);
  // No albedo is above 0.8. So each round multiplies the error by at most 0.8, and 0.8^60 is about
  // 1e-6.
  constexpr int kRounds = 60;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < size; ++i) {
      double arrives = 0;
      for (std::size_t j = 0; j < size; ++j) {
        arrives += factors[i * size + j] * sent[j];
      }
      sent[i] = wall_of(i) == 1 ? 1 : double{albedos[wall_of(i)]} * arrives;
    }
  }
  std::array<double, 6> means{};
  for (std::size_t i = 0; i < size; ++i) {
    means[wall_of(i)] += sent[i] / (n * n);
  }
  return means;
}

TEST(Enclosure, WallsHaveTheRadiositySolution) {
  const std::array<Wall, 6> walls = room(1, 1, 1);
  const std::array<float, 6> albedos = {0.8f, 0, 0.35f, 0.7f, 0.5f, 0.6f};
  const std::array<double, 6> coarse = radiosity(walls, albedos, 8);
  const std::array<double, 6> fine = radiosity(walls, albedos, 16);
  SceneMaker maker;
  for (std::size_t i = 0; i < 6; ++i) {
    add(maker, walls[i], i == 1 ? maker.lamp(1) : maker.diffuse(albedos[i]));
  }
  const auto scene = maker.build();
  for (const std::size_t i : {0, 2, 3, 4, 5}) {
    // The error of the solution is proportional to the square of the patches' size. So the limit
    // for infinitely small patches is extrapolated from two solutions.
    const double expected = (4 * fine[i] - coarse[i]) / 3;
    EXPECT_NEAR(expected, fine[i], 1e-3 * expected) << i;
    expect_mean(mean_radiance(*scene, walls[i], {.max_depth = 1000}, 8192), expected, 5e-4);
  }
}

}  // namespace
}  // namespace bandsaw
