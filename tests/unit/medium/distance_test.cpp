// Sampling of distances in a medium: pdfs of samples and bounds of weights. An id such as V10 in a
// test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderlib/math/constants.h"
#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/equiangular.h"
#include "renderlib/medium/free_flight.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

constexpr std::size_t kCells = 100;
constexpr int kSamples = 100000;

/// Counts samples in 100 cells and compares the counts with the integral of the pdf over each cell.
/// The cells have equal lengths if `length` is finite, and increasing lengths if it is infinite.
/// `sample(choice, u)` returns a distance for two random numbers in [0, 1). `pdf(s)` returns the
/// pdf of the distance s.
void expect_density(const std::function<double(double, double)>& sample,
                    const std::function<double(double)>& pdf, double length, std::uint64_t seed) {
  std::vector<double> edges = {0};
  for (std::size_t i = 1; i < kCells; ++i) {
    const double t = static_cast<double>(i) / kCells;
    edges.push_back(std::isfinite(length) ? length * t : -std::log1p(-t) * 2);
  }
  edges.push_back(std::isfinite(length) ? length : 1e4);
  std::vector<double> expected(kCells);
  double total = 0;
  for (std::size_t cell = 0; cell < kCells; ++cell) {
    constexpr int kSteps = 4000;
    const double step = (edges[cell + 1] - edges[cell]) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      expected[cell] += step * kSamples * pdf(edges[cell] + (i + 0.5) * step);
    }
    total += expected[cell];
  }
  EXPECT_NEAR(total / kSamples, 1, 2e-3);
  test::Random random(seed);
  std::vector<std::uint64_t> counts(kCells);
  int beyond = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double choice = random.uniform();
    const double s = sample(choice, random.uniform());
    ASSERT_GE(s, 0);
    ASSERT_LE(s, length);
    ASSERT_GT(pdf(s), 0);
    const auto found = std::upper_bound(edges.begin(), edges.end(), s);
    if (found == edges.end() && s > edges.back()) {
      ++beyond;
      continue;
    }
    const auto cell = static_cast<std::size_t>(found - edges.begin()) - 1;
    ++counts[std::min(cell, kCells - 1)];
  }
  EXPECT_LT(beyond, kSamples / 500);
  for (double& cell : expected) {
    cell *= (kSamples - beyond) / total;
  }
  const test::ChiSquared result = test::chi_squared(counts, expected);
  // The tests call this function at most 16 times.
  EXPECT_GT(result.p_value, test::sidak(0.01, 16)) << result.statistic << " " << result.degrees;
}

/// Compares the distances that FreeFlight samples with its pdf, in a segment of this length. Light
/// with the weight `throughput` enters the segment.
void expect_flight_density(const Medium& medium, const Rgb& throughput, double length,
                           std::uint64_t seed) {
  const FreeFlight flight(medium, throughput, length);
  expect_density([&](double choice, double u) { return flight.sample(choice, u); },
                 [&](double s) { return flight.pdf(s); }, length, seed);
}

TEST(FreeFlight, DistancesFollowThePdf) {
  const Medium grey{.absorption = gray(0.2f), .scattering = gray(0.8f)};
  expect_flight_density(grey, gray(1), kInfinity, 1);
  expect_flight_density(grey, gray(1), 0.5, 2);
  expect_flight_density(grey, gray(1), 8, 3);
  const Medium colored{.absorption = {0.1f, 0, 2}, .scattering = {0.5f, 2, 0.1f}};
  expect_flight_density(colored, {0.2f, 0.5f, 3}, kInfinity, 4);
  expect_flight_density(colored, {1, 1, 1}, 1.5, 5);
  expect_flight_density({.scattering = gray(1e-12f)}, gray(1), 3, 6);
}

/// The probability of scattering and the weight of all scattered light follow the closed form.
TEST(FreeFlight, ScatterProbabilityIsTheScatteredShare) {
  const FreeFlight flight({.absorption = gray(0.5f), .scattering = gray(1.5f)}, gray(1), 0.7);
  const double stopped = -std::expm1(-1.4);
  const double scattered = 0.75 * stopped;
  EXPECT_NEAR(flight.scatter_probability(), scattered / (scattered + std::exp(-1.4)), 1e-12);
  EXPECT_FLOAT_EQ(flight.all_scattered().g, static_cast<float>(scattered));
  EXPECT_EQ(FreeFlight({.absorption = gray(1)}, gray(1), kInfinity).scatter_probability(), 0);
  EXPECT_EQ(FreeFlight({}, gray(1), kInfinity).scatter_probability(), 0);
  EXPECT_EQ(FreeFlight({.scattering = gray(1)}, gray(1), kInfinity).scatter_probability(), 1);
}

