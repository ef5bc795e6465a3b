#pragma once

// A TCP connection with deadlines, used to see which server answers at an address before gRPC
// connects.

#include <netdb.h>

#include <chrono>
#include <functional>
#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::link {

/// The operations of a socket wait until `end`, or until `stopped` returns true. `stopped` is
/// called every `kInterval`. If it is empty, only the time ends a wait.
struct Deadline {
  static constexpr std::chrono::milliseconds kInterval{100};
  std::chrono::steady_clock::time_point end;
  std::function<bool()> stopped = {};

  bool is_stopped() const { return stopped && stopped(); }
};

/// Owns a connected, non-blocking socket. Every wait ends at the deadline with UNAVAILABLE. Only
/// the look-up of a name by the system's resolver has no deadline.
class Socket {
 public:
  /// Connects to `address`, HOST:PORT or [IPv6]:PORT. UNAVAILABLE: nobody accepts the connection,
  /// or there is no such host. INVALID_ARGUMENT: the address has no port.
  static absl::StatusOr<Socket> connect(const std::string& address, const Deadline& deadline);
  /// Tries the addresses of a resolved name in order, and connects to the first one that accepts.
  /// Before each attempt, the remaining time is divided equally among the remaining addresses.
  /// The caller keeps ownership of `list`.
  static absl::StatusOr<Socket> connect(const addrinfo* list, const Deadline& deadline);
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&&) = delete;
  ~Socket();

  /// Returns whether the other end is on this machine: the connection went to loopback or to
  /// another of the machine's own addresses.
  bool is_to_this_machine() const;
  /// Sends all bytes. UNAVAILABLE: the connection is broken, or not all were sent in time.
  absl::Status send(const std::string& bytes, const Deadline& deadline);
  /// Returns at least one byte. UNAVAILABLE: closed by the other side, or no answer in time.
  absl::StatusOr<std::string> receive(const Deadline& deadline);

 private:
  explicit Socket(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace bandsaw::link
