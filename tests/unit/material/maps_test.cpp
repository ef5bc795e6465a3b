// Numbers of a material, such as its roughness, that vary over a surface. At each point, a material
// with a map must equal a material that has the map's value at this point as a constant number.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

#include "renderlib/material/albedo.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/opacity.h"
#include "renderlib/material/shading_normal.h"
#include "renderlib/texture/noise.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

using test::Random;
using test::random_direction;

/// White, a half, a quarter, and a checker of the last two in uv.
const std::vector<Texture> kTextures = {ConstantTexture{{1, 1, 1}},
                                        ConstantTexture{{0.5f, 0.5f, 0.5f}},
                                        ConstantTexture{{0.25f, 0.25f, 0.25f}},
                                        CheckerTexture{.even = TextureId{1}, .odd = TextureId{2}}};
constexpr TextureId kChecker{3};

/// Returns a point with the texture coordinates (u, 0.5) in both sets of uvs.
SurfacePoint point(double u, const Vec3& normal = {0, 0, 1}) {
  SurfacePoint p;
  p.geometric_normal = p.shading_normal = normal;
  p.along_u = {1, 0, 0};
  p.along_v = {0, 1, 0};
  p.uv = p.uv2 = {u, 0.5};
  return p;
}

/// Returns a normal map of one texel, whose normal leans along the u axis of the map.
ImageTexture tilted_map(UvSet set) {
  ImageTexture map;
  map.width = 1;
  map.height = 1;
  map.format = ImageTexture::Format::kFloat32;
  map.channels = 3;
  const std::array<float, 3> texel{0.75f, 0.5f, 1};
  const auto bytes = std::as_bytes(std::span(texel));
  map.texels = std::vector<std::byte>(bytes.begin(), bytes.end());
  map.uv_set = set;
  return map;
}

// The base and the coat have the same normal map, but the base uses the first set of uvs and the
// coat the second. The second set is turned by a quarter turn. So the normal of the base leans
// along x, and the normal of the coat leans along y.
TEST(Maps, TheNormalMapOfTheCoatUsesItsOwnUvs) {
  const std::vector<Texture> textures = {ConstantTexture{{1, 1, 1}}, tilted_map(UvSet::kFirst),
                                         tilted_map(UvSet::kSecond)};
  SurfacePoint p = point(0.5);
  p.along_u2 = {0, 3, 0};
  p.along_v2 = {-3, 0, 0};
  MetallicRoughness layers;
  layers.coat.factor = 1;
  layers.coat_normal = TextureId{2};
  Material m = layers;
  m.relief.normal = TextureId{1};
  const UvSets sets = uv_sets_of(m, textures);
  EXPECT_TRUE(sets.first && sets.second);
  const auto bsdf = std::get<MetallicRoughnessBsdf>(bsdf_at(m, textures, p, {0, 0, 1}));
  const Vec3 leaning = normalize({0.5, 0, 1});
  EXPECT_NEAR(length(bsdf.normal.shading - leaning), 0, 1e-6);
  EXPECT_NEAR(length(bsdf.coat_normal - Vec3{0, leaning.x, leaning.z}), 0, 1e-6);
}

TEST(AlphaMask, IsOpaqueWhereAlphaEqualsTheCutoff) {
  for (int k = 1; k <= 255; ++k) {
    const double cutoff = k / 255.0;
    const auto grey = static_cast<float>(cutoff);
    const std::vector<Texture> textures{ConstantTexture{gray(grey)},
                                        ConstantTexture{gray(std::nextafter(grey, 0.0f))}};
    for (const bool luminance : {false, true}) {
      Material masked = Diffuse{TextureId{0}};
      masked.alpha = {AlphaMode::kMask, {TextureId{0}, 1}, luminance, cutoff};
      EXPECT_EQ(opacity(masked, textures, point(0.5)), 1) << cutoff << " " << luminance;
      masked.alpha.value.texture = TextureId{1};
      EXPECT_EQ(opacity(masked, textures, point(0.5)), 0) << cutoff << " " << luminance;
    }
  }
}

