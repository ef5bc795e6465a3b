// The identity file of a farm holds the key, the certificate and the secrets of the farm. Only the
// owner of the file can read it.

#include "proto/link/identity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "proto/link/certificate.h"
#include "proto/link/private_file.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::link {
namespace {

using ::testing::HasSubstr;

/// Returns the permissions of a file, or 0 if there is no such file.
unsigned mode_of(const std::string& path) {
  struct stat found {};
  return stat(path.c_str(), &found) == 0 ? found.st_mode & 07777 : 0;
}

/// Returns the contents of a file.
std::string slurp(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Identity, IsReadableByItsOwnerOnly) {
  const test::TempDir folder;
  ASSERT_TRUE(load_or_make_identity(folder / "a/data").ok());
  EXPECT_EQ(mode_of(folder / "a/data"), 0700U);
  EXPECT_EQ(mode_of(folder / "a/data/identity"), 0600U);
  const auto entries = std::filesystem::directory_iterator(folder / "a/data");
  EXPECT_EQ(std::distance(begin(entries), end(entries)), 1) << "no temporary file may be left";
}

TEST(Identity, RenewingASecretChangesNothingElse) {
  const test::TempDir folder;
  const std::string data = folder / "data";
  EXPECT_TRUE(absl::IsNotFound(renew_secret(data, Role::kWorker).status()));
  const Identity before = *load_or_make_identity(data);
  const Identity after = *renew_secret(data, Role::kWorker);
  EXPECT_NE(after.worker_secret, before.worker_secret);
  EXPECT_EQ(after.farm_secret, before.farm_secret);
  EXPECT_EQ(after.certificate_digest, before.certificate_digest);
  EXPECT_EQ(after.key_pem, before.key_pem);
  EXPECT_EQ(load_or_make_identity(data)->worker_secret, after.worker_secret);
  EXPECT_NE(renew_secret(data, Role::kFarm)->farm_secret, before.farm_secret);
  EXPECT_EQ(mode_of(folder / "data/identity"), 0600U);
}

TEST(Identity, ItsCertificateIsValidNowAndForYears) {
  const test::TempDir folder;
  const auto validity =
      certificate_validity(load_or_make_identity(folder / "data")->certificate_pem);
  ASSERT_TRUE(validity.ok()) << validity.status();
  constexpr double kDay = 24 * 60 * 60;
  // It is valid from one day ago until twenty years from now.
  EXPECT_NEAR(validity->until - validity->from, (20 * 365 + 1) * kDay, 10);
  EXPECT_FALSE(certificate_validity("nonsense").ok());
}

// The expected digest of the certificate's public key was printed by `openssl x509 -noout -pubkey |
// openssl pkey -pubin -outform der | sha256sum`.
TEST(Identity, ThePublicKeyDigestIsThatOfOpenSsl) {
  const std::string certificate =
      "-----BEGIN CERTIFICATE-----\n"
      "MIIBbjCCAROgAwIBAgIUEsUGly2sB4OpZf0/SZu7/qlfow8wCgYIKoZIzj0EAwIw\n"
      "DDEKMAgGA1UEAwwBYjAeFw0yNjExMjIwMjA3MDlaFw0yNjExMjMwMjA3MDlaMAwx\n"
      "CjAIBgNVBAMMAWIwWTATBgcqhkjOPQIBBggqhkjOPQMBBwNCAATMc6CSImSmnCMg\n"
      "HhyzoahrueSi+1MiUnR+iHXzBLONy1mlx/Zht1MdYm+uPsC9cAZAxJknWxG7oKeX\n"
      "uJpdNbMuo1MwUTAdBgNVHQ4EFgQUYoFMUeNQJH7Qz1GBGDcHlIcrZGIwHwYDVR0j\n"
      "BBgwFoAUYoFMUeNQJH7Qz1GBGDcHlIcrZGIwDwYDVR0TAQH/BAUwAwEB/zAKBggq\n"
      "hkjOPQQDAgNJADBGAiEAqwmh0FZ6RKHNFLQXVpLGVAAc3QJC/faMXnkxEwZLu3MC\n"
      "IQDIwl4XVMGn/ZUB6IshRMVDgutyfjC7X/H6uaJJBxaNvg==\n"
      "-----END CERTIFICATE-----\n";
  const auto digest = public_key_digest(certificate);
  ASSERT_TRUE(digest.ok()) << digest.status();
  EXPECT_EQ(digest->hex(), "2fff1845e9fba182b56afd73980d03da00d60de7f20b21a87a49270b4e00b898");
  EXPECT_FALSE(public_key_digest("nonsense").ok());
}

TEST(Identity, IsTheSameAfterARestart) {
  const test::TempDir folder;
  const absl::StatusOr<Identity> first = load_or_make_identity(folder.path());
  const absl::StatusOr<Identity> second = load_or_make_identity(folder.path());
  ASSERT_TRUE(first.ok()) << first.status();
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(first->key_pem, second->key_pem);
  EXPECT_EQ(first->certificate_pem, second->certificate_pem);
  EXPECT_EQ(first->certificate_digest, second->certificate_digest);
  EXPECT_EQ(first->worker_secret, second->worker_secret);
  EXPECT_EQ(first->farm_secret, second->farm_secret);
}

TEST(Identity, DiffersBetweenFarms) {
  const test::TempDir folder;
  const absl::StatusOr<Identity> a = load_or_make_identity(folder / "a");
  const absl::StatusOr<Identity> b = load_or_make_identity(folder / "b");
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_NE(a->certificate_digest, b->certificate_digest);
  EXPECT_NE(a->worker_secret, b->worker_secret);
  EXPECT_NE(a->worker_secret, a->farm_secret);
  EXPECT_EQ(a->worker_secret.size(), 22U);
  EXPECT_TRUE(check_key(a->key_pem, a->certificate_pem).ok());
  EXPECT_FALSE(check_key(a->key_pem, b->certificate_pem).ok());
}

TEST(Identity, RefusesAFileThatOthersCanRead) {
  const test::TempDir folder;
  ASSERT_TRUE(load_or_make_identity(folder.path()).ok());
  ASSERT_EQ(chmod((folder / "identity").c_str(), 0644), 0);
  const absl::Status status = load_or_make_identity(folder.path()).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kPermissionDenied);
  EXPECT_THAT(std::string(status.message()), HasSubstr("chmod 600"));
}

