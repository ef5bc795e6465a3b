#pragma once

// Each function add_X adds the handlers of one part of the dashboard's requests to the router. The
// class Dashboard calls all of these functions. The arguments MUST outlive the server's threads.
// Access is checked before a handler runs. proto/web.proto has the messages of each path.

#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/web/access.h"
#include "coordinator/web/browser_leases.h"
#include "coordinator/web/browser_program.h"
#include "coordinator/web/browser_sockets.h"
#include "coordinator/web/clean_pictures.h"
#include "coordinator/web/gallery.h"
#include "coordinator/web/pictures.h"
#include "coordinator/web/router.h"
#include "coordinator/web/scenes.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// Adds the page's files, which are embedded in the program.
void add_page(Router& router);
/// Adds the workers' programs: /bandsaw-worker/MACHINE is the program for the architecture MACHINE,
/// and /bandsaw-worker is the program for the coordinator's own architecture.
void add_worker_programs(Router& router, const WorkerPrograms& programs);
/// Adds login and logout.
void add_login(Router& router, Access& access);
/// Adds the list of jobs and workers, the logs of workers, and metrics.
void add_farm(Router& router, Engine& engine);
/// Adds the state of a job, its frames, and the commands on it, such as cancel.
void add_jobs(Router& router, Engine& engine);
/// Adds the previews, the finished image and the report of a job.
void add_pictures(Router& router, Pictures& pictures, const MakeReport& report);
/// Adds the requests for denoised pictures of finished jobs.
void add_clean_pictures(Router& router, CleanPictures& pictures);
/// Adds the request that submits a scene that is sent as one file.
void add_scenes(Router& router, Scenes& scenes);
/// Adds the requests that submit a scene whose files are sent separately, each file once.
void add_scene_files(Router& router, Engine& engine, Scenes& scenes);
/// Adds the requests that show, make and revoke the link by which browsers join.
void add_browser_link(Router& router, BrowserAccess& access);
/// Adds the requests of browsers that render.
void add_join(Router& router, Engine& engine, BrowserAccess& access, BrowserLeases& leases,
              BrowserSockets& sockets, const BrowserProgram& program);
/// Adds the list of the installed scenes, and the request that renders one of them.
void add_gallery(Router& router, Engine& engine, Scenes& scenes, const Gallery& gallery);

/// Returns the job id at the place of "*" in the path. NOT_FOUND: the text there is not a job id.
absl::StatusOr<JobId> job_of(const HttpRequest& request);

}  // namespace bandsaw::coordinator
