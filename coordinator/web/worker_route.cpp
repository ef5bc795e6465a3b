// The worker's program, for machines that have none yet.

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/routes.h"

namespace bandsaw::coordinator {

void add_worker_program(Router& router, const WorkerProgram& program) {
  if (program.bytes.empty()) {
    return;
  }
  router.get(absl::StrCat("/", kWorkerProgram), [&program](const HttpRequest&) {
    HttpReply reply{.type = "application/octet-stream", .bytes = program.bytes};
    reply.headers.emplace_back("X-Bandsaw-Version", program.version);
    // RFC 9530, section 3.
    reply.headers.emplace_back(
        "Repr-Digest", absl::StrCat("sha-256=:", absl::Base64Escape(program.digest.raw()), ":"));
    return reply;
  });
}

}  // namespace bandsaw::coordinator
