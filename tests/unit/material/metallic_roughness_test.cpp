// glTF's material and rough glass: samples, values and bounds agree. An id such as M10 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderlib/material/bsdf.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/shading_normal.h"
#include "renderlib/math/constants.h"
#include "tests/support/direction_test.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Random;
using test::random_direction;

const std::vector<Texture> kTextures = {ConstantTexture{{1, 1, 1}},
                                        ConstantTexture{{0.7f, 0.35f, 0.9f}}};

SurfacePoint point(const Vec3& shading) {
  SurfacePoint p;
  p.geometric_normal = {0, 0, 1};
  p.shading_normal = normalize(shading);
  p.along_u = {1, 0, 0};
  p.along_v = {0, 1, 0};
  return p;
}

/// Returns the BSDF for light that is scattered in the direction `wo`. The geometric normal is +z.
Bsdf bsdf(const Material& material, const Vec3& wo, const Vec3& shading = {0, 0, 1}) {
  return bsdf_at(material, kTextures, point(shading), normalize(wo));
}

struct Named {
  std::string name;
  Material material;
};

/// Returns glTF's material with these numbers.
MetallicRoughness layered(double metallic, double roughness) {
  MetallicRoughness m;
  m.metallic.factor = metallic;
  m.roughness.factor = roughness;
  return m;
}

/// Returns variations of glTF's material and of glass, with this roughness.
std::vector<Named> all_materials(double roughness) {
  MetallicRoughness tinted = layered(0.4, roughness);
  tinted.base_color = {TextureId{1}, {0.9f, 1, 0.5f}};
  MetallicRoughness coated = layered(0.2, roughness);
  coated.coat.factor = 0.8;
  coated.coat_roughness.factor = 0.5;
  MetallicRoughness thin = layered(0, roughness);
  thin.transmission.factor = 0.7;
  MetallicRoughness coated_thin = layered(0.3, roughness);
  coated_thin.coat.factor = 1;
  coated_thin.coat_roughness.factor = 0.6;
  coated_thin.transmission.factor = 0.5;
  Material bumped = coated_thin;
  bumped.relief.normal = TextureId{1};
  return {{"plastic", layered(0, roughness)},
          {"metal", layered(1, roughness)},
          {"tinted", tinted},
          {"coated", coated},
          {"thin", thin},
          {"bumped", bumped},
          {"glass", Dielectric{1.5, roughness}},
          {"dense glass", Dielectric{2.4, roughness}}};
}

const Vec3 kDirections[] = {{0, 0, 1}, {0.6, 0.3, 0.5}, {0.8, 0.3, 0.08}, {0.3, -0.5, -0.7}};

TEST(MetallicRoughness, SamplesFollowTheirDensity) {
  for (const double roughness : {0.8, 1.0}) {
    for (const auto& [name, material] : all_materials(roughness)) {
      for (const Vec3& wo : kDirections) {
        SCOPED_TRACE(name + " " + std::to_string(roughness) + " " + std::to_string(wo.z));
        const Bsdf b = bsdf(material, wo, {0.1, 0.05, 1});
        Random lobes(9);
        test::expect_samples_match_density(
            [&](double u, double v) {
              const auto drawn = sample(b, u, v, lobes.uniform());
              return drawn ? drawn->wi : Vec3{};
            },
            [&](const Vec3& wi) { return evaluate(b, wi).pdf; }, /*seed=*/17, /*tests=*/64);
      }
    }
  }
}

TEST(MetallicRoughness, SampleWeightsAreValueOverPdf) {
  Random random(12);
  for (const double roughness : {0.0, 0.02, 0.3, 1.0}) {
    for (const auto& [name, material] : all_materials(roughness)) {
      for (int i = 0; i < 3000; ++i) {
        const Bsdf b = bsdf(material, random_direction(random), random_direction(random));
        const double u = random.uniform();
        const double v = random.uniform();
        const auto drawn = sample(b, u, v, random.uniform());
        if (!drawn || drawn->delta) {
          continue;
        }
        const BsdfValue value = evaluate(b, drawn->wi);
        ASSERT_TRUE(std::isfinite(drawn->pdf) && drawn->pdf > 0) << name;
        const double tolerance = roughness < 0.1 ? 1e-3 : 1e-6;
        ASSERT_NEAR(value.pdf / drawn->pdf, 1, tolerance) << name << " " << roughness;
        ASSERT_NEAR(value.value.g / drawn->pdf, drawn->weight.g, 2 * tolerance) << name;
      }
    }
  }
}

