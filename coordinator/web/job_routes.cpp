// The handlers for one job: its state, its frames, and commands (cancel, pause, …).

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/convert/farm_messages.h"
#include "coordinator/rpc/picture.h"
#include "coordinator/scheduler/api/clean_jobs.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/link/random.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using Changed = absl::StatusOr<JobView>;
using JobCommand = void (Engine::*)(JobId, std::function<void(Changed)>);

/// Returns the job after a change as a web::Job, or the error.
HttpReply answer_with(const Changed& changed) {
  if (!changed.ok()) {
    return refuse(changed.status());
  }
  web::Job job;
  *job.mutable_status() = to_message(*changed);
  return reply(job);
}

/// Adds the request POST /api/jobs/ID/NAME. It calls `command` for the job, and answers with the
/// state of the job after the command.
void add_command(Router& router, Engine& engine, const char* name, JobCommand command) {
  router.post(absl::StrCat("/api/jobs/*/", name), [&engine, command](const HttpRequest& request,
                                                                     const HttpBody&) {
    const auto job = job_of(request);
    return answer_with(
        job.ok() ? blocking_call<Changed>([&](auto answer) { (engine.*command)(*job, answer); })
                 : Changed(job.status()));
  });
}

/// Sets the job's priority to the one in the body. Returns the job after this change.
Changed set_priority(Engine& engine, const HttpRequest& request, const HttpBody& body) {
  ASSIGN_OR_RETURN(const JobId job, job_of(request));
  web::Priority wanted;
  RETURN_IF_ERROR(read_json(body, wanted));
  return blocking_call<Changed>(
      [&](auto answer) { engine.set_priority(job, wanted.priority(), answer); });
}

/// Returns the job's state, the reasons why it is not done, and which worker rendered which rows.
absl::StatusOr<web::JobPage> job_page(Engine& engine, const HttpRequest& request) {
  ASSIGN_OR_RETURN(const JobId id, job_of(request));
  ASSIGN_OR_RETURN(const JobView view, job_view(engine, id));
  web::JobPage page;
  *page.mutable_job()->mutable_status() = to_message(view);
  for (const std::string& reason :
       blocking_call<std::vector<std::string>>([&](auto answer) { engine.why(id, answer); })) {
    page.add_why(reason);
  }
  for (const RowsBy& by :
       blocking_call<std::vector<RowsBy>>([&](auto answer) { engine.rendered_by(id, answer); })) {
    web::RowsBy* const rows = page.add_rendered();
    rows->set_first_row(by.rows.first);
    rows->set_last_row(by.rows.last);
    rows->set_worker(by.worker);
  }
  return page;
}

/// Returns the frames of a sequence (a job of many frames) that have changed since an earlier
/// reply. The request's parameter `after` is the number of the last change that the client knows.
absl::StatusOr<farm::ListFramesReply> frames(Engine& engine, const HttpRequest& request) {
  ASSIGN_OR_RETURN(const JobId id, job_of(request));
  std::uint64_t after = 0;
  if (const std::string text = request.parameter("after");
      !text.empty() && !absl::SimpleAtoi(text, &after)) {
    return absl::InvalidArgumentError("after: must be a number");
  }
  using Frames = absl::StatusOr<std::vector<FrameView>>;
  ASSIGN_OR_RETURN(const std::vector<FrameView> found,
                   blocking_call<Frames>([&](auto answer) { engine.frames(id, after, answer); }));
  farm::ListFramesReply reply;
  reply.set_epoch(engine.epoch());
  for (const FrameView& frame : found) {
    *reply.add_frame() = to_message(frame);
  }
  return reply;
}

/// Renders all failed frames of a sequence again. Returns the sequence after this change.
absl::StatusOr<farm::JobStatus> retry(Engine& engine, const HttpRequest& request) {
  ASSIGN_OR_RETURN(const JobId id, job_of(request));
  ASSIGN_OR_RETURN(const JobView view, blocking_call<Changed>([&](auto answer) {
                     engine.retry_frames(id, /*frames=*/{}, answer);
                   }));
  return to_message(view);
}

/// Submits a job that renders albedo, normals or depth of another job's scene, with the same
/// settings.
absl::StatusOr<web::Submitted> submit_layer(Engine& engine, const HttpRequest& request) {
  constexpr std::uint64_t kMaxLayerSamples = 64;  // more do not visibly improve a layer
  ASSIGN_OR_RETURN(const JobId id, job_of(request));
  ASSIGN_OR_RETURN(const JobView view, job_view(engine, id));
  const std::string kind = request.parameter("kind");
  JobSpec spec = view.spec;
  if (kind == "albedo") {
    spec.settings.integrator = Integrator::kAlbedo;
  } else if (kind == "normals") {
    spec.settings.integrator = Integrator::kNormals;
  } else if (kind == "depth") {
    spec.settings.integrator = Integrator::kDepth;
  } else {
    return absl::InvalidArgumentError("kind: must be albedo, normals or depth");
  }
  StopAtSamples stop{16};  // the default
  const std::string samples = request.parameter("samples");
  if (!samples.empty() && (!absl::SimpleAtoi(samples, &stop.samples) || stop.samples < 1 ||
                           stop.samples > kMaxLayerSamples)) {
    return absl::InvalidArgumentError(
        absl::StrCat("samples: must be a number from 1 to ", kMaxLayerSamples));
  }
  spec.stop = stop;
  spec.request_id = "layer-" + link::random_hex(8);
  spec.name = with_suffix(spec.name, absl::StrCat(" (", kind, ")"));
  using Answer = absl::StatusOr<JobId>;
  ASSIGN_OR_RETURN(const JobId job, blocking_call<Answer>([&](auto answer) {
                     engine.submit(spec, answer, view.priority);
                   }));
  web::Submitted submitted;
  submitted.set_job(job);
  return submitted;
}

}  // namespace

absl::StatusOr<JobId> job_of(const HttpRequest& request) {
  JobId job = 0;
  if (!absl::SimpleAtoi(request.captured, &job) || job == 0) {
    return absl::NotFoundError(absl::StrCat("there is no job ", request.captured));
  }
  return job;
}

void add_jobs(Router& router, Engine& engine) {
  router.get("/api/jobs/*",
             [&engine](const HttpRequest& request) { return answer(job_page(engine, request)); });
  router.get("/api/jobs/*/frames",
             [&engine](const HttpRequest& request) { return answer(frames(engine, request)); });
  router.post("/api/jobs/*/retry", [&engine](const HttpRequest& request, const HttpBody&) {
    return answer(retry(engine, request));
  });
  add_command(router, engine, "cancel", &Engine::cancel);
  add_command(router, engine, "pause", &Engine::pause);
  add_command(router, engine, "resume", &Engine::resume);
  router.post("/api/jobs/*/layer", [&engine](const HttpRequest& request, const HttpBody&) {
    return answer(submit_layer(engine, request));
  });
  router.post("/api/jobs/*/priority", [&engine](const HttpRequest& request, const HttpBody& body) {
    return answer_with(set_priority(engine, request, body));
  });
}

}  // namespace bandsaw::coordinator
