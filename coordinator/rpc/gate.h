#pragma once

// Who may call: the secret of each call, checked before anything else of it is looked at.

#include <grpcpp/grpcpp.h>

#include <functional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/rpc/failures.h"
#include "proto/link/identity.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// A secret that was made anew and written down.
struct RenewedSecret {
  link::Identity identity;
  std::string join_file;
  absl::Status written = {};  ///< of the files beside the identity: the secret is new all the same
};
/// May be nothing: then secrets cannot be renewed. Waits for the disk.
using RenewSecret = std::function<absl::StatusOr<RenewedSecret>(link::Role)>;

/// Thread-safe.
class Gate {
 public:
  Gate(link::Identity identity, RenewSecret renew);

  /// UNAUTHENTICATED: no or wrong secret. RESOURCE_EXHAUSTED: that, too often from one address.
  /// PERMISSION_DENIED: the other role's.
  absl::Status check(const grpc::CallbackServerContext& context, link::Role needed)
      EXCLUDES(mutex_);
  /// Whether check would let the call in now. A wrong secret is not counted.
  bool holds(const grpc::CallbackServerContext& context, link::Role needed) EXCLUDES(mutex_);
  /// As check, where both roles may call.
  absl::Status check_any(const grpc::CallbackServerContext& context) EXCLUDES(mutex_);

  /// From its return on the old secret is refused; the file of the new join string.
  /// FAILED_PRECONDITION: there is no way to renew. Not for gRPC's own threads.
  absl::StatusOr<std::string> rotate(link::Role role) EXCLUDES(rotating_);

 private:
  absl::StatusOr<link::Role> role_of(const grpc::CallbackServerContext& context) EXCLUDES(mutex_);
  absl::Status refused(const std::string& address, const absl::Status& why) REQUIRES(mutex_);

  const RenewSecret renew_;
  Mutex rotating_;
  Mutex mutex_;
  link::Identity identity_ GUARDED_BY(mutex_);
  Failures failures_ GUARDED_BY(mutex_);
};

/// gRPC's "ipv4:10.0.0.7:51234" or "ipv6:%5B::1%5D:51234" as people write it, without the port,
/// which says nothing.
std::string address_of(const std::string& peer);

}  // namespace bandsaw::coordinator
