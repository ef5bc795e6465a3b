#pragma once

#include <memory>
#include <optional>

#include "coordinator/rpc/blob_intake.h"
#include "coordinator/rpc/streams.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// Serves Farm.PutBlob: receives a blob (scene data) in chunks. A thread of the file executor
/// writes each chunk to the file. Only then is the next chunk read.
class PutBlobCall final : public SelfOwned<grpc::ServerReadReactor<farm::BlobChunk>, PutBlobCall>,
                          public LongStream {
 public:
  PutBlobCall(const ServiceDependencies& deps, grpc::CallbackServerContext* context)
      : deps_(deps), context_(context) {}
  void begin();
  void OnReadDone(bool ok) override;
  /// Ends the call. The bytes that have arrived are kept for the next attempt.
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kFarm; }

 private:
  /// Processes a chunk, or the end of the stream if `ok` is false. Returns the status with which
  /// the call ends; std::nullopt: the next chunk is to be read.
  std::optional<absl::Status> take(bool ok);
  /// Called when take() has returned `ended`. Reads the next chunk, or ends the call.
  void after_task(std::optional<absl::Status> ended) EXCLUDES(mutex_);
  /// Checks a chunk and appends its bytes to the blob.
  absl::Status add(const farm::BlobChunk& chunk);
  /// Checks that all bytes have arrived, and commits the blob.
  absl::Status end();
  /// Finishes the call if it is to end and no task is in progress.
  void advance() REQUIRES(mutex_);

  const ServiceDependencies deps_;
  grpc::CallbackServerContext* const context_;
  farm::BlobChunk
      chunk_;  ///< chunk_, intake_ and writer_: used by reads and tasks, which alternate
  BlobIntake intake_;
  std::unique_ptr<Engine::BlobWriter> writer_;
  Mutex mutex_;
  bool working_ GUARDED_BY(mutex_) = false;  ///< a task is on the file executor
  bool finished_ GUARDED_BY(mutex_) = false;
  /// The status with which the call is to end; std::nullopt: the call continues.
  std::optional<absl::Status> end_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
