// Disks, groups, instances, motion and cameras of models in scene files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "renderlib/geometry/placement.h"
#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

const std::string kHead =
    R"(camera { position: [0, 1, 5] look_at: [0, 0, 0] shutter_open: 1 shutter_close: 3 }
material { name: "white" diffuse { } }
material { name: "red" diffuse { } }
group { name: "pair"
  shape { sphere { radius: 2 } material: "white" }
  shape { disk { normal: [0, 3, 0] radius: 1 } material: "red" } }
)";

/// Imports a scene file of kHead and `text`.
absl::StatusOr<ImportedScene> import_text(const std::string& text) {
  const TempDir folder;
  return import_scene(write_text(folder, "s.textproto", kHead + text));
}

/// Returns the message of the error of import_text().
std::string message(const std::string& text) {
  return std::string(import_text(text).status().message());
}

TEST(Placement, GroupsAreShownOnlyWhereTheyArePlaced) {
  const auto none = import_text("");
  ASSERT_TRUE(none.ok()) << none.status();
  EXPECT_EQ(none->scene.geometry.size(), 0u);
  EXPECT_TRUE(none->scene.geometry.instances.empty());

  const auto two = import_text(R"(
instance { of: "pair" translate: [1, 2, 3] scale: 2 }
instance { of: "pair" material: "red" rotate { axis: [0, 1, 0] degrees: 90 } })");
  ASSERT_TRUE(two.ok()) << two.status();
  const Geometry& g = two->scene.geometry;
  ASSERT_EQ(g.instances.size(), 2u);
  ASSERT_EQ(g.groups.size(), 1u) << "the instances must share one group";
  EXPECT_EQ(g.groups[0].disks[0].normal, (Vec3{0, 1, 0}));
  EXPECT_EQ(g.instances[0].to_world, translation({1, 2, 3}) * scaling({2, 2, 2}));
  EXPECT_EQ(material_of(g, g.instances[0], 0), MaterialId{0});
  EXPECT_EQ(material_of(g, g.instances[0], 1), MaterialId{1});
  EXPECT_EQ(material_of(g, g.instances[1], 0), MaterialId{1});
}

TEST(Placement, NestedGroupsMultiplyTheirCopies) {
  const auto nested = import_text(R"(
group { name: "row" instance { of: "pair" translate: [1, 0, 0] at { } at { translate: [5, 0, 0] } } }
group { name: "field" instance { of: "row" scale: [1, 1, -1] } instance { of: "row" } }
instance { of: "field" translate: [0, 0, 7] })");
  ASSERT_TRUE(nested.ok()) << nested.status();
  const Geometry& g = nested->scene.geometry;
  ASSERT_EQ(g.instances.size(), 4u);
  EXPECT_EQ(g.groups.size(), 1u);
  EXPECT_EQ(g.instances[1].to_world.point({0, 0, 1}), (Vec3{6, 0, 6}));
  EXPECT_EQ(g.instances[3].to_world.point({0, 0, 1}), (Vec3{6, 0, 8}));
}

TEST(Placement, GridsMakeCopiesThatAreTheSameForTheSameSeed) {
  const auto grid = [](const std::string& more) {
    auto imported = import_text(
        "instance { of: \"pair\" grid { count: [4, 1, 3] step: [10, 0, 20] origin: [1, 2, 3] " +
        more + "} }");
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported->scene.geometry.instances;
  };
  const auto plain = grid("");
  ASSERT_EQ(plain.size(), 12u);
  // A row along x has four copies, so copy 6 is the third copy of the second row.
  EXPECT_EQ(plain[6].to_world, translation({21, 2, 23}));
  const std::string rough = "jitter: [1, 0, 1] turn: 360 scale: [0.5, 2] ";
  const auto random = grid(rough + "seed: 4");
  const auto same = grid(rough + "seed: 4");
  const auto other = grid(rough + "seed: 5");
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(random[i].to_world, same[i].to_world);
    EXPECT_NE(random[i].to_world, other[i].to_world);
    const Vec3 moved = random[i].to_world.point({}) - plain[i].to_world.point({});
    EXPECT_LE(max_abs(moved), 1);
    EXPECT_EQ(moved.y, 0);
    const double size = length(random[i].to_world.direction({1, 0, 0}));
    EXPECT_TRUE(size >= 0.5 && size <= 2);
  }
}

