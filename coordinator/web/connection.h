#pragma once

// One connection of a browser, for one request. It has a deadline as a whole, not for each read, so
// that a peer which sends or takes a byte now and then holds a thread no longer than a silent one.

#include <openssl/ssl.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

namespace bandsaw::coordinator {

/// Used by one thread, in this order: shake_hands, reads of the head, begin_body, reads of the
/// body, begin_answer, writes, finish. The socket stays the caller's. With TLS a write may raise
/// SIGPIPE: the thread MUST block it.
class Connection {
 public:
  /// The request's head, with the TLS handshake, must come within this time.
  static constexpr std::chrono::milliseconds kPatience{10'000};
  /// A body, in either direction, has the same time, and a second more for each so many bytes that
  /// passed.
  static constexpr double kMinBytesPerSecond = 32 << 10;
  /// How long finish() waits for the other end.
  static constexpr std::chrono::seconds kLastWords{2};

  /// `tls` may be null: plaintext.
  Connection(int socket, SSL_CTX* tls, std::chrono::milliseconds patience = kPatience);

  /// False: the other end does not speak TLS, or not in time.
  bool shake_hands();
  /// The head was read: the body has a time of its own.
  void begin_body();
  /// The body was read, as far as it is wanted: the answer has a time of its own.
  void begin_answer();
  /// Waits for bytes and reads at most `size`, which is not 0. Gives their number; 0: the
  /// connection ended, or its time is over.
  std::size_t read(char* bytes, std::size_t size);
  /// Writes at most `size` bytes, which is not 0, as soon as some can be written. Result as of
  /// read.
  std::size_t write(const char* bytes, std::size_t size);
  /// Tells the other end that no more comes, and reads what it still sends: closing a socket with
  /// unread bytes would make the system discard the answer.
  void finish();

  /// Numeric; empty: not known.
  const std::string& remote_address() const { return remote_; }
  /// 0: not known.
  int local_port() const { return local_port_; }

 private:
  struct FreeSsl {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };
  using Clock = std::chrono::steady_clock;

  /// Waits until the socket is ready for `events` of poll; false: the deadline passed.
  bool wait(short events) const;
  /// Waits for what an unfinished read or write of this result needs; false: it failed for good.
  bool wait_after(int tls_result, short plain_events) const;
  /// The time that this many bytes of a body add to the deadline.
  void extend(std::size_t bytes);

  const int socket_;
  const bool encrypted_;
  const std::unique_ptr<SSL, FreeSsl> ssl_;
  const std::chrono::milliseconds patience_;
  bool in_head_ = true;
  Clock::time_point deadline_;
  std::string remote_;
  int local_port_ = 0;
};

}  // namespace bandsaw::coordinator
