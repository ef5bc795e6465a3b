#include "absl/strings/match.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/strip.h"
#include "coordinator/rpc/downloads.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/services.h"
#include "coordinator/rpc/session_call.h"
#include "coordinator/rpc/uploads.h"

namespace bandsaw::coordinator {
namespace {

/// gRPC's "ipv4:10.0.0.7:51234" or "ipv6:%5B::1%5D:51234" as people write it, without the port,
/// which says nothing.
std::string address_of(const std::string& peer) {
  absl::string_view address = peer;
  absl::ConsumePrefix(&address, "ipv4:");
  absl::ConsumePrefix(&address, "ipv6:");
  address = address.substr(0, address.rfind(':'));
  return absl::StrReplaceAll(address, {{"%5B", ""}, {"%5D", ""}, {"[", ""}, {"]", ""}});
}

}  // namespace

grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>* WorkService::Session(
    grpc::CallbackServerContext* context) {
  if (const auto status = check_caller(*context, doors_.identity, link::Role::kWorker);
      !status.ok()) {
    return new RefusedCall<grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>>(status);
  }
  return SessionCall::make(doors_, address_of(context->peer()));
}

grpc::ServerWriteReactor<farm::BlobChunk>* WorkService::GetBlob(
    grpc::CallbackServerContext* context, const farm::GetBlobRequest* request) {
  if (const auto status = check_caller(*context, doors_.identity, link::Role::kWorker);
      !status.ok()) {
    return new RefusedCall<grpc::ServerWriteReactor<farm::BlobChunk>>(status);
  }
  return GetBlobCall::make(doors_, *request);
}

grpc::ServerReadReactor<farm::BandChunk>* WorkService::PutBand(grpc::CallbackServerContext* context,
                                                               farm::PutBandReply* reply) {
  if (const auto status = check_caller(*context, doors_.identity, link::Role::kWorker);
      !status.ok()) {
    return new RefusedCall<grpc::ServerReadReactor<farm::BandChunk>>(status);
  }
  return PutBandCall::make(doors_, context, reply);
}

}  // namespace bandsaw::coordinator
