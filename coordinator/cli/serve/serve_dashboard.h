#pragma once

// The dashboard as `bandsaw serve` starts it, and the file with the link to it.

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/machines/worker_line.h"
#include "coordinator/cli/options/options.h"
#include "coordinator/engine/engine.h"
#include "coordinator/web/dashboard.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct ServedDashboard {
  std::unique_ptr<Dashboard> dashboard;  ///< null: there is none
  std::string url;                       ///< as people reach it, without a secret
  WorkerDigests workers;                 ///< the workers' programs that it hands out

  /// The link that logs in, in its file (0600 where the umask says so); without a dashboard there
  /// is no such file afterwards.
  absl::Status write_link(const std::string& data_folder, const link::Identity& identity) const;

  /// What to paste on a machine that has no worker yet; empty: none is handed out, or machines that
  /// reach the coordinator do not reach the dashboard.
  absl::StatusOr<std::string> worker_line(const ServeOptions& options,
                                          const link::Identity& identity,
                                          const std::string& join) const;
};

/// As the options say; null for "none", and where none was asked for and none can be had. `engine`
/// outlives it. FAILED_PRECONDITION: the address that was asked for cannot be had.
absl::StatusOr<ServedDashboard> serve_dashboard(const ServeOptions& options, Engine& engine,
                                                const link::Identity& identity);

}  // namespace bandsaw::coordinator
