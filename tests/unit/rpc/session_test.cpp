// The streams Session and Watch. A worker stays connected by Session. A user gets the states of a
// job by Watch. Both streams end when the server stops.

#include <gmock/gmock.h>

#include <thread>

#include "proto/wire/limits.h"
#include "proto/wire/versions.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"
#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

using grpc::StatusCode;
using ::testing::HasSubstr;

/// Returns the first message of a compatible worker.
farm::FromWorker hello() {
  farm::FromWorker message;
  farm::Hello* h = message.mutable_hello();
  h->set_protocol(wire::kProtocol);
  h->set_pixel_version(kPixelVersion);
  h->set_canary(canary());
  h->set_instance(std::string(32, 'b'));
  h->set_name("desk");
  h->set_threads(2);
  h->set_max_bands(3);
  return message;
}

class StreamTest : public FarmTest {
 protected:
  /// Opens a session, sends these messages, and reads until the stream ends. If `hang_up` is true,
  /// the worker ends the stream. If not, the coordinator MUST end it.
  grpc::Status say(const std::vector<farm::FromWorker>& messages,
                   std::vector<farm::ToWorker>* answers = nullptr, bool hang_up = true) {
    const auto call = context(link::Role::kWorker);
    const auto stream = work()->Session(call.get());
    for (const farm::FromWorker& message : messages) {
      stream->Write(message);
    }
    if (hang_up) {
      stream->WritesDone();
    }
    farm::ToWorker answer;
    while (stream->Read(&answer)) {
      if (answers != nullptr) {
        answers->push_back(answer);
      }
    }
    return stream->Finish();
  }

  /// Expects that this first message ends the session with an error that contains `what`.
  void expect_refused(const farm::FromWorker& message, const std::string& what) {
    const grpc::Status status = say({message}, nullptr, /*hang_up=*/false);
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT) << what;
    EXPECT_THAT(status.error_message(), HasSubstr(what));
  }
};

farm::FromWorker log(const std::vector<std::string>& lines) {
  farm::FromWorker message;
  for (const std::string& line : lines) {
    message.mutable_log()->add_line(line);
  }
  return message;
}

TEST_F(StreamTest, KeepsTheLogOfAWorker) {
  EXPECT_TRUE(say({hello(), log({"one", "two"}), log({"three"})}).ok());
  farm::LogsRequest request;
  request.set_worker("desk");
  farm::LogsReply reply;
  const grpc::Status status = people()->Logs(context(link::Role::kFarm).get(), request, &reply);
  ASSERT_TRUE(status.ok()) << status.error_message();
  EXPECT_THAT(reply.line(), testing::ElementsAre("one", "two", "three"));
  request.set_worker("laptop");
  EXPECT_EQ(people()->Logs(context(link::Role::kFarm).get(), request, &reply).error_code(),
            StatusCode::NOT_FOUND);
}

TEST_F(StreamTest, RefusesLogsThatAreTooLongOrHoldControlCharacters) {
  for (const farm::FromWorker& bad :
       {log({"\x1b[2J"}), log({std::string(wire::kLogLineBytes + 1, 'x')}),
        log(std::vector<std::string>(wire::kLogLines + 1, "x"))}) {
    const grpc::Status status = say({hello(), bad}, nullptr, /*hang_up=*/false);
    EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_THAT(status.error_message(), HasSubstr("log.line"));
  }
}

TEST_F(StreamTest, AdmitsACompatibleWorker) {
  const auto call = context(link::Role::kWorker);
  const auto stream = work()->Session(call.get());
  stream->Write(hello());
  farm::ToWorker answer;
  ASSERT_TRUE(stream->Read(&answer));
  EXPECT_EQ(answer.welcome().name(), "desk");
  EXPECT_EQ(answer.welcome().epoch(), engine_->epoch());
  EXPECT_GT(answer.welcome().heartbeat_ms(), 0U);
  farm::ListWorkersReply workers;
  ASSERT_TRUE(people()->ListWorkers(context(link::Role::kFarm).get(), {}, &workers).ok());
  ASSERT_EQ(workers.worker_size(), 1);
  EXPECT_EQ(workers.worker(0).address(), "127.0.0.1");
  EXPECT_EQ(workers.worker(0).threads(), 2U);
  EXPECT_FALSE(workers.worker(0).browser()) << "no message of a native worker can say otherwise";
  stream->WritesDone();
  while (stream->Read(&answer)) {
  }
  EXPECT_TRUE(stream->Finish().ok());
}

