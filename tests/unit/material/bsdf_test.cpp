// BSDFs of diffuse surfaces, metal and glass: samples follow their density, and no light is created
// or lost. An id such as M14 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/material/bsdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/sampling/basis.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Random;

const std::vector<Texture> kTextures = {ConstantTexture{{0.5f, 0.25f, 1}}};

SurfacePoint point(const Vec3& geometric, const Vec3& shading) {
  SurfacePoint p;
  p.geometric_normal = normalize(geometric);
  p.shading_normal = normalize(shading);
  return p;
}

/// Returns the BSDF for light that is scattered in the direction `wo`. The geometric normal is +z.
Bsdf bsdf(const Material& material, const Vec3& wo, const Vec3& shading = {0, 0, 1}) {
  return bsdf_at(material, kTextures, point({0, 0, 1}, shading), normalize(wo));
}

/// Counts sampled directions in cells of equal solid angle around `axis`, and compares the counts
/// with the integral of the density over each cell. The cells cover all directions at an angle to
/// the axis with 1 - cos(angle) < `reach`. One further cell counts the samples that are absorbed or
/// fall outside of these cells. `name` is printed with a failure.
void expect_samples_follow_density(const Bsdf& bsdf, const Vec3& axis, double reach,
                                   const std::string& name) {
  constexpr int kCells = 12;
  constexpr int kSteps = 48;
  constexpr int kSamples = 200000;
  const Basis frame = orthonormal_basis(normalize(axis));
  std::vector<std::uint64_t> counts(kCells * kCells + 1);
  Random random(11);
  for (int i = 0; i < kSamples; ++i) {
    const double u = random.uniform();
    const double v = random.uniform();
    const auto drawn = sample(bsdf, u, v, random.uniform());
    std::size_t cell = kCells * kCells;
    if (drawn) {
      ASSERT_NEAR(length(drawn->wi), 1, 1e-14);
      ASSERT_NEAR(evaluate(bsdf, drawn->wi).pdf / drawn->pdf, 1, 1e-9);
      const Vec3 local = frame.to_local(drawn->wi);
      const double height = (1 - local.z) / reach;
      const double turn = std::atan2(local.y, local.x) / (2 * kPi) + 0.5;
      if (height < 1) {
        cell = static_cast<std::size_t>(height * kCells) * kCells +
               std::min<std::size_t>(kCells - 1, static_cast<std::size_t>(turn * kCells));
      }
    }
    ++counts[cell];
  }
  std::vector<double> expected(counts.size());
  double inside = 0;
  const double step_angle = reach * 2 * kPi / (kCells * kCells * kSteps * kSteps);
  for (int a = 0; a < kCells * kSteps; ++a) {
    for (int b = 0; b < kCells * kSteps; ++b) {
      const double z = 1 - reach * (a + 0.5) / (kCells * kSteps);
      const SinCos phi = sincos_turns((b + 0.5) / (kCells * kSteps) - 0.5);
      const double r = std::sqrt(1 - z * z);
      const double pdf = evaluate(bsdf, frame.to_world({r * phi.cos, r * phi.sin, z})).pdf;
      expected[static_cast<std::size_t>(a / kSteps * kCells + b / kSteps)] +=
          kSamples * pdf * step_angle;
      inside += pdf * step_angle;
    }
  }
  EXPECT_LT(inside, 1 + 2e-3) << name;
  expected.back() = kSamples * std::max(0.0, 1 - inside);
  // The tests call this function 14 times. The level of each call is so strict that, for 99 of 100
  // seeds, none of the 14 calls fails by chance.
  EXPECT_GT(test::chi_squared(counts, expected).p_value, test::sidak(0.01, 14)) << name;
}

TEST(Bsdf, DiffuseSamplesFollowTheirDensity) {
  for (const Vec3& wo : {Vec3{0, 0, 1}, Vec3{1, 0, 0.01}, Vec3{0.3, -0.5, -0.7}}) {
    const Vec3 axis{0, 0, wo.z};
    expect_samples_follow_density(bsdf(Diffuse{}, wo), axis, /*reach=*/1, "flat");
    expect_samples_follow_density(bsdf(Diffuse{}, wo, {0.4, 0.2, 1}), axis, /*reach=*/1, "bumped");
  }
}

TEST(Bsdf, FuzzyMetalSamplesFollowTheirDensity) {
  for (const double fuzz : {0.001, 0.1, 0.5, 1.0}) {
    for (const Vec3& wo : {Vec3{0.5, 0.2, 1}, Vec3{1, 0.1, 0.15}}) {
      const Vec3 mirror{-wo.x, -wo.y, wo.z};
      // The sine of the angle between a sampled direction and the mirror direction is at most
      // `fuzz`.
      const double reach = 1 - std::sqrt(1 - fuzz * fuzz);
      expect_samples_follow_density(bsdf(Metal{{}, fuzz}, wo), mirror, reach,
                                    "fuzz " + std::to_string(fuzz));
    }
  }
}

