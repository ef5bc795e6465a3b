#include "coordinator/rpc/downloads.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/put_bands_call.h"
#include "coordinator/rpc/services.h"
#include "coordinator/rpc/session_call.h"

namespace bandsaw::coordinator {
grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>* WorkService::Session(
    grpc::CallbackServerContext* context) {
  if (const auto status = doors_.gate.check(*context, link::Role::kWorker); !status.ok()) {
    return new RefusedCall<grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>>(status);
  }
  return SessionCall::make(doors_, address_of(context->peer()));
}

grpc::ServerWriteReactor<farm::BlobChunk>* WorkService::GetBlob(
    grpc::CallbackServerContext* context, const farm::GetBlobRequest* request) {
  if (const auto status = doors_.gate.check(*context, link::Role::kWorker); !status.ok()) {
    return new RefusedCall<grpc::ServerWriteReactor<farm::BlobChunk>>(status);
  }
  return GetBlobCall::make(doors_, *request);
}

grpc::ServerBidiReactor<farm::BandChunk, farm::PutBandReply>* WorkService::PutBands(
    grpc::CallbackServerContext* context) {
  if (const auto status = doors_.gate.check(*context, link::Role::kWorker); !status.ok()) {
    return new RefusedCall<grpc::ServerBidiReactor<farm::BandChunk, farm::PutBandReply>>(status);
  }
  return PutBandsCall::make(doors_);
}

}  // namespace bandsaw::coordinator
