#pragma once

#include <optional>

#include "coordinator/rpc/band_intake.h"
#include "coordinator/rpc/streams.h"

namespace bandsaw::coordinator {

/// Work.PutBands. One thing at a time: a band is read only when the one before is answered, so that
/// a worker has the memory of one. Chunks are copied and hashed where gRPC calls, which is less
/// than handing them to another thread takes where bands are small; the engine writes them.
class PutBandsCall final
    : public SelfOwned<grpc::ServerBidiReactor<farm::BandChunk, farm::PutBandReply>, PutBandsCall>,
      public LongStream {
 public:
  explicit PutBandsCall(const Doors& doors) : doors_(doors) {}
  void begin();

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;

  /// A band that the engine has is answered first.
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kWorker; }

 private:
  absl::Status take(const farm::BandChunk& chunk) EXCLUDES(mutex_);
  void read_next() EXCLUDES(mutex_);
  /// False: the call is over.
  bool hand_over() EXCLUDES(mutex_);
  void answer(const absl::StatusOr<BandOutcome>& outcome) EXCLUDES(mutex_);
  void advance() REQUIRES(mutex_);

  const Doors doors_;
  farm::BandChunk chunk_;  ///< this and the next: touched in the order of reads only
  BandIntake intake_;
  farm::PutBandReply reply_;  ///< by the one who answers
  Mutex mutex_;
  bool handed_over_ GUARDED_BY(mutex_) = false;  ///< a band, whose answer is not out yet
  bool finished_ GUARDED_BY(mutex_) = false;
  std::optional<absl::Status> end_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
