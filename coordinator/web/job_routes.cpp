// One job: what it is, and what people tell it.

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/rpc/convert.h"
#include "coordinator/rpc/picture.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using Told = absl::StatusOr<JobView>;
using TellJob = void (Engine::*)(JobId, std::function<void(Told)>);

void answer_with(httplib::Response& response, const Told& told) {
  if (!told.ok()) {
    refuse(response, told.status());
    return;
  }
  web::Job job;
  *job.mutable_status() = to_message(*told);
  reply(response, job);
}

void add_order(HttpServer& server, Engine& engine, const char* order, TellJob tell) {
  server.Post(absl::StrCat("/api/jobs/(\\d{1,19})/", order),
              [&engine, tell](const httplib::Request& request, httplib::Response& response,
                              const httplib::ContentReader&) {
                const auto job = job_of(request);
                answer_with(response,
                            job.ok() ? ask<Told>([&](auto answer) { (engine.*tell)(*job, answer); })
                                     : Told(job.status()));
              });
}

Told set_priority(Engine& engine, const httplib::Request& request,
                  const httplib::ContentReader& body) {
  ASSIGN_OR_RETURN(const JobId job, job_of(request));
  web::Priority wanted;
  RETURN_IF_ERROR(read_json(body, wanted));
  return ask<Told>([&](auto answer) { engine.set_priority(job, wanted.priority(), answer); });
}

absl::StatusOr<web::JobPage> job_page(Engine& engine, const httplib::Request& request) {
  ASSIGN_OR_RETURN(const JobId id, job_of(request));
  ASSIGN_OR_RETURN(const JobView view, look_at(engine, id));
  web::JobPage page;
  *page.mutable_job()->mutable_status() = to_message(view);
  for (const std::string& reason :
       ask<std::vector<std::string>>([&](auto answer) { engine.why(id, answer); })) {
    page.add_why(reason);
  }
  for (const RowsBy& by :
       ask<std::vector<RowsBy>>([&](auto answer) { engine.rendered_by(id, answer); })) {
    web::RowsBy* const rows = page.add_rendered();
    rows->set_first_row(by.rows.first);
    rows->set_last_row(by.rows.last);
    rows->set_worker(by.worker);
  }
  return page;
}

}  // namespace

absl::StatusOr<JobId> job_of(const httplib::Request& request) {
  JobId job = 0;
  if (!absl::SimpleAtoi(request.matches[1].str(), &job) || job == 0) {
    return absl::NotFoundError(absl::StrCat("there is no job ", request.matches[1].str()));
  }
  return job;
}

void add_jobs(HttpServer& server, Engine& engine) {
  server.Get("/api/jobs/(\\d{1,19})",
             [&engine](const httplib::Request& request, httplib::Response& response) {
               answer(response, job_page(engine, request));
             });
  add_order(server, engine, "cancel", &Engine::cancel);
  add_order(server, engine, "pause", &Engine::pause);
  add_order(server, engine, "resume", &Engine::resume);
  server.Post("/api/jobs/(\\d{1,19})/priority",
              [&engine](const httplib::Request& request, httplib::Response& response,
                        const httplib::ContentReader& body) {
                answer_with(response, set_priority(engine, request, body));
              });
}

}  // namespace bandsaw::coordinator
