// Scene files of the renderer Mitsuba (XML): how they are converted to this renderer's own
// scene files, what is left out with a warning, and what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "renderlib/image/write_image.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/import.h"
#include "renderlib/import/mitsuba/convert_mitsuba.h"
#include "renderlib/import/mitsuba/spectra.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string kSensor = R"(<sensor type="perspective"/>
)";

class MitsubaScene : public ::testing::Test {
 protected:
  /// Converts a scene with the given content. The sensor is in line 2 of the file.
  absl::StatusOr<ConvertedScene> convert(const std::string& content,
                                         std::map<std::string, std::string> parameters = {}) {
    return convert_file("<scene version=\"3.0.0\">\n" + kSensor + content + "\n</scene>\n",
                        std::move(parameters));
  }
  /// Converts a scene file with this text.
  absl::StatusOr<ConvertedScene> convert_file(const std::string& text,
                                              std::map<std::string, std::string> parameters = {}) {
    const std::string path = write_text(folder_, "s.xml", text);
    const auto folder = SceneFolder::of(path);
    return convert_mitsuba({folder->path() + "/s.xml", "s.xml", *folder, std::move(parameters)});
  }
  /// Returns the converted scene. This and the next two functions take the content for convert().
  scene::Scene scene(const std::string& content) {
    const auto converted = convert(content);
    EXPECT_TRUE(converted.ok()) << converted.status();
    return converted.ok() ? converted->scene : scene::Scene();
  }
  /// Returns the message of the error; an empty text if there is none.
  std::string error(const std::string& content) {
    return std::string(convert(content).status().message());
  }
  std::vector<std::string> warnings(const std::string& content) {
    const auto converted = convert(content);
    EXPECT_TRUE(converted.ok()) << converted.status();
    return converted.ok() ? converted->warnings : std::vector<std::string>();
  }
  TempDir folder_;
};

std::string rectangle(const std::string& bsdf) {
  return "<shape type=\"rectangle\">" + bsdf + "</shape>";
}

// The default lens has a focal length of 50 mm on a film of 36 x 24 mm. The diagonal of the image,
// which has 768 x 576 pixels, has the angle of the diagonal of this film. The width of the image is
// 4/3 of its height, so the diagonal is sqrt(1 + 16/9) times the height.
TEST_F(MitsubaScene, TheDefaultLensHasAFocalLengthOf50mm) {
  EXPECT_NEAR(
      scene("").camera().vertical_fov(),
      2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / 100 / std::sqrt(1 + 16.0 / 9)) * 180 / M_PI,
      1e-9)
      << "the vertical angle of 768 x 576 pixels";
}

TEST_F(MitsubaScene, CropsBecomeWindows) {
  const auto converted = convert_file(R"(<scene version="3.0.0"><sensor type="perspective">
    <float name="fov" value="90"/>
    <transform name="to_world"><lookat origin="1,2,3" target="1,2,0" up="0,1,0"/></transform>
    <film type="hdrfilm">
      <integer name="width" value="200"/> <integer name="height" value="100"/>
      <integer name="crop_offset_x" value="100"/> <integer name="crop_width" value="100"/>
      <rfilter type="box"/>
    </film></sensor></scene>)");
  ASSERT_TRUE(converted.ok()) << converted.status();
  const scene::Camera& camera = converted->scene.camera();
  EXPECT_THAT(camera.position(), ElementsAre(1, 2, 3));
  EXPECT_THAT(camera.look_at(), ElementsAre(1, 2, 0));
  EXPECT_FALSE(camera.mirrored());
  EXPECT_NEAR(camera.vertical_fov(), 2 * std::atan(0.5) * 180 / M_PI, 1e-12);
  EXPECT_THAT(camera.window(), ElementsAre(0, 2, -1, 1))
      << "the window must be the right half of the image";
  EXPECT_EQ(converted->scene.image().width(), 100u);
  EXPECT_EQ(converted->scene.image().filter().box().radius(), 0.5);
}

TEST_F(MitsubaScene, TheWarningOfAReplacedFilterTellsWhyItIsReplaced) {
  const auto warnings_of = [&](const std::string& filter) {
    const auto converted = convert_file(
        "<scene version=\"3.0.0\"><sensor type=\"perspective\">"
        "<film type=\"hdrfilm\"><rfilter type=\"" +
        filter + "\"/></film></sensor></scene>");
    return converted.ok() ? converted->warnings : std::vector<std::string>();
  };
  EXPECT_THAT(warnings_of("gaussian"), IsEmpty());
  EXPECT_THAT(warnings_of("lanczos"), ElementsAre(HasSubstr("\"lanczos\" has negative lobes")));
  EXPECT_THAT(warnings_of("unknown"), ElementsAre(HasSubstr("\"unknown\" is not known")));
}

