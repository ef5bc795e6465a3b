// The commands of users on jobs, by gRPC: pause, resume, set the priority, cancel, and ask why a
// job waits.

#include <gmock/gmock.h>

#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

class JobsTest : public FarmTest {
 protected:
  std::uint64_t submit(std::int32_t priority) {
    farm::SubmitRequest request = cornell_request(put_cornell_box());
    request.set_priority(priority);
    farm::SubmitReply reply;
    const grpc::Status status = people()->Submit(context(link::Role::kFarm).get(), request, &reply);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return reply.job();
  }

  /// Makes a call that answers with the status of a job, and keeps this answer in `job_`.
  template <class Request>
  grpc::Status tell(grpc::Status (farm::Farm::Stub::*call)(grpc::ClientContext*, const Request&,
                                                           farm::JobStatus*),
                    Request request) {
    return (people().get()->*call)(context(link::Role::kFarm).get(), request, &job_);
  }

  grpc::Status pause(std::uint64_t job) {
    farm::PauseRequest request;
    request.set_job(job);
    return tell(&farm::Farm::Stub::Pause, request);
  }
  grpc::Status resume(std::uint64_t job) {
    farm::ResumeRequest request;
    request.set_job(job);
    return tell(&farm::Farm::Stub::Resume, request);
  }
  grpc::Status set_priority(std::uint64_t job, std::int32_t priority) {
    farm::SetPriorityRequest request;
    request.set_job(job);
    request.set_priority(priority);
    return tell(&farm::Farm::Stub::SetPriority, request);
  }
  grpc::Status why(std::uint64_t job, farm::WhyReply& reply) {
    farm::WhyRequest request;
    request.set_job(job);
    return people()->Why(context(link::Role::kFarm).get(), request, &reply);
  }

  /// Lists at most `most` jobs (0: all) with ids above `after`. Returns their ids, and true if
  /// there may be more.
  std::pair<std::vector<std::uint64_t>, bool> list(std::uint64_t after, std::uint32_t most) {
    farm::ListJobsRequest request;
    request.set_after(after);
    request.set_most(most);
    farm::ListJobsReply reply;
    const grpc::Status status =
        people()->ListJobs(context(link::Role::kFarm).get(), request, &reply);
    EXPECT_TRUE(status.ok()) << status.error_message();
    std::vector<std::uint64_t> ids;
    for (const farm::JobStatus& job : reply.job()) {
      ids.push_back(job.job());
    }
    return {ids, reply.more()};
  }

  farm::JobStatus job_;  ///< the last answer
};

TEST_F(JobsTest, APauseMayBeRepeatedAndEnded) {
  const std::uint64_t job = submit(0);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(pause(job).ok());
    EXPECT_EQ(job_.state(), farm::JOB_STATE_PAUSED);
    EXPECT_THAT(job_.reason(), testing::HasSubstr("by a user"));
  }
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(resume(job).ok());
    EXPECT_EQ(job_.state(), farm::JOB_STATE_RUNNING);
  }
}

TEST_F(JobsTest, APriorityIsSetBySubmissionAndMayBeChanged) {
  const std::uint64_t job = submit(-7);
  ASSERT_TRUE(resume(job).ok());  // only to get the status of the job
  EXPECT_EQ(job_.priority(), -7);
  ASSERT_TRUE(set_priority(job, 1000).ok());
  EXPECT_EQ(job_.priority(), 1000);
  // Priorities are at most 1,000.
  EXPECT_EQ(set_priority(job, 1001).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(JobsTest, TheListComesInParts) {
  const std::uint64_t first = submit_job(8);
  const std::uint64_t second = submit_job(8);
  const std::uint64_t third = submit_job(8);
  EXPECT_THAT(list(0, 2), testing::Pair(testing::ElementsAre(first, second), true));
  EXPECT_THAT(list(second, 2), testing::Pair(testing::ElementsAre(third), false));
  EXPECT_THAT(list(third, 2), testing::Pair(testing::IsEmpty(), false));
  EXPECT_THAT(list(0, 0), testing::Pair(testing::ElementsAre(first, second, third), false));
}

TEST_F(JobsTest, WhyIsAnsweredInSentences) {
  const std::uint64_t job = submit(0);
  farm::WhyReply reply;
  ASSERT_TRUE(why(job, reply).ok());
  EXPECT_THAT(reply.reason(), testing::ElementsAre("no worker is connected"));
}

TEST_F(JobsTest, UnknownAndFinishedJobsAreErrors) {
  EXPECT_EQ(pause(99).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(resume(99).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(set_priority(99, 1).error_code(), grpc::StatusCode::NOT_FOUND);
  farm::WhyReply reply;
  EXPECT_EQ(why(99, reply).error_code(), grpc::StatusCode::NOT_FOUND);
  const std::uint64_t job = submit(0);
  farm::CancelRequest cancel;
  cancel.set_job(job);
  ASSERT_TRUE(tell(&farm::Farm::Stub::Cancel, cancel).ok());
  EXPECT_EQ(pause(job).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(resume(job).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(set_priority(job, 1).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
}

}  // namespace
}  // namespace bandsaw::coordinator
