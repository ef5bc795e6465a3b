#pragma once

// The current picture of a job, for display.

#include <cstdint>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"

namespace bandsaw::coordinator {

/// Returns the job's current state. NOT_FOUND: no such job. Waits for the engine, as do all
/// functions here.
absl::StatusOr<JobView> look_at(Engine& engine, JobId job);

/// Returns the finished image, or the number of samples of each pixel. Errors as Engine::result.
absl::StatusOr<StoredResult> result_of(Engine& engine, JobId job,
                                       FinishedPart part = FinishedPart::kImage);

/// Returns the job's current picture, or its finished image, at most about `most_side` pixels a
/// side, >= 1; `digest` is not set. NOT_FOUND: no pixel of it is stored.
absl::StatusOr<StoredResult> picture_of(Engine& engine, const JobView& job,
                                        std::uint32_t most_side);
/// The same for the job's current state, with `digest`.
absl::StatusOr<StoredResult> preview_of(Engine& engine, JobId job, std::uint32_t most_side);

}  // namespace bandsaw::coordinator
