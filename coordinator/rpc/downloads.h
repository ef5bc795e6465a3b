#pragma once

// What goes out in chunks: blobs to workers, results to people.

#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Work.GetBlob. Each chunk is copied out of the mapped file on the file executor: touching a
/// mapped page may wait for the disk.
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

/// Farm.GetResult.
class GetResultCall final
    : public SelfOwned<grpc::ServerWriteReactor<farm::ResultChunk>, GetResultCall> {
 public:
  GetResultCall(const Doors& doors, JobId job) : doors_(doors), job_(job) {}
  void begin();
  void OnWriteDone(bool ok) override;

 private:
  void write_next();

  const Doors doors_;
  const JobId job_;
  StoredResult result_;
  std::uint64_t offset_ = 0;
  farm::ResultChunk chunk_;
};

}  // namespace bandsaw::coordinator
