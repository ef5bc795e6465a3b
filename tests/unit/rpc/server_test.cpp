// The gRPC server and a real worker beside it: submission, rendering, a restart, and a worker that
// cannot connect.

#include "coordinator/rpc/server.h"

#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"
#include "renderlib/render/render_image.h"
#include "tests/support/scenes.h"
#include "tests/unit/rpc/farm.h"
#include "worker/daemon.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;

using ServerTest = FarmTest;

TEST_F(ServerTest, ASecondServerOnAPortReportsThatItIsTaken) {
  const std::string listen = "127.0.0.1:" + std::to_string(server_->port());
  const absl::Status status = Server::start(*engine_, identity_, {.listen = listen}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()), HasSubstr("is taken"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("--listen"));
}

TEST_F(ServerTest, ReportsAnInvalidAddress) {
  for (const char* listen : {"7878", "host", "127.0.0.1:x", "127.0.0.1:70000", ":1"}) {
    EXPECT_EQ(Server::start(*engine_, identity_, {.listen = listen}).status().code(),
              absl::StatusCode::kInvalidArgument)
        << listen;
  }
  // An address of the documentation network, which no machine has.
  EXPECT_EQ(Server::start(*engine_, identity_, {.listen = "192.0.2.1:0"}).status().code(),
            absl::StatusCode::kFailedPrecondition);
}

TEST_F(ServerTest, ChecksEachFieldOfASubmission) {
  // cornell_request() sets stop.samples, and exactly one of samples, error and time_s must be set.
  const std::vector<std::pair<std::string, std::function<void(farm::SubmitRequest&)>>> cases = {
      {"request_id", [](auto& r) { r.set_request_id("short"); }},
      {"request_id", [](auto& r) { r.set_request_id(std::string(65, 'a')); }},
      {"request_id", [](auto& r) { r.set_request_id("0123456789abcde\n"); }},
      {"name", [](auto& r) { r.set_name(std::string(201, 'n')); }},
      {"name", [](auto& r) { r.set_name("\x1b[2J"); }},
      {"manifest_sha256", [](auto& r) { r.set_manifest_sha256("short"); }},
      {"width", [](auto& r) { r.mutable_settings()->set_width(0); }},
      {"height", [](auto& r) { r.mutable_settings()->set_height(65537); }},
      {"depth", [](auto& r) { r.mutable_settings()->set_max_depth(0); }},
      {"stop", [](auto& r) { r.clear_stop(); }},
      {"stop", [](auto& r) { r.mutable_stop()->set_error(0.01); }},
      {"stop.samples", [](auto& r) { r.mutable_stop()->set_samples(kMaxSamples + 1); }},
      {"stop.error",
       [](auto& r) {
         r.mutable_stop()->set_samples(0);
         r.mutable_stop()->set_error(std::nan(""));
       }},
      {"stop.time_s",
       [](auto& r) {
         r.mutable_stop()->set_samples(0);
         r.mutable_stop()->set_time_s(-1);
       }},
      {"integrator",
       [](auto& r) {
         r.mutable_settings()->set_integrator(
             static_cast<farm::Integrator>(farm::Integrator_MAX + 1));
       }},
      {"priority", [](auto& r) { r.set_priority(-1001); }},
      {"stop.max_samples", [](auto& r) { r.mutable_stop()->set_max_samples(kMaxSamples + 1); }},
  };
  const wire::Digest manifest = put_cornell_box();
  for (const auto& [field, change] : cases) {
    farm::SubmitRequest request = cornell_request(manifest);
    change(request);
    farm::SubmitReply reply;
    const grpc::Status status = people()->Submit(context(link::Role::kFarm).get(), request, &reply);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT) << field;
    EXPECT_THAT(status.error_message(), HasSubstr(field));
  }
}

TEST_F(ServerTest, ReportsTheMissingBlobOfAJob) {
  farm::SubmitReply reply;
  const grpc::Status status =
      people()->Submit(context(link::Role::kFarm).get(), cornell_request(wire::Digest()), &reply);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION) << status.error_message();
}

/// A real worker in this process, on a thread of its own. `id`: a different character for each
/// worker of a test.
class Worker {
 public:
  Worker(const link::JoinString& join, const std::string& cache, char id)
      : daemon_(*worker::Daemon::create({.join = join,
                                         .info = {.instance = std::string(32, id),
                                                  .name = "desk",
                                                  .build = "test",
                                                  .threads = 2,
                                                  .max_bands = 3,
                                                  .pixel_version = kPixelVersion,
                                                  .canary = canary()},
                                         .cache_folder = cache,
                                         .log_tail = nullptr,
                                         .joined = nullptr})),
        thread_([this] { status_ = daemon_->run(); }) {}
  ~Worker() {
    daemon_->leave();
    if (thread_.joinable()) {
      thread_.join();
    }
  }
  /// Lets the worker finish its bands and leave the farm. Returns the worker's status.
  absl::Status drain() {
    daemon_->drain("the test is over");
    return wait();
  }
  /// Waits until the worker has ended. Returns its status.
  absl::Status wait() {
    thread_.join();
    return status_;
  }

 private:
  std::unique_ptr<worker::Daemon> daemon_;
  absl::Status status_;
  std::thread thread_;
};