TEST_F(MitsubaScene, AMirroredSensorIsMirrored) {
  const auto converted = convert_file(R"(<scene version="3.0.0"><sensor type="perspective">
    <transform name="to_world"><scale x="-1"/></transform></sensor></scene>)");
  ASSERT_TRUE(converted.ok()) << converted.status();
  EXPECT_TRUE(converted->scene.camera().mirrored());
}

// Mitsuba counts the segments of a path, and this renderer counts the scatterings between the
// segments. In Mitsuba, a max_depth of -1 means no limit. It becomes the maximum, 1024.
TEST_F(MitsubaScene, MaxDepthIsOneLessThanInMitsuba) {
  const auto depth = [&](const std::string& value) {
    return scene("<integrator type=\"path\"><integer name=\"max_depth\" value=\"" + value +
                 "\"/></integrator>")
        .integrator()
        .max_depth();
  };
  EXPECT_EQ(depth("2"), 1u);
  EXPECT_EQ(depth("9"), 8u);
  EXPECT_EQ(depth("-1"), 1024u);
  EXPECT_EQ(scene("<integrator type=\"moment\"><integrator type=\"direct\"/></integrator>")
                .integrator()
                .max_depth(),
            1u);
}

// With free_passage, the passage of light through a pane does not count towards max_depth. In
// Mitsuba, the integrator `path` counts such a passage, and the integrators `volpath` and
// `volpathmis` do not.
TEST_F(MitsubaScene, TheVolumetricPathTracerDoesNotCountThinPanes) {
  const auto is_free = [&](const std::string& integrator) {
    return scene("<integrator type=\"" + integrator + "\"/>" +
                 rectangle("<bsdf type=\"thindielectric\"/>"))
        .material(0)
        .thin_dielectric()
        .free_passage();
  };
  EXPECT_TRUE(is_free("volpath"));
  EXPECT_TRUE(is_free("volpathmis"));
  EXPECT_FALSE(is_free("path"));
}

TEST_F(MitsubaScene, ParametersHaveDefaultsAndValues) {
  const std::string text =
      "<default name=\"r\" value=\"2\"/><shape type=\"sphere\">"
      "<float name=\"radius\" value=\"$r\"/></shape>";
  EXPECT_EQ(scene(text).shape(0).sphere().radius(), 2);
  const auto other = convert(text, {{"r", "5"}});
  ASSERT_TRUE(other.ok()) << other.status();
  EXPECT_EQ(other->scene.shape(0).sphere().radius(), 5);
  EXPECT_THAT(std::string(convert(text, {{"radius", "5"}}).status().message()),
              HasSubstr("has no parameter \"radius\""));
  EXPECT_THAT(error("<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>"),
              StartsWith("s.xml:3: parameter in \"$r\" is not defined"));
}

TEST_F(MitsubaScene, ParametersCannotGrowWithoutBound) {
  std::string text = "<default name=\"p0\" value=\"0123456789\"/>\n";
  for (int i = 1; i < 40; ++i) {
    const std::string last = "$p" + std::to_string(i - 1);
    text += "<default name=\"p" + std::to_string(i) + "\" value=\"" + last + "x" + last + "\"/>\n";
  }
  EXPECT_THAT(error(text), HasSubstr("is longer than 1 MB"));
}

TEST_F(MitsubaScene, IncludesAreRead) {
  write_text(folder_, "ball.xml", "<scene version=\"2.0.0\"><shape type=\"sphere\"/></scene>");
  EXPECT_EQ(scene("<include filename=\"ball.xml\"/>").shape_size(), 1);
}

TEST_F(MitsubaScene, BadIncludesAreRefused) {
  EXPECT_THAT(error("<include filename=\"s.xml\"/>"), HasSubstr("includes itself"));
  write_text(folder_, "a.xml", "<scene version=\"3.0.0\"><include filename=\"b.xml\"/></scene>");
  write_text(folder_, "b.xml", "<scene version=\"3.0.0\">\n<include filename=\"a.xml\"/></scene>");
  EXPECT_THAT(error("<include filename=\"a.xml\"/>"),
              StartsWith("b.xml:2: \"a.xml\" includes itself"));
  EXPECT_THAT(error("\n<include filename=\"../outside.xml\"/>"),
              StartsWith("s.xml:4: \"../outside.xml\" lies outside"));
  EXPECT_THAT(error("<include filename=\"missing.xml\"/>"), HasSubstr("is missing"));
  EXPECT_THAT(error("<path value=\"..\"/>"), HasSubstr("lies outside of the scene's folder"));
}