/// For any coefficients of the channels, no weight grows by more than a factor of 3. The sum of the
/// channels is the same whether the light is scattered or passes.
TEST(FreeFlight, V10_WeightsStayBounded) {
  test::Random random(9);
  const std::vector<Medium> media = {
      {.scattering = {0, 1, 1000}},
      {.absorption = {1000, 0, 1}, .scattering = {0, 1, 1000}},
      {.absorption = {1e-3f, 5, 0}, .scattering = {1e12f, 1e-12f, 1}},
  };
  for (const Medium& medium : media) {
    for (const double length : {1e-6, 0.1, 30.0, kInfinity}) {
      for (int i = 0; i < 2000; ++i) {
        const Rgb before = {static_cast<float>(random.uniform()),
                            static_cast<float>(random.uniform()),
                            static_cast<float>(random.uniform())};
        const FreeFlight flight(medium, before, length);
        const double sum = double{before.r} + before.g + before.b;
        if (flight.scatter_probability() < 1) {
          const Rgb passed = flight.after_passing();
          EXPECT_LE(passed.r + passed.g + passed.b, sum * (1 + 1e-6));
        }
        if (flight.scatter_probability() > 0) {
          const double choice = random.uniform();
          const double distance = flight.sample(choice, random.uniform());
          const Rgb after = flight.after_scattering(distance);
          ASSERT_TRUE(is_finite(after)) << distance;
          const double sum_after = double{after.r} + after.g + after.b;
          EXPECT_LE(sum_after, sum * (1 + 1e-6));
          EXPECT_LE(max_component(after), 3 * max_component(before) * (1 + 1e-6f));
          if (flight.scatter_probability() < 1) {
            const Rgb passed = flight.after_passing();
            EXPECT_NEAR(sum_after, double{passed.r} + passed.g + passed.b, 1e-5 * sum);
          }
          // The weight is the scattered light divided by the pdf of the distance.
          const double density = flight.scatter_probability() * flight.pdf(distance);
          EXPECT_NEAR(after.g, flight.scattered(distance).g / density, 1e-5 * sum);
        }
      }
    }
  }
  test::report_hard_case("V10", "24,000 weights <= 3");
}

/// Both ends of the range of u give finite distances.
TEST(FreeFlight, V2_ExtremeNumbersGiveFiniteDistances) {
  for (const double sigma : {1e-30, 1e-8, 1.0, 1e12}) {
    for (const double length : {1e-3, 1.0, kInfinity}) {
      const FreeFlight flight({.scattering = gray(static_cast<float>(sigma))}, gray(1), length);
      EXPECT_EQ(flight.sample(0, 0), 0);
      const double far = flight.sample(1 - 0x1p-32, 1 - 0x1p-32);
      EXPECT_TRUE(std::isfinite(far)) << sigma << " " << length;
      EXPECT_TRUE(std::isfinite(flight.pdf(far)));
      EXPECT_GT(flight.pdf(far), 0);
    }
  }
  test::report_hard_case("V2",
                         "distances are finite for the smallest and the largest random number");
}

TEST(Equiangular, DistancesFollowThePdf) {
  const Vec3 origin{1, 2, 3};
  const Vec3 direction = normalize({1, 0.2, -0.4});
  std::uint64_t seed = 40;
  for (const double along : {-1.0, 0.0, 1.3, 5.0}) {
    for (const double length : {2.0, kInfinity}) {
      const Vec3 pivot = origin + direction * along + Vec3{0, 0.9, 0.45};
      const Equiangular angles(origin, direction, length, pivot);
      // On an infinite ray, the tail 1 / s^2 of the pdf is cut at s = 1e4. About 1e-4 of the
      // samples are beyond 1e4.
      expect_density([&](double, double u) { return angles.sample(u); },
                     [&](double s) { return angles.pdf(s); }, length, ++seed);
    }
  }
}

/// Distances and pdfs are finite if the light is on the ray, at its start, or far away.
TEST(Equiangular, V8_IsFiniteForALightOnTheRay) {
  const Vec3 direction{0, 0, 1};
  for (const double length : {1e-3, 1.0, kInfinity}) {
    for (const Vec3& pivot : {Vec3{0, 0, 0.5}, Vec3{0, 0, 0}, Vec3{0, 0, -4}, Vec3{0, 0, 1e9},
                              Vec3{1e-12, 0, 0.5}, Vec3{1e20, 0, 0}}) {
      const Equiangular angles({0, 0, 0}, direction, length, pivot);
      for (const double u : {0.0, 0x1p-32, 0.5, 1 - 0x1p-32}) {
        const double s = angles.sample(u);
        EXPECT_TRUE(std::isfinite(s) && s >= 0 && s <= length) << pivot.z << " " << u;
        EXPECT_TRUE(std::isfinite(angles.pdf(s)) && angles.pdf(s) > 0) << pivot.z << " " << u;
      }
    }
  }
  test::report_hard_case(
      "V8", "distances and pdfs are finite for lights on the ray, at its origin and far away");
}

}  // namespace
}  // namespace bandsaw
