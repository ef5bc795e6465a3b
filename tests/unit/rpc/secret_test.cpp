// Users and workers have a secret each, the secret of their role. If a secret is renewed, all calls
// that were made with the old secret end. Also tests the limit on wrong secrets.

#include <gmock/gmock.h>

#include <filesystem>
#include <thread>

#include "proto/wire/limits.h"
#include "tests/support/pattern.h"
#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

using grpc::StatusCode;

class SecretTest : public FarmTest {
 protected:
  SecretTest() {
    server_.reset();
    auto server = Server::start(
        *engine_, identity_,
        {.listen = "127.0.0.1:0", .renew = [this](link::Role role) { return renew(role); }});
    EXPECT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    channel_ = link::connect(join(link::Role::kFarm), std::chrono::seconds(60))->control;
  }

  /// Renews the secret in the identity file, as the program does for the server.
  absl::StatusOr<RenewedSecret> renew(link::Role role) {
    const auto identity = link::renew_secret(folder_ / "identity", role);
    EXPECT_TRUE(identity.ok()) << identity.status();
    renewed_ = *identity;
    return RenewedSecret{renewed_, "the file", written_};
  }

  /// Makes the call RotateSecret, which renews the secret of the role.
  grpc::Status rotate(farm::SecretRole role, farm::RotateSecretReply* reply) {
    farm::RotateSecretRequest request;
    request.set_role(role);
    return people()->RotateSecret(context(link::Role::kFarm).get(), request, reply);
  }

  grpc::Status list_jobs(const std::string& secret) {
    grpc::ClientContext call;
    call.AddMetadata(link::kSecretKey, secret);
    farm::ListJobsReply reply;
    return people()->ListJobs(&call, {}, &reply);
  }

  static std::vector<farm::BlobChunk> chunks_of(const std::string& bytes) {
    std::vector<farm::BlobChunk> chunks;
    for (std::size_t at = 0; at < bytes.size(); at += wire::kChunkBytes) {
      farm::BlobChunk chunk = chunks.empty() ? whole(bytes) : farm::BlobChunk();
      chunk.set_offset(at);
      chunk.set_data(bytes.substr(at, wire::kChunkBytes));
      chunks.push_back(chunk);
    }
    return chunks;
  }

  link::Identity renewed_;
  /// The result of writing the file with the join string (address, certificate and secret).
  absl::Status written_;
};

TEST_F(SecretTest, TheOldSecretOfUsersIsRefusedAndTheNewOneIsNot) {
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_FARM, &reply).ok());
  EXPECT_EQ(reply.join_file(), "the file");
  EXPECT_EQ(list_jobs(identity_.farm_secret).error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_TRUE(list_jobs(renewed_.farm_secret).ok());
  EXPECT_EQ(renewed_.worker_secret, identity_.worker_secret);
}

TEST_F(SecretTest, WorkersWithTheOldSecretAreDisconnectedAndUsersAreNot) {
  const auto call = context(link::Role::kWorker);
  const auto stream = work()->Session(call.get());
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_WORKER, &reply).ok());
  farm::ToWorker message;
  while (stream->Read(&message)) {
  }
  EXPECT_EQ(stream->Finish().error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_TRUE(list_jobs(identity_.farm_secret).ok());
}

