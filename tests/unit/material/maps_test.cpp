// Material numbers that vary over a surface: where a map has a value, the material equals the one
// with that number.

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <variant>
#include <vector>

#include "renderlib/material/albedo.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/shading_normal.h"
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

SurfacePoint point(double u, const Vec3& normal = {0, 0, 1}) {
  SurfacePoint p;
  p.geometric_normal = p.shading_normal = normal;
  p.along_u = {1, 0, 0};
  p.along_v = {0, 1, 0};
  p.uv = p.uv2 = {u, 0.5};
  return p;
}

/// A normal map of one texel that leans along its u.
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

// The uvs of the second set are turned by a quarter, so the normal of the coat leans along y; that
// of the base, whose map is the same in the first set, leans along x.
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

/// Returns true if `mapped` equals `there` at u = 0.5 and `next` at u = 1.5, from all sides.
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

TEST(Maps, TheCoatBendsWithItsOwnNormals) {
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

TEST(Maps, ColoursOfVerticesTintWhatIsDiffuseMetalOrGltf) {
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