TEST_F(MitsubaScene, ManyIncludesOfIncludesAreRefused) {
  for (int i = 0; i < 10; ++i) {
    std::string text = "<scene version=\"3.0.0\">";
    for (int k = 0; k < 10; ++k) {
      text += "<include filename=\"i" + std::to_string(i + 1) + ".xml\"/>";
    }
    write_text(folder_, "i" + std::to_string(i) + ".xml", text + "</scene>");
  }
  write_text(folder_, "i10.xml", "<scene version=\"3.0.0\"/>");
  EXPECT_THAT(error("<include filename=\"i0.xml\"/>"), HasSubstr("or more than 1000 are included"));
}

TEST_F(MitsubaScene, DamagedXmlIsRefusedWithItsLine) {
  EXPECT_THAT(std::string(convert_file("<scene version=\"3.0.0\">\n<shape").status().message()),
              HasSubstr("s.xml:2: is not XML"));
  EXPECT_THAT(std::string(convert_file("<shape/>").status().message()),
              HasSubstr("the root element must be <scene>"));
  EXPECT_THAT(std::string(convert_file("").status().message()), HasSubstr("is not XML"));
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) {
    deep += "<a>";
  }
  for (int i = 0; i < 1'000'000; ++i) {
    deep += "</a>";
  }
  EXPECT_THAT(error(deep), HasSubstr("elements are nested more than 50 deep"));
}

TEST_F(MitsubaScene, InvalidNumbersAndTransformsAreRefused) {
  const auto placed = [&](const std::string& step) {
    return error("<shape type=\"sphere\"><transform name=\"to_world\">\n" + step +
                 "</transform></shape>");
  };
  EXPECT_THAT(placed("<scale value=\"nan\"/>"), StartsWith("s.xml:4: \"nan\" is not a finite"));
  EXPECT_THAT(placed("<translate x=\"inf\"/>"), HasSubstr("is not a finite number"));
  EXPECT_THAT(placed("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>"),
              HasSubstr("the last row of a matrix must be 0 0 0 1"));
  EXPECT_THAT(placed("<scale value=\"0\"/>"), HasSubstr("to_world is singular"));
  EXPECT_THAT(placed("<rotate angle=\"3\"/>"), HasSubstr("needs an axis"));
  EXPECT_THAT(placed("<lookat origin=\"1 1 1\" target=\"1 1 1\"/>"), HasSubstr("must differ"));
}

TEST_F(MitsubaScene, ReferencesAreResolved) {
  const std::string paper =
      "<bsdf type=\"diffuse\" id=\"paper\"><rgb name=\"reflectance\" value=\"0.1 0.2 "
      "0.3\"/></bsdf>";
  const scene::Scene from =
      scene(rectangle("<ref id=\"sheet\"/>") + paper + "<alias id=\"paper\" as=\"sheet\"/>");
  ASSERT_EQ(from.material_size(), 1);
  EXPECT_EQ(from.material(0).name(), "paper");
  EXPECT_NEAR(from.material(0).diffuse().color().rgb(2), 0.3, 1e-7);
  EXPECT_TRUE(from.material(0).one_sided());
  EXPECT_EQ(from.shape(0).material(), "paper");
  EXPECT_THAT(error(rectangle("\n<ref id=\"nothing\"/>")),
              StartsWith("s.xml:4: no object has the id \"nothing\""));
  EXPECT_THAT(error(paper + paper), HasSubstr("id \"paper\" is also at s.xml:3"));
}

TEST_F(MitsubaScene, CyclesAndTooManyReferencesAreRefused) {
  EXPECT_THAT(error("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>"),
              HasSubstr("refers to itself"));
  std::string text = "<bsdf type=\"diffuse\" id=\"b0\"/>";
  for (int i = 1; i < 40; ++i) {
    const std::string last = "<ref id=\"b" + std::to_string(i - 1) + "\"/>";
    text += "<bsdf type=\"blendbsdf\" id=\"b" + std::to_string(i) + "\">" + last + last + "</bsdf>";
  }
  EXPECT_THAT(error(text), HasSubstr("has more than 10000 parts"));
}

