// Media in scene files: valid ones are read, and errors state what is wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

/// Begins each scene file.
const std::string kHead = R"(camera { position: [0, 1, 5] look_at: [0, 0, 0] }
material { name: "glass" dielectric { } }
medium { name: "smoke" absorption { rgb: [1, 2, 3] } scattering { rgb: [4, 5, 6] } density: 0.5 }
medium { name: "milk" albedo { rgb: [1, 0.75, 0.5] } density: 8 anisotropy: 0.3
  emission { rgb: [0, 0, 1] } }
)";

/// OBJ text of a cube without its top. kLid adds the top.
const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\n";
const std::string kLid = "f 5 6 8 7\n";

/// Imports a scene file of kHead and `text`. The folder of the scene has the models closed.obj,
/// open.obj and turned.obj.
absl::StatusOr<ImportedScene> import_text(const std::string& text) {
  const TempDir folder;
  write_text(folder, "closed.obj", kCube + kLid);
  write_text(folder, "open.obj", kCube);
  // The normals of this mesh point inwards.
  write_text(folder, "turned.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\n"
             "f 2 4 3\n");
  return import_scene(write_text(folder, "s.textproto", kHead + text));
}

std::string message_of(const std::string& text) {
  return std::string(import_text(text).status().message());
}

TEST(MediaFile, ReadsMediaAndTheirBoundaries) {
  const auto imported = import_text(R"(
fog: "smoke"
shape { sphere { center: [1, 2, 3] radius: 2 } interior: "milk" }
shape { sphere { radius: 1 } material: "glass" interior: "smoke" }
shape { box { min: [1, 1, 1] max: [2, 4, 3] } interior: "milk" }
shape { box { min: [5, 1, 1] max: [6, 4, 3] } interior: "smoke" }
model { file: "closed.obj" interior: "milk" }
model { file: "closed.obj" interior: "smoke" translate: [9, 0, 0] boundary_only: true }
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Media& media = imported->scene.media;
  ASSERT_EQ(media.media.size(), 2u);
  EXPECT_EQ(media.media[0].absorption, (Rgb{0.5f, 1, 1.5f}));
  EXPECT_EQ(media.media[0].scattering, (Rgb{2, 2.5f, 3}));
  EXPECT_EQ(media.media[1].scattering, (Rgb{8, 6, 4}));
  EXPECT_EQ(media.media[1].absorption, (Rgb{0, 2, 4}));
  EXPECT_EQ(media.media[1].emission, (Rgb{0, 0, 8}));
  EXPECT_EQ(media.media[1].g, 0.3);
  EXPECT_EQ(media.fog, MediumId{0});
  // Only the glass ball and the model without boundary_only are part of the visible geometry.
  EXPECT_EQ(imported->scene.geometry.spheres.size(), 1u);
  EXPECT_EQ(imported->scene.geometry.quads.size(), 0u);
  EXPECT_EQ(imported->scene.geometry.instances.size(), 1u);
  const Geometry& boundaries = media.boundaries;
  ASSERT_EQ(boundaries.spheres.size(), 2u);
  EXPECT_EQ(boundaries.spheres[0].center, (Vec3{1, 2, 3}));
  EXPECT_EQ(medium_in(boundaries.spheres[0].material), MediumId{1});
  ASSERT_EQ(boundaries.instances.size(), 4u);  // two boxes and two models
  EXPECT_EQ(boundaries.instances[0].to_world.point({1, 1, 1}), (Vec3{2, 4, 3}));
  EXPECT_EQ(boundaries.meshes.size(), 2u);  // the cube of all boxes, and the file's mesh
}

TEST(MediaFile, ABoxWithAMaterialAndAnInteriorIsASurfaceAndABoundary) {
  const auto imported = import_text(
      R"(shape { box { min: [0, 0, 0] max: [1, 1, 1] } material: "glass" interior: "milk" })");
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->scene.geometry.quads.size(), 6u);
  EXPECT_EQ(imported->scene.media.boundaries.instances.size(), 1u);
}

// The triangles of the boundary are turned over. The triangles of the visible mesh stay as they
// are.
TEST(MediaFile, AMeshThatIsInsideOutIsInverted) {
  const auto imported = import_text(R"(model { file: "turned.obj" interior: "milk" })");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Mesh& mesh = imported->scene.media.boundaries.meshes.at(0);
  const Mesh& seen = imported->scene.geometry.meshes.at(0);
  EXPECT_EQ(mesh.triangles[0][1], seen.triangles[0][2]);
}

TEST(MediaFile, OpenShapesAreRefusedWithTheRemedy) {
  EXPECT_THAT(
      message_of(
          R"(shape { quad { corner: [0, 0, 0] u: [1, 0, 0] v: [0, 1, 0] } interior: "milk" })"),
      HasSubstr(
          "shape[0].interior: needs a closed shape, and this one encloses nothing: use a box, "
          "a sphere or a closed model"));
  EXPECT_THAT(message_of(R"(model { file: "open.obj" interior: "milk" })"),
              HasSubstr("model[0].interior: needs closed meshes; a mesh of 10 triangles has 4 open "
                        "edges: close its holes, or use a box or a sphere"));
}

TEST(MediaFile, ErrorsNameTheField) {
  EXPECT_THAT(message_of(R"(fog: "smog")"), HasSubstr("fog: no medium is called \"smog\""));
  EXPECT_THAT(
      message_of(R"(shape { sphere { radius: 1 } interior: "smok" })"),
      HasSubstr("shape[0].interior: no medium is called \"smok\"; did you mean \"smoke\"?"));
  EXPECT_THAT(message_of(R"(medium { density: 1 })"), HasSubstr("medium[2].name: is required"));
  EXPECT_THAT(message_of(R"(medium { name: "milk" })"),
              HasSubstr("medium[2].name: \"milk\" is the name of another medium"));
  EXPECT_THAT(message_of(R"(medium { name: "a" anisotropy: 1 })"),
              HasSubstr("medium[2].anisotropy: must lie in [-0.999, 0.999], is 1"));
  EXPECT_THAT(message_of(R"(medium { name: "a" density: -1 })"),
              HasSubstr("medium[2].density: must"));
  EXPECT_THAT(message_of(R"(medium { name: "a" albedo { rgb: [1, 1, 2] } })"),
              HasSubstr("medium[2].albedo.rgb[2]: must lie in [0, 1], is 2"));
  EXPECT_THAT(
      message_of(R"(medium { name: "a" albedo { rgb: [1, 1, 1] } scattering { rgb: [1, 1, 1] } })"),
      HasSubstr("medium[2].albedo: write albedo, or absorption and scattering, not both"));
  EXPECT_THAT(message_of(R"(medium { name: "a" absorption { rgb: [2, 2, 2] } density: 1e12 })"),
              HasSubstr("medium[2].absorption: must be at most"));
  EXPECT_THAT(message_of(R"(medium { name: "a" emission { rgb: [0, 1, 0] } } fog: "a")"),
              HasSubstr("fog: must absorb or scatter where it emits"));
  EXPECT_THAT(message_of(R"(model { file: "closed.obj" boundary_only: true })"),
              HasSubstr("model[0].boundary_only: needs an interior"));
  EXPECT_THAT(message_of(R"(shape { sphere { radius: 1 } })"),
              HasSubstr("shape[0].material: is required"));
}

}  // namespace
}  // namespace bandsaw
