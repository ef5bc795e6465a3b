// Compares the secret in a call's metadata with the secrets in the farm's identity, and counts
// wrong secrets per address.

#include "coordinator/rpc/gate.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "coordinator/engine/clock.h"
#include "proto/link/channel.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

std::string address_of(const std::string& peer) {
  absl::string_view address = peer;
  absl::ConsumePrefix(&address, "ipv4:");
  absl::ConsumePrefix(&address, "ipv6:");
  address = address.substr(0, address.rfind(':'));
  return absl::StrReplaceAll(address, {{"%5B", ""}, {"%5D", ""}, {"[", ""}, {"]", ""}});
}

Gate::Gate(link::Identity identity, RenewSecret renew)
    : renew_(std::move(renew)),
      identity_(std::move(identity)),
      failures_(wire::kWrongSecretsPerMinute) {}

absl::StatusOr<link::Role> Gate::role_of(const grpc::CallbackServerContext& context) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(link::kSecretKey);
  MutexLock lock(mutex_);
  if (found == metadata.end()) {
    return refused(
        address_of(context.peer()),
        absl::UnauthenticatedError("the call carries no secret: it needs a join string"));
  }
  auto role =
      link::role_of_secret(identity_, std::string(found->second.data(), found->second.size()));
  return role.ok() ? role : refused(address_of(context.peer()), role.status());
}

absl::Status Gate::refused(const std::string& address, const absl::Status& why) {
  switch (failures_.add(address, steady_seconds())) {
    case Failures::Verdict::kFirst:
      spdlog::warn("address={} refused: {}", address, std::string(why.message()));
      return why;
    case Failures::Verdict::kMore:
      return why;
    case Failures::Verdict::kTooMany:
      break;
  }
  return absl::ResourceExhaustedError(
      absl::StrCat("too many calls with a wrong secret from ", address, "; wait a minute"));
}

absl::Status Gate::check(const grpc::CallbackServerContext& context, link::Role needed) {
  ASSIGN_OR_RETURN(const link::Role role, role_of(context));
  if (role != needed) {
    return absl::PermissionDeniedError(
        role == link::Role::kWorker
            ? "this join string is for workers: submitting, watching and cancelling need the "
              "users' join string (file `farm` in the coordinator's data folder)"
            : "this join string is for users: a worker needs the workers' join string (file `join` "
              "in the coordinator's data folder)");
  }
  return absl::OkStatus();
}

bool Gate::holds(const grpc::CallbackServerContext& context, link::Role needed) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(link::kSecretKey);
  if (found == metadata.end()) {
    return false;
  }
  const std::string secret(found->second.data(), found->second.size());
  MutexLock lock(mutex_);
  const absl::StatusOr<link::Role> role = link::role_of_secret(identity_, secret);
  return role.ok() && *role == needed;
}

absl::Status Gate::check_any(const grpc::CallbackServerContext& context) {
  return role_of(context).status();
}

absl::StatusOr<RenewedSecret> Gate::rotate(link::Role role) {
  if (!renew_) {
    return absl::FailedPreconditionError("this coordinator cannot renew its secrets");
  }
  MutexLock one_at_a_time(rotating_);
  ASSIGN_OR_RETURN(RenewedSecret renewed, renew_(role));
  MutexLock lock(mutex_);
  identity_ = renewed.identity;
  const char* const whose = role == link::Role::kWorker ? "workers'" : "users'";
  if (renewed.written.ok()) {
    spdlog::info("a new {} secret; the join string is in {}", whose, renewed.join_file);
    return renewed;
  }
  renewed.written = absl::Status(
      renewed.written.code(),
      absl::StrCat("the ", whose, " secret is new, but not in all files (",
                   renewed.written.message(), "): start the coordinator again, which writes them"));
  spdlog::error("{}", std::string(renewed.written.message()));
  return renewed;
}

}  // namespace bandsaw::coordinator
