// Scene files as text or JSON: their fields are read, and each error names the place, the field and
// the range.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Imports a scene file with this text. The end of `name` tells the format.
absl::StatusOr<ImportedScene> import_text(const std::string& text,
                                          const std::string& name = "s.textproto") {
  const TempDir folder;
  return import_scene(write_text(folder, name, text));
}

const std::string kHead = R"(camera { position: [0, 1, 5] look_at: [0, 0, 0] }
material { name: "white" diffuse { color { rgb: [0.7, 0.7, 0.7] } } }
)";

TEST(SceneFile, ReadsCameraImageBackgroundMaterialsAndShapes) {
  const auto imported = import_text(R"(
camera { position: [1, 2, 3] look_at: [4, 5, 6] up: [0, 0, 1] vertical_fov: 30 }
image { width: 64 height: 32 }
integrator { max_depth: 5 }
background { gradient { bottom { rgb: [1, 0, 0] } top { rgb: [0, 0, 2] } } }
material { name: "a" diffuse { } }
material { name: "b" metal { fuzz: 0.25 } }
material { name: "c" dielectric { } }
material { name: "d" emissive { radiance { rgb: [1, 2, 3] } one_sided: true } }
shape { sphere { radius: 2 } material: "b" }
shape { quad { corner: [0, 0, 0] u: [1, 0, 0] v: [0, 1, 0] } material: "d" }
shape { triangle { a: [0, 0, 0] b: [1, 0, 0] c: [0, 1, 0] } material: "c" }
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const SceneDescription& scene = imported->scene;
  const auto& camera = std::get<PerspectiveCamera>(scene.camera);
  EXPECT_EQ(camera.look_at, (Vec3{4, 5, 6}));
  EXPECT_EQ(camera.up, (Vec3{0, 0, 1}));
  EXPECT_EQ(camera.vertical_fov, 30);
  EXPECT_EQ(imported->info.name, "s");
  EXPECT_EQ(imported->info.width, 64u);
  EXPECT_EQ(imported->info.height, 32u);
  EXPECT_EQ(imported->info.max_depth, 5u);
  EXPECT_EQ(scene.background.bottom, (Rgb{1, 0, 0}));
  EXPECT_EQ(scene.background.top, (Rgb{0, 0, 2}));
  ASSERT_EQ(scene.geometry.spheres.size(), 1u);
  EXPECT_EQ(scene.geometry.spheres[0].center, (Vec3{0, 0, 0}));
  const auto& metal =
      std::get<Metal>(scene.materials[index_of(scene.geometry.spheres[0].material)].kind);
  EXPECT_EQ(metal.fuzz, 0.25);
  const auto& lamp =
      std::get<Emissive>(scene.materials[index_of(scene.geometry.quads[0].material)].kind);
  EXPECT_TRUE(lamp.one_sided);
  EXPECT_EQ(std::get<ConstantTexture>(scene.textures[index_of(lamp.radiance)]).value,
            (Rgb{1, 2, 3}));
  EXPECT_EQ(
      std::get<Dielectric>(scene.materials[index_of(scene.geometry.triangles[0].material)].kind)
          .index_of_refraction,
      1.5);
}

TEST(SceneFile, ReadsTheCamera) {
  const auto lens = import_text(R"(camera { position: [0, 0, 5] look_at: [0, 0, 1] aperture: 0.5 }
image { filter { gaussian { } } })");
  ASSERT_TRUE(lens.ok()) << lens.status();
  EXPECT_EQ(std::get<PerspectiveCamera>(lens->scene.camera).aperture, 0.5);
  EXPECT_EQ(std::get<PerspectiveCamera>(lens->scene.camera).focus_distance, 4);
  EXPECT_EQ(lens->scene.filter, (PixelFilter{PixelFilter::Kind::kGaussian, 1.5}));

  const auto study = import_text(R"(camera {
  position: [250, 250, 0] rotate { axis: [0, 0, 1] degrees: 0 } orthographic { height: 500 } }
image { filter { box { radius: 0 } } })");
  ASSERT_TRUE(study.ok()) << study.status();
  // A pixel is one unit wide. Pixels are counted from the top left, and the view is centred at
  // (250, 250).
  const RayGenerator rays(study->scene.camera, 500, 500);
  EXPECT_EQ(rays.ray(3.5, 7.5, 0, 0).origin, (Vec3{3.5, 492.5, 0}));
  EXPECT_EQ(rays.ray(3.5, 7.5, 0, 0).direction, (Vec3{0, 0, -1}));
  EXPECT_EQ(study->scene.filter, (PixelFilter{PixelFilter::Kind::kBox, 0}));

  const auto turned = import_text(R"(camera {
  position: [1, 2, 3] rotate { axis: [0, 1, 0] degrees: 90 } rotate { axis: [0, 0, 1] degrees: 90 } })");
  ASSERT_TRUE(turned.ok()) << turned.status();
  // The first rotation turns the view to -x, with y up. The second one turns -x to -y and y to -x.
  const View view = view_of(turned->scene.camera);
  EXPECT_EQ(normalize(view.look_at - view.position), (Vec3{0, -1, 0}));
  EXPECT_EQ(view.up, (Vec3{-1, 0, 0}));
}

