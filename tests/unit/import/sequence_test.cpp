// Frames of scenes that move: tracks of scene files, animations of glTF, cameras and shutters. A
// track gives a field of the scene file a value for each time.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "renderlib/geometry/placement.h"
#include "renderlib/import/import.h"
#include "tests/unit/import/gltf_writer.h"

namespace bandsaw {
namespace {

using test::GltfWriter;
using test::Json;
using test::TempDir;
using test::write_text;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Chooses a frame by its number. `shutter` is the share of a frame's time in which the shutter is
/// open. If `fps` or `shutter` is std::nullopt, the value of the scene is used.
ImportChoices frame(double number, std::optional<double> fps = std::nullopt,
                    std::optional<double> shutter = std::nullopt) {
  ImportChoices choices;
  choices.frame = FrameChoice{number, fps, shutter};
  return choices;
}

/// Expects that the coordinates of a and b differ by at most 1e-6.
void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-6);
  EXPECT_NEAR(a.y, b.y, 1e-6);
  EXPECT_NEAR(a.z, b.z, 1e-6);
}

class Sequence : public ::testing::Test {
 protected:
  /// Imports the scene, and expects that the result does not depend on frames that were imported
  /// before.
  ImportedScene read(const std::string& path, const ImportChoices& choices) {
    auto imported = import_scene(path, choices);
    EXPECT_TRUE(imported.ok()) << imported.status();
    if (imported.ok()) {
      expect_the_same_after_other_frames(path, choices, *imported);
    }
    return imported.ok() ? *std::move(imported) : ImportedScene();
  }
  /// Expects that the package has the same bytes if other frames were imported before with the same
  /// ImportMemory, which keeps the results of earlier imports.
  static void expect_the_same_after_other_frames(const std::string& path,
                                                 const ImportChoices& choices,
                                                 const ImportedScene& fresh) {
    BlobMap blobs;
    ImportMemory memory;
    ImportChoices other = choices;
    for (int i = 0; i < 2; ++i) {
      if (other.frame) {
        other.frame->number += 3;
      }
      const auto before = import_scene(path, other, &memory);
      ASSERT_TRUE(before.ok()) << before.status();
      encode_package(before->scene, before->info, blobs, &memory.encoded);
    }
    const auto after = import_scene(path, choices, &memory);
    ASSERT_TRUE(after.ok()) << after.status();
    EXPECT_EQ(encode_package(after->scene, after->info, blobs, &memory.encoded),
              encode_package(fresh.scene, fresh.info, blobs));
  }
  ImportedScene read_text(const std::string& text, const ImportChoices& choices) {
    return read(write_text(folder_, "s.textproto", text), choices);
  }
  std::string error_of(const std::string& text, const ImportChoices& choices = {}) {
    const auto imported = import_scene(write_text(folder_, "s.textproto", text), choices);
    EXPECT_FALSE(imported.ok());
    return std::string(imported.status().message());
  }
  TempDir folder_;
};

constexpr char kScene[] = R"(
  camera { position: [0, 0, 5] look_at: [0, 0, 0] shutter_close: 0.5 }
  fps: 10
  material { name: "lamp" emissive { radiance { rgb: [1, 1, 1] } } }
  light { point { position: [0, 1, 0] intensity { rgb: [1, 1, 1] } } }
  shape { sphere { radius: 1 } material: "lamp" })";

TEST_F(Sequence, TracksSetFieldsToTheirValuesInTheMiddleOfTheExposure) {
  const std::string text = std::string(kScene) + R"(
    track { field: "light[0].point.position"
            key { time: 0 value: [0, 1, 0] } key { time: 4 value: [8, 1, 0] } }
    track { field: "material[\"lamp\"].emissive.radiance.rgb" interpolation: INTERPOLATION_STEP
            key { time: 0 value: [1, 2, 3] } key { time: 2.1 value: [4, 5, 6] } })";
  const auto radiance_of_lamp = [](const SceneDescription& scene) {
    const Sphere& ball = scene.geometry.spheres.at(0);
    const auto& lamp = std::get<Emissive>(scene.materials[index_of(ball.material)].kind);
    return std::get<ConstantTexture>(scene.textures[index_of(lamp.radiance)]).value;
  };
  // Frame 20 is at time 2. The exposure lasts from 2 to 2.5, so its middle is at 2.25.
  const ImportedScene imported = read_text(text, frame(20));
  const auto& light = std::get<PointLight>(imported.scene.lights.at(0));
  expect_near(light.position, {4.5, 1, 0});
  // A step track has the value of the last key that is not after the time. At 2.25 this is the key
  // of time 2.1. At the start of the exposure it would be the key of time 0.
  EXPECT_EQ(radiance_of_lamp(imported.scene), (Rgb{4, 5, 6}));
  EXPECT_EQ(shutter_of(imported.scene.camera), (Shutter{2, 2.5}));
  const ImportedScene first = read_text(text, {});
  expect_near(std::get<PointLight>(first.scene.lights.at(0)).position, {0.5, 1, 0});
  // Without a frame the exposure lasts from 0 to 0.5. At its middle a step track still has the
  // value of its first key.
  EXPECT_EQ(radiance_of_lamp(first.scene), (Rgb{1, 2, 3}));
}

