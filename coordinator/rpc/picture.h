#pragma once

// The current picture of a job, for display.

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

/// The finished image, or how many samples each pixel has. Errors as Engine::result; here and below
/// also RESOURCE_EXHAUSTED: images that others look at or download leave no memory for it.
absl::StatusOr<HeldImage> result_of(Engine& engine, JobId job,
                                    FinishedPart part = FinishedPart::kImage);

/// What is there of the job, or its finished image, at most about `most_side` pixels a side, >= 1;
/// without `digest`. NOT_FOUND: nothing of it is there.
absl::StatusOr<HeldImage> picture_of(Engine& engine, const JobView& job, std::uint32_t most_side);
/// The same of the job as it is now, with `digest`.
absl::StatusOr<HeldImage> preview_of(Engine& engine, JobId job, std::uint32_t most_side);

}  // namespace bandsaw::coordinator
