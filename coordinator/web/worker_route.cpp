// The worker's program, for machines that have none yet.

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"

namespace bandsaw::coordinator {

void add_worker_program(HttpServer& server, const WorkerProgram& program) {
  if (program.bytes.empty()) {
    return;
  }
  server.Get(absl::StrCat("/", kWorkerProgram), [&program](const httplib::Request&,
                                                           httplib::Response& response) {
    response.set_header("X-Bandsaw-Version", program.version);
    // RFC 9530, section 3.
    response.set_header("Repr-Digest",
                        absl::StrCat("sha-256=:", absl::Base64Escape(program.digest.raw()), ":"));
    send_bytes(response, program.bytes, "application/octet-stream", nullptr);
  });
}

}  // namespace bandsaw::coordinator
