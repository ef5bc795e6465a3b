#pragma once

// The estimate of the error of filtered values, on which all errors of the denoiser are based
// (denoise.cpp, halves.cpp). It compares a filtered part of the samples with the other part as
// rendered.

namespace bandsaw {

/// Estimates the squared error of the mean of two values, each of which was computed from one part
/// of the samples: `a` from the first, `b` from the second. `first` and `second` are the unfiltered
/// means of the parts, and `share` is the share of the first part in the samples.
///
/// Let E be the expectation and v the variance of a part's value. Because the parts are
/// independent, E (a - second)^2 = error^2(a) + v(second), and v(second) = share (first - second)^2
/// on average. For `b` and `first` the equations hold with the parts exchanged. The squared error
/// of the mean, share a + (1 - share) b, is the mean of the squared errors of `a` and `b` with the
/// same weights, minus share (1 - share) (a - b)^2.
template <class T>
T squared_error(T a, T b, T first, T second, T share) {
  const T squared_difference = (first - second) * (first - second);
  const T of_a = (a - second) * (a - second) - share * squared_difference;
  const T of_b = (b - first) * (b - first) - (1 - share) * squared_difference;
  return share * of_a + (1 - share) * of_b - share * (1 - share) * ((a - b) * (a - b));
}

/// Returns the larger of an estimated squared error and `variance`, the part of the error that is
/// noise: share (1 - share) (a - b)^2. The estimate alone may be far too small, even negative: two
/// parts of one Sobol' sequence differ more than independent parts, so that squared_error()
/// subtracts too much.
template <class T>
T at_least_variance(T squared_error, T variance) {
  return squared_error > variance ? squared_error : variance;
}

}  // namespace bandsaw
