#pragma once

// What comes in chunks: blobs from people, pixels from workers.

#include "coordinator/rpc/blob_intake.h"
#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Farm.PutBlob.
class PutBlobCall final : public ChunkReader<farm::BlobChunk, PutBlobCall> {
 public:
  static constexpr bool kWritesFiles = true;
  using ChunkReader::ChunkReader;
  absl::Status add(const farm::BlobChunk& chunk);
  void end();
  void cut() { writer_.reset(); }

 private:
  BlobIntake intake_;
  std::unique_ptr<Engine::BlobWriter> writer_;
};

/// Work.PutBand. A chunk is copied and hashed, which is less than handing it to another thread
/// takes where bands are small; the engine writes it.
class PutBandCall final : public ChunkReader<farm::BandChunk, PutBandCall> {
 public:
  static constexpr bool kWritesFiles = false;
  PutBandCall(const Doors& doors, grpc::CallbackServerContext* context, farm::PutBandReply* reply)
      : ChunkReader(doors, context), reply_(reply) {}
  absl::Status add(const farm::BandChunk& chunk);
  void end();

 private:
  absl::Status take_header(const farm::BandHeader& header);
  absl::Status check_pixels();

  farm::PutBandReply* const reply_;
  farm::BandHeader header_;
  bool has_header_ = false;
  BandPixels pixels_;
  std::uint64_t received_ = 0;
  wire::Hasher hasher_;
};

}  // namespace bandsaw::coordinator
