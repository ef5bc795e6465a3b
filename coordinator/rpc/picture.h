#pragma once

// Returns the present image of a job, finished or not, for the calls Farm.Preview and
// Farm.GetResult and for the dashboard.

#include <cstdint>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"

namespace bandsaw::coordinator {

/// Returns the job's current state. NOT_FOUND: no such job. Waits for the engine, as do all
/// functions here.
absl::StatusOr<JobView> job_view(Engine& engine, JobId job);

/// An image, and its share of the memory budget Engine::images.
struct HeldImage {
  StoredResult result;
  MemoryBudget::Share share;
};

/// Returns the finished image, or another part of the result (FinishedPart). Errors: those of
/// Engine::result. Also returns RESOURCE_EXHAUSTED, as picture_of() and preview_of() do, if images
/// that are viewed or downloaded at the same time leave too little memory.
absl::StatusOr<HeldImage> result_of(Engine& engine, JobId job,
                                    FinishedPart part = FinishedPart::kImage);

/// Returns the finished image of the job. If the job is not done, returns its present image. The
/// image is reduced by a whole factor, so that each side has at most about `most_side` (>= 1)
/// pixels. `digest` of the result is not set. For a sequence, returns the image of the frame that
/// was done last. If no frame is done, returns the image of the first frame that is being rendered.
/// NOT_FOUND: no band (a rendered range of rows and samples) of the job is stored.
absl::StatusOr<HeldImage> picture_of(Engine& engine, const JobView& job, std::uint32_t most_side);
/// Does the same as picture_of() for the job with this id, and sets `digest`.
absl::StatusOr<HeldImage> preview_of(Engine& engine, JobId job, std::uint32_t most_side);

}  // namespace bandsaw::coordinator
