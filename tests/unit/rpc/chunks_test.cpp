// Transfers of blobs and bands in chunks, by gRPC: each is complete, is continued after an
// interruption, or is refused with the reason.

#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <thread>

#include "proto/wire/limits.h"
#include "tests/support/pattern.h"
#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

using test::pattern;

using grpc::StatusCode;
using ::testing::HasSubstr;

class ChunksTest : public FarmTest {
 protected:
  /// Expects a status with this code and a message that contains `what`.
  static void expect(const grpc::Status& status, StatusCode code, const std::string& what) {
    EXPECT_EQ(status.error_code(), code) << status.error_message();
    EXPECT_THAT(status.error_message(), HasSubstr(what));
  }
  bool is_there(const std::string& bytes) { return engine_->has_blob(wire::sha256(bytes)); }

  /// Downloads the blob from `offset`; `status` is set to the status of the call.
  std::string get_blob(const wire::Digest& digest, std::uint64_t offset, grpc::Status& status) {
    const auto call = context(link::Role::kWorker);
    farm::GetBlobRequest request;
    request.set_sha256(digest.raw());
    request.set_offset(offset);
    const auto reader = work()->GetBlob(call.get(), request);
    std::string bytes;
    farm::BlobChunk chunk;
    while (reader->Read(&chunk)) {
      EXPECT_EQ(chunk.offset(), offset + bytes.size());
      EXPECT_LE(chunk.data().size(), wire::kChunkBytes);
      bytes += chunk.data();
    }
    status = reader->Finish();
    return bytes;
  }

  /// Returns the blob's chunks from `offset`; the first one has the digest and size of the blob.
  static std::vector<farm::BlobChunk> chunks_from(const std::string& bytes, std::size_t offset) {
    std::vector<farm::BlobChunk> chunks;
    for (std::size_t at = offset; at < bytes.size(); at += wire::kChunkBytes) {
      farm::BlobChunk chunk = chunks.empty() ? whole(bytes) : farm::BlobChunk();
      chunk.set_offset(at);
      chunk.set_data(bytes.substr(at, wire::kChunkBytes));
      chunks.push_back(chunk);
    }
    return chunks;
  }

  /// Uploads the first `count` chunks of the blob, waits until they are on disk, and disconnects.
  void cut_after(const std::string& bytes, std::size_t count) {
    const auto call = context(link::Role::kFarm);
    farm::PutBlobReply reply;
    const auto writer = people()->PutBlob(call.get(), &reply);
    const std::vector<farm::BlobChunk> chunks = chunks_from(bytes, 0);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_TRUE(writer->Write(chunks[i]));
    }
    const std::string part =
        folder_ / ("data/blobs/incoming/" + wire::sha256(bytes).hex() + ".part");
    std::error_code error;
    while (std::filesystem::file_size(part, error) != count * wire::kChunkBytes || error) {
      std::this_thread::yield();
    }
    call->TryCancel();
    EXPECT_EQ(writer->Finish().error_code(), StatusCode::CANCELLED);
  }

  /// Returns how many bytes of the unfinished upload of this blob the coordinator has.
  std::uint64_t bytes_there(const std::string& bytes) {
    farm::MissingBlobsRequest request;
    request.add_sha256(wire::sha256(bytes).raw());
    farm::MissingBlobsReply reply;
    const auto status = people()->MissingBlobs(context(link::Role::kFarm).get(), request, &reply);
    EXPECT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(reply.there_size(), 1);
    return reply.there_size() == 1 ? reply.there(0) : 0;
  }
  /// Waits until the coordinator has noticed that the sender disconnected. Returns how many bytes
  /// of the blob the coordinator has.
  std::uint64_t wait_until_there(const std::string& bytes) {
    std::uint64_t there = 0;
    while (there == 0 && !HasFailure()) {
      there = bytes_there(bytes);
    }
    return there;
  }
};