// The canary is a hash of a small render, which every program computes when it starts. A worker
// with another canary than the coordinator would render other pixels.
TEST_F(StreamTest, RefusesAWorkerWithAnotherCanaryAndGivesTheReason) {
  farm::FromWorker other = hello();
  other.mutable_hello()->set_canary(canary() + 1);
  std::vector<farm::ToWorker> answers;
  EXPECT_TRUE(say({other}, &answers, /*hang_up=*/false).ok());
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].refused().reason().empty());
  EXPECT_GT(answers[0].refused().retry_after_ms(), 0U);
}

TEST_F(StreamTest, RequiresHelloFirstAndOnce) {
  farm::FromWorker beat;
  beat.mutable_heartbeat();
  expect_refused(beat, "hello");
  expect_refused(farm::FromWorker(), "hello");
  EXPECT_EQ(say({hello(), hello()}, nullptr, /*hang_up=*/false).error_code(),
            StatusCode::INVALID_ARGUMENT);
}

TEST_F(StreamTest, ChecksEachFieldOfHello) {
  const std::vector<std::pair<std::string, std::function<void(farm::Hello&)>>> cases = {
      {"hello.instance", [](auto& h) { h.set_instance("short"); }},
      {"hello.instance", [](auto& h) { h.set_instance(std::string(32, 'x')); }},
      {"hello.name", [](auto& h) { h.set_name(std::string(wire::kWorkerNameBytes + 1, 'n')); }},
      {"hello.name", [](auto& h) { h.set_name("a\x1b[2J"); }},
      {"hello.build", [](auto& h) { h.set_build(std::string(wire::kReasonBytes + 1, 'n')); }},
      {"hello.threads", [](auto& h) { h.set_threads(0); }},
      {"hello.threads", [](auto& h) { h.set_threads(wire::kThreadsPerWorker + 1); }},
      {"hello.max_bands", [](auto& h) { h.set_max_bands(0); }},
      {"hello.max_bands", [](auto& h) { h.set_max_bands(wire::kBandsPerWorker + 1); }},
      {"hello.held.band", [](auto& h) { h.add_held(); }},
      {"hello.held (count)",
       [](auto& h) {
         for (std::size_t i = 0; i <= wire::kBandsPerWorker; ++i) {
           h.add_held()->mutable_band()->set_last_row(1);
         }
       }},
  };
  for (const auto& [field, change] : cases) {
    farm::FromWorker message = hello();
    change(*message.mutable_hello());
    expect_refused(message, field);
  }
}

TEST_F(StreamTest, ChecksMessagesAfterHello) {
  farm::FromWorker beat;
  for (std::size_t i = 0; i <= wire::kBandsPerWorker; ++i) {
    beat.mutable_heartbeat()->add_lease();
  }
  farm::FromWorker failed;
  failed.mutable_failed()->set_reason(std::string(wire::kReasonBytes + 1, 'r'));
  farm::FromWorker log;
  for (std::size_t i = 0; i <= wire::kLogLines; ++i) {
    log.mutable_failed()->add_log("line");
  }
  farm::FromWorker draining;
  draining.mutable_draining()->set_reason("two\nlines");
  for (const farm::FromWorker& message : {beat, failed, log, draining}) {
    EXPECT_EQ(say({hello(), message}, nullptr, /*hang_up=*/false).error_code(),
              StatusCode::INVALID_ARGUMENT)
        << message.ShortDebugString().substr(0, 100);
  }
}

