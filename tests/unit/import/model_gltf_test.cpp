// The import of glTF files: materials with their extensions, texture transforms, sets of
// uvs, vertex colours, and the rest pose of skins and morph targets.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderlib/import/import.h"
#include "tests/unit/import/gltf_file.h"
#include "tests/unit/import/gltf_writer.h"

namespace bandsaw {
namespace {

using test::floats;
using test::GltfTriangle;
using test::GltfWriter;
using test::Json;
using test::TempDir;
using test::write_text;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Returns the first material, which MUST be of the kind MetallicRoughness.
const MetallicRoughness& layers(const ImportedScene& imported) {
  return std::get<MetallicRoughness>(imported.scene.materials.at(0).kind);
}
const ImageTexture& image(const ImportedScene& imported, TextureId id) {
  return std::get<ImageTexture>(imported.scene.textures.at(index_of(id)));
}

class Gltf : public ::testing::Test {
 protected:
  /// Imports the file, and expects no error. The file may use the image a.ppm.
  ImportedScene read(const GltfTriangle& file) {
    write_text(folder_, "a.ppm", test::small_ppm());
    auto imported = import_scene(file.write(folder_, "t.gltf"));
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? *std::move(imported) : ImportedScene();
  }
  TempDir folder_;
};

// F0 is the reflectance at normal incidence. The default index 1.5 has an F0 of 0.04, and the index
// 1.1 / 0.9 has a quarter of it, 0.01.
TEST_F(Gltf, SpecularBecomesTheIndexWithTheSameReflectance) {
  GltfTriangle file;
  file.more = R"("extensionsUsed": ["KHR_materials_specular"],)";
  file.materials = R"({"extensions": {"KHR_materials_specular": {"specularFactor": 0.25}}})";
  const ImportedScene plain = read(file);
  EXPECT_THAT(plain.info.warnings, IsEmpty());
  EXPECT_NEAR(layers(plain).index_of_refraction, 1.1 / 0.9, 1e-9);
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.materials = R"({"extensions": {"KHR_materials_specular": {"specularFactor": 0,
    "specularColorFactor": [1, 0.5, 1], "specularTexture": {"index": 0}}}})";
  const ImportedScene odd = read(file);
  EXPECT_EQ(layers(odd).index_of_refraction, 1);
  EXPECT_THAT(odd.info.warnings, ElementsAre(HasSubstr("its specular colour is taken as grey"),
                                             HasSubstr("its specular map is left out")));
}

