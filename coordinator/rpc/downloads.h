#pragma once

// Streams from the server in chunks: blobs to workers, images to users.

#include <functional>
#include <utility>

#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Work.GetBlob. Each chunk is copied out of the mapped file by the file executor, because touching
/// a mapped page may wait for the disk.
class GetBlobCall final : public SelfOwned<grpc::ServerWriteReactor<farm::BlobChunk>, GetBlobCall> {
 public:
  GetBlobCall(const Doors& doors, const farm::GetBlobRequest& request)
      : doors_(doors), request_(request) {}
  void begin();
  void OnWriteDone(bool ok) override;

 private:
  absl::Status open();
  void write_next(bool first);

  const Doors doors_;
  const farm::GetBlobRequest request_;
  std::unique_ptr<BlobBytes> blob_;
  std::uint64_t offset_ = 0;
  farm::BlobChunk chunk_;
};

/// Farm.GetResult and Farm.Preview: sends an image that the file executor makes.
class ImageCall final : public SelfOwned<grpc::ServerWriteReactor<farm::ResultChunk>, ImageCall> {
 public:
  /// May block, also on the engine.
  using Make = std::function<absl::StatusOr<StoredResult>()>;
  ImageCall(const Doors& doors, Make make) : doors_(doors), make_(std::move(make)) {}
  void begin();
  void OnWriteDone(bool ok) override;

 private:
  void write_next();

  const Doors doors_;
  const Make make_;
  StoredResult result_;
  std::uint64_t offset_ = 0;
  farm::ResultChunk chunk_;
};

}  // namespace bandsaw::coordinator