/// Returns the point (x, y) of a square in the plane z = 0, which has a corner at the origin and
/// sides of length `side` along x and y.
SurfacePoint on_quad(double side, double x, double y) {
  SurfacePoint p = point(x / side);
  p.position = {x, y, 0};
  p.uv = p.uv2 = {x / side, y / side};
  p.along_u = {side, 0, 0};
  p.along_v = {0, side, 0};
  return p;
}

/// Returns a height map that repeats `scale` times while u increases by 1. It has 64 waves along u,
/// each of 16 texels.
ImageTexture waves(double scale) {
  ImageTexture map;
  map.width = 1024;
  map.height = 1;
  map.format = ImageTexture::Format::kFloat32;
  map.channels = 1;
  std::vector<float> heights;
  for (int i = 0; i < 1024; ++i) {
    heights.push_back(0.5f + 0.5f * std::sin(static_cast<float>(i) * 0.3926991f));
  }
  const auto bytes = std::as_bytes(std::span(heights));
  map.texels = std::vector<std::byte>(bytes.begin(), bytes.end());
  map.uv_transform.m = {scale, 0, 0, 0, scale, 0};
  return map;
}

// A repetition of the map is one unit long on each of the quads, so all quads have the same relief.
// The slope jumps in the middles of texels, so no tested point is such a middle. Heights are
// rounded to float, which changes the slope by about 2^-11 of the height. The tolerance is ten
// times this error for the height of 0.005.
TEST(HeightMap, GivesTheSameReliefHoweverOftenItRepeats) {
  for (const double x : {0.3, 0.54, 0.78}) {
    const std::vector<Texture> once{waves(1)};
    const Vec3 expected = displaced_normal(on_quad(1, x, 0.3), once, TextureId{0}, 0.005);
    EXPECT_GT(std::abs(expected.x), 0.2);
    for (const double scale : {30, 200}) {
      const std::vector<Texture> often{waves(scale)};
      const Vec3 normal = displaced_normal(on_quad(scale, x, 0.3), often, TextureId{0}, 0.005);
      EXPECT_LE(length(normal - expected), 2.5e-5) << x << " " << scale;
    }
  }
}

// The size of a quad does not change the relief of a noise in space. The expected slope is a
// difference of heights in double. The renderer takes the slope from two heights that are rounded
// to float, 2^-13 of a cell of the noise apart. The rounding changes the slope by about 2^-11 of
// the height per cell, and a unit has 12 cells. The tolerance is four times this error: 4 * 12 *
// 2^-11 of the height 0.02.
TEST(HeightMap, TheReliefOfANoiseInSpaceDoesNotDependOnTheQuad) {
  const std::vector<Texture> textures{NoiseTexture{.scale = 12}};
  constexpr double kHeight = 0.02;
  for (const double x : {0.31, 0.52, 0.77}) {
    const auto height = [&](double dx, double dy) {
      return kHeight * 0.5 * (1 + noise({12 * (x + dx), 12 * (0.17 + dy), 0}));
    };
    constexpr double kStep = 1e-5;
    const Vec3 expected = normalize({(height(-kStep, 0) - height(kStep, 0)) / (2 * kStep),
                                     (height(0, -kStep) - height(0, kStep)) / (2 * kStep), 1});
    EXPECT_LT(expected.z, 0.9999);
    for (const double side : {1, 4000}) {
      const Vec3 normal = displaced_normal(on_quad(side, x, 0.17), textures, TextureId{0}, kHeight);
      EXPECT_LE(length(normal - expected), 5e-4) << x << " " << side;
    }
  }
}

// The ramp rises by 2 within 0.001 units. The scale of 0.0005 makes that a slope of 1. The quad has
// sides of 4000 units.
TEST(HeightMap, FollowsAShortRamp) {
  RampTexture ramp;
  ramp.over = RampTexture::Over::kX;
  ramp.stops = {{0.3, gray(0)}, {0.301, gray(2)}};
  const std::vector<Texture> textures{ramp};
  const Vec3 normal = displaced_normal(on_quad(4000, 0.3005, 0.3), textures, TextureId{0}, 0.0005);
  EXPECT_LE(length(normal - normalize({-1, 0, 1})), 1e-3);
}