TEST_F(Gltf, EveryParameterHasItsTextureAndItsNumber) {
  GltfTriangle file;
  file.textures = R"({"source": 0}, {"source": 0, "sampler": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.samplers = R"({"wrapS": 33071, "wrapT": 33648, "magFilter": 9728})";
  file.more = R"("extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_transmission",
    "KHR_materials_ior", "KHR_materials_emissive_strength"],)";
  file.materials = R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.75],
      "baseColorTexture": {"index": 0}, "metallicFactor": 0.25, "roughnessFactor": 0.75,
      "metallicRoughnessTexture": {"index": 1}},
    "normalTexture": {"index": 1, "scale": 0.5}, "emissiveTexture": {"index": 0},
    "emissiveFactor": [1, 0.5, 0.25], "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
    "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 1},
        "clearcoatRoughnessFactor": 0.25, "clearcoatRoughnessTexture": {"index": 1},
        "clearcoatNormalTexture": {"index": 1, "scale": 2}},
      "KHR_materials_transmission": {"transmissionFactor": 0.75, "transmissionTexture": {"index": 1}},
      "KHR_materials_ior": {"ior": 1.25}, "KHR_materials_emissive_strength": {"emissiveStrength": 8}}})";
  const ImportedScene imported = read(file);
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  const MetallicRoughness& m = layers(imported);
  EXPECT_EQ(m.base_color.factor, (Rgb{0.5f, 0.25f, 1}));
  EXPECT_EQ(image(imported, m.base_color.texture).format, ImageTexture::Format::kSrgb8);
  EXPECT_EQ(m.metallic.factor, 0.25);
  EXPECT_EQ(m.roughness.factor, 0.75);
  EXPECT_EQ(m.metallic.texture, m.roughness.texture);
  const ImageTexture& rough = image(imported, m.roughness.texture);
  EXPECT_EQ(rough.format, ImageTexture::Format::kLinear8);
  EXPECT_EQ(rough.wrap, ImageTexture::Wrap::kClamp);
  EXPECT_EQ(rough.v_wrap(), ImageTexture::Wrap::kMirror);
  EXPECT_EQ(rough.filter, ImageTexture::Filter::kNearest);
  const Material& whole = imported.scene.materials.at(0);
  ASSERT_TRUE(whole.relief.normal.has_value());
  EXPECT_EQ(whole.relief.normal_scale, 0.5);
  EXPECT_EQ(whole.emission.radiance.factor, (Rgb{8, 4, 2}));
  EXPECT_FALSE(whole.emission.one_sided);
  EXPECT_EQ(whole.alpha.mode, AlphaMode::kMask);
  EXPECT_EQ(whole.alpha.cutoff, 0.25);
  EXPECT_EQ(whole.alpha.value.factor, 0.75);
  EXPECT_EQ(m.coat.factor, 0.5);
  EXPECT_EQ(m.coat_roughness.factor, 0.25);
  EXPECT_EQ(m.coat.texture, m.roughness.texture)
      << "parameters that use an image in the same way must share a texture";
  ASSERT_TRUE(m.coat_normal.has_value());
  EXPECT_EQ(m.coat_normal_scale, 2);
  EXPECT_EQ(m.transmission.factor, 0.75);
  EXPECT_EQ(m.index_of_refraction, 1.25);
}

TEST_F(Gltf, AnEmptyMaterialHasTheDefaults) {
  const ImportedScene imported = read({});
  const MetallicRoughness& m = layers(imported);
  EXPECT_EQ(m.base_color.factor, (Rgb{1, 1, 1}));
  EXPECT_EQ(m.metallic.factor, 1);
  EXPECT_EQ(m.roughness.factor, 1);
  EXPECT_EQ(m.index_of_refraction, 1.5);
  const Material& whole = imported.scene.materials.at(0);
  EXPECT_EQ(whole.alpha.mode, AlphaMode::kOpaque);
  EXPECT_TRUE(whole.emission.one_sided);
  EXPECT_FALSE(whole.relief.normal || m.coat_normal || m.index_map);
}

