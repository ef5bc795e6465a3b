#include "coordinator/rpc/uploads.h"

#include <span>

#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

void PutBlobCall::OnReadDone(bool ok) {
  doors_.files.post([self = shared_from_this(), ok] { self->take(ok); });
}

void PutBlobCall::take(bool ok) {
  if (!ok && context_->IsCancelled()) {
    writer_.reset();
    Finish(grpc::Status::CANCELLED);
  } else if (!ok) {
    Finish(link::to_grpc(end()));
  } else if (const absl::Status status = add(chunk_); !status.ok()) {
    Finish(link::to_grpc(status));
  } else {
    StartRead(&chunk_);
  }
}

absl::Status PutBlobCall::add(const farm::BlobChunk& chunk) {
  RETURN_IF_ERROR(intake_.add(chunk));
  if (writer_ == nullptr) {
    ASSIGN_OR_RETURN(writer_, doors_.engine.write_blob(intake_.digest(), intake_.size(),
                                                       intake_.first_offset()));
  }
  return writer_->append(std::as_bytes(std::span(chunk.data())));
}

absl::Status PutBlobCall::end() {
  RETURN_IF_ERROR(intake_.end());
  return writer_->commit();
}

}  // namespace bandsaw::coordinator