TEST(Identity, IsNotReplacedWhenDamaged) {
  const test::TempDir folder;
  ASSERT_TRUE(load_or_make_identity(folder.path()).ok());
  const std::string whole = slurp(folder / "identity");
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{30}, std::size_t{200}, whole.size() / 2}) {
    std::ofstream(folder / "identity") << whole.substr(0, size);
    const absl::Status status = load_or_make_identity(folder.path()).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss) << size;
    EXPECT_EQ(slurp(folder / "identity"), whole.substr(0, size));
  }
}

TEST(Identity, NamesThePathThatCannotBeWritten) {
  const test::TempDir folder;
  std::ofstream(folder / "file") << "x";
  const absl::Status status = load_or_make_identity(folder / "file").status();
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr(folder / "file"));
}

TEST(PrivateFile, IsReadWholeOrNotAtAll) {
  const test::TempDir folder;
  const std::string longest(1 << 20, 'x');  // the largest file that is read
  ASSERT_TRUE(write_private_file(folder / "a", longest).ok());
  EXPECT_EQ(*read_private_file(folder / "a"), longest);
  ASSERT_TRUE(write_private_file(folder / "a", longest + "x").ok());
  const absl::Status status = read_private_file(folder / "a").status();
  EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(folder / "a"));
}

TEST(RoleOfSecret, DistinguishesTheRolesAndRefusesOthers) {
  const test::TempDir folder;
  const absl::StatusOr<Identity> identity = load_or_make_identity(folder.path());
  ASSERT_TRUE(identity.ok()) << identity.status();
  EXPECT_EQ(*role_of_secret(*identity, identity->worker_secret), Role::kWorker);
  EXPECT_EQ(*role_of_secret(*identity, identity->farm_secret), Role::kFarm);
  std::string wrong = identity->farm_secret;
  wrong.back() = wrong.back() == 'A' ? 'B' : 'A';
  for (const std::string& secret : {std::string(), wrong, wrong + "A", std::string(5000, 'A')}) {
    EXPECT_EQ(role_of_secret(*identity, secret).status().code(),
              absl::StatusCode::kUnauthenticated);
  }
}

}  // namespace
}  // namespace bandsaw::link
