#pragma once

// The dashboard of `bandsaw serve`, and the file with the link to it.

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/machines/worker_line.h"
#include "coordinator/cli/options/options.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/web/dashboard.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct ServedDashboard {
  std::unique_ptr<Dashboard> dashboard;  ///< nullptr: there is none
  std::string url;                       ///< its address for users, without a secret
  WorkerDigests workers;                 ///< the workers' programs that it hands out

  /// Writes the file with the link that logs in (mode 0600 if the umask says so). Without a
  /// dashboard, removes the file.
  absl::Status write_link(const std::string& data_folder, const link::Identity& identity) const;

  /// Returns the dashboard's address in the form of the users' join string (proto/link/join.h);
  /// empty: there is no dashboard.
  std::string place(const ServeOptions& options) const;

  /// Returns the line to paste on a machine without a worker; empty: no program is handed out, or
  /// machines that reach the coordinator do not reach the dashboard.
  absl::StatusOr<std::string> worker_line(const ServeOptions& options,
                                          const link::Identity& identity,
                                          const std::string& join) const;
};

/// Starts the dashboard. Its pointer is nullptr for "none", and if no address was given and none
/// can be used. `engine` and `browsers`, whose address is set, MUST outlive it.
/// FAILED_PRECONDITION: the given address cannot be used.
absl::StatusOr<ServedDashboard> serve_dashboard(const ServeOptions& options, Engine& engine,
                                                const link::Identity& identity,
                                                BrowserAccess& browsers);

}  // namespace bandsaw::coordinator
