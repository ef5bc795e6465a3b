#pragma once

// The dashboard of `bandsaw serve`: a web page, and the server that answers the requests of the
// page from the engine (the scheduler and the store). The server uses plain HTTP on loopback and
// TLS elsewhere. Users log in by the users' secret. A browser that renders for the farm logs in by
// another secret: that of the link through which it joined.

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/web/browser_program.h"
#include "coordinator/web/browser_sockets.h"
#include "coordinator/web/pictures.h"
#include "coordinator/web/scenes.h"
#include "coordinator/web/worker_program.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct DashboardOptions {
  std::string host = "127.0.0.1";  ///< address or name; IPv6 without brackets
  int port = 8787;                 ///< 0: a free one
  bool insecure = false;           ///< uses plain HTTP on other addresses than loopback too
  std::string gallery;             ///< folder of scene files; may be missing
  ImportScene import_scene;
  WorkerPrograms workers;             ///< programs for machines that are to join
  MakeReport report;                  ///< formats the report of a finished job
  BrowserAccess* browsers = nullptr;  ///< outlives the dashboard; nullptr: no browser can join
  BrowserProgram browser_program = {};
  BrowserSocketLimits browser_limits = {};
};

class Dashboard {
 public:
  /// `engine` outlives the dashboard. FAILED_PRECONDITION: the port cannot be used.
  static absl::StatusOr<std::unique_ptr<Dashboard>> start(Engine& engine,
                                                          const link::Identity& identity,
                                                          const DashboardOptions& options);
  /// Closes every connection.
  ~Dashboard();
  /// Sets the new secrets. If the users' secret has changed, logins with the old secret become
  /// invalid, and every connection is closed, because any of them may use the old secret.
  void renew(const link::Identity& identity);
  int port() const;
  /// Returns true if the dashboard uses TLS.
  bool secure() const;

 private:
  class Impl;
  explicit Dashboard(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Returns true if only this machine can connect to the host.
bool is_loopback(const std::string& host);

}  // namespace bandsaw::coordinator
