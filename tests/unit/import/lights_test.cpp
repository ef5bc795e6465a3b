// Lights without size (directional, point, spot, projector) and environments of scene files, and
// the lights of models.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderlib/base/atomic_file.h"
#include "renderlib/base/file.h"
#include "renderlib/image/hdr.h"
#include "renderlib/image/png.h"
#include "renderlib/import/draft/environment_image.h"
#include "renderlib/import/import.h"
#include "tests/support/environments.h"
#include "tests/support/hard_case.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string kHead = R"(camera { position: [0, 1, 5] look_at: [0, 0, 0] }
material { name: "white" diffuse { } }
shape { sphere { radius: 1 } material: "white" }
)";

void write_hdr(const std::string& path, std::uint32_t width, std::uint32_t height,
               const Rgb& value) {
  Image image{width, height, {}};
  image.pixels.assign(std::size_t{width} * height, value);
  EXPECT_TRUE(write_file_atomically(path, encode_hdr(image)).ok());
}

/// A folder with environment maps.
class SceneLights : public ::testing::Test {
 protected:
  SceneLights() {
    write_hdr(folder_ / "sky.hdr", 8, 4, {1, 2, 4});
    for (const char* side : {"px", "nx", "py", "ny", "pz", "nz"}) {
      write_hdr(folder_ / (std::string(side) + ".hdr"), 4, 4, {1, 1, 1});
    }
    write_hdr(folder_ / "wide.hdr", 4, 3, {1, 1, 1});
  }
  absl::StatusOr<ImportedScene> read(const std::string& text) {
    return import_scene(write_text(folder_, "s.textproto", kHead + text));
  }
  std::string error(const std::string& text) { return std::string(read(text).status().message()); }
  TempDir folder_;
};

