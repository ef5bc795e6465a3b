// KHR_materials_volume: closed meshes that transmit become solid glass with an absorbing medium.
// Also tests that the normal map of a clear coat (KHR_materials_clearcoat) has its own set of uvs.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/import/gltf_writer.h"
#include "tests/unit/import/layer.h"

namespace bandsaw {
namespace {

using test::GltfWriter;
using test::Json;
using test::TempDir;
using test::WavySquare;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The index of refraction is 1, so rays pass straight. White light becomes (0.25, 0.5, 1) over a
/// length of 2.
constexpr char kGlass[] = R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
  "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1},
    "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2,
      "attenuationColor": [0.25, 0.5, 1]}}})";

/// Returns the cube [-1, 1]^3, each face with vertices of its own. `open`: the last face is
/// missing.
GltfWriter cube(bool open = false) {
  std::vector<float> positions;
  std::vector<std::uint16_t> indices;
  for (int face = 0; face < (open ? 5 : 6); ++face) {
    const int axis = face / 2;
    const float side = face % 2 == 0 ? -1.0f : 1.0f;
    const auto first = static_cast<std::uint16_t>(positions.size() / 3);
    for (const auto& [a, b] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      float p[3];
      p[axis] = side;
      p[(axis + 1) % 3] = static_cast<float>(a) * side;
      p[(axis + 2) % 3] = static_cast<float>(b);
      positions.insert(positions.end(), {p[0], p[1], p[2]});
    }
    for (const int corner : {0, 1, 2, 0, 2, 3}) {
      indices.push_back(static_cast<std::uint16_t>(first + corner));
    }
  }
  GltfWriter file;
  file.attributes()["POSITION"] = file.add(positions, 3);
  file.primitive()["indices"] = file.add(indices, 1);
  file.primitive()["material"] = 0;
  file.root["materials"] = Json::array({Json::parse(kGlass)});
  file.root["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume",
                                 "KHR_materials_ior"};
  return file;
}

ImportedScene read(GltfWriter file, const TempDir& folder) {
  auto imported = file.import(folder);
  EXPECT_TRUE(imported.ok()) << imported.status();
  return imported.ok() ? *std::move(imported) : ImportedScene();
}

TEST(GltfVolume, AClosedMeshIsGlassThatAbsorbs) {
  const TempDir folder;
  const ImportedScene imported = read(cube(), folder);
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  const Instance& instance = imported.scene.geometry.instances.at(0);
  const auto& glass =
      std::get<Dielectric>(imported.scene.materials.at(index_of(instance.material)).kind);
  EXPECT_EQ(glass.index_of_refraction, 1);
  EXPECT_EQ(glass.roughness, 0);
  ASSERT_EQ(imported.scene.media.media.size(), 1u);
  const Rgb& absorption = imported.scene.media.media[0].absorption;
  EXPECT_NEAR(absorption.r, std::log(4.0) / 2, 1e-6);
  EXPECT_NEAR(absorption.g, std::log(2.0) / 2, 1e-6);
  EXPECT_EQ(absorption.b, 0);
  EXPECT_EQ(imported.scene.media.boundaries.instances.size(), 1u);
}

