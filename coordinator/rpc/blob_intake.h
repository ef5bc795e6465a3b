#pragma once

// What the chunks of one blob say, each checked against the ones before.

#include <cstdint>
#include <optional>

#include "absl/status/status.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

class BlobIntake {
 public:
  /// INVALID_ARGUMENT, RESOURCE_EXHAUSTED: the field, what is allowed and what was found; nothing
  /// of the chunk counts then.
  absl::Status add(const farm::BlobChunk& chunk);
  /// No more chunks come. INVALID_ARGUMENT: bytes are missing.
  absl::Status end() const;

  bool begun() const { return digest_.has_value(); }
  const wire::Digest& digest() const { return *digest_; }  ///< once begun
  std::uint64_t size() const { return size_; }             ///< of the whole blob
  std::uint64_t first_offset() const { return first_; }    ///< where the first chunk began
  std::uint64_t received() const { return received_; }     ///< with what was there before it

 private:
  absl::Status begin(const farm::BlobChunk& chunk);

  std::optional<wire::Digest> digest_;
  std::uint64_t size_ = 0;
  std::uint64_t first_ = 0;
  std::uint64_t received_ = 0;
};

/// The data of a chunk MUST fit what was announced.
absl::Status check_chunk(const std::string& data, std::uint64_t received, std::uint64_t size);
absl::Status cut_short(std::uint64_t received, std::uint64_t size);

}  // namespace bandsaw::coordinator
