// Passes are aligned ranges of blocks (of 8 samples) whose lengths are powers of two. So each pass
// is a node of the summation tree (renderlib/render/band.h). A checkpoint is a number of samples at
// which the error is compared with the target. next_checkpoint() assumes that the error falls as
// samples^-1/2 and computes at how many samples the error then reaches the target. It limits this
// number to the range from 9/8 to 5/4 of the last checkpoint. Then it assumes the fastest possible
// fall, samples^-1, and computes again at how many samples the error reaches the target. If this
// second number is larger, it is the next checkpoint. If the error is unknown, the next checkpoint
// has twice the samples of the last one.

#include "coordinator/scheduler/model/pass_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace bandsaw::coordinator {
namespace {

std::uint64_t blocks_of(std::uint64_t samples) {
  return (samples + kBlockSamples - 1) / kBlockSamples;
}

/// Returns the number of checkpoint steps that contain these samples.
std::uint64_t steps_of(std::uint64_t samples) {
  return (samples + kCheckpointStep - 1) / kCheckpointStep;
}

/// Returns the length in blocks of the longest pass that may begin at a block; 1 at block 0.
std::uint64_t alignment(std::uint64_t block) { return block == 0 ? 1 : longest_at(block); }

/// Returns the pass of `blocks` blocks that begins at a block, cut off at sample `end`.
SampleRange pass_at(std::uint64_t block, std::uint64_t blocks, std::uint64_t end) {
  return {block * kBlockSamples, std::min((block + blocks) * kBlockSamples, end)};
}

/// Rounds x down to a power of two times 8, 9, … or 15 eighths.
std::uint64_t eighths(std::uint64_t x) {
  const std::uint64_t step = std::max<std::uint64_t>(1, std::bit_floor(x) / 8);
  return x / step * step;
}

}  // namespace

std::vector<SampleRange> passes_between(std::uint64_t from, std::uint64_t to) {
  const std::uint64_t end = blocks_of(to);
  const std::uint64_t longest = std::bit_floor(std::max<std::uint64_t>(1, end / 4));
  std::vector<SampleRange> passes;
  for (std::uint64_t block = from / kBlockSamples; block < end;
       block += blocks_of(passes.back().samples())) {
    passes.push_back(
        pass_at(block, std::min({alignment(block), std::bit_floor(end - block), longest}), to));
  }
  return passes;
}

std::uint64_t next_checkpoint(std::uint64_t samples, double error, double target,
                              std::uint64_t max_samples) {
  const std::uint64_t now = steps_of(samples);
  // Returns the step that lies `part` steps, but at least one step, after the last checkpoint.
  const auto more = [now](std::uint64_t part) { return now + std::max<std::uint64_t>(1, part); };
  std::uint64_t next = more(now / 4);
  if (!(error >= 0)) {
    next = 2 * now;
  } else if (error > target) {
    // Returns the number of checkpoint steps at which the target is reached if the error falls as
    // samples^(-1 / power).
    const auto reached = [&](double power) {
      return static_cast<std::uint64_t>(
          std::min(std::ceil(static_cast<double>(now) * std::pow(error / target, power)),
                   static_cast<double>(steps_of(max_samples))));
    };
    next = std::max(std::clamp(reached(2), more(now / 8), more(now / 4)), reached(1));
  }
  return std::min(std::max(kMinCheckpoint, eighths(next) * kCheckpointStep), max_samples);
}

std::optional<std::uint64_t> expected_end(const ErrorCurve& curve, double target,
                                          std::uint64_t planned, std::uint64_t max_samples) {
  if (curve.empty() || curve.back().estimate.at_most() <= 0) {
    return std::nullopt;
  }
  std::uint64_t checkpoint = std::max(planned, curve.back().samples);
  while (checkpoint < max_samples) {
    const double error = error_at(curve, static_cast<double>(checkpoint));
    if (error <= target) {
      break;
    }
    checkpoint = next_checkpoint(checkpoint, error, target, max_samples);
  }
  return checkpoint;
}

bool time_to_plan_tiles(double error, double target) {
  return error >= 0 && error <= next_target(target, /*tiles_to_plan=*/true);
}

double next_target(double target, bool tiles_to_plan) {
  // The number of samples of each half tile is planned once the error is at most kPilotErrorRatio
  // times the target. With random sampling, reducing the error to a quarter takes 16 times the
  // samples.
  constexpr double kPilotErrorRatio = 4;
  return tiles_to_plan ? kPilotErrorRatio * target : target;
}

SampleRange next_timed_pass(std::uint64_t from, double fits, std::uint64_t max_samples) {
  const std::uint64_t block = from / kBlockSamples;
  const std::uint64_t end = blocks_of(max_samples);
  std::uint64_t blocks = std::min(alignment(block), std::bit_floor(end - block));
  if (block >= 4) {
    blocks = std::min(blocks, std::bit_floor(block / 4));
  }
  const double fitting = std::clamp(fits / static_cast<double>(kBlockSamples), 1.0, 1e9);
  blocks = std::min(blocks, std::bit_floor(static_cast<std::uint64_t>(fitting)));
  return pass_at(block, blocks, max_samples);
}

}  // namespace bandsaw::coordinator
