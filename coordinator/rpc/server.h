#pragma once

// The doors for machines: both gRPC services on one port.

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/gate.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct ServerOptions {
  std::string listen = "0.0.0.0:7878";  ///< port 0 picks one
  bool insecure = false;                ///< plaintext
  bool reflection = false;              ///< tells which calls there are, to anybody who asks
  RenewSecret renew = nullptr;          ///< what RotateSecret does; nothing: it is refused
};

class Server {
 public:
  /// FAILED_PRECONDITION: the port is taken (says by whom to look for).
  static absl::StatusOr<std::unique_ptr<Server>> start(Engine& engine,
                                                       const link::Identity& identity,
                                                       const ServerOptions& options);
  /// Tells workers nothing is wrong with them, ends every stream within 5 s.
  ~Server();
  int port() const;

 private:
  class Impl;
  explicit Server(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bandsaw::coordinator
