// Scene files of the renderer pbrt-v4: how they are converted to scene files of bandsaw's format,
// what is left out with a warning, and what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/import.h"
#include "renderlib/import/pbrt/convert_pbrt.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::small_ppm;
using test::TempDir;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Writes `text` to the file s.pbrt in `dir`, and converts the file.
absl::StatusOr<ConvertedScene> convert(const TempDir& dir, const std::string& text) {
  const std::string path = write_text(dir, "s.pbrt", text);
  const auto folder = SceneFolder::of(path);
  if (!folder.ok()) {
    return folder.status();
  }
  return convert_pbrt({path, "s.pbrt", *folder});
}

/// Returns the scene file that is made of `text`.
scene::Scene scene_of(const std::string& text) {
  const TempDir dir;
  const auto converted = convert(dir, text);
  EXPECT_TRUE(converted.ok()) << converted.status();
  return converted.ok() ? converted->scene : scene::Scene();
}

/// Returns the message of the error for `text`, or "" if the conversion succeeds.
std::string error_of(const std::string& text) {
  const TempDir dir;
  return std::string(convert(dir, text).status().message());
}

/// Returns the warnings of the conversion of `text`.
std::vector<std::string> warnings_of(const std::string& text) {
  const TempDir dir;
  const auto converted = convert(dir, text);
  EXPECT_TRUE(converted.ok()) << converted.status();
  return converted.ok() ? converted->warnings : std::vector<std::string>();
}

// The axes of pbrt's camera are left-handed, and the axes of bandsaw's cameras are right-handed.
TEST(Pbrt, CamerasAreMirroredUnlessTheTransformFlipsThem) {
  const auto scene = scene_of(
      "LookAt 1 2 -5  1 2 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
      "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\n"
      "WorldBegin");
  EXPECT_THAT(scene.camera().position(), ElementsAre(1, 2, -5));
  EXPECT_NEAR(scene.camera().vertical_fov(), 40, 1e-9);
  EXPECT_TRUE(scene.camera().mirrored());
  EXPECT_EQ(scene.image().width(), 200u);
  const auto flipped = scene_of(
      "Scale -1 1 1\nLookAt 1 2 -5  1 2 0  0 1 0\nCamera \"perspective\"\n"
      "WorldBegin");
  EXPECT_FALSE(flipped.camera().mirrored());
}

TEST(Pbrt, TheFieldOfViewIsThatOfTheShorterSide) {
  const auto scene = scene_of(
      "Camera \"perspective\" \"float fov\" 90\n"
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 200\n"
      "WorldBegin");
  // The width of 100 pixels is seen under 90 degrees. The height is twice the width, so it is seen
  // under 2 atan(2), and atan(2) is 63.43 degrees.
  EXPECT_NEAR(scene.camera().vertical_fov(), 2 * 63.43494882292201, 1e-9);
}

TEST(Pbrt, ACropWindowBecomesTheWindowOfTheCamera) {
  const auto scene = scene_of(
      "Camera \"perspective\" \"float fov\" 90\nFilm \"rgb\" \"integer xresolution\" 100 "
      "\"integer yresolution\" 100 \"float cropwindow\" [0.5 1 0 0.25]\nWorldBegin");
  EXPECT_EQ(scene.image().width(), 50u);
  EXPECT_EQ(scene.image().height(), 25u);
  EXPECT_THAT(scene.camera().window(), ElementsAre(0, 1, 0.5, 1));
}

TEST(Pbrt, TransformsAreSavedAndRestored) {
  const auto scene = scene_of(
      "WorldBegin\nTranslate 1 0 0\nAttributeBegin Translate 0 2 0 Scale 3 3 3 Shape \"sphere\" "
      "AttributeEnd\nShape \"sphere\"");
  ASSERT_EQ(scene.shape_size(), 2);
  EXPECT_THAT(scene.shape(0).sphere().center(), ElementsAre(1, 2, 0));
  EXPECT_NEAR(scene.shape(0).sphere().radius(), 3, 1e-12);
  EXPECT_THAT(scene.shape(1).sphere().center(), ElementsAre(1, 0, 0));
}

