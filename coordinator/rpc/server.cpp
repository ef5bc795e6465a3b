// Builds the gRPC server with both services, the health check and, if wanted, reflection. The
// destructor ends all streams before it stops the server.

#include "coordinator/rpc/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/port_check.h"
#include "coordinator/rpc/services.h"
#include "proto/farm.grpc.pb.h"
#include "proto/health.grpc.pb.h"
#include "proto/link/channel.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using Plugin = grpc::reflection::ProtoServerReflectionPlugin;
using Plugins = std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>;

/// Adds the reflection plugin to a server if it is wanted, otherwise removes it.
class ReflectionOption final : public grpc::ServerBuilderOption {
 public:
  explicit ReflectionOption(bool wanted) : wanted_(wanted) {}
  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(Plugins* plugins) override {
    auto ours = std::make_unique<Plugin>();
    const std::string name = ours->name();
    std::erase_if(*plugins, [&](const auto& plugin) { return plugin->name() == name; });
    if (wanted_) {
      plugins->push_back(std::move(ours));
    }
  }

 private:
  const bool wanted_;
};

/// Enables or disables gRPC server reflection. If it is enabled, any client may list the services,
/// calls and messages. A program that is linked with libgrpc++_reflection has reflection enabled.
/// So the plugin of this library is removed unless reflection is wanted.
void set_reflection(grpc::ServerBuilder& builder, bool wanted) {
  builder.SetOption(std::make_unique<ReflectionOption>(wanted));
}

}  // namespace

// Health check for probes: proto/health.proto.

/// Answers callers without a secret, because the reply reveals only that the port is served, which
/// everybody can see from the open port. The service is registered after the engine has replayed
/// its journal, so an answer implies that the replay is complete.
class HealthService final : public grpc::health::v1::Health::CallbackService {
 public:
  grpc::ServerUnaryReactor* Check(grpc::CallbackServerContext* context,
                                  const grpc::health::v1::HealthCheckRequest* request,
                                  grpc::health::v1::HealthCheckResponse* reply) override;
};

grpc::ServerUnaryReactor* HealthService::Check(grpc::CallbackServerContext* context,
                                               const grpc::health::v1::HealthCheckRequest* request,
                                               grpc::health::v1::HealthCheckResponse* reply) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  const std::string& service = request->service();
  if (!service.empty() && service != farm::Farm::service_full_name() &&
      service != farm::Work::service_full_name()) {
    reactor->Finish(link::to_grpc(absl::NotFoundError("there is no such service here")));
    return reactor;
  }
  reply->set_status(grpc::health::v1::HealthCheckResponse::SERVING);
  reactor->Finish(grpc::Status::OK);
  return reactor;
}

namespace {

constexpr int kFileThreads = 4;  // these threads mostly wait for the disk
// Each waits for the film (the sums of all pixels), or holds an image of up to 768 MB.
constexpr int kImageThreads = 2;
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
  Impl(Engine& engine, const link::Identity& identity, RenewSecret renew, BrowserAccess* browsers)
      : identity_(identity),
        gate_(identity, std::move(renew)),
        files_(kFileThreads),
        images_(kImageThreads),
        farm_({engine, gate_, files_, images_, streams_, browsers}),
        work_({engine, gate_, files_, images_, streams_, browsers}) {}

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
  const link::Identity identity_;  ///< key, certificate and first secrets; `gate_` renews secrets
  Gate gate_;
  // files_ and images_ are destroyed after server_, because calls that end post tasks to them.
  FileExecutor files_;
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
  auto impl = std::make_unique<Impl>(engine, identity, options.renew, options.browsers);
  RETURN_IF_ERROR(impl->start(options));
  return std::unique_ptr<Server>(new Server(std::move(impl)));
}

}  // namespace bandsaw::coordinator
