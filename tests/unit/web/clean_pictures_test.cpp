// Denoised ("clean") pictures of finished jobs, for which the farm first renders the guides: images
// of the albedo and of the normals of the surfaces. In these tests, the guides of job n are the
// jobs n + 1 and n + 2. Each has one sample.

#include "coordinator/web/clean_pictures.h"

#include <gmock/gmock.h>

#include <thread>

#include "tests/unit/web/web_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class CleanPicturesTest : public WebTest {
 protected:
  CleanPicturesTest() { log_in(); }
  static std::string path(std::uint64_t job, const std::string& suffix = "") {
    return "/api/jobs/" + std::to_string(job) + "/clean" + suffix;
  }
  web::CleanPicture state(std::uint64_t job) { return message<web::CleanPicture>(get(path(job))); }
  web::CleanPicture wait_until_filtered(std::uint64_t job) {
    web::CleanPicture now = state(job);
    while (now.state() == "filtering") {
      std::this_thread::yield();
      now = state(job);
    }
    return now;
  }
};

TEST_F(CleanPicturesTest, AreMadeWhenTheFarmHasRenderedTheGuides) {
  const std::uint64_t job = submit_box();
  EXPECT_EQ(state(job).state(), "none");
  EXPECT_EQ(post(path(job))->status, 409);  // not finished
  finish(job, /*width=*/24, /*height=*/16);
  EXPECT_EQ(get(path(job, ".png"))->status, 409);  // the picture was not requested
  EXPECT_EQ(message<web::CleanPicture>(post(path(job))).state(), "guides");
  EXPECT_EQ(message<web::CleanPicture>(post(path(job))).state(), "guides");  // starts no more jobs
  EXPECT_EQ(state(job).state(), "guides");
  finish(job + 1, 24, 16, /*samples=*/1);
  EXPECT_EQ(state(job).fraction(), 0.5);
  finish(job + 2, 24, 16, /*samples=*/1);
  const web::CleanPicture ready = wait_until_filtered(job);
  EXPECT_EQ(ready.state(), "ready") << ready.reason();
  EXPECT_EQ(ready.relative_rmse_raw(), 0);  // all samples are equal
  EXPECT_EQ(get(path(job, ".png"))->header("Content-Type"), "image/png");
  EXPECT_THAT(get(path(job, ".png?side=8"))->body, StartsWith("\x89PNG"));
  const auto exr = get(path(job, ".exr"));
  ASSERT_TRUE(exr);
  EXPECT_THAT(exr->body, HasSubstr("raw.R"));
  EXPECT_THAT(exr->body, HasSubstr("error.Z"));
  EXPECT_THAT(get(path(job, ".pfm"))->body, StartsWith("PF\n24 16\n"));
  // The page does not list the guides as jobs.
  const auto overview = message<web::Overview>(get("/api/farm"));
  ASSERT_EQ(overview.job_size(), 1);
  EXPECT_EQ(overview.job(0).status().job(), job);
}

TEST_F(CleanPicturesTest, SayWhyTheyFailedAndAreTriedAgain) {
  const std::uint64_t job = submit_box();
  finish(job, 24, 16);
  post(path(job));
  post("/api/jobs/" + std::to_string(job + 2) + "/cancel");
  const web::CleanPicture failed = state(job);
  EXPECT_EQ(failed.state(), "failed");
  EXPECT_THAT(failed.reason(), HasSubstr("cancelled"));
  EXPECT_EQ(message<web::CleanPicture>(post(path(job))).state(), "guides");
  finish(job + 1, 24, 16, /*samples=*/1);
  finish(job + 3, 24, 16, /*samples=*/1);  // replaces the cancelled guide
  EXPECT_EQ(wait_until_filtered(job).state(), "ready");
}

TEST_F(CleanPicturesTest, AreRefusedForJobsThatDoNotExist) {
  EXPECT_EQ(get(path(17))->status, 404);
  EXPECT_EQ(post(path(17))->status, 404);
  EXPECT_EQ(get(path(17, ".png"))->status, 409);
}

}  // namespace
}  // namespace bandsaw::coordinator