TEST(Pbrt, AnImportedFileChangesNoTransformOrMaterialAfterIt) {
  const TempDir dir;
  write_text(dir, "part.pbrt",
             "Translate 100 0 0\nMaterial \"diffuse\" \"rgb reflectance\" [1 0 0]\n"
             "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n"
             "AttributeBegin\nTranslate 1 0 0\nShape \"sphere\" \"float radius\" 2");
  const auto converted = convert(dir,
                                 "WorldBegin\nTranslate 0 3 0\nImport \"part.pbrt\"\n"
                                 "Shape \"sphere\"\nNamedMaterial \"glass\"\nShape \"sphere\"");
  ASSERT_TRUE(converted.ok()) << converted.status();
  ASSERT_EQ(converted->scene.shape_size(), 3);
  EXPECT_THAT(converted->scene.shape(0).sphere().center(), ElementsAre(101, 3, 0));
  EXPECT_THAT(converted->scene.shape(1).sphere().center(), ElementsAre(0, 3, 0));
  EXPECT_EQ(converted->scene.shape(1).material(), "default");
  EXPECT_EQ(converted->scene.shape(2).material(), "glass");
  EXPECT_THAT(converted->warnings, ElementsAre("part.pbrt: 1 AttributeEnd is missing at the end"));
  write_text(dir, "part.pbrt", "AttributeEnd");
  EXPECT_THAT(
      std::string(
          convert(dir, "WorldBegin\nAttributeBegin\nImport \"part.pbrt\"").status().message()),
      HasSubstr("part.pbrt:1: AttributeEnd without AttributeBegin"));
}

TEST(Pbrt, IsoScalesAllLight) {
  const auto scene = scene_of(
      "Film \"rgb\" \"float iso\" 200\nWorldBegin\nLightSource \"point\" \"rgb I\" [1 2 3]\n"
      "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nAreaLightSource \"diffuse\" \"rgb L\" [1 "
      "1 1]"
      " \"float scale\" 5\nShape \"sphere\"");
  EXPECT_THAT(scene.light(0).point().intensity().rgb(), ElementsAre(2, 4, 6));
  ASSERT_EQ(scene.material_size(), 1);
  EXPECT_THAT(scene.material(0).emissive().radiance().rgb(), ElementsAre(10, 10, 10));
  EXPECT_TRUE(scene.material(0).emissive().one_sided());
}

TEST(Pbrt, AProjectedImageStandsUpright) {
  const TempDir dir;
  write_text(dir, "p.ppm", small_ppm());
  const auto projector = [&](const std::string& transform) {
    const auto converted =
        convert(dir, "WorldBegin\n" + transform +
                         "\nLightSource \"projection\" \"string filename\" \"p.ppm\"");
    EXPECT_TRUE(converted.ok()) << converted.status();
    return converted.ok() ? converted->scene.light(0).projector() : scene::ProjectorLight();
  };
  const auto plain = projector("");
  EXPECT_THAT(plain.look_at(), ElementsAre(0, 0, 1));
  EXPECT_THAT(plain.up(), ElementsAre(0, 1, 0));
  EXPECT_TRUE(plain.mirrored())
      << "the right of the image is +x, but without a mirror it would be cross(z, y) = -x";
  EXPECT_FALSE(projector("Scale -1 1 1").mirrored());
  const auto turned = projector("Scale 1 -1 1");
  EXPECT_THAT(turned.up(), ElementsAre(0, -1, 0));
  EXPECT_FALSE(turned.mirrored());
}

TEST(Pbrt, ABlackBodyHasLuminanceOne) {
  const auto scene = scene_of("WorldBegin\nLightSource \"point\" \"blackbody I\" 3000");
  const auto& rgb = scene.light(0).point().intensity().rgb();
  EXPECT_NEAR(0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.072175 * rgb[2], 1, 1e-9);
  EXPECT_GT(rgb[0], 2 * rgb[2]);
}

TEST(Pbrt, ASpectrumIsBlackOutsideOfItsWavelengths) {
  const TempDir dir;
  write_text(dir, "line.spd", "600 1\n610 1\n");
  const auto intensity = [&](const std::string& spectrum) {
    const auto converted =
        convert(dir, "WorldBegin\nLightSource \"point\" \"spectrum I\" " + spectrum);
    EXPECT_TRUE(converted.ok()) << converted.status();
    return converted.ok() ? converted->scene.light(0).point().intensity() : scene::Color();
  };
  for (const char* spectrum : {"[600 1 610 1]", "\"line.spd\""}) {
    const scene::Color color = intensity(spectrum);
    ASSERT_EQ(color.rgb_size(), 3) << spectrum;
    EXPECT_GT(color.rgb(0), 4) << spectrum;  // orange light of luminance 1
    EXPECT_LT(color.rgb(1), 0.2) << spectrum;
    EXPECT_EQ(color.rgb(2), 0) << spectrum;
  }
  // If the file of a spectrum is missing, the spectrum is white at all wavelengths.
  const scene::Color white = intensity("\"no.spd\"");
  ASSERT_EQ(white.rgb_size(), 3);
  EXPECT_NEAR(white.rgb(1), 0.95, 0.05);
}

