#pragma once

// Checks the chunks in which a blob (a piece of scene data) is uploaded, each against the previous
// ones. Does not keep the bytes.

#include <cstdint>
#include <optional>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

class BlobIntake {
 public:
  /// Checks a chunk. INVALID_ARGUMENT: a field of the chunk is wrong. RESOURCE_EXHAUSTED: the blob
  /// is too large. The message names the field, the allowed range and the value. A refused chunk is
  /// ignored.
  absl::Status add(const farm::BlobChunk& chunk);
  /// Checks that the blob is complete. INVALID_ARGUMENT: bytes are missing.
  absl::Status end() const;

  bool begun() const { return digest_.has_value(); }
  const wire::Digest& digest() const { return *digest_; }  ///< valid once begun
  std::uint64_t size() const { return size_; }             ///< size of the whole blob
  std::uint64_t first_offset() const { return first_; }    ///< offset of the first chunk
  /// Returns the number of bytes of the blob that have arrived. The bytes before the first chunk
  /// count as well.
  std::uint64_t received() const { return received_; }

 private:
  absl::Status begin(const farm::BlobChunk& chunk);

  std::optional<wire::Digest> digest_;
  std::uint64_t size_ = 0;
  std::uint64_t first_ = 0;
  std::uint64_t received_ = 0;
};

/// Checks the bytes of a chunk of a blob or band. `size`: the bytes of the whole blob or band.
/// `received`: the bytes that arrived before this chunk. INVALID_ARGUMENT: the chunk is too long,
/// or longer than the rest of `size`.
absl::Status check_chunk(absl::string_view data, std::uint64_t received, std::uint64_t size);
/// Returns the error of a stream that ended after `received` of `size` bytes.
absl::Status cut_short(std::uint64_t received, std::uint64_t size);

}  // namespace bandsaw::coordinator
