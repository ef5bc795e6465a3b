// Cameras of models, selected by the name of a node, by their own name, and by the name of their
// file.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "renderlib/base/file.h"
#include "renderlib/import/import.h"
#include "tests/unit/import/gltf_file.h"

namespace bandsaw {
namespace {

using test::GltfTriangle;
using test::TempDir;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Writes a glTF file with a triangle and four nodes with cameras, and returns its path. "left" and
/// "right" share one camera. The node "top" is a child of "tower". Assimp loads the camera of "top"
/// first.
std::string write_cameras(const TempDir& folder, const std::string& name) {
  GltfTriangle file;
  file.more = R"("cameras": [
{"name": "wide", "type": "perspective", "perspective": {"yfov": 1.0471975511965976, "znear": 0.1}},
{"name": "narrow", "type": "perspective", "perspective": {"yfov": 0.5235987755982988, "znear": 0.1}},
{"name": "far", "type": "perspective", "perspective": {"yfov": 0.2617993877991494, "znear": 0.1}}],
)";
  const std::string path = file.write(folder, name);
  std::string text = *read_whole_file(path, 1 << 20);
  const auto put = [&](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  put(R"("nodes": [0])", R"("nodes": [0, 1, 2, 3])");
  put(R"("nodes": [{"mesh": 0}])", R"("nodes": [{"mesh": 0},
{"name": "left", "camera": 0, "translation": [-1, 0, 3]},
{"name": "right", "camera": 0, "translation": [1, 0, 3]},
{"name": "tower", "camera": 1, "translation": [0, 5, 9], "children": [4]},
{"name": "top", "camera": 2, "translation": [0, 1, 0]}])");
  return write_text(folder, name, text);
}

/// Position and field of view of an imported camera.
struct Seen {
  Vec3 from;
  int degrees = 0;  ///< vertical field of view, rounded
  friend bool operator==(const Seen&, const Seen&) = default;
};
Seen seen(const ImportedScene& imported) {
  const auto& camera = std::get<PerspectiveCamera>(imported.scene.camera);
  return {camera.position, static_cast<int>(camera.vertical_fov + 0.5)};
}

class ModelCameraNames : public ::testing::Test {
 protected:
  ModelCameraNames() { write_cameras(folder_, "m.gltf"); }

  /// Returns the camera that `name` selects in `file`.
  Seen by(const std::string& name, const std::string& file = "m.gltf") {
    const auto imported = import_scene(folder_ / file, {.camera = name});
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? seen(*imported) : Seen{};
  }
  /// Imports `file` with the camera `name`, and returns the message of the error.
  std::string error(const std::string& name, const std::string& file = "m.gltf") {
    return std::string(import_scene(folder_ / file, {.camera = name}).status().message());
  }
  TempDir folder_;
};

TEST_F(ModelCameraNames, ACameraOfTwoNodesStandsAtBoth) {
  EXPECT_EQ(by("left"), (Seen{{-1, 0, 3}, 60}));
  EXPECT_EQ(by("right"), (Seen{{1, 0, 3}, 60}));
  EXPECT_EQ(by(""), (Seen{{-1, 0, 3}, 60}))
      << "without a name, the camera of the first node is used";
}

TEST_F(ModelCameraNames, ACameraIsSelectedByItsNameOrByTheNameOfItsNode) {
  EXPECT_EQ(by("tower"), (Seen{{0, 5, 9}, 30}));
  EXPECT_EQ(by("narrow"), by("tower"));
  EXPECT_EQ(by("far"), (Seen{{0, 6, 9}, 15}));
  EXPECT_EQ(by("m.gltf/top"), by("far"));
  EXPECT_THAT(error("wide"),
              HasSubstr("m.gltf: several cameras are called \"wide\"; there are \"left\", "
                        "\"right\", \"tower\", \"top\""));
}

TEST_F(ModelCameraNames, AnErrorListsTheExistingCameras) {
  EXPECT_THAT(error("back"), HasSubstr("m.gltf: no model has a camera called \"back\"; there "
                                       "are \"left\", \"right\", \"tower\", \"top\""));
  GltfTriangle().write(folder_, "none.gltf");
  EXPECT_THAT(error("back", "none.gltf"), HasSubstr("the scene's models have no camera"));
}

TEST_F(ModelCameraNames, AreListedByInfo) {
  const auto imported = import_scene(folder_ / "m.gltf");
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->info.model_cameras, ElementsAre("left", "right", "tower", "top"));
}

TEST_F(ModelCameraNames, TwoModelsOfASceneAreDistinguishedByTheirFiles) {
  write_cameras(folder_, "n.gltf");
  write_text(folder_, "s.textproto", R"(camera { position: [0, 0, 8] look_at: [0, 0, 0] }
model { file: "m.gltf" } model { file: "m.gltf" translate: [0, 0, 50] }
model { file: "n.gltf" translate: [100, 0, 0] })");
  EXPECT_EQ(by("n.gltf/left", "s.textproto"), (Seen{{99, 0, 3}, 60}));
  EXPECT_EQ(by("m.gltf/left", "s.textproto"), (Seen{{-1, 0, 3}, 60}))
      << "the camera of the first placement is used";
  EXPECT_THAT(error("left", "s.textproto"),
              HasSubstr("several cameras are called \"left\"; there are \"m.gltf/left\""));
}

