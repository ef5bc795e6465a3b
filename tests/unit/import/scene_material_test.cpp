// Materials of scene files whose numbers are textures.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

absl::StatusOr<ImportedScene> import_material(const std::string& material) {
  const TempDir folder;
  return import_scene(
      write_text(folder, "s.textproto",
                 "camera { position: [0, 1, 5] look_at: [0, 0, 0] }\nmaterial { name: \"m\" " +
                     material + " }"));
}

template <class Kind>
Kind material(const std::string& text) {
  const auto imported = import_material(text);
  EXPECT_TRUE(imported.ok()) << imported.status();
  return imported.ok() ? std::get<Kind>(imported->scene.materials[0]) : Kind();
}

const std::string kNoise = " { noise { scale: 3 } } ";

TEST(SceneMaterial, FuzzIsANumberATextureOrBoth) {
  EXPECT_EQ(material<Metal>("metal {}").fuzz, 0);
  const auto textured = material<Metal>("metal { fuzz_texture" + kNoise + "}");
  EXPECT_EQ(textured.fuzz, 1);
  EXPECT_TRUE(textured.fuzz_map.has_value());
  EXPECT_EQ(material<Metal>("metal { fuzz: 0.25 fuzz_texture" + kNoise + "}").fuzz, 0.25);
}

TEST(SceneMaterial, GlassHasTexturesOfRoughnessAndIndex) {
  const auto glass = material<Dielectric>("dielectric { index_of_refraction: 2 roughness_texture" +
                                          kNoise + "index_of_refraction_texture" + kNoise + "}");
  EXPECT_EQ(glass.roughness, 1);
  EXPECT_TRUE(glass.roughness_map && glass.index_map);
  EXPECT_EQ(glass.index_of_refraction, 2);
}

TEST(SceneMaterial, GltfHasATextureForEachNumber) {
  const auto m = material<Principled>(
      "gltf { metallic_texture" + kNoise + "roughness_texture" + kNoise + "roughness: 0.5 " +
      "clearcoat_texture" + kNoise + "clearcoat_roughness_texture" + kNoise +
      "clearcoat_normal_texture { color { rgb: [0.5, 0.5, 1] } } clearcoat_normal_scale: 0.5 " +
      "transmission_texture" + kNoise + "index_of_refraction_texture" + kNoise + "}");
  EXPECT_EQ(m.metallic.factor, 1);
  EXPECT_EQ(m.roughness.factor, 0.5);
  EXPECT_NE(m.metallic.texture, m.roughness.texture);
  EXPECT_EQ(m.coat.factor, 1);
  EXPECT_EQ(m.coat_roughness.factor, 1);
  EXPECT_EQ(m.transmission.factor, 1);
  EXPECT_TRUE(m.coat_normal && m.index_map);
  EXPECT_EQ(m.coat_normal_scale, 0.5);
}

struct Wrong {
  std::string material;
  std::string message;
};

TEST(SceneMaterial, ErrorsNamePlaceAndField) {
  const Wrong kWrong[] = {
      {"metal { fuzz_texture { color { rgb: [2, 0, 0] } } }", "material[0].metal.fuzz_texture"},
      {"metal { fuzz: 2 }", "material[0].metal.fuzz: must lie in [0, 1], is 2"},
      {"dielectric { priority: 1 index_of_refraction_texture" + kNoise + "}",
       "a glass with a priority has one index of refraction"},
      {"gltf { metallic_roughness_texture" + kNoise + "roughness_texture" + kNoise + "}",
       "metallic_roughness_texture: write it, or metallic_texture and roughness_texture, not both"},
      {"gltf { clearcoat_texture { use: \"x\" } }", "material[0].gltf.clearcoat_texture"},
      {"gltf { clearcoat: 1.5 }", "material[0].gltf.clearcoat: must lie in [0, 1], is 1.5"}};
  for (const auto& [text, message] : kWrong) {
    EXPECT_THAT(std::string(import_material(text).status().message()), HasSubstr(message)) << text;
  }
}

}  // namespace
}  // namespace bandsaw
