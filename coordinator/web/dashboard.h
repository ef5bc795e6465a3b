#pragma once

// The dashboard: a page for people, and what it asks. On loopback in plain HTTP, elsewhere with
// TLS; everywhere with a login by people's secret.

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "coordinator/web/pictures.h"
#include "coordinator/web/scenes.h"
#include "coordinator/web/worker_program.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct DashboardOptions {
  std::string host = "127.0.0.1";  ///< a number or a name; IPv6 without brackets
  int port = 8787;                 ///< 0 picks one
  bool insecure = false;           ///< plain HTTP beyond loopback too
  std::string gallery;             ///< folder of scene files; need not be there
  ImportScene import_scene;
  WorkerPrograms workers;  ///< what is handed out to machines that are to join
  TellReport report;
};

class Dashboard {
 public:
  /// `engine` outlives it. FAILED_PRECONDITION: the port cannot be had.
  static absl::StatusOr<std::unique_ptr<Dashboard>> start(Engine& engine,
                                                          const link::Identity& identity,
                                                          const DashboardOptions& options);
  /// Cuts every connection.
  ~Dashboard();
  /// There is a new secret. If it is people's, logins with the old one are void, and every
  /// connection is cut: it may be under way with the old one.
  void renew(const link::Identity& identity);
  int port() const;
  bool secure() const;

 private:
  class Impl;
  explicit Dashboard(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Whether only this machine reaches it.
bool is_loopback(const std::string& host);

}  // namespace bandsaw::coordinator