TEST_F(Gltf, TexturesAreTurnedScaledAndMovedAboutTheTopLeftCorner) {
  GltfTriangle file;
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.more = R"("extensionsUsed": ["KHR_texture_transform"],)";
  // The specification's example: the lower left quadrant of the image, turned clockwise.
  file.materials = R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions":
    {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1.5707963267948966, "scale": [0.5, 0.5]}}}}})";
  const ImportedScene imported = read(file);
  const ImageTexture& texture = image(imported, layers(imported).base_color.texture);
  // The top left corner of the image is (0, 0) in glTF and (0, 1) in this renderer.
  const auto at = [&](double u, double v) {
    const Vec2 uv = texture.uv_transform({u, 1 - v});
    return Vec3{uv.x, 1 - uv.y, 0};
  };
  EXPECT_NEAR(length(at(0, 0) - Vec3{0, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(length(at(1, 0) - Vec3{0, 0.5, 0}), 0, 1e-12);
  EXPECT_NEAR(length(at(0, 1) - Vec3{0.5, 1, 0}), 0, 1e-12);
  EXPECT_NEAR(length(at(1, 1) - Vec3{0.5, 0.5, 0}), 0, 1e-12);
}

// Assimp may number materials in the order in which nodes use them. In this test, the order of use
// differs from the order in the file.
TEST_F(Gltf, EachMaterialHasItsOwnExtensionsWhateverTheOrderOfUse) {
  write_text(folder_, "o.bin", floats({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  const auto imported = import_scene(write_text(folder_, "o.gltf", R"({"asset": {"version": "2.0"},
"extensionsUsed": ["KHR_materials_emissive_strength"], "scene": 0, "scenes": [{"nodes": [1]}],
"nodes": [{"mesh": 0}, {"mesh": 1, "children": [0, 2]}, {"mesh": 2}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 2}]},
  {"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
  {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]}],
"materials": [
  {"name": "a", "emissiveFactor": [1, 0, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}},
  {"name": "b", "emissiveFactor": [0, 1, 0], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3}}},
  {"emissiveFactor": [0, 0, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "o.bin"}]})"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  std::vector<Rgb> glow;
  for (const Material& material : imported->scene.materials) {
    glow.push_back(material.emission.radiance.factor);
  }
  EXPECT_THAT(glow, ::testing::UnorderedElementsAre(Rgb{2, 0, 0}, Rgb{0, 3, 0}, Rgb{0, 0, 4}));
}

TEST_F(Gltf, EachTextureHasItsOwnSetOfUvs) {
  GltfTriangle file;
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.more = R"("extensionsUsed": ["KHR_texture_transform"],)";
  file.materials = R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}},
    "normalTexture": {"index": 0},
    "emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}})";
  const ImportedScene imported = read(file);
  const MetallicRoughness& m = layers(imported);
  const UvSet base = image(imported, m.base_color.texture).uv_set;
  const Material& whole = imported.scene.materials.at(0);
  EXPECT_NE(image(imported, *whole.relief.normal).uv_set, base);
  EXPECT_EQ(image(imported, whole.emission.radiance.texture).uv_set, base);
  const Mesh& mesh = imported.scene.geometry.meshes[0];
  const auto& uvs = base == UvSet::kFirst ? mesh.uvs : mesh.uvs2;
  EXPECT_EQ(uvs[1][0], 0.5f) << "the base colour must have the file's second set of uvs";
  EXPECT_EQ((base == UvSet::kFirst ? mesh.uvs2 : mesh.uvs)[1][0], 1);
}

TEST_F(Gltf, VertexColoursAreLinearAndWhiteOnesAreDropped) {
  GltfTriangle file;
  file.colors = true;
  const ImportedScene imported = read(file);
  const Mesh& mesh = imported.scene.geometry.meshes[0];
  EXPECT_THAT(mesh.colors, ElementsAre(ElementsAre(0.5f, 0, 0), ElementsAre(0, 0.5f, 0),
                                       ElementsAre(0, 0, 0.5f)));
  EXPECT_THAT(read({}).scene.geometry.meshes[0].colors, IsEmpty());
}

TEST_F(Gltf, UnsupportedFeaturesAreNamed) {
  GltfTriangle file;
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.more =
      R"("extensionsUsed": ["KHR_materials_variants", "KHR_materials_sheen", "KHR_xmp_json_ld"],)";
  file.materials = R"({"occlusionTexture": {"index": 0}})";
  EXPECT_THAT(read(file).info.warnings,
              ElementsAre("t.gltf: the extension KHR_materials_variants is left out",
                          HasSubstr("its occlusion map is left out")));
}

// Each feature gives one warning, however many materials have it, and none if it has no effect.
TEST_F(Gltf, UnsupportedMaterialFeaturesAreNamedOncePerFile) {
  GltfTriangle file;
  file.more = R"("extensionsUsed": ["KHR_materials_sheen", "KHR_materials_iridescence",
    "KHR_materials_anisotropy", "KHR_materials_dispersion", "KHR_materials_diffuse_transmission"],)";
  const std::string all = R"({"extensions": {"KHR_materials_sheen": {"sheenColorFactor": [1, 0, 0],
      "sheenColorTexture": {"index": 0}},
    "KHR_materials_iridescence": {"iridescenceFactor": 1},
    "KHR_materials_anisotropy": {"anisotropyStrength": 0.5},
    "KHR_materials_dispersion": {"dispersion": 0.1},
    "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.25}}})";
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.materials = all + ", " + all;
  file.primitives = R"(, {"attributes": {"POSITION": 0}, "material": 1})";
  const auto named = [](const std::string& what) {
    return HasSubstr(" and 1 more: its " + what + " is left out");
  };
  EXPECT_THAT(
      read(file).info.warnings,
      ::testing::UnorderedElementsAre(named("sheen"), named("iridescence"), named("anisotropy"),
                                      named("dispersion"), named("diffuse transmission")));
  file.materials = R"({"extensions": {"KHR_materials_sheen": {},
    "KHR_materials_iridescence": {"iridescenceIor": 2}, "KHR_materials_dispersion": {}}}, {})";
  EXPECT_THAT(read(file).info.warnings, IsEmpty());
}

