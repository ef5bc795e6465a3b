// Models that Assimp reads: meshes, placements, cameras, materials, textures, and broken files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::test_model;
using test::write_text;
using ::testing::Contains;
using ::testing::HasSubstr;

#define NEED_TEST_MODELS()                                 \
  if (!test::have_test_models()) {                         \
    GTEST_SKIP() << "needs the package assimp-testmodels"; \
  }

/// Returns the number of triangles of all instances.
std::size_t triangles(const ImportedScene& imported) {
  std::size_t count = 0;
  for (const Instance& instance : imported.scene.geometry.instances) {
    count += imported.scene.geometry.meshes[index_of(instance.mesh)].triangles.size();
  }
  return count;
}

/// Returns the first image among the textures of the scene, or nullptr if it has no image.
const ImageTexture* first_image(const ImportedScene& imported) {
  for (const Texture& texture : imported.scene.textures) {
    if (const auto* image = std::get_if<ImageTexture>(&texture)) {
      return image;
    }
  }
  return nullptr;
}

/// Returns the message of the error of an import, or "" if the import succeeds.
std::string message_of(const std::string& path) {
  return std::string(import_scene(path).status().message());
}

class TexturedBox : public ::testing::TestWithParam<std::string> {};

TEST_P(TexturedBox, HasItsTrianglesUvsAndTexture) {
  NEED_TEST_MODELS();
  const auto imported = import_scene(test_model("glTF2/" + GetParam()));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(triangles(*imported), 12u);
  ASSERT_EQ(imported->scene.geometry.meshes.size(), 1u);
  const Mesh& mesh = imported->scene.geometry.meshes[0];
  EXPECT_EQ(mesh.positions.size(), 24u);
  EXPECT_EQ(mesh.normals.size(), 24u);
  EXPECT_EQ(mesh.uvs.size(), 24u);
  const ImageTexture* image = first_image(*imported);
  ASSERT_NE(image, nullptr);
  EXPECT_EQ(image->width, 211u);
  EXPECT_EQ(image->height, 211u);
  // The front face shows the sky of the picture above the ground. A larger v is further up in the
  // image. So the image is the right way up if the upper one of two vertices has the larger v.
  for (const auto& [a, b, c] : mesh.triangles) {
    if (mesh.normals[a][2] > 0 && mesh.positions[a][1] != mesh.positions[b][1] &&
        mesh.positions[a][0] == mesh.positions[b][0]) {
      EXPECT_EQ(mesh.positions[a][1] > mesh.positions[b][1], mesh.uvs[a][1] > mesh.uvs[b][1]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, TexturedBox,
                         ::testing::Values("BoxTextured-glTF/BoxTextured.gltf",
                                           "BoxTextured-glTF-Binary/BoxTextured.glb",
                                           "BoxTextured-glTF-Embedded/BoxTextured.gltf"));

TEST(Model, KeepsTheTreeOfPlacements) {
  NEED_TEST_MODELS();
  const auto imported =
      import_scene(test_model("glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(triangles(*imported), 121496u);
  EXPECT_GT(imported->scene.geometry.instances.size(), imported->scene.geometry.meshes.size());
  // The file's camera has a vertical field of view of 18 degrees.
  EXPECT_NEAR(std::get<PerspectiveCamera>(imported->scene.camera).vertical_fov, 18.0107, 1e-3);
}

TEST(Model, TakesThePerspectiveCameraOfTheFile) {
  NEED_TEST_MODELS();
  const auto imported = import_scene(test_model("glTF2/cameras/Cameras.gltf"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& camera = std::get<PerspectiveCamera>(imported->scene.camera);
  EXPECT_NEAR(camera.vertical_fov, 0.7 * 180 / 3.14159265358979, 1e-4);
  EXPECT_EQ(camera.position, (Vec3{0.5, 0.5, 3}));
  EXPECT_NEAR(length((camera.look_at - camera.position) - Vec3{0, 0, -1}), 0, 1e-6);
}

TEST(Model, ReadsObjWithItsMaterialsAndTextures) {
  NEED_TEST_MODELS();
  const auto imported = import_scene(test_model("OBJ/spider.obj"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(triangles(*imported), 1368u);
  std::size_t images = 0;
  for (const Texture& texture : imported->scene.textures) {
    images += std::holds_alternative<ImageTexture>(texture) ? 1u : 0u;
  }
  EXPECT_EQ(images, 4u) << "the fifth image belongs to a material that nothing uses";
  const auto box = import_scene(test_model("OBJ/box.obj"));
  ASSERT_TRUE(box.ok()) << box.status();
  EXPECT_EQ(triangles(*box), 12u);
}

TEST(Model, AModelWithOnlyInfiniteVerticesIsAnError) {
  NEED_TEST_MODELS();
  EXPECT_THAT(message_of(test_model("glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb")),
              HasSubstr("12 of 12 triangles have a vertex that is not a finite number"));
}

TEST(Model, DropsAndCountsTrianglesWithNanVertices) {
  const TempDir folder;
  const auto imported = import_scene(write_text(
      folder, "m.obj", "o roof\nv nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  ASSERT_EQ(imported->scene.geometry.meshes.size(), 1u);
  EXPECT_EQ(imported->scene.geometry.meshes[0].positions.size(), 3u);
  EXPECT_THAT(imported->info.warnings,
              Contains("m.obj: mesh \"roof\": 1 of 2 triangles have a vertex that is not a finite "
                       "number and are left out"));
}

TEST(Model, ABrokenModelGivesOneError) {
  NEED_TEST_MODELS();
  for (const std::string name :
       {"glTF2/MissingBin/BoxTextured.gltf", "glTF2/wrongTypes/badArray.gltf", "invalid/empty.obj",
        "invalid/malformed.obj", "OBJ/point_cloud.obj"}) {
    const auto imported = import_scene(test_model(name));
    ASSERT_FALSE(imported.ok()) << name;
    EXPECT_THAT(std::string(imported.status().message()),
                ::testing::StartsWith(name.substr(name.rfind('/') + 1) + ": "));
  }
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

TEST(Model, MakesDiffuseAndEmissiveOfObjMaterials) {
  const TempDir folder;
  write_text(folder, "m.mtl",
             "newmtl plain\nKd 0.25 0.5 0.75\nnewmtl lamp\nKd 0.7 0.7 0.7\nKe 17 12 4\n"
             "newmtl picture\nKd 1 1 1\nmap_Kd small picture.ppm\n");
  write_text(folder, "small picture.ppm", test::small_ppm());
  const auto imported =
      import_scene(write_text(folder, "m.obj",
                              "mtllib m.mtl\n" + kTriangle +
                                  "usemtl plain\nf 1/1 2/2 3/3\nusemtl lamp\nf 1/1 2/2 3/3\nusemtl "
                                  "picture\nf 1/1 2/2 3/3\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const SceneDescription& scene = imported->scene;
  ASSERT_EQ(scene.materials.size(), 3u);
  const auto value = [&](TextureId id) {
    return std::get<ConstantTexture>(scene.textures[index_of(id)]).value;
  };
  EXPECT_EQ(value(std::get<Diffuse>(scene.materials[0].kind).reflectance),
            (Rgb{0.25f, 0.5f, 0.75f}));
  EXPECT_EQ(value(std::get<Emissive>(scene.materials[1].kind).radiance), (Rgb{17, 12, 4}));
  const auto& image = std::get<ImageTexture>(
      scene.textures[index_of(std::get<Diffuse>(scene.materials[2].kind).reflectance)]);
  EXPECT_EQ(image.width, 2u);
  EXPECT_TRUE(is_black(scene.background.top)) << "a model with a lamp must have a black background";
}

TEST(Model, MultipliesATextureWithItsColour) {
  const TempDir folder;
  write_text(folder, "m.mtl", "newmtl a\nKd 0.5 1 0\nmap_Kd s.ppm\n");
  write_text(folder, "s.ppm", test::small_ppm());
  const auto imported = import_scene(
      write_text(folder, "m.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1/1 2/2 3/3\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const ImageTexture* image = first_image(*imported);
  ASSERT_NE(image, nullptr);
  // The last texel is white. Times (0.5, 1, 0), it has the codes 188 (of 0.5), 255 and 0. Channels
  // that are 0 stay 0.
  EXPECT_EQ(image->texels[9], std::byte{188});
  EXPECT_EQ(image->texels[10], std::byte{255});
  EXPECT_EQ(image->texels[11], std::byte{0});
  EXPECT_EQ(image->texels[1], std::byte{0});
}

TEST(Model, NamesATextureThatIsMissingOrOutsideTheFolder) {
  const TempDir folder;
  const auto with_map = [&](const std::string& map) {
    write_text(folder, "m.mtl", "newmtl stone\nKd 1 1 1\nmap_Kd " + map + "\n");
    return message_of(write_text(folder, "m.obj",
                                 "mtllib m.mtl\n" + kTriangle + "usemtl stone\nf 1/1 2/2 3/3\n"));
  };
  EXPECT_THAT(
      with_map("no.png"),
      HasSubstr("m.obj: material \"stone\": its texture \"no.png\" is missing (looked for "));
  EXPECT_THAT(with_map("../../etc/passwd"), HasSubstr("lies outside of the scene's folder"));
  EXPECT_THAT(with_map("/etc/passwd"), HasSubstr("is an absolute path"));
  EXPECT_THAT(with_map("m.obj"), HasSubstr("m.obj: is not an image that can be read"));
}

TEST(Model, CannotReadFilesOutsideItsFolder) {
  const TempDir folder;
  const std::string gltf = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "../../../../etc/passwd"}]})";
  const auto imported = import_scene(write_text(folder, "m.gltf", gltf));
  EXPECT_EQ(imported.status().code(), absl::StatusCode::kPermissionDenied) << imported.status();
  EXPECT_THAT(std::string(imported.status().message()),
              HasSubstr("m.gltf: \"../../../../etc/passwd\" lies outside of the scene's folder"));
}

TEST(Model, WarnsOfAMaterialFileThatIsMissing) {
  const TempDir folder;
  const auto imported =
      import_scene(write_text(folder, "m.obj", "mtllib no.mtl\n" + kTriangle + "f 1/1 2/2 3/3\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->info.warnings, Contains("m.obj: its file \"no.mtl\" is missing"));
}

TEST(Model, AModelWithNothingLeftIsAnErrorWithTheReason) {
  const TempDir folder;
  EXPECT_EQ(message_of(write_text(folder, "m.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
            "m.obj: holds no triangle that can be rendered; m.obj: mesh \"defaultobject\": 1 of 1 "
            "triangles have a vertex that is not a finite number and are left out");
  EXPECT_THAT(message_of(write_text(folder, "p.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n")),
              HasSubstr("points and lines are left out"));
}

TEST(Model, TheDefaultCameraShowsTheWholeModelAndTheModelFillsTheImage) {
  const TempDir folder;
  const auto imported = import_scene(
      write_text(folder, "box.obj",
                 "v -100 5 -1\nv 100 5 -1\nv 100 9 -1\nv -100 9 3\nf 1 2 3\nf 1 3 4\nf 1 2 4\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const RayGenerator rays(imported->scene.camera, 600, 400);
  const auto& camera = std::get<PerspectiveCamera>(imported->scene.camera);
  double left = 600;
  double right = 0;
  const Vec3 centre = rays.ray(300, 200, 0, 0).direction;
  const Vec3 across = rays.ray(301, 200, 0, 0).direction - rays.ray(299, 200, 0, 0).direction;
  for (const auto& p : imported->scene.geometry.meshes[0].positions) {
    const Vec3 to = Vec3{p[0], p[1], p[2]} - camera.position;
    ASSERT_GT(dot(to, centre), 0) << "all vertices must be in front of the camera";
    const Vec3 seen = to / dot(to, centre);
    // The column of the image in which the vertex is seen, in pixels.
    const double x = 300 + 2 * dot(seen, normalize(across)) / length(across);
    left = std::min(left, x);
    right = std::max(right, x);
  }
  // A margin of 3 % of the width, 600 pixels, remains at each side.
  EXPECT_NEAR(left, 18, 1);
  EXPECT_NEAR(right, 582, 1);
}

TEST(Model, IsPlacedByScaleThenRotationsThenTranslation) {
  const TempDir folder;
  write_text(folder, "m.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  const auto imported = import_scene(write_text(folder, "s.textproto", R"(
camera { position: [0, 1, 5] look_at: [0, 0, 0] }
material { name: "red" diffuse { } }
model {
  file: "m.obj" material: "red" scale: [2, 3, 4] translate: [10, 20, 30]
  rotate { axis: [0, 0, 1] degrees: 90 } rotate { axis: [1, 0, 0] degrees: 90 }
}
model { file: "m.obj" material: "red" scale: [2] })"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Geometry& geometry = imported->scene.geometry;
  ASSERT_EQ(geometry.meshes.size(), 1u) << "one file is read once";
  ASSERT_EQ(geometry.instances.size(), 2u);
  // (1, 0, 0) -> (2, 0, 0) -> (0, 2, 0) -> (0, 0, 2) -> (10, 20, 32).
  EXPECT_NEAR(length(geometry.instances[0].to_world.point({1, 0, 0}) - Vec3{10, 20, 32}), 0, 1e-14);
  EXPECT_EQ(geometry.instances[1].to_world, scaling({2, 2, 2}));
}

}  // namespace
}  // namespace bandsaw