TEST(Placement, ShapesMoveByTheirVelocity) {
  const auto imported = import_text(R"(
shape { sphere { center: [1, 0, 0] radius: 1 } material: "red" velocity: [0, 2, 0] }
shape { box { min: [0, 0, 0] max: [1, 1, 1] } material: "white" velocity: [1, 0, 0] })");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Geometry& g = imported->scene.geometry;
  EXPECT_EQ(shutter_of(imported->scene.camera), (Shutter{1, 3}));
  EXPECT_EQ(g.size(), 0u);
  ASSERT_EQ(g.instances.size(), 2u);
  EXPECT_EQ(group_of(g, g.instances[1])->quads.size(), 6u);
  EXPECT_EQ(to_world_at(g, g.instances[0], 1), translation({0, 2, 0}));
  EXPECT_EQ(to_world_at(g, g.instances[0], 2.5), translation({0, 5, 0}));
}

// With a shutter of zero duration nothing moves. So a shape with a velocity becomes a shape without
// motion, at the place where the shape is when the shutter opens. C8 and X3 are ids of hard cases
// in tests/hard_cases/cases.txt.
TEST(Placement, C8_WithAShutterOfZeroDurationNothingMoves) {
  const TempDir folder;
  const auto imported = import_scene(write_text(folder, "s.textproto", R"(
camera { position: [0, 1, 5] look_at: [0, 0, 0] shutter_open: 2 shutter_close: 2 }
material { name: "red" diffuse { } }
shape { sphere { center: [1, 0, 0] radius: 1 } material: "red" velocity: [0, 2, 0] }
)"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  ASSERT_EQ(imported->scene.geometry.spheres.size(), 1u);
  EXPECT_EQ(imported->scene.geometry.spheres[0].center, (Vec3{1, 4, 0}));
  EXPECT_TRUE(imported->scene.geometry.frames.empty());
}

TEST(Placement, KeysMoveInstancesAndTheirContents) {
  const auto imported = import_text(R"(
group { name: "arm" instance { of: "pair"
  key { time: 1 translate: [1, 0, 0] } key { time: 3 translate: [3, 0, 0] } } }
instance { of: "arm"
  key { time: 1 } key { time: 3 rotate { axis: [0, 0, 1] degrees: 180 } }
  at { translate: [0, 0, 9] } })");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Geometry& g = imported->scene.geometry;
  ASSERT_EQ(g.instances.size(), 1u);
  const Vec3 start = to_world_at(g, g.instances[0], 1).point({});
  const Vec3 middle = to_world_at(g, g.instances[0], 2).point({});
  EXPECT_EQ(start, (Vec3{1, 0, 9}));
  // At the time 2, the pair is at x = 2 in the arm, and the arm is turned by 90 degrees about z.
  EXPECT_LE(length(middle - Vec3{0, 2, 9}), 1e-15);
}

// Two keys that differ by more than half a turn about one axis are interpolated over the whole
// rotation.
TEST(Placement, RotationsAboutOneAxisAreNotShortened) {
  const auto imported = import_text(R"(
instance { of: "pair" key { time: 0 } key { time: 4 rotate { axis: [0, 2, 0] degrees: 720 } } })");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Geometry& g = imported->scene.geometry;
  const auto spun = import_text(R"(
instance { of: "pair" key { time: 0 rotate { axis: [0, 2, 0] degrees: 0 } }
                      key { time: 4 rotate { axis: [0, 2, 0] degrees: 720 } } })");
  ASSERT_TRUE(spun.ok()) << spun.status();
  const Geometry& s = spun->scene.geometry;
  EXPECT_EQ(to_world_at(s, s.instances[0], 1.1), to_world_at(g, g.instances[0], 1.1));
  const Transform eighth = to_world_at(s, s.instances[0], 0.25);
  EXPECT_LE(length(eighth.direction({1, 0, 0}) - rotation({0, 1, 0}, 45).direction({1, 0, 0})),
            1e-15);
}

TEST(Placement, ErrorsNameThePlaceAndTheRemedy) {
  EXPECT_THAT(message("instance { of: \"pairs\" }"),
              HasSubstr("instance[0].of: no group is called \"pairs\"; did you mean \"pair\"?"));
  EXPECT_THAT(message("instance { }"), HasSubstr("instance[0].of: is required"));
  EXPECT_THAT(message("group { name: \"pair\" shape { sphere { radius: 1 } material: \"red\" } }"),
              HasSubstr("group[1].name: \"pair\" is taken by an earlier group"));
  EXPECT_THAT(message("group { name: \"self\" instance { of: \"self\" } }"),
              HasSubstr("no group is called \"self\""));
  EXPECT_THAT(message("group { name: \"none\" }"), HasSubstr("group[1]: is empty"));
  EXPECT_THAT(message("group { shape { sphere { radius: 1 } material: \"red\" } }"),
              HasSubstr("group[1].name: is required"));
  EXPECT_THAT(message("instance { of: \"pair\" scale: [1, 0, 1] }"),
              HasSubstr("instance[0].scale[1]: must be finite and not zero"));
  // X3: placements without an inverse are refused.
  EXPECT_THAT(message("instance { of: \"pair\" scale: [1, 1e-20, 1] }"),
              HasSubstr("instance[0].scale: flattens"));
  EXPECT_THAT(
      message("instance { of: \"pair\" key { time: 1 } key { time: 1 } }"),
      HasSubstr("instance[0].key[1].time: must be after 1, the time of the key before; it is 1"));
  EXPECT_THAT(message("instance { of: \"pair\" key { time: 1 } key { time: 2 scale: -1 } }"),
              HasSubstr("instance[0].key[1].scale: must keep its signs"));
  EXPECT_THAT(message("instance { of: \"pair\" scale: 2 key { time: 1 } }"),
              HasSubstr("instance[0].key[0]: write key, or translate, scale and rotate, not both"));
  EXPECT_THAT(message("instance { of: \"pair\" at { } grid { count: [1, 1, 1] step: [1, 1, 1] } }"),
              HasSubstr("instance[0].grid: write grid or at, not both"));
  EXPECT_THAT(message("instance { of: \"pair\" grid { count: [1000, 1000, 1] step: [1, 1, 1] } }"),
              HasSubstr("grid.count: makes more than 500000 copies"));
  EXPECT_THAT(message("instance { of: \"pair\" grid { count: [1, 0, 1] step: [1, 1, 1] } }"),
              HasSubstr("grid.count: must be at least 1"));
  EXPECT_THAT(message("shape { disk { normal: [0, 1, 0] } material: \"red\" }"),
              HasSubstr("shape[0].disk.radius: is required"));
  EXPECT_THAT(message("shape { disk { normal: [0, 0, 0] radius: 1 } material: \"red\" }"),
              HasSubstr("shape[0].disk.normal"));
}

TEST(Placement, C8_AShutterThatClosesBeforeItOpensIsRefused) {
  const TempDir folder;
  const auto imported = import_scene(write_text(
      folder, "s.textproto",
      "camera { position: [0, 1, 5] look_at: [0, 0, 0] shutter_open: 2 shutter_close: 1 }"));
  EXPECT_THAT(
      std::string(imported.status().message()),
      HasSubstr("camera.shutter_close: must not be before 2, the value of shutter_open; it is 1"));
}

/// A glTF file with a triangle and two cameras. "front" has a vertical field of view of 45 degrees
/// and an aspect ratio of 2. "plan" is orthographic.
const char kCameras[] = R"({
"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
"nodes": [{"mesh": 0},
  {"name": "front", "camera": 0, "translation": [0, 0, 3]},
  {"name": "plan", "camera": 1, "translation": [0, 5, 0], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]}],
