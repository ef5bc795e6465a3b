// An error curve has a point (samples, error) for each pass of a job. It is interpolated linearly
// in logarithms. Beyond the last point, the shape of the curve in the last octave (the last
// doubling of the samples) repeats.

#include "coordinator/scheduler/api/error_curve.h"

#include <algorithm>
#include <cmath>

#include "renderlib/base/check.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace {

/// Bounds of the exponent p in "error falls as samples^-p". The lower bound is the exponent of
/// random samples. The upper bound is the largest exponent that is used to extrapolate: after an
/// octave in which the error falls faster, it does not fall as fast in the next octave (NOTES.md).
constexpr double kMinFall = 0.5;
constexpr double kMaxFall = 0.75;

/// Returns the first point whose error is above 0. The error of a black or a perfect image is 0.
ErrorCurve::const_iterator begin_of(const ErrorCurve& curve) {
  return std::find_if(curve.begin(), curve.end(),
                      [](const ErrorPoint& point) { return point.estimate.at_most() > 0; });
}

/// Returns the error at `samples`, which lies between the points `a` and `b`. The logarithm of the
/// error is interpolated linearly in the logarithm of the samples.
double between(const ErrorPoint& a, const ErrorPoint& b, double samples) {
  const auto from = static_cast<double>(a.samples);
  const double all = std::log(static_cast<double>(b.samples) / from);
  return a.estimate.at_most() *
         std::pow(b.estimate.at_most() / a.estimate.at_most(), std::log(samples / from) / all);
}

/// Returns the error at this number of samples, interpolated between the points around it.
/// `samples` MUST lie between the samples of begin_of(curve) and the samples of the last point.
double measured_at(const ErrorCurve& curve, double samples) {
  const auto next = std::find_if(begin_of(curve), curve.end(), [&](const ErrorPoint& point) {
    return static_cast<double>(point.samples) >= samples;
  });
  return static_cast<double>(next->samples) == samples ? next->estimate.at_most()
                                                       : between(*std::prev(next), *next, samples);
}

/// Returns the error at any number of samples. Between the points the error is interpolated. Before
/// the first and beyond the last point it is extrapolated with the exponent `fall`.
double expected_at(const ErrorCurve& curve, double samples, double fall) {
  const auto last = static_cast<double>(curve.back().samples);
  if (samples > last) {
    const double octaves = std::ceil(std::log2(samples / last));
    return expected_at(curve, samples * std::exp2(-octaves), fall) * std::exp2(-octaves * fall);
  }
  const ErrorPoint& first = *begin_of(curve);
  const double before = static_cast<double>(first.samples) / samples;
  return before > 1 ? first.estimate.at_most() * std::pow(before, fall)
                    : measured_at(curve, samples);
}

}  // namespace

void add_point(ErrorCurve& curve, const ErrorPoint& point) {
  BANDSAW_CHECK(curve.empty() || curve.back().samples <= point.samples, "samples only grow");
  if (!curve.empty() && curve.back().samples == point.samples) {
    curve.back().estimate = point.estimate;
    return;
  }
  const std::size_t n = curve.size();
  if (n >= 2 && curve[n - 1].samples < curve[n - 2].samples + curve[n - 2].samples / 8) {
    curve.back() = point;
  } else {
    curve.push_back(point);
  }
}

double fall_of(const ErrorCurve& curve) {
  const auto first = begin_of(curve);
  double sum = 0;
  int count = 0;
  for (auto point = first; point != curve.end(); ++point) {
    if (2 * point->samples > curve.back().samples && point->samples >= 2 * first->samples) {
      const double half = measured_at(curve, static_cast<double>(point->samples) / 2);
      sum += std::log2(half / point->estimate.at_most());
      ++count;
    }
  }
  return count == 0 ? kMinFall : std::clamp(sum / count, kMinFall, kMaxFall);
}

double error_at(const ErrorCurve& curve, double samples) {
  BANDSAW_CHECK(begin_of(curve) != curve.end() && samples > 0, "the error is known");
  return expected_at(curve, samples, fall_of(curve));
}

std::optional<double> samples_until(const ErrorCurve& curve, double target) {
  auto point = begin_of(curve);
  if (point == curve.end()) {
    return std::nullopt;
  }
  const double fall = fall_of(curve);
  auto samples = static_cast<double>(point->samples);
  double error = point->estimate.at_most();
  if (error <= target) {
    return samples * std::pow(error / target, 1 / fall);
  }
  // Goes from point to point, and beyond the last point in steps of an eighth of an octave.
  while (samples < static_cast<double>(kMaxSamples)) {
    const bool measured = point != curve.end() && ++point != curve.end();
    const double next =
        measured ? static_cast<double>(point->samples) : samples * std::exp2(1.0 / 8);
    const double lower = expected_at(curve, next, fall);
    if (lower <= target) {
      return samples * std::pow(next / samples, std::log(error / target) / std::log(error / lower));
    }
    samples = next;
    error = lower;
  }
  return std::nullopt;
}

std::optional<double> cpu_s_until(const ErrorCurve& curve, double target) {
  const std::optional<double> samples = samples_until(curve, target);
  if (!samples || curve.back().cpu_s <= 0) {
    return std::nullopt;
  }
  const ErrorPoint& last = curve.back();
  return last.cpu_s * *samples / static_cast<double>(last.samples);
}

}  // namespace bandsaw::coordinator
