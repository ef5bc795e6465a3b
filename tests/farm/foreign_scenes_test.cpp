// Tests scenes of pbrt and Mitsuba. If a farm loses a worker, its image has the same bytes as the
// image of `bandsaw render`. The scene file that `bandsaw import` writes also gives these bytes.
// The scenes are defined in this file, and each has many features.

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/farm/farm_processes.h"
#include "tests/farm/survival.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

constexpr char kTetrahedron[] = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 4
property list uchar int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
)";

constexpr char kPbrt[] = R"(LookAt 0 1.5 -5  0 0.7 0  0 1 0
Camera "perspective" "float fov" 40 "float shutterclose" 1
Film "rgb" "integer xresolution" 200 "integer yresolution" 200
Integrator "volpath" "integer maxdepth" 8
MakeNamedMedium "smoke" "string type" "homogeneous" "rgb sigma_a" [0.2 0.3 0.4]
    "rgb sigma_s" [2 2 2]
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.4 0.5]
AttributeBegin
  AreaLightSource "diffuse" "blackbody L" 3000 "float scale" 8
  Translate 0 3 0
  Rotate 90 1 0 0
  Shape "disk" "float radius" 0.7
AttributeEnd
Texture "board" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
    "rgb tex1" [0.1 0.1 0.1] "rgb tex2" [0.8 0.8 0.8]
AttributeBegin
  Material "coateddiffuse" "texture reflectance" "board" "float roughness" 0.05
  Shape "bilinearmesh" "point3 P" [-4 0 -4  4 0 -4  -4 0 4  4 0 4]
AttributeEnd
AttributeBegin
  ActiveTransform EndTime
  Translate 0.3 0 0
  ActiveTransform All
  Translate -1 0.5 0
  Material "conductor" "spectrum eta" "metal-Cu-eta" "spectrum k" "metal-Cu-k"
      "float roughness" 0.1
  Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
  Translate 0.2 0 0
  Material "dielectric"
  Shape "plymesh" "string filename" "models/tetrahedron.ply"
AttributeEnd
AttributeBegin
  Translate 1.3 0.6 0.3
  Material "interface"
  MediumInterface "smoke" ""
  Shape "sphere" "float radius" 0.6
AttributeEnd
)";

constexpr char kMitsuba[] = R"(<scene version="3.0.0">
  <default name="res" value="200"/>
  <integrator type="volpath"><integer name="max_depth" value="8"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="40"/>
    <transform name="to_world">
      <lookat origin="0, 1.5, 5" target="0, 0.7, 0" up="0, 1, 0"/>
    </transform>
    <film type="hdrfilm">
      <integer name="width" value="$res"/> <integer name="height" value="$res"/>
      <rfilter type="box"/>
    </film>
  </sensor>
  <emitter type="constant"><rgb name="radiance" value="0.3, 0.4, 0.5"/></emitter>
  <shape type="rectangle">
    <transform name="to_world">
      <rotate x="1" angle="-90"/> <scale value="4"/>
    </transform>
    <bsdf type="roughplastic">
      <texture type="checkerboard" name="diffuse_reflectance">
        <transform name="to_uv"><scale x="4" y="4"/></transform>
      </texture>
    </bsdf>
  </shape>
  <shape type="disk">
    <transform name="to_world">
      <rotate x="1" angle="90"/> <translate y="3"/>
    </transform>
    <emitter type="area"><rgb name="radiance" value="8, 6, 4"/></emitter>
  </shape>
  <shape type="ply">
    <string name="filename" value="models/tetrahedron.ply"/>
    <bsdf type="principled">
      <rgb name="base_color" value="0.8, 0.4, 0.2"/> <float name="metallic" value="0.7"/>
    </bsdf>
  </shape>
  <shape type="sphere">
    <point name="center" x="1.3" y="0.6" z="0.3"/> <float name="radius" value="0.6"/>
    <bsdf type="thindielectric"/>
    <medium type="homogeneous" name="interior">
      <rgb name="sigma_t" value="2, 2, 2"/> <rgb name="albedo" value="0.9, 0.8, 0.7"/>
    </medium>
  </shape>
  <shape type="sphere">
    <point name="center" x="-1.2" y="0.5" z="0"/> <float name="radius" value="0.5"/>
    <bsdf type="roughconductor"><string name="material" value="Au"/></bsdf>
  </shape>
</scene>
)";