TEST_F(SceneLights, ReadsDirectionalPointAndSpotLights) {
  const auto imported = read(R"(
light { directional { direction: [0, -2, 0] irradiance { rgb: [1, 2, 3] } } }
light { point { position: [1, 2, 3] intensity { rgb: [4, 5, 6] } } }
light { spot { position: [0, 5, 0] look_at: [0, 1, 0] intensity { rgb: [1, 1, 1] } outer_angle: 60 } }
light { spot { position: [0, 5, 0] direction: [3, 0, 0] intensity { rgb: [1, 1, 1] } inner_angle: 20 } }
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& lights = imported->scene.lights;
  ASSERT_EQ(lights.size(), 4u);
  EXPECT_EQ(std::get<DirectionalLight>(lights[0]).direction, (Vec3{0, -1, 0}));
  EXPECT_EQ(std::get<DirectionalLight>(lights[0]).irradiance, (Rgb{1, 2, 3}));
  EXPECT_EQ(std::get<PointLight>(lights[1]).position, (Vec3{1, 2, 3}));
  const auto& spot = std::get<SpotLight>(lights[2]);
  EXPECT_EQ(spot.direction, (Vec3{0, -1, 0}));
  EXPECT_EQ(spot.cos_inner, 1);  // the default inner angle is 0, the default outer one 45 degrees
  EXPECT_NEAR(spot.cos_outer, 0.5, 1e-15);
  EXPECT_EQ(std::get<SpotLight>(lights[3]).direction, (Vec3{1, 0, 0}));
  EXPECT_NEAR(std::get<SpotLight>(lights[3]).cos_outer, std::sqrt(0.5), 1e-15);
  EXPECT_TRUE(is_black(imported->scene.background.top))
      << "a scene with lights must have no default sky";
}

TEST_F(SceneLights, ProjectImages) {
  const auto imported = read(R"(
light { projector { position: [0, 5, 0] look_at: [0, 1, 0] up: [0, 0, -1] vertical_fov: 90
        image { image { file: "sky.hdr" } } intensity { rgb: [1, 2, 3] } } }
light { projector { position: [0, 0, 5] look_at: [0, 0, 0] mirrored: true aspect: 3
        image { color { rgb: [1, 1, 1] } } } }
light { spot { position: [0, 0, 5] look_at: [0, 0, 0] intensity { rgb: [1, 1, 1] } outer_angle: 45
        falloff: FALLOFF_LINEAR_ANGLE image { image { file: "wide.hdr" } } } }
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& lights = imported->scene.lights;
  ASSERT_EQ(lights.size(), 3u);
  const auto& down = std::get<ProjectorLight>(lights[0]);
  EXPECT_EQ(down.direction, (Vec3{0, -1, 0}));
  EXPECT_EQ(down.image.right, (Vec3{1, 0, 0}));
  EXPECT_EQ(down.image.up, (Vec3{0, 0, -1}));
  EXPECT_EQ(down.intensity, (Rgb{1, 2, 3}));
  EXPECT_NEAR(down.image.half_height, 1, 1e-15);
  EXPECT_NEAR(down.image.half_width, 2, 1e-15) << "the aspect must be that of the image, 8 x 4";
  const auto& mirrored = std::get<ProjectorLight>(lights[1]);
  EXPECT_EQ(mirrored.image.right, (Vec3{-1, 0, 0}));
  EXPECT_NEAR(mirrored.image.half_width / mirrored.image.half_height, 3, 1e-15);
  const auto& spot = std::get<SpotLight>(lights[2]);
  EXPECT_EQ(spot.falloff, SpotLight::Falloff::kLinearAngle);
  ASSERT_TRUE(spot.image.has_value());
  EXPECT_NEAR(spot.image->half_width, 1, 1e-15);
}

TEST_F(SceneLights, ErrorsOfProjectedImagesNameTheField) {
  const std::string projector = "light { projector { position: [0, 0, 0] ";
  const std::string image = "image { color { rgb: [1, 1, 1] } } ";
  EXPECT_THAT(error(projector + image + "} }"), HasSubstr("projector.look_at: is required"));
  EXPECT_THAT(error(projector + "look_at: [1, 0, 0] } }"),
              HasSubstr("projector.image: is required"));
  EXPECT_THAT(error(projector + image + "look_at: [0, 1, 0] } }"),
              HasSubstr("projector.up: is [0, 1, 0] unless written"));
  EXPECT_THAT(error(projector + image + "look_at: [1, 0, 0] vertical_fov: 180 } }"),
              HasSubstr("vertical_fov: must lie in (0, 180) degrees, is 180"));
  EXPECT_THAT(error(projector + image + "look_at: [1, 0, 0] aspect: 0 } }"),
              HasSubstr("aspect: must lie in [0.001, 1000], is 0"));
  const std::string spot =
      "light { spot { position: [0, 0, 0] direction: [1, 0, 0] intensity { rgb: [1, 1, 1] } ";
  EXPECT_THAT(error(spot + "mirrored: true } }"),
              HasSubstr("mirrored: is only for a light with an image"));
  EXPECT_THAT(error(spot + image + "outer_angle: 90 } }"),
              HasSubstr("image: needs an outer_angle below 90"));
}

TEST_F(SceneLights, ErrorsNameTheField) {
  EXPECT_THAT(
      error("light { }"),
      StartsWith(
          "s.textproto:4:1: light[0]: is empty: write directional, point, spot or projector"));
  EXPECT_THAT(error("light { directional { irradiance { rgb: [1, 1, 1] } } }"),
              HasSubstr("light[0].directional.direction: is required"));
  EXPECT_THAT(error("light { point { position: [0, 0, 0] } }"),
              HasSubstr("light[0].point.intensity: is required, for example"));
  EXPECT_THAT(error("light { point { position: [0, 0, 0] intensity { rgb: [1, -1, 1] } } }"),
              HasSubstr("light[0].point.intensity.rgb[1]: must"));
  const std::string spot = "light { spot { position: [0, 0, 0] intensity { rgb: [1, 1, 1] } ";
  EXPECT_THAT(error(spot + "} }"), HasSubstr("one of direction, look_at is required"));
  EXPECT_THAT(error(spot + "look_at: [0, 0, 0] } }"), HasSubstr("must differ from position"));
  EXPECT_THAT(error(spot + "direction: [1, 0, 0] outer_angle: 91 } }"),
              HasSubstr("outer_angle: must be in (0, 90] degrees, is 91"));
  EXPECT_THAT(error(spot + "direction: [1, 0, 0] inner_angle: 50 } }"),
              HasSubstr("inner_angle: must lie in [0, 45], is 50"));
  std::string many;
  for (int i = 0; i < 9; ++i) {
    many += "light { directional { direction: [1, 0, 0] irradiance { rgb: [1, 1, 1] } } }\n";
  }
  EXPECT_THAT(error(many), HasSubstr("light[8].directional: is one more than the 8"));
}

TEST_F(SceneLights, AnEnvironmentIsALatitudeLongitudeImage) {
  const auto imported = read(R"(background { environment { file: "sky.hdr" strength: 0.5
    rotate { axis: [0, 1, 0] degrees: 90 } } })");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const SceneDescription& scene = imported->scene;
  ASSERT_TRUE(scene.background.environment.has_value());
  EXPECT_EQ(scene.background.environment->strength, 0.5f);
  EXPECT_EQ(scene.background.environment->axes.x, (Vec3{0, 0, -1})) << "+x is turned to -z";
  EXPECT_EQ(radiance(scene.background, scene.textures, {0, 0, 1}), (Rgb{0.5f, 1, 2}));
  EXPECT_THAT(imported->info.warnings, IsEmpty());
}