TEST_F(StreamTest, StoppingServerEndsSessionsAndWatchesInTime) {
  const wire::Digest manifest = put_cornell_box();
  farm::SubmitReply job;
  ASSERT_TRUE(
      people()->Submit(context(link::Role::kFarm).get(), cornell_request(manifest), &job).ok());
  const auto session_call = context(link::Role::kWorker);
  const auto session = work()->Session(session_call.get());
  session->Write(hello());
  farm::ToWorker answer;
  ASSERT_TRUE(session->Read(&answer));
  const auto watch_call = context(link::Role::kFarm);
  farm::WatchRequest request;
  request.set_job(job.job());
  const auto watch = people()->Watch(watch_call.get(), request);
  farm::JobStatus state;
  ASSERT_TRUE(watch->Read(&state));
  std::thread stopper([this] { server_.reset(); });
  while (session->Read(&answer)) {
  }
  EXPECT_EQ(session->Finish().error_code(), StatusCode::UNAVAILABLE);
  while (watch->Read(&state)) {
  }
  EXPECT_EQ(watch->Finish().error_code(), StatusCode::UNAVAILABLE);
  stopper.join();
}

TEST_F(StreamTest, WatchEndsWithTheFinalState) {
  const wire::Digest manifest = put_cornell_box();
  farm::SubmitReply job;
  ASSERT_TRUE(
      people()->Submit(context(link::Role::kFarm).get(), cornell_request(manifest), &job).ok());
  const auto call = context(link::Role::kFarm);
  farm::WatchRequest request;
  request.set_job(job.job());
  const auto watch = people()->Watch(call.get(), request);
  farm::JobStatus state;
  ASSERT_TRUE(watch->Read(&state));
  EXPECT_EQ(state.state(), farm::JOB_STATE_RUNNING);
  EXPECT_EQ(state.settings().width(), 24U);
  EXPECT_EQ(state.stop().samples(), 40U);
  EXPECT_EQ(state.manifest_sha256(), manifest.raw());
  farm::CancelRequest cancel;
  cancel.set_job(job.job());
  farm::JobStatus cancelled;
  ASSERT_TRUE(people()->Cancel(context(link::Role::kFarm).get(), cancel, &cancelled).ok());
  while (watch->Read(&state)) {
  }
  EXPECT_TRUE(watch->Finish().ok());
  EXPECT_EQ(state.state(), farm::JOB_STATE_CANCELLED);
}

// Half of the watches are cancelled before they have read a state. The test passes if no
// cancellation crashes or blocks the server.
TEST_F(StreamTest, AWatcherMayCancelAtAnyTime) {
  const wire::Digest manifest = put_cornell_box();
  farm::SubmitReply job;
  ASSERT_TRUE(
      people()->Submit(context(link::Role::kFarm).get(), cornell_request(manifest), &job).ok());
  farm::WatchRequest request;
  request.set_job(job.job());
  for (int i = 0; i < 20; ++i) {
    const auto call = context(link::Role::kFarm);
    const auto watch = people()->Watch(call.get(), request);
    farm::JobStatus state;
    if (i % 2 == 0) {
      watch->Read(&state);
    }
    call->TryCancel();
    watch->Finish();
  }
}

TEST_F(StreamTest, ReportsAnUnknownJob) {
  farm::WatchRequest watch_request;
  watch_request.set_job(99);
  const auto call = context(link::Role::kFarm);
  const auto watch = people()->Watch(call.get(), watch_request);
  farm::JobStatus state;
  EXPECT_FALSE(watch->Read(&state));
  EXPECT_EQ(watch->Finish().error_code(), StatusCode::NOT_FOUND);
  farm::GetResultRequest result_request;
  result_request.set_job(99);
  const auto result_call = context(link::Role::kFarm);
  const auto result = people()->GetResult(result_call.get(), result_request);
  farm::ResultChunk chunk;
  EXPECT_FALSE(result->Read(&chunk));
  EXPECT_EQ(result->Finish().error_code(), StatusCode::NOT_FOUND);
}

}  // namespace
}  // namespace bandsaw::coordinator
