// Textures in scene files: checkers, noise, images, and the errors for wrong fields. The last test
// is about a shape, the box.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::small_ppm;
using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

const std::string kHead = "camera { position: [0, 1, 5] look_at: [0, 0, 0] }\n";

/// Imports a scene file of kHead and `text`. Its folder also has two small images.
absl::StatusOr<ImportedScene> import_text(const std::string& text) {
  const TempDir folder;
  write_text(folder, "colors.ppm", small_ppm());
  write_text(folder, "grey.pgm", std::string("P5 2 1 255\n") + "\x10\x20");
  return import_scene(write_text(folder, "s.textproto", kHead + text));
}

/// Imports a scene with one material, which is diffuse and has this texture.
absl::StatusOr<ImportedScene> import_diffuse(const std::string& texture) {
  return import_text("material { name: \"m\" diffuse { texture { " + texture + " } } }");
}

/// Returns the message of the error of import_diffuse().
std::string message(const std::string& texture) {
  return std::string(import_diffuse(texture).status().message());
}

/// Returns the reflectance of the last material, which is diffuse.
template <class Kind>
Kind texture_of(const absl::StatusOr<ImportedScene>& imported) {
  const SceneDescription& scene = imported->scene;
  const auto& material = std::get<Diffuse>(scene.materials.back().kind);
  return std::get<Kind>(scene.textures[index_of(material.reflectance)]);
}

/// Returns the value of the texture `id`, which is constant.
Rgb color(const absl::StatusOr<ImportedScene>& imported, TextureId id) {
  return std::get<ConstantTexture>(imported->scene.textures[index_of(id)]).value;
}

TEST(SceneTexture, CheckersAreReadWithTheirTextures) {
  const auto imported = import_diffuse(
      "checker { mapping: MAPPING_POSITION size: [1, 2, 3] space: SPACE_OBJECT"
      " even { color { rgb: [0.5, 0, 0] } } odd { checker { size: 0.25 uv_set: UV_SET_SECOND } } "
      "}");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto outer = texture_of<CheckerTexture>(imported);
  EXPECT_EQ(outer.mapping, CheckerTexture::Mapping::kPosition);
  EXPECT_EQ(outer.size, (Vec3{1, 2, 3}));
  EXPECT_EQ(outer.space, Space::kObject);
  EXPECT_EQ(color(imported, outer.even), (Rgb{0.5f, 0, 0}));
  const auto& inner = std::get<CheckerTexture>(imported->scene.textures[index_of(outer.odd)]);
  EXPECT_EQ(inner.size, (Vec3{0.25, 0.25, 1}));
  EXPECT_EQ(inner.uv_set, UvSet::kSecond);
  EXPECT_EQ(color(imported, inner.even), (Rgb{1, 1, 1}));
  EXPECT_EQ(color(imported, inner.odd), (Rgb{0, 0, 0}));
}

TEST(SceneTexture, NoiseHasDefaultsAndReadsItsFields) {
  const auto plain = import_diffuse("noise { }");
  ASSERT_TRUE(plain.ok()) << plain.status();
  EXPECT_EQ(texture_of<NoiseTexture>(plain).octaves, 7u);
  EXPECT_EQ(texture_of<NoiseTexture>(plain).strength, 10);
  const auto imported = import_diffuse(
      "noise { kind: KIND_MARBLE scale: 4 octaves: 3 strength: 0 turbulence_scale: 2"
      " axis: [1, 0, 0] low { rgb: [0, 0.5, 0] } high { rgb: [1, 0, 0] } space: SPACE_OBJECT }");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto noise = texture_of<NoiseTexture>(imported);
  EXPECT_EQ(noise.kind, NoiseTexture::Kind::kMarble);
  EXPECT_EQ(noise.scale, 4);
  EXPECT_EQ(noise.octaves, 3u);
  EXPECT_EQ(noise.strength, 0);
  EXPECT_EQ(noise.turbulence_scale, 2);
  EXPECT_EQ(noise.axis, (Vec3{1, 0, 0}));
  EXPECT_EQ(noise.low, (Rgb{0, 0.5f, 0}));
  EXPECT_EQ(noise.space, Space::kObject);
}

// The first scene is wrong: the field `color` of part b of the mixture is empty. The second scene
// is right: its two materials and its ramp use two named textures, and the product is the third.
TEST(SceneTexture, AnEmptyColorIsAnErrorAndAllUsesOfANamedTextureShareIt) {
  const auto imported = import_text(R"(
texture { name: "veins" noise { kind: KIND_TURBULENCE } }
texture { name: "fire" ramp { texture { use: "veins" } stop { at: 0.5 color: [1, 0, 0] } steps: true } }
material { name: "a" diffuse { texture { use: "fire" } } }
material { name: "b" diffuse { texture { mix { a { use: "fire" } b { color { } } amount { use: "veins" } } } } }
)");
  ASSERT_FALSE(imported.ok());
  const auto good = import_text(R"(
texture { name: "veins" noise { kind: KIND_TURBULENCE } }
texture { name: "fire" ramp { texture { use: "veins" } stop { at: 0.5 color: [1, 0, 0] } steps: true } }
material { name: "a" diffuse { texture { use: "fire" } } }
material { name: "b" metal { texture { product { a { use: "fire" } b { use: "veins" } } } } }
)");
  ASSERT_TRUE(good.ok()) << good.status();
  EXPECT_EQ(good->scene.textures.size(), 3u);
  EXPECT_EQ(std::get<RampTexture>(good->scene.textures[1]).texture, TextureId{0});
  EXPECT_EQ(std::get<ProductTexture>(good->scene.textures[2]).a, TextureId{1});
}

