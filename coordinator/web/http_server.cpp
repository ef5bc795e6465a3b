#include "coordinator/web/http_server.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {

HttpServer::HttpServer(TlsContext tls) : tls_(std::move(tls)) {
  new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  // Not the library's SO_REUSEPORT: two coordinators would share the port in silence.
  set_socket_options([](socket_t socket) {
    const int on = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  });
  set_tcp_nodelay(true);
}

HttpServer::~HttpServer() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    for (const auto& [socket, address] : open_) {
      shutdown(socket, SHUT_RDWR);
    }
  }
  stop();
  if (thread_.joinable()) {
    thread_.join();
  }
}

absl::StatusOr<int> HttpServer::start(const std::string& host, int port) {
  const bool bound = port == 0 ? (port = bind_to_any_port(host)) > 0 : bind_to_port(host, port);
  if (!bound) {
    return absl::FailedPreconditionError(absl::StrCat("cannot listen on ", host, ":", port));
  }
  thread_ = std::thread([this] { listen_after_bind(); });
  // stop() before the loop has begun would not end it.
  while (!is_running()) {
    std::this_thread::yield();
  }
  return port;
}

bool HttpServer::enter(int socket, const std::string& address) {
  MutexLock lock(mutex_);
  const auto same = std::count_if(open_.begin(), open_.end(),
                                  [&](const auto& one) { return one.second == address; });
  if (stopping_ || same >= kMostOfOneAddress) {
    return false;
  }
  open_.emplace(socket, address);
  return true;
}

void HttpServer::leave(int socket) {
  MutexLock lock(mutex_);
  open_.erase(socket);
}

bool HttpServer::process_and_close_socket(socket_t socket) {
  {
    Connection connection(socket, tls_.get());
    if (enter(socket, connection.remote_address())) {
      serve(connection);
      connection.finish();
      leave(socket);
    }
  }
  close(socket);
  return true;
}

void HttpServer::serve(Connection& connection) {
  bool closed = false;
  if (connection.shake_hands()) {
    process_request(connection, true, closed, [&](httplib::Request&) { connection.begin_body(); });
  }
}

}  // namespace bandsaw::coordinator
