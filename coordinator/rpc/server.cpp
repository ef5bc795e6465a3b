#include "coordinator/rpc/server.h"

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/health_service.h"
#include "coordinator/rpc/port_check.h"
#include "coordinator/rpc/reflection.h"
#include "coordinator/rpc/services.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr int kFileThreads = 4;   // they wait for the disk more than they work
constexpr int kImageThreads = 2;  // they wait for the film, or hold an image of up to 768 MB each
constexpr auto kShutdownTime = std::chrono::seconds(4);

std::shared_ptr<grpc::ServerCredentials> credentials(const link::Identity& identity,
                                                     bool insecure) {
  if (insecure) {
    return grpc::InsecureServerCredentials();
  }
  grpc::SslServerCredentialsOptions
      options;  // clients are authenticated by secrets, not by certificates
  options.pem_key_cert_pairs.push_back(
      {.private_key = identity.key_pem, .cert_chain = identity.certificate_pem});
  return grpc::SslServerCredentials(options);
}

}  // namespace

class Server::Impl {
 public:
  Impl(Engine& engine, const link::Identity& identity, RenewSecret renew)
      : identity_(identity),
        gate_(identity, std::move(renew)),
        files_(kFileThreads),
        images_(kImageThreads),
        farm_({engine, gate_, files_, images_, streams_}),
        work_({engine, gate_, files_, images_, streams_}) {}

  absl::Status start(const ServerOptions& options) {
    RETURN_IF_ERROR(check_can_listen(options.listen));
    grpc::ServerBuilder builder;
    link::configure_server(builder);
    builder.AddListeningPort(options.listen, credentials(identity_, options.insecure), &port_);
    builder.RegisterService(&farm_);
    builder.RegisterService(&work_);
    builder.RegisterService(&health_);
    set_reflection(builder, options.reflection);
    server_ = builder.BuildAndStart();
    if (server_ == nullptr || port_ == 0) {
      return absl::FailedPreconditionError(
          absl::StrCat("cannot listen on ", options.listen, ": its port was taken just now"));
    }
    return absl::OkStatus();
  }

  ~Impl() {
    if (server_ != nullptr) {
      streams_.stop_all(absl::UnavailableError("the coordinator is being stopped"));
      server_->Shutdown(std::chrono::system_clock::now() + kShutdownTime);
      server_->Wait();
    }
  }

  int port() const { return port_; }

 private:
  const link::Identity identity_;  ///< as at start; the certificate does not change
  Gate gate_;
  FileExecutor files_;  // before the server, as the next: calls that end post to them
  FileExecutor images_;
  LongStreams streams_;
  FarmService farm_;
  WorkService work_;
  HealthService health_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
};

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;
int Server::port() const { return impl_->port(); }

absl::StatusOr<std::unique_ptr<Server>> Server::start(Engine& engine,
                                                      const link::Identity& identity,
                                                      const ServerOptions& options) {
  auto impl = std::make_unique<Impl>(engine, identity, options.renew);
  RETURN_IF_ERROR(impl->start(options));
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

}  // namespace bandsaw::coordinator