TEST(Pbrt, RoughnessIsRemappedToAlpha) {
  const auto alpha = [](const std::string& parameters) {
    return scene_of("WorldBegin\nMaterial \"conductor\" " + parameters + "\nShape \"sphere\"")
        .material(0)
        .conductor()
        .surface()
        .alpha();
  };
  EXPECT_NEAR(alpha("\"float roughness\" 0.09"), 0.3, 1e-12);
  EXPECT_NEAR(alpha("\"float roughness\" 0.09 \"bool remaproughness\" false"), 0.09, 1e-12);
}

TEST(Pbrt, ACoatedConductorKeepsItsTexture) {
  const TempDir dir;
  write_text(dir, "p.ppm", small_ppm());
  const auto converted =
      convert(dir,
              "WorldBegin\nTexture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"p.ppm\"\n"
              "Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"p.ppm\"\n"
              "Material \"coatedconductor\" \"texture reflectance\" \"t\" \"bool remaproughness\" "
              "false \"texture conductor.roughness\" \"r\" \"float interface.roughness\" 0.25\n"
              "Shape \"sphere\"");
  ASSERT_TRUE(converted.ok()) << converted.status();
  ASSERT_EQ(converted->scene.material_size(), 1);
  const scene::Gltf& gltf = converted->scene.material(0).gltf();
  EXPECT_EQ(gltf.base_color_texture().use(), "t");
  EXPECT_FALSE(gltf.has_base_color());
  EXPECT_NEAR(gltf.roughness() * gltf.roughness(), 0.5, 1e-12);
  EXPECT_EQ(gltf.clearcoat_roughness(), 0.5);
  ASSERT_EQ(converted->warnings.size(), 2u);
  EXPECT_THAT(converted->warnings[0],
              HasSubstr("s.pbrt:4: the texture of the metal's roughness is left out"));
}

TEST(Pbrt, ObjectsAreGroups) {
  const auto scene = scene_of(
      "WorldBegin\nObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\nTranslate 1 2 3\n"
      "ObjectInstance \"o\"");
  ASSERT_EQ(scene.group_size(), 1);
  ASSERT_EQ(scene.instance_size(), 1);
  EXPECT_EQ(scene.shape_size(), 0);
  EXPECT_THAT(scene.instance(0).matrix(), ElementsAre(1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3));
}

TEST(Pbrt, MotionBecomesKeys) {
  const auto scene = scene_of(
      "WorldBegin\nActiveTransform EndTime\nTranslate 1 0 0\nActiveTransform All\nShape "
      "\"sphere\"");
  ASSERT_EQ(scene.instance_size(), 1);
  ASSERT_EQ(scene.instance(0).key_size(), 2);
  EXPECT_THAT(scene.instance(0).key(0).translate(), ElementsAre(0, 0, 0));
  EXPECT_THAT(scene.instance(0).key(1).translate(), ElementsAre(1, 0, 0));
  EXPECT_EQ(scene.camera().shutter_close(), 1);
}

TEST(Pbrt, AShearedShapeMovesAboutItsOrigin) {
  // A triangle with half a unit of shear at (5, 0, 0) turns by 90 degrees and moves up by 2.
  const auto scene = scene_of(
      "WorldBegin\nTranslate 5 0 0\nActiveTransform EndTime\nTranslate 0 2 0\nRotate 90 0 0 1\n"
      "ActiveTransform All\nConcatTransform [1 0 0 0  0.5 1 0 0  0 0 1 0  0 0 0 1]\n"
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0  1 0 0  0 1 0]");
  ASSERT_EQ(scene.group_size(), 1);
  ASSERT_EQ(scene.group(0).model_size(), 1);
  EXPECT_THAT(scene.group(0).model(0).matrix(), ElementsAre(1, 0.5, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0));
  ASSERT_EQ(scene.instance_size(), 1);
  ASSERT_EQ(scene.instance(0).key_size(), 2);
  EXPECT_THAT(scene.instance(0).key(0).translate(), ElementsAre(5, 0, 0));
  EXPECT_THAT(scene.instance(0).key(1).translate(), ElementsAre(5, 2, 0));
  EXPECT_NEAR(scene.instance(0).key(1).rotate(0).degrees(), 90, 1e-9);
}

