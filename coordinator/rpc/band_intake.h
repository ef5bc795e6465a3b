#pragma once

// What the chunks of one band say, each checked against the ones before.

#include "absl/status/statusor.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

class BandIntake {
 public:
  /// INVALID_ARGUMENT: the field, what is allowed and what was found.
  absl::Status add(const farm::BandChunk& chunk);
  /// Chunks came, but not all.
  bool cut() const { return begun_ && !whole(); }
  bool whole() const { return begun_ && received_ == header_.size(); }
  std::uint64_t received() const { return received_; }

  const farm::BandHeader& header() const { return header_; }  ///< once a chunk came
  /// Of a whole band, once. INVALID_ARGUMENT: not the bytes that were announced, or not sums.
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
