#pragma once

// Streams from the server in chunks: blobs (scene data) to workers, images to users.

#include <functional>
#include <optional>
#include <utility>

#include "coordinator/rpc/picture.h"
#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Serves Work.GetBlob. Each chunk is copied out of the mapped file on the file executor, because
/// touching a mapped page may wait for the disk. From begin() to Finish, either a task or a write
/// is always in progress. Whenever a task or a write ends, the call checks whether stop() was
/// called.
class GetBlobCall final : public SelfOwned<grpc::ServerWriteReactor<farm::BlobChunk>, GetBlobCall>,
                          public LongStream {
 public:
  GetBlobCall(const ServiceDependencies& deps, const farm::GetBlobRequest& request)
      : deps_(deps), request_(request) {}
  void begin();
  void OnWriteDone(bool ok) override;
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kWorker; }

 private:
  /// Opens the blob, and prepares the first chunk.
  absl::Status open();
  /// Writes the next chunk, or ends the call. `first`: this is the first chunk, which is written
  /// even if it has no bytes.
  void write_next(bool first);
  /// Returns the status that stop() was called with; OK if it was not called.
  absl::Status stopped() EXCLUDES(mutex_);

  const ServiceDependencies deps_;
  const farm::GetBlobRequest request_;
  std::unique_ptr<BlobBytes> blob_;
  std::uint64_t offset_ = 0;
  farm::BlobChunk chunk_;
  Mutex mutex_;
  absl::Status stopped_ GUARDED_BY(mutex_);
};

/// Serves Farm.GetResult and Farm.Preview: sends an image that is made on the executor for images.
/// From begin() to Finish, either a task or a write is always in progress.
class ImageCall final : public SelfOwned<grpc::ServerWriteReactor<farm::ResultChunk>, ImageCall>,
                        public LongStream {
 public:
  /// Makes the image. May block, because it may wait for the engine.
  using Make = std::function<absl::StatusOr<HeldImage>()>;
  ImageCall(const ServiceDependencies& deps, Make make) : deps_(deps), make_(std::move(make)) {}
  void begin();
  void OnWriteDone(bool ok) override;
  /// Ends the call, and frees the memory of the image at once.
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kFarm; }

 private:
  void make_and_write() EXCLUDES(mutex_);
  /// Writes the next chunk, or ends the call.
  void write_next() REQUIRES(mutex_);

  const ServiceDependencies deps_;
  const Make make_;
  farm::ResultChunk chunk_;
  Mutex mutex_;
  HeldImage image_ GUARDED_BY(mutex_);
  std::uint64_t offset_ GUARDED_BY(mutex_) = 0;
  absl::Status stopped_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