TEST(Pbrt, AShapeWithAGrowingShearStandsStillWithAWarning) {
  const std::string text =
      "WorldBegin\nActiveTransform EndTime\n"
      "ConcatTransform [1 0 0 0  0.5 1 0 0  0 0 1 0  0 0 0 1]\nActiveTransform All\n"
      "Shape \"sphere\"";
  EXPECT_THAT(warnings_of(text), ElementsAre(HasSubstr("s.pbrt:5: the shape stands still")));
  EXPECT_EQ(scene_of(text).instance(0).key_size(), 0);
}

TEST(Pbrt, ACameraMoves) {
  const std::string text =
      "TransformTimes 2 4\nActiveTransform EndTime\nTranslate -3 0 0\nActiveTransform All\n"
      "Camera \"perspective\" \"float shutteropen\" 2 \"float shutterclose\" 4\nWorldBegin\n"
      "Shape \"sphere\"";
  EXPECT_THAT(warnings_of(text), ElementsAre());
  const auto scene = scene_of(text);
  EXPECT_THAT(scene.camera().position(), ElementsAre(0, 0, 0));
  EXPECT_EQ(scene.camera().shutter_close(), 4);
  ASSERT_EQ(scene.track_size(), 3);
  EXPECT_EQ(scene.track(0).field(), "camera.position");
  EXPECT_EQ(scene.track(0).key(0).time(), 2);
  EXPECT_THAT(scene.track(0).key(1).value(), ElementsAre(3, 0, 0));
  EXPECT_EQ(scene.track(1).field(), "camera.look_at");
  EXPECT_THAT(scene.track(1).key(0).value(), ElementsAre(0, 0, 3));
  EXPECT_THAT(scene.track(1).key(1).value(), ElementsAre(3, 0, 3));
  EXPECT_THAT(scene.track(2).key(1).value(), ElementsAre(0, 1, 0));
}

TEST(Pbrt, MicrofacetsUseHeightCorrelatedMasking) {
  const auto scene = scene_of(
      "WorldBegin\nMaterial \"dielectric\" \"float uroughness\" 0.04 \"float vroughness\" 0.09\n"
      "Shape \"sphere\"");
  const auto& surface = scene.material(0).dielectric().surface();
  EXPECT_EQ(surface.masking(), scene::Microfacets::MASKING_CORRELATED);
  EXPECT_NEAR(surface.alpha(), 0.2, 1e-12);
  EXPECT_NEAR(surface.alpha_v(), 0.3, 1e-12);
}

TEST(Pbrt, SpheresWhoseUvsMatterAreMeshes) {
  const TempDir dir;
  write_text(dir, "p.ppm", small_ppm());
  const auto shapes_and_models = [&](const std::string& text) {
    const auto converted = convert(
        dir,
        "WorldBegin\nTexture \"t\" \"float\" \"imagemap\" \"string filename\" \"p.ppm\"\n" + text);
    EXPECT_TRUE(converted.ok()) << converted.status();
    return converted.ok() ? std::pair(converted->scene.shape_size(), converted->scene.model_size())
                          : std::pair(-1, -1);
  };
  for (const char* text :
       {"Shape \"sphere\" \"texture alpha\" \"t\"", "Shape \"disk\" \"texture alpha\" \"t\"",
        "AreaLightSource \"diffuse\" \"string filename\" \"p.ppm\" Shape \"sphere\"",
        "AreaLightSource \"diffuse\" Shape \"sphere\" \"string emissionfilename\" \"p.ppm\"",
        "Material \"diffuse\" \"string normalmap\" \"p.ppm\" Shape \"sphere\"",
        "Material \"coatedconductor\" \"string normalmap\" \"p.ppm\" Shape \"sphere\"",
        "Material \"diffuse\" \"texture displacement\" \"t\" Shape \"sphere\"",
        "Material \"conductor\" \"float uroughness\" 0.5 \"float vroughness\" 0.1 "
        "Shape \"sphere\"",
        "Material \"dielectric\" \"float uroughness\" 0.5 \"float vroughness\" 0.1 "
        "Shape \"sphere\""}) {
    EXPECT_EQ(shapes_and_models(text), std::pair(0, 1)) << text;
  }
  for (const char* text :
       {"Shape \"sphere\" \"float alpha\" 0.5", "AreaLightSource \"diffuse\" Shape \"sphere\"",
        "Material \"conductor\" \"float roughness\" 0.5 Shape \"sphere\""}) {
    EXPECT_EQ(shapes_and_models(text), std::pair(1, 0)) << text;
  }
}

