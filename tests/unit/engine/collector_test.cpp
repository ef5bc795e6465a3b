// Tests the collector. It forgets final jobs by age, bytes and number, and then removes the blobs
// (files of scenes, named by their digests) that no known job needs. By default it keeps jobs for
// 30 days and unused blobs for one day. A KeptJob has the members id, final (true or false),
// manifests and frame jobs.

#include "coordinator/engine/collector.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "renderlib/base/file.h"
#include "renderlib/package/package.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kNow = 2e9;  // seconds since 1970
constexpr double kDay = 24 * 60 * 60;

class CollectorTest : public testing::Test {
 protected:
  CollectorTest()
      : folder_(*DataFolder::open(temp_ / "data")), blobs_(*BlobStore::open(folder_.blobs())) {}

  static void set_time(const std::string& path, double seconds) {
    const timespec time{static_cast<time_t>(seconds), 0};
    const timespec times[2] = {time, time};
    ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0) << path;
  }

  /// Stores a blob that was last used at the time `at`.
  wire::Digest put(const std::string& text, double at) {
    const wire::Digest digest = wire::sha256(text);
    auto writer = blobs_->write(digest, text.size());
    EXPECT_TRUE(
        writer->append({reinterpret_cast<const std::byte*>(text.data()), text.size()}).ok());
    EXPECT_TRUE(writer->commit().ok());
    set_time(folder_.blobs() + "/" + digest.hex().substr(0, 2) + "/" + digest.hex(), at);
    return digest;
  }

  /// Stores a package with this name, and returns the digest of its manifest. All packages share
  /// the blobs of one scene.
  DigestHex package(const std::string& name) {
    BlobMap blobs;
    PackageInfo info;
    info.name = name;
    const std::string manifest = encode_package(test::cornell_box().scene, info, blobs);
    for (const auto& [digest, bytes] : blobs.all()) {
      put({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, kNow - 100 * kDay);
    }
    return put(manifest, kNow - 100 * kDay).hex();
  }

  /// Stores a result of `bytes` bytes, of a job that ended at the time `at`.
  void result(JobId job, std::size_t bytes, double at) {
    ASSERT_TRUE(make_folder(folder_.job(job)).ok());
    std::ofstream(folder_.result(job)) << std::string(bytes, 'x');
    set_time(folder_.job(job), at);
  }

  Collector collector(const Keep& keep) { return Collector(folder_, *blobs_, keep); }

  test::TempDir temp_;
  DataFolder folder_;
  std::unique_ptr<BlobStore> blobs_;
};

TEST_F(CollectorTest, ForgetsFinalJobsByAge) {
  result(1, 10, kNow - 31 * kDay);
  result(2, 10, kNow - 29 * kDay);
  result(3, 10, kNow - 90 * kDay);
  EXPECT_THAT(
      collector({}).to_forget({{1, true, {}, {}}, {2, true, {}, {}}, {3, false, {}, {}}}, kNow),
      ElementsAre(1));
}

// If a final job has no folder, to_forget() makes one. The time of the folder then tells the age of
// the job.
TEST_F(CollectorTest, KeepsJobsWithoutFilesAsLongAsOthers) {
  const std::vector<KeptJob> jobs = {{1, true, {}, {}}};
  EXPECT_THAT(collector({}).to_forget(jobs, kNow), IsEmpty());
  set_time(folder_.job(1), kNow - 29 * kDay);
  EXPECT_THAT(collector({}).to_forget(jobs, kNow), IsEmpty());
  set_time(folder_.job(1), kNow - 31 * kDay);
  EXPECT_THAT(collector({}).to_forget(jobs, kNow), ElementsAre(1));
}

