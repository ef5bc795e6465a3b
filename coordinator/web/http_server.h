#pragma once

// The HTTP server of the dashboard. It serves one request per connection, and each connection has a
// deadline. The number of threads is fixed, and the number of connections from one address is
// limited. The keys for TLS come from memory, not from files.

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
  /// Maximum number of connections from one address; more are closed at once.
  static constexpr int kMaxOfOneAddress = 24;

  /// `tls` may be nullptr: plaintext. `headers` are added to every response. `handler` is called on
  /// several threads at the same time.
  HttpServer(TlsContext tls, std::vector<HttpField> headers, HttpHandler handler);
  /// Closes every connection and waits for the handlers.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// Starts to listen and returns the port. Call at most once. `host`: address or name; `port`: 0
  /// for a free one. FAILED_PRECONDITION: the port cannot be used.
  absl::StatusOr<int> start(const std::string& host, int port);
  /// Closes every open connection.
  void cut() EXCLUDES(mutex_);

 private:
  /// Runs on each thread until the server is stopped: accepts connections, and serves and closes
  /// one after the other.
  void run() EXCLUDES(mutex_);
  /// Serves one connection. Returns true if the caller must close the socket, false if the
  /// connection was taken over.
  bool serve(int socket) EXCLUDES(mutex_);
  /// Adds a connection to open_ and returns true. If the server is being stopped, or the address
  /// has too many connections, returns false. Then the caller must close the connection.
  bool enter(int socket, const std::string& address) EXCLUDES(mutex_);
  /// Removes the connection from open_.
  void leave(int socket) EXCLUDES(mutex_);
  /// Call after a failed accept; `error`: its errno. If file descriptors or memory have run out,
  /// waits a moment. Returns false if the server is being stopped.
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