TEST_F(ChunksTest, ABlobIsSentInChunksAndReadFromAnyOffset) {
  const std::string bytes = pattern((2 << 20) + 12345);
  farm::BlobChunk first = whole(bytes);
  first.set_data(bytes.substr(0, 1000));
  std::vector<farm::BlobChunk> chunks = {first};
  for (std::size_t at = 1000; at < bytes.size(); at += wire::kChunkBytes) {
    farm::BlobChunk chunk;
    chunk.set_offset(at);
    chunk.set_data(bytes.substr(at, wire::kChunkBytes));
    chunks.push_back(chunk);
  }
  const grpc::Status put = put_blob(chunks);
  ASSERT_TRUE(put.ok()) << put.error_message();
  EXPECT_TRUE(is_there(bytes));
  for (const std::size_t offset : {std::size_t{0}, std::size_t{777}, bytes.size()}) {
    grpc::Status status;
    EXPECT_TRUE(get_blob(wire::sha256(bytes), offset, status) == bytes.substr(offset));
    EXPECT_TRUE(status.ok()) << status.error_message();
  }
  grpc::Status status;
  get_blob(wire::sha256(bytes), bytes.size() + 1, status);
  expect(status, StatusCode::INVALID_ARGUMENT, "offset");
}

TEST_F(ChunksTest, AnInterruptedUploadContinues) {
  const std::string bytes = pattern((3 << 20) + 77);
  cut_after(bytes, 2);
  const std::uint64_t there = wait_until_there(bytes);
  ASSERT_EQ(there, 2U << 20);
  const std::vector<farm::BlobChunk> rest = chunks_from(bytes, there);
  std::size_t sent = 0;
  for (const farm::BlobChunk& chunk : rest) {
    sent += chunk.data().size();
  }
  EXPECT_EQ(sent, bytes.size() - (2U << 20));
  const grpc::Status put = put_blob(rest);
  ASSERT_TRUE(put.ok()) << put.error_message();
  grpc::Status status;
  EXPECT_TRUE(get_blob(wire::sha256(bytes), 0, status) == bytes);
}

TEST_F(ChunksTest, AnUploadCannotContinueBeyondTheReceivedBytes) {
  const std::string bytes = pattern(3 << 20);
  expect(put_blob(chunks_from(bytes, 1 << 20)), StatusCode::FAILED_PRECONDITION, "0 bytes");
  farm::BlobChunk beyond = whole("x");
  beyond.set_offset(2);
  expect(put_blob({beyond}), StatusCode::INVALID_ARGUMENT, "offset");
  EXPECT_FALSE(is_there(bytes));
}

TEST_F(ChunksTest, ADamagedPartIsReportedAndSentAgain) {
  const std::string bytes = pattern(3 << 20);
  const wire::Digest digest = wire::sha256(bytes);
  cut_after(bytes, 2);
  const std::uint64_t there = wait_until_there(bytes);
  std::fstream part(folder_ / ("data/blobs/incoming/" + digest.hex() + ".part"),
                    std::ios::in | std::ios::out | std::ios::binary);
  part.seekp(12345).put(static_cast<char>(bytes[12345] ^ 1));
  part.close();
  ASSERT_TRUE(part.good());
  expect(put_blob(chunks_from(bytes, there)), StatusCode::DATA_LOSS, digest.hex());
  EXPECT_EQ(bytes_there(bytes), 0U);
  EXPECT_TRUE(put_blob(chunks_from(bytes, 0)).ok());
  EXPECT_TRUE(is_there(bytes));
}

TEST_F(ChunksTest, AMissingBlobIsNotFound) {
  grpc::Status status;
  get_blob(wire::Digest(), 0, status);
  EXPECT_EQ(status.error_code(), StatusCode::NOT_FOUND);
}

TEST_F(ChunksTest, ABlobMayBeEmpty) {
  ASSERT_TRUE(put_blob({whole("")}).ok());
  grpc::Status status;
  EXPECT_EQ(get_blob(wire::sha256(std::string()), 0, status), "");
  EXPECT_TRUE(status.ok()) << status.error_message();
}

