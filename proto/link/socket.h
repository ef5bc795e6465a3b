#pragma once

// A plain TCP connection with a deadline: to see who answers at an address before gRPC is let near
// it.

#include <chrono>
#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::link {

using Deadline = std::chrono::steady_clock::time_point;

/// Owns a connected, non-blocking socket. Every wait ends at the deadline with UNAVAILABLE.
class Socket {
 public:
  /// `address` is HOST:PORT or [IPv6]:PORT. UNAVAILABLE: "connection refused", "no such host", "no
  /// answer", ….
  static absl::StatusOr<Socket> connect(const std::string& address, Deadline deadline);
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&&) = delete;
  ~Socket();

  absl::Status send(const std::string& bytes, Deadline deadline);
  /// At least one byte. UNAVAILABLE: closed by the other side, or no answer.
  absl::StatusOr<std::string> receive(Deadline deadline);

 private:
  explicit Socket(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace bandsaw::link
