// Tracking (the sampling of collisions along a ray in a medium that varies in space) against closed
// forms: flights that scatter or pass, points of scattering, transmittance and emission. fly()
// sends light through a segment of a ray, where it is scattered or passes. pass() sends light
// through the segment without scattering the path, and also draws one point at which the medium
// scatters light. Seeds are fixed; with unbiased code each z-test has a false-alarm rate of 6e-5.

#include "renderlib/medium/tracking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/grids.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Moments;

constexpr std::size_t kWalks = 40000;  ///< estimates in each mean
constexpr std::uint32_t kGridCells = 257;
/// A ray along x through the centres of the cells, from the first to the last.
const GridRay kAlong{{0.5, 0.5, 0.5}, {1, 0, 0}};
constexpr double kLength = kGridCells - 1;

/// Returns a medium with these coefficients, scaled by the density of grid 0.
Medium of_density(const Rgb& absorption, const Rgb& scattering, const Rgb& emission = {}) {
  Medium medium{.absorption = absorption, .scattering = scattering, .emission = emission};
  medium.grids.density = GridUse{GridId{0}, 1};
  return medium;
}

/// A row of cells with density f(x) at the distance x along kAlong, interpolated linearly between
/// the centres.
std::vector<VolumeGrid> row(const std::function<double(double)>& f) {
  VolumeGrid grid =
      test::grid_of({kGridCells, 1, 1}, {}, {kGridCells, 1, 1},
                    [&](std::uint32_t x, auto, auto) { return static_cast<float>(f(x)); });
  grid.border = VolumeGrid::Border::kClamp;
  return {grid};
}

/// A density along kAlong, and `depth`: its integral from 0 to x.
struct Profile {
  const char* name;
  std::function<double(double)> density;
  std::function<double(double)> depth;
};

const Profile kLinear{"linear", [](double x) { return 4e-5 * x; },
                      [](double x) { return 2e-5 * x * x; }};
const Profile kExponential{"exponential", [](double x) { return 0.05 * std::exp(-x / 40); },
                           [](double x) { return 2 - 2 * std::exp(-x / 40); }};
/// The density is the same everywhere, so residual ratio tracking has no noise.
const Profile kConstant{"constant", [](double) { return 0.004; },
                        [](double x) { return 0.004 * x; }};

/// Returns the deviation of the mean from `expected` in standard errors. Returns 0 if the deviation
/// is only due to rounding.
double z_of(const Moments& moments, double expected) {
  // If the variance is 0, the mean of float colours still differs from the double by rounding.
  return std::abs(moments.mean() - expected) < 1e-6 * expected ? 0 : moments.z(expected);
}

TEST(Tracking, TransmittanceIsThatOfTheClosedForm) {
  for (const Profile& profile : {kLinear, kExponential, kConstant}) {
    const std::vector<VolumeGrid> grids = row(profile.density);
    const GridMedium medium(of_density({0.5f, 0, 0}, {0.5f, 2, 0.1f}), grids);
    for (const double length : {kLength, 100.0}) {
      std::array<Moments, 3> seen;
      for (std::size_t i = 0; i < kWalks; ++i) {
        NumberStream numbers(i);
        const Rgb t = estimate_transmittance(medium, kAlong, length, numbers);
        seen[0].add(t.r);
        seen[1].add(t.g);
        seen[2].add(t.b);
      }
      const double depth = profile.depth(length);
      EXPECT_LT(std::abs(z_of(seen[0], std::exp(-depth))), 4) << profile.name;
      EXPECT_LT(std::abs(z_of(seen[1], std::exp(-2 * depth))), 4) << profile.name;
      EXPECT_LT(std::abs(z_of(seen[2], std::exp(-0.1 * depth))), 4) << profile.name;
    }
  }
}

TEST(Tracking, TransmittanceThroughAConstantDensityHasNoNoise) {
  const std::vector<VolumeGrid> grids = row(kConstant.density);
  const GridMedium medium(of_density({}, {1, 2, 3}), grids);
  for (std::size_t i = 0; i < 100; ++i) {
    NumberStream numbers(i);
    const Rgb t = estimate_transmittance(medium, kAlong, kLength, numbers);
    EXPECT_NEAR(t.r, std::exp(-0.004 * kLength), 1e-6);
    EXPECT_NEAR(t.b, std::exp(-0.012 * kLength), 1e-6);
  }
}