TEST_F(MitsubaScene, FieldsOfMaterialsAreConverted) {
  const auto material = [&](const std::string& bsdf) {
    const scene::Scene from = scene(rectangle(bsdf));
    return from.material_size() > 0 ? from.material(from.material_size() - 1) : scene::Material();
  };
  const auto glass = material("<bsdf type=\"dielectric\"/>");
  // By default, the inside is glass and the outside is air, which has the index 1.000277.
  EXPECT_NEAR(glass.dielectric().index_of_refraction(), 1.5046 / 1.000277, 1e-12);
  EXPECT_FALSE(glass.one_sided());
  const auto plastic = material(
      "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.2\"/>"
      "<boolean name=\"nonlinear\" value=\"true\"/><string name=\"distribution\" value=\"ggx\"/>"
      "<string name=\"int_ior\" value=\"water\"/></bsdf>");
  EXPECT_EQ(plastic.plastic().surface().alpha(), 0.2);
  EXPECT_TRUE(plastic.plastic().nonlinear());
  EXPECT_NEAR(plastic.plastic().index_of_refraction(), 1.333 / 1.000277, 1e-12);
  const auto metal = material(
      "<bsdf type=\"twosided\"><bsdf type=\"roughconductor\"><float name=\"alpha_u\" "
      "value=\"0.1\"/>"
      "<float name=\"alpha_v\" value=\"0.3\"/><spectrum name=\"eta\" value=\"0.2\"/>"
      "<rgb name=\"k\" value=\"1 2 3\"/></bsdf></bsdf>");
  EXPECT_FALSE(metal.one_sided());
  EXPECT_EQ(metal.conductor().surface().distribution(), scene::Microfacets::DISTRIBUTION_BECKMANN);
  EXPECT_EQ(metal.conductor().surface().alpha_v(), 0.3);
  EXPECT_THAT(metal.conductor().k().rgb(), ElementsAre(1, 2, 3));
  const auto masked = material(
      "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.25\"/><bsdf "
      "type=\"diffuse\"/></bsdf>");
  EXPECT_EQ(masked.opacity(), 0.25);
  const auto blend = material(
      "<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.75\"/><bsdf type=\"diffuse\"/>"
      "<bsdf type=\"plastic\"/></bsdf>");
  EXPECT_EQ(blend.mix().a(), "diffuse");
  EXPECT_EQ(blend.mix().b(), "plastic");
  EXPECT_THAT(blend.mix().amount().color().rgb(), ElementsAre(0.75, 0.75, 0.75));
}

TEST_F(MitsubaScene, AConductorWithoutAMetalIsAMirror) {
  const auto metal = [&](const std::string& version, const std::string& parameters) {
    const auto converted =
        convert_file("<scene version=\"" + version + "\">" + kSensor +
                     rectangle("<bsdf type=\"conductor\">" + parameters + "</bsdf>") + "</scene>");
    EXPECT_TRUE(converted.ok()) << converted.status();
    if (!converted.ok()) {
      return scene::Conductor();
    }
    EXPECT_THAT(converted->warnings, IsEmpty());
    return converted->scene.material(0).conductor();
  };
  for (const char* version : {"2.1.0", "3.0.0"}) {
    EXPECT_FALSE(metal(version, "").has_eta()) << version;
    EXPECT_FALSE(metal(version, "").has_k()) << version;
  }
  EXPECT_FALSE(metal("3.0.0", "<rgb name=\"k\" value=\"2 2 2\"/>").has_eta())
      << "without eta, eta is 0, so the conductor is a mirror whatever k is";
  const auto glossy = metal("3.0.0", "<rgb name=\"eta\" value=\"0.5 1 2\"/>");
  EXPECT_THAT(glossy.eta().rgb(), ElementsAre(0.5, 1, 2));
  EXPECT_THAT(glossy.k().rgb(), ElementsAre(1, 1, 1));
  const auto copper = metal("3.0.0", "<string name=\"material\" value=\"Cu\"/>");
  EXPECT_TRUE(copper.has_eta());
  EXPECT_EQ(metal("0.6.0", "").eta().rgb(0), copper.eta().rgb(0))
      << "the default metal of version 0.6 must be copper";
}

