#pragma once

// The estimate of the error of filtered values, on which all errors of the denoiser are based
// (denoise.cpp, error_sums.h). It compares a filtered part of the samples with the other part as
// rendered.

namespace bandsaw {

/// One value (a channel of a pixel) in two parts of the samples.
template <class T>
struct InParts {
  T a;       ///< filtered from the first part
  T b;       ///< filtered from the second part
  T first;   ///< mean of the first part, unfiltered
  T second;  ///< mean of the second part, unfiltered
  T share;   ///< share of the first part in the samples

  /// Returns share (1 - share) (a - b)^2, which is on average the variance of the filtered value
  /// share a + (1 - share) b.
  T variance() const { return share * (1 - share) * ((a - b) * (a - b)); }
};

/// Estimates the squared error of the filtered value share a + (1 - share) b.
///
/// Let E be the expectation and v the variance of a part's value. Because the parts are
/// independent, E (a - second)^2 = error^2(a) + v(second), and v(second) = share (first - second)^2
/// on average. For `b` and `first` the equations hold with the parts exchanged. The squared error
/// of the filtered value is the mean of the squared errors of `a` and `b` with the same weights,
/// minus the variance.
template <class T>
T squared_error(const InParts<T>& of) {
  const T squared_difference = (of.first - of.second) * (of.first - of.second);
  const T of_a = (of.a - of.second) * (of.a - of.second) - of.share * squared_difference;
  const T of_b = (of.b - of.first) * (of.b - of.first) - (1 - of.share) * squared_difference;
  return of.share * of_a + (1 - of.share) * of_b - of.variance();
}

/// Estimates the product of the biases of the same channel in two neighbouring pixels `p` and `q`.
/// It does not use differences of parts in one pixel, so it does not need parts that are
/// independent within a pixel. It needs unfiltered values of neighbours that are independent.
///
/// E (p.a - p.second)(q.a - q.second) is the product of the biases plus the covariance of p.a and
/// q.a. For the other part the same holds with `b` and `first`. The last term subtracts both
/// covariances, as in squared_error().
template <class T>
T common_bias(const InParts<T>& p, const InParts<T>& q) {
  const T of_a = (p.a - p.second) * (q.a - q.second);
  const T of_b = (p.b - p.first) * (q.b - q.first);
  return p.share * of_a + (1 - p.share) * of_b -
         2 * (p.share * (1 - p.share)) * ((p.a - p.b) * (q.a - q.b));
}

/// Returns the larger of an estimated squared error and `variance`, the part of the error that is
/// noise (InParts::variance). The estimate alone may be far too small, even negative: two parts of
/// one Sobol' sequence differ more than independent parts, so that squared_error() subtracts too
/// much.
template <class T>
T at_least_variance(T squared_error, T variance) {
  return squared_error > variance ? squared_error : variance;
}

}  // namespace bandsaw
