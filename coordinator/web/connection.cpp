// Reads from a socket and writes to it, with or without TLS. The socket does not block: each
// operation is repeated, with poll() in between, until the operation succeeds or the deadline has
// passed.

#include "coordinator/web/connection.h"

#include <fcntl.h>
#include <netdb.h>
#include <openssl/err.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kMaxAtOnce = 1 << 20;  // bytes of one read or write; OpenSSL takes an int

struct Endpoint {
  std::string address;  ///< numeric
  int port = 0;
};

/// Returns the address and port of one end of a socket. `name_of`: getpeername or getsockname. The
/// result is empty if the socket has no numeric address.
Endpoint endpoint_of(int socket, int (*name_of)(int, sockaddr*, socklen_t*)) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (name_of(socket, generic, &size) != 0 ||
      (generic->sa_family != AF_INET && generic->sa_family != AF_INET6) ||
      getnameinfo(generic, size, host.data(), host.size(), service.data(), service.size(),
                  NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return {};
  }
  return {host.data(), std::atoi(service.data())};
}

}  // namespace

Connection::Connection(int socket, SSL_CTX* tls, std::chrono::milliseconds timeout)
    : socket_(socket),
      encrypted_(tls != nullptr),
      ssl_(tls == nullptr ? nullptr : SSL_new(tls)),
      timeout_(timeout),
      deadline_(Clock::now() + timeout),
      remote_(endpoint_of(socket, &getpeername).address),
      local_port_(endpoint_of(socket, &getsockname).port) {
  fcntl(socket_, F_SETFL, fcntl(socket_, F_GETFL) | O_NONBLOCK);
  if (ssl_ != nullptr) {
    SSL_set_fd(ssl_.get(), socket_);
    SSL_set_mode(ssl_.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  }
}

bool Connection::wait(short events) const {
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline_ - Clock::now()).count();
    if (left <= 0) {
      return false;
    }
    pollfd ready{socket_, events, 0};
    const int found = poll(&ready, 1, static_cast<int>(std::min<long>(left, 60'000)));
    if (found > 0) {
      return true;
    }
    if (found < 0 && errno != EINTR) {
      return false;
    }
  }
}

short Connection::events_after(int tls_result, short plain_events) const {
  if (ssl_ == nullptr) {
    return errno == EAGAIN || errno == EINTR ? plain_events : short{0};
  }
  switch (SSL_get_error(ssl_.get(), tls_result)) {
    case SSL_ERROR_WANT_READ:
      return POLLIN;
    case SSL_ERROR_WANT_WRITE:
      return POLLOUT;
    default:
      return 0;
  }
}

bool Connection::shake_hands() {
  if (!encrypted_) {
    return true;
  }
  while (ssl_ != nullptr) {  // nullptr: out of memory
    ERR_clear_error();
    const int result = SSL_accept(ssl_.get());
    if (result == 1) {
      return true;
    }
    if (const short events = events_after(result, POLLIN); events == 0 || !wait(events)) {
      return false;
    }
  }
  return false;
}

void Connection::begin_body() {
  in_head_ = false;
  deadline_ = Clock::now() + timeout_;
}

// The response gets as much time as a body.
void Connection::begin_answer() { begin_body(); }

void Connection::extend(std::size_t bytes) {
  if (!in_head_) {
    deadline_ += std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(static_cast<double>(bytes) / kMinBytesPerSecond));
  }
}

Connection::Attempt Connection::try_read(char* bytes, std::size_t size) {
  const std::size_t most = std::min(size, kMaxAtOnce);
  ERR_clear_error();
  const ssize_t got = ssl_ != nullptr ? SSL_read(ssl_.get(), bytes, static_cast<int>(most))
                                      : recv(socket_, bytes, most, 0);
  if (got > 0) {
    return {.bytes = static_cast<std::size_t>(got)};
  }
  if (got == 0 && ssl_ == nullptr) {
    return {};
  }
  return {.wait_for = events_after(static_cast<int>(got), POLLIN)};
}

Connection::Attempt Connection::try_write(const char* bytes, std::size_t size) {
  const std::size_t most = std::min(size, kMaxAtOnce);
  ERR_clear_error();
  const ssize_t sent = ssl_ != nullptr ? SSL_write(ssl_.get(), bytes, static_cast<int>(most))
                                       : send(socket_, bytes, most, MSG_NOSIGNAL);
  if (sent > 0) {
    return {.bytes = static_cast<std::size_t>(sent)};
  }
  return {.wait_for = events_after(static_cast<int>(sent), POLLOUT)};
}

template <class Try>
std::size_t Connection::repeat(Try attempt) {
  while (Clock::now() < deadline_) {
    const Attempt done = attempt();
    if (done.bytes > 0) {
      extend(done.bytes);
      return done.bytes;
    }
    if (done.wait_for == 0 || !wait(done.wait_for)) {
      return 0;
    }
  }
  return 0;
}

std::size_t Connection::read(char* bytes, std::size_t size) {
  return repeat([&] { return try_read(bytes, size); });
}

std::size_t Connection::write(const char* bytes, std::size_t size) {
  return repeat([&] { return try_write(bytes, size); });
}

void Connection::end_sending() {
  if (ssl_ != nullptr && SSL_is_init_finished(ssl_.get()) != 0) {
    ERR_clear_error();
    SSL_shutdown(ssl_.get());
  }
  shutdown(socket_, SHUT_WR);
}

void Connection::finish() {
  end_sending();
  deadline_ = Clock::now() + kFinishTimeout;
  std::array<char, 16 << 10> ignored;
  ssize_t got = 0;
  do {
    got = recv(socket_, ignored.data(), ignored.size(), 0);
  } while (got > 0 ? Clock::now() < deadline_
                   : got < 0 && (errno == EAGAIN || errno == EINTR) && wait(POLLIN));
}

}  // namespace bandsaw::coordinator
