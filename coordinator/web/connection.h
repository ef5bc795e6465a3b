#pragma once

// One connection of a browser, for one request. It has a deadline as a whole, not for each read, so
// that who sends or takes a byte now and then holds a thread no longer than who does nothing.

#include <httplib.h>
#include <openssl/ssl.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

namespace bandsaw::coordinator {

/// Used by one thread. The socket stays the caller's.
class Connection final : public httplib::Stream {
 public:
  /// The request's head, with the TLS handshake, must come within this time and in so many bytes.
  static constexpr std::chrono::seconds kPatience{10};
  static constexpr std::uint64_t kMostHead = 32 << 10;
  /// A body, either way, has the same time and a second more for each so many bytes that passed.
  static constexpr double kSlowest = 32 << 10;
  static constexpr std::chrono::seconds kLastWords{2};

  /// `tls` may be null: plaintext.
  Connection(int socket, SSL_CTX* tls);

  /// False: the other end speaks no TLS, or not in time.
  bool shake_hands();
  /// The head is read: what comes is the body.
  void begin_body();
  /// Says that no more comes, and takes what still comes: closing a socket with unread bytes would
  /// take the answer back.
  void finish();
  /// Numeric.
  const std::string& remote_address() const { return remote_; }

  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* bytes, size_t size) override;
  ssize_t write(const char* bytes, size_t size) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  /// None: the library wants it for select(), which a coordinator with a thousand workers is
  /// beyond.
  socket_t socket() const override { return INVALID_SOCKET; }

 private:
  struct FreeSsl {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };
  using Clock = std::chrono::steady_clock;
  enum class Phase { kHead, kBody, kAnswer };

  /// Until the socket is ready for `events` of poll; false: the deadline passed.
  bool wait(short events) const;
  /// What went wrong is waited for; false: it cannot be mended.
  bool wait_after(int tls_result, short plain_events) const;
  bool fill();
  void earn(std::size_t bytes);

  const int socket_;
  const std::unique_ptr<SSL, FreeSsl> ssl_;
  Phase phase_ = Phase::kHead;
  Clock::time_point deadline_ = Clock::now() + kPatience;
  std::uint64_t head_left_ = kMostHead;
  std::array<char, 16 << 10> buffer_{};
  std::size_t begin_ = 0;  ///< of what is in the buffer and not read yet
  std::size_t end_ = 0;
  std::string remote_;
  std::string local_;
  int remote_port_ = 0;
  int local_port_ = 0;
};

}  // namespace bandsaw::coordinator
