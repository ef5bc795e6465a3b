#pragma once

// What is there of a job's image, for people to look at.

#include <cstdint>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"

namespace bandsaw::coordinator {

/// The job as it is now. NOT_FOUND. Waits for the engine, as all here.
absl::StatusOr<JobView> look_at(Engine& engine, JobId job);

/// The finished image, or how many samples each pixel has. Errors as Engine::result.
absl::StatusOr<StoredResult> result_of(Engine& engine, JobId job,
                                       FinishedPart part = FinishedPart::kImage);

/// What is there of the job, or its finished image, at most about `most_side` pixels a side, >= 1;
/// without `digest`. NOT_FOUND: nothing of it is there.
absl::StatusOr<StoredResult> picture_of(Engine& engine, const JobView& job,
                                        std::uint32_t most_side);
/// The same of the job as it is now, with `digest`.
absl::StatusOr<StoredResult> preview_of(Engine& engine, JobId job, std::uint32_t most_side);

}  // namespace bandsaw::coordinator
