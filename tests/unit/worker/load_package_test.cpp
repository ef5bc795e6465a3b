// A worker fetches a scene package (a manifest and the blobs that it names) from the coordinator.
// It fetches each byte once, also after lost connections.

#include "worker/executor/load_package.h"

#include <gtest/gtest.h>

#include <fstream>

#include "renderlib/package/package.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::worker {
namespace {

/// A coordinator with one package. It counts the bytes that it sends, and interrupts the next
/// `breaks_` transfers.
class LoadPackageTest : public ::testing::Test {
 protected:
  LoadPackageTest() {
    const std::string manifest = encode_package(test::cornell_box().scene, {}, farm_);
    const auto* data = reinterpret_cast<const std::byte*>(manifest.data());
    manifest_ = farm_.put(std::vector<std::byte>(data, data + manifest.size()));
    for (const auto& [digest, bytes] : farm_.all()) {
      total_ += bytes.size();
    }
  }

  /// Sends the bytes of a blob from `offset` on. An interrupted transfer sends half of these bytes.
  absl::Status transfer(const wire::Digest& digest, std::uint64_t offset, const TakeBytes& take) {
    const auto found = farm_.all().find(digest);
    if (found == farm_.all().end()) {
      return absl::NotFoundError("no such blob");
    }
    if (offset > found->second.size()) {
      return absl::InvalidArgumentError("offset: beyond the blob's end");
    }
    const auto rest = absl::MakeConstSpan(found->second).subspan(offset);
    const bool breaks = breaks_-- > 0;
    const auto sent = breaks ? rest.first(rest.size() / 2) : rest;
    bytes_sent_ += sent.size();
    if (absl::Status status = take(sent); !status.ok()) {
      return status;
    }
    return breaks ? absl::UnavailableError("broke off") : absl::OkStatus();
  }

  absl::StatusOr<std::shared_ptr<const Scene>> load(BlobCache& cache,
                                                    const wire::Digest& manifest) {
    const TransferBlob transfer_blob = [this](const wire::Digest& digest, std::uint64_t offset,
                                              const TakeBytes& take) {
      return transfer(digest, offset, take);
    };
    const Prepared prepared = [this](std::uint64_t now) {
      EXPECT_GT(now, prepared_);
      prepared_ = now;
    };
    FetchingSource source(cache, transfer_blob, stop_, prepared);
    return loader_.load(manifest, source);
  }
  std::unique_ptr<BlobCache> open(std::uint64_t max_bytes = 1 << 30) {
    return *BlobCache::open(folder_ / "cache", max_bytes);
  }

  test::TempDir folder_;
  BlobMap farm_;  ///< the blobs of the coordinator
  wire::Digest manifest_;
  std::uint64_t total_ = 0;  ///< bytes of the package
  std::uint64_t bytes_sent_ = 0;
  int breaks_ = 0;              ///< number of the next transfers that are interrupted
  std::uint64_t prepared_ = 0;  ///< the last progress that was reported; it MUST grow
  std::atomic<bool> stop_{false};
  Pool pool_{1};
  PackageLoader loader_{pool_};
};

TEST_F(LoadPackageTest, FetchesEachByteOnce) {
  const auto cache = open();
  const auto scene = load(*cache, manifest_);
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ((*scene)->features(), test::cornell_box().build()->features());
  EXPECT_EQ(bytes_sent_, total_);
  EXPECT_GT(prepared_, 0U);
}

TEST_F(LoadPackageTest, FetchesNothingAfterARestart) {
  ASSERT_TRUE(load(*open(), manifest_).ok());
  bytes_sent_ = 0;
  prepared_ = 0;
  EXPECT_TRUE(load(*open(), manifest_).ok());
  EXPECT_EQ(bytes_sent_, 0U);
}

TEST_F(LoadPackageTest, ContinuesAfterALostConnection) {
  breaks_ = 2;
  EXPECT_TRUE(load(*open(), manifest_).ok());
  EXPECT_EQ(bytes_sent_, total_);
}

TEST_F(LoadPackageTest, WorksWithACacheWithoutSpace) {
  EXPECT_TRUE(load(*open(1), manifest_).ok());
}

TEST_F(LoadPackageTest, FetchesADamagedBlobAgain) {
  ASSERT_TRUE(load(*open(), manifest_).ok());
  std::ofstream(folder_ / "cache/" + manifest_.hex()) << "damaged";
  prepared_ = 0;
  EXPECT_TRUE(load(*open(), manifest_).ok());
}

TEST_F(LoadPackageTest, FetchesABlobAgainIfItsPartialFileIsTooLong) {
  const auto cache = open();
  const std::string part = folder_ / ("cache/" + manifest_.hex() + ".part");
  std::ofstream(part) << std::string(farm_.all().at(manifest_).size() + 1, 'x');
  const auto scene = load(*cache, manifest_);
  EXPECT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ(bytes_sent_, total_);
}

TEST_F(LoadPackageTest, ReportsABlobThatTheFarmLacks) {
  EXPECT_EQ(load(*open(), wire::Digest()).status().code(), absl::StatusCode::kNotFound);
}

TEST_F(LoadPackageTest, RefusesAnInvalidManifest) {
  const wire::Digest nonsense = farm_.put(std::vector<std::byte>(100, std::byte{0xff}));
  EXPECT_EQ(load(*open(), nonsense).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(LoadPackageTest, ReadsAndBuildsOnceTheMeshThatTwoFramesShare) {
  const auto add = [&](const SceneDescription& scene) {
    const std::string text = encode_package(scene, {}, farm_);
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return farm_.put(std::vector<std::byte>(data, data + text.size()));
  };
  test::SceneMaker maker;
  maker.camera({0, 0, 9}, {0, 0, 0}, 40);
  maker.background({1, 1, 1}, {1, 1, 1});
  maker.instance(test::grid(40), Transform{}, maker.diffuse(0.5f));
  const wire::Digest first = add(maker.scene);
  maker.camera({1, 0, 9}, {0, 0, 0}, 40);
  const wire::Digest second = add(maker.scene);

  const auto cache = open();
  auto scene = load(*cache, first);
  ASSERT_TRUE(scene.ok()) << scene.status();
  prepared_ = 0;
  const auto next = load(*cache, second);
  ASSERT_TRUE(next.ok()) << next.status();
  EXPECT_EQ((*next)->geometry().meshes.shared(0), (*scene)->geometry().meshes.shared(0));
  const std::uint64_t of_one_blob = prepared_;  // only the second manifest was fetched
  // The mesh stays in memory because the second scene still uses it.
  scene = absl::CancelledError("dropped");
  prepared_ = 0;
  const auto again = load(*cache, first);
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ((*again)->geometry().meshes.shared(0), (*next)->geometry().meshes.shared(0));
  EXPECT_LT(prepared_, of_one_blob) << "the manifest must come from the cache";
}

TEST_F(LoadPackageTest, StopsOnRequest) {
  stop_ = true;
  EXPECT_EQ(load(*open(), manifest_).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bandsaw::worker
