// Checks the sizes and the order of a blob's chunks, and that the last chunk ends at the announced
// size. The bytes are not kept here.

#include "coordinator/rpc/blob_intake.h"

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/checked_messages.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::Status check_chunk(absl::string_view data, std::uint64_t received, std::uint64_t size) {
  if (data.size() > wire::kChunkBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("data: at most ", wire::kChunkBytes, " bytes a chunk, has ", data.size()));
  }
  if (data.size() > size - received) {
    return absl::InvalidArgumentError(
        absl::StrCat("data: more bytes than the announced size of ", size));
  }
  return absl::OkStatus();
}

absl::Status cut_short(std::uint64_t received, std::uint64_t size) {
  return absl::InvalidArgumentError(
      absl::StrCat("data: the stream ended after ", received, " of ", size, " bytes"));
}

absl::Status BlobIntake::begin(const farm::BlobChunk& chunk) {
  ASSIGN_OR_RETURN(const wire::Digest digest, digest_field("sha256", chunk.sha256()));
  if (chunk.size() > wire::kBlobBytes) {
    return absl::ResourceExhaustedError(
        absl::StrCat("size: a blob has at most ", wire::kBlobBytes, " bytes, not ", chunk.size()));
  }
  if (chunk.offset() > chunk.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("offset: the blob has ", chunk.size(), " bytes, not ", chunk.offset()));
  }
  RETURN_IF_ERROR(check_chunk(chunk.data(), chunk.offset(), chunk.size()));
  digest_ = digest;
  size_ = chunk.size();
  first_ = chunk.offset();
  received_ = first_ + chunk.data().size();
  return absl::OkStatus();
}

absl::Status BlobIntake::add(const farm::BlobChunk& chunk) {
  if (!begun()) {
    return begin(chunk);
  }
  if (!chunk.sha256().empty() || chunk.size() != 0) {
    return absl::InvalidArgumentError("sha256, size: belong in the first chunk only");
  }
  if (chunk.offset() != received_) {
    return absl::InvalidArgumentError(
        absl::StrCat("offset: must be ", received_, " now, is ", chunk.offset()));
  }
  RETURN_IF_ERROR(check_chunk(chunk.data(), received_, size_));
  received_ += chunk.data().size();
  return absl::OkStatus();
}

absl::Status BlobIntake::end() const {
  if (!begun()) {
    return absl::InvalidArgumentError("the stream holds no chunk");
  }
  return received_ == size_ ? absl::OkStatus() : cut_short(received_, size_);
}

}  // namespace bandsaw::coordinator