TEST_F(Sequence, TheCameraMovesDuringTheExposure) {
  const std::string text = std::string(kScene) + R"(
    track { field: "camera.position" key { time: 0 value: [0, 0, 5] }
            key { time: 10 value: [10, 0, 5] } }
    track { field: "camera.vertical_fov" key { time: 0 value: 30 } key { time: 10 value: 40 } })";
  const ImportedScene imported = read_text(text, frame(20));
  ASSERT_TRUE(imported.scene.camera_at_close.has_value());
  expect_near(view_of(imported.scene.camera).position, {2, 0, 5});
  expect_near(view_of(*imported.scene.camera_at_close).position, {2.5, 0, 5});
  EXPECT_DOUBLE_EQ(std::get<PerspectiveCamera>(*imported.scene.camera_at_close).vertical_fov, 32.5);
  EXPECT_TRUE(read_text(text, frame(20, 10, 0.0)).scene.camera_at_close == std::nullopt)
      << "a camera must not move if the shutter does not open";
}

TEST_F(Sequence, FpsAndShutterOfTheUserReplaceThoseOfTheScene) {
  const Shutter shutter = shutter_of(read_text(kScene, frame(30, 60, 0.25)).scene.camera);
  EXPECT_DOUBLE_EQ(shutter.open, 0.5);
  EXPECT_DOUBLE_EQ(shutter.close, 0.5 + 0.25 / 60);
}

TEST_F(Sequence, AWrongTrackIsAnErrorThatNamesItsPlace) {
  const auto with = [&](const std::string& track) {
    return error_of(std::string(kScene) + "\ntrack { " + track + " }");
  };
  const std::string key = "key { time: 0 value: 1 }";
  EXPECT_THAT(with("field: \"camera.fov\" " + key), HasSubstr("there is no field \"fov\""));
  EXPECT_THAT(with("field: \"light[7].point.position\" " + key), HasSubstr("has no light[7]"));
  EXPECT_THAT(with("field: \"material[\\\"x\\\"].emissive.radiance.rgb\" " + key),
              HasSubstr("has no material[\"x\"]"));
  EXPECT_THAT(with("field: \"camera.shutter_open\" " + key), HasSubstr("must be a number"));
  EXPECT_THAT(with("field: \"fps\" " + key), HasSubstr("there is no field \"fps\""));
  EXPECT_THAT(with("field: \"track[0].key\" " + key), HasSubstr("there is no field \"track\""));
  EXPECT_THAT(with("field: \"camera.vertical_fov\""), HasSubstr("key: is required"));
  EXPECT_THAT(with("field: \"camera.vertical_fov\" key { time: 0 value: [1, 2] }"),
              HasSubstr("must be one number"));
  EXPECT_THAT(with("field: \"camera.position\" key { time: 1 value: 1 } key { time: 1 value: 1 }"),
              HasSubstr("must be after 1, the time of the key before; it is 1"));
  EXPECT_THAT(with(key), HasSubstr("field: is required"));
}

/// A file with two nodes. Node 1 has a triangle and is a child of node 0.
GltfWriter two_nodes() {
  GltfWriter file;
  file.attributes() = {{"POSITION", file.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)}};
  file.root["nodes"] = Json::parse(R"([{"children": [1], "translation": [0, 0, 7]}, {"mesh": 0}])");
  return file;
}

/// The file of two_nodes() with a camera at node 1. The node is named "eye".
GltfWriter with_camera() {
  GltfWriter file = two_nodes();
  file.root["cameras"] =
      Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 1}}])");
  file.root["nodes"][1]["camera"] = 0;
  file.root["nodes"][1]["name"] = "eye";
  return file;
}

/// Adds to `animation` the keys of one property of a node. `path`: the property, as glTF names it;
/// `values`: `components` numbers for each time.
void add_channel(GltfWriter& file, Json& animation, int node, const char* path,
                 const std::vector<float>& times, const std::vector<float>& values, int components,
                 const char* interpolation = "LINEAR") {
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back({{"input", file.add(times, 1)},
                                   {"output", file.add(values, components)},
                                   {"interpolation", interpolation}});
}

