// Wrappers of OpenSSL's functions. Each wrapper frees what it allocates, and returns an error if
// OpenSSL fails.

#include "proto/link/certificate.h"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <ctime>
#include <memory>

#include "absl/strings/str_cat.h"

namespace bandsaw::link {
namespace {

using Bio = std::unique_ptr<BIO, decltype(&BIO_free_all)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Extension = std::unique_ptr<X509_EXTENSION, decltype(&X509_EXTENSION_free)>;

constexpr long kDay = 24 * 60 * 60;  // seconds; OpenSSL takes `long`
constexpr long kTwentyYears = 20 * 365 * kDay;

absl::Status failed(absl::string_view what) {
  return absl::InternalError(absl::StrCat("OpenSSL cannot ", what));
}

/// Returns an empty buffer in memory, to which OpenSSL can write.
Bio memory() { return {BIO_new(BIO_s_mem()), &BIO_free_all}; }
/// Returns a buffer from which OpenSSL reads `text`, without a copy.
Bio memory_of(const std::string& text) {
  return {BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), &BIO_free_all};
}
/// Returns what OpenSSL has written to the buffer.
std::string text_of(const Bio& bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio.get(), &data);
  return {data, static_cast<std::size_t>(size)};
}

/// Returns null if `pem` is not a certificate.
Certificate parse_certificate(const std::string& pem) {
  const Bio bio = memory_of(pem);
  return {PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr), &X509_free};
}

absl::Status unreadable() { return absl::InvalidArgumentError("the certificate cannot be read"); }

/// Returns the SHA-256 of a DER buffer that OpenSSL has written, and frees the buffer. INTERNAL:
/// `size` <= 0, which means that OpenSSL has failed.
absl::StatusOr<wire::Digest> digest_of_der(unsigned char* der, int size) {
  if (size <= 0) {
    return failed("write a certificate as DER");
  }
  const std::string bytes(reinterpret_cast<const char*>(der), static_cast<std::size_t>(size));
  OPENSSL_free(der);
  return wire::sha256(bytes);
}

/// Returns the day in UTC, such as 2026-11-26.
std::string day_of(double unix_s) {
  const auto seconds = static_cast<std::time_t>(unix_s);
  std::tm utc{};
  char text[32] = "";
  if (gmtime_r(&seconds, &utc) != nullptr) {
    std::strftime(text, sizeof(text), "%Y-%m-%d", &utc);
  }
  return text;
}

bool add_extension(X509* certificate, int nid, const std::string& value) {
  const Extension extension(X509V3_EXT_conf_nid(nullptr, nullptr, nid, value.c_str()),
                            &X509_EXTENSION_free);
  return extension != nullptr && X509_add_ext(certificate, extension.get(), -1) == 1;
}

/// Sets a random serial number of 63 bits: X.509 requires a positive one.
bool set_serial(X509* certificate) {
  unsigned char bytes[8];
  if (RAND_bytes(bytes, sizeof(bytes)) != 1) {
    return false;
  }
  std::uint64_t serial = 1;
  for (const unsigned char byte : bytes) {
    serial = (serial << 8 | byte) & 0x7fffffffffffffff;
  }
  return ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate), serial) == 1;
}

/// Makes `certificate` a self-signed certificate of `name`. It is valid from one day ago until
/// twenty years from now. Returns false if OpenSSL fails.
bool fill_and_sign(X509* certificate, EVP_PKEY* key, const std::string& name) {
  X509_NAME* subject = X509_get_subject_name(certificate);
  const auto* text = reinterpret_cast<const unsigned char*>(name.c_str());
  return X509_set_version(certificate, 2) == 1 &&  // v3
         set_serial(certificate) &&
         X509_gmtime_adj(X509_getm_notBefore(certificate), -kDay) != nullptr &&
         X509_gmtime_adj(X509_getm_notAfter(certificate), kTwentyYears) != nullptr &&
         X509_set_pubkey(certificate, key) == 1 &&
         X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, text, -1, -1, 0) == 1 &&
         X509_set_issuer_name(certificate, subject) == 1 &&
         add_extension(certificate, NID_subject_alt_name, "DNS:" + name) &&
         add_extension(certificate, NID_basic_constraints, "critical,CA:TRUE") &&
         X509_sign(certificate, key, EVP_sha256()) > 0;
}

}  // namespace

absl::StatusOr<KeyAndCertificate> make_certificate(const std::string& name) {
  const Key key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
  const Certificate certificate(X509_new(), &X509_free);
  if (key == nullptr || certificate == nullptr ||
      !fill_and_sign(certificate.get(), key.get(), name)) {
    return failed("make a certificate");
  }
  const Bio key_text = memory();
  const Bio certificate_text = memory();
  if (PEM_write_bio_PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) !=
          1 ||
      PEM_write_bio_X509(certificate_text.get(), certificate.get()) != 1) {
    return failed("write a certificate");
  }
  return KeyAndCertificate{text_of(key_text), text_of(certificate_text)};
}

absl::StatusOr<wire::Digest> certificate_digest(const std::string& certificate_pem) {
  const Certificate certificate = parse_certificate(certificate_pem);
  if (certificate == nullptr) {
    return unreadable();
  }
  unsigned char* der = nullptr;
  const int size = i2d_X509(certificate.get(), &der);
  return digest_of_der(der, size);
}

absl::StatusOr<wire::Digest> public_key_digest(const std::string& certificate_pem) {
  const Certificate certificate = parse_certificate(certificate_pem);
  if (certificate == nullptr) {
    return unreadable();
  }
  unsigned char* der = nullptr;
  const int size = i2d_X509_PUBKEY(X509_get_X509_PUBKEY(certificate.get()), &der);
  return digest_of_der(der, size);
}

absl::StatusOr<Validity> certificate_validity(const std::string& certificate_pem) {
  const Certificate certificate = parse_certificate(certificate_pem);
  std::tm from{};
  std::tm until{};
  if (certificate == nullptr ||
      ASN1_TIME_to_tm(X509_get0_notBefore(certificate.get()), &from) != 1 ||
      ASN1_TIME_to_tm(X509_get0_notAfter(certificate.get()), &until) != 1) {
    return unreadable();
  }
  return Validity{static_cast<double>(timegm(&from)), static_cast<double>(timegm(&until))};
}

absl::Status check_clock(const std::string& certificate_pem) {
  const absl::StatusOr<Validity> validity = certificate_validity(certificate_pem);
  if (!validity.ok()) {
    return absl::UnavailableError(validity.status().message());
  }
  const auto now = static_cast<double>(std::time(nullptr));
  if (now < validity->from || now > validity->until) {
    return absl::UnavailableError(absl::StrCat(
        "this machine's clock says ", day_of(now), ", but the farm's certificate is valid from ",
        day_of(validity->from), " to ", day_of(validity->until), ": set the clock"));
  }
  return absl::OkStatus();
}

absl::Status check_key(const std::string& key_pem, const std::string& certificate_pem) {
  const Bio bio = memory_of(key_pem);
  const Key key(PEM_read_bio_PrivateKey(bio.get(), nullptr, nullptr, nullptr), &EVP_PKEY_free);
  const Certificate certificate = parse_certificate(certificate_pem);
  if (key == nullptr || certificate == nullptr) {
    return absl::InvalidArgumentError("the private key or the certificate cannot be read");
  }
  if (X509_check_private_key(certificate.get(), key.get()) != 1) {
    return absl::InvalidArgumentError("the private key does not belong to the certificate");
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::link
