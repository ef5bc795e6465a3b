#include "coordinator/web/connection.h"

#include <fcntl.h>
#include <netdb.h>
#include <openssl/err.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace bandsaw::coordinator {
namespace {

using NameOf = int (*)(int, sockaddr*, socklen_t*);

void read_name(int socket, NameOf name_of, std::string& ip, int& port) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> service{};
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (name_of(socket, generic, &size) == 0 &&
      getnameinfo(generic, size, host.data(), host.size(), service.data(), service.size(),
                  NI_NUMERICHOST | NI_NUMERICSERV) == 0) {
    ip = host.data();
    port = std::atoi(service.data());
  }
}

}  // namespace

Connection::Connection(int socket, SSL_CTX* tls)
    : socket_(socket), ssl_(tls == nullptr ? nullptr : SSL_new(tls)) {
  fcntl(socket_, F_SETFL, fcntl(socket_, F_GETFL) | O_NONBLOCK);
  read_name(socket_, &getpeername, remote_, remote_port_);
  read_name(socket_, &getsockname, local_, local_port_);
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

bool Connection::wait_after(int tls_result, short plain_events) const {
  if (ssl_ == nullptr) {
    return (errno == EAGAIN || errno == EINTR) && wait(plain_events);
  }
  const int error = SSL_get_error(ssl_.get(), tls_result);
  return (error == SSL_ERROR_WANT_READ && wait(POLLIN)) ||
         (error == SSL_ERROR_WANT_WRITE && wait(POLLOUT));
}

bool Connection::shake_hands() {
  while (ssl_ != nullptr) {
    ERR_clear_error();
    const int result = SSL_accept(ssl_.get());
    if (result == 1) {
      break;
    }
    if (!wait_after(result, POLLIN)) {
      return false;
    }
  }
  return true;
}

void Connection::begin_body() {
  phase_ = Phase::kBody;
  deadline_ = Clock::now() + kPatience;
}

void Connection::earn(std::size_t bytes) {
  deadline_ += std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(static_cast<double>(bytes) / kSlowest));
}

bool Connection::fill() {
  while (true) {
    ERR_clear_error();
    const ssize_t got = ssl_ != nullptr
                            ? SSL_read(ssl_.get(), buffer_.data(), static_cast<int>(buffer_.size()))
                            : recv(socket_, buffer_.data(), buffer_.size(), 0);
    if (got > 0) {
      begin_ = 0;
      end_ = static_cast<std::size_t>(got);
      return true;
    }
    if ((got == 0 && ssl_ == nullptr) || !wait_after(static_cast<int>(got), POLLIN)) {
      return false;
    }
  }
}

ssize_t Connection::read(char* bytes, size_t size) {
  if (begin_ == end_ && !fill()) {
    return -1;
  }
  const std::size_t given = std::min(size, end_ - begin_);
  if (phase_ == Phase::kHead) {
    if (given > head_left_) {
      return -1;
    }
    head_left_ -= given;
  } else {
    earn(given);
  }
  std::memcpy(bytes, &buffer_[begin_], given);
  begin_ += given;
  return static_cast<ssize_t>(given);
}

ssize_t Connection::write(const char* bytes, size_t size) {
  if (phase_ != Phase::kAnswer) {
    phase_ = Phase::kAnswer;
    deadline_ = Clock::now() + kPatience;
  }
  constexpr std::size_t kMost = 1 << 20;
  while (true) {
    ERR_clear_error();
    const ssize_t sent = ssl_ != nullptr
                             ? SSL_write(ssl_.get(), bytes, static_cast<int>(std::min(size, kMost)))
                             : send(socket_, bytes, size, MSG_NOSIGNAL);
    if (sent > 0) {
      earn(static_cast<std::size_t>(sent));
      return sent;
    }
    if (!wait_after(static_cast<int>(sent), POLLOUT)) {
      return -1;
    }
  }
}

void Connection::finish() {
  if (ssl_ != nullptr && SSL_is_init_finished(ssl_.get()) != 0) {
    ERR_clear_error();
    SSL_shutdown(ssl_.get());
  }
  shutdown(socket_, SHUT_WR);
  deadline_ = Clock::now() + kLastWords;
  ssize_t got = 0;
  do {
    got = recv(socket_, buffer_.data(), buffer_.size(), 0);
  } while (got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR) && wait(POLLIN)));
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = remote_;
  port = remote_port_;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip = local_;
  port = local_port_;
}

}  // namespace bandsaw::coordinator
