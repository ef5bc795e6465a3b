// Each chunk of a blob is checked and written by a thread of the executor, never by a thread of
// gRPC. The next chunk is read when the previous chunk is written. While a chunk is processed, the
// call cannot end.

#include "coordinator/rpc/uploads.h"

#include <span>

#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

void PutBlobCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
    return;
  }
  StartRead(&chunk_);
}

void PutBlobCall::OnReadDone(bool ok) {
  {
    MutexLock lock(mutex_);
    if (finished_) {
      return;
    }
    working_ = true;
  }
  deps_.files.post([self = shared_from_this(), ok] { self->after_task(self->take(ok)); });
}

std::optional<absl::Status> PutBlobCall::take(bool ok) {
  if (!ok && context_->IsCancelled()) {
    writer_.reset();
    return absl::CancelledError("the client disconnected");
  }
  if (!ok) {
    return end();
  }
  const absl::Status status = add(chunk_);
  return status.ok() ? std::nullopt : std::optional(status);
}

void PutBlobCall::after_task(std::optional<absl::Status> ended) {
  MutexLock lock(mutex_);
  working_ = false;
  if (ended) {
    end_ = *std::move(ended);  // a complete upload succeeds even if stop() was called
  }
  if (end_) {
    advance();
  } else {
    StartRead(&chunk_);
  }
}

void PutBlobCall::stop(const absl::Status& why) {
  MutexLock lock(mutex_);
  if (!end_) {
    end_ = why;
  }
  advance();
}

void PutBlobCall::advance() {
  if (end_ && !working_ && !finished_) {
    finished_ = true;
    Finish(link::to_grpc(*end_));
  }
}

absl::Status PutBlobCall::add(const farm::BlobChunk& chunk) {
  RETURN_IF_ERROR(intake_.add(chunk));
  if (writer_ == nullptr) {
    ASSIGN_OR_RETURN(
        writer_, deps_.engine.write_blob(intake_.digest(), intake_.size(), intake_.first_offset()));
  }
  return writer_->append(std::as_bytes(std::span(chunk.data())));
}

absl::Status PutBlobCall::end() {
  RETURN_IF_ERROR(intake_.end());
  return writer_->commit();
}

}  // namespace bandsaw::coordinator
