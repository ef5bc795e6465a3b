// Scenes with meshes that deform while the shutter is open.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>

#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/render/kernel.h"
#include "renderlib/render/render_band.h"
#include "renderlib/scene/static_instances.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::SceneMaker;
using ::testing::HasSubstr;

constexpr Shutter kExposure = {1, 3};

/// A closed mesh that changes its shape, with normals.
Mesh changing(std::uint64_t seed = 1) {
  Mesh mesh = test::rough_sphere(12, 6, 1.5, seed);
  mesh.positions_at_close = test::rough_sphere(12, 6, 2.5, seed + 1).positions;
  mesh.normals = mesh.positions;
  mesh.normals_at_close = mesh.positions_at_close;
  return mesh;
}

/// Three deforming meshes over a floor under a sky: one of metal, one that emits light, and one
/// that bounds a medium.
SceneMaker scene_of_all() {
  SceneMaker maker;
  maker.quad({-9, -2, -9}, {0, 0, 18}, {18, 0, 0}, maker.diffuse(0.5f));
  maker.camera({0, 1, 9}, {0, 0, 0}, 50);
  maker.background({1, 1, 1}, {0.5f, 0.7f, 1});
  maker.instance(changing(), translation({-2.5, 0, 0}), maker.metal(0.8f, 0.3));
  maker.instance(changing(5), scaling({0.5, -0.5, 0.5}), maker.lamp(4));
  Media& media = maker.scene.media;
  media.media = {{.absorption = {0.3f, 0.2f, 0.1f}, .scattering = {0.5f, 0.5f, 0.5f}}};
  media.boundaries.meshes.push_back(changing(9));
  media.boundaries.instances.push_back({MeshId{0}, MaterialId{0}, translation({2.5, 0, 0})});
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = kExposure;
  return maker;
}

/// Options with which the scene is built and rendered. All of them must give the same pixels.
struct BuildOptions {
  SceneFeatures forced = {};  ///< features to enable even if the scene does not use them
  Traversal traversal = Traversal::kBvh;
  const Kernel* kernel = nullptr;  ///< nullptr: the fastest
  EarlierScenes earlier = {};      ///< scenes whose BVHs are used again for the same meshes
  std::uint32_t rows = 12;         ///< of each band; a divisor of 12
};

/// Returns the scene, built with these options.
std::shared_ptr<const Scene> built(const SceneDescription& scene,
                                   const BuildOptions& options = {}) {
  Pool pool(1);
  auto built =
      Scene::build(scene, pool, options.forced, options.traversal, options.kernel, options.earlier);
  EXPECT_TRUE(built.ok()) << built.status();
  return built.ok() ? *built : nullptr;
}

/// Returns the sums of 16 samples of each pixel of an image of 18 x 12 pixels, rendered in bands of
/// `rows` rows.
std::vector<double> rendered(const Scene& scene, std::uint32_t rows = 12) {
  Pool pool(1);
  const std::atomic<bool> stop = false;
  std::vector<double> all;
  for (std::uint32_t y = 0; y < 12; y += rows) {
    const auto band = render_band(scene, {.width = 18, .height = 12, .seed = 3},
                                  {{0, 16}, {y, y + rows}}, pool, stop, {});
    EXPECT_TRUE(band.ok());
    all.insert(all.end(), band->sums.begin(), band->sums.end());
  }
  return all;
}

std::vector<double> rendered(const SceneDescription& scene, const BuildOptions& options = {}) {
  return rendered(*built(scene, options), options.rows);
}

TEST(DeformingScene, PixelsAreTheSameForKernelsBandsAndTraversals) {
  const SceneDescription scene = scene_of_all().scene;
  const auto first = built(scene);
  EXPECT_TRUE(first->features().motion);
  const std::vector<double> expected = rendered(*first);
  for (const Kernel* kernel : kernels()) {
    EXPECT_EQ(rendered(scene, {.kernel = kernel}), expected) << kernel->name;
  }
  EXPECT_EQ(rendered(scene, {.rows = 4}), expected);
  EXPECT_EQ(rendered(scene, {.traversal = Traversal::kBruteForce}), expected);
  EXPECT_EQ(rendered(scene, {.forced = kAllFeatures}), expected);
  // The next scene shares the meshes of the earlier scene and uses their BVHs again.
  SceneDescription next = scene;
  next.geometry.meshes = first->geometry().meshes;
  const std::shared_ptr<const Scene> earlier[] = {first};
  EXPECT_EQ(rendered(next, {.earlier = earlier}), expected);
}

