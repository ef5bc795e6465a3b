#pragma once

// How the error of a job's image falls, and when it will be small enough. Pure functions.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/render/error_estimate.h"

namespace bandsaw::coordinator {

/// What was known of the error after a pass.
struct ErrorPoint {
  std::uint64_t samples = 0;  ///< a pixel, of the complete passes; > 0
  double elapsed_s = 0;       ///< of the job so far
  double cpu_s = 0;           ///< of rendering so far, summed over threads
  ErrorEstimate estimate;
  friend bool operator==(const ErrorPoint&, const ErrorPoint&) = default;
};

/// By rising samples.
using ErrorCurve = std::vector<ErrorPoint>;

/// Adds a point that has at least the last one's samples. One with as many takes the last one's
/// place but keeps its times: it was looked at again. Of points less than an eighth apart the later
/// stays, so a curve has at most some 160 of them.
void add_point(ErrorCurve& curve, const ErrorPoint& point);

/// p of "error falls as samples^-p" from octave to octave: the mean over the points of the last
/// octave, each against half its samples, kept in [0.5, 0.75]: random samples have 1/2. 1/2 where
/// there is not an octave.
double fall_of(const ErrorCurve& curve);

/// The relative RMSE and its margin at so many samples a pixel, > 0: between points by
/// interpolation; beyond the last that of half as many, lower by the fall. So what a whole net of
/// 2^k points gains over three quarters of one, and no power of the samples has, is expected again.
/// The curve MUST have a point whose error is not 0.
double error_at(const ErrorCurve& curve, double samples);

/// The samples a pixel at which that is at most `target`, > 0. Nothing without a point, of a black
/// image, or where no job may have so many.
std::optional<double> samples_until(const ErrorCurve& curve, double target);

/// The same in CPU seconds, which grow with the samples. Nothing where those are not known either.
std::optional<double> cpu_s_until(const ErrorCurve& curve, double target);

}  // namespace bandsaw::coordinator
