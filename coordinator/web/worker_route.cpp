// The worker's program, for machines that have none yet.

#include <algorithm>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
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
    response.set_content_provider(
        program.bytes.size(), "application/octet-stream",
        [&program](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          constexpr std::size_t kPiece = 1 << 20;
          return sink.write(program.bytes.data() + offset, std::min(length, kPiece));
        });
  });
}

}  // namespace bandsaw::coordinator