TEST(Bsdf, M14ValuesAreTheReflectanceTimesTheDensity) {
  const Vec3 wi = normalize({0.1, -0.3, 0.8});
  for (const Material& material : {Material(Diffuse{}), Material(Metal{{}, 0.9})}) {
    const BsdfValue value = evaluate(bsdf(material, {0.2, 0.1, 1}), wi);
    ASSERT_GT(value.pdf, 0);
    EXPECT_NEAR(value.value.r / value.pdf, 0.5, 1e-6);
    EXPECT_NEAR(value.value.g / value.pdf, 0.25, 1e-6);
    EXPECT_NEAR(value.value.b / value.pdf, 1, 1e-6);
  }
  test::report_hard_case("M14",
                         "value / pdf equals the reflectance within 1e-6; light reflected below "
                         "the horizon is absorbed, as by the metal of Ray Tracing in One Weekend");
}

TEST(Bsdf, M10NoLightPassesOpaqueSurfacesForAnyShadingNormal) {
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const double tilt = random.uniform(0, 1.5);
    const Vec3 shading{std::sin(tilt), 0, std::cos(tilt)};
    const Vec3 wo =
        normalize({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const Vec3 wi =
        normalize({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    for (const Material& material :
         {Material(Diffuse{}), Material(Metal{{}, 0.7}), Material(Metal{{}, 0})}) {
      const Bsdf b = bsdf(material, wo, shading);
      if (wo.z * wi.z < 0) {
        ASSERT_EQ(evaluate(b, wi).pdf, 0);
        ASSERT_TRUE(is_black(evaluate(b, wi).value));
      }
      const double u = random.uniform();
      const auto drawn = sample(b, u, random.uniform(), 0.3);
      ASSERT_TRUE(!drawn || wo.z * drawn->wi.z > 0);
    }
  }
  test::report_hard_case("M10",
                         "no light passes an opaque surface, for 60,000 pairs of directions");
}

TEST(Bsdf, MirrorsAndGlassLoseNothingUnderAnyShadingNormal) {
  Random random(5);
  for (int i = 0; i < 20000; ++i) {
    const double tilt = random.uniform(0, 1.5);
    const Vec3 shading{std::sin(tilt), 0, std::cos(tilt)};
    const Vec3 wo =
        normalize({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
    const auto reflected = sample(bsdf(Metal{{}, 0}, wo, shading), 0, 0, 0);
    ASSERT_TRUE(reflected && reflected->delta);
    ASSERT_GT(reflected->wi.z * wo.z, 0);
    const auto through = sample(bsdf(Dielectric{1.5}, wo, shading), 0, 0, random.uniform());
    ASSERT_TRUE(through && through->delta);
    ASSERT_NEAR(length(through->wi), 1, 1e-14);
    // Radiance is scaled by the square of the relative index, 1.5^2 = 2.25, at a boundary.
    const bool beyond = through->wi.z * wo.z < 0;
    const double compression = !beyond ? 1 : wo.z > 0 ? 1 / 2.25 : 2.25;
    ASSERT_NEAR(through->compression, compression, 1e-12);
    ASSERT_NEAR(through->weight.g, compression, 1e-6);
  }
}

// Glass reflects the light if the last random number of sample() is below the Fresnel share, and
// refracts it otherwise.
TEST(Bsdf, GlassReflectsTheFresnelShare) {
  const Vec3 wo{std::sqrt(0.75), 0, 0.5};
  const double share = 0.0891867128;  // fresnel(0.5, 1.5)
  EXPECT_GT(sample(bsdf(Dielectric{1.5}, wo), 0, 0, share - 1e-6)->wi.z, 0);
  EXPECT_LT(sample(bsdf(Dielectric{1.5}, wo), 0, 0, share + 1e-6)->wi.z, 0);
  // From inside, beyond the critical angle, all light is reflected and stays inside.
  EXPECT_LT(sample(bsdf(Dielectric{1.5}, -wo), 0, 0, kOneMinusEpsilon)->wi.z, 0);
}

TEST(Bsdf, M6GlassOfIndexOneIsInvisible) {
  const Vec3 wo = normalize({0.3, 0.4, -0.2});
  const auto through = sample(bsdf(Dielectric{1}, wo), 0, 0, 0);
  ASSERT_TRUE(through);
  EXPECT_NEAR(length(through->wi + wo), 0, 1e-14);
  EXPECT_EQ(through->weight, gray(1));
  test::report_hard_case("M6", "smooth glass: transmitted direction within 1e-14, weight 1");
}

TEST(Bsdf, M1CornersOfTheUnitSquareGiveFiniteSamples) {
  const double least = 0x1p-32;
  for (const double u : {0.0, least, 1 - least, 0.5}) {
    for (const double v : {0.0, least, 1 - least, 0.5}) {
      for (const double w : {0.0, least, 1 - least}) {
        for (const Material& material : {Material(Diffuse{}), Material(Metal{{}, 1}),
                                         Material(Metal{{}, 1e-6}), Material(Metal{{}, 1e-7})}) {
          for (const Vec3& wo : {Vec3{0, 0, 1}, Vec3{1, 0, 1e-12}, Vec3{1, 0, 0}}) {
            const auto drawn = sample(bsdf(material, wo), u, v, w);
            ASSERT_TRUE(!drawn || (is_finite(drawn->wi) && std::isfinite(drawn->pdf) &&
                                   (drawn->pdf > 0 || drawn->delta)));
          }
        }
      }
    }
  }
  test::report_hard_case("M1", "no NaN at the corners of the unit square");
}

}  // namespace
}  // namespace bandsaw