// A scene places the cube, whose depth is 2. White light that passes through it gets the colour
// that the file gives for a length of 2.
TEST(GltfVolume, WhiteLightGetsTheColourThatTheFileGives) {
  const TempDir folder;
  cube().write(folder, "m.gltf");
  const auto imported = import_scene(
      write_text(folder, "s.textproto",
                 "camera { position: [0, 0, 9] look_at: [0, 0, 0] orthographic { height: 1 } }"
                 "background { constant { rgb: [1, 1, 1] } } model { file: \"m.gltf\" }"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Image image = test::layer(*imported, 2, 2, Integrator::kPath);
  for (const Rgb& pixel : image.pixels) {
    EXPECT_NEAR(pixel.r, 0.25, 1e-4);
    EXPECT_NEAR(pixel.g, 0.5, 1e-4);
    EXPECT_NEAR(pixel.b, 1, 1e-4);
  }
}

TEST(GltfVolume, OpenOrPartlyOpaqueMeshesStayThinPanes) {
  const TempDir folder;
  const ImportedScene open = read(cube(true), folder);
  EXPECT_THAT(open.info.warnings, ElementsAre(HasSubstr("the volume of 1 placements of meshes")));
  const auto is_thin = [](const ImportedScene& imported) {
    const MaterialId id = imported.scene.geometry.instances.at(0).material;
    return std::holds_alternative<MetallicRoughness>(
               imported.scene.materials.at(index_of(id)).kind) &&
           imported.scene.media.boundaries.instances.empty();
  };
  EXPECT_TRUE(is_thin(open));
  GltfWriter half = cube();
  half.root["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.5;
  const ImportedScene clouded = read(half, folder);
  EXPECT_THAT(clouded.info.warnings, ElementsAre(HasSubstr("its volume is left out")));
  EXPECT_TRUE(is_thin(clouded));
}

TEST(GltfVolume, SpecularDoesNotChangeTheRefraction) {
  const TempDir folder;
  GltfWriter file = cube();
  file.root["extensionsUsed"].push_back("KHR_materials_specular");
  Json& extensions = file.root["materials"][0]["extensions"];
  extensions["KHR_materials_ior"]["ior"] = 1.25;
  extensions["KHR_materials_specular"] = {{"specularFactor", 0}};
  const ImportedScene imported = read(file, folder);
  EXPECT_THAT(imported.info.warnings, ElementsAre(HasSubstr("its specular factor and colour")));
  const MaterialId id = imported.scene.geometry.instances.at(0).material;
  const auto& glass = std::get<Dielectric>(imported.scene.materials.at(index_of(id)).kind);
  EXPECT_EQ(glass.index_of_refraction, 1.25);
  extensions["KHR_materials_specular"] = {{"specularFactor", 1}};
  EXPECT_THAT(read(file, folder).info.warnings, IsEmpty());
}

TEST(GltfVolume, AMeshWithoutAThicknessIsAThinPane) {
  const TempDir folder;
  GltfWriter thin = cube();
  thin.root["materials"][0]["extensions"]["KHR_materials_volume"].erase("thicknessFactor");
  const ImportedScene imported = read(thin, folder);
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  EXPECT_TRUE(imported.scene.media.media.empty());
}

// The base's normal map uses the first set of uvs. Its scale is 0, so the map has no effect. The
// coat's normal map uses the second set, which is rotated by a quarter turn. So the picture must be
// the same with and without the base's map.
TEST(GltfCoat, TheNormalMapUsesTheSetOfUvsThatItNames) {
  const TempDir folder;
  write_text(folder, "lean.ppm", std::string("P6 1 1 255\n") + "\xe0\x80\xf0");
  const WavySquare square(2);
  std::vector<float> turned;
  for (std::size_t i = 0; i < square.uvs.size(); i += 2) {
    turned.insert(turned.end(), {square.uvs[i + 1], -square.uvs[i]});
  }
  // Returns the picture. `base_map`: the base has its normal map. `coat_set`: number of the set of
  // uvs that the coat's normal map uses.
  const auto seen = [&](bool base_map, int coat_set) {
    GltfWriter file = square.plain();
    file.attributes()["TEXCOORD_1"] = file.add(turned, 2);
    file.primitive()["material"] = 0;
    file.root["images"] = {{{"uri", "lean.ppm"}}};
    file.root["textures"] = {{{"source", 0}}};
    Json material = Json::parse(R"({"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1],
      "metallicFactor": 0, "roughnessFactor": 1}, "extensions": {"KHR_materials_clearcoat":
      {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.3, "clearcoatNormalTexture": {"index": 0}}}})");
    material["extensions"]["KHR_materials_clearcoat"]["clearcoatNormalTexture"]["texCoord"] =
        coat_set;
    if (base_map) {
      material["normalTexture"] = {{"index", 0}, {"texCoord", 0}, {"scale", 0}};
    }
    file.root["materials"] = Json::array({material});
    file.root["extensionsUsed"] = {"KHR_materials_clearcoat"};
    ImportedScene imported = read(file, folder);
    imported.scene.camera =
        OrthographicCamera{.position = {0.5, 0.5, 9}, .look_at = {0.5, 0.5, 0}, .height = 0.9};
    return test::layer(imported, 16, 16, Integrator::kPath).pixels;
  };
  const auto difference = [](const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    float most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      most = std::max(most, std::abs(a[i].r - b[i].r));
    }
    return most;
  };
  EXPECT_LT(difference(seen(true, 1), seen(false, 1)), 1e-4);
  EXPECT_GT(difference(seen(true, 1), seen(true, 0)), 1e-2)
      << "a map that uses the other set of uvs must change the picture";
}

}  // namespace
}  // namespace bandsaw
