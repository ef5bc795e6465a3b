#pragma once

// Work.PutBands, open for a minute: to open a call costs more than to send a small band.

#include <chrono>
#include <memory>

#include "worker/session/farm_calls.h"

namespace bandsaw::worker {

class BandStream {
 public:
  /// `calls` MUST outlive it.
  BandStream(FarmCalls& calls, std::shared_ptr<grpc::Channel> channel);
  /// Cancels what is under way.
  ~BandStream();

  /// Whether the next band may go through it: opened on this channel, and with time enough left
  /// before its deadline for a slow line.
  bool serves(const std::shared_ptr<grpc::Channel>& channel) const;

  /// Returns when the coordinator has answered. With an error the stream is over.
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
