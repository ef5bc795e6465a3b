// Tests the store of blobs (parts of scenes, named by their SHA-256 digests) on the coordinator's
// disk: uploads, interrupted uploads, damage, and a full disk.

#include "coordinator/store/blob_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <thread>

#include "proto/wire/limits.h"
#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/store/test_files.h"

namespace bandsaw::coordinator {
namespace {

class BlobStoreTest : public testing::Test {
 protected:
  std::unique_ptr<BlobStore> open() { return *BlobStore::open(folder_.path()); }

  /// Uploads a blob in two parts.
  static absl::Status put(BlobStore& store, const std::string& text) {
    absl::StatusOr<BlobStore::Writer> writer = store.write(wire::sha256(text), text.size());
    if (!writer.ok()) {
      return writer.status();
    }
    const std::string half = text.substr(0, text.size() / 2);
    if (absl::Status s = writer->append(bytes_of(half)); !s.ok()) {
      return s;
    }
    if (absl::Status s = writer->append(bytes_of(text.substr(half.size()))); !s.ok()) {
      return s;
    }
    return writer->commit();
  }

  /// Returns a text that is long enough that half of it is kept as a partial upload.
  static std::string long_text(char fill) { return std::string(2 * PartialBlobs::kMinBytes, fill); }
  /// Uploads the first half of a blob, and then abandons the upload.
  static void leave_half(BlobStore& store, const std::string& text) {
    absl::StatusOr<BlobStore::Writer> writer = store.write(wire::sha256(text), text.size());
    ASSERT_TRUE(writer.ok()) << writer.status();
    ASSERT_TRUE(writer->append(bytes_of(text.substr(0, text.size() / 2))).ok());
  }

  static std::string text_of(BlobStore& store, const wire::Digest& digest) {
    const absl::StatusOr<std::unique_ptr<BlobBytes>> blob = store.get(digest);
    EXPECT_TRUE(blob.ok()) << blob.status();
    const absl::Span<const std::byte> bytes = (*blob)->bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  /// Returns the path of a blob's file.
  std::string file_of(const wire::Digest& digest) const {
    return folder_ / (digest.hex().substr(0, 2) + "/" + digest.hex());
  }
  /// Returns the number of files in the store.
  std::size_t files() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
      count += entry.is_regular_file() ? 1 : 0;
    }
    return count;
  }

  test::TempDir folder_;
};

TEST_F(BlobStoreTest, ReturnsStoredBlobsAlsoAfterARestart) {
  for (const std::string& text : {std::string(), std::string("a"), std::string(100'000, 'b')}) {
    const wire::Digest digest = wire::sha256(text);
    {
      const auto store = open();
      EXPECT_FALSE(store->has(digest));
      ASSERT_TRUE(put(*store, text).ok());
      ASSERT_TRUE(put(*store, text).ok()) << "a second upload of the same blob must succeed";
      EXPECT_TRUE(store->has(digest));
      EXPECT_EQ(text_of(*store, digest), text);
    }
    EXPECT_EQ(text_of(*open(), digest), text);
  }
}

TEST_F(BlobStoreTest, AnUnknownBlobIsNotFound) {
  EXPECT_EQ(open()->get(wire::sha256("nothing")).status().code(), absl::StatusCode::kNotFound);
}

TEST_F(BlobStoreTest, WrongBytesAndWrongSizesAreRefusedAndLeaveNothing) {
  const auto store = open();
  const wire::Digest digest = wire::sha256("right");
  {
    auto writer = store->write(digest, 5);
    ASSERT_TRUE(writer->append(bytes_of("wrong")).ok());
    EXPECT_EQ(writer->commit().code(), absl::StatusCode::kInvalidArgument);
  }
  {
    auto writer = store->write(digest, 4);
    EXPECT_EQ(writer->append(bytes_of("right")).code(), absl::StatusCode::kInvalidArgument);
  }
  {
    auto writer = store->write(digest, 6);
    ASSERT_TRUE(writer->append(bytes_of("right")).ok());
    EXPECT_EQ(writer->commit().code(), absl::StatusCode::kInvalidArgument);
  }
  { ASSERT_TRUE(store->write(digest, 5)->append(bytes_of("rig")).ok()); }
  EXPECT_FALSE(store->has(digest));
  EXPECT_EQ(files(), 0u);
}

// If an interrupted upload can continue, the name of its file is the digest and ".part". The file
// "7" is of an upload that cannot continue.
TEST_F(BlobStoreTest, AnUploadThatCannotContinueIsRemovedAtTheNextStart) {
  open();
  write_all(folder_ / "incoming/7", "half");
  open();
  EXPECT_EQ(files(), 0u);
}

TEST_F(BlobStoreTest, AnInterruptedUploadContinuesAfterARestart) {
  const std::string text = long_text('a');
  const wire::Digest digest = wire::sha256(text);
  leave_half(*open(), text);
  const auto store = open();
  ASSERT_EQ(store->partial(digest), text.size() / 2);
  EXPECT_FALSE(store->has(digest));
  auto writer = store->write(digest, text.size(), text.size() / 2);
  ASSERT_TRUE(writer.ok()) << writer.status();
  EXPECT_EQ(store->partial(digest), 0u)
      << "a part must not be offered while an upload continues it";
  ASSERT_TRUE(writer->append(bytes_of(text.substr(text.size() / 2))).ok());
  ASSERT_TRUE(writer->commit().ok());
  EXPECT_EQ(text_of(*store, digest), text);
}

TEST_F(BlobStoreTest, AnUploadMayContinueBeforeTheEndOfItsPartButNotBeyond) {
  const std::string text = long_text('b');
  const wire::Digest digest = wire::sha256(text);
  const auto store = open();
  leave_half(*store, text);
  EXPECT_EQ(store->write(digest, text.size(), text.size() / 2 + 1).status().code(),
            absl::StatusCode::kFailedPrecondition);
  auto writer = store->write(digest, text.size(), 10);
  ASSERT_TRUE(writer->append(bytes_of(text.substr(10))).ok());
  EXPECT_TRUE(writer->commit().ok());
}

TEST_F(BlobStoreTest, ARefusedUploadLeavesNoFile) {
  const std::string text = long_text('b');
  const auto store = open();
  const absl::Status status = store->write(wire::sha256(text), text.size(), 10).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()), testing::HasSubstr("0 bytes are there, not 10"));
  EXPECT_EQ(files(), 0u);
}

TEST_F(BlobStoreTest, ADamagedPartIsReportedAndRemoved) {
  const std::string text = long_text('c');
  const wire::Digest digest = wire::sha256(text);
  const auto store = open();
  leave_half(*store, text);
  write_all(folder_ / ("incoming/" + digest.hex() + ".part"), std::string(text.size() / 2, 'x'));
  {
    auto writer = store->write(digest, text.size(), text.size() / 2);
    ASSERT_TRUE(writer->append(bytes_of(text.substr(text.size() / 2))).ok());
    const absl::Status status = writer->commit();
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr(digest.hex()));
  }
  EXPECT_EQ(store->partial(digest), 0u);
  EXPECT_TRUE(put(*store, text).ok());
}