Json empty_animation(const char* name) {
  return {{"name", name}, {"channels", Json::array()}, {"samplers", Json::array()}};
}

TEST_F(Sequence, NodesOfGltfAreWhereTheirAnimationPutsThem) {
  GltfWriter file = two_nodes();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0, 1}, {0, 0, 0, 10, 0, 0}, 3);
  const auto half = static_cast<float>(std::sqrt(0.5));
  add_channel(file, walk, 1, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, half, half}, 4);
  add_channel(file, walk, 1, "scale", {0, 2}, {1, 1, 1, 3, 3, 3}, 3);
  file.root["animations"] = Json::array({walk});
  const std::string path = file.write(folder_, "m.gltf");
  // At 24 frames per second, frame 12 is at half a second. The nodes are then moved by 5 along x,
  // turned by 45 degrees about z and scaled by 1.5.
  const ImportedScene imported = read(path, frame(12));
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  ASSERT_THAT(imported.scene.geometry.instances, SizeIs(1));
  expect_near(imported.scene.geometry.instances[0].to_world.point({1, 0, 0}),
              {5 + 1.5 * std::sqrt(0.5), 1.5 * std::sqrt(0.5), 0});
  const ImportedScene rest = read(path, {});
  expect_near(rest.scene.geometry.instances[0].to_world.point({1, 0, 0}), {1, 0, 7});
  EXPECT_THAT(rest.info.warnings, Contains(HasSubstr("the rest pose is shown")));
}

// During the exposure a node moves by its own keys, in the coordinates of its moving parent.
TEST_F(Sequence, NodesMoveWithTheirParentsDuringTheExposure) {
  GltfWriter file = two_nodes();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0, 0.5, 1}, {0, 0, 0, 10, 0, 0, 10, 10, 0}, 3);
  add_channel(file, walk, 1, "translation", {0, 1}, {0, 0, 0, 0, 0, 2}, 3);
  file.root["animations"] = Json::array({walk});
  const ImportedScene imported = read(file.write(folder_, "m.gltf"), frame(0, 1, 1.0));
  const Geometry& geometry = imported.scene.geometry;
  ASSERT_THAT(geometry.instances, SizeIs(1));
  ASSERT_NE(geometry.instances[0].frame, kNoFrame);
  const auto origin_at = [&](double time) {
    return to_world_at(geometry, geometry.instances[0], time).point({0, 0, 0});
  };
  expect_near(origin_at(0), {0, 0, 0});
  expect_near(origin_at(0.25), {5, 0, 0.5});
  expect_near(origin_at(0.75), {10, 5, 1.5});
  expect_near(origin_at(1), {10, 10, 2});
}

TEST_F(Sequence, SkinsAndMorphTargetsHaveThePoseOfTheFrame) {
  GltfWriter file;
  file.add_skinned_triangle();
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 0, 4, 0, 0, 0, 0, 0}, 3)}}});
  file.root["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0}, {"translation": [0, 0, 0]}])");
  file.root["scenes"][0]["nodes"] = {0, 1};
  file.root["skins"] = Json::parse(R"([{"joints": [1]}])");
  Json bend = empty_animation("bend");
  add_channel(file, bend, 1, "translation", {0, 1}, {0, 0, 0, 0, 0, 8}, 3);
  add_channel(file, bend, 0, "weights", {0, 1}, {0, 1}, 1);
  file.root["animations"] = Json::array({bend});
  // At 24 frames per second, frame 6 is at a quarter of a second. The bone moves all vertices by 2
  // along z, and the target moves the second vertex by 1 along x.
  const ImportedScene imported = read(file.write(folder_, "m.gltf"), frame(6, 24));
  ASSERT_THAT(imported.scene.geometry.meshes, SizeIs(1));
  EXPECT_THAT(imported.scene.geometry.meshes[0].positions,
              ElementsAre(ElementsAre(0, 0, 2), ElementsAre(2, 0, 2), ElementsAre(0, 1, 2)));
}