"cameras": [
  {"type": "perspective", "perspective": {"aspectRatio": 2, "yfov": 0.7853981633974483, "znear": 0.1}},
  {"type": "orthographic", "orthographic": {"xmag": 6, "ymag": 2, "znear": 0.1, "zfar": 10}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
})";

TEST(ModelCamera, IsUsedByItsName) {
  const TempDir folder;
  write_text(folder, "m.gltf", kCameras);
  const auto scene = [&](const std::string& text) {
    return import_scene(write_text(folder, "s.textproto", text));
  };
  const auto front = scene(
      "camera { use: \"front\" shutter_close: 1 } model { file: \"m.gltf\" translate: [0, 0, 1] }");
  ASSERT_TRUE(front.ok()) << front.status();
  const auto& perspective = std::get<PerspectiveCamera>(front->scene.camera);
  EXPECT_NEAR(perspective.vertical_fov, 45, 1e-4)
      << "the angle is yfov, whatever the aspect ratio is";
  EXPECT_EQ(perspective.position, (Vec3{0, 0, 4}));
  EXPECT_EQ(perspective.shutter, (Shutter{0, 1}));

  const auto plan = scene("camera { use: \"plan\" } model { file: \"m.gltf\" scale: 3 }");
  ASSERT_TRUE(plan.ok()) << plan.status();
  const auto& flat = std::get<OrthographicCamera>(plan->scene.camera);
  EXPECT_NEAR(flat.height, 12, 1e-5) << "the height is 2 ymag times the scale 3";
  EXPECT_LE(length(normalize(flat.look_at - flat.position) - Vec3{0, -1, 0}), 1e-6);

  const auto alone = import_scene(folder / "m.gltf");
  ASSERT_TRUE(alone.ok()) << alone.status();
  EXPECT_TRUE(std::holds_alternative<PerspectiveCamera>(alone->scene.camera))
      << "the first camera must be used";
}