TEST_F(Gltf, AnUnlitMaterialBecomesDiffuseWithAWarning) {
  GltfTriangle file;
  file.more = R"("extensionsUsed": ["KHR_materials_unlit"],)";
  file.materials = R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1]},
    "extensions": {"KHR_materials_unlit": {}}})";
  const ImportedScene imported = read(file);
  EXPECT_THAT(imported.info.warnings, ElementsAre(HasSubstr("is unlit")));
  EXPECT_TRUE(std::holds_alternative<Diffuse>(imported.scene.materials.at(0).kind));
}

TEST_F(Gltf, AnUnlitMaterialKeepsItsAlpha) {
  GltfTriangle file;
  file.more = R"("extensionsUsed": ["KHR_materials_unlit"],)";
  file.materials = R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.75]},
    "alphaMode": "MASK", "alphaCutoff": 0.25, "extensions": {"KHR_materials_unlit": {}}})";
  const Material masked = read(file).scene.materials.at(0);
  EXPECT_TRUE(std::holds_alternative<Diffuse>(masked.kind));
  EXPECT_EQ(masked.alpha.mode, AlphaMode::kMask);
  EXPECT_EQ(masked.alpha.cutoff, 0.25);
  EXPECT_EQ(masked.alpha.value.factor, 0.75);
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.materials = R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
    "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}}})";
  const ImportedScene blended = read(file);
  EXPECT_EQ(blended.scene.materials.at(0).alpha.mode, AlphaMode::kBlend);
}

TEST_F(Gltf, AGlossinessMaterialKeepsItsAlpha) {
  GltfTriangle file;
  file.more = R"("extensionsUsed": ["KHR_materials_pbrSpecularGlossiness"],)";
  file.materials = R"({"alphaMode": "BLEND", "extensions":
    {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [1, 0.5, 0.25, 0.75],
      "specularFactor": [0, 0, 0]}}})";
  const ImportedScene imported = read(file);
  EXPECT_EQ(layers(imported).base_color.factor, (Rgb{1, 0.5f, 0.25f}));
  EXPECT_EQ(imported.scene.materials.at(0).alpha.mode, AlphaMode::kBlend);
  EXPECT_EQ(imported.scene.materials.at(0).alpha.value.factor, 0.75);
}

// The material has pbrMetallicRoughness and the extension pbrSpecularGlossiness. The diffuse
// texture and the factors of the extension are not used.
TEST_F(Gltf, AMaterialOfTwoDescriptionsIsReadByItsMetallicRoughness) {
  GltfTriangle file;
  file.textures = R"({"source": 0})";
  file.images = R"({"uri": "a.ppm"})";
  file.more = R"("extensionsUsed": ["KHR_materials_pbrSpecularGlossiness"],)";
  file.materials = R"({"alphaMode": "BLEND",
    "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 0.75], "roughnessFactor": 0.5},
    "extensions": {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0, 0, 0, 0.125],
      "diffuseTexture": {"index": 0}, "specularFactor": [1, 1, 1], "glossinessFactor": 0.25}}})";
  const ImportedScene imported = read(file);
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  const MetallicRoughness& m = layers(imported);
  EXPECT_EQ(m.base_color.factor, (Rgb{1, 0.5f, 0.25f}));
  const Texture& base = imported.scene.textures.at(index_of(m.base_color.texture));
  EXPECT_FALSE(std::holds_alternative<ImageTexture>(base));
  EXPECT_EQ(m.metallic.factor, 1);
  EXPECT_EQ(m.roughness.factor, 0.5);
  EXPECT_EQ(imported.scene.materials.at(0).alpha.value.factor, 0.75);
}

