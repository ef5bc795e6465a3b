#pragma once

// Keys and self-signed certificates, by OpenSSL. The coordinator makes a key and a certificate for
// itself (identity.h). Each client compares the digest of this certificate with the digest in the
// join string.

#include <string>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"

namespace bandsaw::link {

struct KeyAndCertificate {
  std::string key_pem;
  std::string certificate_pem;
};

/// Creates an EC P-256 key and its self-signed certificate for `name`. The certificate is valid for
/// 20 years. Its validity begins a day before the present, because clocks differ. INTERNAL: OpenSSL
/// failed.
absl::StatusOr<KeyAndCertificate> make_certificate(const std::string& name);

/// Returns the SHA-256 of the DER form. INVALID_ARGUMENT: not a certificate.
absl::StatusOr<wire::Digest> certificate_digest(const std::string& certificate_pem);

/// Returns the SHA-256 of the public key (SubjectPublicKeyInfo, RFC 7469, section 2.4).
/// INVALID_ARGUMENT: not a certificate.
absl::StatusOr<wire::Digest> public_key_digest(const std::string& certificate_pem);

/// Validity period of a certificate, seconds since 1970.
struct Validity {
  double from = 0;
  double until = 0;
};
/// Returns the validity period. INVALID_ARGUMENT: not a certificate.
absl::StatusOr<Validity> certificate_validity(const std::string& certificate_pem);

/// Checks that the machine's clock is within the certificate's validity. UNAVAILABLE: the clock
/// is outside of the validity, or `certificate_pem` is not a certificate.
absl::Status check_clock(const std::string& certificate_pem);

/// Checks that the key belongs to the certificate. INVALID_ARGUMENT: `key_pem` is not a private
/// key, `certificate_pem` is not a certificate, or the key belongs to another certificate.
absl::Status check_key(const std::string& key_pem, const std::string& certificate_pem);

}  // namespace bandsaw::link
