#pragma once

// The power that figures follow.

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace bandsaw::coordinator {

/// Of the logarithms of the points with x, y > 0: sums over the points of (x - mean x)^2 and
/// (x - mean x)(y - mean y).
struct PowerFit {
  double spread = 0;
  double covariance = 0;
};
inline PowerFit fit_power(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [at, value] : points) {
    if (at > 0 && value > 0) {
      const double log_at = std::log(at), log_value = std::log(value);
      n += 1, x += log_at, y += log_value, xx += log_at * log_at, xy += log_at * log_value;
    }
  }
  return n < 1 ? PowerFit() : PowerFit{xx - x * x / n, xy - x * y / n};
}

/// p of "y ~ x^p" by least squares in logarithms. Nothing where these have not two different x.
inline std::optional<double> power_of(const std::vector<std::pair<double, double>>& points) {
  const PowerFit fit = fit_power(points);
  return fit.spread > 1e-9 ? std::optional(fit.covariance / fit.spread) : std::nullopt;
}

}  // namespace bandsaw::coordinator
