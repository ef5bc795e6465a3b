// One cell of path guiding: a few balls from which much light comes. Tests the fit of the balls to
// recorded light, and the sampling of the cones in which a surface sees the balls.

#include "renderlib/guiding/guiding_cell.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/sampling/warp.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

constexpr Vec3 kUp{0, 0, 1};

/// Returns a cell of three balls above a surface. Seen from the origin, two of the balls overlap. A
/// ball has a centre, a radius and a weight, which is its share of the light. `share` is the
/// probability that a direction is sampled towards the balls and not from the BSDF.
GuidingCell three_balls() {
  GuidingCell cell;
  cell.count = 3;
  cell.irradiance = 1;
  cell.share = 0.5f;
  cell.balls[0] = {{1, 0, 2}, 0.7f, 0.5f};
  cell.balls[1] = {{2, 0.5f, 3}, 1.0f, 0.3f};
  cell.balls[2] = {{-3, 1, 0.5f}, 0.2f, 0.2f};
  return cell;
}

TEST(GuidingCones, PdfIntegratesToOne) {
  const GuidingCell cell = three_balls();
  const GuidingCones cones({.paths = &cell}, {0.1, -0.2, 0}, kUp);
  // The midpoint rule over (z, turn); the edges of the cones limit its precision.
  constexpr int kRows = 2000;
  constexpr int kColumns = 4000;
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      sum += cones.pdf(sample_sphere((row + 0.5) / kRows, (column + 0.5) / kColumns));
    }
  }
  EXPECT_NEAR(sum * 4 * kPi / (kRows * kColumns), 1, 1e-3);
}

// Each direction belongs to one of eight classes, according to which of its three coordinates are
// above a limit. The share of samples in a class must equal the integral of the pdf over the class,
// which is estimated from uniform directions.
TEST(GuidingCones, SamplesHaveThePdf) {
  const GuidingCell cell = three_balls();
  const GuidingCones cones({.paths = &cell}, {}, kUp);
  constexpr int kSamples = 100'000;
  // E[f / pdf] over the samples is the integral of f over the cones. Here f is 1 in one class and 0
  // in the others.
  std::array<test::Moments, 8> sampled;
  std::array<test::Moments, 8> uniform;
  const PixelSampler sampler(1, 2, 3);
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const Sample4 numbers = sampler.group(i, 0);
    const Vec3 direction = cones.sample(numbers[0], numbers[1], numbers[2]);
    ASSERT_NEAR(length(direction), 1, 1e-12);
    ASSERT_GT(cones.pdf(direction), 0);
    const Vec3 other = sample_sphere(numbers[1], numbers[2]);
    const auto class_of = [](const Vec3& d) {
      return (d.x > 0.4 ? 1u : 0u) + (d.y > 0.1 ? 2u : 0u) + (d.z > 0.6 ? 4u : 0u);
    };
    for (std::size_t class_number = 0; class_number < 8; ++class_number) {
      sampled[class_number].add(class_of(direction) == class_number ? 1 / cones.pdf(direction) : 0);
      uniform[class_number].add(class_of(other) == class_number && cones.pdf(other) > 0 ? 4 * kPi
                                                                                        : 0);
    }
  }
  for (std::size_t i = 0; i < 8; ++i) {
    const double deviation = std::hypot(sampled[i].standard_error(), uniform[i].standard_error());
    EXPECT_LE(std::abs(sampled[i].mean() - uniform[i].mean()), 4 * deviation + 1e-12) << i;
  }
}

TEST(GuidingCones, LeavesTheShareOfHiddenBallsToTheBsdf) {
  GuidingCell cell = three_balls();
  EXPECT_NEAR(GuidingCones({.paths = &cell}, {}, kUp).share(), 0.5, 1e-7);
  // Seen from a surface that faces down, all balls lie below it.
  EXPECT_EQ(GuidingCones({.paths = &cell}, {}, -kUp).share(), 0);
  // The point is inside of ball 0, whose light may come from any direction. Ball 2 lies below the
  // surface, so only ball 1, whose weight is 0.3, can be sampled.
  EXPECT_NEAR(GuidingCones({.paths = &cell}, {1, 0, 2.1}, kUp).share(), 0.5 * 0.3, 1e-7);
}

TEST(GuidingCones, WithoutCellsGuidesNothing) {
  EXPECT_EQ(GuidingCones().share(), 0);
  EXPECT_EQ(GuidingCones({}, {}, kUp).share(), 0);
  EXPECT_EQ(GuidingCones({}, {}, kUp).pdf(kUp), 0);
}

