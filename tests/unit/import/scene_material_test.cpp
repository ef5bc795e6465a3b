// Tests materials of scene files: the fields that are numbers, textures or both, the kinds of
// materials of other renderers, and the errors for wrong fields.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

/// Imports a scene with the material "m". `material`: the text of its fields.
absl::StatusOr<ImportedScene> import_material(const std::string& material) {
  const TempDir folder;
  return import_scene(
      write_text(folder, "s.textproto",
                 "camera { position: [0, 1, 5] look_at: [0, 0, 0] }\nmaterial { name: \"m\" " +
                     material + " }"));
}

/// Returns the part of the material that is special to its kind. `text`: as for import_material().
template <class Kind>
Kind material(const std::string& text) {
  const auto imported = import_material(text);
  EXPECT_TRUE(imported.ok()) << imported.status();
  return imported.ok() ? std::get<Kind>(imported->scene.materials[0].kind) : Kind();
}

const std::string kNoise = " { noise { scale: 3 } } ";

TEST(SceneMaterial, FuzzIsANumberATextureOrBoth) {
  EXPECT_EQ(material<Metal>("metal {}").fuzz, 0);
  const auto textured = material<Metal>("metal { fuzz_texture" + kNoise + "}");
  EXPECT_EQ(textured.fuzz, 1);  // the factor of the texture, unless a number is given
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
  const auto m = material<MetallicRoughness>(
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

/// Returns the whole material, with the fields that all kinds have.
Material whole(const std::string& text) {
  const auto imported = import_material(text);
  EXPECT_TRUE(imported.ok()) << imported.status();
  return imported.ok() ? imported->scene.materials[0] : Material();
}

TEST(SceneMaterial, EveryKindHasThePropertiesOfTheSurface) {
  const Material m =
      whole("plastic {} normal_texture { color { rgb: [0.5, 0.5, 1] } } " +
            std::string("normal_scale: 2 opacity: 0.5 emission { rgb: [1, 2, 3] } ") +
            "emission_one_sided: true one_sided: true");
  EXPECT_TRUE(m.relief.normal && !m.relief.height);
  EXPECT_EQ(m.relief.normal_scale, 2);
  EXPECT_EQ(m.alpha.mode, AlphaMode::kBlend);
  EXPECT_EQ(m.alpha.value.factor, 0.5);
  EXPECT_TRUE(m.alpha.luminance);
  EXPECT_EQ(m.emission.radiance.factor, (Rgb{1, 2, 3}));
  EXPECT_TRUE(m.emission.one_sided && m.one_sided);
  const Material bumped = whole("diffuse {} bump_texture" + kNoise + "bump_scale: -0.5");
  EXPECT_TRUE(bumped.relief.height);
  EXPECT_EQ(bumped.relief.height_scale, -0.5);
}

TEST(SceneMaterial, ReadsTheKindsOfOtherRenderers) {
  const auto plastic = material<Plastic>("plastic { surface { alpha_texture" + kNoise +
                                         "} index_of_refraction: 1.9 nonlinear: true }");
  EXPECT_EQ(plastic.surface.alpha_u, 1);
  EXPECT_EQ(plastic.surface.alpha_v_map, plastic.surface.alpha_u_map);
  EXPECT_TRUE(plastic.nonlinear);
  const auto metal = material<Conductor>(
      "conductor { eta { rgb: [1, 2, 3] } k { rgb: [4, 5, 6] } surface { alpha: 0.1 alpha_v: 0.2 "
      "distribution: DISTRIBUTION_BECKMANN masking: MASKING_CORRELATED } }");
  ASSERT_TRUE(metal.index);
  EXPECT_EQ(metal.index->k, (Rgb{4, 5, 6}));
  EXPECT_EQ(metal.surface.alpha_v, 0.2);
  EXPECT_EQ(metal.surface.distribution, Microfacets::Distribution::kBeckmann);
  EXPECT_EQ(metal.surface.masking, Microfacets::Masking::kCorrelated);
  EXPECT_FALSE(material<Conductor>("conductor {}").index);
  EXPECT_EQ(material<ThinDielectric>("thin_dielectric {}").index_of_refraction, 1.5);
  material<DiffuseTransmission>("diffuse_transmission {}");
  EXPECT_TRUE(material<Dielectric>("dielectric { surface { alpha: 0.2 } }").surface);
  const auto principled = material<Principled>("principled { specular: 0.5 metallic { texture" +
                                               kNoise + "} sheen { value: 0.25 } }");
  EXPECT_NEAR(principled.index_of_refraction, 1.5, 1e-9);
  EXPECT_EQ(principled.metallic.value, 1);
  EXPECT_TRUE(principled.metallic.map);
  EXPECT_EQ(principled.sheen.value, 0.25);
  EXPECT_EQ(principled.roughness.value, 0.5);
  // In a scene file, diff_trans is twice the share of the diffuse light that is transmitted.
  EXPECT_EQ(
      material<ThinPrincipled>("thin_principled { diff_trans { value: 1.5 } }").diff_trans.value,
      0.75);
}

TEST(SceneMaterial, AMixtureRefersToMaterialsBeforeIt) {
  const auto imported = import_material(
      "diffuse {} } material { name: \"n\" plastic {} } material { name: \"x\" mix { a: \"m\" b: "
      "\"n\" }");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& mix = std::get<Mix>(imported->scene.materials[2].kind);
  EXPECT_EQ(mix.a, MaterialId{0});
  EXPECT_EQ(mix.b, MaterialId{1});
}

/// A material with a mistake, and a part of the message of its error.
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
      {"gltf {} opacity: 0.5", "material[0].opacity: write the field of gltf instead"},
      {"emissive { radiance { rgb: [1, 1, 1] } } one_sided: true",
       "material[0].one_sided: is not possible for an emissive material"},
      {"dielectric {} one_sided: true", "a material that transmits light has two sides"},
      {"diffuse {} normal_texture" + kNoise + "bump_texture" + kNoise,
       "material[0].bump_texture: write normal_texture or bump_texture, not both"},
      {"diffuse {} bump_texture { noise { space: SPACE_OBJECT } }",
       "a height map cannot lie in object space"},
      {"diffuse {} opacity: 2", "material[0].opacity: must lie in [0, 1], is 2"},
      {"conductor { eta { rgb: [1, 1, 1] } }", "material[0].conductor.eta: write eta and k"},
      {"conductor { eta { rgb: [1, 0, 1] } k { rgb: [1, 1, 1] } }", "must be above 0"},
      {"plastic { surface { alpha: 0.1 alpha_v: 0.2 } }",
       "material[0].plastic.surface: the coat of plastic is isotropic"},
      {"plastic { index_of_refraction: 1 }", "must be above 1"},
      {"dielectric { roughness: 0.5 surface {} }", "write surface or roughness, not both"},
      {"diffuse_transmission { reflectance { rgb: [0.8, 0, 0] } }", "must not exceed 1 in sum"},
      {"principled { specular: 0.5 index_of_refraction: 1.5 }", "not both"},
      {"principled { sheen {} }", "material[0].principled.sheen.value: is required"},
      {"thin_principled { diff_trans { value: 3 } }", "must lie in [0, 2], is 3"},
      {"mix { a: \"m\" b: \"m\" }", "material[0].mix.a: no material before this one is called"},
      {"gltf { clearcoat: 1.5 }", "material[0].gltf.clearcoat: must lie in [0, 1], is 1.5"}};
  for (const auto& [text, message] : kWrong) {
    EXPECT_THAT(std::string(import_material(text).status().message()), HasSubstr(message)) << text;
  }
}

}  // namespace
}  // namespace bandsaw