TEST(Tracking, FirstCollisionsFollowTheClosedForm) {
  for (const Profile& profile : {kLinear, kExponential, kConstant}) {
    const std::vector<VolumeGrid> grids = row(profile.density);
    const GridMedium medium(of_density({}, gray(1)), grids);
    constexpr std::size_t kBins = 64;
    std::vector<std::uint64_t> counts(kBins + 1);
    for (std::size_t i = 0; i < kWalks; ++i) {
      NumberStream numbers(i + 1000000);
      const FirstCollision first{numbers.next(), numbers.next()};
      const Flight flight = fly(medium, kAlong, kLength, gray(1), first, numbers);
      // Nothing is absorbed, so the weight is 1 whether light is scattered or passes.
      ASSERT_EQ(flight.throughput, gray(1));
      const double bin = flight.scattered ? flight.distance / kLength * kBins : kBins;
      ++counts[static_cast<std::size_t>(bin)];
    }
    std::vector<double> expected;
    for (std::size_t i = 0; i < kBins; ++i) {
      const auto passing = [&](std::size_t at) {
        return std::exp(-profile.depth(kLength * static_cast<double>(at) / kBins));
      };
      expected.push_back(kWalks * (passing(i) - passing(i + 1)));
    }
    expected.push_back(kWalks * std::exp(-profile.depth(kLength)));
    const test::ChiSquared result = test::chi_squared(counts, expected);
    EXPECT_GT(result.p_value, test::sidak(0.01, 3)) << profile.name << " " << result.statistic;
  }
}

/// Returns the integral of f along kAlong, from 0 to kLength.
double integral(const std::function<double(double)>& f) {
  constexpr int kSteps = 100000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    sum += f(kLength * (i + 0.5) / kSteps);
  }
  return sum * kLength / kSteps;
}

TEST(Tracking, EveryChannelKeepsItsMeanAndTheSumOfChannelsDoesNotGrow) {
  const std::vector<VolumeGrid> grids = row(kExponential.density);
  const Rgb absorption{0.5f, 0, 0.4f};
  const Rgb scattering{0.5f, 2, 0};
  const GridMedium medium(of_density(absorption, scattering), grids);
  const Rgb entering{0.5f, 1, 2};
  std::array<Moments, 3> passed;
  std::array<Moments, 3> scattered;
  std::array<Moments, 3> one_point;
  for (std::size_t i = 0; i < kWalks; ++i) {
    NumberStream numbers(i);
    const FirstCollision first{numbers.next(), numbers.next()};
    const Flight flight = fly(medium, kAlong, kLength, entering, first, numbers);
    const Rgb pass_weight = flight.scattered ? Rgb{} : flight.throughput;
    const Rgb scatter_weight = flight.scattered ? flight.throughput : Rgb{};
    const Rgb point = pass(medium, kAlong, kLength, entering, numbers).scattered.weight;
    // The sum of the channels of `entering` is 3.5.
    EXPECT_LE(flight.throughput.r + flight.throughput.g + flight.throughput.b, 3.5f * 1.0001f);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = [c](const Rgb& rgb) { return c == 0 ? rgb.r : c == 1 ? rgb.g : rgb.b; };
      passed[c].add(channel(pass_weight));
      scattered[c].add(channel(scatter_weight));
      one_point[c].add(channel(point));
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = [c](const Rgb& rgb) {
      return double{c == 0 ? rgb.r : c == 1 ? rgb.g : rgb.b};
    };
    const double extinction = channel(absorption) + channel(scattering);
    const double through = std::exp(-extinction * kExponential.depth(kLength));
    const double all = channel(entering) * integral([&](double x) {
                         return kExponential.density(x) * channel(scattering) *
                                std::exp(-extinction * kExponential.depth(x));
                       });
    EXPECT_LT(std::abs(passed[c].z(channel(entering) * through)), 4) << c;
    EXPECT_LT(std::abs(scattered[c].z(all)), 4) << c;
    EXPECT_LT(std::abs(one_point[c].z(all)), 4) << c;
  }
}

