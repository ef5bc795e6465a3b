// Tests spheres and boxes whose placement squashes or stretches space by many orders of magnitude.
// A ray that leaves the surface inwards hits the other side from inside. A ray that leaves outwards
// does not hit the surface again. So a ray enters and leaves in turn: its crossings alternate. An
// id such as S12 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/light/lights.h"
#include "renderlib/scene/media.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Random;

struct Case {
  std::string name;
  Transform to_world;
};

/// Returns placements that squash or stretch by 3 to 10 orders of magnitude. Some of them also
/// rotate, mirror and move.
std::vector<Case> cases() {
  const Transform turn = rotation({1, 2, 3}, 40);
  const Transform turn_and_move = translation({3, -2, 1}) * turn;
  std::vector<Case> all;
  for (const double by : {1e-3, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const std::string exponent = std::to_string(std::log10(by)).substr(0, 3);
    all.push_back({"squashed, 10^" + exponent, scaling({1, by, 1})});
    all.push_back({"squashed and turned, 10^" + exponent, turn_and_move * scaling({1, by, 1})});
    all.push_back(
        {"turned and squashed, 10^" + exponent, turn_and_move * scaling({1, by, -1}) * turn});
    all.push_back({"a needle, 10^" + exponent, turn_and_move * scaling({by, 1, by}) * turn});
    all.push_back({"small, 10^" + exponent, turn * scaling({1e-4, by * 1e-4, 2e-4})});
    all.push_back({"stretched, 1 / 10^" + exponent, turn * scaling({1, 1 / by, 1})});
  }
  return all;
}

/// Returns a geometry of one sphere of radius 1, or of one unit cube around 0, with the placement
/// `to_world`.
Geometry placed(const Transform& to_world, bool cube) {
  Geometry g;
  Instance instance;
  instance.to_world = to_world;
  if (cube) {
    g.meshes.push_back(unit_cube());
    instance.to_world = to_world * translation({-0.5, -0.5, -0.5});
  } else {
    g.groups.push_back(unit_ball());
    instance.group = GroupId{0};
    instance.material = kOwnMaterial;
  }
  g.instances.push_back(instance);
  return g;
}

/// Returns a random direction on the inner or outer side of the surface. The direction is uniform
/// in the world or in the object's own space. If the normal of `p` is zero, the direction may be
/// on any side.
Vec3 direction_from(const SurfacePoint& p, bool inwards, const Transform& to_world,
                    Random& random) {
  Vec3 d = test::random_direction(random);
  if (random.below(2) == 0) {
    d = normalize(to_world.direction(d));
  }
  return (dot(d, p.geometric_normal) < 0) == inwards ? d : -d;
}

struct Lost {
  int rays = 0;
  int inside = 0;   ///< rays that left inwards and did not hit the surface from inside
  int outside = 0;  ///< rays that left outwards and hit the surface again
};

/// Traces `rays` rays from outside. From each hit, the ray continues inwards, up to 20 times, and
/// one more ray leaves outwards.
Lost bounce(const Geometry& g, const Transform& to_world, int rays, std::uint64_t seed) {
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  Random random(seed);
  Lost lost;
  for (int i = 0; i < rays; ++i) {
    const Vec3 target = to_world.point(0.6 * test::random_point(random));
    const Vec3 origin = target + 5 * direction_from({}, /*inwards=*/false, to_world, random);
    Ray ray = {origin, normalize(target - origin)};
    Hit hit = accel.closest(ray);
    for (int k = 0; hit && k < 20; ++k) {
      const SurfacePoint p = surface_at(g, ray, hit);
      ++lost.rays;
      lost.outside +=
          accel.occluded(spawn_ray(p, direction_from(p, false, to_world, random))) ? 1 : 0;
      ray = spawn_ray(p, direction_from(p, /*inwards=*/true, to_world, random));
      hit = accel.closest(ray);
      const bool exits = hit && dot(surface_at(g, ray, hit).geometric_normal, ray.direction) > 0;
      lost.inside += exits ? 0 : 1;
    }
  }
  return lost;
}

TEST(Squashed, S12_CrossingsOfASphereAlternate) {
  constexpr int kRays = 2'000;
  Lost all;
  for (const Case& c : cases()) {
    const Lost lost = bounce(placed(c.to_world, /*cube=*/false), c.to_world, kRays, 1);
    EXPECT_GT(lost.rays, 10 * kRays) << c.name;
    EXPECT_EQ(lost.inside, 0) << c.name << ", of " << lost.rays << " rays";
    EXPECT_EQ(lost.outside, 0) << c.name << ", of " << lost.rays << " rays";
    all.rays += lost.rays;
    all.inside += lost.inside;
    all.outside += lost.outside;
  }
  const std::string count = std::to_string(all.rays);
  test::at_most("S12", "rays that start inside and find no exit, of " + count, all.inside, 0);
  test::at_most("S12", "rays that leave the ball and hit it again, of " + count, all.outside, 0);
}

/// Checks the length of the chord that a ray has in a sphere. In the sphere's own space, the ray
/// p + t d with |p| = 1 leaves the sphere at t = -2 (p.d) / (d.d).
TEST(Squashed, S12_ChordsAreCloseToTheirExactLength) {
  test::Worst error;
  for (const Case& c : cases()) {
    const Geometry g = placed(c.to_world, /*cube=*/false);
    const Transform to_object = *inverse(c.to_world);
    Pool pool(1);
    const Accel accel = Accel::build(g, pool);
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 origin = c.to_world.point(3 * test::random_direction(random));
      const Vec3 target = c.to_world.point(0.6 * test::random_point(random));
      const Ray in = {origin, target - origin};
      const SurfacePoint p = surface_at(g, in, accel.closest(in));
      const Ray ray = spawn_ray(p, direction_from(p, /*inwards=*/true, c.to_world, random));
      const Vec3 d = to_object.direction(ray.direction);
      const double along = -dot(p.object_position, d) / length(d);
      // The offset of the ray's origin shortens a grazing chord by more than the offset itself, so
      // grazing chords are not checked.
      if (along > 0.1) {
        error.see(std::abs(accel.closest(ray).t * length(d) - 2 * along));
      }
    }
  }
  test::at_most("S12", "error of the chord length in radii, for chords steeper than 6 degrees",
                error.value(), 0.05);
}

