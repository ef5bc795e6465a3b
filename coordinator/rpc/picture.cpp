// Takes a share of the memory budget for an image before the image is read or made, and reduces the
// image to the requested size.

#include "coordinator/rpc/picture.h"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/blocking_call.h"
#include "coordinator/engine/submit_check.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/shrink.h"

namespace bandsaw::coordinator {
namespace {

/// Takes the memory of an image of this size from the budget.
absl::StatusOr<MemoryBudget::Share> share_for(Engine& engine, std::uint32_t width,
                                              std::uint32_t height) {
  const std::uint64_t bytes = std::uint64_t{width} * height * sizeof(Rgb);
  if (std::optional<MemoryBudget::Share> share = engine.images().take(bytes)) {
    return *std::move(share);
  }
  const std::uint64_t mebibytes = (bytes + (1 << 20) - 1) >> 20;  // rounded up
  return absl::ResourceExhaustedError(
      absl::StrCat("images that are being downloaded leave no memory for this one of ", mebibytes,
                   " MiB; try again when a download has ended"));
}

/// Reads a part of the result of a finished job, after taking its memory from the budget.
absl::StatusOr<HeldImage> finished_image(Engine& engine, const JobView& job, FinishedPart part) {
  const RenderSettings& settings = job.spec.settings;
  ASSIGN_OR_RETURN(MemoryBudget::Share share, share_for(engine, settings.width, settings.height));
  using Result = absl::StatusOr<StoredResult>;
  ASSIGN_OR_RETURN(StoredResult result, blocking_call<Result>([&](auto answer) {
                     engine.result(job.id, part, answer);
                   }));
  return HeldImage{std::move(result), std::move(share)};
}

/// Reduces the image by these factors, and its share of the memory accordingly.
void shrink(HeldImage& held, std::uint32_t across, std::uint32_t down) {
  if (across > 1 || down > 1) {
    held.result.image = shrunk(held.result.image, across, down);
    held.share.resize(held.result.image.pixels.size() * sizeof(Rgb));
  }
}

/// Returns the job of the frame that was done last. If no frame is done, returns the job of the
/// first frame that is being rendered.
absl::StatusOr<JobView> frame_to_show(Engine& engine, JobId sequence) {
  using Frames = absl::StatusOr<std::vector<FrameView>>;
  ASSIGN_OR_RETURN(const std::vector<FrameView> frames,
                   blocking_call<Frames>([&](auto answer) { engine.frames(sequence, 0, answer); }));
  const FrameView* best = nullptr;
  for (const FrameView& frame : frames) {
    const bool done = frame.state == FrameState::kDone;
    const bool better = best == nullptr || (done && best->state != FrameState::kDone) ||
                        (done && frame.changed > best->changed);
    if ((done || frame.state == FrameState::kRendering) && better) {
      best = &frame;
    }
  }
  return best == nullptr
             ? absl::NotFoundError(absl::StrCat("no frame of job ", sequence, " is rendered yet"))
             : job_view(engine, best->job);
}

}  // namespace

absl::StatusOr<JobView> job_view(Engine& engine, JobId job) {
  using View = absl::StatusOr<JobView>;
  return blocking_call<View>([&](auto answer) {
    engine.watch(job, [answer](View view) {
      answer(std::move(view));
      return false;
    });
  });
}

absl::StatusOr<HeldImage> result_of(Engine& engine, JobId job, FinishedPart part) {
  ASSIGN_OR_RETURN(const JobView view, job_view(engine, job));
  return finished_image(engine, view, part);
}

absl::StatusOr<HeldImage> picture_of(Engine& engine, const JobView& job, std::uint32_t most_side) {
  if (job.has_frames()) {
    ASSIGN_OR_RETURN(const JobView frame, frame_to_show(engine, job.id));
    return picture_of(engine, frame, most_side);
  }
  const RenderSettings& settings = job.spec.settings;
  const std::uint32_t side = std::max(settings.width, settings.height);
  const std::uint32_t step = side / most_side + (side % most_side == 0 ? 0 : 1);
  if (job.state == JobState::kDone) {
    ASSIGN_OR_RETURN(HeldImage held, finished_image(engine, job, FinishedPart::kImage));
    shrink(held, step, step);
    return held;
  }
  // Engine::preview() returns only every step-th row, so shrink() has to reduce only the columns.
  const std::uint32_t rows = (settings.height - 1) / step + 1;
  ASSIGN_OR_RETURN(MemoryBudget::Share share, share_for(engine, settings.width, rows));
  using Part = absl::StatusOr<Image>;
  ASSIGN_OR_RETURN(Image image,
                   blocking_call<Part>([&](auto answer) { engine.preview(job.id, step, answer); }));
  HeldImage held{{.image = std::move(image),
                  .digest = {},
                  .display = display_of(job.spec.manifest, engine.blobs())},
                 std::move(share)};
  shrink(held, step, 1);
  return held;
}

absl::StatusOr<HeldImage> preview_of(Engine& engine, JobId job, std::uint32_t most_side) {
  ASSIGN_OR_RETURN(const JobView view, job_view(engine, job));
  ASSIGN_OR_RETURN(HeldImage held, picture_of(engine, view, most_side));
  held.result.digest = wire::sha256(std::as_bytes(std::span(held.result.image.pixels)));
  return held;
}

}  // namespace bandsaw::coordinator
