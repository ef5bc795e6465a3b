// Tests the hard cases M2, M7, M8, M11 and M12 (materials), which cases.txt lists. Also tests the
// masking term of microfacets.
//
// In texts, u is the unit roundoff of double, 2^-53.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "renderlib/integrate/path.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/ggx.h"
#include "renderlib/math/constants.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Random;
using test::random_direction;

const std::vector<Texture> kTextures = {ConstantTexture{{1, 1, 1}}, ConstantTexture{gray(0.5f)}};

SurfacePoint point() {
  SurfacePoint p;
  p.geometric_normal = p.shading_normal = {0, 0, 1};
  return p;
}

/// Returns a material with all layers of MetallicRoughness: half metallic, half transmitting, and
/// with a clear coat.
MetallicRoughness layered(double roughness) {
  MetallicRoughness m;
  m.metallic = m.transmission = m.coat_roughness = {TextureId{1}, 1};
  m.roughness = {TextureId{0}, roughness};
  m.coat = {TextureId{0}, 1};
  return m;
}

// M2: if a pdf is nearly zero, no result is 0 / 0. Some of the random numbers are the smallest and
// the largest number in [0, 1).
TEST(MaterialHardCases, M2_PdfsNearZeroGiveFiniteNumbers) {
  const Material materials[] = {layered(0.01), layered(1), Dielectric{1.5, 0.02},
                                Dielectric{1.0000001, 0.5}, Metal{TextureId{0}, 1e-5}};
  const double edges[] = {0, 0x1p-32, 0.5, 1 - 0x1p-24, 1 - 0x1p-32};
  Random random(5);
  // run.sh uses the second number of tries, and the default tests use the first.
  const int tries = test::tries(20'000, 20'000'000);
  for (const Material& material : materials) {
    for (int i = 0; i < tries; ++i) {
      Vec3 wo = random_direction(random);
      wo.z *= i % 3 == 0 ? 1e-9 : 1;
      const Bsdf bsdf = bsdf_at(material, kTextures, point(), normalize(wo));
      const auto edge = [&] { return edges[static_cast<int>(random.uniform() * 5)]; };
      const double u = i % 2 == 0 ? random.uniform() : edge();
      const double v = i % 5 == 0 ? edge() : random.uniform();
      if (const auto drawn = sample(bsdf, u, v, edge())) {
        ASSERT_TRUE(is_finite(drawn->wi) && is_finite(drawn->weight) && std::isfinite(drawn->pdf));
        ASSERT_TRUE(drawn->delta || drawn->pdf > 0);
      }
      const BsdfValue value = evaluate(bsdf, random_direction(random));
      ASSERT_TRUE(is_finite(value.value) && std::isfinite(value.pdf) && value.pdf >= 0);
    }
  }
  test::report_hard_case(
      "M2", "none of " + std::to_string(10 * std::int64_t{tries}) + " samples and values is NaN");
}

// Returns the Fresnel reflectance, computed with 64 bits of mantissa from the same double cosine
// (Born and Wolf, 1.5.2).
long double exact_fresnel(double cosine, double eta) {
  const long double c = cosine;
  const long double n = eta;
  const long double cos2_t = 1 - (1 - c * c) / (n * n);
  if (cos2_t <= 0) {
    return 1;
  }
  const long double t = std::sqrt(cos2_t);
  const long double parallel = (n * c - t) / (n * c + t);
  const long double perpendicular = (c - n * t) / (c + n * t);
  return (parallel * parallel + perpendicular * perpendicular) / 2;
}

TEST(MaterialHardCases, M7_FresnelIsAccurateAroundTheCriticalAngle) {
  test::Worst error;       // at a distance of 1e-5 or more from the critical cosine
  test::Worst near_error;  // at a smaller distance
  for (const double eta : {1 / 1.33, 1 / 1.5, 1 / 2.4}) {
    const double critical = std::sqrt(1 - eta * eta);
    for (int k = 2; k <= 12; ++k) {
      for (const double sign : {-1.0, 1.0}) {
        const double cosine = critical + sign * std::pow(10.0, -k);
        const long double exact = exact_fresnel(cosine, eta);
        // Near the critical angle F depends on the square root of the difference between the cosine
        // and the critical cosine. So the last bit of the cosine has a large effect on F. The
        // tolerance allows this effect.
        const double bit = 1e-15 * std::pow(10.0, k / 2.0);
        const auto off = static_cast<double>(std::abs(fresnel(cosine, eta) - exact));
        EXPECT_LE(off, 1e-12 + bit);
        (k <= 5 ? error : near_error).see(k <= 5 ? off : off * std::pow(10, -k / 2.0));
        EXPECT_EQ(refracted_cos(cosine, eta).has_value(), exact < 1) << k << " " << sign;
        if (const auto cos_t = refracted_cos(cosine, eta)) {
          const Vec3 w{std::sqrt(1 - cosine * cosine), 0, cosine};
          EXPECT_NEAR(length(refracted(w, {0, 0, 1}, *cos_t, eta)), 1, 1e-12);
        }
      }
    }
  }
  test::at_most("M7", "error of F if the cosine differs by 1e-5 or more from the critical cosine",
                error.value(), 1e-12);
  test::at_most("M7",
                "error of F times the square root of the difference, if the cosine differs by less "
                "than 1e-5 from the critical cosine",
                near_error.value(), 1e-15);
  test::report_hard_case("M7",
                         "total reflection where the exact formula has it; the refracted direction "
                         "w has |w| = 1 within 1e-12");
}

TEST(MaterialHardCases, M8_DirectionsKeepLengthOneAfterAThousandMirrors) {
  Random random(2);
  Vec3 direction = random_direction(random);
  for (int bounce = 0; bounce < 1000; ++bounce) {
    SurfacePoint p = point();
    const Vec3 towards = random_direction(random);
    p.geometric_normal = p.shading_normal = dot(towards, direction) < 0 ? towards : -towards;
    const auto next = sample(bsdf_at(Metal{TextureId{0}}, kTextures, p, -direction), 0.5, 0.5, 0.5);
    ASSERT_TRUE(next);
    direction = next->wi;
    // The criterion is 4 u for the length, so 8 u for the squared length.
    ASSERT_LE(std::abs(length_squared(direction) - 1), 8 * 0x1p-53);
  }
  test::report_hard_case(
      "M8", "squared length of the direction within 8 u of 1 after each of 1,000 mirrors");
}

// M11: a closed white sphere absorbs nothing, so a path in the sphere ends at the maximum depth.
// M12: if the reflectance is low, Russian roulette ends the path after few surfaces.
TEST(MaterialHardCases, M11M12_PathsEnd) {
  for (const float reflectance : {1.0f, 1e-3f}) {
    test::SceneMaker maker;
    maker.sphere({0, 0, 0}, 1, maker.diffuse(reflectance));
    const auto scene = maker.build();
    PathCounts counts;
    const Ray ray{.origin = {0.5, 0, 0}, .direction = {0, 1, 0}};
    for (std::uint64_t sample = 0; sample < 64; ++sample) {
      const Rgb seen =
          path_radiance(*scene, ray, PixelSampler(0, 1, 2), sample, {.max_depth = 200}, counts);
      EXPECT_TRUE(is_black(seen));
    }
    if (reflectance == 1) {
      EXPECT_EQ(counts.rays, 64u * 201);
      EXPECT_EQ(counts.truncated, 64u);
    } else {
      EXPECT_LE(counts.rays, 64u * 8);
    }
  }
  test::report_hard_case("M11",
                         "64 of 64 paths end at the maximum depth and are counted as cut off");
  test::report_hard_case("M12", "64 paths of at most 200 bounces trace at most 8 rays on average");
}

// Weak white furnace (Heitz 2014, section 5.3): the visible facets, each by its projected area, sum
// up to the projected area of the surface. So the integral of G1 D max(0, o.h) / |o.z| over h is 1.
TEST(Ggx, VisibleFacetsAddUpToTheProjectedArea) {
  for (const double alpha : {0.05, 0.2, 0.5, 1.0}) {
    for (const double z : {1.0, 0.7, 0.3, 0.1}) {
      const Vec3 o{std::sqrt(1 - z * z), 0, z};
      // The substitution tan = alpha sqrt(x / (1 - x)) of the slopes makes D cos dh uniform in x.
      // The second substitution, x = 1 - s^2, puts more points at steep slopes.
      constexpr int kSide = 600;
      double sum = 0;
      for (int a = 0; a < kSide; ++a) {
        const double s = (a + 0.5) / kSide;
        const double slope = alpha * std::sqrt(1 - s * s) / s;
        const double cosine = 1 / std::sqrt(1 + slope * slope);
        for (int b = 0; b < kSide; ++b) {
          const double phi = 2 * kPi * (b + 0.5) / kSide;
          const Vec3 h{slope * cosine * std::cos(phi), slope * cosine * std::sin(phi), cosine};
          sum += 2 * s * std::max(0.0, dot(o, h)) / cosine;
        }
      }
      const double whole = ggx_masking(o, alpha) * sum / (double{kSide} * kSide) / z;
      EXPECT_NEAR(whole, 1, 1e-4) << alpha << " " << z;
    }
  }
}

}  // namespace
}  // namespace bandsaw