// Under light of radiance 1 from all directions, a surface may scatter a radiance of at most 1.
// Light that enters or leaves glass changes its radiance by the square of the index. This factor,
// `compression`, is divided out. White plastic scatters nearly all of the light.
TEST(MetallicRoughness, ReflectanceIsAtMostOne) {
  constexpr int kSide = 48;
  for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
    for (const auto& [name, material] : all_materials(roughness)) {
      for (const double mu : {1.0, 0.7, 0.3, 0.05, -0.4, -0.05}) {
        const Bsdf b = bsdf(material, {std::sqrt(1 - mu * mu), 0, mu});
        Random random(2);
        test::Moments sum;
        for (int i = 0; i < kSide * kSide; ++i) {
          const double u = random.uniform();
          const double v = random.uniform();
          const auto drawn = sample(b, u, v, random.uniform());
          sum.add(drawn ? max_component(drawn->weight) / drawn->compression : 0);
        }
        ASSERT_LE(sum.mean(), 1.003 + 4 * sum.standard_error())
            << name << " " << roughness << " " << mu;
        if (name == "plastic" && roughness == 0.3) {
          EXPECT_GT(sum.mean(), 0.9) << mu;
        }
      }
    }
  }
}

TEST(MetallicRoughness, ReflectionIsReciprocal) {
  Random random(6);
  for (const auto& [name, material] : all_materials(0.5)) {
    if (name == "bumped") {
      continue;  // the shading normal is bent towards wo, so it depends on wo
    }
    const bool glass = std::holds_alternative<Dielectric>(material.kind);
    for (int i = 0; i < 5000; ++i) {
      Vec3 a = random_direction(random);
      Vec3 b = random_direction(random);
      if (std::abs(a.z) < 1e-3 || std::abs(b.z) < 1e-3 || (!glass && a.z < 0)) {
        continue;
      }
      const double ab = evaluate(bsdf(material, a), b).value.g / std::abs(b.z);
      const double ba = evaluate(bsdf(material, b), a).value.g / std::abs(a.z);
      // Radiance through a boundary is scaled by the square of the index.
      const double eta = glass ? std::get<Dielectric>(material.kind).index_of_refraction : 1;
      const double scale = a.z * b.z > 0 ? 1 : a.z > 0 ? eta * eta : 1 / (eta * eta);
      ASSERT_NEAR(ab * scale, ba, 1e-5 * (1e-3 + ba)) << name;
    }
  }
}

TEST(MetallicRoughness, M10OpaqueSurfacesPassNoLightForAnyNormals) {
  Random random(4);
  for (const double roughness : {0.05, 0.6}) {
    for (const auto& [name, material] : all_materials(roughness)) {
      if (name == "thin" || name == "bumped" || std::holds_alternative<Dielectric>(material.kind)) {
        continue;
      }
      for (int i = 0; i < 5000; ++i) {
        const Vec3 wo = random_direction(random);
        const Vec3 wi = random_direction(random);
        const Bsdf b = bsdf(material, wo, random_direction(random));
        if (wo.z * wi.z < 0) {
          ASSERT_EQ(evaluate(b, wi).pdf, 0);
          ASSERT_TRUE(is_black(evaluate(b, wi).value));
        }
        const double u = random.uniform();
        const double v = random.uniform();
        const auto drawn = sample(b, u, v, random.uniform());
        ASSERT_TRUE(!drawn || wo.z * drawn->wi.z > 0);
      }
    }
  }
}

TEST(MetallicRoughness, M2M5EdgesOfTheRangesOfParametersGiveFiniteNumbers) {
  const double least = 0x1p-32;
  for (const double roughness : {0.0, 0.01, 1.0}) {
    for (const auto& [name, material] : all_materials(roughness)) {
      for (const Vec3& wo : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{1, 0, 1e-12}, Vec3{1, 0, -1e-4}}) {
        const Bsdf b = bsdf(material, wo);
        const BsdfValue back = evaluate(b, -normalize(wo));
        ASSERT_TRUE(is_finite(back.value) && std::isfinite(back.pdf)) << name;
        for (const double u : {0.0, least, 1 - least}) {
          for (const double v : {0.0, least, 1 - least}) {
            for (const double w : {0.0, 0.5, 1 - least}) {
              const auto drawn = sample(b, u, v, w);
              ASSERT_TRUE(!drawn || (is_finite(drawn->wi) && is_finite(drawn->weight) &&
                                     std::isfinite(drawn->pdf)))
                  << name;
            }
          }
        }
      }
    }
  }
  test::report_hard_case("M2", "glTF material: no NaN at the ends of the range of any parameter");
}

TEST(MetallicRoughness, SmoothDielectricsReflectFresnelAtNormalIncidence) {
  MetallicRoughness black = layered(0, 0.2);
  black.base_color.factor = {0, 0, 0};
  const Bsdf b = bsdf(black, {0, 0, 1});
  Random random(1);
  double sum = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double u = random.uniform();
    const auto drawn = sample(b, u, random.uniform(), 0.5);
    sum += drawn ? drawn->weight.g : 0;
  }
  EXPECT_NEAR(sum / kSamples, 0.04, 4e-4);
}

