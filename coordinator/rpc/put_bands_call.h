#pragma once

#include <optional>

#include "coordinator/rpc/band_intake.h"
#include "coordinator/rpc/streams.h"

namespace bandsaw::coordinator {

/// Serves Work.PutBands, the stream on which a worker sends its finished bands. Flow control: the
/// next band is read only after the previous one is answered. So a worker's stream needs the memory
/// of one band. BandIntake takes this memory from Engine::bands(). Chunks are copied and hashed on
/// gRPC's thread, because this costs less for small bands than handing the chunks to another
/// thread. The engine writes the bands to disk.
class PutBandsCall final
    : public SelfOwned<grpc::ServerBidiReactor<farm::BandChunk, farm::PutBandReply>, PutBandsCall>,
      public LongStream {
 public:
  explicit PutBandsCall(const ServiceDependencies& deps)
      : deps_(deps), intake_(deps.engine.bands()) {}
  void begin();

  void OnReadDone(bool ok) override;
  void OnWriteDone(bool ok) override;

  /// Ends the call. A band that the engine already has is answered first.
  void stop(const absl::Status& why) override EXCLUDES(mutex_);
  link::Role role() const override { return link::Role::kWorker; }

 private:
  /// Adds a chunk to the band, then reads the next chunk, or hands a complete band to the engine.
  absl::Status take(const farm::BandChunk& chunk) EXCLUDES(mutex_);
  void read_next() EXCLUDES(mutex_);
  /// Marks the band as given to the engine. Returns false if the call is over.
  bool hand_over() EXCLUDES(mutex_);
  /// Called by the engine when it is done with the band. Writes the outcome to the worker, or ends
  /// the call if the engine returned an error.
  void answer(const absl::StatusOr<BandOutcome>& outcome) EXCLUDES(mutex_);
  /// Finishes the call if it is to end and no band is with the engine.
  void advance() REQUIRES(mutex_);

  const ServiceDependencies deps_;
  farm::BandChunk chunk_;  ///< chunk_ and intake_: used by read callbacks only
  BandIntake intake_;
  farm::PutBandReply reply_;  ///< accessed by the thread that answers
  Mutex mutex_;
  /// True while a band is with the engine or its answer is being written.
  bool handed_over_ GUARDED_BY(mutex_) = false;
  bool finished_ GUARDED_BY(mutex_) = false;
  /// The status with which the call is to end; std::nullopt: the call continues.
  std::optional<absl::Status> end_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
