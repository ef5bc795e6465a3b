#pragma once

// What the server answers, by path. Access is checked before any of these runs.

#include "coordinator/engine/engine.h"
#include "coordinator/web/access.h"
#include "coordinator/web/gallery.h"
#include "coordinator/web/http_server.h"
#include "coordinator/web/pictures.h"
#include "coordinator/web/scenes.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// The page's files, which are part of the program.
void add_page(HttpServer& server);
/// What is given outlives the server's threads, here and below. /bandsaw-worker/MACHINE is the
/// program for the architecture of that name, /bandsaw-worker that for the coordinator's own.
void add_worker_programs(HttpServer& server, const WorkerPrograms& programs);
void add_login(HttpServer& server, Access& access);
void add_farm(HttpServer& server, Engine& engine);
void add_jobs(HttpServer& server, Engine& engine);
void add_pictures(HttpServer& server, Pictures& pictures, const TellReport& report);
void add_scenes(HttpServer& server, Scenes& scenes);
void add_gallery(HttpServer& server, Engine& engine, Scenes& scenes, const Gallery& gallery);

/// The number that a path's first group matched. NOT_FOUND: that is no job's.
absl::StatusOr<JobId> job_of(const httplib::Request& request);

}  // namespace bandsaw::coordinator
