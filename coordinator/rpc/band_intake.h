#pragma once

// Assembles one band (a range of rows and samples that a worker rendered) from the chunks in which
// it arrives, checks each chunk against the previous ones, and hands the band to the engine. Used
// for gRPC (put_bands_call.h) and for the HTTP requests of browsers (web/join_routes.cpp).

#include <functional>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "coordinator/engine/engine.h"
#include "coordinator/engine/memory_budget.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

class BandIntake {
 public:
  /// `memory`: the budget for bands, which MUST outlive the intake. When the header comes, the size
  /// of the whole band is taken from this budget.
  explicit BandIntake(MemoryBudget& memory) : memory_(&memory) {}

  /// Adds a chunk. INVALID_ARGUMENT names the field, the allowed range and the value.
  /// RESOURCE_EXHAUSTED: the budget has no space for the band; send it again.
  absl::Status add(const farm::BandChunk& chunk);
  /// The two parts of add(), with the same errors: begin() takes the header, append() the next
  /// bytes of the pixels' sums.
  absl::Status begin(const farm::BandHeader& header);
  absl::Status append(absl::string_view data);
  bool begun() const { return begun_; }
  /// Returns true if some chunks have arrived, but not all.
  bool cut() const { return begun_ && !whole(); }
  /// Returns true if all bytes that the header announces have arrived.
  bool whole() const { return begun_ && received_ == header_.size(); }
  std::uint64_t received() const { return received_; }  ///< bytes

  const farm::BandHeader& header() const { return header_; }  ///< valid after the first chunk
  /// Returns the pixels of a complete band; callable once. INVALID_ARGUMENT: the bytes do not match
  /// the announced digest, or a sum is not finite and >= 0.
  absl::StatusOr<BandPixels> take();
  /// Calls take(), then gives the band and the share of the memory budget to Engine::put_band().
  /// The engine calls `done` with the outcome. If take() fails, `done` gets the error of take().
  /// Callable once. `browser`: true if a browser sent the band.
  void put(Engine& engine, std::function<void(absl::StatusOr<BandOutcome>)> done, bool browser);

 private:
  MemoryBudget* memory_;
  MemoryBudget::Share share_;  ///< the memory of the whole band
  bool begun_ = false;
  farm::BandHeader header_;
  BandPixels pixels_;
  std::uint64_t received_ = 0;
  wire::Hasher hasher_;
};

farm::PutBandReply::Outcome to_message(BandOutcome outcome);

}  // namespace bandsaw::coordinator
