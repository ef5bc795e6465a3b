// The photon map: each photon spreads its power over a disk of its own. The radius of the disk is
// small where photons are dense. The irradiance at a point is the sum over the disks that contain
// the point.

#include "renderlib/guiding/photon_map.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "renderlib/sampling/sampler.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

constexpr Vec3 kAbove{0, 0, 1};

/// Returns 1: the whole disk of the photon lies on the surface. The arguments of PhotonMap are the
/// photons, the origin of their positions, a factor for all radii, a seed, the pool and such a
/// function, which returns the share of a photon's disk that lies on the surface.
double whole(const StoredPhoton&) { return 1; }

/// Returns photons of power 1 on the floor [0, 1]^2, ten times as dense where x < 1/4. So 10/13 of
/// the photons are there.
std::vector<StoredPhoton> on_floor(std::uint64_t count) {
  std::vector<StoredPhoton> photons;
  const PixelSampler sampler(1, 2, 3);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Sample4 at = sampler.group(i, 0);
    const double x = at[2] < 10.0 / 13 ? at[0] / 4 : 0.25 + at[0] * 0.75;
    photons.push_back({.position = float3({x, at[1], 0}),
                       .normal = float3(kAbove),
                       .chain = 1,
                       .from = float3(kAbove),
                       .power = gray(1)});
  }
  return photons;
}

/// Returns the irradiance in green at a point of a surface with this normal.
double irradiance(const PhotonMap& map, const Vec3& position, const Vec3& normal = kAbove) {
  double sum = 0;
  map.visit(position, normal,
            [&](const StoredPhoton& photon, float density) { sum += photon.power.g * density; });
  return sum;
}

// All coordinates of the points are multiples of 2^-7, so their sums with `far` are exact.
TEST(PhotonMap, IsTheSameFarFromTheOriginOfTheWorld) {
  Pool pool(1);
  const Vec3 far{0x1p40, -0x1p41, 3 * 0x1p38};
  const PhotonMap near_map(on_floor(5000), {}, 1, 0, pool, whole);
  const PhotonMap far_map(on_floor(5000), far, 1, 0, pool, whole);
  for (int i = 0; i < 100; ++i) {
    const Vec3 at{i * 0x1p-7, (i * 37 % 100) * 0x1p-7, 0};
    EXPECT_EQ(irradiance(far_map, far + at), irradiance(near_map, at)) << i;
  }
}

TEST(PhotonMap, TheDensityOfAPhotonIntegratesToOne) {
  const StoredPhoton photon{.position = {1, 2, 3}, .radius = 0.5f, .normal = float3(kAbove)};
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec3 at{0.4 + 1.2 * (i + 0.5) / kSteps, 1.4 + 1.2 * (j + 0.5) / kSteps, 3};
      sum += density_at(photon, float3(at), float3(kAbove));
    }
  }
  EXPECT_NEAR(sum * 1.2 * 1.2 / (kSteps * kSteps), 1, 1e-3);
  EXPECT_EQ(density_at(photon, {1, 2, 3}, float3(-kAbove)), 0);    // the back of the surface
  EXPECT_EQ(density_at(photon, {1, 2, 3.3}, float3(kAbove)), 0);   // too far above the disk
  EXPECT_EQ(density_at(photon, {1.51, 2, 3}, float3(kAbove)), 0);  // beyond the rim of the disk
}

TEST(PhotonMap, FindsThePhotonsThatAnExhaustiveSearchFinds) {
  Pool pool(2);
  const PhotonMap map(on_floor(5000), {}, 1, 0, pool, whole);
  ASSERT_GT(map.size(), 500u);
  const PixelSampler sampler(4, 5, 6);
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Sample4 at = sampler.group(i, 0);
    const Vec3 point{at[0], at[1], 0};
    double expected = 0;
    for (const StoredPhoton& photon : map.photons()) {
      expected += photon.power.g * density_at(photon, float3(point), float3(kAbove));
    }
    EXPECT_NEAR(irradiance(map, point), expected, 1e-5 * expected);
  }
}

struct Totals {
  double power = 0;   ///< sum of the powers
  double radius = 0;  ///< mean of the radii, weighted by power
};
/// Returns the totals of the photons whose x is in [from, to).
Totals totals_of(const PhotonMap& map, double from = 0, double to = 1) {
  Totals sum;
  for (const StoredPhoton& photon : map.photons()) {
    if (photon.position[0] >= from && photon.position[0] < to) {
      sum.power += photon.power.g;
      sum.radius += double{photon.power.g} * photon.radius;
    }
  }
  sum.radius /= sum.power;
  return sum;
}

