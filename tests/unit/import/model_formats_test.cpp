// The import of OBJ, PLY, STL, COLLADA and FBX models: their materials, textures whose file names
// differ from those in the model, vertex colours, lights and the up axis.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/image/srgb.h"
#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::test_model;
using test::write_text;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

class Obj : public ::testing::Test {
 protected:
  /// Imports an OBJ file of a triangle. `material`: the lines of the triangle's material in the MTL
  /// file.
  ImportedScene read(const std::string& material) {
    write_text(folder_, "m.mtl", "newmtl a\n" + material);
    auto imported = import_scene(
        write_text(folder_, "m.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1/1 2/2 3/3\n"));
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? *std::move(imported) : ImportedScene();
  }
  Material material(const std::string& text) { return read(text).scene.materials.at(0); }
  /// Returns the material, and expects that it is of the kind MetallicRoughness.
  MetallicRoughness layers(const std::string& text) {
    const Material whole = material(text);
    const auto* found = std::get_if<MetallicRoughness>(&whole.kind);
    EXPECT_NE(found, nullptr) << text;
    return found == nullptr ? MetallicRoughness() : *found;
  }
  TempDir folder_;
};

// A highlight of exponent Ns has the width of GGX with alpha^2 = 2 / (Ns + 2), and alpha is the
// square of the roughness.
TEST_F(Obj, AHighlightBecomesRoughness) {
  const MetallicRoughness m = layers("Kd 0.5 0.5 0.5\nKs 0.9 0.9 0.9\nNs 98\nillum 2\n");
  EXPECT_NEAR(m.roughness.factor, std::pow(0.02, 0.25), 1e-6);
  EXPECT_EQ(m.metallic.factor, 0);
  EXPECT_NEAR(m.index_of_refraction, 1.5, 1e-6) << "without Ni, the index is at most that of glass";
  EXPECT_EQ(layers("Kd 0.5 0.5 0.5\nKs 0.9 0.9 0.9\nNs 98\nNi 2\nillum 2\n").index_of_refraction,
            2);
}

TEST_F(Obj, BlackWithAHighlightIsMetal) {
  const MetallicRoughness m = layers("Kd 0 0 0\nKs 1 0.75 0.25\nNs 198\nillum 3\n");
  EXPECT_EQ(m.metallic.factor, 1);
  EXPECT_EQ(m.base_color.factor, (Rgb{1, 0.75f, 0.25f}));
}

TEST_F(Obj, ADisabledHighlightGivesDiffuse) {
  for (const char* off : {"Ks 1 1 1\nNs 0\nillum 2\n", "Ks 0 0 0\nNs 100\nillum 2\n",
                          "Ks 1 1 1\nNs 100\nillum 1\n"}) {
    const ImportedScene imported = read(std::string("Kd 0.5 0.5 0.5\n") + off);
    EXPECT_TRUE(std::holds_alternative<Diffuse>(imported.scene.materials[0].kind)) << off;
  }
}

TEST_F(Obj, OpacityBecomesAlphaAndAnOpacityOfZeroIsIgnored) {
  const Material glass = material("Kd 0.5 0.5 0.5\nd 0.25\n");
  EXPECT_EQ(glass.alpha.mode, AlphaMode::kBlend);
  EXPECT_EQ(glass.alpha.value.factor, 0.25);
  const ImportedScene gone = read("Kd 0.5 0.5 0.5\nd 0\n");
  EXPECT_TRUE(std::holds_alternative<Diffuse>(gone.scene.materials[0].kind));
  EXPECT_THAT(
      gone.info.warnings,
      Contains(
          "m.obj: material \"a\": its opacity of 0 is taken as a mistake, and it is shown opaque"));
}

TEST_F(Obj, AnOpacityMapIsReadFromItsBrightness) {
  write_text(folder_, "mask.pgm", std::string("P5 2 1 255\n") + '\0' + "\xff");
  const Material m = material("Kd 1 1 1\nmap_d mask.pgm\n");
  EXPECT_EQ(m.alpha.mode, AlphaMode::kBlend);
  EXPECT_EQ(m.alpha.value.factor, 1);
}

/// Returns a TGA file of two texels with these alphas. The left texel is black, the right texel is
/// white.
std::string tga_with_alpha(char alpha_of_black, char alpha_of_white) {
  const char header[18] = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28};
  const char texels[8] = {0, 0, 0, alpha_of_black, '\xff', '\xff', '\xff', alpha_of_white};
  return std::string(header, sizeof header) + std::string(texels, sizeof texels);
}

