// Hands out the worker's program to machines that have none.

#include <algorithm>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"

namespace bandsaw::coordinator {
namespace {

/// Returns a NOT_FOUND error that names the architectures of `programs`.
absl::Status no_program(const WorkerPrograms& programs) {
  const std::string there = absl::StrJoin(programs, ", ", [](std::string* out, const auto& one) {
    absl::StrAppend(out, machine_name(one.machine));
  });
  return absl::NotFoundError(
      absl::StrCat("the coordinator has no bandsaw-worker for this architecture; it has: ",
                   there.empty() ? "none" : there,
                   ". Install the program for this architecture at the coordinator, as "
                   "deploy/README.md says, and start the coordinator again"));
}

/// Returns the program for `machine` (std::nullopt: unknown architecture), or a 404.
HttpReply program_for(const WorkerPrograms& programs, std::optional<Machine> machine) {
  const auto found = std::find_if(programs.begin(), programs.end(),
                                  [&](const WorkerProgram& one) { return one.machine == machine; });
  if (found == programs.end()) {
    return refuse(no_program(programs));
  }
  HttpReply reply{.type = "application/octet-stream", .bytes = found->bytes};
  reply.headers.emplace_back("X-Bandsaw-Version", found->version);
  // RFC 9530, section 3.
  reply.headers.emplace_back(
      "Repr-Digest", absl::StrCat("sha-256=:", absl::Base64Escape(found->digest.raw()), ":"));
  return reply;
}

}  // namespace

void add_worker_programs(Router& router, const WorkerPrograms& programs) {
  const std::string path = absl::StrCat("/", kWorkerProgram);
  router.get(path, [&programs](const HttpRequest&) { return program_for(programs, kThisMachine); });
  router.get(path + "/*", [&programs](const HttpRequest& request) {
    return program_for(programs, machine_named(request.captured));
  });
}

}  // namespace bandsaw::coordinator
