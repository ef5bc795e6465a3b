#pragma once

// The present picture of a job, for display.

#include <cstdint>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"

namespace bandsaw::coordinator {

/// Returns the job's current state. NOT_FOUND: no such job. Waits for the engine, as do all
/// functions here.
absl::StatusOr<JobView> look_at(Engine& engine, JobId job);

/// An image, and its bytes of Engine::images.
struct HeldImage {
  StoredResult result;
  MemoryBudget::Share share;
};

/// Returns the finished image, or the number of samples of each pixel. Errors as Engine::result;
/// here and below also RESOURCE_EXHAUSTED: other images that are viewed or downloaded leave no
/// memory.
absl::StatusOr<HeldImage> result_of(Engine& engine, JobId job,
                                    FinishedPart part = FinishedPart::kImage);

/// Returns the present image of the job, or its finished image, with at most about `most_side`
/// pixels per side, >= 1; without `digest`. NOT_FOUND: none of its bands is there.
absl::StatusOr<HeldImage> picture_of(Engine& engine, const JobView& job, std::uint32_t most_side);
/// Returns the same for the job's present state, with `digest`.
absl::StatusOr<HeldImage> preview_of(Engine& engine, JobId job, std::uint32_t most_side);

}  // namespace bandsaw::coordinator
