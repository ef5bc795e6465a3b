#pragma once

// The HTTP server under the dashboard: cpp-httplib with one request a connection, bounded threads,
// bounded connections of one address, a deadline for each connection, and TLS from memory.

#include <httplib.h>

#include <map>
#include <string>
#include <thread>

#include "absl/status/statusor.h"
#include "coordinator/web/connection.h"
#include "coordinator/web/tls.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class HttpServer final : public httplib::Server {
 public:
  static constexpr std::size_t kThreads = 32;
  static constexpr int kMostOfOneAddress = 24;

  /// `tls` may be null: plaintext.
  explicit HttpServer(TlsContext tls);
  /// Cuts every connection.
  ~HttpServer() override;

  /// Listens from its return on, with the handlers that are set by then; the port.
  /// FAILED_PRECONDITION: it cannot be had.
  absl::StatusOr<int> start(const std::string& host, int port);

 private:
  /// Its thread may close the socket when nobody else knows it any more.
  bool process_and_close_socket(socket_t socket) override EXCLUDES(mutex_);
  void serve(Connection& connection);
  bool enter(int socket, const std::string& address) EXCLUDES(mutex_);
  void leave(int socket) EXCLUDES(mutex_);

  const TlsContext tls_;
  std::thread thread_;
  Mutex mutex_;
  bool stopping_ GUARDED_BY(mutex_) = false;
  std::map<int, std::string> open_ GUARDED_BY(mutex_);  ///< address by socket
};

}  // namespace bandsaw::coordinator
