// Lets the importer (a process with few rights) read a scene and store it, and submits the job.

#include "coordinator/web/scenes.h"

#include <optional>

#include "absl/cleanup/cleanup.h"
#include "coordinator/web/reply.h"
#include "proto/link/random.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/settings_of.h"

namespace bandsaw::coordinator {
absl::StatusOr<web::Submitted> Scenes::submit(const std::string& path, const SceneRequest& wanted) {
  const absl::Cleanup done = [this] { --reading_; };
  if (++reading_ > kAtOnce) {
    return absl::UnavailableError("other scenes are being read; try again in a moment");
  }
  ASSIGN_OR_RETURN(const SceneOnFarm scene, import_scene_(path, wanted.inside, stop_));
  const JobSpec spec{.request_id = wanted.request_id.empty() ? "dashboard-" + link::random_hex(8)
                                                             : wanted.request_id,
                     .name = wanted.title.empty() ? scene.info.name : wanted.title,
                     .manifest = scene.manifest,
                     .settings = settings_of(
                         scene.info, wanted.width == 0 ? std::nullopt : std::optional(wanted.width),
                         /*height=*/std::nullopt),
                     .stop = wanted.stop};
  RETURN_IF_ERROR(validate(spec.settings));
  using Answer = absl::StatusOr<JobId>;
  ASSIGN_OR_RETURN(const JobId job,
                   blocking_call<Answer>([&](auto answer) { engine_.submit(spec, answer); }));
  web::Submitted submitted;
  submitted.set_job(job);
  submitted.mutable_warning()->Assign(scene.info.warnings.begin(), scene.info.warnings.end());
  return submitted;
}

}  // namespace bandsaw::coordinator
