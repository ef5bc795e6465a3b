// The handlers of the dashboard's requests that concern the whole farm: all jobs, all workers, the
// logs of workers, and metrics.

#include <algorithm>

#include "coordinator/convert/farm_messages.h"
#include "coordinator/rpc/checked_messages.h"
#include "coordinator/web/metrics.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw::coordinator {
namespace {

/// Maximum number of jobs in the overview; `bandsaw jobs` lists all.
constexpr std::size_t kMaxJobs = 200;

std::vector<JobView> all_jobs(Engine& engine) {
  return blocking_call<std::vector<JobView>>([&](auto answer) { engine.jobs(answer); });
}

std::vector<WorkerView> all_workers(Engine& engine) {
  return blocking_call<std::vector<WorkerView>>([&](auto answer) { engine.workers(answer); });
}

/// Returns the jobs and the workers. Unfinished jobs come first. In both groups of jobs, newer ones
/// come before older ones.
web::Overview overview(Engine& engine) {
  web::Overview overview;
  overview.set_version(BANDSAW_VERSION);
  std::vector<JobView> jobs = all_jobs(engine);
  // The page shows the guides of a clean picture (images for the denoiser, clean_pictures.h) with
  // the job of that picture. So the jobs that render guides are left out here. `bandsaw jobs` lists
  // them.
  std::erase_if(jobs, [](const JobView& job) { return is_guide(job.spec.settings.integrator); });
  std::sort(jobs.begin(), jobs.end(), [](const JobView& a, const JobView& b) {
    return is_final(a.state) != is_final(b.state) ? is_final(b.state) : a.id > b.id;
  });
  const std::size_t shown = std::min(jobs.size(), kMaxJobs);
  for (std::size_t i = 0; i < shown; ++i) {
    *overview.add_job()->mutable_status() = to_message(jobs[i]);
  }
  overview.set_jobs_left_out(static_cast<std::uint32_t>(jobs.size() - shown));
  for (const WorkerView& worker : all_workers(engine)) {
    *overview.add_worker() = to_message(worker);
  }
  return overview;
}

/// Returns the log of the worker that the request's parameter `name` names.
absl::StatusOr<web::Log> worker_log(Engine& engine, const HttpRequest& request) {
  ASSIGN_OR_RETURN(const std::string name, reason_field("name", request.parameter("name")));
  using Lines = absl::StatusOr<std::vector<std::string>>;
  ASSIGN_OR_RETURN(const std::vector<std::string> lines,
                   blocking_call<Lines>([&](auto answer) { engine.logs(name, answer); }));
  web::Log log;
  log.mutable_line()->Assign(lines.begin(), lines.end());
  return log;
}

}  // namespace

void add_farm(Router& router, Engine& engine) {
  router.get("/api/farm", [&engine](const HttpRequest&) { return reply(overview(engine)); });
  router.get("/api/workers/log",
             [&engine](const HttpRequest& request) { return answer(worker_log(engine, request)); });
  router.get("/metrics", [&engine](const HttpRequest&) {
    return text_reply(
        metrics(all_jobs(engine), all_workers(engine), engine.free_bytes(), BANDSAW_VERSION),
        "text/plain; version=0.0.4; charset=utf-8");
  });
}

}  // namespace bandsaw::coordinator
