// Limits on the numbers of primitives and lights in a scene, and the errors of scenes beyond these
// limits. The limits are the largest numbers that the BVHs and the ids of lights can hold.

#include "renderlib/scene/check_counts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "renderlib/accel/capacity.h"
#include "renderlib/light/check_light_counts.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Expects an INVALID_ARGUMENT and returns its message.
std::string text_of(const absl::Status& status) {
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  return std::string(status.message());
}

TEST(Counts, MeshesBeyondALimitAreRefused) {
  EXPECT_TRUE(check_mesh_counts("mesh", kMaxTreeItems, kMaxMeshPositions).ok());
  EXPECT_EQ(text_of(check_mesh_counts("meshes[3]", kMaxTreeItems + 1, 3)),
            "meshes[3]: has 536870912 triangles, a mesh holds at most 536870911: split it into "
            "several meshes");
  EXPECT_EQ(text_of(check_mesh_counts("meshes[3]", 1, kMaxMeshPositions + 1)),
            "meshes[3]: has 4294967297 positions, a mesh holds at most 4294967296: split it into "
            "several meshes");
}

// Loose shapes are those that are not part of a mesh. A quad takes two items of the BVH. Every
// other shape, and every instance, takes one.
TEST(Counts, LooseShapesBeyondALimitAreRefused) {
  constexpr std::uint64_t kHalf = kMaxTreeItems / 2;
  EXPECT_TRUE(check_shape_counts("shapes", {.quads = kHalf, .disks = 1}).ok());
  EXPECT_TRUE(check_shape_counts("shapes", {.spheres = kHalf, .instances = kHalf + 1}).ok());
  for (const ShapeCounts& counts :
       {ShapeCounts{.quads = kHalf + 1}, ShapeCounts{.triangles = kMaxTreeItems + 1},
        ShapeCounts{.spheres = kHalf, .disks = kHalf + 2},
        ShapeCounts{.spheres = 1, .instances = kMaxTreeItems}}) {
    EXPECT_THAT(text_of(check_shape_counts("groups[2]", counts)),
                AllOf(StartsWith("groups[2]: has "), HasSubstr("at most 536870911")));
  }
}

/// Adds a mesh of 131,072 triangles, with so many instances that there are 2^31 triangles.
test::SceneMaker placed_many_times(MaterialId material, test::SceneMaker maker) {
  maker.instance(test::grid(256), {}, material);
  maker.scene.geometry.instances.resize(std::size_t{1} << 14, maker.scene.geometry.instances[0]);
  return maker;
}

TEST(Counts, LightsBeyondALimitAreRefusedBeforeTheyAreBuilt) {
  test::SceneMaker maker;
  const MaterialId lamp = maker.lamp(1);
  Pool pool(1);
  EXPECT_THAT(text_of(Scene::build(placed_many_times(lamp, maker).scene, pool).status()),
              AllOf(StartsWith("lights: "), HasSubstr("2147483648 primitives"),
                    HasSubstr("at most 2147483647")));
}

TEST(Counts, DarkInstancesAreNotCountedAsLights) {
  const auto check = [](const test::SceneMaker& maker) {
    const SceneDescription& s = maker.scene;
    return check_light_counts(s.geometry, s.materials, s.textures, 0);
  };
  test::SceneMaker maker;
  const MaterialId white = maker.diffuse(1);
  const MaterialId dark = maker.lamp(0);
  EXPECT_TRUE(check(placed_many_times(white, maker)).ok());
  EXPECT_TRUE(check(placed_many_times(dark, maker)).ok());
}

// If one sphere of a group emits light, all spheres of each instance of the group are counted. The
// last argument of check_light_counts() is the number of further lights.
TEST(Counts, LightsInGroupsBeyondALimitAreRefused) {
  test::SceneMaker maker;
  const MaterialId lamp = maker.lamp(1);
  Geometry& geometry = maker.scene.geometry;
  geometry.groups.resize(1);
  geometry.groups[0].spheres.resize(std::size_t{1} << 16, Sphere{{0, 0, 0}, 1, maker.diffuse(1)});
  geometry.groups[0].spheres.back().material = lamp;
  Instance placed;
  placed.group = GroupId{0};
  placed.material = kOwnMaterial;
  geometry.instances.resize(std::size_t{1} << 15, placed);
  const SceneDescription& s = maker.scene;
  EXPECT_THAT(text_of(check_light_counts(geometry, s.materials, s.textures, 0)),
              HasSubstr("2147483648 primitives"));
  // Without one instance there are 2^31 - 2^16 spheres, so at most 2^16 - 1 further lights fit.
  geometry.instances.pop_back();
  EXPECT_TRUE(check_light_counts(geometry, s.materials, s.textures, 0xffff).ok());
  EXPECT_FALSE(check_light_counts(geometry, s.materials, s.textures, 0x10000).ok());
}

}  // namespace
}  // namespace bandsaw