/// The expected values are those that the renderer Tungsten lists. They are the linear RGB of the
/// same spectral tables under light of equal energy.
TEST(MitsubaMetals, HaveTheirPublishedColours) {
  struct Published {
    const char* name;
    Rgb eta;
    Rgb k;
  };
  const Published all[] = {{"a-C", {2.944f, 2.227f, 1.968f}, {0.887f, 0.799f, 0.815f}},
                           {"Ag", {0.155f, 0.117f, 0.138f}, {4.828f, 3.122f, 2.147f}},
                           {"Al", {1.657f, 0.880f, 0.521f}, {9.224f, 6.270f, 4.837f}},
                           {"Au", {0.143f, 0.375f, 1.442f}, {3.983f, 2.386f, 1.603f}},
                           {"Cr", {4.370f, 2.917f, 1.655f}, {5.206f, 4.231f, 3.755f}},
                           {"Cu", {0.200f, 0.924f, 1.102f}, {3.913f, 2.453f, 2.142f}},
                           {"Hg", {2.399f, 1.440f, 0.910f}, {6.328f, 4.372f, 3.422f}},
                           {"Ni_palik", {2.367f, 1.663f, 1.467f}, {4.499f, 3.050f, 2.345f}},
                           {"TiN", {1.648f, 1.150f, 1.380f}, {3.368f, 1.943f, 1.102f}},
                           {"W", {4.371f, 3.300f, 2.998f}, {3.501f, 2.605f, 2.273f}}};
  for (const Published& published : all) {
    const auto metal = mitsuba::metal_of(published.name);
    ASSERT_TRUE(metal.ok()) << metal.status();
    const auto expect_near = [&](float ours, float theirs) {
      // The tables of this renderer have one value for every 30 nm. So they blur the sharp edges in
      // the spectra of copper and gold.
      EXPECT_NEAR(ours, theirs, std::max(0.015f * theirs, 0.02f)) << published.name;
    };
    for (const auto& [ours, theirs] :
         {std::pair(metal->eta, published.eta), std::pair(metal->k, published.k)}) {
      expect_near(ours.r, theirs.r);
      expect_near(ours.g, theirs.g);
      expect_near(ours.b, theirs.b);
    }
  }
}

TEST_F(MitsubaScene, OldSpellingsAreRead) {
  const auto converted = convert_file(R"(<scene version="0.6.0">
  <sensor type="perspective"><transform name="toWorld"><lookAt origin="0 0 5" target="0 0 0"
    up="0 1 0"/></transform></sensor>
  <shape type="sphere"><bsdf type="dielectric"><float name="intIOR" value="1.5"/>
    <float name="extIOR" value="1"/></bsdf></shape>
  <shape type="rectangle"><bsdf type="diffuse"><srgb name="reflectance" value="#ff0000"/></bsdf>
  </shape></scene>)");
  ASSERT_TRUE(converted.ok()) << converted.status();
  EXPECT_THAT(converted->scene.camera().position(), ElementsAre(0, 0, 5));
  EXPECT_EQ(converted->scene.material(0).dielectric().index_of_refraction(), 1.5);
  EXPECT_THAT(converted->scene.material(1).diffuse().color().rgb(), ElementsAre(1, 0, 0));
  EXPECT_THAT(converted->warnings, IsEmpty());
}

TEST_F(MitsubaScene, ElementsWithoutACounterpartAreNamedOnce) {
  EXPECT_THAT(warnings("<shape type=\"sdfgrid\"/>"),
              ElementsAre("s.xml:3: shape \"sdfgrid\" is not known; the shape is left out"));
  EXPECT_THAT(warnings("<shape type=\"sphere\"><float name=\"wobble\" value=\"1\"/></shape>"),
              ElementsAre("s.xml:3: parameter \"wobble\" of shape \"sphere\" has no counterpart "
                          "and is left out"));
  EXPECT_THAT(warnings("<emitter type=\"sunsky\"/>").size(), 1u);
  EXPECT_THAT(warnings("<shape type=\"obj\"><string name=\"filename\" value=\"no.obj\"/></shape>"),
              ElementsAre(HasSubstr("s.xml:3: \"no.obj\" is missing")));
}

// By default, the colours of a checkerboard are 0.4 and 0.2.
TEST_F(MitsubaScene, ColoursOfACheckerboardAreExchangedWhereVIsReversed) {
  const std::string checker =
      "<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">"
      "<transform name=\"to_uv\"><scale value=\"5\"/></transform></texture></bsdf>";
  const scene::Scene from =
      scene(rectangle(checker) + "<shape type=\"sphere\">" + checker + "</shape>");
  const scene::CheckerTexture& flat = from.material(0).diffuse().texture().checker();
  EXPECT_THAT(flat.size(), ElementsAre(0.1, 0.1));
  EXPECT_NEAR(flat.even().color().rgb(0), 0.4, 1e-7);
  // On the sphere, v is reversed, so the rows of cells are counted from the other end. The number
  // of rows, ten, is even, so the first row counted from that end starts with the second colour.
  EXPECT_NEAR(from.material(1).diffuse().texture().checker().even().color().rgb(0), 0.2, 1e-7);
}

