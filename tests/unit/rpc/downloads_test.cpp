// Concurrent downloads of images and scenes. A budget, engine_->images(), limits the memory of
// images that are being sent. Downloads of scenes do not wait for threads that images occupy.

#include <gmock/gmock.h>

#include <future>
#include <thread>

#include "tests/support/pattern.h"
#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

using grpc::StatusCode;
using ::testing::HasSubstr;

constexpr std::uint32_t kSide = 1024;
constexpr std::int64_t kImageBytes = std::int64_t{kSide} * kSide * 3 * sizeof(float);

class DownloadsTest : public FarmTest {
 protected:
  using Reader = std::unique_ptr<grpc::ClientReader<farm::ResultChunk>>;

  Reader get_result(grpc::ClientContext& call, std::uint64_t job) {
    farm::GetResultRequest request;
    request.set_job(job);
    return people()->GetResult(&call, request);
  }
  Reader preview(grpc::ClientContext& call, std::uint64_t job) {
    farm::PreviewRequest request;
    request.set_job(job);
    return people()->Preview(&call, request);
  }
  /// Downloads everything and returns the status.
  static grpc::Status read_all(const Reader& reader, std::size_t* bytes = nullptr) {
    farm::ResultChunk chunk;
    while (reader->Read(&chunk)) {
      if (bytes != nullptr) {
        *bytes += chunk.data().size();
      }
    }
    return reader->Finish();
  }
  grpc::Status whole_result(std::uint64_t job) {
    const auto call = context(link::Role::kFarm);
    return read_all(get_result(*call, job));
  }
  /// Waits until exactly this number of bytes of the budget is free.
  void wait_until_left(std::int64_t bytes) {
    while (engine_->images().left() != bytes) {
      std::this_thread::yield();
    }
  }
};

TEST_F(DownloadsTest, AnImageIsInTheMemoryBudgetWhileItIsDownloaded) {
  const std::uint64_t job = finish_job(kSide);
  const std::int64_t all = engine_->images().left();
  const auto call = context(link::Role::kFarm);
  const Reader slow = get_result(*call, job);  // the client does not read yet
  wait_until_left(all - kImageBytes);

  // Other images take so much of the budget that one byte is missing for a second download. The
  // image has exactly 12 MiB.
  auto others = engine_->images().take(static_cast<std::uint64_t>(all - 2 * kImageBytes + 1));
  ASSERT_TRUE(others);
  const grpc::Status refused = whole_result(job);
  EXPECT_EQ(refused.error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(refused.error_message(), HasSubstr("of 12 MiB;"));
  EXPECT_THAT(refused.error_message(), HasSubstr("try again when a download has ended"));
  others.reset();
  EXPECT_TRUE(whole_result(job).ok());

  std::size_t bytes = 0;
  EXPECT_TRUE(read_all(slow, &bytes).ok());
  EXPECT_EQ(bytes, static_cast<std::size_t>(kImageBytes));
  wait_until_left(all);
}

TEST_F(DownloadsTest, ACancelledDownloadFreesTheMemory) {
  const std::uint64_t job = finish_job(kSide);
  const std::int64_t all = engine_->images().left();
  const auto call = context(link::Role::kFarm);
  const Reader slow = get_result(*call, job);
  wait_until_left(all - kImageBytes);
  call->TryCancel();
  EXPECT_EQ(read_all(slow).error_code(), StatusCode::CANCELLED);
  wait_until_left(all);
}

// A preview is refused if only 1,000 bytes of the budget are free, whether the job is done or runs.
TEST_F(DownloadsTest, APreviewCountsWithItsActualSize) {
  const std::uint64_t done = finish_job(kSide);
  const std::uint64_t running = submit_job(kSide);
  put_rows(running, kSide, 0, kSide / 2);
  const std::int64_t all = engine_->images().left();
  for (const std::uint64_t job : {done, running}) {
    const auto others = engine_->images().take(static_cast<std::uint64_t>(all - 1000));
    ASSERT_TRUE(others);
    const auto call = context(link::Role::kFarm);
    EXPECT_EQ(read_all(preview(*call, job)).error_code(), StatusCode::RESOURCE_EXHAUSTED);
  }
  for (const std::uint64_t job : {done, running}) {
    const auto call = context(link::Role::kFarm);
    EXPECT_TRUE(read_all(preview(*call, job)).ok());
  }
  wait_until_left(all);
}

// The film holds the image of a running job and has its own thread. Workers get their scenes
// however many previews wait for this thread.
TEST_F(DownloadsTest, ScenesAreSentWhilePreviewsWaitForTheFilm) {
  const std::uint64_t job = submit_job(kSide);
  put_rows(job, kSide, 0, kSide / 2);
  const std::string scene = test::pattern(1 << 20);
  ASSERT_TRUE(put_blob({whole(scene)}).ok());

  std::promise<void> release;
  const std::shared_future<void> released = release.get_future().share();
  std::promise<void> held;
  engine_->preview(job, 1, [&](const absl::StatusOr<Image>&) {  // on the film's thread
    held.set_value();
    released.wait();
  });
  held.get_future().wait();
  std::vector<std::unique_ptr<grpc::ClientContext>> calls;
  std::vector<Reader> previews;
  for (int i = 0; i < 8; ++i) {
    calls.push_back(context(link::Role::kFarm));
    previews.push_back(preview(*calls.back(), job));
  }

  const auto call = context(link::Role::kWorker);
  call->set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
  farm::GetBlobRequest request;
  request.set_sha256(wire::sha256(scene).raw());
  const auto blob = work()->GetBlob(call.get(), request);
  std::string got;
  for (farm::BlobChunk chunk; blob->Read(&chunk);) {
    got += chunk.data();
  }
  const grpc::Status status = blob->Finish();
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_TRUE(got == scene);
  release.set_value();
  for (const Reader& one : previews) {
    EXPECT_TRUE(read_all(one).ok());
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