TEST_F(Obj, AnOpacityMapIsReadFromItsAlphaUnlessItsAlphaIsOpaqueEverywhere) {
  const auto opacities = [&](const std::string& text) {
    const ImportedScene imported = read(text);
    EXPECT_THAT(imported.info.warnings, IsEmpty());
    const TextureId map = imported.scene.materials.at(0).alpha.value.texture;
    const auto at = [&](double u) {
      return evaluate(imported.scene.textures, map, {{u, 0.5}, {}, {}, {}}).r;
    };
    return std::pair(at(0.25), at(0.75));
  };
  write_text(folder_, "cut.tga", tga_with_alpha('\xff', 0));
  write_text(folder_, "full.tga", tga_with_alpha('\xff', '\xff'));
  write_text(folder_, "grey.pgm", std::string("P5 1 1 255\n") + "\x80");
  EXPECT_EQ(opacities("Kd 1 1 1\nmap_d cut.tga\n"), std::pair(1.0f, 0.0f));
  EXPECT_EQ(opacities("Kd 1 1 1\nmap_d full.tga\n"), std::pair(0.0f, 1.0f));
  EXPECT_EQ(opacities("Kd 1 1 1\nmap_Kd grey.pgm\nmap_d full.tga\n"), std::pair(0.0f, 1.0f));
}

TEST_F(Obj, AnOpacityMapThatIsAlsoTheColourMapIsReadFromItsAlpha) {
  write_text(folder_, "full.tga", tga_with_alpha('\xff', '\xff'));
  const ImportedScene imported = read("Kd 1 1 1\nmap_Kd full.tga\nmap_d full.tga\n");
  const TextureId map = imported.scene.materials.at(0).alpha.value.texture;
  EXPECT_EQ(evaluate(imported.scene.textures, map, {{0.25, 0.5}, {}, {}, {}}), (Rgb{1, 1, 1}));
}

TEST_F(Obj, AWeakEmissionIsAddedToTheReflection) {
  const Material m = material("Kd 0.5 0.5 0.5\nKe 0.25 0.125 0\n");
  EXPECT_EQ(m.emission.radiance.factor, (Rgb{0.25f, 0.125f, 0}));
  EXPECT_EQ(std::get<MetallicRoughness>(m.kind).base_color.factor, gray(0.5f));
  EXPECT_FALSE(m.emission.one_sided);
}

/// Returns a PPM file of one texel.
std::string ppm_of(int red, int green, int blue) {
  std::string file = "P6 1 1 255\n";
  for (const int code : {red, green, blue}) {
    file += static_cast<char>(code);
  }
  return file;
}

TEST_F(Obj, ABumpMapThatHoldsNormalsIsANormalMap) {
  write_text(folder_, "n.ppm", ppm_of(128, 128, 255));
  write_text(folder_, "h.ppm", ppm_of(90, 90, 90));
  EXPECT_TRUE(material("Kd 1 1 1\nmap_Bump n.ppm\n").relief.normal.has_value());
  EXPECT_TRUE(material("Kd 1 1 1\nnorm n.ppm\n").relief.normal.has_value());
  EXPECT_TRUE(material("Kd 1 1 1\nmap_Bump h.ppm\n").relief.normal.has_value());
  EXPECT_THAT(read("Kd 1 1 1\nmap_Bump h.ppm\n").info.warnings, IsEmpty());
}

// The heights rise by 51 of 255 codes per texel to the right. So the slope is 0.2. With the option
// -bm 2 the slope is 0.4.
TEST_F(Obj, ABumpMapOfHeightsBecomesANormalMap) {
  write_text(folder_, "h.pgm", std::string("P5 3 1 255\n") + '\x0a' + '\x3d' + '\x70');
  const auto middle = [&](const std::string& bump) {
    const ImportedScene imported = read("Kd 1 1 1\n" + bump);
    const Relief& relief = imported.scene.materials[0].relief;
    const Rgb texel = evaluate(imported.scene.textures, *relief.normal, {{0.5, 0.5}, {}, {}, {}});
    return Vec3{2.0 * texel.r - 1, 2.0 * texel.g - 1, 2.0 * texel.b - 1};
  };
  EXPECT_LE(length(middle("map_Bump h.pgm\n") - normalize({-0.2, 0, 1})), 1e-6);
  EXPECT_LE(length(middle("map_Bump -bm 2 h.pgm\n") - normalize({-0.4, 0, 1})), 1e-6);
}