// In a checkerboard of colours, the even cells have color0. In a checkerboard of numbers, here a
// factor of metal, Mitsuba exchanges the two values: the even cells have color1.
TEST_F(MitsubaScene, InACheckerboardOfNumbersTheEvenCellsHaveColor1) {
  const scene::Scene from = scene(rectangle(
      "<bsdf type=\"principled\"><texture type=\"checkerboard\" name=\"metallic\">"
      "<float name=\"color0\" value=\"0.75\"/><float name=\"color1\" value=\"0.5\"/></texture>"
      "</bsdf>"));
  const scene::CheckerTexture& board = from.material(0).principled().metallic().texture().checker();
  EXPECT_EQ(board.even().color().rgb(0), 0.5);
  EXPECT_EQ(board.odd().color().rgb(0), 0.75);
}

TEST_F(MitsubaScene, TexturesKeepTheirPlacement) {
  write_text(folder_, "t.pgm", "P2 1 1 255 255\n");
  const scene::Scene from =
      scene(rectangle("<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">"
                      "<string name=\"filename\" value=\"t.pgm\"/><transform name=\"to_uv\"><scale "
                      "x=\"2\" y=\"3\"/>"
                      "<translate x=\"0.5\" y=\"0.25\"/></transform></texture></bsdf>"));
  const scene::ImageTexture& image = from.material(0).diffuse().texture().image();
  // Counted from the top, the coordinate in the image is 3 v + 0.25. So counted from the bottom, it
  // is 1 - 0.25 - 3 v.
  EXPECT_THAT(image.uv_scale(), ElementsAre(2, -3));
  EXPECT_THAT(image.uv_offset(), ElementsAre(0.5, 0.75));
}

// By default, the inner angle of a spot light is 3/4 of the cutoff angle. The irradiance of a
// projector becomes its image. The intensity of the projector multiplies the image. It is pi, so
// that a white surface perpendicular to the light shows the image.
TEST_F(MitsubaScene, FieldsOfLightsAreConverted) {
  const scene::Scene from = scene(R"(
<emitter type="point"><point name="position" x="1" y="2" z="3"/>
  <rgb name="intensity" value="4"/></emitter>
<emitter type="directional"><vector name="direction" value="0,0,-1"/></emitter>
<emitter type="spot"><float name="cutoff_angle" value="40"/></emitter>
<emitter type="projector"><float name="fov" value="90"/><rgb name="irradiance" value="2"/></emitter>
<emitter type="constant"><rgb name="radiance" value="0.5"/></emitter>)");
  ASSERT_EQ(from.light_size(), 4);
  EXPECT_THAT(from.light(0).point().intensity().rgb(), ElementsAre(4, 4, 4));
  EXPECT_THAT(from.light(1).directional().direction(), ElementsAre(0, 0, -1));
  EXPECT_EQ(from.light(2).spot().inner_angle(), 30);
  EXPECT_EQ(from.light(2).spot().falloff(), scene::SpotLight::FALLOFF_LINEAR_ANGLE);
  EXPECT_NEAR(from.light(3).projector().vertical_fov(), 90, 1e-12);
  EXPECT_NEAR(from.light(3).projector().intensity().rgb(0), M_PI, 1e-6);
  EXPECT_THAT(from.background().constant().rgb(), ElementsAre(0.5, 0.5, 0.5));
}

TEST_F(MitsubaScene, AreaLightsEmitToOneSide) {
  const scene::Scene from = scene(rectangle(
      "<bsdf type=\"diffuse\"/><emitter type=\"area\"><rgb name=\"radiance\" value=\"1 2 3\"/>"
      "</emitter>"));
  EXPECT_THAT(from.material(0).emission().rgb(), ElementsAre(1, 2, 3));
  EXPECT_TRUE(from.material(0).emission_one_sided());
}

