#pragma once

// Runs the gRPC services on one port.

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct ServerOptions {
  std::string listen = "0.0.0.0:7878";  ///< port 0: any free port
  bool insecure = false;                ///< plaintext instead of TLS
  bool reflection = false;              ///< any client may list the services and calls
  RenewSecret renew = nullptr;          ///< implements RotateSecret; nullptr: the call is refused
  BrowserAccess* browsers = nullptr;    ///< implements BrowserLink; outlives the server
};

class Server {
 public:
  /// Starts the server. FAILED_PRECONDITION: the server cannot listen. If the port is taken, the
  /// message says how to find the process that uses the port. INVALID_ARGUMENT: `options.listen` is
  /// not HOST:PORT.
  static absl::StatusOr<std::unique_ptr<Server>> start(Engine& engine,
                                                       const link::Identity& identity,
                                                       const ServerOptions& options);
  /// Ends every stream with UNAVAILABLE, after which workers keep their bands and reconnect. Takes
  /// at most 5 s.
  ~Server();
  int port() const;

 private:
  class Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bandsaw::coordinator
