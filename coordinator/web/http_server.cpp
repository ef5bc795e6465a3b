// The server has a fixed number of threads. Each accepts a connection, serves it, and accepts the
// next one.

#include "coordinator/web/http_server.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/web/exchange.h"

namespace bandsaw::coordinator {
namespace {

/// Time before the next accept, if the last one failed because file descriptors or memory ran out.
constexpr std::chrono::milliseconds kWaitForDescriptors{100};

struct FreeAddresses {
  void operator()(addrinfo* addresses) const { freeaddrinfo(addresses); }
};

void switch_on(int socket, int level, int option) {
  const int on = 1;
  setsockopt(socket, level, option, &on, sizeof(on));
}

/// Returns a socket that listens at this address, or -1 with errno.
int listen_at(const addrinfo& address) {
  const int listener = socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC, 0);
  if (listener < 0) {
    return -1;
  }
  // With SO_REUSEPORT, two coordinators would share the port without an error. So this option is
  // not set.
  switch_on(listener, SOL_SOCKET, SO_REUSEADDR);
  if (address.ai_family == AF_INET6) {
    const int off = 0;  // "::" also accepts IPv4
    setsockopt(listener, IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof(off));
  }
  if (bind(listener, address.ai_addr, address.ai_addrlen) == 0 &&
      listen(listener, SOMAXCONN) == 0) {
    return listener;
  }
  const int error = errno;
  close(listener);
  errno = error;
  return -1;
}

/// Returns a socket that listens at the first usable address of the host.
absl::StatusOr<int> listen_on(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  const std::unique_ptr<addrinfo, FreeAddresses> addresses(failed == 0 ? found : nullptr);
  std::string why = failed == 0 ? "it has no address" : gai_strerror(failed);
  for (const addrinfo* one = addresses.get(); one != nullptr; one = one->ai_next) {
    if (const int socket = listen_at(*one); socket >= 0) {
      return socket;
    }
    why = std::strerror(errno);
  }
  return absl::FailedPreconditionError(
      absl::StrCat("cannot listen on ", host, ":", port, ": ", why));
}

/// Returns the port at which the socket listens.
absl::StatusOr<int> port_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return absl::InternalError("a listening socket has no address");
  }
  return ntohs(address.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                   : reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

HttpServer::HttpServer(TlsContext tls, std::vector<HttpField> headers, HttpHandler handler)
    : tls_(std::move(tls)), headers_(std::move(headers)), handler_(std::move(handler)) {}

HttpServer::~HttpServer() {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
  }
  cut();
  stopped_.notify_all();
  shutdown(listener_, SHUT_RDWR);  // ends every accept
  for (std::thread& thread : threads_) {
    thread.join();
  }
  if (listener_ >= 0) {
    close(listener_);
  }
}

void HttpServer::cut() {
  MutexLock lock(mutex_);
  for (const auto& [socket, address] : open_) {
    shutdown(socket, SHUT_RDWR);
  }
}

absl::StatusOr<int> HttpServer::start(const std::string& host, int port) {
  absl::StatusOr<int> listener = listen_on(host, port);
  if (!listener.ok()) {
    return listener.status();
  }
  listener_ = *listener;
  for (int i = 0; i < kThreads; ++i) {
    threads_.emplace_back([this] { run(); });
  }
  return port_of(listener_);
}

void HttpServer::run() {
  sigset_t pipe;
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe, nullptr);  // OpenSSL writes without MSG_NOSIGNAL
  while (true) {
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket >= 0) {
      if (serve(socket)) {
        close(socket);
      }
    } else if (!may_accept_again(errno)) {
      return;
    }
  }
}

bool HttpServer::may_accept_again(int error) {
  MutexLock lock(mutex_);
  if (!stopping_ && (error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM)) {
    stopped_.wait_for(mutex_, kWaitForDescriptors);
  }
  return !stopping_;
}

bool HttpServer::enter(int socket, const std::string& address) {
  MutexLock lock(mutex_);
  const auto same = std::count_if(open_.begin(), open_.end(),
                                  [&](const auto& one) { return one.second == address; });
  if (stopping_ || same >= kMaxOfOneAddress) {
    return false;
  }
  open_.emplace(socket, address);
  return true;
}

void HttpServer::leave(int socket) {
  MutexLock lock(mutex_);
  open_.erase(socket);
}

bool HttpServer::serve(int socket) {
  switch_on(socket, IPPROTO_TCP, TCP_NODELAY);
  auto connection = std::make_unique<Connection>(socket, tls_.get());
  if (!enter(socket, connection->remote_address())) {
    return true;
  }
  TakeOver take_over;
  if (connection->shake_hands()) {
    take_over = exchange(*connection, handler_, headers_);
  }
  if (take_over) {
    leave(socket);
    take_over(std::move(connection));
    return false;
  }
  connection->finish();
  leave(socket);
  return true;
}

}  // namespace bandsaw::coordinator