TEST_F(Sequence, MeshesAndImagesThatDoNotChangeAreShared) {
  GltfWriter file = two_nodes();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0, 1}, {0, 0, 0, 9, 0, 0}, 3);
  file.root["animations"] = Json::array({walk});
  const std::string path = file.write(folder_, "m.gltf");
  ImportMemory memory;
  const auto first = import_scene(path, frame(0), &memory);
  ASSERT_TRUE(first.ok()) << first.status();
  std::filesystem::remove(path);  // The second import must not read the file again.
  write_text(folder_, "m.gltf", "");
  const auto second = import_scene(path, frame(5), &memory);
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(first->scene.geometry.meshes.shared(0), second->scene.geometry.meshes.shared(0));
  // The second package adds no blobs, because it has the same meshes as the first package.
  BlobMap of_first;
  encode_package(first->scene, first->info, of_first, &memory.encoded);
  EXPECT_THAT(of_first.all(), SizeIs(2));  // positions and indices
  BlobMap of_second;
  encode_package(second->scene, second->info, of_second, &memory.encoded);
  EXPECT_THAT(of_second.all(), IsEmpty());
}

TEST_F(Sequence, AnAnimationIsChosenByName) {
  GltfWriter file = two_nodes();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0}, {1, 0, 0}, 3);
  Json jump = empty_animation("jump");
  add_channel(file, jump, 0, "translation", {0}, {0, 1, 0}, 3);
  file.root["animations"] = Json::array({walk, jump});
  const std::string path = file.write(folder_, "m.gltf");
  ImportChoices choices = frame(0);
  const ImportedScene first = read(path, choices);
  expect_near(first.scene.geometry.instances[0].to_world.point({0, 0, 0}), {1, 0, 0});
  EXPECT_THAT(first.info.warnings, ElementsAre(HasSubstr("\"walk\", \"jump\"; \"walk\" is shown")));
  choices.animation = "jump";
  expect_near(read(path, choices).scene.geometry.instances[0].to_world.point({0, 0, 0}), {0, 1, 0});
  choices.animation = "run";
  EXPECT_THAT(std::string(import_scene(path, choices).status().message()),
              HasSubstr("m.gltf: has no animation \"run\"; there are \"walk\", \"jump\""));
  // In a scene file each model names its own animation.
  const ImportedScene both = read_text(std::string(kScene) + R"(
    model { file: "m.gltf" animation: "walk" } model { file: "m.gltf" animation: "jump" })",
                                       {});
  ASSERT_THAT(both.scene.geometry.instances, SizeIs(2));
  expect_near(both.scene.geometry.instances[0].to_world.point({0, 0, 0}), {1, 0, 0});
  expect_near(both.scene.geometry.instances[1].to_world.point({0, 0, 0}), {0, 1, 0});
}

TEST_F(Sequence, ACameraAtAMovingNodeMovesWithIt) {
  GltfWriter file = with_camera();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0, 1}, {0, 0, 5, 4, 0, 5}, 3);
  file.root["animations"] = Json::array({walk});
  const ImportedScene imported = read(file.write(folder_, "m.gltf"), frame(1, 4, 0.5));
  expect_near(view_of(imported.scene.camera).position, {1, 0, 5});
  ASSERT_TRUE(imported.scene.camera_at_close.has_value());
  expect_near(view_of(*imported.scene.camera_at_close).position, {1.5, 0, 5});
}

TEST_F(Sequence, ACameraMovesWithTheKeysOfItsModel) {
  GltfWriter file = with_camera();
  file.write(folder_, "m.gltf");
  const std::string text = R"(camera { use: "eye" } model { file: "m.gltf"
    key { time: 0 translate: [0, 0, 0] } key { time: 1 translate: [4, 0, 0] } })";
  const ImportedScene imported = read_text(text, frame(1, 4, 0.5));
  expect_near(view_of(imported.scene.camera).position, {1, 0, 7});
  ASSERT_TRUE(imported.scene.camera_at_close.has_value());
  expect_near(view_of(*imported.scene.camera_at_close).position, {1.5, 0, 7});
  EXPECT_FALSE(read_text(text, frame(1, 4, 0.0)).scene.camera_at_close.has_value());
}

TEST_F(Sequence, ACameraOfAModelKeepsItsWindowWhileItMoves) {
  GltfWriter file = with_camera();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0, 1}, {0, 0, 5, 4, 0, 5}, 3);
  file.root["animations"] = Json::array({walk});
  file.write(folder_, "m.gltf");
  const ImportedScene imported = read_text(
      R"(camera { use: "eye" window: [0, 1, 0, 1] mirrored: true } model { file: "m.gltf" })",
      frame(1, 4, 0.5));
  ASSERT_TRUE(imported.scene.camera_at_close.has_value());
  for (const Camera& camera : {imported.scene.camera, *imported.scene.camera_at_close}) {
    EXPECT_EQ(window_of(camera), (ImageWindow{0, 1, 0, 1}));
    EXPECT_TRUE(is_mirrored(camera));
  }
}

