#pragma once

// Starts the dashboard (the web pages) of `bandsaw serve`, and writes the file with the link to it.

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

/// The dashboard that runs, or none.
struct ServedDashboard {
  std::unique_ptr<Dashboard> dashboard;  ///< nullptr: there is none
  std::string url;                       ///< its address for users, without a secret
  WorkerDigests workers;                 ///< the workers' programs that it hands out

  /// Writes the file with the link that logs a user in. If the umask is 077, as `serve` sets it,
  /// the file has mode 0600. Without a dashboard, removes the file.
  absl::Status write_link(const std::string& data_folder, const link::Identity& identity) const;

  /// Returns the dashboard's address as the users' join string has it (proto/link/join.h):
  /// HOST:PORT, or only PORT if the dashboard listens on all addresses of the machine. Returns an
  /// empty text if there is no dashboard.
  std::string place(const ServeOptions& options) const;

  /// Returns the line to paste on a machine without a worker (cli/machines/worker_line.h). `join`:
  /// the workers' join string. Returns an empty text if no program is handed out, or if other
  /// machines can reach the coordinator but not the dashboard.
  absl::StatusOr<std::string> worker_line(const ServeOptions& options,
                                          const link::Identity& identity,
                                          const std::string& join) const;
};

/// Starts the dashboard at the address of --web, and sets its address in `browsers`. Starts none if
/// --web is "none", or if --web is not given and no port can be used. `engine` and `browsers` MUST
/// outlive the dashboard. FAILED_PRECONDITION: the address that the user gave cannot be used.
absl::StatusOr<ServedDashboard> serve_dashboard(const ServeOptions& options, Engine& engine,
                                                const link::Identity& identity,
                                                BrowserAccess& browsers);

}  // namespace bandsaw::coordinator