// The mean of the estimate over many places is the density of the photons. The density is ten times
// as high where x < 1/4, so the disks are smaller in this part. The photons are spread evenly in
// each part, so there is little noise.
TEST(PhotonMap, EstimatesTheDensityAndAdaptsTheDisks) {
  Pool pool(1);
  constexpr std::uint64_t kPhotons = 100'000;
  const PhotonMap map(on_floor(kPhotons), {}, 1, 0, pool, whole);
  for (const bool dense : {false, true}) {
    test::Moments moments;
    const PixelSampler sampler(7, 8, 9);
    for (std::uint64_t i = 0; i < 2000; ++i) {
      const Sample4 at = sampler.group(i, 0);
      const double x = dense ? 0.05 + 0.15 * at[0] : 0.4 + 0.4 * at[0];
      moments.add(irradiance(map, {x, 0.2 + 0.6 * at[1], 0}));
    }
    // The quarter has the weight 10 / 4 and the rest 3 / 4; 3.25 is their sum.
    const double expected = kPhotons * (dense ? 10 : 1) / 3.25;
    EXPECT_NEAR(moments.mean(), expected, 0.02 * expected);
    EXPECT_LT(moments.variance(), 0.15 * 0.15 * expected * expected);
  }
  EXPECT_NEAR(totals_of(map).power, kPhotons, 1e-3 * kPhotons);
  EXPECT_LT(map.size(), kPhotons / 2);  // where photons are even, one replaces several
  const double ratio = totals_of(map, 0.25).radius / totals_of(map, 0, 0.25).radius;
  EXPECT_GT(ratio, 2);
  EXPECT_LT(ratio, 5);
}

// Only the quarter of the floor where x < 1/4 has photons.
TEST(PhotonMap, KeepsAnEdgeOfLight) {
  std::vector<StoredPhoton> photons = on_floor(100'000);
  std::erase_if(photons, [](const StoredPhoton& photon) { return photon.position[0] > 0.25f; });
  Pool pool(1);
  const PhotonMap map(photons, {}, 1, 0, pool, whole);
  const double lit = static_cast<double>(photons.size()) * 4;
  EXPECT_NEAR(irradiance(map, {0.2, 0.5, 0}), lit, 0.4 * lit);
  EXPECT_EQ(irradiance(map, {0.3, 0.5, 0}), 0);
}

TEST(PhotonMap, TheRadiusFactorScalesTheDisks) {
  Pool pool(1);
  const PhotonMap one(on_floor(30'000), {}, 1, 0, pool, whole);
  const PhotonMap half(on_floor(30'000), {}, 0.5, 0, pool, whole);
  EXPECT_NEAR(totals_of(half).radius, 0.5 * totals_of(one).radius, 1e-3 * totals_of(one).radius);
}

TEST(PhotonMap, DividesByTheShareOnTheSurface) {
  Pool pool(3);
  const PhotonMap map(on_floor(3000), {}, 1, 0, pool,
                      [](const StoredPhoton& photon) { return photon.radius > 0 ? 0.25 : 1; });
  EXPECT_NEAR(totals_of(map).power, 12'000, 1);  // 3,000 photons of power 1, divided by 0.25
}

TEST(PhotonMap, IsTheSameForAnyNumberOfThreads) {
  Pool one(1);
  Pool three(3);
  const PhotonMap a(on_floor(5000), {}, 1, 0, one, whole);
  const PhotonMap b(on_floor(5000), {}, 1, 0, three, whole);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(a.photons()[i].position == b.photons()[i].position &&
                a.photons()[i].power == b.photons()[i].power);
  }
}

// A map divides space into parts. The photons of a part have disks of one radius, so the radius
// jumps at the border of two parts. An image would show lines if these borders were at the same
// places in all maps. Here, a quarter of the floor has no photons. Close to this quarter,
// the radius at a point must differ for most seeds.
TEST(PhotonMap, TheSeedDecidesWhereRadiiJump) {
  Pool pool(1);
  std::vector<StoredPhoton> photons = on_floor(4000);
  std::erase_if(photons, [](const StoredPhoton& photon) {
    return photon.position[0] < 0.5f && photon.position[1] < 0.5f;
  });
  const auto radius_at = [&](std::uint64_t seed, const Float3& position) {
    const PhotonMap map(photons, {}, 1, seed, pool, whole);
    const auto near = std::min_element(map.photons().begin(), map.photons().end(),
                                       [&](const auto& a, const auto& b) {
                                         return length_squared(vec3(a.position) - vec3(position)) <
                                                length_squared(vec3(b.position) - vec3(position));
                                       });
    return near->radius;
  };
  std::set<float> radii;
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    radii.insert(radius_at(seed, {0.52f, 0.3f, 0}));
  }
  EXPECT_GT(radii.size(), 8u);
}

TEST(PhotonMap, MayBeEmptyOrHaveAllPhotonsAtOnePoint) {
  EXPECT_EQ(irradiance(PhotonMap(), {}), 0);
  Pool pool(1);
  std::vector<StoredPhoton> photons = on_floor(100);
  for (StoredPhoton& photon : photons) {
    photon.position = {1, 1, 0};
  }
  const PhotonMap map(photons, {}, 1, 0, pool, whole);
  EXPECT_EQ(irradiance(map, {0, 0, 0}), 0);
}

// Photons at one point do not tell the density of their surroundings, so the disks there must not
// become points.
TEST(PhotonMap, PhotonsAtOnePointHaveTheDisksOfTheirSurroundings) {
  Pool pool(1);
  std::vector<StoredPhoton> photons = on_floor(4000);
  for (std::size_t i = 0; i < 40; ++i) {
    photons[i].position = {0.6f, 0.6f, 0};
  }
  const PhotonMap map(photons, {}, 1, 0, pool, whole);
  for (const StoredPhoton& photon : map.photons()) {
    EXPECT_GT(photon.radius, 0.005f);
  }
}

}  // namespace
}  // namespace bandsaw
