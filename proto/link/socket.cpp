// Calls the non-blocking functions of the system, and waits with poll() until the deadline.

#include "proto/link/socket.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace bandsaw::link {
namespace {

absl::Status unavailable(int error) {
  return absl::UnavailableError(absl::AsciiStrToLower(std::strerror(error)));
}

/// Waits with poll() for `events` of `fd`. UNAVAILABLE: the deadline has passed, or
/// `deadline.stopped` returned true.
absl::Status wait_for(int fd, short events, const Deadline& deadline) {
  using std::chrono::milliseconds;
  while (true) {
    const auto left =
        std::chrono::duration_cast<milliseconds>(deadline.end - std::chrono::steady_clock::now());
    const milliseconds slice =
        std::max(milliseconds(0), deadline.stopped ? std::min(Deadline::kInterval, left) : left);
    pollfd watched{.fd = fd, .events = events, .revents = 0};
    const int ready = poll(&watched, 1, static_cast<int>(slice.count()));
    if (ready > 0) {
      return absl::OkStatus();
    }
    if (ready < 0 && errno != EINTR) {
      return unavailable(errno);
    }
    if (deadline.is_stopped()) {
      return absl::UnavailableError("interrupted");
    }
    if (ready == 0 && left <= slice) {
      return absl::UnavailableError("no answer in time");
    }
  }
}

/// Connects the non-blocking socket `fd` to one address.
absl::Status connect_one(int fd, const addrinfo& info, const Deadline& deadline) {
  if (::connect(fd, info.ai_addr, info.ai_addrlen) == 0) {
    return absl::OkStatus();
  }
  if (errno != EINPROGRESS) {
    return unavailable(errno);
  }
  if (absl::Status status = wait_for(fd, POLLOUT, deadline); !status.ok()) {
    return status;
  }
  int error = 0;
  socklen_t size = sizeof(error);
  if (getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error != 0) {
    return unavailable(error != 0 ? error : errno);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Socket> Socket::connect(const std::string& address, const Deadline& deadline) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos) {
    return absl::InvalidArgumentError(absl::StrCat("'", address, "' is not HOST:PORT"));
  }
  std::string host = address.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), address.substr(colon + 1).c_str(), &hints, &found);
  if (error != 0) {
    return absl::UnavailableError(absl::AsciiStrToLower(gai_strerror(error)));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> list(found, &freeaddrinfo);
  return connect(list.get(), deadline);
}

absl::StatusOr<Socket> Socket::connect(const addrinfo* list, const Deadline& deadline) {
  int left = 0;
  for (const addrinfo* info = list; info != nullptr; info = info->ai_next) {
    ++left;
  }
  absl::Status last = absl::UnavailableError("no such host");
  for (const addrinfo* info = list; info != nullptr; info = info->ai_next, --left) {
    const auto now = std::chrono::steady_clock::now();
    Socket socket(::socket(info->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    last = socket.fd_ < 0 ? unavailable(errno)
                          : connect_one(socket.fd_, *info,
                                        {now + (deadline.end - now) / left, deadline.stopped});
    if (last.ok()) {
      return socket;
    }
  }
  return last;
}

Socket::Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

Socket::~Socket() {
  if (fd_ >= 0) {
    close(fd_);
  }
}

bool Socket::is_to_this_machine() const {
  sockaddr_storage peer{};
  socklen_t size = sizeof(peer);
  if (getpeername(fd_, reinterpret_cast<sockaddr*>(&peer), &size) != 0) {
    return false;
  }
  if (peer.ss_family == AF_INET) {
    reinterpret_cast<sockaddr_in&>(peer).sin_port = 0;  // any free port
  } else if (peer.ss_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6&>(peer).sin6_port = 0;
  }
  // Only an address of this machine can be bound. To compare the addresses of both ends would not
  // be enough, because they can differ on one machine: a connection to 127.0.0.2 comes from
  // 127.0.0.1.
  const Socket probe(::socket(peer.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return bind(probe.fd_, reinterpret_cast<const sockaddr*>(&peer), size) == 0;
}

absl::Status Socket::send(const std::string& bytes, const Deadline& deadline) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t sent = ::send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (sent >= 0) {
      done += static_cast<std::size_t>(sent);
    } else if (errno == EAGAIN) {
      if (absl::Status status = wait_for(fd_, POLLOUT, deadline); !status.ok()) {
        return status;
      }
    } else if (errno != EINTR) {
      return unavailable(errno);
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<std::string> Socket::receive(const Deadline& deadline) {
  std::string bytes(16 << 10, '\0');
  while (true) {
    const ssize_t got = recv(fd_, bytes.data(), bytes.size(), 0);
    if (got > 0) {
      bytes.resize(static_cast<std::size_t>(got));
      return bytes;
    }
    if (got == 0) {
      return absl::UnavailableError("the connection was closed");
    }
    if (errno == EAGAIN) {
      if (absl::Status status = wait_for(fd_, POLLIN, deadline); !status.ok()) {
        return status;
      }
    } else if (errno != EINTR) {
      return unavailable(errno);
    }
  }
}

}  // namespace bandsaw::link