/// In an environment map of Mitsuba, a row of pixels is a circle of latitude. In an environment map
/// of this renderer, a row is a band of latitudes. The conversion must not blur the image.
TEST_F(MitsubaScene, EnvironmentsStaySharp) {
  const Image rows{1, 3, {gray(0), gray(1), gray(0)}};
  const auto bytes = encode_image(rows, ImageFormat::kExr);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  write_text(folder_, "sky.exr", {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  const auto converted =
      convert("<emitter type=\"envmap\"><string name=\"filename\" value=\"sky.exr\"/></emitter>");
  ASSERT_TRUE(converted.ok()) << converted.status();
  const auto made = converted->made_files.find(converted->scene.background().environment().file());
  ASSERT_NE(made, converted->made_files.end());
  const auto image = decode_picture(made->second);
  ASSERT_TRUE(image.ok()) << image.status();
  const std::size_t half = image->height / 2;
  EXPECT_GT((image->pixels[half - 1].g + image->pixels[half].g) / 2, 0.95f)
      << "the equator must stay bright";
  EXPECT_LT(image->pixels.front().g, 0.05f) << "the pole must stay dark";
}

TEST_F(MitsubaScene, RectanglesKeepTheirNormal) {
  // Returns the z of u x v: 4, the area of the rectangle, if the normal is +z, and -4 if it is -z.
  const auto normal = [&](const std::string& inside) {
    const scene::Quad quad = scene(rectangle(inside)).shape(0).quad();
    return quad.u(0) * quad.v(1) - quad.u(1) * quad.v(0);
  };
  EXPECT_EQ(normal(""), 4);
  EXPECT_EQ(normal("<boolean name=\"flip_normals\" value=\"true\"/>"), -4);
  EXPECT_EQ(normal("<transform name=\"to_world\"><scale x=\"-1\"/></transform>"), 4)
      << "normals stay on their side when a placement mirrors";
}

TEST_F(MitsubaScene, GroupsAreSharedByTheirInstances) {
  const scene::Scene from = scene(R"(
<shape type="shapegroup" id="pile"><shape type="sphere"/><shape type="rectangle"/></shape>
<shape type="instance"><ref id="pile"/></shape>
<shape type="instance"><ref id="pile"/><transform name="to_world"><translate x="3"/></transform>
</shape>)");
  ASSERT_EQ(from.group_size(), 1);
  EXPECT_EQ(from.group(0).shape_size(), 2);
  ASSERT_EQ(from.instance_size(), 2);
  EXPECT_THAT(from.instance(1).matrix(), ElementsAre(1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0));
  EXPECT_THAT(error("<shape type=\"instance\"/>"), HasSubstr("must refer to a shapegroup"));
}

TEST_F(MitsubaScene, MediaHaveTheirCoefficients) {
  const scene::Scene from = scene(R"(
<medium type="homogeneous" id="fog"><rgb name="sigma_t" value="2"/>
  <rgb name="albedo" value="0.25"/><float name="scale" value="3"/>
  <phase type="hg"><float name="g" value="0.5"/></phase></medium>
<shape type="sphere"><bsdf type="null"/><ref name="interior" id="fog"/></shape>)");
  ASSERT_EQ(from.medium_size(), 1);
  EXPECT_THAT(from.medium(0).scattering().rgb(), ElementsAre(0.5, 0.5, 0.5));
  EXPECT_THAT(from.medium(0).absorption().rgb(), ElementsAre(1.5, 1.5, 1.5));
  EXPECT_EQ(from.medium(0).density(), 3);
  EXPECT_EQ(from.medium(0).anisotropy(), 0.5);
  EXPECT_EQ(from.shape(0).interior(), "fog");
  EXPECT_EQ(from.shape(0).material(), "");
}

TEST_F(MitsubaScene, GridsOfAbsorptionAreRefused) {
  write_text(folder_, "smoke.vol", "VOL");  // only the name of the file is used
  EXPECT_THAT(error("<medium type=\"heterogeneous\" id=\"smoke\"><volume name=\"sigma_a\" "
                    "type=\"gridvolume\"><string name=\"filename\" value=\"smoke.vol\"/></volume>"
                    "</medium><shape type=\"sphere\"><bsdf type=\"null\"/>"
                    "<ref name=\"interior\" id=\"smoke\"/></shape>"),
              HasSubstr("sigma_a and sigma_s cannot be grids; write sigma_t and albedo instead"));
}

/// In Mitsuba, the outermost values of a grid continue to the faces of the grid.
TEST_F(MitsubaScene, GridsAreClampedAtTheirFaces) {
  write_text(folder_, "smoke.vol", "VOL");  // only the name of the file is used
  const auto text = [](const std::string& wrap) {
    return "<medium type=\"heterogeneous\" id=\"smoke\"><volume name=\"sigma_t\" "
           "type=\"gridvolume\">"
           "<string name=\"filename\" value=\"smoke.vol\"/>" +
           wrap +
           "</volume></medium><shape type=\"sphere\"><bsdf type=\"null\"/>"
           "<ref name=\"interior\" id=\"smoke\"/></shape>";
  };
  const scene::Scene from = scene(text(""));
  ASSERT_EQ(from.medium_size(), 1);
  EXPECT_TRUE(from.medium(0).density_grid().clamp());
  EXPECT_THAT(warnings(text("<string name=\"wrap_mode\" value=\"repeat\"/>")),
              ElementsAre(HasSubstr("wrap_mode \"repeat\" of a grid is shown as clamp")));
}

/// Mitsuba places grids in the world. A sphere that is scaled unequally, or has uvs, is an instance
/// here, and its medium lies in the space of the instance. So the product of the instance's matrix
/// and the grid's matrix, which places the grid in the world, must be the identity.
TEST_F(MitsubaScene, GridsInSpheresThatAreInstancesStayInTheirPlace) {
  write_text(folder_, "smoke.vol", "VOL");  // only the name of the file is used
  const auto grid_to_world = [&](const std::string& scale, const std::string& bsdf) {
    const scene::Scene from = scene(
        "<medium type=\"heterogeneous\" id=\"smoke\"><volume name=\"sigma_t\" "
        "type=\"gridvolume\"><string name=\"filename\" value=\"smoke.vol\"/></volume>"
        "</medium><shape type=\"sphere\">" +
        bsdf + "<ref name=\"interior\" id=\"smoke\"/><transform name=\"to_world\"><scale " + scale +
        "/><translate x=\"5\"/></transform></shape>");
    const auto transform_of = [](const auto& numbers) {
      Transform out;
      for (int i = 0; i < numbers.size(); ++i) {
        out.m[i / 4][i % 4] = numbers[i];
      }
      return out;
    };
    EXPECT_EQ(from.instance_size(), 1);
    return transform_of(from.instance(0).matrix()) *
           transform_of(from.medium(0).density_grid().matrix());
  };
  const std::string textured =
      "<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"/></bsdf>";
  for (const Transform& found : {grid_to_world("x=\"2\"", "<bsdf type=\"null\"/>"),
                                 grid_to_world("value=\"2\"", textured)}) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        EXPECT_NEAR(found.m[row][column], row == column ? 1 : 0, 1e-12) << row << " " << column;
      }
    }
  }
}

