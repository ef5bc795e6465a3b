#include "coordinator/rpc/reflection.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>

#include <memory>
#include <string>
#include <vector>

namespace bandsaw::coordinator {
namespace {

using Plugin = grpc::reflection::ProtoServerReflectionPlugin;
using Plugins = std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>;

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

}  // namespace

void set_reflection(grpc::ServerBuilder& builder, bool wanted) {
  builder.SetOption(std::make_unique<ReflectionOption>(wanted));
}

}  // namespace bandsaw::coordinator
