// Shows why MIS does not meet the criterion of case Q5 in cases.txt: at most 1.2 times the error of
// the better technique. Two techniques, light sampling by solid angle and cosine-weighted sampling,
// are weighted by the ratio of their pdfs, which is all that a heuristic can know in any scene.
// Near the light, cosine-weighted sampling is nearly exact. Far from the light, light sampling is
// nearly exact. But the same ratios occur at both places. This test computes the optimal weights,
// and the optimal weights do not meet the criterion either.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderlib/math/constants.h"
#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

constexpr int kBins = 400;     // bins of the ratio, uniform in its logarithm
constexpr double kMin = 0.01;  // below the smallest ratio at the two places
constexpr double kMax = 2.05;  // above the largest ratio at the two places

int bin_of(double ratio) {
  const double at = std::log(ratio / kMin) / std::log(kMax / kMin);
  return std::clamp(static_cast<int>(at * kBins), 0, kBins - 1);
}

/// Second moments of two sampling techniques. They estimate the irradiance at a point below the
/// middle of a square light of radiance 1 / pi; f is the integrand of the irradiance, p the pdf of
/// cosine-weighted sampling, q that of light sampling. Each integral is split into bins of the
/// ratio p / q.
struct Seen {
  std::vector<double> cosine_sampling = std::vector<double>(kBins);  ///< integral of f^2 / p
  std::vector<double> light_sampling = std::vector<double>(kBins);   ///< integral of f^2 / q
};

/// Returns the moments for a light of 2 x 2 at `height`. For this light p = cos / pi, f = p, and q
/// is 1 / the solid angle of the light.
Seen seen_from(double height) {
  constexpr int kSteps = 600;
  const double solid_angle = 4 * std::atan(1 / (height * std::sqrt(2 + height * height)));
  const double range = std::asinh(1 / height);  // x = height sinh(s): fine steps near the light
  Seen seen;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double s = (i + 0.5) / kSteps * range;
      const double t = (j + 0.5) / kSteps * range;
      const double x = height * std::sinh(s);
      const double y = height * std::sinh(t);
      const double distance2 = x * x + y * y + height * height;
      const double cosine = height / std::sqrt(distance2);
      const double step = height * range / kSteps;
      const double area = 4 * step * step * std::cosh(s) * std::cosh(t);
      const double p = cosine * kInvPi;
      const double share = p * area * cosine / distance2;
      seen.cosine_sampling[bin_of(p * solid_angle)] += share;
      seen.light_sampling[bin_of(p * solid_angle)] += share * p * solid_angle;
    }
  }
  return seen;
}

double sum(const std::vector<double>& values) {
  double all = 0;
  for (const double value : values) {
    all += value;
  }
  return all;
}

/// Returns the variance of the sum of one weighted sample of each technique. `weights` has the
/// weight of cosine-weighted sampling in each bin.
double variance(const Seen& seen, const std::vector<double>& weights) {
  double squares = 0;
  double by_cosine = 0;
  for (int k = 0; k < kBins; ++k) {
    const double by_light = 1 - weights[k];
    squares += weights[k] * weights[k] * seen.cosine_sampling[k] +
               by_light * by_light * seen.light_sampling[k];
    by_cosine += weights[k] * seen.cosine_sampling[k];
  }
  const double by_light = sum(seen.cosine_sampling) - by_cosine;
  return squares - by_cosine * by_cosine - by_light * by_light;
}

/// Returns the smaller of the variances of the two techniques alone.
double of_better_technique(const Seen& seen) {
  return std::min(variance(seen, std::vector<double>(kBins, 0)),
                  variance(seen, std::vector<double>(kBins, 1)));
}

/// A point below the light, at which the variance counts with a factor.
struct Place {
  Seen seen;
  double scale = 0;  ///< factor of the variance
};

/// Returns the weights that minimise the sum of the scaled variances. At the minimum the gradient
/// of the sum is zero. This is a system of linear equations whose matrix is positive definite; it
/// is solved by Gaussian elimination.
std::vector<double> best_weights(const std::vector<Place>& places) {
  std::vector<std::vector<double>> rows(kBins, std::vector<double>(kBins + 1));
  for (const auto& [seen, scale] : places) {
    const double all = sum(seen.cosine_sampling);
    for (int k = 0; k < kBins; ++k) {
      rows[k][k] += scale * (seen.cosine_sampling[k] + seen.light_sampling[k]);
      rows[k][kBins] += scale * (seen.light_sampling[k] - all * seen.cosine_sampling[k]);
      for (int j = 0; j < kBins; ++j) {
        rows[k][j] -= 2 * scale * seen.cosine_sampling[k] * seen.cosine_sampling[j];
      }
    }
  }
  for (int k = 0; k < kBins; ++k) {
    rows[k][k] += rows[k][k] == 0 ? 1 : 0;  // no direction has this ratio
    for (int below = k + 1; below < kBins; ++below) {
      const double factor = rows[below][k] / rows[k][k];
      for (int j = k; j <= kBins; ++j) {
        rows[below][j] -= factor * rows[k][j];
      }
    }
  }
  std::vector<double> weights(kBins);
  for (int k = kBins - 1; k >= 0; --k) {
    double right = rows[k][kBins];
    for (int j = k + 1; j < kBins; ++j) {
      right -= rows[k][j] * weights[j];
    }
    weights[k] = right / rows[k][k];
  }
  return weights;
}

TEST(Weights, Q5_NoWeightsByThePdfRatioAreCloseToTheBetterTechnique) {
  // At each of the two places, divide the variance of the weighted samples by the variance of the
  // better technique. Let r and s be these two ratios. Weights are good if max(r, s) is small. For
  // every share q from 0 to 1, max(r, s) is at least the mean q r + (1 - q) s. So the smallest mean
  // that any weights reach is a lower bound of max(r, s). The q that follows was found by a search.
  constexpr double kShareNear = 0.96;
  std::vector<Place> places;
  for (const auto& [height, share] :
       {std::pair(0.02, kShareNear), std::pair(3.0, 1 - kShareNear)}) {
    const Seen seen = seen_from(height);
    places.push_back({seen, share / of_better_technique(seen)});
  }
  const std::vector<double> weights = best_weights(places);
  double bound = 0;
  for (const auto& [seen, scale] : places) {
    bound += scale * variance(seen, weights);
  }
  test::at_least(
      "Q5",
      "lower bound for weights that depend only on the ratio of the pdfs: standard deviation at h "
      "= 0.02 or at h = 3, divided by the standard deviation of the better technique",
      std::sqrt(bound), 1.2);
}

}  // namespace
}  // namespace bandsaw