// Textures are clamped as in pbrt. Without the clamping, the scenes could not be rendered, because
// a reflectance must lie in [0, 1].
TEST(Pbrt, TexturesAboveOneAreClamped) {
  const std::string image = "\"imagemap\" \"string filename\" \"p.ppm\"";
  const std::string shape = "\nShape \"bilinearmesh\" \"point3 P\" [0 0 5 1 0 5 0 1 5 1 1 5]";
  for (const std::string& text :
       {"Texture \"a\" \"spectrum\" " + image + " \"float scale\" 2\n" +
            "Material \"diffuse\" \"texture reflectance\" \"a\"" + shape,
        "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [2 2 2]\n" +
            ("Material \"diffuse\" \"texture reflectance\" \"a\"" + shape),
        "Texture \"a\" \"float\" " + image + " \"float scale\" 2\n" +
            "Material \"conductor\" \"texture roughness\" \"a\"" + shape,
        "Texture \"a\" \"spectrum\" " + image + "\n" +
            "Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 2\n" +
            "Material \"coateddiffuse\" \"texture reflectance\" \"b\"" + shape,
        "Texture \"a\" \"float\" " + image + " \"float scale\" 3\n" +
            "MakeNamedMaterial \"x\" \"string type\" \"diffuse\"\n" +
            "MakeNamedMaterial \"y\" \"string type\" \"conductor\"\n" +
            "Material \"mix\" \"string materials\" [\"x\" \"y\"] \"texture amount\" \"a\"" + shape,
        "Texture \"a\" \"float\" " + image + " \"float scale\" 3" + shape +
            " \"texture alpha\" \"a\"",
        "Texture \"a\" \"spectrum\" " + image + "\n" +
            "Texture \"b\" \"spectrum\" \"mix\" \"texture tex1\" \"a\" \"rgb tex2\" [3 3 3]\n" +
            "Material \"diffuse\" \"texture reflectance\" \"b\"" + shape}) {
    const TempDir dir;
    write_text(dir, "p.ppm", small_ppm());
    const auto imported =
        import_scene(write_text(dir, "s.pbrt", "WorldBegin\nLightSource \"point\"\n" + text));
    EXPECT_TRUE(imported.ok()) << text << "\n" << imported.status();
  }
}

TEST(Pbrt, AClampedImageKeepsItsDarkParts) {
  const TempDir dir;
  // 55 and 188 are 0.0382 and 0.5029 in linear values.
  write_text(dir, "p.ppm", "P6 2 1 255\n\x37\x37\x37\xbc\xbc\xbc");
  const auto converted =
      convert(dir,
              "WorldBegin\nTexture \"a\" \"spectrum\" \"imagemap\" \"string filename\" \"p.ppm\" "
              "\"float scale\" 2\nMaterial \"diffuse\" \"texture reflectance\" \"a\"\n"
              "Shape \"sphere\"\nMaterial \"coateddiffuse\" \"texture reflectance\" \"a\"\n"
              "Shape \"sphere\"");
  ASSERT_TRUE(converted.ok()) << converted.status();
  EXPECT_THAT(converted->warnings, ElementsAre());
  ASSERT_EQ(converted->scene.texture_size(), 2)
      << "both materials must use the one limited texture";
  EXPECT_EQ(converted->scene.texture(1).image().file(), "s_files/limited_1.exr");
  ASSERT_EQ(converted->scene.material_size(), 2);
  const std::string& name = converted->scene.texture(1).name();
  EXPECT_EQ(converted->scene.material(0).diffuse().texture().use(), name);
  EXPECT_EQ(converted->scene.material(1).plastic().texture().use(), name);
  const auto limited = decode_picture(converted->made_files.at("s_files/limited_1.exr"));
  ASSERT_TRUE(limited.ok()) << limited.status();
  EXPECT_NEAR(limited->at(0, 0).g, 0.0764, 1e-3);
  EXPECT_EQ(limited->at(1, 0).g, 1);
}

TEST(Pbrt, ATextureThatCannotBeClampedIsScaledWithAWarning) {
  const std::string text =
      "WorldBegin\nTexture \"a\" \"spectrum\" \"mix\" \"rgb tex1\" [0 0 0] \"rgb tex2\" [4 4 "
      "4]\nMaterial \"diffuse\" \"texture reflectance\" \"a\"\nShape \"sphere\"";
  EXPECT_THAT(warnings_of(text), ElementsAre(HasSubstr("s.pbrt:3: a texture reaches 4;")));
  const auto scene = scene_of(text);
  ASSERT_EQ(scene.texture_size(), 2);
  EXPECT_NEAR(scene.texture(1).product().b().color().rgb(0), 0.25, 1e-6);
}