// The map scales the reflectance of glass, whose F0 is 0.04, to about half. The index is stored
// with an error of half a code.
TEST_F(Obj, ASpecularMapScalesTheReflection) {
  write_text(folder_, "s.ppm", ppm_of(188, 188, 188));
  const ImportedScene imported = read("illum 2\nKd 0.5 0 0\nKs 1 1 1\nNs 100\nmap_Ks s.ppm\n");
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  const MetallicRoughness& m = std::get<MetallicRoughness>(imported.scene.materials[0].kind);
  ASSERT_TRUE(m.index_map.has_value());
  const Rgb share = evaluate(imported.scene.textures, *m.index_map, {{0.5, 0.5}, {}, {}, {}});
  const double index = 1 + share.r * (m.index_of_refraction - 1);
  const double f0 = (index - 1) * (index - 1) / ((index + 1) * (index + 1));
  EXPECT_NEAR(f0, 0.04 * srgb_table()[188], 1.3e-4);
}

TEST_F(Obj, ReadsThePbrNumbersOfNewerFiles) {
  write_text(folder_, "r.pgm", std::string("P5 1 1 255\n") + "\x80");
  const MetallicRoughness m =
      layers("Kd 0.5 0.25 0.125\nPm 0.75\nPr 0.5\nmap_Pr r.pgm\nPc 0.25\nPcr 0.125\n");
  EXPECT_EQ(m.metallic.factor, 0.75);
  EXPECT_EQ(m.roughness.factor, 0.5);
  EXPECT_EQ(m.base_color.factor, (Rgb{0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(m.coat.factor, 0.25);
  EXPECT_EQ(m.coat_roughness.factor, 0.125);
}

TEST_F(Obj, FindsATextureBesideTheModelThoughItsPathDiffers) {
  write_text(folder_, "My Stone.PPM", test::small_ppm());
  for (const char* name :
       {"My Stone.PPM", "my stone.ppm", "My%20Stone.PPM", "C:\\art\\stones\\My Stone.ppm",
        "..\\..\\tex\\My Stone.PPM", "/home/me/My Stone.PPM", "textures/My Stone.PPM"}) {
    const ImportedScene imported = read(std::string("Kd 1 1 1\nmap_Kd ") + name + "\n");
    ASSERT_EQ(imported.scene.materials.size(), 1u);
    const auto id = std::get<Diffuse>(imported.scene.materials[0].kind).reflectance;
    EXPECT_TRUE(std::holds_alternative<ImageTexture>(imported.scene.textures[index_of(id)]))
        << name;
    EXPECT_THAT(imported.info.warnings, IsEmpty()) << name;
  }
}

TEST_F(Obj, TexturesAreScaledAndMoved) {
  write_text(folder_, "t.ppm", test::small_ppm());
  const ImportedScene imported =
      read("Kd 1 1 1\nKs 0.5 0.5 0.5\nNs 100\nillum 2\nmap_Kd -s 2 3 1 -o -0.5 0.25 0 t.ppm\n");
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  const auto& layers = std::get<MetallicRoughness>(imported.scene.materials.at(0).kind);
  const auto& image =
      std::get<ImageTexture>(imported.scene.textures.at(index_of(layers.base_color.texture)));
  EXPECT_EQ(image.uv_transform.m, (std::array<double, 6>{2, 0, -0.5, 0, 3, 0.25}));
  EXPECT_THAT(read("Kd 1 1 1\nmap_Kd -mm 0 0.5 t.ppm\n").info.warnings,
              Contains("m.obj: the option -mm of its textures is left out"));
}

TEST_F(Obj, VertexColoursAreSrgb) {
  const auto imported = import_scene(
      write_text(folder_, "c.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Mesh& mesh = imported->scene.geometry.meshes[0];
  ASSERT_EQ(mesh.colors.size(), 3u);
  EXPECT_EQ(mesh.colors[0], (std::array<float, 3>{1, 0, 0}));
  EXPECT_EQ(mesh.colors[1][1], static_cast<float>(srgb_decode(0.5)));
  const auto& surface = std::get<Diffuse>(imported->scene.materials.at(0).kind);
  EXPECT_EQ(evaluate(imported->scene.textures, surface.reflectance, {}), (Rgb{1, 1, 1}))
      << "the default grey of a file without materials must not dim the vertex colours";
}

TEST_F(Obj, VertexColoursAreIgnoredIfTheSceneReplacesTheMaterial) {
  write_text(folder_, "c.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  const auto imported = import_scene(
      write_text(folder_, "s.textproto",
                 "material { name: \"w\" diffuse {} } model { file: \"c.obj\" material: \"w\" }"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_THAT(imported->scene.geometry.meshes[0].colors, IsEmpty());
}

/// Returns a PLY file of a triangle. `properties`: declarations of the vertices' properties besides
/// the position. `vertices`: a line for each of the three vertices.
std::string ply(const std::string& properties, const std::string& vertices) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\n" +
         properties + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
         vertices + "3 0 1 2\n";
}

TEST(Ply, IsGreyOrHasVertexColours) {
  const TempDir folder;
  const auto plain = import_scene(write_text(folder, "p.ply", ply("", "0 0 0\n1 0 0\n0 1 0\n")));
  ASSERT_TRUE(plain.ok()) << plain.status();
  EXPECT_TRUE(std::holds_alternative<Diffuse>(plain->scene.materials[0].kind));
  const auto painted =
      import_scene(write_text(folder, "c.ply",
                              ply("property uchar red\nproperty uchar green\nproperty uchar blue\n",
                                  "0 0 0 255 0 0\n1 0 0 0 188 0\n0 1 0 0 0 255\n")));
  ASSERT_TRUE(painted.ok()) << painted.status();
  ASSERT_EQ(painted->scene.geometry.meshes[0].colors.size(), 3u);
  EXPECT_NEAR(painted->scene.geometry.meshes[0].colors[1][1], 0.5, 0.005);
}

/// Returns the reflectance of the first material, a diffuse one, at the middle of its texture.
Rgb reflectance(const absl::StatusOr<ImportedScene>& imported) {
  EXPECT_TRUE(imported.ok()) << imported.status();
  if (!imported.ok()) {
    return {};
  }
  const auto& scene = imported->scene;
  return evaluate(scene.textures, std::get<Diffuse>(scene.materials.at(0).kind).reflectance,
                  {{0.5, 0.5}, {}, {}, {}});
}

TEST(Ply, TheDefaultGreyDoesNotDimItsColours) {
  const TempDir folder;
  const auto read = [&](const std::string& text) {
    return import_scene(write_text(folder, "p.ply", text));
  };
  const Rgb white{1, 1, 1};
  EXPECT_EQ(reflectance(read(ply("", "0 0 0\n1 0 0\n0 1 0\n"))), gray(0.8f));
  EXPECT_EQ(reflectance(read(ply("property uchar red\nproperty uchar green\nproperty uchar blue\n",
                                 "0 0 0 255 0 0\n1 0 0 0 188 0\n0 1 0 0 0 255\n"))),
            white);
  write_text(folder, "t.ppm", ppm_of(255, 255, 255));
  std::string textured =
      ply("property float s\nproperty float t\n", "0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n");
  const std::string format = "format ascii 1.0\n";
  textured.insert(textured.find(format) + format.size(), "comment TextureFile t.ppm\n");
  const auto imported = read(textured);
  EXPECT_EQ(reflectance(imported), white);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(std::holds_alternative<ImageTexture>(imported->scene.textures.at(0)));
}

TEST(Stl, HasATriangleAndItsNormal) {
  const TempDir folder;
  const auto imported = import_scene(
      write_text(folder, "t.stl",
                 "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
                 "0\nendloop\nendfacet\nendsolid t\n"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->scene.geometry.meshes[0].normals[0], (std::array<float, 3>{0, 0, 1}));
}

// Returns a COLLADA file of a triangle whose third vertex is `up`. A unit is a hundredth of a
// metre.
std::string dae(const std::string& up_axis, const std::string& up) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimetre" meter="0.01"/><up_axis>)" +
         up_axis + R"(</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0  1 0 0  )" +
         up + R"(</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST(Dae, UpAxisAndUnitAreConverted) {
  const TempDir folder;
  for (const auto& [axis, up] : {std::pair("Y_UP", "0 2 0"), std::pair("Z_UP", "0 0 2")}) {
    const auto imported = import_scene(write_text(folder, "t.dae", dae(axis, up)));
    ASSERT_TRUE(imported.ok()) << imported.status();
    const Instance& instance = imported->scene.geometry.instances.at(0);
    const auto& tip = imported->scene.geometry.meshes[0].positions[2];
    const Vec3 world = instance.to_world.point({tip[0], tip[1], tip[2]});
    EXPECT_NEAR(length(world - Vec3{0, 0.02, 0}), 0, 1e-9) << axis;
  }
}

TEST(Fbx, UpAxisIsConverted) {
  if (!test::have_test_models()) {
    GTEST_SKIP() << "needs the package assimp-testmodels";
  }
  // In the file z is up, and the box stands on z = 0. In the imported scene y is up.
  const auto imported = import_scene(test_model("FBX/embedded_ascii/box.FBX"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  double lowest = 1e9;
  const Instance& instance = imported->scene.geometry.instances.at(0);
  for (const auto& p : imported->scene.geometry.meshes[0].positions) {
    lowest = std::min(lowest, instance.to_world.point({p[0], p[1], p[2]}).y);
  }
  EXPECT_NEAR(lowest, 0, 1e-6);
}

/// Returns an ASCII FBX file of a square on y = 0 and a light above it. The intensity of the light
/// is 4 (400 in the file). `properties`: further lines of the light's properties.
std::string fbx_light(const std::string& properties) {
  return R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UpAxis", "int", "Integer", "",1
		P: "UpAxisSign", "int", "Integer", "",1
		P: "FrontAxis", "int", "Integer", "",2
		P: "FrontAxisSign", "int", "Integer", "",1
		P: "CoordAxis", "int", "Integer", "",0
		P: "CoordAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Objects:  {
	Geometry: 100, "Geometry::plane", "Mesh" {
		Vertices: *12 {
			a: -4,0,4,4,0,4,4,0,-4,-4,0,-4
		}
		PolygonVertexIndex: *4 {
			a: 0,1,2,-4
		}
		GeometryVersion: 124
	}
	Model: 101, "Model::plane", "Mesh" {
		Version: 232
		Properties70:  {
		}
	}
	NodeAttribute: 200, "NodeAttribute::lamp", "Light" {
		Properties70:  {
			P: "Color", "Color", "", "A",1,1,1
			P: "Intensity", "Number", "", "A",400
)" + properties +
         R"(		}
		TypeFlags: "Light"
	}
	Model: 201, "Model::lamp", "Light" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",0,2,0
		}
	}
}
Connections:  {
	C: "OO",101,0
	C: "OO",100,101
	C: "OO",201,0
	C: "OO",200,201
}
)";
}

/// Imports an FBX file with a light of these properties.
absl::StatusOr<ImportedScene> import_fbx_light(const std::string& properties) {
  const TempDir folder;
  return import_scene(write_text(folder, "l.fbx", fbx_light(properties)));
}

// FBX states the full angle of a cone, from edge to edge. cos_inner and cos_outer are the cosines
// of half the angles, 30 and 45 degrees.
TEST(Fbx, TheConesOfASpotLightAreHalfItsAngles) {
  const auto imported = import_fbx_light(R"(
			P: "LightType", "enum", "", "",2
			P: "InnerAngle", "Number", "", "A",60
			P: "OuterAngle", "Number", "", "A",90
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto& spot = std::get<SpotLight>(imported->scene.lights.at(0));
  EXPECT_NEAR(length(spot.position - Vec3{0, 2, 0}), 0, 1e-6);
  EXPECT_NEAR(length(spot.direction - Vec3{0, -1, 0}), 0, 1e-6);
  EXPECT_NEAR(spot.cos_inner, std::sqrt(0.75), 1e-6);
  EXPECT_NEAR(spot.cos_outer, std::sqrt(0.5), 1e-6);
}

// The light has a quadratic decay that starts at the distance 0. Assimp gives such a light an
// infinite falloff.
TEST(Fbx, AQuadraticDecayThatStartsAtZeroIsNotBlack) {
  const auto imported = import_fbx_light(R"(
			P: "LightType", "enum", "", "",0
			P: "DecayType", "enum", "", "",2
			P: "DecayStart", "Number", "", "A",0
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(std::get<PointLight>(imported->scene.lights.at(0)).intensity, (Rgb{4, 4, 4}));
  EXPECT_THAT(imported->info.warnings, Contains(HasSubstr("the light \"lamp\" gets a falloff")));
}

}  // namespace
}  // namespace bandsaw
