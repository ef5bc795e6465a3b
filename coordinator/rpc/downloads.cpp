#include "coordinator/rpc/downloads.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/convert.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

static_assert(sizeof(Rgb) == 3 * sizeof(float), "an image's pixels are its bytes on the wire");

absl::Status GetBlobCall::open() {
  ASSIGN_OR_RETURN(const wire::Digest digest, digest_field("sha256", request_.sha256()));
  ASSIGN_OR_RETURN(blob_, doors_.engine.blobs().get(digest));
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
  doors_.files.post([self = shared_from_this()] {
    if (const absl::Status status = self->open(); !status.ok()) {
      self->Finish(link::to_grpc(status));
    } else {
      self->write_next(true);
    }
  });
}

void GetBlobCall::OnWriteDone(bool ok) {
  if (!ok) {
    Finish(grpc::Status::CANCELLED);
    return;
  }
  doors_.files.post([self = shared_from_this()] {
    self->chunk_.clear_sha256();
    self->chunk_.clear_size();
    self->write_next(false);
  });
}

void GetBlobCall::write_next(bool first) {
  const auto bytes = blob_->bytes();
  if (offset_ == bytes.size() && !first) {
    Finish(grpc::Status::OK);
    return;
  }
  const std::uint64_t size = std::min<std::uint64_t>(wire::kChunkBytes, bytes.size() - offset_);
  chunk_.set_offset(offset_);
  chunk_.set_data(bytes.data() + offset_, size);
  offset_ += size;
  StartWrite(&chunk_);
}

void ImageCall::begin() {
  doors_.files.post([self = shared_from_this()] {
    absl::StatusOr<StoredResult> result = self->make_();
    if (!result.ok()) {
      self->Finish(link::to_grpc(result.status()));
      return;
    }
    self->result_ = *std::move(result);
    self->chunk_.set_width(self->result_.image.width);
    self->chunk_.set_height(self->result_.image.height);
    self->chunk_.set_sha256(self->result_.digest.raw());
    self->chunk_.set_exposure(self->result_.display.exposure);
    self->chunk_.set_tone(static_cast<std::uint32_t>(self->result_.display.tone));
    self->write_next();
  });
}

void ImageCall::OnWriteDone(bool ok) {
  const std::uint64_t total = result_.image.pixels.size() * sizeof(Rgb);
  if (!ok) {
    Finish(grpc::Status::CANCELLED);
  } else if (offset_ == total) {
    Finish(grpc::Status::OK);
  } else {
    chunk_.Clear();
    write_next();
  }
}

void ImageCall::write_next() {
  const auto* bytes = reinterpret_cast<const char*>(result_.image.pixels.data());
  const std::uint64_t total = result_.image.pixels.size() * sizeof(Rgb);
  const std::uint64_t size = std::min<std::uint64_t>(wire::kChunkBytes, total - offset_);
  chunk_.set_data(bytes + offset_, size);
  offset_ += size;
  StartWrite(&chunk_);
}

}  // namespace bandsaw::coordinator