TEST_F(CollectorTest, ForgetsTheOldestJobsBeyondTheMaximumBytes) {
  for (const JobId job : {1, 2, 3}) {
    result(job, 1'000, kNow - static_cast<double>(10 - job) * kDay);
  }
  const std::vector<KeptJob> jobs = {{1, true, {}, {}}, {2, true, {}, {}}, {3, true, {}, {}}};
  EXPECT_THAT(collector({.bytes = 2'500}).to_forget(jobs, kNow), ElementsAre(1));
  EXPECT_THAT(collector({.bytes = 1'500}).to_forget(jobs, kNow), ElementsAre(1, 2));
  EXPECT_THAT(collector({}).to_forget(jobs, kNow), IsEmpty());
  std::ofstream(folder_.samples(3)) << std::string(1'000, 'x');
  set_time(folder_.job(3), kNow - 7 * kDay);
  EXPECT_THAT(collector({.bytes = 2'500}).to_forget(jobs, kNow), ElementsAre(1, 2));
}

// Job 1 has one file of 1,000 bytes, and job 2 has three. So the jobs have 4,000 bytes together.
TEST_F(CollectorTest, CountsAllFilesOfAJob) {
  result(1, 1'000, kNow - 9 * kDay);
  result(2, 1'000, kNow - 8 * kDay);
  for (const std::string& path : {folder_.first(2), folder_.attribution(2)}) {
    std::ofstream(path) << std::string(1'000, 'x');
  }
  set_time(folder_.job(2), kNow - 8 * kDay);
  const std::vector<KeptJob> jobs = {{1, true, {}, {}}, {2, true, {}, {}}};
  EXPECT_THAT(collector({.bytes = 3'500}).to_forget(jobs, kNow), ElementsAre(1));
}

// For an hour after its end, a job is not forgotten because of its bytes. So job 2, which ended a
// minute ago, stays, although the stored blob alone exceeds the maximum of 10 bytes.
TEST_F(CollectorTest, AFreshResultIsNotForgottenForItsSize) {
  result(1, 1'000, kNow - kDay);
  result(2, 1'000, kNow - 60);
  put("a large scene of a job that is not final", kNow);
  EXPECT_THAT(collector({.bytes = 10})
                  .to_forget({{1, true, {}, {}}, {2, true, {}, {}}, {3, false, {}, {}}}, kNow),
              ElementsAre(1));
}

TEST_F(CollectorTest, ForgetsTheOldestJobsBeyondTheMaximumNumber) {
  std::vector<KeptJob> jobs;
  for (const JobId job : {1, 2, 3, 4}) {
    result(job, 1, kNow - kDay);
    jobs.push_back({job, job != 2, {}, {}});
  }
  EXPECT_THAT(collector({.jobs = 2}).to_forget(jobs, kNow), ElementsAre(1));
  EXPECT_THAT(collector({.jobs = 1}).to_forget(jobs, kNow), ElementsAre(1, 3));
  EXPECT_THAT(collector({.jobs = 3}).to_forget(jobs, kNow), IsEmpty());
}

TEST_F(CollectorTest, NeverRemovesBlobsOfKnownJobs) {
  const DigestHex one = package("one");
  const DigestHex two = package("two");
  collector({}).sweep({{1, false, {one}, {}}}, kNow);
  EXPECT_TRUE(blobs_->has(*wire::digest_from_hex(one)));
  EXPECT_FALSE(blobs_->has(*wire::digest_from_hex(two)));
  const auto bytes = blobs_->get(*wire::digest_from_hex(one));
  ASSERT_TRUE(bytes.ok());
  const std::string manifest(reinterpret_cast<const char*>((*bytes)->bytes().data()),
                             (*bytes)->bytes().size());
  const auto refs = package_blobs(manifest);
  ASSERT_TRUE(refs.ok()) << refs.status();
  for (const BlobRef& blob : *refs) {
    EXPECT_TRUE(blobs_->has(blob.digest))
        << "a blob that package one shares with the removed package two must stay";
  }
}

TEST_F(CollectorTest, RemovesNothingWhileAManifestCannotBeRead) {
  const DigestHex one = package("one");
  const wire::Digest other = put("of no job that can be read", kNow - 2 * kDay);
  const std::string path = folder_.blobs() + "/" + one.substr(0, 2) + "/" + one;
  ASSERT_TRUE(std::filesystem::remove(path));
  ASSERT_TRUE(std::filesystem::create_directory(path));
  // A folder in the place of the manifest: it exists, but reading it fails.
  const absl::Status unreadable = blobs_->get(*wire::digest_from_hex(one)).status();
  ASSERT_FALSE(unreadable.ok() || absl::IsNotFound(unreadable)) << unreadable;
  collector({}).sweep({{1, false, {one}, {}}}, kNow);
  EXPECT_TRUE(blobs_->has(other));
  ASSERT_TRUE(std::filesystem::remove(path));
  collector({}).sweep({{1, false, {one}, {}}}, kNow);
  EXPECT_FALSE(blobs_->has(other)) << "a job whose manifest is missing needs no blobs";
}

TEST_F(CollectorTest, KeepsRecentlySentOrRequestedBlobs) {
  const wire::Digest old = put("old", kNow - 2 * kDay);
  const wire::Digest young = put("young", kNow - kDay / 2);
  const wire::Digest asked = put("asked", kNow - 2 * kDay);
  blobs_->touch(asked);  // sets the time of the blob's file to the real present, which is not kNow
  struct stat found {};
  ASSERT_EQ(
      stat((folder_.blobs() + "/" + asked.hex().substr(0, 2) + "/" + asked.hex()).c_str(), &found),
      0);
  EXPECT_GT(static_cast<double>(found.st_mtim.tv_sec), 1.7e9);  // the present, roughly
  EXPECT_NE(static_cast<double>(found.st_mtim.tv_sec), kNow - 2 * kDay);
  collector({}).sweep({}, kNow);
  EXPECT_FALSE(blobs_->has(old));
  EXPECT_TRUE(blobs_->has(young));
}

TEST_F(CollectorTest, RemovesFoldersOfForgottenJobs) {
  result(1, 10, kNow);
  result(2, 10, kNow);
  result(3, 10, kNow);
  collector({}).sweep({{2, true, {}, {}}}, kNow);
  EXPECT_FALSE(std::filesystem::exists(folder_.job(1)));
  EXPECT_TRUE(std::filesystem::exists(folder_.job(2)));
  EXPECT_TRUE(std::filesystem::exists(folder_.job(3)))
      << "a job with an id above all known ids may be new";
}

}  // namespace
}  // namespace bandsaw::coordinator