TEST(Squashed, CrossingsOfACubeAlternate) {
  for (const Case& c : cases()) {
    const Lost lost = bounce(placed(c.to_world, /*cube=*/true), c.to_world, 2'000, 3);
    EXPECT_GT(lost.rays, 20'000) << c.name;
    EXPECT_EQ(lost.inside, 0) << c.name << ", of " << lost.rays << " rays";
    EXPECT_EQ(lost.outside, 0) << c.name << ", of " << lost.rays << " rays";
  }
}

// A point inside an area light sees all of the light.
TEST(Squashed, S12_ALightAroundTheReceiverDoesNotShadowItself) {
  int rays = 0;
  int shadows = 0;
  for (const Case& c : cases()) {
    Geometry lamp = placed(c.to_world, /*cube=*/false);
    lamp.instances[0].material = MaterialId{0};
    const std::vector<Texture> textures = {ConstantTexture{gray(1)}};
    const std::vector<Material> materials = {Emissive{.radiance = TextureId{0}}};
    const Lights lights(lamp, materials, textures, {}, {});
    Pool pool(1);
    const Accel accel = Accel::build(lamp, pool);
    Random random(4);
    int occluded = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 from = c.to_world.point(0.5 * test::random_point(random));
      const double u = random.uniform();
      const auto light = lights.sample({from, std::nullopt}, 0.5, u, random.uniform());
      rays += light ? 1 : 0;
      occluded += light && accel.occluded({from, light->target - from, 1}) ? 1 : 0;
    }
    EXPECT_EQ(occluded, 0) << c.name;
    shadows += occluded;
  }
  EXPECT_GT(rays, 10'000);
  test::at_most("S12",
                "shadow rays from inside a lamp that the lamp occludes, of " + std::to_string(rays),
                shadows, 0);
}

}  // namespace
}  // namespace bandsaw
