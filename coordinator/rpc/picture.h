#pragma once

// The present picture of a job, for display.

#include <cstdint>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"

namespace bandsaw::coordinator {

/// Returns the job's current state. NOT_FOUND: no such job. Waits for the engine, as do all
/// functions here.
absl::StatusOr<JobView> look_at(Engine& engine, JobId job);

/// An image, and its share of the memory budget Engine::images.
struct HeldImage {
  StoredResult result;
  MemoryBudget::Share share;
};

/// Returns the finished image, or the number of samples of each pixel. Errors: those of
/// Engine::result. This function and those below also return RESOURCE_EXHAUSTED if images that are
/// viewed or downloaded at the same time leave too little memory.
absl::StatusOr<HeldImage> result_of(Engine& engine, JobId job,
                                    FinishedPart part = FinishedPart::kImage);

/// Returns the present image of the job, or its finished image, with at most about `most_side`
/// pixels per side, >= 1; without `digest`. Of a sequence: of the frame that was done last, or else
/// of the first that is rendered. NOT_FOUND: none of its bands is stored.
absl::StatusOr<HeldImage> picture_of(Engine& engine, const JobView& job, std::uint32_t most_side);
/// Returns the same for the job's present state, with `digest`.
absl::StatusOr<HeldImage> preview_of(Engine& engine, JobId job, std::uint32_t most_side);

}  // namespace bandsaw::coordinator
