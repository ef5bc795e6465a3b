// Tests the integrators other than `path`: normals, depth, albedo, ambient occlusion and direct
// light.

#include "renderlib/integrate/sample_value.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::SceneMaker;

/// Returns the value of one sample along the ray. `sample`: the number of the sample.
Rgb value(const SceneMaker& maker, Integrator integrator, const Ray& ray,
          std::uint64_t sample = 0) {
  PathCounts counts;
  return sample_value(*maker.build(), integrator, ray, PixelSampler(1, 2, 3), sample,
                      {.max_depth = 16, .local = integrator == Integrator::kDirect}, counts);
}

/// Expects the mean of many pixels to be `expected` within 4 standard errors, and returns the mean.
/// A false alarm has the probability 6e-5.
double expect_mean(const SceneMaker& maker, Integrator integrator, const Ray& ray,
                   double expected) {
  const auto scene = maker.build();
  test::Moments moments;
  PathCounts counts;
  for (std::uint32_t pixel = 0; pixel < 20'000; ++pixel) {
    moments.add(sample_value(*scene, integrator, ray, PixelSampler(1, pixel, 3), 0,
                             {.max_depth = 16, .local = integrator == Integrator::kDirect}, counts)
                    .g);
  }
  EXPECT_LT(std::abs(moments.z(expected)), 4) << moments.mean() << " for " << expected;
  return moments.mean();
}

const Ray kAhead{.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}};

TEST(SampleValue, NormalsDepthAndAlbedoAreThoseOfTheFirstSurface) {
  SceneMaker maker;
  maker.wall(maker.diffuse({0.2f, 0.4f, 0.6f}), -2);
  EXPECT_EQ(value(maker, Integrator::kNormals, kAhead), (Rgb{0.5f, 0.5f, 1}));
  EXPECT_EQ(value(maker, Integrator::kDepth, kAhead), gray(7));
  EXPECT_EQ(value(maker, Integrator::kAlbedo, kAhead), (Rgb{0.2f, 0.4f, 0.6f}));
  maker.sphere({0.1, 0.2, 0}, 1, maker.metal(0.75f, 0.3));
  EXPECT_EQ(value(maker, Integrator::kDepth, kAhead), gray(4));
  EXPECT_EQ(value(maker, Integrator::kAlbedo, kAhead), gray(0.75f));
}

TEST(SampleValue, TheAlbedoOfAnEmitterIsClampedAndTheAlbedoOfGlassIsWhite) {
  SceneMaker maker;
  maker.sphere({0.1, 0.2, 0}, 1, maker.lamp(3));
  EXPECT_EQ(value(maker, Integrator::kAlbedo, kAhead), gray(1));
  SceneMaker glass;
  glass.sphere({0.1, 0.2, 0}, 1, glass.glass(1.5));
  EXPECT_EQ(value(glass, Integrator::kAlbedo, kAhead), gray(1));
}

TEST(SampleValue, AlbedoOfAGltfMaterialIsItsBaseColour) {
  SceneMaker maker;
  const TextureId gold = maker.texture(ConstantTexture{{0.8f, 0.6f, 0.4f}});
  MetallicRoughness material;
  material.base_color = {gold, {0.5f, 1, 0.25f}};
  material.metallic = {gold, 1};
  material.roughness = {gold, 0.5};
  material.coat.texture = material.coat_roughness.texture = material.transmission.texture = gold;
  maker.wall(maker.material(material));
  EXPECT_EQ(value(maker, Integrator::kAlbedo, kAhead), (Rgb{0.4f, 0.6f, 0.1f}));
}

TEST(SampleValue, UsesNormalMapsAndSkipsHoles) {
  SceneMaker maker;
  maker.wall(maker.diffuse({0.2f, 0.4f, 0.6f}), -2);
  Material bent = MetallicRoughness{};
  bent.relief.normal = maker.texture(ConstantTexture{{0.75f, 0.5f, 0.75f}});
  const MaterialId id = maker.material(bent);
  maker.wall(id);
  // The normal of the map is n = (1, 0, 1) / sqrt(2), and the image shows (n + 1) / 2.
  const Rgb normal = value(maker, Integrator::kNormals, kAhead);
  EXPECT_NEAR(normal.r, 0.5 + std::sqrt(0.125), 1e-6);
  EXPECT_NEAR(normal.b, 0.5 + std::sqrt(0.125), 1e-6);
  Alpha& alpha = maker.scene.materials.back().alpha;
  alpha.mode = AlphaMode::kMask;
  alpha.value.factor = 0.25;
  EXPECT_EQ(value(maker, Integrator::kDepth, kAhead), gray(7));
  EXPECT_EQ(value(maker, Integrator::kAlbedo, kAhead), (Rgb{0.2f, 0.4f, 0.6f}));
}

