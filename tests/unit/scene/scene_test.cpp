// Scenes: validation, counts, the features that a scene uses, and meshes that are shared with an
// earlier scene. An id such as S9 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::SceneMaker;
using ::testing::StartsWith;

/// A valid scene with a sphere, a quad, a triangle and an instance of a mesh.
SceneMaker valid() {
  SceneMaker maker;
  const MaterialId white = maker.diffuse(0.5f);
  maker.sphere({0, 0, 0}, 1, white);
  maker.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, maker.metal(0.5f, 0.1));
  maker.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, maker.lamp(1));
  maker.instance(test::grid(2), translation({0, 0, 3}), maker.glass(1.5));
  return maker;
}

/// Builds the scene and returns the message of the error; empty if there is none.
std::string message(const SceneDescription& scene) {
  Pool pool(1);
  const auto built = Scene::build(scene, pool);
  if (!built.ok()) {
    EXPECT_EQ(built.status().code(), absl::StatusCode::kInvalidArgument);
  }
  return std::string(built.status().message());
}

template <class Change>
std::string message_after(Change change) {
  SceneMaker maker = valid();
  change(maker.scene);
  return message(maker.scene);
}

TEST(Scene, S9_ErrorsNameFieldRangeAndValue) {
  EXPECT_EQ(message(valid().scene), "");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.spheres[0].radius = -1; }),
            "spheres[0].radius: must be > 0, is -1");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.spheres[0].radius = std::nan(""); }),
            "spheres[0].radius: must be > 0, is nan");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.spheres[0].center.y = 1e31; }),
            "spheres[0].center: must be within +-1e+30, is [0, 1e+31, 0]");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.quads[0].material = MaterialId{7}; }),
            "quads[0].material: must be below 4, is 7");
  EXPECT_THAT(message_after([](auto& s) { s.geometry.triangles[0].b.x = kInfinity; }),
              StartsWith("triangles[0].b: must be within"));
  EXPECT_EQ(message_after([](auto& s) { s.geometry.meshes.change(0).triangles[3][1] = 9; }),
            "meshes[0].triangles[3]: must be indices below 9, one is 9");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.meshes.change(0).uvs.pop_back(); }),
            "meshes[0].uvs: must have one entry for each of the 9 positions, or none; has 8");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.meshes.change(0).normals.resize(2); }),
            "meshes[0].normals: must have one entry for each of the 9 positions, or none; has 2");
  EXPECT_EQ(message_after([](auto& s) { s.geometry.instances[0].mesh = MeshId{1}; }),
            "instances[0].mesh: must be below 1, is 1");
  EXPECT_THAT(message_after([](auto& s) {
                s.geometry.instances[0].to_world = scaling({1, 0, 1});
              }),
              StartsWith("instances[0].to_world: must have an inverse"));
  EXPECT_THAT(message_after([](auto& s) { s.geometry.instances[0].to_world.m[1][3] = kInfinity; }),
              StartsWith("instances[0].to_world: entries must be within"));
  EXPECT_EQ(message_after([](auto& s) { s.background.top.g = -1; }),
            "background.top: must be finite and not negative, is -1");
  EXPECT_THAT(message_after([](auto& s) { std::get<0>(s.camera).vertical_fov = 200; }),
              StartsWith("camera.vertical_fov: "));
  test::report_hard_case(
      "S9", "a negative radius and NaN are refused with an error that names the field");
  test::report_hard_case("X3", "a scale of 0 is refused with an error that names the field");
}