TEST_F(SecretTest, WorkersAreDisconnectedAlsoIfTheJoinStringIsNotWritten) {
  written_ = absl::ResourceExhaustedError("cannot write the file");
  const auto call = context(link::Role::kWorker);
  const auto stream = work()->Session(call.get());
  farm::RotateSecretReply reply;
  const grpc::Status rotated = rotate(farm::SECRET_ROLE_WORKER, &reply);
  EXPECT_EQ(rotated.error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(rotated.error_message(), testing::HasSubstr("secret is new, but not in all files"));
  farm::ToWorker message;
  while (stream->Read(&message)) {
  }
  EXPECT_EQ(stream->Finish().error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(SecretTest, UploadsOfBandsWithTheOldSecretEnd) {
  const auto call = context(link::Role::kWorker);
  const auto stream = work()->PutBands(call.get());
  farm::PutBandReply outcome;
  ASSERT_TRUE(stream->Write(band_chunk()) && stream->Read(&outcome));
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_WORKER, &reply).ok());
  EXPECT_FALSE(stream->Read(&outcome));
  EXPECT_EQ(stream->Finish().error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(SecretTest, DownloadsOfScenesWithTheOldSecretEnd) {
  // The scene is so large that the download is not over when the secret is renewed.
  const std::string scene = test::pattern(16 << 20);
  ASSERT_TRUE(put_blob(chunks_of(scene)).ok());
  const auto call = context(link::Role::kWorker);
  farm::GetBlobRequest request;
  request.set_sha256(wire::sha256(scene).raw());
  const auto reader = work()->GetBlob(call.get(), request);
  farm::BlobChunk chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_WORKER, &reply).ok());
  while (reader->Read(&chunk)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(SecretTest, UploadsOfScenesWithTheOldSecretEnd) {
  const std::string scene = test::pattern(3 << 20);
  const auto call = context(link::Role::kFarm);
  farm::PutBlobReply put;
  const auto writer = people()->PutBlob(call.get(), &put);
  ASSERT_TRUE(writer->Write(chunks_of(scene)[0]));
  const wire::Digest digest = wire::sha256(scene);
  const std::string part = folder_ / ("data/blobs/incoming/" + digest.hex() + ".part");
  std::error_code error;
  while (std::filesystem::file_size(part, error) != wire::kChunkBytes || error) {
    std::this_thread::yield();
  }
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_FARM, &reply).ok());
  EXPECT_EQ(writer->Finish().error_code(), StatusCode::UNAUTHENTICATED);
  // The received bytes are kept for a sender with the new secret.
  while (engine_->partial_blob(digest) == 0) {
    std::this_thread::yield();
  }
}

TEST_F(SecretTest, DownloadsOfImagesWithTheOldSecretEnd) {
  const std::uint64_t job = finish_job(1024);
  const std::int64_t all = engine_->images().left();
  const auto call = context(link::Role::kFarm);
  farm::GetResultRequest request;
  request.set_job(job);
  const auto reader = people()->GetResult(call.get(), request);
  farm::ResultChunk chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_FARM, &reply).ok());
  EXPECT_EQ(engine_->images().left(), all)
      << "the memory must be free even if the client does not read on";
  while (reader->Read(&chunk)) {
  }
  EXPECT_EQ(reader->Finish().error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(SecretTest, ADownloadWithTheSecretOfTheOtherRoleContinues) {
  const std::uint64_t job = finish_job(1024);
  const auto call = context(link::Role::kFarm);
  farm::GetResultRequest request;
  request.set_job(job);
  const auto reader = people()->GetResult(call.get(), request);
  farm::ResultChunk chunk;
  ASSERT_TRUE(reader->Read(&chunk));
  farm::RotateSecretReply reply;
  ASSERT_TRUE(rotate(farm::SECRET_ROLE_WORKER, &reply).ok());
  while (reader->Read(&chunk)) {
  }
  EXPECT_TRUE(reader->Finish().ok());
}

TEST_F(SecretTest, AnUnknownRoleIsRefused) {
  farm::RotateSecretReply reply;
  EXPECT_EQ(rotate(farm::SECRET_ROLE_UNSPECIFIED, &reply).error_code(),
            StatusCode::INVALID_ARGUMENT);
}

TEST_F(SecretTest, ManyWrongSecretsAreLimitedAndTheRightOneIsNot) {
  StatusCode last = StatusCode::OK;
  for (std::size_t i = 0; i <= wire::kWrongSecretsPerMinute; ++i) {
    last = list_jobs(std::string(22, 'A')).error_code();
  }
  EXPECT_EQ(last, StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(list_jobs(identity_.farm_secret).ok());
}

using WithoutRenewal = FarmTest;  // a server that was started without the option `renew`

TEST_F(WithoutRenewal, RenewalIsRefused) {
  farm::RotateSecretRequest request;
  request.set_role(farm::SECRET_ROLE_WORKER);
  farm::RotateSecretReply reply;
  EXPECT_EQ(people()->RotateSecret(context(link::Role::kFarm).get(), request, &reply).error_code(),
            StatusCode::FAILED_PRECONDITION);
}

TEST_F(WithoutRenewal, BothRolesMayCallAbout) {
  for (const link::Role role : {link::Role::kFarm, link::Role::kWorker}) {
    farm::AboutReply about;
    ASSERT_TRUE(people()->About(context(role).get(), {}, &about).ok());
    EXPECT_GT(about.protocol(), 0U);
    EXPECT_GT(about.pixel_version(), 0U);
    EXPECT_GT(about.unix_s(), 1.7e9);
    EXPECT_GT(about.free_bytes(), 0U);
    EXPECT_EQ(about.workers(), 0U);
  }
  grpc::ClientContext stranger;
  farm::AboutReply about;
  EXPECT_EQ(people()->About(&stranger, {}, &about).error_code(), StatusCode::UNAUTHENTICATED);
}

}  // namespace
}  // namespace bandsaw::coordinator
