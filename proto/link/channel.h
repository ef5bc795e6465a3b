#pragma once

// gRPC channels to the coordinator, configured for a LAN where gRPC's defaults do not fit:
// keepalive on both sides, no proxy, quick reconnects, and a certificate that is checked against
// the join string before it is trusted.

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "proto/link/join.h"
#include "proto/link/socket.h"

namespace bandsaw::link {

/// Metadata key of the secret.
inline constexpr char kSecretKey[] = "bandsaw-secret";

/// Lets gRPC look up host names with the system's resolver, which knows the names of mDNS, such as
/// studio.local, and of NIS. gRPC's own resolver knows /etc/hosts and DNS only. The function sets
/// the environment variable GRPC_DNS_RESOLVER, unless the user has set it. So it MUST be called
/// before the first channel is made, while the process has one thread.
void use_system_resolver();

/// A connection to the address that answered with the certificate of the join string.
struct Connected {
  std::string address;
  std::shared_ptr<grpc::Channel> control;  ///< For streams and small calls.
  std::shared_ptr<grpc::Channel> bulk;     ///< For blobs and pixels; a connection of its own.
};

/// Tries the addresses in order, each for at most `timeout` (a refused connection fails at once).
/// Calls `stopped` about every 100 ms while it waits, and fails with UNAVAILABLE soon after
/// `stopped` returns true. Verifies the server's identity only; a wrong secret or role is detected
/// by the first call. UNAVAILABLE: no address answered, or this machine's clock is outside the
/// certificate's validity (the message gives the reason for each address). UNAUTHENTICATED: a
/// server on another machine, or the server at every address, presented a certificate other than
/// that of the join string.
absl::StatusOr<Connected> connect(const JoinString& join, std::chrono::milliseconds timeout,
                                  const std::function<bool()>& stopped = {});

/// Fetches the certificate that a server presents, as PEM, without trusting it. UNAVAILABLE: no
/// answer in time, or no TLS there; the message says which.
absl::StatusOr<std::string> fetch_certificate_pem(const std::string& address,
                                                  std::chrono::milliseconds timeout);

/// Fetches the certificate through a connection that is already open. Afterwards the connection
/// cannot be used for anything else.
absl::StatusOr<std::string> fetch_certificate_pem(Socket& socket, const Deadline& deadline);

/// Sets the secret and the deadline on a call's context. A deadline of zero means none (for long
/// streams).
void prepare(grpc::ClientContext& context, const JoinString& join,
             std::chrono::milliseconds deadline);

/// Converts between gRPC's and Abseil's status, whose codes are equal.
grpc::Status to_grpc(const absl::Status& status);
absl::Status from_grpc(const grpc::Status& status);

/// Sets a server's channel arguments: keepalive, no SO_REUSEPORT, message limits.
void configure_server(grpc::ServerBuilder& builder);

}  // namespace bandsaw::link