TEST_F(SceneLights, ACubeMapIsSixImages) {
  const std::string six =
      R"(positive_x: "px.hdr" negative_x: "nx.hdr" positive_y: "py.hdr" negative_y: "ny.hdr"
         positive_z: "pz.hdr" negative_z: "nz.hdr" )";
  const auto imported = read("background { cube_map { " + six + "} }");
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->scene.background.environment->images.size(), 6u);
  EXPECT_EQ(imported->scene.background.environment->axes.x, (Vec3{1, 0, 0}));
  const auto mirrored = read("background { cube_map { " + six + " left_handed: true } }");
  ASSERT_TRUE(mirrored.ok()) << mirrored.status();
  EXPECT_EQ(mirrored->scene.background.environment->axes.x, (Vec3{-1, 0, 0}));
  EXPECT_THAT(error(R"(background { cube_map { positive_x: "px.hdr" } })"),
              HasSubstr("background.cube_map.negative_x: is required"));
  EXPECT_THAT(error(R"(background { cube_map { positive_x: "px.hdr" negative_x: "wide.hdr" } })"),
              HasSubstr("negative_x: images of a cube map must be square and of one size; "
                        "\"wide.hdr\" is 4 x 3"));
}

TEST_F(SceneLights, ErrorsOfAnEnvironmentNameTheField) {
  EXPECT_THAT(error("background { environment { } }"),
              StartsWith("s.textproto:4:14: background.environment.file: is required"));
  EXPECT_THAT(error(R"(background { environment { file: "../sky.hdr" } })"),
              HasSubstr("background.environment.file: \"../sky.hdr\" lies outside"));
  EXPECT_THAT(error(R"(background { environment { file: "s.textproto" } })"),
              HasSubstr("s.textproto: is not an image"));
  EXPECT_THAT(error(R"(background { environment { file: "sky.hdr" strength: -1 } })"),
              HasSubstr("background.environment.strength: must lie in [0, 1e+06], is -1"));
}

TEST_F(SceneLights, AnEnvironmentThatIsGivenBesideTheSceneReplacesItsBackground) {
  const TempDir elsewhere;
  write_hdr(elsewhere / "given.hdr", 4, 2, {3, 3, 3});
  const auto bytes = read_whole_file(elsewhere / "given.hdr", 1 << 20);
  ASSERT_TRUE(bytes.ok());
  const std::string scene =
      write_text(folder_, "s.textproto", kHead + "background { constant { rgb: [1, 1, 1] } }");
  const auto imported = import_scene(scene, {.environment = GivenFile{"given.hdr", *bytes}});
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(radiance(imported->scene.background, imported->scene.textures, {0, 1, 0}),
            (Rgb{3, 3, 3}));
  EXPECT_THAT(
      std::string(
          import_scene(scene, {.environment = GivenFile{"x.hdr", "no image"}}).status().message()),
      HasSubstr("x.hdr: is not an image"));
}

// L9 is the id of a case in tests/hard_cases/cases.txt. Negative and NaN texels become 0, and
// infinite or too large texels become the largest valid value, which is 7 here.
TEST(RepairLight, L9InvalidTexelsAreRepairedAndCounted) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const float values[] = {1, -1, std::nanf(""), 7, kInf, 2e30f, -kInf, 0};
  ImageTexture image = test::float_image(8, 1, [&](auto x, auto) { return values[x]; });
  EXPECT_EQ(repair_light(image), 5u);
  const float expected[] = {1, 0, 0, 7, 7, 7, 0, 0};
  for (std::size_t i = 0; i < 8; ++i) {
    float value = 0;
    std::memcpy(&value, image.texels.data() + i * sizeof value, sizeof value);
    EXPECT_EQ(value, expected[i]) << i;
  }
  EXPECT_EQ(repair_light(image), 0u);
  ImageTexture bad = test::float_image(2, 2, [&](auto, auto) { return kInf; });
  EXPECT_EQ(repair_light(bad), 4u) << "all texels must be repaired, even if none is valid";
  test::report_hard_case("L9", "invalid texels are repaired and counted");
}