TEST(SceneFile, ReadsIntegratorAndDisplaySettings) {
  const auto scene = import_text(kHead + R"(image { exposure: -1.5 tone: TONE_FILMIC }
integrator { kind: KIND_DIRECT ambient { rgb: [0.1, 0.2, 0.3] } occlusion_distance: 2 })");
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ(scene->info.integrator, Integrator::kDirect);
  EXPECT_EQ(scene->info.display, (Display{.exposure = -1.5, .tone = Tone::kFilmic}));
  EXPECT_EQ(scene->scene.local_shading.ambient, (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(scene->scene.local_shading.occlusion_distance, 2);
  const auto message = [](const std::string& text) {
    return std::string(import_text(kHead + text).status().message());
  };
  EXPECT_THAT(message("image { exposure: 40 }"),
              HasSubstr("image.exposure: must lie in [-30, 30]"));
  EXPECT_THAT(message("integrator { occlusion_distance: 0 }"),
              HasSubstr("integrator.occlusion_distance: must be > 0, is 0"));
  EXPECT_THAT(message("integrator { ambient { rgb: [-1, 0, 0] } }"),
              HasSubstr("integrator.ambient.rgb"));
}

TEST(SceneFile, IsTheSameInJson) {
  const auto text = import_text(kHead + R"(shape { sphere { radius: 2 } material: "white" })");
  const auto json = import_text(R"({
    "camera": {"position": [0, 1, 5], "look_at": [0, 0, 0]},
    "material": [{"name": "white", "diffuse": {"color": {"rgb": [0.7, 0.7, 0.7]}}}],
    "shape": [{"sphere": {"radius": 2}, "material": "white"}]})",
                                "s.json");
  ASSERT_TRUE(text.ok()) << text.status();
  ASSERT_TRUE(json.ok()) << json.status();
  BlobMap text_blobs;
  BlobMap json_blobs;
  EXPECT_EQ(encode_package(text->scene, text->info, text_blobs),
            encode_package(json->scene, json->info, json_blobs));
}

TEST(SceneFile, HasADefaultBackgroundUnlessItHasLights) {
  const auto lit =
      import_text(kHead + R"(material { name: "lamp" emissive { radiance { rgb: [1, 1, 1] } } })");
  ASSERT_TRUE(lit.ok()) << lit.status();
  EXPECT_TRUE(is_black(lit->scene.background.top));
  const auto unlit = import_text(kHead);
  ASSERT_TRUE(unlit.ok()) << unlit.status();
  EXPECT_FALSE(is_black(unlit->scene.background.top));
}

/// A scene with a mistake, and the beginning of the message of its error.
struct Wrong {
  std::string name;
  std::string text;  ///< after kHead, which has two lines
  std::string message;
  friend void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }
};

class WrongScene : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongScene, ErrorsNamePlaceFieldAndRange) {
  const auto imported = import_text(kHead + GetParam().text);
  ASSERT_EQ(imported.status().code(), absl::StatusCode::kInvalidArgument) << imported.status();
  EXPECT_THAT(std::string(imported.status().message()), StartsWith(GetParam().message));
}