TEST(Scene, M13_MaterialsAndTexturesAreValidated) {
  EXPECT_EQ(message_after([](auto& s) {
              s.textures[0] = ConstantTexture{{0, 1.5f, 0}};
            }),
            "materials[0].reflectance: must be in [0, 1], texture 0 reaches 1.5");
  EXPECT_EQ(message_after([](auto& s) {
              s.textures[1] = ConstantTexture{{-0.1f, 0, 0}};
            }),
            "textures[1]: must be finite and not negative, is -0.1");
  EXPECT_EQ(message_after([](auto& s) {
              s.textures[2] = ConstantTexture{{0, 0, INFINITY}};
            }),
            "textures[2]: must be finite and not negative, is inf");
  EXPECT_EQ(message_after([](auto& s) { std::get<Metal>(s.materials[1].kind).fuzz = 2; }),
            "materials[1].fuzz: must be in [0, 1], is 2");
  EXPECT_EQ(message_after([](auto& s) { s.materials[3] = Dielectric{0.9}; }),
            "materials[3].index_of_refraction: must be in [1, 5], is 0.9");
  EXPECT_EQ(message_after([](auto& s) { s.materials[0] = Diffuse{TextureId{3}}; }),
            "materials[0].reflectance: must be below 3, is 3");
  EXPECT_EQ(message_after([](auto& s) {
              MetallicRoughness layers;
              layers.coat_normal_scale = std::nan("");
              s.materials[0] = layers;
            }),
            "materials[0].coat_normal_scale: must be in [-1e+30, 1e+30], is nan");
  const auto with = [](const Material& material) {
    return message_after([&](auto& s) { s.materials[1] = material; });
  };
  Material common = Diffuse{};
  common.relief.normal_scale = kInfinity;
  EXPECT_EQ(with(common), "materials[1].relief.normal_scale: must be in [-1e+30, 1e+30], is inf");
  common.relief = {TextureId{0}, 1, TextureId{0}};
  EXPECT_EQ(with(common),
            "materials[1].relief.height: a surface has a normal map or a height map, not both");
  common.relief = {};
  common.alpha = {AlphaMode::kMask, {TextureId{0}, 1}, false, kInfinity};
  EXPECT_EQ(with(common), "materials[1].alpha.cutoff: must be in [0, 1e+30], is inf");
  common.alpha = {};
  common.emission.radiance = {TextureId{9}, {1, 1, 1}};
  EXPECT_EQ(with(common), "materials[1].emission.radiance: must be below 3, is 9");
  Material glass = Dielectric{};
  glass.one_sided = true;
  EXPECT_EQ(with(glass), "materials[1].one_sided: a material that transmits light has two sides");
  EXPECT_EQ(
      with(Plastic{TextureId{0}, 1}),
      "materials[1].index_of_refraction: must be above 1: a coat of index 1 would reflect nothing");
  EXPECT_EQ(with(Plastic{TextureId{0}, 1.5, {.alpha_u = 0.5}}),
            "materials[1].surface: the coat of plastic is isotropic");
  EXPECT_EQ(with(Conductor{ConductorIndex{{1, 0, 1}, {1, 1, 1}}}),
            "materials[1].eta: must be above 0 in each channel");
  EXPECT_EQ(with(Principled{.sheen = {2}}), "materials[1].sheen.value: must be in [0, 1], is 2");
  EXPECT_EQ(with(Mix{MaterialId{0}, MaterialId{1}}), "materials[1].b: must be below 1, is 1");
  EXPECT_EQ(message_after([](auto& s) {
              s.materials[0] = Dielectric{1.5, 0, 1};
              s.materials[1] = Mix{MaterialId{0}, MaterialId{0}};
            }),
            "materials[1].a: a glass with a priority is not part of a mixture");
  EXPECT_EQ(message_after([](auto& s) {
              // Material i is a mixture whose two parts are both material i - 1. So material i is
              // made of 2^(i + 1) - 1 materials.
              s.materials[0] = Diffuse{};
              for (std::uint32_t i = 0; i < 9; ++i) {
                const MaterialId last{i};
                s.materials.insert(s.materials.begin() + i + 1, Mix{last, last});
              }
            }),
            "materials[8]: is made of 511 materials, at most 256");
  EXPECT_EQ(message_after([](auto& s) {
              s.geometry.meshes.change(0).colors.resize(9, {1, 1, 1});
              s.geometry.meshes.change(0).colors[2] = {0, -0.5f, 0};
            }),
            "meshes[0].colors[2]: must be >= 0, one channel is -0.5");
  ImageTexture image;
  EXPECT_EQ(message_after([&](auto& s) { s.textures[0] = image; }),
            "textures[0].width: must be in [1, 65536], is 0");
  image.width = 1;
  image.height = 2;
  EXPECT_EQ(message_after([&](auto& s) { s.textures[0] = image; }),
            "textures[0].texels: must have 6 bytes for 1 x 2 texels, has 0");
  image.format = ImageTexture::Format::kFloat32;
  const float texels[6] = {0, 0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN()};
  const auto* bytes = reinterpret_cast<const std::byte*>(texels);
  image.texels = std::vector<std::byte>(bytes, bytes + sizeof texels);
  EXPECT_EQ(message_after([&](auto& s) { s.textures[0] = image; }),
            "textures[0].texels: texel (0, 1) must be finite and not negative, is nan");
  test::report_hard_case("M13", "refused with an error that names the field and the texel");
  test::report_hard_case("TX6", "textures without texels or with a NaN texel are refused");
}

