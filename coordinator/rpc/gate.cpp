#include "coordinator/rpc/gate.h"

#include "proto/link/channel.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::Status check_caller(const grpc::CallbackServerContext& context,
                          const link::Identity& identity, link::Role needed) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(link::kSecretKey);
  if (found == metadata.end()) {
    return absl::UnauthenticatedError("the call carries no secret: it needs a join string");
  }
  ASSIGN_OR_RETURN(
      const link::Role role,
      link::role_of_secret(identity, std::string(found->second.data(), found->second.size())));
  if (role != needed) {
    return absl::PermissionDeniedError(
        role == link::Role::kWorker
            ? "this join string is for workers: submitting, watching and cancelling need the "
              "farm's own (file `farm` in the coordinator's data folder)"
            : "this join string is for people: a worker needs the workers' one (file `join` in the "
              "coordinator's data folder)");
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
