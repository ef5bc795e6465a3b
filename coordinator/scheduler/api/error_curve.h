#pragma once

// The error of a job's image as a function of its samples per pixel: measured after each pass,
// interpolated between the passes, and extrapolated to predict when a target is reached. Pure
// functions. A pass is a range of samples that is rendered for the whole image.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/render/error_estimate.h"

namespace bandsaw::coordinator {

/// Error of the image after a pass.
struct ErrorPoint {
  std::uint64_t samples = 0;  ///< per pixel, of the complete passes; > 0
  double elapsed_s = 0;       ///< time of the job until then
  double cpu_s = 0;           ///< CPU time of rendering until then, summed over threads
  ErrorEstimate estimate;
  friend bool operator==(const ErrorPoint&, const ErrorPoint&) = default;
};

/// Ordered by rising samples.
using ErrorCurve = std::vector<ErrorPoint>;

/// Adds a point with at least as many samples as the last one. If it has as many samples as the
/// last one, the last point gets the new estimate and keeps its times, because the new point is a
/// second measurement of the same image. A point with more samples replaces the last point if the
/// last point has less than 1/8 more samples than the point before it. So a curve has at most about
/// 160 points.
void add_point(ErrorCurve& curve, const ErrorPoint& point);

/// Returns the exponent p of "error falls as samples^-p" over the last octave (the last doubling of
/// the samples). Each point of this octave gives one exponent, from its error and the error at half
/// of its samples. The result is the mean of these exponents, but at least 0.5 and at most 0.75. If
/// the curve does not span an octave, the result is 0.5, the exponent of random samples.
double fall_of(const ErrorCurve& curve);

/// Returns the relative RMSE plus its margin (ErrorEstimate::at_most) at this many samples per
/// pixel, > 0. Between points it is interpolated. Beyond the last point it is the error at half the
/// samples, multiplied by 2^-fall_of(curve). So the shape of the last octave repeats in the
/// following octaves. This shape is not a plain power law, because a complete net of 2^k samples
/// has a smaller error than a power law through other sample counts predicts. The curve MUST have a
/// point whose error is not 0.
double error_at(const ErrorCurve& curve, double samples);

/// Returns the samples per pixel at which error_at is at most `target`, > 0. std::nullopt: the
/// curve has no point or belongs to a black image, or more than kMaxSamples would be needed.
std::optional<double> samples_until(const ErrorCurve& curve, double target);

/// Returns the CPU seconds until error_at is at most `target`. CPU seconds are taken as
/// proportional to the samples. std::nullopt: samples_until returns it, or the CPU time is unknown.
std::optional<double> cpu_s_until(const ErrorCurve& curve, double target);

}  // namespace bandsaw::coordinator