/// import_scene reads a Mitsuba file too, also in strict mode, in which a warning is an error.
TEST_F(MitsubaScene, IsImportedAsASceneFile) {
  write_text(folder_, "s.xml",
             "<scene version=\"3.0.0\">\n" + kSensor +
                 "<shape type=\"sphere\"/><emitter type=\"constant\"/></scene>");
  const auto imported = import_scene(folder_ / "s.xml");
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->scene.geometry.spheres.size(), 1u);
  ImportChoices strict;
  strict.strict = true;
  EXPECT_TRUE(import_scene(folder_ / "s.xml", strict).ok());
}

TEST_F(MitsubaScene, FilesOutsideTheFolderOfTheSceneNeedAWiderFolder) {
  std::filesystem::create_directory(folder_ / "scenes");
  std::filesystem::create_directory(folder_ / "common");
  write_text(folder_, "common/ball.xml",
             "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>");
  write_text(folder_, "scenes/s.xml",
             "<scene version=\"3.0.0\"><path value=\"../common\"/>" + kSensor +
                 "<include filename=\"ball.xml\"/></scene>");
  const std::string path = folder_ / "scenes/s.xml";
  EXPECT_THAT(std::string(import_scene(path).status().message()),
              HasSubstr("name a wider one with --folder"));
  ImportChoices around;
  around.folder = folder_ / ".";
  EXPECT_TRUE(import_scene(path, around).ok()) << import_scene(path, around).status();
  around.folder = folder_ / "common";
  EXPECT_THAT(std::string(import_scene(path, around).status().message()),
              HasSubstr("does not lie in the folder"));
}

/// The image lies in another folder than the scene.
TEST_F(MitsubaScene, AProjectorHasTheShapeOfItsImage) {
  std::filesystem::create_directory(folder_ / "scenes");
  std::filesystem::create_directory(folder_ / "common");
  const auto bytes = encode_image(Image{3, 1, {gray(1), gray(1), gray(1)}}, ImageFormat::kPng);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  write_text(folder_, "common/wide.png",
             {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  write_text(folder_, "scenes/s.xml",
             "<scene version=\"3.0.0\"><path value=\"../common\"/>" + kSensor +
                 "<emitter type=\"projector\"><texture type=\"bitmap\" name=\"irradiance\">"
                 "<string name=\"filename\" value=\"wide.png\"/></texture></emitter></scene>");
  const auto around = SceneFolder::of(write_text(folder_, "any.xml", ""));
  ASSERT_TRUE(around.ok()) << around.status();
  const auto converted = convert_mitsuba({around->path() + "/scenes/s.xml", "s.xml", *around, {}});
  ASSERT_TRUE(converted.ok()) << converted.status();
  EXPECT_EQ(converted->scene.light(0).projector().aspect(), 3);
}

}  // namespace
}  // namespace bandsaw