TEST_F(Gltf, APrimitiveWithoutAMaterialGetsTheDefault) {
  GltfTriangle file;
  file.materials = R"({"extensions": {"KHR_materials_unlit": {}}})";
  file.primitives = R"(, {"attributes": {"POSITION": 0}})";
  const ImportedScene imported = read(file);
  ASSERT_EQ(imported.scene.geometry.instances.size(), 2u);
  const auto material = [&](std::size_t i) {
    return imported.scene.materials.at(index_of(imported.scene.geometry.instances[i].material));
  };
  EXPECT_TRUE(std::holds_alternative<Diffuse>(material(0).kind));
  ASSERT_TRUE(std::holds_alternative<MetallicRoughness>(material(1).kind));
  EXPECT_EQ(std::get<MetallicRoughness>(material(1).kind).base_color.factor, (Rgb{1, 1, 1}));
}

TEST_F(Gltf, ColoursOfThreeChannelsGiveNoWarningAboutAlpha) {
  GltfTriangle file;
  file.colors = true;
  EXPECT_THAT(read(file).info.warnings, IsEmpty());
}

// A file is refused if it requires an extension whose images or vertices cannot be read. A file
// that requires any other extension is imported.
TEST_F(Gltf, UnreadableDataIsRefused) {
  GltfTriangle file;
  file.more = R"("extensionsRequired": ["KHR_texture_basisu"],)";
  EXPECT_THAT(std::string(import_scene(file.write(folder_, "t.gltf")).status().message()),
              HasSubstr("t.gltf: cannot be read: it requires the extension KHR_texture_basisu"));
  file.more = R"("extensionsRequired": ["KHR_texture_transform", "KHR_technique_webgl"],)";
  EXPECT_TRUE(import_scene(file.write(folder_, "t.gltf")).ok());
}

// A triangle has a skin with one bone. The node of the bone lifts it by 2, and the inverse bind
// matrix lowers it by 1. A morph target of weight 0.5 moves the second vertex along z. The
// translation of the mesh's own node has no effect.
TEST_F(Gltf, ASkinnedMeshStandsInItsRestPose) {
  const std::vector<float> lowered{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  const std::string joints = std::string(12, '\0');
  std::string weights = floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  write_text(folder_, "s.bin",
             floats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + floats(lowered) + weights +
                 floats({0, 0, 0, 0, 0, 4, 0, 0, 0}) + joints);
  const auto imported = import_scene(write_text(folder_, "s.gltf", R"({"asset": {"version": "2.0"},
"scene": 0, "scenes": [{"nodes": [0, 1]}, {"nodes": [0]}],
"nodes": [{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}, {"name": "bone", "translation": [0, 2, 0]}],
"skins": [{"joints": [1], "inverseBindMatrices": 1}],
"meshes": [{"weights": [0.5], "primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 4, "WEIGHTS_0": 2},
  "targets": [{"POSITION": 3}]}]}],
"accessors": [
{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
{"bufferView": 1, "componentType": 5126, "count": 1, "type": "MAT4"},
{"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC4"},
{"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [0,0,4]},
{"bufferView": 4, "componentType": 5121, "count": 3, "type": "VEC4"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 64},
{"buffer": 0, "byteOffset": 100, "byteLength": 48}, {"buffer": 0, "byteOffset": 148, "byteLength": 36},
{"buffer": 0, "byteOffset": 184, "byteLength": 12}],
"buffers": [{"byteLength": 196, "uri": "s.bin"}]})"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Geometry& geometry = imported->scene.geometry;
  ASSERT_EQ(geometry.instances.size(), 1u);
  EXPECT_EQ(geometry.instances[0].to_world, Transform{});
  EXPECT_THAT(geometry.meshes[0].positions,
              ElementsAre(ElementsAre(0, 1, 0), ElementsAre(1, 1, 2), ElementsAre(0, 2, 0)));
  EXPECT_THAT(imported->info.warnings,
              Contains(HasSubstr("1 scene beside the default one is left out")));
}

// Two triangles have one bone each. Both bones have the same name.
TEST_F(Gltf, BonesOfOneNameAreDistinguished) {
  const std::string joints = std::string(12, '\0');
  write_text(folder_, "s.bin",
             floats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}) +
                 joints + floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}));
  const auto imported = import_scene(write_text(folder_, "s.gltf", R"({"asset": {"version": "2.0"},
"scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
"nodes": [{"mesh": 0, "skin": 0}, {"mesh": 1, "skin": 1},
  {"name": "hips", "translation": [0, 2, 0]}, {"name": "hips", "translation": [0, 0, 7]}],
"skins": [{"joints": [2], "inverseBindMatrices": 3}, {"joints": [3], "inverseBindMatrices": 3}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2}}]},
  {"primitives": [{"attributes": {"POSITION": 0, "WEIGHTS_0": 1, "JOINTS_0": 2}}]}],