/// Expects that `mapped` equals `there` at u = 0.5 and `next` at u = 1.5, for directions on all
/// sides. The texture kChecker is a half at u = 0.5 and a quarter at u = 1.5. This texture
/// multiplies the number of the material. If the number is an index of refraction, the texture
/// multiplies only the part above 1.
void expect_same(const Material& mapped, const Material& there, const Material& next) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = random_direction(random);
    const Vec3 wi = random_direction(random);
    const double numbers[3] = {random.uniform(), random.uniform(), random.uniform()};
    for (const auto& [u, plain] : {std::pair(0.5, there), std::pair(1.5, next)}) {
      const Bsdf a = bsdf_at(mapped, kTextures, point(u), wo);
      const Bsdf b = bsdf_at(plain, kTextures, point(u), wo);
      const auto sample_a = sample(a, numbers[0], numbers[1], numbers[2]);
      const auto sample_b = sample(b, numbers[0], numbers[1], numbers[2]);
      ASSERT_EQ(sample_a.has_value(), sample_b.has_value());
      if (sample_a) {
        ASSERT_EQ(sample_a->wi, sample_b->wi);
        ASSERT_EQ(sample_a->pdf, sample_b->pdf);
      }
      ASSERT_EQ(evaluate(a, wi).value, evaluate(b, wi).value);
    }
  }
}

TEST(Maps, FuzzVaries) {
  expect_same(Metal{TextureId{0}, 0.5, kChecker}, Metal{TextureId{0}, 0.25},
              Metal{TextureId{0}, 0.125});
}

TEST(Maps, RoughnessAndIndexOfGlassVary) {
  expect_same(Dielectric{1.5, 0.5, 0, kChecker}, Dielectric{1.5, 0.25}, Dielectric{1.5, 0.125});
  expect_same(Dielectric{3, 0, 0, std::nullopt, kChecker}, Dielectric{2}, Dielectric{1.5});
}

TEST(Maps, EveryNumberOfGltfVaries) {
  const auto with = [](double value, TextureId texture) {
    MetallicRoughness m;
    m.metallic = m.roughness = m.coat = m.coat_roughness = m.transmission = {texture, value};
    return m;
  };
  expect_same(with(0.5, kChecker), with(0.25, TextureId{0}), with(0.125, TextureId{0}));
}

TEST(Maps, TheIndexOfGltfVaries) {
  const auto with = [](double index, std::optional<TextureId> map) {
    MetallicRoughness m;
    m.index_of_refraction = index;
    m.index_map = map;
    return m;
  };
  expect_same(with(3, kChecker), with(2, std::nullopt), with(1.5, std::nullopt));
}

// With the scale 0, the normal map has no effect on the coat either.
TEST(Maps, TheNormalMapOfTheCoatBendsOnlyTheNormalOfTheCoat) {
  std::vector<Texture> textures = kTextures;
  textures.emplace_back(ConstantTexture{{0.75f, 0.5f, 1}});
  MetallicRoughness m;
  m.coat.factor = 1;
  m.coat_normal = TextureId{4};
  const Bsdf bent = bsdf_at(m, textures, point(0.5), {0, 0, 1});
  const auto& layers = std::get<MetallicRoughnessBsdf>(bent);
  EXPECT_EQ(layers.normal.shading, (Vec3{0, 0, 1}));
  EXPECT_GT(layers.coat_normal.x, 0.3);
  m.coat_normal_scale = 0;
  const auto flat = std::get<MetallicRoughnessBsdf>(bsdf_at(m, textures, point(0.5), {0, 0, 1}));
  EXPECT_NEAR(length(flat.coat_normal - Vec3{0, 0, 1}), 0, 1e-7);
}

TEST(Maps, VertexColoursTintDiffuseMetalAndGltfMaterials) {
  SurfacePoint tinted = point(0.5);
  tinted.color = {0.5f, 0.25f, 2};
  for (const Material& material : {Material(Diffuse{TextureId{0}}), Material(Metal{TextureId{0}}),
                                   Material(MetallicRoughness{})}) {
    EXPECT_EQ(albedo_at(material, kTextures, tinted), (Rgb{0.5f, 0.25f, 1}));
  }
  const Bsdf diffuse = bsdf_at(Diffuse{TextureId{0}}, kTextures, tinted, {0, 0, 1});
  EXPECT_EQ(std::get<DiffuseBsdf>(diffuse).reflectance, (Rgb{0.5f, 0.25f, 1}));
}

}  // namespace
}  // namespace bandsaw