const std::vector<Wrong> kWrong = {
    {"unknown_field", R"(shape { sphere { radus: 2 } })",
     "s.textproto:3:18: unknown field \"radus\" in Sphere; did you mean \"radius\"? (its fields: "
     "center, radius)"},
    {"wrong_type", R"(image { width: "big" })", "s.textproto:3:16: Expected integer, got: \"big\""},
    {"negative_size", R"(image { width: -5 })", "s.textproto:3:16: "},
    {"not_closed", R"(shape { sphere { radius: 2 }
)",
     "s.textproto:4:1: "},
    {"two_kinds", R"(shape { sphere { radius: 2 } quad { } })",
     "s.textproto:3:35: Field \"quad\" is specified along with field \"sphere\""},
    {"no_radius", R"(shape { material: "white" sphere { } })",
     "s.textproto:3:27: shape[0].sphere.radius: is required and must be > 0"},
    {"negative_radius", R"(shape { material: "white" sphere { radius: -1 } })",
     "s.textproto:3:36: shape[0].sphere.radius: must be finite and > 0, is -1"},
    {"zero_radius", R"(shape { material: "white" sphere { radius: 0 } })",
     "s.textproto:3:36: shape[0].sphere.radius: must be finite and > 0, is 0"},
    {"nan", R"(shape { material: "white" sphere { radius: 1 center: [0, nan, 0] } })",
     "s.textproto:3:46: shape[0].sphere.center[1]: must be finite, at most 1e30, is nan"},
    {"inf", R"(shape { material: "white" sphere { radius: inf } })",
     "s.textproto:3:36: shape[0].sphere.radius: must be finite and > 0, is inf"},
    {"short_list", R"(shape { material: "white" sphere { radius: 1 center: [0, 1] } })",
     "s.textproto:3:46: shape[0].sphere.center: must be a list of 3 numbers, has 2"},
    {"no_material", R"(shape { sphere { radius: 1 } })",
     "s.textproto:3:1: shape[0].material: is required: the name of a material"},
    {"unknown_material", R"(shape { sphere { radius: 1 } material: "wite" })",
     "s.textproto:3:30: shape[0].material: no material is called \"wite\"; did you mean "
     "\"white\"?"},
    {"no_kind", R"(shape { material: "white" })",
     "s.textproto:3:1: shape[0]: has no kind: write sphere, quad, triangle, box or disk"},
    {"flat_quad",
     R"(shape { material: "white" quad { corner: [0, 0, 0] u: [1, 0, 0] v: [-2, 0, 0] } })",
     "s.textproto:3:65: shape[0].quad.v: must not be parallel to u"},
    {"no_corner", R"(shape { material: "white" quad { u: [1, 0, 0] v: [0, 1, 0] } })",
     "s.textproto:3:27: shape[0].quad.corner: is required: a list of three numbers"},
    {"twin_materials", R"(material { name: "white" metal { } })",
     "s.textproto:3:12: material[1].name: \"white\" is the name of another material"},
    {"nameless_material", R"(material { metal { } })",
     "s.textproto:3:1: material[1].name: is required"},
    {"kindless_material", R"(material { name: "x" })",
     "s.textproto:3:1: material[1]: has no kind: write diffuse, metal, plastic, "
     "dielectric, emissive, gltf or another kind"},
    {"reflectance", R"(material { name: "x" diffuse { color { rgb: [0.5, 1.7, 0] } } })",
     "s.textproto:3:40: material[1].diffuse.color.rgb[1]: must lie in [0, 1], is 1.7"},
    {"two_colors", R"(material { name: "x" diffuse { color { rgb: [0, 0, 0] } texture { } } })",
     "s.textproto:3:32: material[1].diffuse.color: write texture or color, not both"},
    {"fuzz", R"(material { name: "x" metal { fuzz: 1.5 } })",
     "s.textproto:3:30: material[1].metal.fuzz: must lie in [0, 1], is 1.5"},
    {"index", R"(material { name: "x" dielectric { index_of_refraction: 0 } })",
     "s.textproto:3:35: material[1].dielectric.index_of_refraction: must lie in [1, 5], is 0"},
    {"dark_lamp", R"(material { name: "x" emissive { } })",
     "s.textproto:3:22: material[1].emissive.radiance: is required"},
    {"negative_lamp", R"(material { name: "x" emissive { radiance { rgb: [1, 1, -1] } } })",
     "s.textproto:3:44: material[1].emissive.radiance.rgb[2]: must be finite and >= 0, is -1"},
    {"missing_texture",
     R"(material { name: "x" diffuse { texture { image { file: "no.png" } } } })",
     "s.textproto:3:50: material[1].diffuse.texture.image.file: \"no.png\" is missing (looked "
     "for "},
    {"escaping_texture",
     R"(material { name: "x" diffuse { texture { image { file: "../no.png" } } } })",
     "s.textproto:3:50: material[1].diffuse.texture.image.file: \"../no.png\" lies outside of the "
     "scene's folder"},
    {"absolute_texture",
     R"(material { name: "x" diffuse { texture { image { file: "/etc/passwd" } } } })",
     "s.textproto:3:50: material[1].diffuse.texture.image.file: \"/etc/passwd\" is an absolute "
     "path"},
    {"not_an_image",
     R"(material { name: "x" diffuse { texture { image { file: "s.textproto" } } } })",
     "s.textproto:3:50: material[1].diffuse.texture.image.file: s.textproto: is not an image"},
    {"depth", R"(integrator { max_depth: 0 })",
     "s.textproto:3:14: integrator.max_depth: must lie in [1, 1024], is 0"},
    {"size", R"(image { width: 70000 })",
     "s.textproto:3:9: image.width: must lie in [1, 65536], is 70000"},
    {"pixels", R"(image { width: 65536 height: 65536 })",
     "s.textproto:3:1: image: has 4294967296 pixels, at most 64000000 are allowed"},
    {"empty_background", R"(background { })",
     "s.textproto:3:1: background: is empty: write constant, gradient, environment or cube_map"},
    {"half_gradient", R"(background { gradient { top { rgb: [1, 1, 1] } } })",
     "s.textproto:3:14: background.gradient: needs bottom and top"},
    {"no_model_file", R"(model { })", "s.textproto:3:1: model[0].file: is required"},
    {"missing_model", R"(model { file: "duck.glb" })",
     "s.textproto:3:9: model[0].file: \"duck.glb\" is missing"},
    {"strange_model", R"(model { file: "s.textproto" })",
     "s.textproto:3:9: model[0].file: \"s.textproto\" is not a model that is read"},
    {"flat_model", R"(model { file: "x.obj" scale: [1, 0, 1] })",
     "s.textproto:3:23: model[0].scale[1]: must be finite and not zero, is 0"},
    {"two_scales", R"(model { file: "x.obj" scale: [1, 2] })",
     "s.textproto:3:23: model[0].scale: must be 1 or 3 numbers, has 2"},
    {"no_axis", R"(model { file: "x.obj" rotate { degrees: 3 } })",
     "s.textproto:3:23: model[0].rotate[0].axis: is required"},
    {"model_material", R"(model { file: "x.obj" material: "red" })",
     "s.textproto:3:23: model[0].material: no material is called \"red\""},
};