TEST(Pbrt, AFloatTextureReadsTheAlphaOfAnImageThatHasAlpha) {
  const TempDir dir;
  // Returns a TGA file of two white texels with these alphas. The bytes of a texel are blue, green,
  // red and alpha.
  const auto tga = [](const std::string& alphas) {
    std::string file("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\x20\x28", 18);
    for (const char alpha : alphas) {
      file += std::string("\xff\xff\xff") + alpha;
    }
    return file;
  };
  write_text(dir, "leaf.tga", tga(std::string("\0\x80", 2)));
  write_text(dir, "opaque.tga", tga("\xff\xff"));
  const auto converted =
      convert(dir,
              "WorldBegin\nTexture \"a\" \"float\" \"imagemap\" \"string filename\" \"leaf.tga\"\n"
              "Texture \"b\" \"float\" \"imagemap\" \"string filename\" \"opaque.tga\"\n"
              "Texture \"c\" \"spectrum\" \"imagemap\" \"string filename\" \"leaf.tga\"");
  ASSERT_TRUE(converted.ok()) << converted.status();
  ASSERT_EQ(converted->scene.texture_size(), 3);
  EXPECT_EQ(converted->scene.texture(0).image().file(), "s_files/alpha_1.png");
  EXPECT_EQ(converted->scene.texture(1).image().file(), "opaque.tga");
  EXPECT_EQ(converted->scene.texture(2).image().file(), "leaf.tga");
  std::vector<std::string> unused;
  const auto alpha = decode_image(converted->made_files.at("s_files/alpha_1.png"), unused);
  ASSERT_TRUE(alpha.ok()) << alpha.status();
  ASSERT_EQ(alpha->width, 2u);
  EXPECT_EQ(std::to_integer<int>(alpha->texels[0]), 0);
  EXPECT_EQ(std::to_integer<int>(alpha->texels[3]), 128);
}

TEST(Pbrt, FeaturesWithoutACounterpartAreNamed) {
  for (const char* type : {"nanovdb", "cloud", "rgbgrid"}) {
    const std::string text = "MakeNamedMedium \"m\" \"string type\" \"" + std::string(type) +
                             "\"\nWorldBegin\nMediumInterface \"m\" \"\"\n"
                             "Material \"interface\"\nShape \"sphere\"\nShape \"sphere\"";
    EXPECT_THAT(warnings_of(text), ElementsAre(HasSubstr("s.pbrt:1: the medium \"m\" of kind \"" +
                                                         std::string(type))));
  }
  EXPECT_THAT(warnings_of("Film \"rgb\" \"string sensor\" \"canon_eos_5d\"\nWorldBegin"),
              ElementsAre(HasSubstr("s.pbrt:1: the sensor \"canon_eos_5d\"")));
  EXPECT_THAT(warnings_of("Film \"rgb\" \"float whitebalance\" 5000\nWorldBegin"),
              ElementsAre(HasSubstr("s.pbrt:1: the white balance")));
}

TEST(Pbrt, UnknownNamesAndMissingFilesGiveWarningsWithTheirLines) {
  EXPECT_THAT(warnings_of("WorldBegin\n\nShape \"sphere\" \"float radios\" 2"),
              ElementsAre(HasSubstr("s.pbrt:3: the parameter \"float radios\"")));
  EXPECT_THAT(warnings_of("WorldBegin\nMaterial \"hair\"\nShape \"sphere\""),
              ElementsAre(HasSubstr("s.pbrt:2: the material \"hair\" has no counterpart")));
  EXPECT_THAT(warnings_of("WorldBegin\nShape \"plymesh\" \"string filename\" \"no.ply\""),
              ElementsAre(HasSubstr("s.pbrt:2: the file \"no.ply\" is missing")));
}

