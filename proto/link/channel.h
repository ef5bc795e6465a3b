#pragma once

// Channels to the coordinator, with everything that gRPC's defaults get wrong for a LAN: keepalive
// both ways, no proxy, quick reconnects, the certificate checked against the join string before any
// trust.

#include <chrono>
#include <memory>
#include <string>

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "proto/link/join.h"

namespace bandsaw::link {

/// Metadata key of the secret.
inline constexpr char kSecretKey[] = "bandsaw-secret";

/// What a join string turned into after one address answered with the right certificate.
struct Connected {
  std::string address;
  std::shared_ptr<grpc::Channel> control;  ///< streams and small calls
  std::shared_ptr<grpc::Channel> bulk;     ///< blobs and pixels: a connection of its own
};

/// Tries the addresses in order, each for at most `timeout` (a refused connection fails at once).
/// Only the address is proven here; a wrong secret or role shows at the first call. UNAVAILABLE:
/// none answered (names each with its reason). UNAUTHENTICATED: one answered with another
/// certificate.
absl::StatusOr<Connected> connect(const JoinString& join, std::chrono::milliseconds timeout);

/// The certificate a server shows, without trusting it. UNAVAILABLE with the reason.
absl::StatusOr<std::string> fetch_certificate_pem(const std::string& address,
                                                  std::chrono::milliseconds timeout);

/// Sets secret and deadline on a call's context; a deadline of zero: none (long streams).
void prepare(grpc::ClientContext& context, const JoinString& join,
             std::chrono::milliseconds deadline);

/// gRPC's statuses and ours carry the same codes.
grpc::Status to_grpc(const absl::Status& status);
absl::Status from_grpc(const grpc::Status& status);

/// Arguments for servers: keepalive, no SO_REUSEPORT, message limits.
void configure_server(grpc::ServerBuilder& builder);

}  // namespace bandsaw::link
