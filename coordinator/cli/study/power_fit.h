#pragma once

// Fits a power law.

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace bandsaw::coordinator {

/// Returns p of "y ~ x^p" by least squares in logarithms over the points with x, y > 0. Returns
/// std::nullopt if they do not have at least two different x.
inline std::optional<double> power_of(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [at, value] : points) {
    if (at > 0 && value > 0) {
      const double log_at = std::log(at), log_value = std::log(value);
      n += 1, x += log_at, y += log_value, xx += log_at * log_at, xy += log_at * log_value;
    }
  }
  const double spread = n * xx - x * x;
  return n < 2 || !(spread > 1e-12 * n * xx) ? std::nullopt
                                             : std::optional((n * xy - x * y) / spread);
}

}  // namespace bandsaw::coordinator
