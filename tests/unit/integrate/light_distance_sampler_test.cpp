// For light sampling in a medium, LightDistanceSampler draws the distance along a ray from a
// mixture of two strategies: free flight and equiangular sampling. Tests the variance of the
// mixture by quadrature.

#include "renderlib/integrate/light_distance_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/support/media.h"

namespace bandsaw {
namespace {

constexpr double kLength = 6;

/// Returns the integral of f(distance) over the segment [0, kLength]. A light source is at the
/// distance `aside` from the middle of the segment. All steps have the same angle seen from the
/// source, so the steps near the source are short.
double integral(double aside, const std::function<double(double)>& f) {
  constexpr int kSteps = 20000;
  const double low = std::atan(-3 / aside);
  const double high = std::atan(3 / aside);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = low + (high - low) * (i + 0.5) / kSteps;
    const double y = aside * std::tan(angle);
    sum += f(3 + y) * (aside * aside + y * y) / aside * (high - low) / kSteps;
  }
  return sum;
}

/// The variance of one sample divided by the square of the mean, for each way to sample distances.
struct Spread {
  double flown;   ///< free flight
  double angles;  ///< equiangular sampling
  double both;    ///< the mixture of both strategies
};

/// Returns the variances for the light of a small source at the distance `aside` from the middle of
/// the segment. `sigma`: scattering coefficient of the medium.
Spread spread(float sigma, double aside) {
  const Medium smoke = test::medium(0, sigma);
  const FreeFlight flight(smoke, gray(1), kLength);
  const Vec3 origin{};
  const Vec3 direction{1, 0, 0};
  const Vec3 lamp{3, aside, 0};
  LightDistanceSampler both(flight, smoke);
  both.add(origin, direction, kLength, lamp);
  const Equiangular angles(origin, direction, kLength, lamp);
  const auto light = [&](double s) {
    const double r = std::hypot(3 - s, aside);
    return flight.scattered(s).g * std::exp(-sigma * r) / (r * r);
  };
  const double mean = integral(aside, light);
  const auto of = [&](const std::function<double(double)>& pdf) {
    return integral(aside, [&](double s) { return light(s) * light(s) / pdf(s); }) / (mean * mean) -
           1;
  };
  return {of([&](double s) { return flight.pdf(s); }), of([&](double s) { return angles.pdf(s); }),
          of([&](double s) { return both.pdf(s); })};
}

TEST(LightDistanceSampler, IsNeverMuchWorseThanItsBetterStrategy) {
  for (const float sigma : {0.01f, 0.1f, 1.0f, 10.0f}) {
    for (const double aside : {2.0, 0.5, 0.05, 0.005}) {
      const Spread found = spread(sigma, aside);
      RecordProperty("sigma " + std::to_string(sigma) + " aside " + std::to_string(aside),
                     std::to_string(found.flown) + " " + std::to_string(found.angles) + " " +
                         std::to_string(found.both));
      // A spread plus 1 is the second moment divided by the square of the mean.
      EXPECT_LE(found.both + 1, 2 * (std::min(found.flown, found.angles) + 1)) << sigma << aside;
    }
  }
}

/// The gain is the variance of free flight divided by the variance of the mixture. The NOTES.md of
/// renderlib/integrate states these gains.
TEST(LightDistanceSampler, ReducesVarianceNearALight) {
  const auto gain = [](float sigma, double aside) {
    const Spread found = spread(sigma, aside);
    return found.flown / found.both;
  };
  EXPECT_GT(gain(0.1f, 0.5), 30);
  EXPECT_GT(gain(0.1f, 0.05), 100);
  EXPECT_GT(gain(1, 0.05), 50);
}

}  // namespace
}  // namespace bandsaw