TEST(SceneTexture, ImagesHaveAnEncodingATransformAndAUvSet) {
  const auto imported = import_diffuse(
      "image { file: \"colors.ppm\" encoding: ENCODING_LINEAR uv_set: UV_SET_SECOND"
      " uv_scale: [2, 3] uv_offset: [0.5, -1] uv_rotate: 90 }");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto image = texture_of<ImageTexture>(imported);
  EXPECT_EQ(image.format, ImageTexture::Format::kLinear8);
  EXPECT_EQ(image.uv_set, UvSet::kSecond);
  const Vec2 uv = image.uv_transform({0.25, 1});  // scaled to (0.5, 3), turned to (-3, 0.5), moved
  EXPECT_EQ(uv.x, -2.5);
  EXPECT_EQ(uv.y, -0.5);
}

TEST(SceneTexture, GreyImagesKeepOneChannel) {
  const auto imported = import_diffuse("image { file: \"grey.pgm\" filter: FILTER_NEAREST }");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto image = texture_of<ImageTexture>(imported);
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.texels, (std::vector<std::byte>{std::byte{16}, std::byte{32}}));
}

TEST(SceneTexture, ErrorsNamePlaceAndField) {
  EXPECT_THAT(message("checker { size: [1, 2, 3] }"), HasSubstr("s.textproto:2:"));
  EXPECT_THAT(message("checker { size: [1, 2, 3] }"),
              HasSubstr("material[0].diffuse.texture.checker.size: must be 1 or 2 numbers, has 3"));
  EXPECT_THAT(message("checker { size: 0 }"), HasSubstr("checker.size[0]: must be finite and > 0"));
  EXPECT_THAT(message("noise { octaves: 17 }"), HasSubstr("noise.octaves: must lie in [1, 16]"));
  EXPECT_THAT(message("noise { high { rgb: [2, 0, 0] } }"), HasSubstr("noise.high"));
  EXPECT_THAT(message("ramp { stop { at: 0 color: [0, 0, 0] } }"),
              HasSubstr("ramp: has no input: write texture or coordinate"));
  EXPECT_THAT(message("ramp { coordinate: COORDINATE_U }"),
              HasSubstr("ramp.stop: must have 1 to 256 stops; it has 0"));
  EXPECT_THAT(
      message("ramp { coordinate: COORDINATE_U stop { at: 1 color: [0, 0, 0] }"
              " stop { at: 1 color: [0, 0, 0] } }"),
      HasSubstr("ramp.stop[1].at: must be above 1, the position of the stop before; it is 1"));
  EXPECT_THAT(message("mix { a { color { rgb: [0, 0, 0] } } }"), HasSubstr("mix.b: is required"));
  EXPECT_THAT(message("product { a { color { rgb: [2, 2, 2] } } b { color { rgb: [1, 1, 1] } } }"),
              HasSubstr("product: a reflectance must lie in [0, 1], it reaches 2"));
  EXPECT_THAT(message("use: \"none\""),
              HasSubstr("use: no texture before this is called \"none\""));
  EXPECT_THAT(message("name: \"x\" noise { }"),
              HasSubstr("name: is for the textures of the scene"));
  EXPECT_THAT(message("image { file: \"colors.ppm\" uv_offset: 1 }"),
              HasSubstr("image.uv_offset: must be 2 numbers, has 1"));
  EXPECT_THAT(std::string(import_text("texture { noise { } }").status().message()),
              HasSubstr("texture[0].name: is required"));
  EXPECT_THAT(
      std::string(import_text("texture { name: \"a\" noise { } } texture { name: \"a\" noise { } }")
                      .status()
                      .message()),
      HasSubstr("texture[1].name: \"a\" is the name of another texture"));
}

TEST(SceneTexture, AModelWithAMaterialOfTheSceneKeepsItsSecondUvs) {
  if (!test::have_test_models()) {
    GTEST_SKIP() << "package assimp-testmodels is not installed";
  }
  const TempDir folder;
  std::filesystem::copy(test::test_model("glTF2/BoxTexcoords-glTF"), folder / "box");
  const auto imported = import_scene(write_text(
      folder, "s.textproto",
      kHead + "material { name: \"m\" diffuse { texture { checker { uv_set: UV_SET_SECOND } "
              "} } } model { file: \"box/boxTexcoords.gltf\" material: \"m\" }"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  for (const Mesh& mesh : imported->scene.geometry.meshes) {
    EXPECT_EQ(mesh.uvs2.size(), mesh.positions.size());
    EXPECT_NE(mesh.uvs2, mesh.uvs);
  }
}

TEST(SceneTexture, ABoxIsSixQuadsThatFaceOutwards) {
  const auto imported = import_text(
      "material { name: \"m\" diffuse { } }"
      "shape { box { min: [-1, 0, 2] max: [3, 5, 4] } material: \"m\" }");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const std::vector<Quad>& sides = imported->scene.geometry.quads;
  ASSERT_EQ(sides.size(), 6u);
  const Vec3 middle{1, 2.5, 3};
  double area = 0;
  for (const Quad& side : sides) {
    const Vec3 normal = cross(side.u, side.v);
    EXPECT_GT(dot(normal, side.corner - middle), 0);
    area += length(normal);
  }
  EXPECT_EQ(area, 2 * (4 * 5 + 4 * 2 + 5 * 2));
  EXPECT_THAT(
      std::string(import_text("material { name: \"m\" diffuse { } }"
                              "shape { box { min: [0, 0, 0] max: [1, 0, 1] } material: \"m\" }")
                      .status()
                      .message()),
      HasSubstr("shape[0].box.max: must be above min"));
}

}  // namespace
}  // namespace bandsaw