// A normal map that tilts along u uses the second uv set, whose u grows along y.
TEST(SampleValue, ANormalMapTiltsAlongItsUvSet) {
  SceneMaker maker;
  ImageTexture map;
  map.width = map.height = 1;
  map.format = ImageTexture::Format::kLinear8;
  map.uv_set = UvSet::kSecond;
  map.texels = std::vector<std::byte>{std::byte{255}, std::byte{128}, std::byte{128}};
  Material bent = MetallicRoughness{};
  bent.relief.normal = maker.texture(map);
  const MaterialId id = maker.material(bent);
  Mesh mesh;
  mesh.positions = {{-9, -9, 0}, {9, -9, 0}, {-9, 9, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.uvs2 = {{0, 0}, {0, -1}, {1, 0}};
  mesh.triangles = {{0, 1, 2}};
  Geometry& geometry = maker.scene.geometry;
  geometry.meshes.push_back(mesh);
  geometry.instances.push_back({MeshId{0}, id, Transform{}});
  const Ray ahead{.origin = {-3, -3, 5}, .direction = {0, 0, -1}};
  EXPECT_GT(value(maker, Integrator::kNormals, ahead).g, 0.99f);
  std::get<ImageTexture>(maker.scene.textures.back()).uv_set = UvSet::kFirst;
  EXPECT_GT(value(maker, Integrator::kNormals, ahead).r, 0.99f);
}

TEST(SampleValue, AMissIsBlackAndUnoccluded) {
  SceneMaker maker;
  maker.sphere({50, 0, 0}, 1, maker.diffuse(0.5f));
  maker.background(gray(3), gray(3));
  for (const Integrator integrator :
       {Integrator::kNormals, Integrator::kDepth, Integrator::kAlbedo}) {
    EXPECT_EQ(value(maker, integrator, kAhead), Rgb{});
  }
  EXPECT_EQ(value(maker, Integrator::kAmbientOcclusion, kAhead), gray(1));
  EXPECT_EQ(value(maker, Integrator::kDirect, kAhead), gray(3));
}

TEST(SampleValue, ABallAboveOccludesItsViewFactor) {
  SceneMaker maker;
  maker.wall(maker.diffuse(0.5f));
  maker.sphere({0, 0, 4}, 2, maker.diffuse(0.5f));
  const Ray below{.origin = {0, 0, 1}, .direction = {0, 0, -1}};
  // The view factor of a ball of radius r at distance d along the normal is (r / d)^2.
  expect_mean(maker, Integrator::kAmbientOcclusion, below, 0.75);
  maker.scene.local_shading.occlusion_distance = 2.5;
  const double near = expect_mean(maker, Integrator::kAmbientOcclusion, below,
                                  // Rays that hit the ball nearer than 2.5 are in a cone. The rim
                                  // of the cone is the circle in which the ball meets a sphere of
                                  // radius 2.5 about the point. The circle is at
                                  // z = (2.5^2 + 4^2 - 2^2) / 8. So sin^2 of the half-angle, which
                                  // is the occluded share, is 1 - (z / 2.5)^2.
                                  std::pow((2.5 * 2.5 + 12) / 8 / 2.5, 2));
  EXPECT_GT(near, 0.75);
  maker.scene.local_shading.occlusion_distance = 1.9;
  EXPECT_EQ(expect_mean(maker, Integrator::kAmbientOcclusion, below, 1), 1);
}

TEST(SampleValue, AmbientOcclusionSkipsHolesAndHiddenLamps) {
  SceneMaker maker;
  maker.wall(maker.diffuse(0.5f));
  Material hole = MetallicRoughness{};
  hole.alpha = {AlphaMode::kMask, {TextureId{0}, 0}};
  maker.wall(maker.material(hole), 2);
  const MaterialId lamp = maker.lamp(1);
  std::get<Emissive>(maker.scene.materials[index_of(lamp)].kind).hidden = true;
  maker.wall(lamp, 3);
  EXPECT_EQ(expect_mean(maker, Integrator::kAmbientOcclusion, kAhead, 1), 1);
}

TEST(SampleValue, DirectIsIrradianceAndAmbientTerm) {
  SceneMaker maker;
  maker.wall(maker.diffuse(0.5f));
  maker.sphere({0, 0, 4}, 2, maker.lamp(3));
  maker.scene.local_shading.ambient = gray(0.25f);
  const Ray below{.origin = {0, 0, 1}, .direction = {0, 0, -1}};
  // The value is the irradiance pi L (r / d)^2 times albedo / pi, plus the albedo times the ambient
  // radiance.
  expect_mean(maker, Integrator::kDirect, below, 0.5 * 3 * 0.25 + 0.5 * 0.25);
}

TEST(SampleValue, DirectHasNoInterreflection) {
  SceneMaker maker;
  maker.wall(maker.diffuse(0.5f));
  maker.wall(maker.diffuse(0.9f), 20);
  maker.background(gray(7), gray(7));
  maker.scene.local_shading.ambient = {0.1f, 0.2f, 0.4f};
  for (std::uint64_t sample = 0; sample < 20; ++sample) {
    EXPECT_EQ(value(maker, Integrator::kDirect, kAhead, sample), (Rgb{0.05f, 0.1f, 0.2f}));
  }
}

TEST(SampleValue, DirectContinuesAtMirrorsAndGlass) {
  SceneMaker maker;
  maker.wall(maker.metal(0.5f, 0));
  maker.wall(maker.diffuse(0.5f), 20);
  maker.scene.local_shading.ambient = gray(1);
  EXPECT_EQ(value(maker, Integrator::kDirect, kAhead), gray(0.25f));
  SceneMaker glass;
  glass.sphere({0.1, 0.2, 0}, 1, glass.glass(1.5));
  glass.background(gray(2), gray(2));
  expect_mean(glass, Integrator::kDirect, kAhead, 2);
}

TEST(SampleValue, IntegratorsAreFoundByTheirNames) {
  for (int i = 0; i <= kLastIntegrator; ++i) {
    const auto integrator = static_cast<Integrator>(i);
    EXPECT_EQ(integrator_named(integrator_name(integrator)), integrator);
  }
  EXPECT_EQ(integrator_named("paths"), std::nullopt);
}

}  // namespace
}  // namespace bandsaw
