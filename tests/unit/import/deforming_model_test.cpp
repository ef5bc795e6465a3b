// Skins and morph targets that move while the shutter is open: their vertices at both ends of the
// exposure, and the coverage of rendered pixels against closed forms. Each comparison of pixels
// allows 4 standard errors. With random seeds, fewer than 1 % of all runs would fail by chance; the
// seeds are fixed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/import/import.h"
#include "renderlib/math/elementary.h"
#include "renderlib/render/render_band.h"
#include "tests/support/statistics.h"
#include "tests/unit/import/gltf_writer.h"

namespace bandsaw {
namespace {

using test::GltfWriter;
using test::Json;
using test::Moments;
using test::TempDir;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Returns the choice of an exposure that begins at frame / fps seconds. `shutter` is the share of
/// a frame's time in which the shutter is open.
ImportChoices exposure(double frame, double fps, double shutter) {
  ImportChoices choices;
  choices.frame = FrameChoice{frame, fps, shutter};
  return choices;
}

/// Returns a file of the quad [x0, x1] x [y0, y1] at node 0. Tests may let its corners follow
/// bones.
GltfWriter quad(float x0, float x1, float y0, float y1) {
  GltfWriter file;
  file.attributes() = {
      {"POSITION", file.add<float>({x0, y0, 0, x1, y0, 0, x1, y1, 0, x0, y1, 0}, 3)}};
  file.primitive()["indices"] = file.add<std::uint32_t>({0, 1, 2, 0, 2, 3}, 1);
  return file;
}

/// Adds a linear channel to the animation "act", which is made if there is none. `path` is the
/// property of the node that the channel animates.
void animate(GltfWriter& file, int node, const char* path, const std::vector<float>& times,
             const std::vector<float>& values, int components) {
  if (!file.root.contains("animations")) {
    file.root["animations"] = Json::parse(R"([{"name": "act", "channels": [], "samplers": []}])");
  }
  Json& animation = file.root["animations"][0];
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back(
      {{"input", file.add(times, 1)}, {"output", file.add(values, components)}});
}

/// Returns a file of a quad whose corners all follow the bone at node 1. The bone is turned by
/// `degrees` about z in the first second.
GltfWriter swinging_quad(double degrees, float x0, float x1, float y0, float y1) {
  GltfWriter file = quad(x0, x1, y0, y1);
  file.attributes()["JOINTS_0"] = file.add<std::uint8_t>(std::vector<std::uint8_t>(16, 0), 4);
  file.attributes()["WEIGHTS_0"] =
      file.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4);
  file.root["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0}, {"name": "joint"}])");
  file.root["scenes"][0]["nodes"] = {0, 1};
  file.root["skins"] = Json::parse(R"([{"joints": [1]}])");
  const SinCos half = sincos_turns(degrees / 720);
  animate(file, 1, "rotation", {0, 1},
          {0, 0, 0, 1, 0, 0, static_cast<float>(half.sin), static_cast<float>(half.cos)}, 4);
  return file;
}

class DeformingModel : public ::testing::Test {
 protected:
  ImportedScene read(GltfWriter& file, const ImportChoices& choices) {
    auto imported = import_scene(file.write(folder_, "m.gltf"), choices);
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? *std::move(imported) : ImportedScene();
  }

  /// Renders the model with 32 seeds for the exposure [0, 1], and returns the moments of each
  /// pixel. The model emits 1 and is seen along -z. A pixel covers one unit, and the lower left
  /// corner of the image is at (x, y).
  std::vector<Moments> pixels(GltfWriter& file, double x, double y, std::uint32_t width,
                              std::uint32_t height) {
    file.write(folder_, "m.gltf");
    const std::string text = absl::StrCat(
        "camera { position: [", x + width / 2.0, ", ", y + height / 2.0, ", 5] look_at: [",
        x + width / 2.0, ", ", y + height / 2.0, ", 0] orthographic { height: ", height,
        " } shutter_close: 1 } image { width: ", width, " height: ", height,
        R"( } material { name: "lamp" emissive { radiance { rgb: [1, 1, 1] } } }
            model { file: "m.gltf" material: "lamp" animation: "act" })");
    const auto imported = import_scene(write_text(folder_, "s.textproto", text), {});
    EXPECT_TRUE(imported.ok()) << imported.status();
    Pool pool(1);
    const auto scene = Scene::build(imported->scene, pool);
    EXPECT_TRUE(scene.ok()) << scene.status();
    std::vector<Moments> means(std::size_t{width} * height);
    constexpr std::uint64_t kSamples = 128;
    const std::atomic<bool> stop = false;
    for (std::uint64_t seed = 0; seed < 32; ++seed) {
      const auto band = render_band(**scene, {.width = width, .height = height, .seed = seed},
                                    {{0, kSamples}, {0, height}}, pool, stop, {});
      EXPECT_TRUE(band.ok());
      for (std::size_t i = 0; i < means.size(); ++i) {
        means[i].add(band->sums[3 * i + 1] / kSamples);
      }
    }
    return means;
  }

