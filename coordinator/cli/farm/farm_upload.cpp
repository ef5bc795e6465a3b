// FarmClient::put_blob: sends a blob (a part of a scene, named by its SHA-256) in chunks, and
// resumes after an interruption.

#include <algorithm>

#include "coordinator/cli/farm/farm_client.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// `status` is the result of an upload. Returns true if the upload began at the wrong byte: the
/// farm has fewer bytes of the blob than this client assumed (FAILED_PRECONDITION), or has deleted
/// damaged bytes (DATA_LOSS). Then the upload starts again at the byte that the farm reports.
bool offset_is_wrong(const absl::Status& status) {
  return absl::IsFailedPrecondition(status) || absl::IsDataLoss(status);
}

}  // namespace

absl::Status FarmClient::put_blob(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                                  std::uint64_t there,
                                  const std::function<void(std::uint64_t)>& sent) {
  absl::Status status = put_rest(digest, bytes, there, sent);
  for (int tries = 1; tries < kTries && (outcome_unknown(status) || offset_is_wrong(status));
       ++tries) {
    pause(kRetryPause);
    ASSIGN_OR_RETURN(const std::vector<MissingBlob> missing, missing_blobs({digest}));
    if (missing.empty()) {
      return absl::OkStatus();
    }
    // The limit counts only attempts without progress, so that an upload completes even if its
    // connection breaks often.
    tries = missing.front().there > there ? 0 : tries;
    there = missing.front().there;
    status = put_rest(digest, bytes, there, sent);
  }
  return given_up(status);
}

absl::Status FarmClient::put_rest(const wire::Digest& digest, absl::Span<const std::byte> bytes,
                                  std::uint64_t offset,
                                  const std::function<void(std::uint64_t)>& sent) {
  return try_once(kNoDeadline, [&](grpc::ClientContext& context) {
    farm::PutBlobReply reply;
    const auto stream = bulk_->PutBlob(&context, &reply);
    std::uint64_t at = std::min<std::uint64_t>(offset, bytes.size());
    bool first = true;
    while (first || at < bytes.size()) {
      farm::BlobChunk chunk;
      if (first) {
        chunk.set_sha256(digest.raw());
        chunk.set_size(bytes.size());
        first = false;
      }
      const auto piece = bytes.subspan(at, wire::kChunkBytes);
      chunk.set_offset(at);
      chunk.set_data(piece.data(), piece.size());
      if (!stream->Write(chunk)) {
        break;  // Finish() returns the reason
      }
      at += piece.size();
      sent(at);
    }
    stream->WritesDone();
    return stream->Finish();
  });
}

}  // namespace bandsaw::coordinator
