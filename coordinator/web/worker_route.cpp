// The worker's program, for machines that have none yet.

#include <algorithm>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"

namespace bandsaw::coordinator {
namespace {

absl::Status no_program(const WorkerPrograms& programs) {
  const std::string there = absl::StrJoin(programs, ", ", [](std::string* out, const auto& one) {
    absl::StrAppend(out, machine_name(one.machine));
  });
  return absl::NotFoundError(
      absl::StrCat("the coordinator has no bandsaw-worker for this architecture; it has: ",
                   there.empty() ? "none" : there,
                   ". Install the program of the other one at the coordinator, as deploy/README.md "
                   "says, and start the coordinator again"));
}

void send_program(httplib::Response& response, const WorkerPrograms& programs,
                  std::optional<Machine> machine) {
  const auto found = std::find_if(programs.begin(), programs.end(),
                                  [&](const WorkerProgram& one) { return one.machine == machine; });
  if (found == programs.end()) {
    return refuse(response, no_program(programs));
  }
  response.set_header("X-Bandsaw-Version", found->version);
  // RFC 9530, section 3.
  response.set_header("Repr-Digest",
                      absl::StrCat("sha-256=:", absl::Base64Escape(found->digest.raw()), ":"));
  send_bytes(response, found->bytes, "application/octet-stream", nullptr);
}

}  // namespace

void add_worker_programs(HttpServer& server, const WorkerPrograms& programs) {
  const std::string path = absl::StrCat("/", kWorkerProgram);
  server.Get(path, [&programs](const httplib::Request&, httplib::Response& response) {
    send_program(response, programs, kThisMachine);
  });
  server.Get(path + R"(/(\w+))",
             [&programs](const httplib::Request& request, httplib::Response& response) {
               send_program(response, programs, machine_named(request.matches[1].str()));
             });
}

}  // namespace bandsaw::coordinator