INSTANTIATE_TEST_SUITE_P(All, WrongScene, ::testing::ValuesIn(kWrong),
                         [](const auto& wrong) { return wrong.param.name; });

TEST(SceneFile, ACameraThatCannotMakeRaysIsRefused) {
  const auto message = [](const std::string& text) {
    return std::string(import_text(text).status().message());
  };
  EXPECT_THAT(message(""), StartsWith("s.textproto: camera: is required"));
  EXPECT_THAT(message("camera { }"), StartsWith("s.textproto:1:1: camera.look_at: is required"));
  EXPECT_THAT(message("camera { look_at: [0, 0, 0] }"),
              StartsWith("s.textproto:1:10: camera.look_at: must differ from position"));
  EXPECT_THAT(message("camera { look_at: [0, 3, 0] }"),
              StartsWith("s.textproto:1:1: camera.up: is [0, 1, 0] unless written"));
  EXPECT_THAT(message("camera { look_at: [0, 0, 1] vertical_fov: 180 }"),
              StartsWith("s.textproto:1:29: camera.vertical_fov: must lie in (0, 180) degrees"));
}

TEST(SceneFile, ErrorsNameTheFieldOfLensFilterOrRotation) {
  const auto message = [](const std::string& in_camera, const std::string& image = "") {
    return std::string(import_text("camera { " + in_camera + " }\n" + image).status().message());
  };
  EXPECT_THAT(message("look_at: [0, 0, -1] aperture: -1"),
              StartsWith("s.textproto:1:30: camera.aperture: must lie"));
  EXPECT_THAT(message("look_at: [0, 0, -1] focus_distance: 0"),
              HasSubstr("camera.focus_distance: must lie"));
  EXPECT_THAT(message("look_at: [0, 0, -1] orthographic { }"),
              HasSubstr("camera.orthographic.height: is required"));
  EXPECT_THAT(message("look_at: [0, 0, -1] vertical_fov: 3 orthographic { height: 1 }"),
              HasSubstr("camera.vertical_fov: is of a perspective camera"));
  EXPECT_THAT(message("look_at: [0, 0, -1] rotate { axis: [0, 1, 0] }"),
              HasSubstr("camera.rotate: write rotate, or look_at and up, not both"));
  EXPECT_THAT(message("rotate { degrees: 3 }"), HasSubstr("camera.rotate[0].axis: is required"));
  EXPECT_THAT(message("rotate { axis: [0, 1, 0] } aperture: 1"),
              HasSubstr("camera.focus_distance: is required"));
  EXPECT_THAT(message("look_at: [0, 0, -1]", "image { filter { tent { radius: 99 } } }"),
              HasSubstr("image.filter.tent.radius: must lie in [0, 16], is 99"));
  EXPECT_THAT(message("look_at: [0, 0, -1]", "image { filter { } }"),
              HasSubstr("image.filter: is empty: write box, tent or gaussian"));
}

