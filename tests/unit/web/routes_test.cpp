// The requests of the dashboard's page and their answers: the farm, dropped scenes, jobs, images,
// the gallery, and the program of the workers.

#include <gmock/gmock.h>

#include <thread>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/metrics.h"
#include "tests/unit/web/web_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class RoutesTest : public WebTest {
 protected:
  RoutesTest() { log_in(); }
  std::string error_of(const Answer& result) { return message<web::Problem>(result).error(); }
};

TEST_F(RoutesTest, AnEmptyFarmIsShown) {
  const auto overview = message<web::Overview>(get("/api/farm"));
  EXPECT_EQ(overview.job_size(), 0);
  EXPECT_EQ(overview.worker_size(), 0);
  EXPECT_FALSE(overview.version().empty());
}

TEST_F(RoutesTest, ThePageHasItsScriptsAndASecurityPolicy) {
  const auto page = get("/");
  ASSERT_TRUE(page);
  EXPECT_THAT(page->body, StartsWith("<!doctype html>"));
  EXPECT_THAT(page->header("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(get("/main.js")->header("Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/nothing.js")->status, 404);
}

TEST_F(RoutesTest, TheWorkersProgramIsHandedOutWithVersionAndDigest) {
  headers_.clear();  // no login is needed, because the reply contains no secret
  const auto got = get("/bandsaw-worker");
  ASSERT_TRUE(got);
  EXPECT_EQ(got->status, 200);
  EXPECT_EQ(got->body, std::string(3 << 20, 'w'));
  EXPECT_EQ(got->header("X-Bandsaw-Version"), "1.2.3");
  const std::string raw = wire::sha256(got->body).raw();
  EXPECT_EQ(got->header("Repr-Digest"), "sha-256=:" + absl::Base64Escape(raw) + ":");
}

// An architecture has two names, such as "aarch64" and "arm64". Both lead to its program.
TEST_F(RoutesTest, EachArchitectureHasItsProgram) {
  headers_.clear();
  const std::string own(machine_name(kThisMachine));
  EXPECT_EQ(get("/bandsaw-worker/" + own)->body, get("/bandsaw-worker")->body);
  for (const absl::string_view name :
       {machine_name(kOtherMachine), other_machine_name(kOtherMachine)}) {
    const auto got = get("/bandsaw-worker/" + std::string(name));
    ASSERT_TRUE(got);
    EXPECT_EQ(got->body, "o");
    EXPECT_EQ(got->header("X-Bandsaw-Version"), "1.2.4");
    EXPECT_EQ(got->header("Repr-Digest"),
              "sha-256=:" + absl::Base64Escape(wire::sha256("o").raw()) + ":");
  }
  const auto none = get("/bandsaw-worker/riscv64");
  ASSERT_TRUE(none);
  EXPECT_EQ(none->status, 404);
  EXPECT_THAT(error_of(none), HasSubstr("no bandsaw-worker for this architecture; it has: " + own));
  EXPECT_EQ(get("/bandsaw-worker/..%2fx")->status, 404);
  EXPECT_EQ(get("/bandsaw-worker/")->status, 404);
}

// The server sends no more bytes than the file has, whatever the Range header says.
TEST_F(RoutesTest, ARangeReturnsNoMoreBytesThanTheFileHas) {
  const std::size_t size = 3 << 20;
  headers_ = {{"Range", "bytes=5-9"}};
  const auto part = get("/bandsaw-worker");
  ASSERT_TRUE(part);
  EXPECT_EQ(part->status, 206);
  EXPECT_EQ(part->body, "wwwww");
  for (const std::string& range :
       {"0-" + std::to_string(size + 200), std::to_string(size) + "-" + std::to_string(size + 9),
        std::string("99999999999999-99999999999999")}) {
    headers_ = {{"Range", "bytes=" + range}};
    const auto got = get("/bandsaw-worker");
    EXPECT_TRUE(!got || got->body.size() <= size) << range;
  }
  headers_.clear();
  EXPECT_EQ(get("/bandsaw-worker")->body.size(), size) << "the file must still be served";
}

TEST_F(RoutesTest, ADroppedSceneBecomesAJob) {
  const auto submitted = message<web::Submitted>(
      post("/api/scenes?name=../my%20box.textproto&width=48&samples=32", "a box"));
  EXPECT_EQ(submitted.job(), 1u);
  EXPECT_THAT(submitted.warning(), ::testing::ElementsAre("nothing was left out"));
  const auto page = message<web::JobPage>(get("/api/jobs/1"));
  EXPECT_EQ(page.job().status().name(), "my_box");
  EXPECT_EQ(page.job().status().settings().width(), 48u);
  EXPECT_EQ(page.job().status().settings().height(), 32u);  // the scene, 600 x 400, scaled
  EXPECT_EQ(page.job().status().stop().samples(), 32u);
  EXPECT_EQ(page.why_size(), 1);  // one reason why the job is not done: there is no worker
  EXPECT_EQ(message<web::Overview>(get("/api/farm")).job_size(), 1);
}

TEST_F(RoutesTest, ScenesOfOtherRenderersAndZipsMayBeDropped) {
  for (const char* name : {"a.zip", "a.PBRT", "a.xml"}) {
    EXPECT_GT(message<web::Submitted>(post(std::string("/api/scenes?name=") + name, "a")).job(), 0u)
        << name;
  }
}

TEST_F(RoutesTest, ADroppedSceneMaySetAnErrorTarget) {
  post("/api/scenes?name=a.GLB&error=0.02", "a box");
  EXPECT_EQ(message<web::JobPage>(get("/api/jobs/1")).job().status().stop().error(), 0.02);
}

TEST_F(RoutesTest, ARefusedDropStatesTheReason) {
  EXPECT_THAT(error_of(post("/api/scenes?name=a.obj", "v")), HasSubstr("bandsaw submit"));
  EXPECT_THAT(error_of(post("/api/scenes?name=a.glb", "broken")), HasSubstr("1:1: it is broken"));
  EXPECT_THAT(error_of(post("/api/scenes?name=a.glb&samples=0", "x")), HasSubstr("samples"));
  EXPECT_THAT(error_of(post("/api/scenes?name=a.zip&scene=b.pbrt", "x")),
              HasSubstr("no \"b.pbrt\" in it"));
  EXPECT_THAT(error_of(post("/api/scenes?name=a.glb&error=-1", "x")), HasSubstr("error"));
  EXPECT_THAT(error_of(post("/api/scenes?name=a.glb&width=x", "x")), HasSubstr("width"));
  EXPECT_THAT(error_of(post("/api/scenes?name=a.glb&width=65537", "x")), HasSubstr("width"));
  EXPECT_EQ(message<web::Overview>(get("/api/farm")).job_size(), 0);
}

TEST_F(RoutesTest, AJobIsPausedResumedGivenAPriorityAndCancelled) {
  const std::string job = "/api/jobs/" + std::to_string(submit_box());
  const auto state = [&](const Answer& result) {
    return message<web::Job>(result).status().state();
  };
  EXPECT_EQ(state(post(job + "/pause")), farm::JOB_STATE_PAUSED);
  EXPECT_EQ(state(post(job + "/resume")), farm::JOB_STATE_RUNNING);
  EXPECT_EQ(message<web::Job>(post(job + "/priority", "{\"priority\": 7}")).status().priority(), 7);
  EXPECT_EQ(post(job + "/priority", "{\"priority\": 1001}")->status, 400);
  EXPECT_EQ(post(job + "/priority", "{\"rank\": 1}")->status, 400);
  EXPECT_EQ(state(post(job + "/cancel")), farm::JOB_STATE_CANCELLED);
  EXPECT_EQ(post(job + "/pause")->status, 409);
}

TEST_F(RoutesTest, MissingThingsAre404AndFilesOfAJobThatIsNotDoneAre409) {
  EXPECT_EQ(get("/api/jobs/7")->status, 404);
  EXPECT_EQ(get("/api/jobs/99999999999999999999")->status, 404);
  EXPECT_THAT(error_of(post("/api/jobs/7/cancel")), HasSubstr("there is no job 7"));
  EXPECT_EQ(get("/api/workers/log?name=desk")->status, 404);
  submit_box();
  EXPECT_EQ(get("/api/jobs/1/preview.png")->status, 404);
  // The job exists, but it is not done.
  EXPECT_EQ(get("/api/jobs/1/image.png")->status, 409);
  EXPECT_EQ(get("/api/jobs/1/report.json")->status, 409);
  EXPECT_EQ(get("/api/jobs/7/report.json")->status, 404);
}

TEST_F(RoutesTest, AnImageForWhichNoMemoryIsLeftIsRefused) {
  const std::uint64_t job = submit_box();
  finish(job, 24, 16);
  const std::string path = "/api/jobs/" + std::to_string(job);
  const std::int64_t all = engine_->images().left();
  {
    // Holds all memory for images, as many downloads would.
    const auto others = engine_->images().take(static_cast<std::uint64_t>(all));
    ASSERT_TRUE(others);
    for (const char* file : {"/image.png", "/image.exr", "/preview.png", "/report.json"}) {
      const auto refused = get(path + file);
      EXPECT_EQ(refused->status, 429) << file;
      EXPECT_THAT(error_of(refused), HasSubstr("try again when a download has ended")) << file;
    }
  }
  for (const char* file : {"/image.png", "/image.exr", "/report.json"}) {
    EXPECT_EQ(get(path + file)->status, 200) << file;
  }
  // The server gives the memory back when it has closed the connection.
  while (engine_->images().left() != all) {
    std::this_thread::yield();
  }
  const auto preview = get(path + "/preview.png");
  EXPECT_EQ(preview->status, 200);
  EXPECT_EQ(engine_->images().left(), all - static_cast<std::int64_t>(preview->body.size()))
      << "the preview must stay in memory for the next request";
}

TEST_F(RoutesTest, ADoneJobDoesNotShowAnOlderPicture) {
  const std::uint64_t job = submit_box();
  const std::string path = absl::StrCat("/api/jobs/", job, "/preview.png?side=");
  put(job, 24, 16, {0, 8}, /*value=*/0.1);
  const auto early = get(path + "64");
  ASSERT_TRUE(early);
  ASSERT_EQ(early->status, 200);
  finish(job, 24, 16, /*samples=*/64, /*first=*/8);
  {
    const std::int64_t left = engine_->images().left();
    const auto others = engine_->images().take(static_cast<std::uint64_t>(left));
    ASSERT_TRUE(others);
    EXPECT_EQ(get(path + "64")->status, 429)
        << "a picture of a part of the samples must not be sent";
  }
  const auto done = get(path + "64");
  EXPECT_EQ(done->status, 200);
  EXPECT_NE(done->body, early->body);
  EXPECT_EQ(done->body, get(path + "500")->body)
      << "both sides are larger than the image, so both pictures are the image itself";
}

TEST_F(RoutesTest, TheGalleryRendersItsScenes) {
  auto gallery = message<web::Gallery>(get("/api/gallery"));
  ASSERT_EQ(gallery.scene_size(), 1);
  EXPECT_EQ(gallery.scene(0).name(), "box");
  EXPECT_EQ(gallery.scene(0).about(), "A box. With a lamp.");
  EXPECT_FALSE(gallery.scene(0).has_job());
  const std::string request = R"({"scene": "box", "width": 30, "samples": "16"})";
  EXPECT_EQ(message<web::Submitted>(post("/api/gallery/render", request)).job(), 1u);
  EXPECT_EQ(message<web::Submitted>(post("/api/gallery/render", request)).job(), 2u);
  gallery = message<web::Gallery>(get("/api/gallery"));
  EXPECT_EQ(gallery.scene(0).job().status().job(), 2u);
  EXPECT_EQ(gallery.scene(0).job().status().settings().width(), 30u);
  EXPECT_EQ(post("/api/gallery/render", R"({"scene": "../box", "samples": "16"})")->status, 404);
  EXPECT_EQ(post("/api/gallery/render", R"({"scene": "box", "samples": "0"})")->status, 400);
}

TEST_F(RoutesTest, ALongBodyIsRefused) {
  EXPECT_EQ(post("/api/gallery/render", std::string(100'000, ' '))->status, 400);
}

TEST(Metrics, EscapeNamesAndOmitUnknownValues) {
  JobView job;
  job.id = 3;
  job.spec.name = "a \"b\"\\";
  job.fraction = 0.5;
  WorkerView worker;
  worker.name = "desk";
  worker.state = "idle";
  worker.threads = 4;
  WorkerView tab;
  tab.name = "phone";
  tab.state = "idle";
  tab.threads = 2;
  tab.browser = true;
  const std::string text = metrics({job}, {worker, tab}, 1000, "0.1");
  EXPECT_THAT(text, HasSubstr("bandsaw_job_fraction{job=\"3\",name=\"a \\\"b\\\"\\\\\"} 0.5\n"));
  EXPECT_THAT(text, HasSubstr("bandsaw_workers{state=\"idle\",kind=\"native\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("bandsaw_workers{state=\"idle\",kind=\"browser\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("bandsaw_worker_threads{worker=\"desk\",kind=\"native\"} 4\n"));
  EXPECT_THAT(text, HasSubstr("bandsaw_worker_threads{worker=\"phone\",kind=\"browser\"} 2\n"));
  EXPECT_THAT(text, HasSubstr("bandsaw_free_bytes 1000\n"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("bandsaw_job_error{")));
}

}  // namespace
}  // namespace bandsaw::coordinator
