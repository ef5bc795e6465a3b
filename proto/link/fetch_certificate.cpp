// Fetches a server's certificate by a TLS handshake without verification, because gRPC does not
// expose a certificate that it does not trust. The TLS records go through memory buffers, so that
// every wait has a deadline and no write can raise SIGPIPE.

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>

#include <memory>

#include "proto/link/channel.h"
#include "proto/link/identity.h"
#include "proto/link/socket.h"

namespace bandsaw::link {
namespace {

using Context = std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)>;
using Session = std::unique_ptr<SSL, decltype(&SSL_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Bio = std::unique_ptr<BIO, decltype(&BIO_free_all)>;

/// Removes all bytes from the memory buffer and returns them.
std::string take_all(BIO* bio) {
  std::string bytes(BIO_ctrl_pending(bio), '\0');
  const int got = bytes.empty() ? 0 : BIO_read(bio, bytes.data(), static_cast<int>(bytes.size()));
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

/// Runs one round of the handshake: calls OpenSSL, sends what OpenSSL has written, and passes the
/// server's answer to OpenSSL. Returns true once the handshake is complete.
absl::StatusOr<bool> advance(SSL* session, Socket& socket, const Deadline& deadline) {
  ERR_clear_error();  // SSL_get_error reports errors that earlier calls of this thread have left
  const int result = SSL_connect(session);
  const int reason = SSL_get_error(session, result);
  if (absl::Status status = socket.send(take_all(SSL_get_wbio(session)), deadline); !status.ok()) {
    return status;
  }
  if (result == 1) {
    return true;
  }
  if (reason != SSL_ERROR_WANT_READ) {
    ERR_clear_error();  // later calls of this thread would read this error
    return absl::UnavailableError("the server there does not speak TLS");
  }
  absl::StatusOr<std::string> answer = socket.receive(deadline);
  if (!answer.ok()) {
    return answer.status();
  }
  BIO_write(SSL_get_rbio(session), answer->data(), static_cast<int>(answer->size()));
  return false;
}

absl::StatusOr<std::string> peer_certificate_pem(SSL* session) {
  const Certificate certificate(SSL_get1_peer_certificate(session), &X509_free);
  const Bio bio(BIO_new(BIO_s_mem()), &BIO_free_all);
  if (certificate == nullptr || PEM_write_bio_X509(bio.get(), certificate.get()) != 1) {
    return absl::UnavailableError("the server there has no certificate");
  }
  return take_all(bio.get());
}

}  // namespace

absl::StatusOr<std::string> fetch_certificate_pem(const std::string& address,
                                                  std::chrono::milliseconds timeout) {
  const Deadline deadline{std::chrono::steady_clock::now() + timeout};
  absl::StatusOr<Socket> socket = Socket::connect(address, deadline);
  if (!socket.ok()) {
    return socket.status();
  }
  return fetch_certificate_pem(*socket, deadline);
}

absl::StatusOr<std::string> fetch_certificate_pem(Socket& socket, const Deadline& deadline) {
  const Context context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
  const Session session(context == nullptr ? nullptr : SSL_new(context.get()), &SSL_free);
  if (session == nullptr) {
    return absl::InternalError("OpenSSL cannot begin a TLS session");
  }
  SSL_set_bio(session.get(), BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
  SSL_set_verify(session.get(), SSL_VERIFY_NONE, nullptr);
  SSL_set_tlsext_host_name(session.get(), kServerName);
  // A gRPC server closes a connection that does not offer HTTP/2 by ALPN.
  static constexpr unsigned char kAlpn[] = {2, 'h', '2'};
  SSL_set_alpn_protos(session.get(), kAlpn, sizeof(kAlpn));
  while (true) {
    absl::StatusOr<bool> over = advance(session.get(), socket, deadline);
    if (!over.ok()) {
      return over.status();
    }
    if (*over) {
      return peer_certificate_pem(session.get());
    }
  }
}

}  // namespace bandsaw::link
