// Tests the cache of blobs (parts of scenes, named by their SHA-256 digests) on a worker's disk.
// Several workers of one machine may share the cache.

#include "worker/cache/blob_cache.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/temp_dir.h"

namespace bandsaw::worker {
namespace {

/// Returns the content of a blob: `size` bytes with the value `fill`.
std::vector<std::byte> bytes_of(char fill, std::size_t size = 1000) {
  return std::vector<std::byte>(size, static_cast<std::byte>(fill));
}

/// A small disk in memory, mounted at `folder`, which is created. The destructor unmounts it.
class SmallDisk {
 public:
  /// `options`: tmpfs's mount options, which limit the disk, such as "size=256k".
  SmallDisk(std::string folder, const char* options) : folder_(std::move(folder)) {
    std::filesystem::create_directory(folder_);
    is_mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, options) == 0;
  }
  ~SmallDisk() {
    if (is_mounted_) {
      ::umount2(folder_.c_str(), MNT_DETACH);
    }
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  /// False if this user may not mount.
  bool is_mounted() const { return is_mounted_; }

 private:
  std::string folder_;
  bool is_mounted_ = false;
};

class BlobCacheTest : public ::testing::Test {
 protected:
  std::unique_ptr<BlobCache> open(std::uint64_t max_bytes = 1 << 30) {
    return *BlobCache::open(folder_ / "cache", max_bytes);
  }
  std::string path_of(const wire::Digest& digest) { return folder_ / "cache/" + digest.hex(); }

  static void put(BlobCache& cache, const std::vector<std::byte>& bytes) {
    auto download = cache.begin(wire::sha256(bytes));
    ASSERT_TRUE(download.ok()) << download.status();
    ASSERT_NE(*download, nullptr);
    ASSERT_TRUE((*download)->append(bytes).ok());
    ASSERT_TRUE((*download)->commit().ok());
  }
  /// Sets the time of the last use to `seconds` ago, so that no test waits.
  void set_age(const wire::Digest& digest, int seconds) {
    timespec times[2];
    clock_gettime(CLOCK_REALTIME, &times[0]);
    times[0].tv_sec -= seconds;
    times[1] = times[0];
    ASSERT_EQ(utimensat(AT_FDCWD, path_of(digest).c_str(), times, 0), 0);
  }

