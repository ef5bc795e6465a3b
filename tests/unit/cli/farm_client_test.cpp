// Tests the errors of FarmClient, with which commands call a farm over gRPC. The test chooses the
// answers of the server.

#include "coordinator/cli/farm/farm_client.h"

#include <gtest/gtest.h>

#include <atomic>

#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {
namespace {

/// A farm on a free port of loopback, without TLS.
class TestFarm : public farm::Farm::Service {
 public:
  TestFarm() {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }

  /// Connects to this farm without TLS.
  std::unique_ptr<FarmClient> connect() const {
    link::JoinString join;
    join.role = link::Role::kFarm;
    join.addresses = {absl::StrCat("127.0.0.1:", port_)};
    join.secret = std::string(22, 'a');
    return *FarmClient::connect(join);
  }

 private:
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

/// A farm that cancels its first calls, as a coordinator does while it stops.
class CancellingFarm : public TestFarm {
 public:
  /// `cancelled`: number of calls that are answered with CANCELLED.
  explicit CancellingFarm(int cancelled) : cancelled_(cancelled) {}

  grpc::Status ListJobs(grpc::ServerContext*, const farm::ListJobsRequest*,
                        farm::ListJobsReply*) override {
    return cancelled_-- > 0 ? grpc::Status::CANCELLED : grpc::Status::OK;
  }

 private:
  std::atomic<int> cancelled_;
};

/// A farm that accepts a job, calls `accepted`, and then answers with `answer`.
class AcceptingFarm : public TestFarm {
 public:
  grpc::Status Submit(grpc::ServerContext*, const farm::SubmitRequest*,
                      farm::SubmitReply* reply) override {
    accepted();
    reply->set_job(7);
    return answer;
  }

  std::function<void()> accepted;
  grpc::Status answer;
};

TEST(FarmClient, RepeatsACallThatTheFarmCancelled) {
  const CancellingFarm farm(1);
  const absl::Status status = farm.connect()->jobs().status();
  EXPECT_TRUE(status.ok()) << status;
}

// A command ends if a call fails with CANCELLED, because Ctrl-C causes this error. With UNAVAILABLE
// it waits for the farm.
TEST(FarmClient, ReportsAFarmThatCancelsAllCallsAsUnavailable) {
  const CancellingFarm farm(1000);
  const absl::Status status = farm.connect()->jobs().status();
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable) << status;
}

TEST(FarmClient, IsCancelledByStop) {
  const CancellingFarm farm(0);
  const auto client = farm.connect();
  client->stop();
  EXPECT_EQ(client->jobs().status().code(), absl::StatusCode::kCancelled);
}

TEST(FarmClient, ReturnsTheAcceptedJobEvenAfterStop) {
  AcceptingFarm farm;
  const auto client = farm.connect();
  farm.accepted = [&] { client->stop(); };
  const absl::StatusOr<JobId> job = client->submit({});
  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(*job, 7u);
}

TEST(FarmClient, SaysThatTheFarmMayHaveAcceptedAJob) {
  AcceptingFarm farm;
  farm.answer = grpc::Status(grpc::StatusCode::UNAVAILABLE, "the connection was lost");
  const auto client = farm.connect();
  farm.accepted = [&] { client->stop(); };
  const absl::Status status = client->submit({}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kCancelled);
  EXPECT_NE(status.message().find("`bandsaw jobs` lists it"), std::string::npos) << status;
}

}  // namespace
}  // namespace bandsaw::coordinator