  TempDir folder_;
};

TEST_F(DeformingModel, HasItsVerticesAtBothEndsOfTheExposure) {
  GltfWriter file = swinging_quad(90, 0, 1, 0, 1);
  file.attributes()["NORMAL"] = file.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, 3);
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3)}}});
  animate(file, 0, "weights", {0, 1}, {0, 1}, 1);
  // The exposure lasts from 0.25 s to 0.5 s. The quad is turned by 22.5 degrees when the exposure
  // begins and by 45 degrees when the exposure ends. The morph target lifts the first vertex by 8
  // in a second, so by 2 when the exposure begins and by 4 when it ends.
  const ImportedScene imported = read(file, exposure(1, 4, 1));
  EXPECT_THAT(imported.info.warnings, IsEmpty());
  ASSERT_THAT(imported.scene.geometry.meshes, SizeIs(1));
  const Mesh& mesh = imported.scene.geometry.meshes[0];
  const auto expect_turned = [&](const auto& positions, const auto& normals, double degrees,
                                 float height) {
    const SinCos turn = sincos_turns(degrees / 360);
    ASSERT_THAT(positions, SizeIs(4));
    ASSERT_THAT(normals, SizeIs(4));
    EXPECT_NEAR(positions[0][2], height, 1e-6);
    EXPECT_NEAR(positions[1][0], turn.cos, 1e-6);
    EXPECT_NEAR(positions[1][1], turn.sin, 1e-6);
    EXPECT_NEAR(normals[1][0], turn.cos, 1e-6);
    EXPECT_NEAR(normals[1][1], turn.sin, 1e-6);
  };
  expect_turned(mesh.positions, mesh.normals, 22.5, 2);
  expect_turned(mesh.positions_at_close, mesh.normals_at_close, 45, 4);
}

// Three nodes have the same mesh. The weight of the first node rises from 0 to 1 in a second, the
// weight of the second node is 0, and the weight of the third node falls from 1 to 0. The exposure
// lasts from 0.25 s to 0.5 s.
TEST_F(DeformingModel, EachNodeOfAMeshHasItsOwnWeights) {
  GltfWriter file = quad(0, 1, 0, 1);
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 3)}}});
  file.root["nodes"] = Json::parse(R"([{"mesh": 0}, {"mesh": 0}, {"mesh": 0}])");
  file.root["scenes"][0]["nodes"] = {0, 1, 2};
  animate(file, 0, "weights", {0, 1}, {0, 1}, 1);
  animate(file, 2, "weights", {0, 1}, {1, 0}, 1);
  const ImportedScene imported = read(file, exposure(1, 4, 1));
  const Geometry& geometry = imported.scene.geometry;
  ASSERT_THAT(geometry.instances, SizeIs(3));
  const auto mesh = [&](std::size_t i) {
    return geometry.meshes[index_of(geometry.instances[i].mesh)];
  };
  EXPECT_NEAR(mesh(0).positions[0][2], 2, 1e-6);
  EXPECT_NEAR(mesh(0).positions_at_close.at(0)[2], 4, 1e-6);
  EXPECT_EQ(mesh(1).positions[0][2], 0);
  EXPECT_THAT(mesh(1).positions_at_close, IsEmpty());
  EXPECT_NEAR(mesh(2).positions[0][2], 6, 1e-6);
  EXPECT_NEAR(mesh(2).positions_at_close.at(0)[2], 4, 1e-6);
}

TEST_F(DeformingModel, AMeshWhosePoseRestsDoesNotDeform) {
  GltfWriter file = swinging_quad(90, 0, 1, 0, 1);
  const ImportedScene instant = read(file, exposure(1, 4, 0));
  EXPECT_THAT(instant.scene.geometry.meshes[0].positions_at_close, IsEmpty());
  // The animation ends after a second.
  const ImportedScene later = read(file, exposure(9, 4, 1));
  EXPECT_THAT(later.scene.geometry.meshes[0].positions_at_close, IsEmpty());
  EXPECT_EQ(later.info.warnings, std::vector<std::string>());
}