class WorkerTest : public FarmTest {
 protected:
  /// Waits until the job is over and returns its last state.
  farm::JobStatus watch_to_end(std::uint64_t job) {
    const auto call = context(link::Role::kFarm);
    farm::WatchRequest request;
    request.set_job(job);
    const auto watch = people()->Watch(call.get(), request);
    farm::JobStatus state;
    while (watch->Read(&state)) {
    }
    const grpc::Status status = watch->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    return state;
  }

  /// Downloads the image of a job and returns its bytes.
  std::string result(std::uint64_t job) {
    const auto call = context(link::Role::kFarm);
    farm::GetResultRequest request;
    request.set_job(job);
    const auto reader = people()->GetResult(call.get(), request);
    farm::ResultChunk chunk;
    std::string bytes;
    std::string digest;
    while (reader->Read(&chunk)) {
      digest += chunk.sha256();
      bytes += chunk.data();
    }
    const grpc::Status status = reader->Finish();
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(wire::sha256(bytes).raw(), digest);
    return bytes;
  }

  /// Returns the bytes of the image of cornell_request, rendered in this process without a farm.
  static std::string rendered_here() {
    Pool pool(1);
    const std::atomic<bool> never{false};
    const auto image = render_image(
        *test::cornell_box().build(), {.width = 24, .height = 20, .max_depth = 4, .seed = 5}, 40,
        pool, never, [](std::uint64_t) {}, "");
    EXPECT_TRUE(image.ok()) << image.status();
    const Image pixels = image->film.snapshot().image;
    return {reinterpret_cast<const char*>(pixels.pixels.data()),
            pixels.pixels.size() * sizeof(Rgb)};
  }
};

TEST_F(WorkerTest, RendersTheSameBytesAsALocalRender) {
  Worker first(join(link::Role::kWorker), folder_ / "cache", 'a');
  Worker second(join(link::Role::kWorker), folder_ / "cache", 'b');
  const wire::Digest manifest = put_cornell_box();
  farm::SubmitReply job;
  const grpc::Status submitted =
      people()->Submit(context(link::Role::kFarm).get(), cornell_request(manifest), &job);
  ASSERT_TRUE(submitted.ok()) << submitted.error_message();
  const farm::JobStatus end = watch_to_end(job.job());
  ASSERT_EQ(end.state(), farm::JOB_STATE_DONE) << end.reason();
  EXPECT_EQ(end.samples_done(), 24U * 20U * 40U);
  EXPECT_EQ(end.samples_per_pixel(), 40U);
  EXPECT_EQ(end.fraction(), 1);
  EXPECT_GE(end.workers_used(), 1U);
  EXPECT_GT(end.rays(), 0U);
  EXPECT_TRUE(result(job.job()) == rendered_here());
  EXPECT_TRUE(first.drain().ok());
  EXPECT_TRUE(second.drain().ok());
}

TEST_F(WorkerTest, SurvivesARestartOfTheCoordinator) {
  Worker worker(join(link::Role::kWorker), folder_ / "cache", 'a');
  const wire::Digest manifest = put_cornell_box();
  farm::SubmitRequest request = cornell_request(manifest);
  farm::SubmitReply job;
  ASSERT_TRUE(people()->Submit(context(link::Role::kFarm).get(), request, &job).ok());
  const std::string listen = "127.0.0.1:" + std::to_string(server_->port());
  server_.reset();
  engine_.reset();
  engine_ =
      *Engine::start({.data_folder = folder_ / "data", .reattach_grace_s = 0.1, .audit_share = 0});
  auto server = Server::start(*engine_, identity_, {.listen = listen});
  ASSERT_TRUE(server.ok()) << server.status();
  server_ = *std::move(server);
  EXPECT_EQ(watch_to_end(job.job()).state(), farm::JOB_STATE_DONE);
  EXPECT_TRUE(result(job.job()) == rendered_here());
  EXPECT_TRUE(worker.drain().ok());
}

TEST_F(WorkerTest, EndsWithAnErrorIfItsJoinStringIsInvalid) {
  link::JoinString wrong_secret = join(link::Role::kWorker);
  wrong_secret.secret = std::string(22, 'A');
  Worker secret(wrong_secret, folder_ / "cache", 'a');
  EXPECT_EQ(secret.wait().code(), absl::StatusCode::kUnauthenticated);

  Worker role(join(link::Role::kFarm), folder_ / "cache", 'b');
  EXPECT_EQ(role.wait().code(), absl::StatusCode::kPermissionDenied);

  link::JoinString wrong_certificate = join(link::Role::kWorker);
  wrong_certificate.certificate = wire::Digest();
  Worker certificate(wrong_certificate, folder_ / "cache", 'c');
  EXPECT_EQ(certificate.wait().code(), absl::StatusCode::kUnauthenticated);
}

TEST_F(WorkerTest, DrainsAtOnceWithoutAConnection) {
  link::JoinString nowhere = join(link::Role::kWorker);
  nowhere.addresses = {"127.0.0.1:1"};
  Worker worker(nowhere, folder_ / "cache", 'a');
  EXPECT_TRUE(worker.drain().ok());
}

}  // namespace
}  // namespace bandsaw::coordinator