// Each number is in range, but a worker would refuse their product.
TEST(Placement, ProductsThatAWorkerWouldRefuseAreRefused) {
  const TempDir folder;
  const auto made = import_scene(write_text(folder, "s.textproto", R"(
camera { position: [0, 0, 5] look_at: [0, 0, 0] }
material { name: "m" diffuse { } }
group { name: "g" shape { material: "m" sphere { center: [1, 0, 0] radius: 1 } } }
group { name: "h" instance { of: "g" scale: 1e20 } }
instance { of: "h" scale: 1e20 }
)"));
  EXPECT_EQ(made.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(made.status().message()), HasSubstr("s.textproto: instances[0]"));
}

TEST(ModelCamera, ErrorsListTheExistingCameras) {
  const TempDir folder;
  write_text(folder, "m.gltf", kCameras);
  const auto message = [&](const std::string& text) {
    return std::string(import_scene(write_text(folder, "s.textproto", text)).status().message());
  };
  EXPECT_THAT(message("camera { use: \"back\" } model { file: \"m.gltf\" }"),
              HasSubstr("camera.use: no model has a camera called \"back\"; there are \"front\", "
                        "\"plan\""));
  EXPECT_THAT(message("camera { use: \"back\" }"), HasSubstr("the scene's models have no camera"));
  EXPECT_THAT(message("camera { use: \"front\" vertical_fov: 3 } model { file: \"m.gltf\" }"),
              HasSubstr("camera.use: write use, or position,"));
  EXPECT_THAT(message("camera { use: \"plan\" aperture: 3 } model { file: \"m.gltf\" }"),
              HasSubstr("camera.aperture: is of a perspective camera"));
}

}  // namespace
}  // namespace bandsaw