TEST(MetallicRoughness, MetalnessIsReadFromBlueAndRoughnessFromGreen) {
  MetallicRoughness m = layered(1, 1);
  m.metallic.texture = TextureId{1};
  m.roughness.texture = TextureId{1};
  const auto b = std::get<MetallicRoughnessBsdf>(bsdf(m, {0, 0, 1}));
  EXPECT_NEAR(b.metallic, 0.9, 1e-7);
  EXPECT_NEAR(b.surface.roughness, 0.35, 1e-7);
  EXPECT_NEAR(b.surface.alpha, 0.35 * 0.35, 1e-7);
}

TEST(RoughGlass, M6RoughGlassOfIndexOneIsInvisible) {
  const Vec3 wo = normalize({0.3, 0.4, -0.2});
  const auto through = sample(bsdf(Dielectric{1, 0.5}, wo), 0.3, 0.2, 0.1);
  ASSERT_TRUE(through && through->delta);
  EXPECT_NEAR(length(through->wi + wo), 0, 1e-14);
  test::report_hard_case("M6", "rough glass: transmitted direction within 1e-14");
}

// A texel t stands for the normal 2 t - 1. So (0.5, 0.5, 1) is the normal (0, 0, 1), (1, 0.5, 0.5)
// is (1, 0, 0), and (0.5, 0.75, 0.933) is (0, 0.5, 0.866).
TEST(ShadingNormal, AFlatTexelChangesNothingAndATiltedOneTiltsAlongTheUvs) {
  const SurfacePoint p = point({0, 0, 1});
  EXPECT_NEAR(length(mapped_normal(p, {0.5f, 0.5f, 1}, 1) - Vec3{0, 0, 1}), 0, 1e-7);
  const Vec3 right = mapped_normal(p, {1, 0.5f, 0.5f}, 1);
  EXPECT_GT(right.x, 0.99);
  const Vec3 up = mapped_normal(p, {0.5f, 0.75f, 0.933f}, 1);
  EXPECT_NEAR(up.y, 0.5, 2e-2);
  SurfacePoint mirrored = p;
  mirrored.along_v = {0, -1, 0};
  EXPECT_NEAR(mapped_normal(mirrored, {0.5f, 0.75f, 0.933f}, 1).y, -0.5, 2e-2);
}

// The texel tilts the normal to the right in the map. If the map is turned by a quarter turn, the
// normal tilts upwards on the surface. If the map is mirrored in u, the normal tilts to the left.
TEST(ShadingNormal, ATransformedMapTiltsAlongItsOwnAxes) {
  const SurfacePoint p = point({0, 0, 1});
  const Rgb tilted{1, 0.5f, 0.5f};
  const auto normal = [&](const std::array<double, 6>& m) {
    return mapped_normal(p, tilted, 1, UvTransform{m});
  };
  // The map's coordinates are (s, t) = (v, 1 - u), so s grows where v grows.
  EXPECT_GT(normal({0, 1, 0, -1, 0, 1}).y, 0.99);
  EXPECT_LT(normal({-1, 0, 1, 0, 1, 0}).x, -0.99);
  EXPECT_GT(normal({5, 0, 0, 0, 3, 0}).x, 0.99) << "a scaled map must tilt the same way";
  EXPECT_NEAR(mapped_normal(p, {0.5f, 0.75f, 0.933f}, 1, UvTransform{{-1, 0, 1, 0, 1, 0}}).y, 0.5,
              2e-2);
}

TEST(ShadingNormal, T15_UvsWithoutAreaGiveAUnitNormal) {
  SurfacePoint p = point({0.2, 0.1, -0.9});
  for (const Vec3& along : {Vec3{}, Vec3{0.2, 0.1, -0.9}, Vec3{1e-300, 0, 0}}) {
    p.along_u = along;
    const Vec3 n = mapped_normal(p, {0.9f, 0.1f, 0.4f}, 2);
    EXPECT_NEAR(length(n), 1, 1e-12);
  }
  test::report_hard_case("T15", "the normal has length 1 and no NaN");
}

TEST(ShadingNormal, NormalsThatFaceAwayAreBentAsLittleAsNeeded) {
  Random random(7);
  const Vec3 up{0, 0, 1};
  for (int i = 0; i < 100000; ++i) {
    Vec3 wo = random_direction(random);
    wo.z = std::abs(wo.z);
    const Vec3 n = random_direction(random);
    const Vec3 bent = visible_normal(n, up, wo);
    ASSERT_NEAR(length(bent), 1, 1e-12);
    ASSERT_GT(dot(wo, bent), 0);
    ASSERT_GT(mirrored(wo, bent).z, 0);
    // A normal that faces wo is kept if the mirror image of wo has a cosine of more than about 0.01
    // to the geometric normal.
    if (dot(wo, n) > 0 && mirrored(wo, n).z > 0.011) {
      ASSERT_EQ(bent, n);
    }
  }
}

}  // namespace
}  // namespace bandsaw
