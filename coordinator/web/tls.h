#pragma once

// Prepares OpenSSL for the dashboard's TLS connections, with the farm's own certificate.

#include <openssl/ssl.h>

#include <memory>

#include "absl/status/statusor.h"
#include "proto/link/identity.h"

namespace bandsaw::coordinator {

struct FreeTlsContext {
  void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
};
using TlsContext = std::unique_ptr<SSL_CTX, FreeTlsContext>;

/// Creates a server's context for TLS 1.2 or later, with the certificate and the key of `identity`.
/// INVALID_ARGUMENT: the certificate or the key cannot be used.
absl::StatusOr<TlsContext> make_tls_context(const link::Identity& identity);

}  // namespace bandsaw::coordinator
