#pragma once

// Assembles one band from its chunks and checks each chunk against the previous ones.

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

class BandIntake {
 public:
  /// Adds a chunk. INVALID_ARGUMENT names the field, the allowed range and the value.
  absl::Status add(const farm::BandChunk& chunk);
  /// Returns true if some chunks have arrived, but not all.
  bool cut() const { return begun_ && !whole(); }
  bool whole() const { return begun_ && received_ == header_.size(); }
  std::uint64_t received() const { return received_; }

  const farm::BandHeader& header() const { return header_; }  ///< valid after the first chunk
  /// Returns the pixels of a complete band; callable once. INVALID_ARGUMENT: the bytes do not match
  /// the announced digest, or a sum is not finite and >= 0.
  absl::StatusOr<BandPixels> take();

 private:
  absl::Status begin(const farm::BandHeader& header);

  bool begun_ = false;
  farm::BandHeader header_;
  BandPixels pixels_;
  std::uint64_t received_ = 0;
  wire::Hasher hasher_;
};

}  // namespace bandsaw::coordinator