TEST(Tracking, CollectsEmission) {
  const std::vector<VolumeGrid> grids = row(kExponential.density);
  const GridMedium medium(of_density({1, 0, 0}, {0.5f, 1, 0}, {1, 2, 3}), grids);
  std::array<Moments, 3> flown;
  std::array<Moments, 3> passed;
  for (std::size_t i = 0; i < kWalks; ++i) {
    NumberStream numbers(i);
    const FirstCollision first{numbers.next(), numbers.next()};
    const Rgb a = fly(medium, kAlong, kLength, gray(1), first, numbers).emitted;
    const Rgb b = pass(medium, kAlong, kLength, gray(1), numbers).emitted;
    flown[0].add(a.r);
    flown[1].add(a.g);
    flown[2].add(a.b);
    passed[0].add(b.r);
    passed[1].add(b.g);
    passed[2].add(b.b);
  }
  const std::array<double, 3> extinction = {1.5, 1, 0};
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected =
        static_cast<double>(c + 1) * integral([&](double x) {
          return kExponential.density(x) * std::exp(-extinction[c] * kExponential.depth(x));
        });
    EXPECT_LT(std::abs(flown[c].z(expected)), 4) << c;
    EXPECT_LT(std::abs(passed[c].z(expected)), 4) << c;
  }
}

TEST(Tracking, CollectsEmissionWhereNothingIsDense) {
  std::vector<VolumeGrid> grids = row([](double) { return 0; });
  grids.push_back(row([](double x) { return x < 128 ? 0.01 : 0; })[0]);
  // The ray meets only the emission grid, which is turned and outside of the density grid.
  grids[1].to_medium = rotation({0, 0, 1}, 90) * translation({0, -1, 0});
  Medium medium = of_density(gray(1), gray(1), {1, 2, 0});
  medium.grids.emission = GridUse{GridId{1}, 2};
  const GridMedium varying(medium, grids);
  Moments seen;
  for (std::size_t i = 0; i < kWalks; ++i) {
    NumberStream numbers(i);
    const FirstCollision first{numbers.next(), numbers.next()};
    const Flight flight = fly(varying, {{0.5, -10, 0.5}, {0, 1, 0}}, 1000, gray(1), first, numbers);
    ASSERT_FALSE(flight.scattered);
    ASSERT_EQ(flight.throughput, gray(1));
    ASSERT_EQ(flight.emitted.b, 0);
    seen.add(flight.emitted.g);
  }
  // The expected value is the medium's green emission 2 times the grid's factor 2 times 0.01 times
  // a length of 128 cells. Half a cell lies before the first centre, and 127 cells lie between the
  // centres with 0.01. Up to the next centre, the grid falls from 0.01 to 0, which counts as half a
  // cell.
  EXPECT_LT(std::abs(seen.z(2 * 2 * 0.01 * (0.5 + 127.5))), 4);
}

TEST(Tracking, TheAlbedoGridDividesExtinctionIntoScatteringAndAbsorption) {
  std::vector<VolumeGrid> grids = row([](double) { return 0.01; });
  VolumeGrid albedo = dense_grid({2, 1, 1}, 3, [](std::size_t i) { return i < 3 ? 0.25f : 2.0f; });
  albedo.filter = VolumeGrid::Filter::kNearest;
  albedo.to_medium = scaling({kGridCells / 2.0, 1, 1});
  grids.push_back(albedo);
  Medium medium = of_density({}, gray(3));
  medium.grids.albedo = GridUse{GridId{1}, 1};
  const GridMedium varying(medium, grids);
  const Coefficients left = varying.coefficients({1, 0.5, 0.5}, varying.density({1, 0.5, 0.5}, 1));
  EXPECT_NEAR(left.extinction[0], 0.03, 1e-7);
  EXPECT_NEAR(left.scattering[0], 0.0075, 1e-7);
  const Coefficients right =
      varying.coefficients({200, 0.5, 0.5}, varying.density({200, 0.5, 0.5}, 1));
  EXPECT_NEAR(right.scattering[2], 0.03, 1e-7) << "an albedo above 1 must count as 1";
}

