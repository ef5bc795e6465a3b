// connect() fetches the certificate at each address (fetch_certificate.cpp), compares its digest
// with the join string, and only then opens gRPC channels that accept this certificate alone.

#include "proto/link/channel.h"

#include <cstdlib>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "proto/link/certificate.h"
#include "proto/link/identity.h"
#include "proto/wire/limits.h"

namespace bandsaw::link {
namespace {

/// Time between two pings of a connection. A frozen machine or a pulled cable is detected after
/// kKeepaliveMs + kKeepaliveTimeoutMs.
constexpr int kKeepaliveMs = 2000;
/// If a client does not complete the handshake within kHandshakeMs, the server closes the
/// connection, so that its file descriptor becomes free.
constexpr int kHandshakeMs = 10'000;
/// Time within which a ping must be answered.
constexpr int kKeepaliveTimeoutMs = 4000;

/// Returns the settings of a channel. If `own_connection` is false, the channel may share its
/// connection with other such channels.
grpc::ChannelArguments channel_arguments(bool own_connection) {
  grpc::ChannelArguments args;
  args.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  args.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  args.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);  // unlimited
  args.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  args.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  // This is also the minimum time that gRPC gives one connection attempt; a handshake with a busy
  // machine takes longer than the first backoff.
  args.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 2000);
  args.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 5000);
  args.SetMaxReceiveMessageSize(static_cast<int>(wire::kMessageBytes));
  // Channels with equal arguments would share one connection, and a large scene would delay
  // heartbeats.
  args.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, own_connection ? 1 : 0);
  return args;
}

Connected open_channels(const std::string& address,
                        const std::shared_ptr<grpc::ChannelCredentials>& credentials, bool tls) {
  Connected connected{.address = address, .control = nullptr, .bulk = nullptr};
  for (const bool bulk : {false, true}) {
    grpc::ChannelArguments args = channel_arguments(/*own_connection=*/bulk);
    if (tls) {
      args.SetSslTargetNameOverride(kServerName);
    }
    (bulk ? connected.bulk : connected.control) =
        grpc::CreateCustomChannel(address, credentials, args);
  }
  return connected;
}

/// Opens channels to `address` with TLS. `socket` is a connection to the same address; the server's
/// certificate is fetched through it. UNAUTHENTICATED: the certificate does not have the digest
/// `expected`.
absl::StatusOr<Connected> connect_tls(const std::string& address, const wire::Digest& expected,
                                      Socket& socket, const Deadline& deadline) {
  absl::StatusOr<std::string> pem = fetch_certificate_pem(socket, deadline);
  if (!pem.ok()) {
    return pem.status();
  }
  absl::StatusOr<wire::Digest> digest = certificate_digest(*pem);
  if (!digest.ok()) {
    return absl::UnavailableError(digest.status().message());
  }
  if (*digest != expected) {
    return absl::UnauthenticatedError(
        "it has another certificate than the join string names: another farm, or one whose data "
        "folder was created again");
  }
  // gRPC checks the dates too, but tells only that the verification failed.
  if (absl::Status status = check_clock(*pem); !status.ok()) {
    return status;
  }
  grpc::SslCredentialsOptions options;
  options.pem_root_certs = *std::move(pem);
  return open_channels(address, grpc::SslCredentials(options), /*tls=*/true);
}

/// Opens channels to `address` without TLS, and waits until the control channel is
/// connected. UNAVAILABLE: the deadline has passed, or `deadline.stopped` returned true.
absl::StatusOr<Connected> connect_plain(const std::string& address, const Deadline& deadline) {
  Connected connected = open_channels(address, grpc::InsecureChannelCredentials(), /*tls=*/false);
  while (!connected.control->WaitForConnected(std::chrono::system_clock::now() +
                                              Deadline::kInterval)) {
    if (std::chrono::steady_clock::now() >= deadline.end || deadline.is_stopped()) {
      return absl::UnavailableError(
          "the server there does not speak plaintext gRPC: was the coordinator started with "
          "--insecure?");
    }
  }
  return connected;
}

}  // namespace

void use_system_resolver() { setenv("GRPC_DNS_RESOLVER", "native", 0); }

absl::StatusOr<Connected> connect(const JoinString& join, std::chrono::milliseconds timeout,
                                  const std::function<bool()>& stopped) {
  std::vector<std::string> reasons;
  std::size_t wrong = 0;  // number of addresses that presented another certificate
  // True if one of the addresses that `wrong` counts is on another machine. If only servers on this
  // machine present another certificate, the wanted farm may still exist. The reason is that this
  // machine may run another farm, and that the join string names addresses that every machine has
  // (loopback, bridges for containers).
  bool wrong_elsewhere = false;
  for (const std::string& address : join.addresses) {
    const Deadline deadline{std::chrono::steady_clock::now() + timeout, stopped};
    if (deadline.is_stopped()) {
      reasons.push_back("interrupted");
      break;
    }
    absl::StatusOr<Socket> socket = Socket::connect(address, deadline);
    if (!socket.ok()) {
      reasons.push_back(absl::StrCat(address, ": ", socket.status().message()));
      continue;
    }
    absl::StatusOr<Connected> connected =
        join.certificate ? connect_tls(address, *join.certificate, *socket, deadline)
                         : connect_plain(address, deadline);
    if (connected.ok()) {
      return connected;
    }
    if (absl::IsUnauthenticated(connected.status())) {
      ++wrong;
      wrong_elsewhere |= !socket->is_to_this_machine();
    }
    reasons.push_back(absl::StrCat(address, ": ", connected.status().message()));
  }
  const std::string all = absl::StrJoin(reasons, "; ");
  return wrong_elsewhere || wrong == join.addresses.size()
             ? absl::UnauthenticatedError(absl::StrCat("not this farm at ", all))
             : absl::UnavailableError(absl::StrCat("no coordinator answers at ", all));
}

void prepare(grpc::ClientContext& context, const JoinString& join,
             std::chrono::milliseconds deadline) {
  context.AddMetadata(kSecretKey, join.secret);
  if (deadline.count() > 0) {
    context.set_deadline(std::chrono::system_clock::now() + deadline);
  }
}

grpc::Status to_grpc(const absl::Status& status) {
  return {static_cast<grpc::StatusCode>(status.code()), std::string(status.message())};
}

absl::Status from_grpc(const grpc::Status& status) {
  return {static_cast<absl::StatusCode>(status.error_code()), status.error_message()};
}

void configure_server(grpc::ServerBuilder& builder) {
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, kHandshakeMs);
  // Accepts the pings of clients, which come every kKeepaliveMs.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 1000);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PING_STRIKES, 0);
  builder.SetMaxReceiveMessageSize(static_cast<int>(wire::kMessageBytes));
}

}  // namespace bandsaw::link