TEST_F(ChunksTest, ABlobMayBeSentAgain) {
  EXPECT_TRUE(put_blob({whole("again")}).ok());
  EXPECT_TRUE(put_blob({whole("again")}).ok());
}

TEST_F(ChunksTest, ABlobThatDiffersFromItsHeaderIsRefused) {
  farm::BlobChunk tail;
  tail.set_offset(5);
  tail.set_data("world");
  farm::BlobChunk head = whole("helloworld");
  head.set_data("hello");

  expect(put_blob({}), StatusCode::INVALID_ARGUMENT, "no chunk");
  expect(put_blob({head}), StatusCode::INVALID_ARGUMENT, "ended after 5 of 10");
  expect(put_blob({tail}), StatusCode::INVALID_ARGUMENT, "sha256");
  farm::BlobChunk gap = tail;
  gap.set_offset(6);
  expect(put_blob({head, gap}), StatusCode::INVALID_ARGUMENT, "offset: must be 5");
  expect(put_blob({head, tail, tail}), StatusCode::INVALID_ARGUMENT, "offset: must be 10");
  farm::BlobChunk longer = tail;
  longer.set_data("world!");
  expect(put_blob({head, longer}), StatusCode::INVALID_ARGUMENT, "more bytes");
  farm::BlobChunk named = tail;
  named.set_sha256(head.sha256());
  expect(put_blob({head, named}), StatusCode::INVALID_ARGUMENT, "first chunk only");
  farm::BlobChunk other = tail;
  other.set_data("World");
  EXPECT_EQ(put_blob({head, other}).error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_FALSE(is_there("helloworld"));
  EXPECT_TRUE(put_blob({head, tail}).ok());
  EXPECT_TRUE(is_there("helloworld"));
}

TEST_F(ChunksTest, SizesOverTheirLimitsAreRefused) {
  expect(put_blob({whole(pattern(wire::kChunkBytes + 1))}), StatusCode::INVALID_ARGUMENT,
         "a chunk");
  farm::BlobChunk huge = whole("x");
  huge.set_size(wire::kBlobBytes + 1);
  expect(put_blob({huge}), StatusCode::RESOURCE_EXHAUSTED, "size");
  EXPECT_EQ(put_blob({whole(pattern(wire::kMessageBytes))}).error_code(),
            StatusCode::RESOURCE_EXHAUSTED)
      << "gRPC itself must refuse a message of this size";
  farm::BandChunk band = band_chunk();
  band.mutable_header()->set_size(wire::kBandBytes + 1);
  expect(put_bands({band}).status, StatusCode::INVALID_ARGUMENT, "header.size");
}

// engine_->bands() is the budget of the memory for bands that arrive. The band has 144 bytes. Other
// users of the budget take all but 144 bytes. Then a second band is refused while the first one is
// arriving, and is accepted when the first one has ended.
TEST_F(ChunksTest, ABandsMemoryIsReservedWhenItsHeaderArrives) {
  const std::int64_t all = engine_->bands().left();
  const auto wait_until_left = [&](std::int64_t bytes) {
    while (engine_->bands().left() != bytes) {
      std::this_thread::yield();
    }
  };
  farm::BandChunk half = band_chunk();
  half.set_data(half.data().substr(0, 40));
  const auto call = context(link::Role::kWorker);
  const auto stream = work()->PutBands(call.get());
  ASSERT_TRUE(stream->Write(half));
  wait_until_left(all - 144);
  {
    const auto others = engine_->bands().take(static_cast<std::uint64_t>(all - 144));
    ASSERT_TRUE(others);
    expect(put_bands({half}).status, StatusCode::RESOURCE_EXHAUSTED, "send this one again");
  }
  call->TryCancel();
  EXPECT_EQ(stream->Finish().error_code(), StatusCode::CANCELLED);
  wait_until_left(all);
  {
    const auto others = engine_->bands().take(static_cast<std::uint64_t>(all - 144));
    ASSERT_TRUE(others);
    EXPECT_NE(put_bands({band_chunk()}).status.error_code(), StatusCode::RESOURCE_EXHAUSTED)
        << "the memory of a whole band must be reserved only once";
  }
  wait_until_left(all);
}

TEST_F(ChunksTest, MissingBlobsAreNamed) {
  ASSERT_TRUE(put_blob({whole("here")}).ok());
  farm::MissingBlobsRequest request;
  request.add_sha256(wire::sha256(std::string("here")).raw());
  request.add_sha256(wire::sha256(std::string("gone")).raw());
  farm::MissingBlobsReply reply;
  ASSERT_TRUE(people()->MissingBlobs(context(link::Role::kFarm).get(), request, &reply).ok());
  ASSERT_EQ(reply.sha256_size(), 1);
  EXPECT_EQ(reply.sha256(0), wire::sha256(std::string("gone")).raw());
  request.add_sha256("short");
  expect(people()->MissingBlobs(context(link::Role::kFarm).get(), request, &reply),
         StatusCode::INVALID_ARGUMENT, "32 bytes");
}

// The band has 2 rows of 3 pixels: 18 sums, 144 bytes.
TEST_F(ChunksTest, ABandThatDiffersFromItsHeaderIsRefused) {
  farm::BandChunk bare = band_chunk();
  bare.clear_header();
  expect(put_bands({bare}).status, StatusCode::INVALID_ARGUMENT, "header");
  farm::BandChunk half = band_chunk();
  half.set_data(half.data().substr(0, 40));
  expect(put_bands({half}).status, StatusCode::INVALID_ARGUMENT, "ended after 40 of 144");
  expect(put_bands({half, half}).status, StatusCode::INVALID_ARGUMENT,
         "first chunk of a band only");
  expect(put_bands({half, bare}).status, StatusCode::INVALID_ARGUMENT, "more bytes");
  farm::BandChunk wrong = band_chunk();
  wrong.mutable_header()->set_sha256(wire::Digest().raw());
  expect(put_bands({wrong}).status, StatusCode::INVALID_ARGUMENT, "sha256");
  farm::BandChunk uneven = band_chunk();
  uneven.mutable_header()->mutable_band()->set_last_row(5);
  expect(put_bands({uneven}).status, StatusCode::INVALID_ARGUMENT, "rows of pixels");
  farm::BandChunk rows = band_chunk();
  rows.mutable_header()->mutable_band()->set_last_row(0);
  expect(put_bands({rows}).status, StatusCode::INVALID_ARGUMENT, "header.band");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0}) {
    std::vector<double> sums(18, 0.5);
    sums[17] = bad;
    expect(put_bands({band_chunk(sums)}).status, StatusCode::INVALID_ARGUMENT, "finite");
  }
}

// The server either ends the call with an error or answers that the band is unwanted.
TEST_F(ChunksTest, ABandOfAnUnknownJobIsNotStored) {
  const PutBands put = put_bands({band_chunk()});
  EXPECT_TRUE(!put.status.ok() ||
              put.outcomes == std::vector{farm::PutBandReply::OUTCOME_UNWANTED});
}

TEST_F(ChunksTest, EachOfSeveralBandsIsAnswered) {
  farm::BandChunk first = band_chunk();
  first.set_data(first.data().substr(0, 40));
  farm::BandChunk rest = band_chunk();
  rest.clear_header();
  rest.set_data(rest.data().substr(40));
  const PutBands none = put_bands({});
  EXPECT_TRUE(none.status.ok() && none.outcomes.empty());
  const PutBands put = put_bands({first, rest, band_chunk()});
  EXPECT_TRUE(put.status.ok()) << put.status.error_message();
  EXPECT_EQ(put.outcomes.size(), 2u);
}

}  // namespace
}  // namespace bandsaw::coordinator
