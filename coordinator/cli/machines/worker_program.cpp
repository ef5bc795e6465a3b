#include "coordinator/cli/machines/worker_program.h"

#include <cstdint>
#include <limits>

#include "absl/strings/ascii.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/cli/base/program_folder.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

absl::StatusOr<std::string> version_of(const std::string& program) {
  constexpr double kPatience = 10;  // seconds
  ASSIGN_OR_RETURN(const ChildOutcome outcome,
                   run_child({program, "--version"}, kPatience, nullptr));
  if (outcome.end != ChildOutcome::End::kExited || outcome.wait_status != 0) {
    return absl::FailedPreconditionError(absl::StrCat(program, " does not run here"));
  }
  absl::string_view said = absl::StripAsciiWhitespace(outcome.output);
  absl::ConsumePrefix(&said, absl::StrCat(kWorkerProgram, " "));
  return std::string(said);
}

}  // namespace

absl::StatusOr<WorkerProgram> load_worker_program() {
  const std::string path = absl::StrCat(program_folder(), "/", kWorkerProgram);
  if (!file_exists(path)) {
    return absl::NotFoundError(absl::StrCat("there is no ", path));
  }
  WorkerProgram program;
  ASSIGN_OR_RETURN(program.version, version_of(path));
  ASSIGN_OR_RETURN(program.bytes, read_whole_file(path, std::numeric_limits<std::uint64_t>::max()));
  program.digest = wire::sha256(program.bytes);
  return program;
}

std::string worker_line(const std::string& url, const std::optional<wire::Digest>& public_key,
                        const wire::Digest& program, const std::string& join) {
  // The certificate is nobody's but the farm's, so only its key counts. The file gets its name when
  // it is whole: one of that name may be running.
  const std::string trust = public_key ? absl::StrCat(" -k --pinnedpubkey sha256//",
                                                      absl::Base64Escape(public_key->raw()))
                                       : "";
  const std::string file = kWorkerProgram;
  return absl::StrCat("curl -fsS", trust, " ", url, "/", file, " -o ", file, ".new && echo '",
                      program.hex(), "  ", file, ".new' | sha256sum -c - && chmod +x ", file,
                      ".new && mv ", file, ".new ", file, " && ./", file, " --join ", join);
}

}  // namespace bandsaw::coordinator