TEST(Pbrt, ErrorsNameTheLine) {
  EXPECT_THAT(error_of("WorldBegin\nShape \"sphere\" \"string radius\" \"x\""),
              HasSubstr("s.pbrt:2: \"string radius\" must be one float"));
  EXPECT_THAT(error_of("WorldBegin\nShape \"torus\""), HasSubstr("s.pbrt:2: "));
  EXPECT_THAT(error_of("WorldBegin\nShpae \"sphere\""),
              HasSubstr("s.pbrt:2: \"Shpae\" is no directive"));
  EXPECT_THAT(error_of("WorldBegin\nTranslate 1 nan 0"),
              HasSubstr("s.pbrt:2: numbers must be finite"));
  EXPECT_THAT(error_of("Shape \"sphere\""), HasSubstr("must come after WorldBegin"));
  EXPECT_THAT(
      error_of("WorldBegin\nShape \"trianglemesh\" \"integer indices\" [0 1 9] \"point3 P\" "
               "[0 0 0 1 0 0 0 1 0]"),
      HasSubstr("the index 9 must be a whole number below 3, the number of points"));
}

TEST(Pbrt, TruncatedScenesGiveAnErrorOrAWarning) {
  EXPECT_EQ(error_of("WorldBegin\nShape \"sphere\" \"float radius\" [ 1"),
            "s.pbrt:2: the list of values of \"float radius\" has no closing ]");
  EXPECT_EQ(error_of("WorldBegin\nShape \"sph"), "s.pbrt:2: the string has no end on its line");
  EXPECT_THAT(error_of("WorldBegin\nTranslate 1 2"), HasSubstr("s.pbrt:2: "));
  EXPECT_THAT(error_of("WorldBegin\nShape"), HasSubstr("s.pbrt:2: "));
  EXPECT_THAT(warnings_of("WorldBegin\nAttributeBegin\nShape \"sphere\""),
              ElementsAre(HasSubstr("1 AttributeEnd is missing at the end")));
}

TEST(Pbrt, TransformsMustBeFiniteAndRegular) {
  EXPECT_THAT(error_of("WorldBegin\nTransform [1 0 0 0 0 nan 0 0 0 0 1 0 0 0 0 1]"),
              HasSubstr("s.pbrt:2: numbers must be finite"));
  EXPECT_THAT(error_of("WorldBegin\nConcatTransform [1 0 0 0 0 inf 0 0 0 0 1 0 0 0 0 1]"),
              HasSubstr("s.pbrt:2: numbers must be finite"));
  EXPECT_THAT(error_of("WorldBegin\nScale 0 1 1\nShape \"sphere\""),
              HasSubstr("s.pbrt:3: the transformation of the shape is singular"));
  EXPECT_THAT(error_of("LookAt 0 0 0 0 0 0 0 1 0\nWorldBegin"),
              HasSubstr("LookAt needs a direction"));
}

TEST(Pbrt, CountsAreCheckedBeforeMemoryIsAllocated) {
  const std::string grid =
      "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"integer nx\" 4096 \"integer ny\" "
      "4096 \"integer nz\" 160 \"float density\" [1 2 3]\nWorldBegin\nMediumInterface \"m\" \"\"\n"
      "Material \"interface\" Shape \"sphere\"";
  EXPECT_THAT(error_of(grid), HasSubstr("must have nx x ny x nz = 2684354560 numbers, has 3"));
  const TempDir dir;
  write_text(dir, "a.ply",
             "ply\nformat binary_little_endian 1.0\nelement vertex 900000000\nproperty float x\n"
             "property float y\nproperty float z\nend_header\n1234");
  // The shape emits light. So the converter, not the importer, reads this file.
  EXPECT_THAT(
      std::string(convert(dir,
                          "WorldBegin\nAreaLightSource \"diffuse\"\nShape \"plymesh\" "
                          "\"string filename\" \"a.ply\"")
                      .status()
                      .message()),
      HasSubstr("s.pbrt:3: \"a.ply\": is damaged: it says that it has 900000000 of \"vertex\""));
}

// Attributes that are nested too deeply, cyclic includes, and files outside of the scene's folder
// are refused.
TEST(Pbrt, HostileScenesAreRefused) {
  std::string nested = "WorldBegin\n";
  for (int i = 0; i < 1'000'000; ++i) {
    nested += "AttributeBegin\n";
  }
  EXPECT_THAT(error_of(nested), HasSubstr("attributes within each other"));
  EXPECT_THAT(error_of("Include \"s.pbrt\""), HasSubstr("s.pbrt:1: \"s.pbrt\" includes itself"));
  const TempDir dir;
  write_text(dir, "b.pbrt", "WorldBegin\nInclude \"s.pbrt\"");
  EXPECT_THAT(std::string(convert(dir, "Include \"b.pbrt\"").status().message()),
              HasSubstr("b.pbrt:2: \"s.pbrt\" includes itself"));
  EXPECT_THAT(error_of("Include \"../x.pbrt\""), HasSubstr("outside of the scene's folder"));
  // The missing indices are reported before the number of levels is checked.
  EXPECT_THAT(error_of("WorldBegin\nShape \"loopsubdiv\" \"integer levels\" 100"),
              HasSubstr("s.pbrt:2: \"integer indices\" are missing"));
}

