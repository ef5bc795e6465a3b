// Makes OpenSSL's server context from the certificate and the key of the farm. Both are read from
// memory, not from files.

#include "coordinator/web/tls.h"

#include <openssl/pem.h>
#include <openssl/x509.h>

#include <string>

namespace bandsaw::coordinator {
namespace {

struct Free {
  void operator()(BIO* bio) const { BIO_free(bio); }
  void operator()(X509* certificate) const { X509_free(certificate); }
  void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

Owned<BIO> reader_of(const std::string& pem) {
  return Owned<BIO>(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
}

}  // namespace

absl::StatusOr<TlsContext> make_tls_context(const link::Identity& identity) {
  TlsContext context(SSL_CTX_new(TLS_server_method()));
  const Owned<BIO> certificate_pem = reader_of(identity.certificate_pem);
  const Owned<BIO> key_pem = reader_of(identity.key_pem);
  const Owned<X509> certificate(
      PEM_read_bio_X509(certificate_pem.get(), nullptr, nullptr, nullptr));
  const Owned<EVP_PKEY> key(PEM_read_bio_PrivateKey(key_pem.get(), nullptr, nullptr, nullptr));
  if (context == nullptr || certificate == nullptr || key == nullptr ||
      SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION) != 1 ||
      SSL_CTX_use_certificate(context.get(), certificate.get()) != 1 ||
      SSL_CTX_use_PrivateKey(context.get(), key.get()) != 1) {
    return absl::InvalidArgumentError("the farm's certificate cannot be used for TLS");
  }
  return context;
}

}  // namespace bandsaw::coordinator
