#pragma once

// A Work.PutBands call that is used for a minute, because opening a call costs more than sending a
// small band.

#include <chrono>
#include <memory>

#include "worker/session/farm_calls.h"

namespace bandsaw::worker {

class BandStream {
 public:
  /// `calls` MUST outlive the stream.
  BandStream(FarmCalls& calls, std::shared_ptr<grpc::Channel> channel);
  /// Cancels a transfer in progress.
  ~BandStream();

  /// True if the next band may be sent on it: it was opened on this channel, and the time to its
  /// deadline is sufficient for a slow connection.
  bool serves(const std::shared_ptr<grpc::Channel>& channel) const;

  /// Sends a band and waits for the coordinator's answer. After an error the stream must not be
  /// used again.
  absl::StatusOr<farm::PutBandReply::Outcome> put(const FinishedBand& band,
                                                  const std::string& instance,
                                                  const LeaseName& lease);

 private:
  bool send(const FinishedBand& band, const std::string& instance, const LeaseName& lease);

  const std::shared_ptr<grpc::Channel> channel_;
  const std::unique_ptr<farm::Work::Stub> stub_;
  const std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  FarmCalls::Context context_;
  std::unique_ptr<grpc::ClientReaderWriter<farm::BandChunk, farm::PutBandReply>> stream_;
  bool finished_ = false;
};

}  // namespace bandsaw::worker
