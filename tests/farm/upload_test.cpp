// A blob is a part of a scene that is known by the digest of its bytes. Tests a submitter that
// disconnects while it uploads a blob, and a submitter that resumes the upload.

#include <gtest/gtest.h>

#include <csignal>
#include <optional>
#include <span>
#include <string>

#include "coordinator/cli/farm/farm_client.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/pattern.h"

namespace bandsaw::test {
namespace {

using coordinator::FarmClient;

class Upload : public testing::Test {
 protected:
  std::unique_ptr<FarmClient> connect() {
    return *FarmClient::connect(*link::join_string_from(farm_.farm_file()));
  }

  /// Returns the number of bytes of the blob that the farm has; std::nullopt: all.
  std::optional<std::uint64_t> bytes_on_farm() {
    const auto missing = connect()->missing_blobs({digest()});
    EXPECT_TRUE(missing.ok()) << missing.status();
    return missing->empty() ? std::nullopt : std::optional(missing->front().there);
  }

  /// Uploads at least half of the blob, then disconnects.
  void leave_in_the_middle() {
    const auto client = connect();
    const absl::Status cut = client->put_blob(digest(), bytes_, 0, [&](std::uint64_t sent) {
      if (sent >= bytes_.size() / 2) {
        client->stop();
      }
    });
    ASSERT_EQ(cut.code(), absl::StatusCode::kCancelled) << cut;
  }

  wire::Digest digest() const { return wire::sha256(bytes_); }

  FarmProcesses farm_;
  const std::string text_ = pattern(16 << 20);
  const absl::Span<const std::byte> bytes_ = std::as_bytes(std::span(text_));
};

TEST_F(Upload, ResumesAlsoAfterARestartOfTheCoordinator) {
  leave_in_the_middle();
  std::uint64_t kept = 0;
  while (kept == 0 && !HasFailure()) {
    // The coordinator notices the disconnection a moment later. Until then it reports no part of
    // the blob.
    kept = bytes_on_farm().value_or(bytes_.size());
  }
  ASSERT_LT(kept, bytes_.size());
  farm_.coordinator().signal(SIGKILL);
  farm_.coordinator().wait();
  farm_.restart_coordinator();
  EXPECT_EQ(bytes_on_farm(), kept);
  std::optional<std::uint64_t> first;
  const absl::Status put = connect()->put_blob(
      digest(), bytes_, kept, [&](std::uint64_t sent) { first = first.value_or(sent); });
  ASSERT_TRUE(put.ok()) << put;
  // A chunk has 1 MiB. After the first chunk the client reports the kept bytes and this chunk as
  // sent.
  EXPECT_EQ(first, kept + (1 << 20)) << "the upload must continue after the kept bytes";
  EXPECT_EQ(bytes_on_farm(), std::nullopt);
}

TEST_F(Upload, RestartsIfTheFarmLostThePart) {
  // The client claims that the farm has the first 8 MiB, but the farm has no part of the blob.
  const absl::Status put = connect()->put_blob(digest(), bytes_, 8 << 20, [](std::uint64_t) {});
  EXPECT_TRUE(put.ok()) << put;
  EXPECT_EQ(bytes_on_farm(), std::nullopt);
}

}  // namespace
}  // namespace bandsaw::test