TEST_F(BlobStoreTest, PartsAreLimitedInNumberAndAge) {
  const auto store = open();
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < wire::kPartialBlobs + 2; ++i) {
    texts.push_back(long_text('d') + std::to_string(i));
    leave_half(*store, texts.back());
  }
  EXPECT_EQ(files(), wire::kPartialBlobs);
  EXPECT_EQ(store->partial(wire::sha256(texts.front())), 0u);
  EXPECT_GT(store->partial(wire::sha256(texts.back())), 0u);
  const double now = static_cast<double>(std::time(nullptr));
  store->remove_partials(now, 60);  // removes parts older than 60 s
  EXPECT_EQ(files(), wire::kPartialBlobs);
  store->remove_partials(now + 100, 60);
  EXPECT_EQ(files(), 0u);
}

TEST_F(BlobStoreTest, APartThatIsRemovedForItsSizeDoesNotCount) {
  const auto store = open();
  leave_half(*store, long_text('e'));
  // These files have no blocks on the disk.
  for (std::size_t i = 0; i < wire::kPartialBlobs; ++i) {
    const auto file = folder_ / ("incoming/" + wire::sha256(std::to_string(i)).hex() + ".part");
    write_all(file, "");
    std::filesystem::resize_file(file, wire::kPartialBytes + 1);
  }
  leave_half(*store, long_text('f'));
  EXPECT_EQ(files(), 2U) << "both small parts must be kept";
}

TEST_F(BlobStoreTest, ADamagedFileIsDataLossAndCanBeSentAgain) {
  const std::string text = "some geometry";
  const wire::Digest digest = wire::sha256(text);
  ASSERT_TRUE(put(*open(), text).ok());
  write_all(file_of(digest), "some geometrY");
  const auto store = open();
  EXPECT_EQ(store->get(digest).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_FALSE(store->has(digest)) << "a damaged blob must count as missing";
  ASSERT_TRUE(put(*store, text).ok());
  EXPECT_EQ(text_of(*store, digest), text);
}

// The file is read in pieces of 1 MiB to compute its digest.
TEST_F(BlobStoreTest, DamageAtAnyPlaceIsDataLoss) {
  const std::string text = long_text('e') + std::string(3 << 20, 'f');
  const wire::Digest digest = wire::sha256(text);
  for (const std::size_t at : {std::size_t{0}, text.size() / 2, text.size() - 1}) {
    ASSERT_TRUE(put(*open(), text).ok());
    EXPECT_EQ(text_of(*open(), digest), text);
    std::string damaged = text;
    damaged[at] = 'x';
    write_all(file_of(digest), damaged);
    EXPECT_EQ(open()->get(digest).status().code(), absl::StatusCode::kDataLoss) << "byte " << at;
  }
}

TEST_F(BlobStoreTest, AFullDiskIsDetectedBeforeTheUpload) {
  const auto store = open();
  const std::string text(100'000, 'x');
  {
    const test::FullDisk full(1000);
    EXPECT_EQ(store->write(wire::sha256(text), text.size()).status().code(),
              absl::StatusCode::kResourceExhausted);
  }
  EXPECT_EQ(files(), 0u);
  EXPECT_TRUE(put(*store, text).ok());
}

TEST_F(BlobStoreTest, ManyThreadsMayPutAndGetTheSameBlob) {
  const auto store = open();
  const std::string text(10'000, 'y');
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      EXPECT_TRUE(put(*store, text).ok());
      EXPECT_EQ(text_of(*store, wire::sha256(text)), text);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(files(), 1u);
}

}  // namespace
}  // namespace bandsaw::coordinator
