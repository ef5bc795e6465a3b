// The summary of a scene that `bandsaw info` prints.

#include "coordinator/cli/scene/scene_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

SceneDescription scene() {
  SceneDescription scene;
  scene.camera = OrthographicCamera{.position = {1, 2, 3}, .look_at = {1, 2, 0}, .height = 4};
  scene.textures = {ConstantTexture{{1, 1, 1}}};
  scene.materials = {Diffuse{TextureId{0}}, Emissive{TextureId{0}}, Diffuse{TextureId{0}}};
  Geometry& g = scene.geometry;
  g.spheres = {{{0, 0, 0}, 2, MaterialId{1}}};
  g.triangles = {{{0, 0, 0}, {9, 0, 0}, {0, 1, 0}, MaterialId{0}}};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  g.meshes = {mesh};
  g.instances = {{MeshId{0}, MaterialId{1}, translation({0, 0, 10})},
                 {MeshId{0}, MaterialId{2}, scaling({-7, 1, 1})}};
  return scene;
}

// A triangle and two instances of a mesh of two triangles are five triangles. The sphere and the
// two triangles of the first instance emit light. The bounds are those of the sphere of radius 2,
// except for -7 (the mirrored instance), 9 (the loose triangle) and 10 (the moved instance).
TEST(SceneSummary, CountsTheParts) {
  const SceneSummary summary = summary_of(scene(), {}, 1234);
  EXPECT_EQ(summary.triangles, 5u);
  EXPECT_EQ(summary.lights, 3u);
  EXPECT_EQ(summary.bounds.lo, (Vec3{-7, -2, -2}));
  EXPECT_EQ(summary.bounds.hi, (Vec3{9, 2, 10}));
  ASSERT_EQ(summary.materials.size(), 2u);
  EXPECT_EQ(summary.materials[0].what, "diffuse");
  EXPECT_EQ(summary.materials[0].count, 2u);
  EXPECT_EQ(summary.camera, "orthographic, 4 high, at [1, 2, 3], looking at [1, 2, 0]");
}

TEST(SceneSummary, NamesDeltaLightsBackgroundMediaAndCameras) {
  SceneDescription lit = scene();
  lit.lights = {SpotLight{}, PointLight{}, SpotLight{}, DirectionalLight{}};
  lit.media.media = {{.absorption = {1, 1, 1}}, {.scattering = {1, 2, 3}}, {.emission = {1, 0, 0}}};
  lit.media.boundaries.spheres = {{{0, 0, 0}, 1, filled_with(MediumId{1})}};
  lit.media.fog = MediumId{1};
  lit.background.environment = Environment{.images = {TextureId{1}}};
  ImageTexture image;
  image.width = 8;
  image.height = 4;
  lit.textures.emplace_back(image);
  PackageInfo info;
  info.model_cameras = {"front", "plan"};
  const SceneSummary summary = summary_of(lit, info, 0);
  const auto lines = summary_text(summary);
  EXPECT_THAT(lines, Contains(HasSubstr("without size: 2 × spot, 1 × point, 1 × directional")));
  EXPECT_THAT(lines, Contains(HasSubstr("equirectangular image of 8×4")));
  EXPECT_THAT(lines, Contains(HasSubstr("1 × absorbing medium, 1 × scattering medium, "
                                        "1 × glowing medium, 1 × boundary, 1 × fog")));
  EXPECT_THAT(lines, Contains(HasSubstr("front, plan (--camera NAME)")));
  EXPECT_THAT(summary_json(summary), HasSubstr("\"model_cameras\":[\"front\",\"plan\"]"));
}

TEST(SceneSummary, ReportsUnsupportedParts) {
  PackageInfo info;
  EXPECT_THAT(summary_text(summary_of(scene(), info, 0)), Contains(HasSubstr("nothing")));
  info.warnings = {"no bones"};
  const auto lines = summary_text(summary_of(scene(), info, 0));
  EXPECT_THAT(lines.back(), HasSubstr("no bones"));
  EXPECT_THAT(summary_json(summary_of(scene(), info, 0)), HasSubstr("\"warnings\":[\"no bones\"]"));
}

}  // namespace
}  // namespace bandsaw::coordinator
