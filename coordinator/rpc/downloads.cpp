// GetBlobCall sends a blob (a part of a scene), and ImageCall sends an image, in chunks. Both work
// in steps. A task on an executor makes the image, or copies a chunk of the blob. gRPC writes a
// chunk, and OnWriteDone() starts the next step.

#include "coordinator/rpc/downloads.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/checked_messages.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

static_assert(sizeof(Rgb) == 3 * sizeof(float),
              "the pixels of an image are sent as they are in memory");

absl::Status GetBlobCall::open() {
  ASSIGN_OR_RETURN(const wire::Digest digest, digest_field("sha256", request_.sha256()));
  ASSIGN_OR_RETURN(blob_, deps_.engine.blobs().get(digest));
  if (request_.offset() > blob_->bytes().size()) {
    return absl::InvalidArgumentError(absl::StrCat("offset: the blob has ", blob_->bytes().size(),
                                                   " bytes, not ", request_.offset()));
  }
  offset_ = request_.offset();
  chunk_.set_sha256(request_.sha256());
  chunk_.set_size(blob_->bytes().size());
  return absl::OkStatus();
}

void GetBlobCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
  }
  deps_.files.post([self = shared_from_this()] {
    absl::Status status = self->stopped();
    status = status.ok() ? self->open() : status;
    if (!status.ok()) {
      self->Finish(link::to_grpc(status));
    } else {
      self->write_next(/*first=*/true);
    }
  });
}

void GetBlobCall::stop(const absl::Status& why) {
  MutexLock lock(mutex_);
  stopped_.Update(why);
}

absl::Status GetBlobCall::stopped() {
  MutexLock lock(mutex_);
  return stopped_;
}

void GetBlobCall::OnWriteDone(bool ok) {
  if (!ok) {
    Finish(grpc::Status::CANCELLED);
    return;
  }
  deps_.files.post([self = shared_from_this()] {
    self->chunk_.clear_sha256();
    self->chunk_.clear_size();
    self->write_next(/*first=*/false);
  });
}

void GetBlobCall::write_next(bool first) {
  const auto bytes = blob_->bytes();
  const absl::Status status = stopped();
  if (!status.ok() || (offset_ == bytes.size() && !first)) {
    Finish(link::to_grpc(status));
    return;
  }
  const std::uint64_t size = std::min<std::uint64_t>(wire::kChunkBytes, bytes.size() - offset_);
  chunk_.set_offset(offset_);
  chunk_.set_data(bytes.data() + offset_, size);
  offset_ += size;
  StartWrite(&chunk_);
}

void ImageCall::begin() {
  if (const absl::Status status = deps_.streams.add(weak_from_this()); !status.ok()) {
    stop(status);
  }
  deps_.images.post([self = shared_from_this()] { self->make_and_write(); });
}

void ImageCall::make_and_write() {
  {
    MutexLock lock(mutex_);
    if (!stopped_.ok()) {
      write_next();
      return;
    }
  }
  absl::StatusOr<HeldImage> made = make_();
  MutexLock lock(mutex_);
  if (!made.ok()) {
    stopped_.Update(made.status());
  } else if (stopped_.ok()) {
    image_ = *std::move(made);
    chunk_.set_width(image_.result.image.width);
    chunk_.set_height(image_.result.image.height);
    chunk_.set_sha256(image_.result.digest.raw());
    chunk_.set_exposure(image_.result.display.exposure);
    chunk_.set_tone(static_cast<std::uint32_t>(image_.result.display.tone));
  }
  write_next();
}

void ImageCall::stop(const absl::Status& why) {
  MutexLock lock(mutex_);
  stopped_.Update(why);
  image_ = {};
}

void ImageCall::OnWriteDone(bool ok) {
  MutexLock lock(mutex_);
  if (!ok) {
    image_ = {};
    Finish(grpc::Status::CANCELLED);
    return;
  }
  chunk_.Clear();
  write_next();
}

void ImageCall::write_next() {
  const auto* bytes = reinterpret_cast<const char*>(image_.result.image.pixels.data());
  const std::uint64_t total = image_.result.image.pixels.size() * sizeof(Rgb);
  if (!stopped_.ok() || offset_ == total) {
    image_ = {};
    Finish(link::to_grpc(stopped_));
    return;
  }
  const std::uint64_t size = std::min<std::uint64_t>(wire::kChunkBytes, total - offset_);
  chunk_.set_data(bytes + offset_, size);
  offset_ += size;
  StartWrite(&chunk_);
}

}  // namespace bandsaw::coordinator
