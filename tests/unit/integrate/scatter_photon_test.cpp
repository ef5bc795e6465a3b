// Photons that a caster (a surface that casts caustics) scatters must carry the same light as paths
// that the caster scatters. The tests integrate the scattered light over pairs of directions: one
// from which light comes, and one to which light goes. The integral over all pairs must be the same
// for photons and for paths, and so must the integrals over three parts of the pairs.

#include "renderlib/integrate/scatter_photon.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "renderlib/material/bsdf.h"
#include "renderlib/math/constants.h"
#include "renderlib/sampling/warp.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::SceneMaker;

/// Parts of the pairs of directions: all pairs, pairs whose light comes from +x, pairs whose light
/// goes to +x, and pairs of refractions to +x.
constexpr std::size_t kParts = 4;
using Parts = std::array<test::Moments, kParts>;

/// Adds a sample of the scattered light to every part: `amount` to the parts that contain the pair
/// of directions, and 0 to the other parts.
void add(const Vec3& in, const Vec3& out, double amount, Parts& parts) {
  const bool refracted = in.z * out.z < 0;
  const std::array<bool, kParts> counted = {true, in.x > 0, out.x > 0, refracted && out.x > 0};
  for (std::size_t i = 0; i < kParts; ++i) {
    parts[i].add(counted[i] ? amount : 0);
  }
}

/// Returns a direction on either side of z = 0, with the pdf |cos| / (2 pi).
Vec3 direction(test::Random& random) {
  const double u = random.uniform();  // the evaluation order of arguments is unspecified
  const double v = random.uniform();
  const Vec3 up = sample_cosine_hemisphere(u, v);
  return random.uniform() < 0.5 ? up : -up;
}

/// Compares photons and paths at a point whose shading normal is tilted by 30 degrees. Each of the
/// four comparisons fails by chance with a probability of 6e-5.
void expect_the_light_of_paths(const SceneMaker& maker, MaterialId material) {
  const auto scene = maker.build();
  SurfacePoint point;
  point.geometric_normal = {0, 0, 1};
  point.shading_normal = {0.5, 0, std::sqrt(0.75)};
  point.material = material;
  const Material& material_of_point = scene->material(material);
  test::Random random(17);
  Parts of_photons;
  Parts of_paths;
  for (int i = 0; i < 200'000; ++i) {
    const Vec3 in = direction(random);
    const Sample4 numbers{random.uniform(), random.uniform(), random.uniform(), random.uniform()};
    const auto photon = scatter_photon(*scene, point, in, numbers);
    add(in, photon ? photon->out : Vec3{}, photon ? 2 * kPi * photon->factor.g : 0, of_photons);
    const Vec3 out = direction(random);
    const Sample4 other{random.uniform(), random.uniform(), random.uniform()};
    const auto path = sample(bsdf_at(material_of_point, scene->textures(), point, out), other[0],
                             other[1], other[2]);
    add(path ? path->wi : Vec3{}, out, path ? 2 * kPi * path->weight.g : 0, of_paths);
  }
  for (std::size_t i = 0; i < kParts; ++i) {
    EXPECT_LE(std::abs(of_photons[i].mean() - of_paths[i].mean()),
              4 * std::hypot(of_photons[i].standard_error(), of_paths[i].standard_error()))
        << i << ": " << of_photons[i].mean() << " and " << of_paths[i].mean();
  }
  EXPECT_GT(of_paths[0].mean(), 1);
}

/// A maker with a floor, because a scene needs something that can be seen.
SceneMaker maker_with_floor() {
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.diffuse(0.5f));
  return maker;
}

TEST(ScatterPhoton, CarriesTheLightOfPathsAtATiltedMirror) {
  SceneMaker maker = maker_with_floor();
  const MaterialId mirror = maker.metal(0.8f, 0);
  expect_the_light_of_paths(maker, mirror);
}

TEST(ScatterPhoton, CarriesTheLightOfPathsAtTiltedGlass) {
  SceneMaker maker = maker_with_floor();
  const MaterialId glass = maker.glass(1.5);
  expect_the_light_of_paths(maker, glass);
}

TEST(ScatterPhoton, CarriesTheLightOfPathsAtTiltedRoughGlass) {
  SceneMaker maker = maker_with_floor();
  const MaterialId glass = maker.material(Dielectric{.index_of_refraction = 1.5, .roughness = 0.5});
  expect_the_light_of_paths(maker, glass);
}

TEST(ScatterPhoton, CarriesTheLightOfPathsAtATiltedGltfMetal) {
  SceneMaker maker = maker_with_floor();
  MetallicRoughness metal;
  metal.metallic.factor = 1;
  metal.roughness.factor = 0.5;
  const MaterialId id = maker.material(metal);
  expect_the_light_of_paths(maker, id);
}

TEST(ScatterPhoton, CarriesTheLightOfPathsAtTiltedFuzzyMetal) {
  SceneMaker maker = maker_with_floor();
  const MaterialId metal = maker.metal(0.8f, 0.3);
  expect_the_light_of_paths(maker, metal);
}

}  // namespace
}  // namespace bandsaw