// One cell is fitted to paths and one to photons. The probability of sampling towards the photons'
// cell is its part of the irradiance of both cells, limited to [1/8, 1/2]. The paths' cell has the
// share 0.5, so the probability of sampling towards it is half of the remaining probability.
TEST(GuidingShares, TheShareOfPhotonsFollowsTheirLight) {
  GuidingCell paths = three_balls();
  GuidingCell photons = three_balls();
  photons.moment = 100;  // a large second moment: without guiding, the photons' light is noisy
  const auto share_of_photons = [&](float irradiance) {
    photons.irradiance = irradiance;
    return shares_of({&paths, &photons}).photons;
  };
  EXPECT_EQ(share_of_photons(0), 0);
  EXPECT_EQ(share_of_photons(1e-4f), 0);  // so little light that it is not worth guiding
  EXPECT_EQ(share_of_photons(0.1f), 0.125);
  EXPECT_NEAR(share_of_photons(1.0f / 3), 0.25, 1e-6);
  EXPECT_EQ(share_of_photons(100), 0.5);
  EXPECT_EQ(shares_of({&paths, &photons}).paths, 0.25);
}

/// Returns records of light that a surface receives from a disk around (0, 0, 5).
std::vector<GuidingRecord> light_of_disk(GuidingRecord::Kind kind, double radius, int count) {
  std::vector<GuidingRecord> records;
  const PixelSampler sampler(4, 5, 6);
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const Sample4 at = sampler.group(i, 0);
    const Vec2 from = sample_disk(at[2], at[3]) * radius;
    records.push_back({.position = float3({at[0] - 0.5, at[1] - 0.5, 0}),
                       .normal = float3(kUp),
                       .source = float3({from.x, from.y, 5}),
                       .weight = 1,
                       .kind = kind});
  }
  return records;
}

// `moment` is the expected second moment of a sampled direction's contribution without guiding, in
// units of the squared mean. `guided_moment` is the second moment with guiding.
TEST(FitCell, FindsASmallSource) {
  for (const auto kind : {GuidingRecord::Kind::kPath, GuidingRecord::Kind::kPhoton}) {
    const GuidingCell cell = fit_cell(light_of_disk(kind, 0.1, 200));
    ASSERT_GT(cell.count, 0u);
    EXPECT_EQ(cell.share, 0.5f);
    EXPECT_GT(cell.moment, 100);       // the disk covers a thousandth of the hemisphere
    EXPECT_LT(cell.guided_moment, 4);  // half of the directions are sampled towards the disk
    // Also from the edge of the cell, most guided directions hit the disk.
    const GuidingCones cones({.paths = &cell}, {0.5, 0.5, 0}, kUp);
    int hits = 0;
    const PixelSampler sampler(7, 8, 9);
    for (std::uint64_t i = 0; i < 1000; ++i) {
      const Sample4 numbers = sampler.group(i, 0);
      const Vec3 d = cones.sample(numbers[0], numbers[1], numbers[2]);
      const double x = 0.5 + d.x / d.z * 5;
      const double y = 0.5 + d.y / d.z * 5;
      hits += d.z > 0 && x * x + y * y < 0.1 * 0.1 ? 1 : 0;
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(FitCell, ScalesPhotonsByTheirAreaAndAveragesPaths) {
  // 200 photons of power 1 on a unit square make an irradiance of 200. 200 paths that each found an
  // irradiance of 1 have the mean 1.
  EXPECT_NEAR(fit_cell(light_of_disk(GuidingRecord::Kind::kPhoton, 0.1, 200)).irradiance, 200, 10);
  EXPECT_NEAR(fit_cell(light_of_disk(GuidingRecord::Kind::kPath, 0.1, 200)).irradiance, 1, 1e-5);
}

TEST(FitCell, LeavesUniformLightMostlyToTheBsdf) {
  std::vector<GuidingRecord> records = light_of_disk(GuidingRecord::Kind::kPath, 0.1, 500);
  const PixelSampler sampler(1, 1, 1);
  for (std::uint64_t i = 0; i < records.size(); ++i) {
    const Sample4 at = sampler.group(i, 1);
    records[i].source =
        float3(vec3(records[i].position) + sample_cosine_hemisphere(at[0], at[1]) * 100);
  }
  const GuidingCell cell = fit_cell(records);
  EXPECT_LT(cell.moment, 1.3);
  EXPECT_LE(cell.share, 0.125f);
}

TEST(FitCell, TooFewRecordsWithLightGiveNoBalls) {
  EXPECT_EQ(fit_cell({}).count, 0u);
  EXPECT_EQ(fit_cell(light_of_disk(GuidingRecord::Kind::kPath, 0.1, 7)).count, 0u);  // needs 8
  std::vector<GuidingRecord> dark = light_of_disk(GuidingRecord::Kind::kPath, 0.1, 100);
  for (GuidingRecord& record : dark) {
    record.weight = 0;
  }
  EXPECT_EQ(fit_cell(dark).count, 0u);
  // If one record outshines all others, the cell has in effect a single record, which is too few.
  dark[0].weight = 1;
  for (std::size_t i = 1; i < dark.size(); ++i) {
    dark[i].weight = 1e-4f;
  }
  EXPECT_EQ(fit_cell(dark).count, 0u);
}

}  // namespace
}  // namespace bandsaw
