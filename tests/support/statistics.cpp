// Mean and variance, the chi-squared test, and Sidak's correction for several tests.

#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bandsaw::test {

void Moments::add(double x) {
  ++count_;
  const double difference = x - mean_;
  mean_ += difference / static_cast<double>(count_);
  sum_of_squares_ += difference * (x - mean_);
}

double Moments::variance() const {
  return count_ < 2 ? 0 : sum_of_squares_ / static_cast<double>(count_ - 1);
}

double Moments::standard_error() const {
  return count_ == 0 ? 0 : std::sqrt(variance() / static_cast<double>(count_));
}

double Moments::z(double expected) const {
  const double error = standard_error();
  const double difference = mean_ - expected;
  if (error > 0) {
    return difference / error;
  }
  return difference == 0 ? 0 : std::numeric_limits<double>::infinity();
}

ChiSquared chi_squared(const std::vector<std::uint64_t>& counts,
                       const std::vector<double>& expected) {
  constexpr double kMinExpected = 5;
  ChiSquared result;
  double pooled_count = 0;
  double pooled_expected = 0;
  const auto add_cell = [&result](double count, double mean) {
    result.statistic += (count - mean) * (count - mean) / mean;
    ++result.degrees;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto count = static_cast<double>(counts[i]);
    if (expected[i] < kMinExpected) {
      pooled_count += count;
      pooled_expected += expected[i];
    } else {
      add_cell(count, expected[i]);
    }
  }
  if (pooled_expected >= kMinExpected) {
    add_cell(pooled_count, pooled_expected);
  } else if (pooled_count > 4 * kMinExpected) {
    // More than 20 counts where fewer than 5 are expected are practically impossible by chance.
    result.statistic = std::numeric_limits<double>::infinity();
  }
  result.degrees = std::max(1, result.degrees - 1);
  // Wilson and Hilferty 1931: the cube root of chi-squared / k is nearly normal. Its variance is
  // 2 / (9 k), and its mean is 1 - variance.
  const double k = result.degrees;
  const double variance = 2 / (9 * k);
  const double z = (std::cbrt(result.statistic / k) - (1 - variance)) / std::sqrt(variance);
  result.p_value = 0.5 * std::erfc(z / std::sqrt(2.0));
  return result;
}

double sidak(double level, std::size_t tests) {
  return 1 - std::pow(1 - level, 1 / static_cast<double>(tests));
}

}  // namespace bandsaw::test
