// Starts the object that serves each call of a worker, after the worker's secret is checked.

#include "coordinator/rpc/downloads.h"
#include "coordinator/rpc/gate.h"
#include "coordinator/rpc/put_bands_call.h"
#include "coordinator/rpc/services.h"
#include "coordinator/rpc/session_call.h"

namespace bandsaw::coordinator {

grpc::ServerBidiReactor<farm::FromWorker, farm::ToWorker>* WorkService::Session(
    grpc::CallbackServerContext* context) {
  return admitted<SessionCall>(deps_, *context, link::Role::kWorker, address_of(context->peer()));
}

grpc::ServerWriteReactor<farm::BlobChunk>* WorkService::GetBlob(
    grpc::CallbackServerContext* context, const farm::GetBlobRequest* request) {
  return admitted<GetBlobCall>(deps_, *context, link::Role::kWorker, *request);
}

grpc::ServerBidiReactor<farm::BandChunk, farm::PutBandReply>* WorkService::PutBands(
    grpc::CallbackServerContext* context) {
  return admitted<PutBandsCall>(deps_, *context, link::Role::kWorker);
}

}  // namespace bandsaw::coordinator
