// The identity is one text file with the key, the certificate and both secrets. A renewed secret
// replaces the whole file.

#include "proto/link/identity.h"

#include <openssl/crypto.h>
#include <sys/stat.h>

#include <fstream>
#include <sstream>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "proto/link/certificate.h"
#include "proto/link/private_file.h"
#include "proto/link/random.h"

namespace bandsaw::link {
namespace {

constexpr char kHeading[] = "bandsaw-identity 1";
constexpr char kWorkerLine[] = "worker-secret ";
constexpr char kFarmLine[] = "farm-secret ";
constexpr char kCertificateBegin[] = "-----BEGIN CERTIFICATE-----";
constexpr char kCertificateEnd[] = "-----END CERTIFICATE-----\n";

/// Key, certificate and secrets are written to one file, so that they always belong together.
std::string to_text(const Identity& identity) {
  return absl::StrCat(kHeading, "\n", kWorkerLine, identity.worker_secret, "\n", kFarmLine,
                      identity.farm_secret, "\n", identity.certificate_pem, identity.key_pem);
}

/// Returns the error for an identity file that cannot be used because of `what`.
absl::Status damaged(const std::string& path, absl::string_view what) {
  return absl::DataLossError(absl::StrCat(
      path, ": the farm's identity is damaged: ", what,
      ". Restore it from a backup, or move it away to make a new one (every machine then needs a "
      "new join string)"));
}

/// Parses the text of an identity file. `path` is for error messages.
absl::StatusOr<Identity> from_text(const std::string& text, const std::string& path) {
  const std::vector<std::string> lines = absl::StrSplit(text, absl::MaxSplits('\n', 3));
  if (lines.size() != 4 || lines[0] != kHeading || !absl::StartsWith(lines[1], kWorkerLine) ||
      !absl::StartsWith(lines[2], kFarmLine)) {
    return damaged(path, "its first lines are not those of an identity");
  }
  Identity identity;
  identity.worker_secret = lines[1].substr(sizeof(kWorkerLine) - 1);
  identity.farm_secret = lines[2].substr(sizeof(kFarmLine) - 1);
  if (identity.worker_secret.size() != kSecretLength ||
      identity.farm_secret.size() != kSecretLength) {
    return damaged(path, "a secret is not 22 characters long");
  }
  const std::size_t end = lines[3].find(kCertificateEnd);
  if (!absl::StartsWith(lines[3], kCertificateBegin) || end == std::string::npos) {
    return damaged(path, "it holds no certificate");
  }
  identity.certificate_pem = lines[3].substr(0, end + sizeof(kCertificateEnd) - 1);
  identity.key_pem = lines[3].substr(end + sizeof(kCertificateEnd) - 1);
  if (absl::Status status = check_key(identity.key_pem, identity.certificate_pem); !status.ok()) {
    return damaged(path, status.message());
  }
  absl::StatusOr<wire::Digest> digest = certificate_digest(identity.certificate_pem);
  if (!digest.ok()) {
    return damaged(path, digest.status().message());
  }
  identity.certificate_digest = *digest;
  return identity;
}

absl::StatusOr<Identity> make_identity() {
  absl::StatusOr<KeyAndCertificate> made = make_certificate(kServerName);
  if (!made.ok()) {
    return made.status();
  }
  Identity identity{.key_pem = std::move(made->key_pem),
                    .certificate_pem = std::move(made->certificate_pem),
                    .certificate_digest = {},
                    .worker_secret = make_secret(),
                    .farm_secret = make_secret()};
  absl::StatusOr<wire::Digest> digest = certificate_digest(identity.certificate_pem);
  if (!digest.ok()) {
    return digest.status();
  }
  identity.certificate_digest = *digest;
  return identity;
}

}  // namespace

bool is_same_secret(const std::string& a, const std::string& b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

absl::StatusOr<Identity> load_or_make_identity(const std::string& folder) {
  if (absl::Status status = make_private_folder(folder); !status.ok()) {
    return status;
  }
  const std::string path = folder + "/identity";
  absl::StatusOr<std::string> text = read_private_file(path);
  if (text.ok()) {
    return from_text(*text, path);
  }
  if (!absl::IsNotFound(text.status())) {
    return text.status();
  }
  absl::StatusOr<Identity> identity = make_identity();
  if (!identity.ok()) {
    return identity.status();
  }
  if (absl::Status status = write_private_file(path, to_text(*identity)); !status.ok()) {
    return status;
  }
  return identity;
}

absl::StatusOr<Identity> renew_secret(const std::string& folder, Role role) {
  const std::string path = folder + "/identity";
  absl::StatusOr<std::string> text = read_private_file(path);
  if (!text.ok()) {
    return text.status();
  }
  absl::StatusOr<Identity> identity = from_text(*text, path);
  if (!identity.ok()) {
    return identity.status();
  }
  (role == Role::kWorker ? identity->worker_secret : identity->farm_secret) = make_secret();
  if (absl::Status status = write_private_file(path, to_text(*identity)); !status.ok()) {
    return status;
  }
  return identity;
}

absl::StatusOr<Role> role_of_secret(const Identity& identity, const std::string& secret) {
  // Compares with both secrets in every case, so that the time does not depend on the result of the
  // first comparison.
  const bool worker = is_same_secret(identity.worker_secret, secret);
  const bool farm = is_same_secret(identity.farm_secret, secret);
  if (worker) {
    return Role::kWorker;
  }
  if (farm) {
    return Role::kFarm;
  }
  return absl::UnauthenticatedError(
      "the secret is not one of this farm's: is the join string old, or that of another farm?");
}

}  // namespace bandsaw::link