TEST(Scene, T10_PrimitivesWithoutAreaAreDroppedAndCounted) {
  SceneMaker maker = valid();
  const MaterialId white{0};
  maker.quad({5, 0, 0}, {1, 1, 0}, {2, 2, 0}, white);
  maker.quad({6, 0, 0}, {1e-20, 0, 0}, {0, 1e-20, 0}, white);
  maker.triangle({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, white);
  Mesh& mesh = maker.scene.geometry.meshes.change(0);
  mesh.triangles.push_back({0, 0, 1});
  mesh.positions.push_back({std::nanf(""), 0, 0});
  mesh.uvs.push_back({INFINITY, 0});
  mesh.triangles.insert(mesh.triangles.begin(), {0, 1, 9});
  maker.scene.geometry.instances.push_back(maker.scene.geometry.instances[0]);
  const auto scene = maker.build();
  // One quad, one triangle, and two triangles of the mesh in each of its two instances.
  EXPECT_EQ(scene->dropped_primitives(), 2u + 2 * 2);
  ASSERT_EQ(scene->geometry().quads.size(), 2u);
  EXPECT_EQ(scene->geometry().quads[1].corner.x, 6);
  EXPECT_EQ(scene->geometry().meshes[0].triangles, test::grid(2).triangles);
  EXPECT_EQ(scene->geometry().meshes[0].uvs.back(), (std::array<float, 2>{0, 0}));
  const Hit hit = scene->accel().closest({.origin = {0.4, 0.3, 9}, .direction = {0, 0, -1}});
  EXPECT_TRUE(hit);
  EXPECT_EQ(hit.id.instance, 1u);
  test::report_hard_case("T10", "invalid primitives are dropped and counted");
}

TEST(Scene, SharesMeshesWithEarlierScenes) {
  SceneMaker maker = valid();
  Mesh& mesh = maker.scene.geometry.meshes.change(0);
  mesh.triangles.insert(mesh.triangles.begin(), {0, 0, 1});  // dropped
  Pool pool(1);
  const auto first = *Scene::build(maker.scene, pool);
  EXPECT_EQ(maker.scene.geometry.meshes[0].triangles.size(), mesh.triangles.size())
      << "the copied description must still have all its triangles";
  SceneDescription moved = maker.scene;
  moved.geometry.meshes = first->geometry().meshes;
  moved.geometry.instances[0].to_world = translation({0, 0, 1});
  const std::vector<std::shared_ptr<const Scene>> earlier = {first};
  const auto second = *Scene::build(moved, pool, {}, Traversal::kBvh, nullptr, earlier);
  EXPECT_EQ(second->geometry().meshes.shared(0), first->geometry().meshes.shared(0));
  EXPECT_EQ(second->dropped_primitives(), first->dropped_primitives());
  const auto alone = *Scene::build(moved, pool);
  EXPECT_NE(alone->geometry().meshes.shared(0), first->geometry().meshes.shared(0));
  const Ray ray{.origin = {0.4, 0.3, 9}, .direction = {0, 0, -1}};
  const Hit hit = second->accel().closest(ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, alone->accel().closest(ray).t);
  EXPECT_EQ(hit.t, 8) << "the instance must be where the second scene places it";
}

// SceneFeatures has a flag for each feature that costs time where it is enabled, such as lights,
// motion and media.
TEST(Scene, HasTheFeaturesThatItUses) {
  SceneMaker empty;
  EXPECT_EQ(empty.build()->features(), SceneFeatures{});
  SceneMaker maker = valid();
  maker.background({}, {0, 0, 1});
  const SceneFeatures features = maker.build()->features();
  EXPECT_EQ(features, SceneFeatures{.lights = true});
  SceneMaker dark;
  dark.sphere({0, 0, 0}, 1, dark.lamp(0));
  EXPECT_FALSE(dark.build()->features().lights) << "a lamp that is off is no light";
}

TEST(Scene, AnEmptySceneShowsItsBackground) {
  SceneMaker maker;
  maker.background({1, 2, 3}, {1, 2, 3});
  const auto scene = maker.build();
  EXPECT_FALSE(scene->accel().closest({.origin = {0, 0, 0}, .direction = {0, 0, 1}}));
  EXPECT_EQ(radiance(scene->background(), scene->textures(), {0, 1, 0}), (Rgb{1, 2, 3}));
}

}  // namespace
}  // namespace bandsaw