TEST_F(ModelCameraNames, ASceneFileSetsTheWindowOfAModelsCameraAndMirrorsIt) {
  const auto used = [&](const std::string& fields) {
    return import_scene(
        write_text(folder_, "s.textproto",
                   "camera { use: \"left\" " + fields + " } model { file: \"m.gltf\" }"));
  };
  const auto plain = used("");
  ASSERT_TRUE(plain.ok()) << plain.status();
  EXPECT_FALSE(window_of(plain->scene.camera).has_value());
  EXPECT_FALSE(is_mirrored(plain->scene.camera));
  const auto shown = used("window: [0, 1, -0.5, 0.25] mirrored: true");
  ASSERT_TRUE(shown.ok()) << shown.status();
  EXPECT_EQ(seen(*shown), (Seen{{-1, 0, 3}, 60}));
  EXPECT_EQ(window_of(shown->scene.camera), (ImageWindow{0, 1, -0.5, 0.25}));
  EXPECT_TRUE(is_mirrored(shown->scene.camera));
  EXPECT_THAT(std::string(used("window: [0, 1]").status().message()),
              HasSubstr("camera.window: must be 4 numbers"));
}

/// Imports a COLLADA file with a triangle and a camera. `optics` is the XML of the camera's lens.
/// The camera is 5 units in front of the triangle. A unit is half a metre.
absl::StatusOr<ImportedScene> import_collada(const std::string& optics) {
  const TempDir folder;
  return import_scene(write_text(folder, "m.dae",
                                 R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="half" meter="0.5"/><up_axis>Y_UP</up_axis></asset>
<library_cameras><camera id="lens"><optics><technique_common>)" +
                                     optics + R"(
</technique_common></optics></camera></library_cameras>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0  1 0 0  0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
<node id="eye"><translate>0 0 5</translate><instance_camera url="#lens"/></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)"));
}

TEST(ColladaCameras, HaveTheVerticalAngleOfTheFile) {
  const auto degrees = [](const std::string& angles) {
    const auto imported = import_collada("<perspective>" + angles + "</perspective>");
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? std::get<PerspectiveCamera>(imported->scene.camera).vertical_fov : 0;
  };
  EXPECT_NEAR(degrees("<yfov>40</yfov>"), 40, 1e-9);
  EXPECT_NEAR(degrees("<xfov>60</xfov><yfov>40</yfov>"), 40, 1e-9);
  EXPECT_NEAR(degrees("<yfov>40</yfov><aspect_ratio>1.5</aspect_ratio>"), 40, 1e-9);
  EXPECT_NEAR(degrees("<xfov>60</xfov>"), 60, 1e-9);
  // tan 45 degrees / sqrt 3 is tan 30 degrees.
  EXPECT_NEAR(degrees("<xfov>90</xfov><aspect_ratio>1.7320508075688772</aspect_ratio>"), 60, 1e-9);
}

// In COLLADA, ymag is half of the height and xmag is half of the width of the view. A unit is half
// a metre, so the height in metres equals ymag, or xmag divided by the aspect ratio.
TEST(ColladaCameras, MayBeOrthographic) {
  const auto height = [](const std::string& sizes) {
    const auto imported = import_collada("<orthographic>" + sizes + "</orthographic>");
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? std::get<OrthographicCamera>(imported->scene.camera).height : 0;
  };
  EXPECT_NEAR(height("<xmag>6</xmag><aspect_ratio>1.5</aspect_ratio>"), 4, 1e-6);
  EXPECT_NEAR(height("<xmag>6</xmag><ymag>3</ymag>"), 3, 1e-6);
}

TEST(ColladaCameras, CamerasWithoutAValidLensAreLeftOut) {
  for (const std::string angle : {"", "<yfov>200</yfov>"}) {
    const auto imported = import_collada("<perspective>" + angle + "</perspective>");
    ASSERT_TRUE(imported.ok()) << imported.status();
    EXPECT_THAT(imported->info.model_cameras, ::testing::IsEmpty());
    EXPECT_THAT(imported->info.warnings,
                ::testing::Contains(HasSubstr("the camera \"eye\" is left out")));
  }
}

TEST_F(ModelCameraNames, AModelInAGroupHasNoCameras) {
  write_text(folder_, "s.textproto", R"(camera { position: [0, 0, 8] look_at: [0, 0, 0] }
group { name: "g" model { file: "m.gltf" } } instance { of: "g" })");
  EXPECT_THAT(error("left", "s.textproto"), HasSubstr("the scene's models have no camera"));
}

}  // namespace
}  // namespace bandsaw