TEST(Pbrt, AMixOfAnUnknownMaterialIsAnError) {
  for (const char* names : {"\"a\" \"b\"", "\"b\" \"a\""}) {
    EXPECT_THAT(error_of(std::string("WorldBegin\nMakeNamedMaterial \"a\" \"string type\" "
                                     "\"interface\"\nMaterial \"mix\" \"string materials\" [") +
                         names + "]\nShape \"sphere\""),
                HasSubstr("no material is called \"b\""));
  }
}

TEST(Pbrt, MediaFillClosedShapes) {
  const auto scene = scene_of(
      "WorldBegin\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] "
      "\"rgb sigma_s\" [1 2 3] \"float scale\" 2\nMediumInterface \"fog\" \"\"\n"
      "Material \"interface\"\nShape \"sphere\"");
  ASSERT_EQ(scene.medium_size(), 1);
  EXPECT_THAT(scene.medium(0).scattering().rgb(), ElementsAre(2, 4, 6));
  EXPECT_EQ(scene.shape(0).interior(), "fog");
  EXPECT_EQ(scene.shape(0).material(), "");
}

TEST(Pbrt, TheBoxOfAMediumWithOpenSurfacesContainsMeshesThatStayFiles) {
  const TempDir dir;
  write_text(dir, "far.ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
             "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
             "end_header\n0 0 0\n50 0 0\n0 0 -40\n3 0 1 2\n");
  const auto converted =
      convert(dir,
              "WorldBegin\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
              "Shape \"plymesh\" \"string filename\" \"far.ply\"\nMediumInterface \"fog\" \"\"\n"
              "Material \"interface\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]");
  ASSERT_TRUE(converted.ok()) << converted.status();
  ASSERT_EQ(converted->scene.model_size(), 1);
  EXPECT_EQ(converted->scene.model(0).file(), "far.ply") << "the file must be used unchanged";
  ASSERT_EQ(converted->scene.shape_size(), 1);
  const scene::Box& box = converted->scene.shape(0).box();
  EXPECT_GT(box.max(0), 50);
  EXPECT_LT(box.min(2), -40);
}

TEST(Pbrt, AGridOfEmissionScalesIsLeftOutAndASingleScaleIsApplied) {
  const auto text = [](const std::string& scales) {
    return "WorldBegin\nMakeNamedMedium \"fire\" \"string type\" \"uniformgrid\" \"integer nx\" 2 "
           "\"integer ny\" 1 \"integer nz\" 1 \"float density\" [1 2] \"rgb Le\" [1 1 1] "
           "\"float Lescale\" [" +
           scales + "]\nMediumInterface \"fire\" \"\"\nMaterial \"interface\"\nShape \"sphere\"";
  };
  const auto emission = [&](const std::string& scales) {
    return scene_of(text(scales)).medium(0).emission().rgb(1);
  };
  EXPECT_THAT(warnings_of(text("1 3")), ElementsAre(HasSubstr("the grid Lescale is left out")));
  EXPECT_THAT(warnings_of(text("3")), ElementsAre());
  EXPECT_GT(emission("1 3"), 0);
  EXPECT_NEAR(emission("3") / emission("1 3"), 3, 1e-6);
}

// The mesh becomes a binary PLY file, in which the first byte of -0.0025 is a line break. Assimp
// skips a line break after the header, even if a number begins with this byte. The triangle must be
// read nevertheless.
TEST(Pbrt, ANumberMayBeginWithALineBreak) {
  const TempDir dir;
  const std::string path = write_text(
      dir, "s.pbrt",
      "WorldBegin\nLightSource \"point\"\nShape \"trianglemesh\" \"integer indices\" [0 1 2]"
      " \"point3 P\" [-0.0025 0 0 1 0 0 0 1 0]");
  const auto imported = import_scene(path);
  ASSERT_TRUE(imported.ok()) << imported.status();
  ASSERT_EQ(imported->scene.geometry.meshes.size(), 1u);
  EXPECT_EQ(imported->scene.geometry.meshes[0].triangles.size(), 1u);
}

}  // namespace
}  // namespace bandsaw