"accessors": [
{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC4"},
{"bufferView": 2, "componentType": 5121, "count": 3, "type": "VEC4"},
{"bufferView": 3, "componentType": 5126, "count": 1, "type": "MAT4"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 48},
{"buffer": 0, "byteOffset": 84, "byteLength": 12}, {"buffer": 0, "byteOffset": 96, "byteLength": 64}],
"buffers": [{"byteLength": 160, "uri": "s.bin"}]})"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& meshes = imported->scene.geometry.meshes;
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_THAT(meshes[0].positions[0], ElementsAre(0, 2, 0));
  EXPECT_THAT(meshes[1].positions[0], ElementsAre(0, 0, 7));
}

// Four nodes share one mesh. The first and the second node have a skin each, and the third node has
// none. The fourth node has the same skin as the first, and would place the same triangle a second
// time. So the fourth node is left out.
TEST_F(Gltf, EachSkinPosesTheMeshThatItShares) {
  GltfWriter file;
  file.add_skinned_triangle();
  file.root["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0}, {"mesh": 0, "skin": 1},
    {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "skin": 0},
    {"translation": [0, 2, 0]}, {"translation": [0, 0, 7]}])");
  file.root["scenes"][0]["nodes"] = {0, 1, 2, 3, 4, 5};
  file.root["skins"] = Json::parse(R"([{"joints": [4]}, {"joints": [5]}])");
  const auto imported = file.import(folder_);
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->info.warnings, IsEmpty());
  const Geometry& geometry = imported->scene.geometry;
  ASSERT_EQ(geometry.instances.size(), 3u);
  const auto first_vertex = [&](std::size_t i) {
    const Instance& instance = geometry.instances[i];
    const auto& p = geometry.meshes[index_of(instance.mesh)].positions[0];
    return instance.to_world.point({p[0], p[1], p[2]});
  };
  EXPECT_EQ(first_vertex(0), (Vec3{0, 2, 0}));
  EXPECT_EQ(first_vertex(1), (Vec3{0, 0, 7}));
  EXPECT_EQ(first_vertex(2), (Vec3{5, 0, 0}));
}

// The weights of a node replace the weights of its mesh. Nodes with equal weights share one
// imported mesh.
TEST_F(Gltf, MorphTargetsHaveTheWeightsOfTheNode) {
  GltfWriter file;
  file.attributes()["POSITION"] = file.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 0, 0, 0, 4, 0, 0, 0}, 3)}}});
  file.root["meshes"][0]["weights"] = {0.25};
  file.root["nodes"] =
      Json::parse(R"([{"mesh": 0, "weights": [0.5]}, {"mesh": 0}, {"mesh": 0, "weights": [0.5]}])");
  file.root["scenes"][0]["nodes"] = {0, 1, 2};
  const auto imported = file.import(folder_);
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Geometry& geometry = imported->scene.geometry;
  ASSERT_EQ(geometry.instances.size(), 3u);
  const auto height = [&](std::size_t i) {
    return geometry.meshes[index_of(geometry.instances[i].mesh)].positions[1][2];
  };
  EXPECT_EQ(height(0), 2);
  EXPECT_EQ(height(1), 1);
  EXPECT_EQ(height(2), 2);
  EXPECT_EQ(geometry.meshes.size(), 2u);
}

}  // namespace
}  // namespace bandsaw