  test::TempDir folder_;
};

TEST_F(BlobCacheTest, ReturnsStoredBlobs) {
  const auto cache = open();
  const auto bytes = bytes_of('a');
  EXPECT_FALSE(cache->has(wire::sha256(bytes)));
  EXPECT_EQ(cache->get(wire::sha256(bytes)).status().code(), absl::StatusCode::kNotFound);
  put(*cache, bytes);
  EXPECT_TRUE(cache->has(wire::sha256(bytes)));
  const auto blob = cache->get(wire::sha256(bytes));
  ASSERT_TRUE(blob.ok()) << blob.status();
  EXPECT_EQ((*blob)->bytes(), absl::MakeConstSpan(bytes));
}

TEST_F(BlobCacheTest, TakesAnEmptyBlob) {
  const auto cache = open();
  put(*cache, {});
  EXPECT_TRUE(cache->get(wire::sha256(std::string())).ok());
}

TEST_F(BlobCacheTest, KeepsBlobsOverARestart) {
  const auto bytes = bytes_of('a');
  put(*open(), bytes);
  EXPECT_TRUE(open()->get(wire::sha256(bytes)).ok());
}

TEST_F(BlobCacheTest, ContinuesAnInterruptedDownload) {
  const auto bytes = bytes_of('a');
  const auto digest = wire::sha256(bytes);
  ASSERT_TRUE((*open()->begin(digest))->append(absl::MakeConstSpan(bytes).first(300)).ok());
  const auto cache = open();
  EXPECT_FALSE(cache->has(digest)) << "a partial download must not count as a blob";
  auto download = *cache->begin(digest);
  EXPECT_EQ(download->offset(), 300U);
  ASSERT_TRUE(download->append(absl::MakeConstSpan(bytes).subspan(300)).ok());
  ASSERT_TRUE(download->commit().ok());
  EXPECT_TRUE(cache->get(digest).ok());
}

TEST_F(BlobCacheTest, RemovesBytesWithAWrongDigest) {
  const auto cache = open();
  const auto digest = wire::sha256(bytes_of('a'));
  auto download = *cache->begin(digest);
  ASSERT_TRUE(download->append(bytes_of('b')).ok());
  EXPECT_EQ(download->commit().code(), absl::StatusCode::kDataLoss);
  download.reset();
  EXPECT_FALSE(cache->has(digest));
  EXPECT_EQ((*cache->begin(digest))->offset(), 0U);
}

TEST_F(BlobCacheTest, RemovesADamagedBlob) {
  const auto cache = open();
  const auto bytes = bytes_of('a');
  const auto digest = wire::sha256(bytes);
  put(*cache, bytes);
  std::ofstream(path_of(digest)) << "damaged";
  EXPECT_EQ(cache->get(digest).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_FALSE(cache->has(digest));
  put(*cache, bytes);
  EXPECT_TRUE(cache->get(digest).ok());
}

TEST_F(BlobCacheTest, RemovesTheLeastRecentlyUsedBlob) {
  const auto cache = open(3000);
  const auto a = wire::sha256(bytes_of('a'));
  const auto b = wire::sha256(bytes_of('b'));
  for (const char fill : {'a', 'b', 'c'}) {
    put(*cache, bytes_of(fill));
  }
  set_age(a, 30);
  set_age(b, 20);
  EXPECT_TRUE(cache->get(a).ok());  // marks a as used, so b is the oldest now
  put(*cache, bytes_of('d'));
  EXPECT_TRUE(cache->has(a));
  EXPECT_FALSE(cache->has(b));
  EXPECT_TRUE(cache->has(wire::sha256(bytes_of('d'))));
}

TEST_F(BlobCacheTest, CountsBlobsThatOtherWorkersAddToTheFolder) {
  const auto mine = open(3000);
  const auto theirs = open(3000);
  put(*mine, bytes_of('a'));
  put(*mine, bytes_of('b'));
  set_age(wire::sha256(bytes_of('a')), 30);
  put(*theirs, bytes_of('c'));
  put(*theirs, bytes_of('d'));
  EXPECT_FALSE(mine->has(wire::sha256(bytes_of('a'))));
  for (const char fill : {'b', 'c', 'd'}) {
    EXPECT_TRUE(mine->has(wire::sha256(bytes_of(fill)))) << fill;
  }
}

TEST_F(BlobCacheTest, KeepsANewBlobThatIsLargerThanTheLimit) {
  const auto cache = open(500);
  put(*cache, bytes_of('a'));
  EXPECT_TRUE(cache->get(wire::sha256(bytes_of('a'))).ok())
      << "the new blob must be kept, because it is needed now";
  put(*cache, bytes_of('b'));
  EXPECT_FALSE(cache->has(wire::sha256(bytes_of('a'))));
}

TEST_F(BlobCacheTest, MakesARemovedFolderAgain) {
  const auto cache = open();
  put(*cache, bytes_of('a'));
  std::filesystem::remove_all(folder_ / "cache");
  EXPECT_FALSE(cache->has(wire::sha256(bytes_of('a'))));
  put(*cache, bytes_of('b'));
  EXPECT_TRUE(cache->get(wire::sha256(bytes_of('b'))).ok());
}

// The disk may be full before the cache has reached its limit.
TEST_F(BlobCacheTest, FreesSpaceOnAFullDisk) {
  const SmallDisk disk(folder_ / "cache", "size=256k");
  if (!disk.is_mounted()) {
    GTEST_SKIP() << "a small disk needs root";
  }
  const auto cache = open();
  for (const char fill : {'a', 'b', 'c', 'd'}) {
    put(*cache, bytes_of(fill, 100 << 10));
  }
  EXPECT_TRUE(cache->get(wire::sha256(bytes_of('d', 100 << 10))).ok());
  EXPECT_FALSE(cache->has(wire::sha256(bytes_of('a', 100 << 10))));
  auto download = *cache->begin(wire::sha256(std::vector<std::byte>(1 << 20)));
  EXPECT_EQ(download->append(std::vector<std::byte>(1 << 20)).code(),
            absl::StatusCode::kResourceExhausted);
}

// A hole in a file can be read on a full disk: read() returns zeros. But if the file is mapped into
// memory and the disk is full, access to the hole raises SIGBUS, which ends the process. A bad
// sector of the disk has the same effect.
TEST_F(BlobCacheTest, RemovesABlobThatCannotBeMapped) {
  const SmallDisk disk(folder_ / "cache", "size=256k");
  if (!disk.is_mounted()) {
    GTEST_SKIP() << "a small disk needs root";
  }
  const auto cache = open();
  const auto digest = wire::sha256(bytes_of('a', 100 << 10));
  put(*cache, bytes_of('a', 100 << 10));
  std::filesystem::resize_file(path_of(digest), 0);
  std::filesystem::resize_file(path_of(digest), 100 << 10);
  std::ofstream(folder_ / "cache/thesis.tex") << std::string(300 << 10, 'x');
  EXPECT_EQ(cache->get(digest).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_FALSE(cache->has(digest));
}

// The folder itself takes one of the four inodes.
TEST_F(BlobCacheTest, FreesInodesOnAFullDisk) {
  const SmallDisk disk(folder_ / "cache", "nr_inodes=4");
  if (!disk.is_mounted()) {
    GTEST_SKIP() << "a small disk needs root";
  }
  const auto cache = open();
  for (const char fill : {'a', 'b', 'c', 'd'}) {
    put(*cache, bytes_of(fill));
  }
  EXPECT_TRUE(cache->get(wire::sha256(bytes_of('d'))).ok());
  EXPECT_FALSE(cache->has(wire::sha256(bytes_of('a'))));
}

TEST_F(BlobCacheTest, ReportsADiskWithoutInodes) {
  const SmallDisk disk(folder_ / "cache", "nr_inodes=1");
  if (!disk.is_mounted()) {
    GTEST_SKIP() << "a small disk needs root";
  }
  EXPECT_EQ(open()->begin(wire::sha256(bytes_of('a'))).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST_F(BlobCacheTest, DoesNotRemoveForeignFiles) {
  std::filesystem::create_directory(folder_ / "cache");
  std::ofstream(folder_ / "cache/thesis.tex") << std::string(5000, 'x');
  const auto cache = open(1500);
  put(*cache, bytes_of('a'));
  put(*cache, bytes_of('b'));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cache/thesis.tex"));
  EXPECT_TRUE(cache->has(wire::sha256(bytes_of('b'))));
}

TEST_F(BlobCacheTest, LetsOnlyOneOfTwoWorkersDownload) {
  const auto mine = open();
  const auto theirs = open();
  const auto bytes = bytes_of('a');
  auto download = *mine->begin(wire::sha256(bytes));
  EXPECT_EQ(*theirs->begin(wire::sha256(bytes)), nullptr);
  ASSERT_TRUE(download->append(bytes).ok());
  ASSERT_TRUE(download->commit().ok());
  EXPECT_TRUE(theirs->get(wire::sha256(bytes)).ok());
}

TEST_F(BlobCacheTest, KeepsBlobsThatAreBeingDownloaded) {
  const auto cache = open(500);
  const auto bytes = bytes_of('a');
  auto download = *cache->begin(wire::sha256(bytes));
  ASSERT_TRUE(download->append(absl::MakeConstSpan(bytes).first(300)).ok());
  put(*open(500), bytes_of('b'));
  ASSERT_TRUE(download->append(absl::MakeConstSpan(bytes).subspan(300)).ok());
  EXPECT_TRUE(download->commit().ok());
  EXPECT_TRUE(cache->has(wire::sha256(bytes)));
}

// Four workers use nine blobs in a cache that has space for four.
TEST_F(BlobCacheTest, IsSafeWithManyWorkersAndLittleSpace) {
  std::vector<std::thread> workers;
  for (int w = 0; w < 4; ++w) {
    workers.emplace_back([&, w] {
      const auto cache = open(4000);
      for (int i = 0; i < 100; ++i) {
        const auto bytes = bytes_of(static_cast<char>('a' + (i * (w + 1)) % 9));
        const auto digest = wire::sha256(bytes);
        if (const auto got = cache->get(digest); got.ok()) {
          EXPECT_EQ((*got)->bytes(), absl::MakeConstSpan(bytes));
          continue;
        }
        auto download = cache->begin(digest);
        ASSERT_TRUE(download.ok()) << download.status();
        // begin() returns a null pointer while another worker downloads this blob.
        if (*download != nullptr && (*download)->offset() == 0) {
          ASSERT_TRUE((*download)->append(bytes).ok());
          EXPECT_TRUE((*download)->commit().ok())
              << "no other worker may have removed the partial file";
        }
      }
    });
  }
  for (std::thread& worker : workers) {
    worker.join();
  }
}

TEST_F(BlobCacheTest, NamesTheFolderThatItCannotUse) {
  std::ofstream(folder_ / "file") << "x";
  const absl::Status status = BlobCache::open(folder_ / "file", 1000).status();
  EXPECT_FALSE(status.ok());
  EXPECT_NE(std::string(status.message()).find(folder_ / "file"), std::string::npos);
}

}  // namespace
}  // namespace bandsaw::worker