class ForeignScenes : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(farm_.path("models"));
    write("models/tetrahedron.ply", kTetrahedron);
    write("kitchen.pbrt", kPbrt);
    write("kitchen.xml", kMitsuba);
  }
  void write(const std::string& name, const std::string& text) {
    std::FILE* file = std::fopen(farm_.path(name).c_str(), "wb");
    ASSERT_NE(file, nullptr);
    EXPECT_EQ(std::fwrite(text.data(), 1, text.size(), file), text.size());
    EXPECT_EQ(std::fclose(file), 0);
  }
  /// Renders the scene on three workers, one of which is killed. The image must have the bytes of
  /// `bandsaw render`, and no stored band may be rendered again.
  void expect_the_same_bytes_of(const std::string& scene) {
    Survival job(farm_, farm_.path(scene));
    for (const char* name : {"victim", "second", "third"}) {
      farm_.add_worker(name, 1);
    }
    Process client = job.submit();
    job.wait_until_stored("victim", 2);
    farm_.worker("victim").signal(SIGKILL);
    job.expect_the_same_bytes(client);
    job.expect_nothing_rendered_again("victim");
  }
  /// Returns the bytes of a small rendering of the scene.
  std::string rendered(const std::string& scene, const std::string& output) {
    const Finished finished = run({BANDSAW_BIN, "render", scene, "--width", "48", "--height", "48",
                                   "--samples", "8", "-o", farm_.path(output), "--quiet"});
    EXPECT_EQ(finished.code, 0) << finished.err;
    return file_bytes(farm_.path(output));
  }
  FarmProcesses farm_;
};

TEST_F(ForeignScenes, PbrtScenesHaveTheSameBytesAfterAWorkerDied) {
  expect_the_same_bytes_of("kitchen.pbrt");
}

TEST_F(ForeignScenes, MitsubaScenesHaveTheSameBytesAfterAWorkerDied) {
  expect_the_same_bytes_of("kitchen.xml");
}

TEST_F(ForeignScenes, AnImportedSceneHasTheSameBytes) {
  for (const std::string scene : {"kitchen.pbrt", "kitchen.xml"}) {
    const std::string folder = farm_.path("imported " + scene);
    fs::create_directories(folder);
    const std::string output = folder + "/scene.textproto";
    const Finished finished = run({BANDSAW_BIN, "import", farm_.path(scene), "-o", output});
    ASSERT_EQ(finished.code, 0) << finished.err;
    EXPECT_NE(finished.out.find("wrote "), std::string::npos) << finished.out;
    EXPECT_TRUE(rendered(farm_.path(scene), "foreign.pfm") == rendered(output, "ours.pfm"))
        << scene;
    EXPECT_TRUE(fs::exists(folder + "/kitchen_files"))
        << "the meshes must be beside the scene file";
  }
}

TEST_F(ForeignScenes, ImportReplacesNothingUnlessForced) {
  const std::string output = farm_.path("kitchen.textproto");
  write("kitchen.textproto", "mine");
  const Finished refused = run({BANDSAW_BIN, "import", farm_.path("kitchen.pbrt"), "-o", output});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("--force"), std::string::npos) << refused.err;
  EXPECT_EQ(file_bytes(output), "mine");
  const Finished forced =
      run({BANDSAW_BIN, "import", farm_.path("kitchen.pbrt"), "-o", output, "--force"});
  EXPECT_EQ(forced.code, 0) << forced.err;
  EXPECT_NE(file_bytes(output), "mine");
}

TEST_F(ForeignScenes, StrictImportRefusesFeaturesWithoutCounterpart) {
  write("hair.pbrt", "WorldBegin\nMaterial \"hair\"\nShape \"sphere\"\n");
  const std::string output = farm_.path("hair.textproto");
  const Finished strict =
      run({BANDSAW_BIN, "import", farm_.path("hair.pbrt"), "--strict", "-o", output});
  EXPECT_EQ(strict.code, 2);
  EXPECT_NE(strict.err.find("hair.pbrt:2: the material \"hair\""), std::string::npos) << strict.err;
  EXPECT_FALSE(fs::exists(output)) << "a refused import must write no file";
  const Finished lenient = run({BANDSAW_BIN, "import", farm_.path("hair.pbrt"), "-o", output});
  EXPECT_EQ(lenient.code, 0) << lenient.err;
  EXPECT_NE(lenient.err.find("warning: "), std::string::npos) << lenient.err;
  EXPECT_NE(file_bytes(output).find("# "), std::string::npos)
      << "the warnings must be in the text too";
}

}  // namespace
}  // namespace bandsaw::test
