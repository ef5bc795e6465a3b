// A textured model is seen from the front with one pixel per texel. A layer is the image of one
// integrator. The albedo layer must have the colours of the model's texture, and the normal layer
// must have the normals of the model's normal map.

#include <gtest/gtest.h>

#include "renderlib/image/srgb.h"
#include "tests/support/random.h"
#include "tests/unit/import/gltf_file.h"
#include "tests/unit/import/layer.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;

constexpr std::uint32_t kWidth = 7;
constexpr std::uint32_t kHeight = 5;

/// Returns random 8-bit codes, three for each texel. With `normals`, they are the codes of normals
/// that point upwards (+z).
std::string codes(bool normals) {
  test::Random random(9);
  std::string bytes;
  for (std::uint32_t i = 0; i < 3 * kWidth * kHeight; ++i) {
    const bool up = normals && i % 3 == 2;
    bytes += static_cast<char>(up ? 220 + 35 * random.uniform() : 60 + 130 * random.uniform());
  }
  return bytes;
}

/// Renders the file `model` in `folder` by `integrator`, with one pixel for each texel.
Image seen(const TempDir& folder, const std::string& model, Integrator integrator) {
  const auto imported = import_scene(write_text(
      folder, "s.textproto",
      "camera { position: [0.5, 0.5, 9] look_at: [0.5, 0.5, 0] orthographic { height: 1 } }"
      "image { filter { box { radius: 0 } } }"
      "model { file: \"" +
          model + "\" scale: [1.4, 1, 1] translate: [-0.2, 0, 0] }"));
  EXPECT_TRUE(imported.ok()) << imported.status();
  return test::layer(*imported, kWidth, kHeight, integrator);
}

/// Writes q.obj and q.gltf, the same textured square in both formats.
void write_models(const TempDir& folder) {
  const std::string head = absl::StrCat("P6 ", kWidth, " ", kHeight, " 255\n");
  write_text(folder, "color.ppm", head + codes(false));
  write_text(folder, "normal.ppm", head + codes(true));
  write_text(folder, "q.mtl", "newmtl a\nKd 1 1 1\nmap_Kd color.ppm\nnorm normal.ppm\n");
  write_text(folder, "q.obj",
             "mtllib q.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
             "usemtl a\nf 1/1 2/2 3/3 4/4\n");
  write_text(folder, "q.bin",
             test::floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}) +
                 test::floats({0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0}));
  write_text(folder, "q.gltf",
             R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
  "material": 0}]}],
"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 1}}],
"textures": [{"source": 0}, {"source": 1}], "images": [{"uri": "color.ppm"}, {"uri": "normal.ppm"}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
{"bufferView": 1, "componentType": 5126, "count": 6, "type": "VEC2"}],
"bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 48}],
"buffers": [{"byteLength": 120, "uri": "q.bin"}]})");
}

class ModelLayers : public ::testing::TestWithParam<std::string> {};

TEST_P(ModelLayers, ShowTheColoursOfTheTextureAndTheNormalsOfTheMap) {
  const TempDir folder;
  write_models(folder);
  const Image albedo = seen(folder, GetParam(), Integrator::kAlbedo);
  const Image normals = seen(folder, GetParam(), Integrator::kNormals);
  const std::string colors = codes(false);
  const std::string bent = codes(true);
  ASSERT_EQ(albedo.pixels.size(), colors.size() / 3);
  for (std::size_t i = 0; i < albedo.pixels.size(); ++i) {
    const auto color = [&](std::size_t c) {
      return srgb_table()[static_cast<unsigned char>(colors[3 * i + c])];
    };
    EXPECT_NEAR(albedo.pixels[i].r, color(0), 1e-6);
    EXPECT_NEAR(albedo.pixels[i].g, color(1), 1e-6);
    EXPECT_NEAR(albedo.pixels[i].b, color(2), 1e-6);
    const auto along = [&](std::size_t c) {
      return 2 * static_cast<unsigned char>(bent[3 * i + c]) / 255.0 - 1;
    };
    // The model is scaled by 1.4 along x. The scaling turns neither the tangents nor the normal of
    // the surface, so the normals of the map must stay the same.
    const Vec3 n = normalize({along(0), along(1), along(2)});
    EXPECT_NEAR(2 * normals.pixels[i].r - 1, n.x, 1e-5);
    EXPECT_NEAR(2 * normals.pixels[i].g - 1, n.y, 1e-5);
    EXPECT_NEAR(2 * normals.pixels[i].b - 1, n.z, 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ModelLayers, ::testing::Values("q.obj", "q.gltf"));

}  // namespace
}  // namespace bandsaw
