#pragma once

// The HTTP server under the dashboard: one request a connection, a bounded number of threads, a
// bounded number of connections of one address, a deadline for each connection, TLS from memory.

#include <map>
#include <string>
#include <thread>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/web/connection.h"
#include "coordinator/web/http.h"
#include "coordinator/web/tls.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class HttpServer {
 public:
  static constexpr int kThreads = 32;
  /// Further connections of an address that has so many are closed at once.
  static constexpr int kMaxOfOneAddress = 24;

  /// `tls` may be null: plaintext. `headers` are added to every answer. `handler` is called on
  /// several threads at once.
  HttpServer(TlsContext tls, std::vector<HttpField> headers, HttpHandler handler);
  /// Cuts every connection, and waits for the handlers.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Listens from its return on; MUST be called at most once. `host`: a number or a name; `port`: 0
  /// picks one. Gives the port. FAILED_PRECONDITION: it cannot be had.
  absl::StatusOr<int> start(const std::string& host, int port);
  /// Cuts every connection that is open now.
  void cut() EXCLUDES(mutex_);

 private:
  /// What each thread does: accepts a connection, serves it, closes it.
  void run() EXCLUDES(mutex_);
  void serve(int socket) EXCLUDES(mutex_);
  /// False: the server is being stopped, or the address has too many connections.
  bool enter(int socket, const std::string& address) EXCLUDES(mutex_);
  void leave(int socket) EXCLUDES(mutex_);
  /// After an accept that gave no connection. False: the server is being stopped.
  bool may_accept_again(int error) EXCLUDES(mutex_);

  const TlsContext tls_;
  const std::vector<HttpField> headers_;
  const HttpHandler handler_;
  int listener_ = -1;  ///< constant while threads run
  Mutex mutex_;
  CondVar stopped_;
  bool stopping_ GUARDED_BY(mutex_) = false;
  std::map<int, std::string> open_ GUARDED_BY(mutex_);  ///< the peer's address by socket
  std::vector<std::thread> threads_;
};

}  // namespace bandsaw::coordinator