TEST(SceneFile, ErrorsInJsonNameTheField) {
  const auto message = [](const std::string& text) {
    return std::string(import_text(text, "s.json").status().message());
  };
  EXPECT_THAT(message("{\"camera\": {\n  \"position\" [0, 0, 0]}}"), StartsWith("s.json:2:14: "));
  EXPECT_THAT(message(R"({"camera": {"postion": [0, 0, 0]}})"), HasSubstr("postion"));
  EXPECT_THAT(message(R"({"camera": {"look_at": [0, 0]}})"),
              StartsWith("s.json: camera.look_at: must be a list of 3 numbers, has 2"));
}

TEST(SceneFile, CannotReadOutsideItsFolderThroughALink) {
  const TempDir outside;
  const TempDir folder;
  write_text(outside, "secret.ppm", test::small_ppm());
  ASSERT_EQ(symlink((outside / "secret.ppm").c_str(), (folder / "link.ppm").c_str()), 0);
  const std::string path = write_text(
      folder, "s.textproto",
      kHead + R"(material { name: "x" diffuse { texture { image { file: "link.ppm" } } } })");
  EXPECT_THAT(std::string(import_scene(path).status().message()),
              HasSubstr("\"link.ppm\" lies outside of the scene's folder"));
}

TEST(SceneFile, UsesOfOneImageFileShareItsTexels) {
  const TempDir folder;
  write_text(folder, "small.ppm", test::small_ppm());
  const auto imported = import_scene(write_text(folder, "s.textproto", kHead + R"(
material { name: "a" diffuse { texture { image { file: "small.ppm" } } } }
material { name: "b" diffuse { texture { image { file: "./small.ppm" } } } }
material { name: "c" diffuse { texture { image { file: "small.ppm" wrap: WRAP_CLAMP filter: FILTER_NEAREST } } } })"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  // Texture 0 is the colour of kHead. The materials "a" and "b" share texture 1, and "c" has
  // texture 2.
  ASSERT_EQ(imported->scene.textures.size(), 3u);
  const auto& first = std::get<ImageTexture>(imported->scene.textures[1]);
  const auto& last = std::get<ImageTexture>(imported->scene.textures[2]);
  EXPECT_EQ(first.texels, last.texels);
  EXPECT_EQ(first.wrap, ImageTexture::Wrap::kRepeat);
  EXPECT_EQ(last.wrap, ImageTexture::Wrap::kClamp);
  EXPECT_EQ(last.filter, ImageTexture::Filter::kNearest);
}

TEST(SceneFile, RefusesUnknownFormatsAndMissingFiles) {
  EXPECT_THAT(std::string(import_text("", "scene.max").status().message()),
              StartsWith("scene.max: is of a kind that is not read"));
  EXPECT_EQ(import_scene("/no/such/scene.textproto").status().code(), absl::StatusCode::kNotFound);
}

class Gallery : public ::testing::TestWithParam<std::string> {};

TEST_P(Gallery, IsImportedWithoutAWarning) {
  const auto imported = import_scene(std::string(BANDSAW_GALLERY) + "/" + GetParam());
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->info.warnings, ::testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(All, Gallery,
                         ::testing::Values("cornell.textproto", "spheres.textproto",
                                           "glass_and_metal.textproto", "textured.textproto",
                                           "mesh.textproto", "defocus.textproto",
                                           "orthographic.textproto"));

}  // namespace
}  // namespace bandsaw
