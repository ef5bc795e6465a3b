// The handlers of the gallery: its scenes with their newest jobs on this farm, and the request to
// render a scene.

#include "absl/strings/str_cat.h"
#include "coordinator/convert/farm_messages.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/link/random.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Limits of the jobs that users submit from the gallery. Larger jobs need `bandsaw submit`.
constexpr std::uint64_t kMaxGallerySamples = 4096;
constexpr std::uint32_t kMaxWidth = 4096;

/// Returns the scenes of the gallery, each with the newest job that the gallery submitted for it.
web::Gallery gallery_message(Engine& engine, const Gallery& gallery) {
  const auto jobs = blocking_call<std::vector<JobView>>([&](auto answer) { engine.jobs(answer); });
  web::Gallery message;
  for (const GalleryScene& scene : gallery.scenes()) {
    web::Scene* const card = message.add_scene();
    card->set_name(scene.name);
    card->set_about(scene.about);
    if (const JobView* job = newest_of(scene, jobs)) {
      *card->mutable_job()->mutable_status() = to_message(*job);
    }
  }
  return message;
}

/// Submits a job for the scene that the body, a web::RenderScene in JSON, names.
absl::StatusOr<web::Submitted> render(Scenes& scenes, const Gallery& gallery,
                                      const HttpBody& body) {
  web::RenderScene request;
  RETURN_IF_ERROR(read_json(body, request));
  const GalleryScene* const scene = gallery.find(request.scene());
  if (scene == nullptr) {
    return absl::NotFoundError("there is no such scene in the gallery");
  }
  if (request.samples() < 1 || request.samples() > kMaxGallerySamples ||
      request.width() > kMaxWidth) {
    return absl::InvalidArgumentError(absl::StrCat("samples: must lie in [1, ", kMaxGallerySamples,
                                                   "]; width: at most ", kMaxWidth));
  }
  return scenes.submit(scene->path, {.request_id = request_prefix(*scene) + link::random_hex(8),
                                     .width = request.width(),
                                     .stop = StopAtSamples{request.samples()}});
}

}  // namespace

void add_gallery(Router& router, Engine& engine, Scenes& scenes, const Gallery& gallery) {
  router.get("/api/gallery", [&engine, &gallery](const HttpRequest&) {
    return reply(gallery_message(engine, gallery));
  });
  router.post("/api/gallery/render", [&scenes, &gallery](const HttpRequest&, const HttpBody& body) {
    return answer(render(scenes, gallery, body));
  });
}

}  // namespace bandsaw::coordinator
