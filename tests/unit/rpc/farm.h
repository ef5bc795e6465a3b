#pragma once

// The base of tests of the gRPC server. It starts a coordinator for each test: an engine on a
// temporary folder and a server on a free port of loopback. The channel is connected with the role
// `farm`, which users have. Workers have the role `worker`.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "coordinator/engine/engine.h"
#include "coordinator/rpc/server.h"
#include "proto/farm.grpc.pb.h"
#include "proto/link/channel.h"
#include "proto/link/identity.h"
#include "renderlib/package/package.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {

class FarmTest : public ::testing::Test {
 protected:
  FarmTest();
  ~FarmTest() override;

  /// Returns what a client of this role needs to connect: address, certificate and secret.
  link::JoinString join(link::Role role) const;
  std::shared_ptr<grpc::Channel> channel() const { return channel_; }
  /// Returns a context with this role's secret and a deadline that expires only because of a bug.
  std::unique_ptr<grpc::ClientContext> context(link::Role role) const;
  /// `people`: the service for users; `work`: the service for workers.
  std::unique_ptr<farm::Farm::Stub> people() const { return farm::Farm::NewStub(channel_); }
  std::unique_ptr<farm::Work::Stub> work() const { return farm::Work::NewStub(channel_); }

  /// Uploads a blob in these chunks, as a user does.
  grpc::Status put_blob(const std::vector<farm::BlobChunk>& chunks);
  /// The outcome of each uploaded band, and the status of the call.
  struct PutBands {
    std::vector<farm::PutBandReply::Outcome> outcomes;
    grpc::Status status;
  };
  /// Returns one chunk with a whole band of job 1, which does not exist unless the test submits a
  /// job. The band has two rows of three pixels. `sums`: three for each pixel.
  static farm::BandChunk band_chunk(const std::vector<double>& sums = std::vector<double>(18, 0.5));
  /// Sends these chunks as a worker, and returns the answers to the bands.
  PutBands put_bands(const std::vector<farm::BandChunk>& chunks);
  /// Returns one chunk with the whole blob.
  static farm::BlobChunk whole(const std::string& bytes);

  /// Stores the Cornell box's package; returns its manifest's digest.
  wire::Digest put_cornell_box();
  /// Returns a request to render the package with 24 x 20 pixels and 40 samples per pixel.
  farm::SubmitRequest cornell_request(const wire::Digest& manifest) const;

  /// Submits a job of side x side pixels with 8 samples per pixel; returns its id.
  std::uint64_t submit_job(std::uint32_t side);
  /// Stores all samples of the rows [first, last) of a job that submit_job(side) returned, and
  /// waits until they are stored.
  void put_rows(std::uint64_t job, std::uint32_t side, std::uint32_t first, std::uint32_t last);
  /// Submits a job as submit_job does, stores all its rows and waits until it is done. Returns the
  /// id of the job.
  std::uint64_t finish_job(std::uint32_t side);

  test::TempDir folder_;
  link::Identity identity_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<Server> server_;
  std::shared_ptr<grpc::Channel> channel_;

 private:
  int submitted_ = 0;
};

}  // namespace bandsaw::coordinator
