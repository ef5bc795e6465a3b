#pragma once

// The answers of the server by path. Access is checked before any of these runs.

#include "coordinator/engine/engine.h"
#include "coordinator/web/access.h"
#include "coordinator/web/gallery.h"
#include "coordinator/web/pictures.h"
#include "coordinator/web/router.h"
#include "coordinator/web/scenes.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// The page's files, which are part of the program.
void add_page(Router& router);
/// The arguments outlive the server's threads, here and below. /bandsaw-worker/MACHINE is the
/// program for the architecture of that name, /bandsaw-worker that for the coordinator's own.
void add_worker_programs(Router& router, const WorkerPrograms& programs);
void add_login(Router& router, Access& access);
void add_farm(Router& router, Engine& engine);
void add_jobs(Router& router, Engine& engine);
void add_pictures(Router& router, Pictures& pictures, const TellReport& report);
void add_scenes(Router& router, Scenes& scenes);
void add_gallery(Router& router, Engine& engine, Scenes& scenes, const Gallery& gallery);

/// The job that the path names in place of "*". NOT_FOUND: this is no job's number.
absl::StatusOr<JobId> job_of(const HttpRequest& request);

}  // namespace bandsaw::coordinator
