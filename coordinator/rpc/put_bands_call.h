#pragma once

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
  PutBandsCall(const Doors& doors, grpc::CallbackServerContext* context)
      : doors_(doors), context_(context) {}
  void begin();
  void done() EXCLUDES(mutex_);

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;

  /// The worker sees a cancelled call; why, its session tells it.
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kWorker; }

 private:
  absl::Status take(const farm::BandChunk& chunk);
  void answer(const absl::StatusOr<BandOutcome>& outcome);
  grpc::Status last_word() EXCLUDES(mutex_);

  const Doors doors_;
  farm::BandChunk chunk_;
  BandIntake intake_;
  farm::PutBandReply reply_;
  Mutex mutex_;
  grpc::CallbackServerContext* context_ GUARDED_BY(mutex_);  ///< null: gRPC has put it away
};

}  // namespace bandsaw::coordinator