// A morph target makes one vertex infinite when the exposure ends, but not when the exposure
// begins.
TEST_F(DeformingModel, ATriangleThatIsNotFiniteAtOneEndOfTheExposureIsLeftOut) {
  GltfWriter file = quad(0, 1, 0, 1);
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 0, 0, 3e38f, 0, 0, 0, 0, 0, 0, 0}, 3)}}});
  animate(file, 0, "weights", {0, 1}, {0, 9}, 1);
  const ImportedScene imported = read(file, exposure(0, 1, 1));
  EXPECT_THAT(imported.info.warnings, ElementsAre(HasSubstr("1 of 2 triangles have a vertex")));
  const Mesh& mesh = imported.scene.geometry.meshes[0];
  EXPECT_THAT(mesh.triangles, SizeIs(1));
  EXPECT_THAT(mesh.positions, SizeIs(3));
  EXPECT_THAT(mesh.positions_at_close, SizeIs(3));
}

// A morph target moves the right edge of a half-plane by ten pixels, so the coverage is a linear
// ramp.
TEST_F(DeformingModel, TheCoverageOfAMorphTargetInLinearMotionIsALinearRamp) {
  constexpr int kWidth = 24;
  GltfWriter file = quad(-100, 5, -9, 9);
  file.primitive()["targets"] =
      Json::array({{{"POSITION", file.add<float>({0, 0, 0, 10, 0, 0, 10, 0, 0, 0, 0, 0}, 3)}}});
  animate(file, 0, "weights", {0, 1}, {0, 1}, 1);
  const std::vector<Moments> found = pixels(file, 0, 0, kWidth, 1);
  // Returns the integral of clamp(s, 0, 10) / 10 over s from 0 to x.
  const auto integral = [](double x) { return x < 0 ? 0 : x < 10 ? x * x / 20 : x - 5; };
  for (int x = 0; x < kWidth; ++x) {
    const double expected = 1 - (integral(x + 1 - 5) - integral(x - 5));
    const Moments& pixel = found[static_cast<std::size_t>(x)];
    EXPECT_NEAR(pixel.mean(), expected, 4 * pixel.standard_error() + 1e-9) << x;
  }
}

// A bar swings by the angle a about the joint at the origin. Its vertices move along straight
// lines. So at the share t of the exposure, the map (1 - t) I + t R(a) has been applied to the bar.
// The determinant of this map is (1 - t)^2 + t^2 + 2 t (1 - t) cos a, and its mean over t is
// (2 + cos a) / 3.
TEST_F(DeformingModel, ASwingingBarCoversTheMeanOfItsArea) {
  constexpr double kAngle = 75;
  constexpr double kArea = 8 * 2;
  const SinCos turn = sincos_turns(kAngle / 360);
  GltfWriter file = swinging_quad(kAngle, 0, 8, -1, 1);
  const std::vector<Moments> found = pixels(file, -3, -3, 14, 14);
  double sum = 0;
  double variance = 0;
  for (const Moments& pixel : found) {
    sum += pixel.mean();
    variance += pixel.standard_error() * pixel.standard_error();
  }
  const double expected = kArea * (2 + turn.cos) / 3;
  EXPECT_NEAR(sum, expected, 4 * std::sqrt(variance));
  EXPECT_LT(std::sqrt(variance), 5e-3 * expected);
  // At the time t, a point of a pixel is covered if the inverse of the map at t takes the point
  // into the bar. The expected value of a pixel is the probability that a random point of the pixel
  // is covered at a random time.
  constexpr int kParts = 48;
  for (int y = 0; y < 14; ++y) {
    for (int x = 0; x < 14; ++x) {
      int inside = 0;
      for (int part = 0; part < kParts * kParts * kParts; ++part) {
        const auto middle = [&](int n) { return (n % kParts + 0.5) / kParts; };
        const double t = middle(part);
        const double c = 1 - t + t * turn.cos;  // the rows of the map are (c, -s) and (s, c)
        const double s = t * turn.sin;
        const double px = x - 3 + middle(part / kParts);
        const double py = 14 - 3 - y - middle(part / kParts / kParts);
        const double det = c * c + s * s;
        const double bx = (c * px + s * py) / det;
        const double by = (c * py - s * px) / det;
        inside += bx >= 0 && bx <= 8 && by >= -1 && by <= 1 ? 1 : 0;
      }
      const Moments& pixel = found[static_cast<std::size_t>(14 * y + x)];
      EXPECT_NEAR(pixel.mean(), static_cast<double>(inside) / (kParts * kParts * kParts),
                  4 * pixel.standard_error() + 1e-3)
          << x << " " << y;
    }
  }
}

}  // namespace
}  // namespace bandsaw
