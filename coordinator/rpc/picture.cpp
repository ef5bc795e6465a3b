#include "coordinator/rpc/picture.h"

#include <algorithm>
#include <span>
#include <utility>

#include "coordinator/engine/ask.h"
#include "coordinator/engine/submit_check.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/shrink.h"

namespace bandsaw::coordinator {

absl::StatusOr<JobView> look_at(Engine& engine, JobId job) {
  using View = absl::StatusOr<JobView>;
  return ask<View>([&](auto answer) {
    engine.watch(job, [answer](View view) {
      answer(std::move(view));
      return false;
    });
  });
}

absl::StatusOr<StoredResult> result_of(Engine& engine, JobId job, FinishedPart part) {
  using Result = absl::StatusOr<StoredResult>;
  return ask<Result>([&](auto answer) { engine.result(job, part, answer); });
}

absl::StatusOr<StoredResult> picture_of(Engine& engine, const JobView& job,
                                        std::uint32_t most_side) {
  const RenderSettings& settings = job.spec.settings;
  const std::uint32_t side = std::max(settings.width, settings.height);
  const std::uint32_t step = side / most_side + (side % most_side == 0 ? 0 : 1);
  if (job.state == JobState::kDone) {
    ASSIGN_OR_RETURN(StoredResult result, result_of(engine, job.id));
    result.image = shrunk(result.image, step, step);
    return result;
  }
  using Part = absl::StatusOr<Image>;
  ASSIGN_OR_RETURN(const Image rows,
                   ask<Part>([&](auto answer) { engine.preview(job.id, step, answer); }));
  return StoredResult{.image = shrunk(rows, step, 1),
                      .digest = {},
                      .display = display_of(job.spec.manifest, engine.blobs())};
}

absl::StatusOr<StoredResult> preview_of(Engine& engine, JobId job, std::uint32_t most_side) {
  ASSIGN_OR_RETURN(const JobView view, look_at(engine, job));
  ASSIGN_OR_RETURN(StoredResult picture, picture_of(engine, view, most_side));
  picture.digest = wire::sha256(std::as_bytes(std::span(picture.image.pixels)));
  return picture;
}

}  // namespace bandsaw::coordinator