/// Returns a glTF file with one triangle and lights at three nodes, which are moved, rotated or
/// scaled.
std::string gltf_with_lights() {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [
  {"type": "directional", "color": [1, 0.5, 0.25], "intensity": 3, "name": "sun"},
  {"type": "point", "intensity": 40, "name": "bulb"},
  {"type": "spot", "intensity": 60, "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.6}}]}},
"nodes": [{"mesh": 0, "name": "t"},
  {"name": "a", "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
   "extensions": {"KHR_lights_punctual": {"light": 0}}},
  {"name": "b", "translation": [1, 2, 3], "scale": [2, 2, 2],
   "extensions": {"KHR_lights_punctual": {"light": 1}}},
  {"name": "c", "translation": [0, 5, 0], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476],
   "extensions": {"KHR_lights_punctual": {"light": 2}}}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
               "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
}

TEST(ModelLights, GltfLightsHaveTheirUnitsAndStandAtTheirNodes) {
  const TempDir folder;
  const auto imported = import_scene(write_text(folder, "m.gltf", gltf_with_lights()));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->info.warnings, IsEmpty());
  const auto& lights = imported->scene.lights;
  ASSERT_EQ(lights.size(), 3u);
  const auto& sun = std::get<DirectionalLight>(lights[0]);
  EXPECT_LE(length(sun.direction - Vec3{0, -1, 0}), 1e-6) << "glTF's lights look along -z";
  EXPECT_NEAR(sun.irradiance.g, 1.5, 1e-6);
  const auto& bulb = std::get<PointLight>(lights[1]);
  EXPECT_EQ(bulb.position, (Vec3{1, 2, 3}));
  EXPECT_EQ(bulb.intensity, (Rgb{40, 40, 40}))
      << "the scale of a node must not change the intensity";
  const auto& spot = std::get<SpotLight>(lights[2]);
  EXPECT_LE(length(spot.direction - Vec3{-1, 0, 0}), 1e-6);
  EXPECT_NEAR(spot.cos_inner, std::cos(0.3), 1e-6);
  EXPECT_NEAR(spot.cos_outer, std::cos(0.6), 1e-6);
  EXPECT_TRUE(is_black(imported->scene.background.top))
      << "a model with lights must have no default sky";
}

// The point light is at two nodes, which have the same name, "b". A third node of this name has a
// mesh.
TEST(ModelLights, ALightAtSeveralNodesEmitsFromEach) {
  const TempDir folder;
  std::string text = gltf_with_lights();
  const auto replace = [&](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  replace(R"({"light": 2})", R"({"light": 1})");
  replace(R"("name": "c")", R"("name": "b")");
  replace(R"("name": "t")", R"("name": "b")");
  const auto imported = import_scene(write_text(folder, "m.gltf", text));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& lights = imported->scene.lights;
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<DirectionalLight>(lights[0]));
  EXPECT_EQ(std::get<PointLight>(lights[1]).position, (Vec3{1, 2, 3}));
  EXPECT_EQ(std::get<PointLight>(lights[2]).position, (Vec3{0, 5, 0}));
}

TEST(ModelLights, RangesOfLightsAreLeftOutWithAWarning) {
  const TempDir folder;
  std::string text = gltf_with_lights();
  text.insert(text.find("\"intensity\": 40"), "\"range\": 7, ");
  const auto imported = import_scene(write_text(folder, "m.gltf", text));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->info.warnings,
              Contains(HasSubstr("the range of 1 light is left out: light reaches any distance")));
}

TEST(ModelLights, ArePlacedWithTheirModel) {
  const TempDir folder;
  write_text(folder, "m.gltf", gltf_with_lights());
  const auto imported = import_scene(write_text(folder, "s.textproto", R"(
camera { position: [0, 1, 5] look_at: [0, 0, 0] }
model { file: "m.gltf" translate: [10, 0, 0] scale: 3 rotate { axis: [0, 1, 0] degrees: 90 } })"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& bulb = std::get<PointLight>(imported->scene.lights.at(1));
  // The bulb at (1, 2, 3) is scaled to (3, 6, 9), rotated to (9, 6, -3), and then moved.
  EXPECT_LE(length(bulb.position - Vec3{19, 6, -3}), 1e-9);
  EXPECT_EQ(bulb.intensity, (Rgb{40, 40, 40}));
  const auto& spot = std::get<SpotLight>(imported->scene.lights.at(2));
  EXPECT_LE(length(spot.direction - Vec3{0, 0, 1}), 1e-6);
}

}  // namespace
}  // namespace bandsaw