/// Returns the scene with ordinary meshes instead of deforming ones. They have the shapes of the
/// deforming meshes after the given share of the exposure.
SceneDescription frozen(SceneDescription scene, double share) {
  const ShutterTime now({0, 1}, share);
  for (MeshList* meshes : {&scene.geometry.meshes, &scene.media.boundaries.meshes}) {
    for (std::size_t i = 0; i < meshes->size(); ++i) {
      Mesh& mesh = meshes->change(i);
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        mesh.positions[v] = now.between(mesh.positions[v], mesh.positions_at_close[v]);
        mesh.normals[v] = now.between(mesh.normals[v], mesh.normals_at_close[v]);
      }
      mesh.positions_at_close.clear();
      mesh.normals_at_close.clear();
    }
  }
  return scene;
}

// If a mesh has the same positions when the shutter opens and closes, the pixels are those of the
// ordinary mesh, to the bit. A shutter without duration also gives the pixels of the ordinary mesh.
TEST(DeformingScene, AMeshThatDoesNotChangeEqualsTheOrdinaryMesh) {
  SceneDescription scene = scene_of_all().scene;
  SceneDescription still = frozen(scene, 0.3);
  SceneDescription both = still;
  for (MeshList* meshes : {&both.geometry.meshes, &both.media.boundaries.meshes}) {
    for (std::size_t i = 0; i < meshes->size(); ++i) {
      meshes->change(i).positions_at_close = (*meshes)[i].positions;
      meshes->change(i).normals_at_close = (*meshes)[i].normals;
    }
  }
  // The deforming lamp is removed. Lights that move have bounds of another kind, and are chosen
  // with other probabilities.
  for (SceneDescription* each : {&scene, &still, &both}) {
    each->geometry.instances.pop_back();
  }
  EXPECT_EQ(rendered(both, {.forced = kAllFeatures}), rendered(still, {.forced = kAllFeatures}));
  std::get<PerspectiveCamera>(scene.camera).shutter = {1, 1};
  EXPECT_FALSE(built(scene)->features().motion);
  EXPECT_EQ(rendered(scene), rendered(frozen(scene, 0)));
}

/// Returns the error of the scene that `spoil` has changed; empty if there is none.
std::string error_after(void (*spoil)(SceneDescription&)) {
  SceneMaker maker = scene_of_all();
  spoil(maker.scene);
  Pool pool(1);
  return std::string(Scene::build(maker.scene, pool).status().message());
}

TEST(DeformingScene, InvalidPositionsAreRefusedWithTheField) {
  EXPECT_EQ(error_after([](auto&) {}), "");
  EXPECT_THAT(
      error_after([](auto& s) { s.geometry.meshes.change(1).positions_at_close.pop_back(); }),
      HasSubstr("meshes[1].positions_at_close: must have one entry for each"));
  EXPECT_THAT(error_after([](auto& s) { s.geometry.meshes.change(0).normals_at_close.resize(2); }),
              HasSubstr("meshes[0].normals_at_close: must have one entry for each"));
  EXPECT_THAT(error_after([](auto& s) { s.geometry.meshes.change(0).normals.clear(); }),
              HasSubstr("meshes[0].normals_at_close: must be empty unless the mesh has normals"));
  EXPECT_THAT(error_after([](auto& s) { s.geometry.meshes.change(0).positions_at_close.clear(); }),
              HasSubstr("meshes[0].normals_at_close: must be empty unless the mesh has normals"));
  // Two corners of the boundary move apart: it is closed when the shutter opens, and open
  // afterwards.
  EXPECT_THAT(error_after([](auto& s) {
                Mesh& mesh = s.media.boundaries.meshes.change(0);
                for (auto* list : {&mesh.positions, &mesh.positions_at_close, &mesh.normals,
                                   &mesh.normals_at_close}) {
                  list->push_back(list->at(mesh.triangles[0][0]));
                }
                mesh.positions_at_close.back()[0] += 1;
                mesh.triangles[0][0] = static_cast<std::uint32_t>(mesh.positions.size() - 1);
              }),
              HasSubstr("boundaries.meshes[0]: must be closed, has"));
}

// A triangle that has no area when the shutter opens and closes, and has an area in between, can be
// hit, so it is kept.
TEST(DeformingScene, OnlyTrianglesThatAreNeverHitAreRemoved) {
  SceneMaker maker;
  maker.camera({0, 0, 5}, {0, 0, 0}, 40);
  Mesh mesh;
  mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {5, 5, 5}};
  mesh.positions_at_close = {{0, -1, 0}, {0, 1, 0}, {0, 1, 0}, {5, 5, 5}};
  mesh.positions[2] = {-0.5f, 0, 0};
  mesh.triangles = {{0, 1, 2}, {3, 3, 0}, {3, 0, 3}};
  maker.instance(mesh, {}, maker.lamp(1));
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = kExposure;
  const auto scene = maker.build();
  EXPECT_EQ(scene->dropped_primitives(), 2u);
  EXPECT_EQ(scene->lights().size(), 1u);
  EXPECT_TRUE(moves(scene->geometry()));
}

}  // namespace
}  // namespace bandsaw
