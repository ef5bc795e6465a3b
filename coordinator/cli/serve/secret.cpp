// The command `bandsaw secret rotate`: makes a new secret of workers or users. If a coordinator
// runs, it is asked to make the secret. Otherwise this program changes the files in the data
// folder.

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/serve/join_files.h"
#include "coordinator/store/data_folder.h"
#include "proto/link/browser_link.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

// The file with the farm's certificate and secrets.
std::string identity_file(const std::string& folder) { return folder + "/identity"; }

/// If this program runs as root, makes the owner of the folder the owner of the file. Otherwise
/// that owner, such as the user of an installed service, could not read the file.
absl::Status give_to_owner(const std::string& folder, const std::string& file) {
  struct stat owner {};
  if (geteuid() == 0 && (stat(folder.c_str(), &owner) != 0 ||
                         lchown(file.c_str(), owner.st_uid, owner.st_gid) != 0)) {
    return errno_status(errno, absl::StrCat("cannot give ", file, " to the owner of its folder"));
  }
  return absl::OkStatus();
}

/// Renews the secret in the folder, and revokes the link by which browsers join the farm. Returns
/// the path of the file with the new join string. The path is empty if no join string was written;
/// then the next `serve` writes it. FAILED_PRECONDITION: a coordinator is using the folder.
absl::StatusOr<std::string> rotate_here(const std::string& folder, link::Role role) {
  ASSIGN_OR_RETURN(const DataFolder locked, DataFolder::open(folder));
  RETURN_IF_ERROR(link::remove_browser_link(folder));
  ASSIGN_OR_RETURN(const RenewedSecret renewed, rotate_secret(folder, role, std::nullopt));
  RETURN_IF_ERROR(give_to_owner(folder, identity_file(folder)));
  RETURN_IF_ERROR(renewed.written);
  if (!renewed.join_file.empty()) {
    RETURN_IF_ERROR(give_to_owner(folder, renewed.join_file));
  }
  return renewed.join_file;
}

/// Asks the running coordinator to renew the secret. If none is running, calls rotate_here().
/// Returns the path of the file with the new join string; empty: no join string was written.
/// INVALID_ARGUMENT: the folder is no data folder. Other errors: those of the files and of the
/// farm.
absl::StatusOr<std::string> rotate(const std::string& folder, link::Role role) {
  if (!file_exists(identity_file(folder))) {
    return absl::InvalidArgumentError(
        absl::StrCat(folder, " is no data folder of a coordinator; name it with --data DIR"));
  }
  umask(S_IRWXG | S_IRWXO);
  // The lock of the folder shows if a coordinator is running. If one is, the coordinator must
  // rotate the secret, because only it can end the connections that use the old secret.
  auto here = rotate_here(folder, role);
  if (!absl::IsFailedPrecondition(here.status())) {
    return here;
  }
  ASSIGN_OR_RETURN(const auto client, connect_to_farm({.farm = farm_join_file(folder)}));
  return client->rotate_secret(role);
}

}  // namespace

ExitCode run(const RotateOptions& options, Process& process) {
  std::string folder = options.data;
  if (folder.empty()) {
    const auto standard = default_data_folder();
    if (!standard.ok()) {
      return finished(standard.status(), process.console);
    }
    folder = *standard;
  }
  const auto file = rotate(folder, options.role);
  if (!file.ok()) {
    return finished(file.status(), process.console);
  }
  const char* const whose = options.role == link::Role::kWorker ? "workers'" : "users'";
  if (options.verbosity.json) {
    process.console.line(JsonObject().text("event", "rotated").text("join_file", *file).str());
  } else {
    process.console.line(absl::StrCat(
        "the ", whose, " old join string is void; ",
        file->empty() ? absl::StrCat("`bandsaw serve` writes the new one to ",
                                     join_file_of(folder, options.role), " at its next start")
                      : absl::StrCat("the new one is in ", *file)));
  }
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
