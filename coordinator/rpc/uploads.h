#pragma once

#include "coordinator/rpc/blob_intake.h"
#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Farm.PutBlob: receives a blob in chunks. The next chunk is read only after the file executor has
/// written the previous one.
class PutBlobCall final : public SelfOwned<grpc::ServerReadReactor<farm::BlobChunk>, PutBlobCall> {
 public:
  PutBlobCall(const Doors& doors, grpc::CallbackServerContext* context)
      : doors_(doors), context_(context) {}
  void begin() { StartRead(&chunk_); }
  void OnReadDone(bool ok) override;

 private:
  void take(bool ok);
  absl::Status add(const farm::BlobChunk& chunk);
  absl::Status end();

  const Doors doors_;
  grpc::CallbackServerContext* const context_;
  farm::BlobChunk chunk_;
  BlobIntake intake_;
  std::unique_ptr<Engine::BlobWriter> writer_;
};

}  // namespace bandsaw::coordinator
