// Sources of blobs (byte arrays named by their SHA-256), and the cleaning of foreign text.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "renderlib/base/clean_text.h"
#include "renderlib/package/blob_folder.h"
#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto* data = reinterpret_cast<const std::byte*>(text.data());
  return std::vector<std::byte>(data, data + text.size());
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

TEST(BlobMap, ReturnsStoredBlobs) {
  BlobMap blobs;
  const wire::Digest digest = blobs.put(bytes_of("band"));
  EXPECT_EQ(digest, wire::sha256(std::string("band")));
  EXPECT_EQ(blobs.put(bytes_of("band")), digest);
  EXPECT_EQ(blobs.all().size(), 1u);
  EXPECT_EQ(blobs.get(digest).value()->bytes(), absl::MakeConstSpan(bytes_of("band")));
  EXPECT_EQ(blobs.get(wire::Digest{}).status().code(), absl::StatusCode::kNotFound);
}

TEST(BlobFolder, ReadsFilesByDigest) {
  const test::TempDir folder;
  BlobFolder blobs(folder.path());
  for (const std::string text : {"", "band", "saw"}) {
    const wire::Digest digest = wire::sha256(text);
    write(blobs.path_of(digest), text);
    const auto blob = blobs.get(digest);
    ASSERT_TRUE(blob.ok()) << blob.status();
    EXPECT_EQ((*blob)->bytes(), absl::MakeConstSpan(bytes_of(text)));
  }
}

TEST(BlobFolder, DistinguishesMissingFromDamagedBlobs) {
  const test::TempDir folder;
  BlobFolder blobs(folder.path());
  const wire::Digest digest = wire::sha256(std::string("band"));
  EXPECT_EQ(blobs.get(digest).status().code(), absl::StatusCode::kNotFound);
  write(blobs.path_of(digest), "bent");
  EXPECT_EQ(blobs.get(digest).status().code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(blobs.get(digest).status().message()),
              ::testing::HasSubstr(blobs.path_of(digest)));
  std::remove(blobs.path_of(digest).c_str());
  mkdir(blobs.path_of(digest).c_str(), 0700);
  EXPECT_EQ(blobs.get(digest).status().code(), absl::StatusCode::kDataLoss);
}

// The second argument of clean_text() is the maximum number of bytes of the result.
TEST(CleanText, KeepsValidText) {
  EXPECT_EQ(clean_text("Grüße, 世界 🪚", 100), "Grüße, 世界 🪚");
}

TEST(CleanText, ReplacesInvalidBytes) {
  EXPECT_EQ(clean_text("a\nb\x1b[31m\x7f", 100), "a?b?[31m?");
  EXPECT_EQ(clean_text("\xc2\x9b", 100), "?");
  EXPECT_EQ(clean_text("\xff\xc0\xaf\xed\xa0\x80\xe4\xb8", 100), "????????");
}

TEST(CleanText, CutsBetweenCharacters) {
  EXPECT_EQ(clean_text("aüb", 2), "a");  // ü has two bytes
  EXPECT_EQ(clean_text("aüb", 3), "aü");
}

}  // namespace
}  // namespace bandsaw
