#pragma once

// Statistical tests with fixed seeds: what fails, fails every time.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bandsaw::test {

/// Mean and variance in one pass (Welford 1962).
class Moments {
 public:
  void add(double x);
  std::size_t count() const { return count_; }
  double mean() const { return mean_; }
  /// Of the samples, unbiased; 0 for fewer than two.
  double variance() const;
  /// Of the mean.
  double standard_error() const;
  /// How many standard errors the mean is off; samples that are all equal and right give 0.
  double z(double expected) const;

 private:
  std::size_t count_ = 0;
  double mean_ = 0;
  double sum_of_squares_ = 0;
};

/// Pearson's chi-squared test of counts against expected counts (of equal sum). Cells that expect
/// fewer than 5 are pooled.
struct ChiSquared {
  double statistic = 0;
  int degrees = 0;
  /// The probability of a statistic this large or larger, from the cube-root normal approximation
  /// (Wilson and Hilferty 1931).
  double p_value = 1;
};
ChiSquared chi_squared(const std::vector<std::uint64_t>& counts,
                       const std::vector<double>& expected);

/// The level at which each of `tests` independent tests must be judged for all together to fail
/// falsely with probability `level` (Sidak 1967).
double sidak(double level, std::size_t tests);

}  // namespace bandsaw::test
