// Writes the join strings (lines by which workers and users connect to the farm) to the files of
// the data folder, and renews the secret of one role (workers or users).

#include "coordinator/cli/serve/join_files.h"

#include <span>

#include "coordinator/cli/base/data_folder.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Writes the join string to the file, unless the file has it already. So `serve` can start on a
/// full disk if nothing has changed.
absl::Status write(const std::string& file, const link::JoinString& join) {
  const std::string line = join.text() + "\n";
  const absl::StatusOr<std::string> there = read_whole_file(file, 2 * line.size());
  if (there.ok() && *there == line) {
    return absl::OkStatus();
  }
  return write_file_atomically(file, std::as_bytes(std::span(line)));
}

const std::string& secret_of(const link::Identity& identity, link::Role role) {
  return role == link::Role::kWorker ? identity.worker_secret : identity.farm_secret;
}

}  // namespace

std::string join_file_of(const std::string& data_folder, link::Role role) {
  return role == link::Role::kWorker ? worker_join_file(data_folder) : farm_join_file(data_folder);
}

link::JoinString join_string(link::Role role, const link::Identity& identity,
                             const std::vector<std::string>& addresses, bool insecure) {
  link::JoinString join;
  join.role = role;
  join.addresses = addresses;
  if (!insecure) {
    join.certificate = identity.certificate_digest;
  }
  join.secret = secret_of(identity, role);
  return join;
}

absl::Status write_join_file(const std::string& data_folder, const link::JoinString& join) {
  return write(join_file_of(data_folder, join.role), join);
}

absl::StatusOr<RenewedSecret> rotate_secret(const std::string& data_folder, link::Role role,
                                            std::optional<link::JoinString> present) {
  const std::string file = join_file_of(data_folder, role);
  if (!present) {
    if (absl::StatusOr<link::JoinString> in_file = link::join_string_from(file); in_file.ok()) {
      present = *std::move(in_file);
    }
  }
  ASSIGN_OR_RETURN(link::Identity identity, link::renew_secret(data_folder, role));
  if (!present) {  // the addresses of the farm are unknown, so no join string is written
    return RenewedSecret{std::move(identity), ""};
  }
  present->secret = secret_of(identity, role);
  const absl::Status written = write(file, *present);
  return RenewedSecret{std::move(identity), file, written};
}

}  // namespace bandsaw::coordinator