// The default camera shows the whole model in its rest pose.
TEST_F(Sequence, TheDefaultCameraDoesNotFollowTheAnimation) {
  GltfWriter file = two_nodes();
  Json walk = empty_animation("walk");
  add_channel(file, walk, 0, "translation", {0, 1}, {0, 0, 0, 9, 0, 0}, 3);
  file.root["animations"] = Json::array({walk});
  const std::string path = file.write(folder_, "m.gltf");
  expect_near(view_of(read(path, frame(0)).scene.camera).position,
              view_of(read(path, frame(20)).scene.camera).position);
}

/// The file of two_nodes(), in which the node with the mesh has a scale of 0 until the time
/// `shown`, in seconds.
GltfWriter hidden_until(float shown) {
  GltfWriter file = two_nodes();
  Json pop = empty_animation("pop");
  add_channel(file, pop, 1, "scale", {0, shown}, {0, 0, 0, 1, 1, 1}, 3, "STEP");
  file.root["animations"] = Json::array({pop});
  return file;
}

TEST_F(Sequence, AnAnimationMayHideAllMeshes) {
  const std::string path = hidden_until(1).write(folder_, "m.gltf");
  const ImportedScene hidden = read(path, frame(0));
  EXPECT_THAT(hidden.scene.geometry.instances, IsEmpty());
  EXPECT_THAT(hidden.info.warnings, ElementsAre(HasSubstr("1 placements are left out")));
  const ImportedScene shown = read(path, frame(24));
  EXPECT_THAT(shown.scene.geometry.instances, SizeIs(1));
  // For both frames, the default camera is placed for the rest pose, at z = 7.
  const Vec3 eye = view_of(shown.scene.camera).position;
  expect_near(view_of(hidden.scene.camera).position, eye);
  EXPECT_GT(eye.z, 7);
  // The model may also be hidden beside other objects, and alone in a scene file without a camera.
  const ImportedScene both =
      read_text(std::string(kScene) + R"(model { file: "m.gltf" })", frame(0));
  EXPECT_THAT(both.scene.geometry.instances, IsEmpty());
  EXPECT_THAT(read_text(R"(model { file: "m.gltf" })", frame(0)).scene.geometry.instances,
              IsEmpty());
}

TEST_F(Sequence, AModelOfScaleZeroWithoutAnAnimationIsRefused) {
  GltfWriter file = two_nodes();
  file.root["nodes"][1]["scale"] = {0, 0, 0};
  EXPECT_THAT(std::string(import_scene(file.write(folder_, "m.gltf")).status().message()),
              HasSubstr("holds no triangle that can be rendered"));
}

TEST_F(Sequence, TheDefaultCameraOfASceneFileHasTheChosenShutter) {
  two_nodes().write(folder_, "m.gltf");
  const ImportedScene imported = read_text(R"(model { file: "m.gltf" })", frame(30, 60, 0.25));
  const Shutter shutter = shutter_of(imported.scene.camera);
  EXPECT_DOUBLE_EQ(shutter.open, 0.5);
  EXPECT_DOUBLE_EQ(shutter.close, 0.5 + 0.25 / 60);
}

TEST_F(Sequence, DamagedAnimationsAreErrors) {
  const auto with = [&](const std::vector<float>& times, const std::vector<float>& values,
                        const char* interpolation) {
    GltfWriter file = two_nodes();
    Json walk = empty_animation("walk");
    add_channel(file, walk, 0, "translation", times, values, 3, interpolation);
    file.root["animations"] = Json::array({walk});
    return std::string(import_scene(file.write(folder_, "m.gltf"), frame(0)).status().message());
  };
  EXPECT_THAT(with({0, 0}, {0, 0, 0, 1, 1, 1}, "LINEAR"),
              HasSubstr("its times must increase; time 1 is 0 s, and time 0 is 0 s"));
  for (const float time : {2e9F, INFINITY, NAN}) {
    EXPECT_THAT(with({0, time}, {0, 0, 0, 1, 1, 1}, "LINEAR"),
                HasSubstr("its times must be finite and within +-1e9 s; time 1 is "));
  }
  EXPECT_THAT(with({0, 1}, {0, 0, 0}, "LINEAR"), HasSubstr("does not match the 2 times"));
  EXPECT_THAT(with({0, 1}, {0, 0, 0, 1, 1, 1}, "CUBICSPLINE"), HasSubstr("does not match"));
  EXPECT_THAT(with({0, 1}, {0, 0, 0, NAN, 1, 1}, "LINEAR"), HasSubstr("not finite"));
  EXPECT_THAT(with({0, 1}, {0, 0, 0, 1, 1, 1}, "BEZIER"), HasSubstr("\"BEZIER\" is not LINEAR"));
}

}  // namespace
}  // namespace bandsaw
