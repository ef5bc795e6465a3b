// worker_line() builds the shell command that a user pastes on another machine: it downloads the
// worker with curl, checks its SHA-256 and starts it.

#include "coordinator/cli/machines/worker_line.h"

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {
namespace {

/// Returns a shell command that sets the shell variable `d` to the digest of the program for the
/// machine's architecture. If `programs` has none, the command prints an error and fails.
std::string choice_of_digest(const WorkerDigests& programs) {
  std::string arms;
  std::string names;
  for (const auto& [machine, digest] : programs) {
    absl::StrAppend(&arms, machine_name(machine), "|", other_machine_name(machine),
                    ") d=", digest.hex(), ";; ");
    absl::StrAppend(&names, names.empty() ? "" : ", ", machine_name(machine));
  }
  return absl::StrCat("case $(uname -m) in ", arms, "*) echo \"", kWorkerProgram,
                      ": the coordinator has no worker program for $(uname -m), only for ", names,
                      "\" >&2; false;; esac");
}

}  // namespace

std::string worker_line(const std::string& url, const std::optional<wire::Digest>& public_key,
                        const WorkerDigests& programs, const std::string& join) {
  // The certificate is the farm's own and not signed by an authority, so curl checks only its key.
  // The download goes to a file with another name, which is renamed at the end, because a program
  // of the final name may be running. curl ignores the proxy that the environment sets, because the
  // worker ignores it as well.
  const std::string trust = public_key ? absl::StrCat(" -k --pinnedpubkey sha256//",
                                                      absl::Base64Escape(public_key->raw()))
                                       : "";
  const std::string file = kWorkerProgram;
  return absl::StrCat(choice_of_digest(programs), " && curl --noproxy '*' -fsS", trust, " ", url,
                      "/", file, "/$(uname -m) -o ", file, ".new && echo \"$d  ", file,
                      ".new\" | sha256sum -c - && chmod +x ", file, ".new && mv ", file, ".new ",
                      file, " && ./", file, " --join ", join);
}

}  // namespace bandsaw::coordinator
