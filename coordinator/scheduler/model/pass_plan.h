#pragma once

// Division of a job into passes: pure functions of the stop rule and of measured errors, so that
// the same job has the same passes on every farm. A pass is a range of samples that is rendered for
// the whole image.

#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/scheduler/api/error_curve.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Returns consecutive passes that cover samples [from, to). Each is a node of the summation tree
/// (renderlib/render/band.h): an aligned power-of-two number of blocks of 8 samples. The first
/// passes are small, so that a first image appears soon; then their sizes double, up to about a
/// quarter of `to`. `from`: 0 or a multiple of 8; to > from.
std::vector<SampleRange> passes_between(std::uint64_t from, std::uint64_t to);

/// Error checkpoints before the last sample are multiples of this number of samples.
inline constexpr std::uint64_t kCheckpointStep = 16;
/// The fewest samples per pixel from which the error is estimated.
inline constexpr std::uint64_t kMinCheckpoint = 32;

/// Returns the next error checkpoint: the number of samples per pixel at which the error is
/// compared with `target` again. It is at most max_samples. It is at least kMinCheckpoint, unless
/// max_samples is less. Passes up to a checkpoint run without a barrier between them. `samples`:
/// the last checkpoint; 0: there is none yet. `error`: the error at the last checkpoint; negative
/// or NaN: unknown.
///
/// With n samples per pixel, the error of an image falls at a rate between n^-1/2 (random samples)
/// and n^-1 (well stratified samples). Let S be the number of samples at which the error reaches
/// the target if it falls as n^-1/2, the slowest rate. S is clamped to the range from 9/8 to 5/4 of
/// `samples`. Let F be the number of samples at which the error reaches the target if it falls as
/// n^-1, the fastest rate. The target cannot be met before F. The checkpoint is the larger of F and
/// the clamped S. So a job renders at most about a quarter too much; the mean over the scenes of
/// the gallery is 7 %.
std::uint64_t next_checkpoint(std::uint64_t samples, double error, double target,
                              std::uint64_t max_samples);

/// Returns the sample at which a job with this error target is expected to end: the first
/// checkpoint at which the extrapolated error reaches `target`. `planned`: the next checkpoint,
/// with which the search begins. std::nullopt: no error is known yet.
std::optional<std::uint64_t> expected_end(const ErrorCurve& curve, double target,
                                          std::uint64_t planned, std::uint64_t max_samples);

/// Returns true if the error at a checkpoint of an adaptive job is at most four times the target.
/// Then the samples rendered so far are the pilot. From the pilot, the number of samples of each
/// half tile (half of the pixels of a 16 x 16 tile) is to be planned at this checkpoint. The pilot
/// has at least about a sixteenth of the samples that random sampling would need to reach the
/// target.
bool time_to_plan_tiles(double error, double target);

/// Returns the error that is to be reached next. If the tiles are still to be planned
/// (`tiles_to_plan`), this is four times `target`, the error at which they are planned
/// (time_to_plan_tiles). Otherwise it is `target`.
double next_target(double target, bool tiles_to_plan);

/// Returns the next pass of a job with a time limit, after samples [0, from). `fits`: the number of
/// samples per pixel that are expected to fit into the remaining time. If `from` is at least 32,
/// the pass has at most a quarter of `from` samples. It has at most `fits` samples, unless `fits`
/// is less than a block (8). from < max_samples.
SampleRange next_timed_pass(std::uint64_t from, double fits, std::uint64_t max_samples);

}  // namespace bandsaw::coordinator
