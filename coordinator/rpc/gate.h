#pragma once

// Authentication: checks the secret of each call before anything else in the call is read. Each
// secret gives a role: worker, or farm (a user).

#include <grpcpp/grpcpp.h>

#include <functional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/rpc/failures.h"
#include "proto/link/identity.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// The result of a renewal of a secret. `identity` is already written to disk.
struct RenewedSecret {
  link::Identity identity;
  std::string join_file;  ///< path of the file with the new join string; empty: none was written
  /// Status of writing the files that depend on the secret, such as the one with the join string.
  /// The secret is renewed even if this is an error.
  absl::Status written = {};
};
/// Renews the secret of a role. nullptr: secrets cannot be renewed. May block on the disk.
using RenewSecret = std::function<absl::StatusOr<RenewedSecret>(link::Role)>;

/// Thread-safe.
class Gate {
 public:
  Gate(link::Identity identity, RenewSecret renew);

  /// Checks that the call carries the secret of role `needed`. UNAUTHENTICATED: the call has no
  /// secret, or a wrong one. RESOURCE_EXHAUSTED: the call has no secret or a wrong one, and there
  /// were too many such calls from its address. PERMISSION_DENIED: the secret is that of the other
  /// role.
  absl::Status check(const grpc::CallbackServerContext& context, link::Role needed)
      EXCLUDES(mutex_);
  /// Returns true if check() would admit the call now. A wrong secret is not counted.
  bool holds(const grpc::CallbackServerContext& context, link::Role needed) EXCLUDES(mutex_);
  /// Like check(), for calls that both roles may make.
  absl::Status check_any(const grpc::CallbackServerContext& context) EXCLUDES(mutex_);

  /// Renews a role's secret. If rotate() returns a RenewedSecret, the old secret is refused, even
  /// if RenewedSecret::written is an error. The caller MUST then end the streams that the old
  /// secret opened. FAILED_PRECONDITION: this server cannot renew secrets. MUST NOT be called on
  /// gRPC's threads, because it waits for the disk.
  absl::StatusOr<RenewedSecret> rotate(link::Role role) EXCLUDES(rotating_);

 private:
  /// Returns the role of the call's secret. Errors as check(), except PERMISSION_DENIED.
  absl::StatusOr<link::Role> role_of(const grpc::CallbackServerContext& context) EXCLUDES(mutex_);
  /// Counts a call without a valid secret. Returns `why`, or RESOURCE_EXHAUSTED if the address has
  /// made too many such calls.
  absl::Status refused(const std::string& address, const absl::Status& why) REQUIRES(mutex_);

  const RenewSecret renew_;
  Mutex rotating_;  ///< locked during rotate(), so that only one secret is renewed at a time
  Mutex mutex_;
  link::Identity identity_ GUARDED_BY(mutex_);
  Failures failures_ GUARDED_BY(mutex_);
};

/// Converts gRPC's "ipv4:10.0.0.7:51234" or "ipv6:%5B::1%5D:51234" to a readable address without
/// the port, which is ephemeral.
std::string address_of(const std::string& peer);

}  // namespace bandsaw::coordinator