TEST(Tracking, ADensityMayHaveThreeChannels) {
  VolumeGrid colored = dense_grid({kGridCells, 1, 1}, 3, [](std::size_t i) {
    return static_cast<float>(kLinear.density(static_cast<double>(i / 3)) *
                              static_cast<double>(1 + i % 3));
  });
  colored.border = VolumeGrid::Border::kClamp;
  const std::vector<VolumeGrid> grids = {colored};
  const GridMedium medium(of_density({}, gray(0.5f), {1, 0, 0}), grids);
  std::array<Moments, 3> passing;
  std::array<Moments, 3> passed;
  Moments emitted;
  for (std::size_t i = 0; i < kWalks; ++i) {
    NumberStream numbers(i);
    const FirstCollision first{numbers.next(), numbers.next()};
    const Flight flight = fly(medium, kAlong, kLength, gray(1), first, numbers);
    const Rgb weight = flight.scattered ? Rgb{} : flight.throughput;
    const Rgb t = estimate_transmittance(medium, kAlong, kLength, numbers);
    emitted.add(flight.emitted.r);
    passing[0].add(t.r);
    passing[1].add(t.g);
    passing[2].add(t.b);
    passed[0].add(weight.r);
    passed[1].add(weight.g);
    passed[2].add(weight.b);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const double through = std::exp(-0.5 * static_cast<double>(c + 1) * kLinear.depth(kLength));
    EXPECT_LT(std::abs(passing[c].z(through)), 4) << c;
    EXPECT_LT(std::abs(passed[c].z(through)), 4) << c;
  }
  // The integral of the density times exp(-0.5 * depth).
  EXPECT_LT(std::abs(emitted.z(2 * (1 - std::exp(-0.5 * kLinear.depth(kLength))))), 4);
}

TEST(Tracking, EndsInVeryDenseMedia) {
  // The region's bound of the density is 1e9, and the density is 0 where the ray passes. Without
  // Russian roulette over the number of collisions, the ray would take more than 1e9 collisions.
  std::vector<VolumeGrid> grids = {
      test::grid_of({8, 8, 8}, {}, {8, 8, 8},
                    [](auto x, auto y, auto) { return x == 7 && y == 7 ? 1e9f : 0.0f; })};
  const GridMedium medium(of_density({}, gray(1)), grids);
  NumberStream numbers(1);
  const GridRay beside{{1, 1, 0}, {0, 0, 1}};
  const Flight flight = fly(medium, beside, 8, gray(1), {0.5, 0.5}, numbers);
  EXPECT_FALSE(flight.scattered);
  const Rgb t = estimate_transmittance(medium, beside, 8, numbers);
  EXPECT_EQ(t, Rgb{});  // Russian roulette ended the ray
}

// A region is a part of space with a lower and an upper bound of the density. A RegionWalk divides
// a ray, here up to the distance 3, into spans that lie in one region each.
TEST(RegionWalk, SpansFollowEachOtherAndBoundTheDensityAtTheirPoints) {
  std::vector<VolumeGrid> grids = {test::grid_of(
      {20, 17, 40}, {-1, 2, 3}, {4, 5, 9}, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return x / 8 == 1 ? 0.0f : static_cast<float>((x * 3 + y * 5 + z * 11) % 17);
      })};
  const GridMedium medium(of_density({}, gray(1)), grids);
  NumberStream numbers(3);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto number = [&] { return 10 * numbers.next(); };
    GridRay ray{{number() - 4, number() - 1, number()}, {number() - 5, number() - 5, number() - 5}};
    if (i % 5 == 0) {
      ray.direction.x = 0;
    }
    if (i % 7 == 0) {
      ray.direction.z = 0;
    }
    RegionWalk walk(medium.regions(), ray, 3);
    RegionSpan span;
    double at = 0;
    while (walk.next(span)) {
      ASSERT_EQ(span.begin, at);
      ASSERT_GE(span.end, span.begin);
      for (const double share : {0.01, 0.5, 0.99}) {
        const double density =
            medium.density(ray.at(span.begin + share * (span.end - span.begin)), 1e9)[0];
        ASSERT_LE(density, span.region.most * (1 + 1e-6));
        ASSERT_GE(density, span.region.least * (1 - 1e-6));
        inside += density > 0 ? 1 : 0;
      }
      at = span.end;
    }
    ASSERT_EQ(at, 3);
  }
  EXPECT_GT(inside, 2000);
}

}  // namespace
}  // namespace bandsaw
