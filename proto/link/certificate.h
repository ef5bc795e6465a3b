#pragma once

// What OpenSSL makes and reads: keys, self-signed certificates.

#include <string>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"

namespace bandsaw::link {

struct KeyAndCertificate {
  std::string key_pem;
  std::string certificate_pem;
};

/// An EC P-256 key and its self-signed certificate for `name`, valid for 20 years, beginning a day
/// ago because clocks differ.
absl::StatusOr<KeyAndCertificate> make_certificate(const std::string& name);

/// SHA-256 of the DER form. INVALID_ARGUMENT: not a certificate.
absl::StatusOr<wire::Digest> certificate_digest(const std::string& certificate_pem);

/// SHA-256 of the public key (SubjectPublicKeyInfo, RFC 7469, section 2.4). INVALID_ARGUMENT: not a
/// certificate.
absl::StatusOr<wire::Digest> public_key_digest(const std::string& certificate_pem);

/// From when until when it is valid, in seconds since 1970.
struct Validity {
  double from = 0;
  double until = 0;
};
/// INVALID_ARGUMENT: not a certificate.
absl::StatusOr<Validity> certificate_validity(const std::string& certificate_pem);

/// INVALID_ARGUMENT: not a private key, or not this certificate's.
absl::Status check_key(const std::string& key_pem, const std::string& certificate_pem);

}  // namespace bandsaw::link
