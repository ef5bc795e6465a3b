#pragma once

// Statistics for tests of random numbers: moments and the chi-squared test. Tests call them with
// samples of fixed seeds, so a failure is reproducible.

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
  /// Unbiased variance of the samples; 0 for fewer than two.
  double variance() const;
  /// Standard error of the mean.
  double standard_error() const;
  /// Returns the deviation of the mean from `expected` in standard errors. If the standard error is
  /// 0, returns 0 for a mean that equals `expected`, and infinity for any other mean.
  double z(double expected) const;

 private:
  std::size_t count_ = 0;
  double mean_ = 0;
  double sum_of_squares_ = 0;
};

/// Result of Pearson's chi-squared test of counts against expected counts with the same sum. All
/// cells with an expected count below 5 are pooled into one cell. If the expected count of the
/// pooled cell is below 5 too, the pooled cell is left out. If a pooled cell that is left out has
/// more than 20 counts, the statistic is infinite.
struct ChiSquared {
  double statistic = 0;
  int degrees = 0;  ///< of freedom
  /// Probability of a statistic at least this large, by the cube-root normal approximation (Wilson
  /// and Hilferty 1931).
  double p_value = 1;
};
/// Runs the test. `counts` and `expected` have one number for each cell.
ChiSquared chi_squared(const std::vector<std::uint64_t>& counts,
                       const std::vector<double>& expected);

/// Returns the significance level that each of `tests` independent tests must have, so that the
/// probability of at least one false alarm among all of them is `level` (Sidak 1967).
double sidak(double level, std::size_t tests);

}  // namespace bandsaw::test
