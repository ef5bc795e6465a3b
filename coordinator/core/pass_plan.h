#pragma once

// Which passes a job is sawn into: pure functions of the stop rule and of what was measured, so
// that the same job has the same passes on every farm.

#include <cstdint>
#include <optional>
#include <vector>

#include "coordinator/core/error_curve.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Passes that follow each other and cover samples [from, to): each a node, beginning small so that
/// a first image comes soon, then doubling, none longer than about a quarter of `to`. `from`: 0 or
/// a multiple of 16; to > from.
std::vector<SampleRange> passes_between(std::uint64_t from, std::uint64_t to);

/// When the error is looked at next, in samples a pixel: up to there the passes run on without
/// waiting for each other. `samples`: where it was measured as `error` (not known: negative or not
/// a number); 0 at the beginning. The error of an image falls between n^-1/2 (random samples) and
/// n^-1 (well stratified ones). Before n^-1 could have reached the target there is no use in
/// looking; then it is looked at where n^-1/2 will have, but after at least an eighth and at most a
/// quarter more: so a job renders at most about a quarter too much, and 7 % on average of gallery
/// scenes. Never above max_samples.
std::uint64_t next_look(std::uint64_t samples, double error, double target,
                        std::uint64_t max_samples);

/// Where a job that ends at `target` will end, in samples a pixel, by how its error has fallen: at
/// the first look from `planned` (the next one) on that finds it reached. Nothing while no error is
/// known.
std::optional<std::uint64_t> expected_end(const ErrorCurve& curve, double target,
                                          std::uint64_t planned, std::uint64_t max_samples);

/// Whether tiles are planned at a look that finds this error: not before it is near enough to the
/// target that the pilot is about a sixteenth of what random samples need, or more.
bool time_to_plan_tiles(double error, double target);

/// The error that the next look waits for: the target, or, while tiles are still to be planned,
/// what they are planned at.
double next_target(double target, bool tiles_to_plan);

/// The next pass of a job with a time limit, after samples [0, from): at most a quarter of what is
/// there, and no more than `fits` samples where that is not less than a block. from < max_samples.
SampleRange next_timed_pass(std::uint64_t from, double fits, std::uint64_t max_samples);

}  // namespace bandsaw::coordinator
