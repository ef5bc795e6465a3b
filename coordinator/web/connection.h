#pragma once

// One connection of a client to the dashboard, for one request, with TLS or without. The head, the
// body and the response have one deadline each, for all reads or writes together. So a peer that
// transfers a byte now and then occupies a thread hardly longer than a silent peer.

#include <openssl/ssl.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

namespace bandsaw::coordinator {

/// Used by one thread, in this order: shake_hands, reads of the head, begin_body, reads of the
/// body, begin_answer, writes, finish. The caller keeps the ownership of the socket. With TLS a
/// write may raise SIGPIPE, so the thread MUST block this signal.
class Connection {
 public:
  /// The request's head, with the TLS handshake, must come within this time.
  static constexpr std::chrono::milliseconds kTimeout{10'000};
  /// The transfer of a body, in either direction, has kTimeout plus one second for each
  /// kMinBytesPerSecond bytes that were transferred.
  static constexpr double kMinBytesPerSecond = 32 << 10;
  /// Time that finish() waits for the peer.
  static constexpr std::chrono::seconds kFinishTimeout{2};

  /// `tls` may be nullptr: plaintext.
  Connection(int socket, SSL_CTX* tls, std::chrono::milliseconds timeout = kTimeout);

  /// Returns false if the TLS handshake failed or was not finished in time.
  bool shake_hands();
  /// Call after the head was read: starts the time of the body.
  void begin_body();
  /// Call after the needed part of the body was read: starts the time of the response.
  void begin_answer();
  /// Waits for bytes and reads at most `size`, which is not 0. Returns their number; 0: the
  /// connection has ended, or its deadline has passed.
  std::size_t read(char* bytes, std::size_t size);
  /// Writes at most `size` bytes, which is not 0, as soon as some can be written. Returns how many
  /// bytes it wrote; 0: the connection has ended, or its deadline has passed.
  std::size_t write(const char* bytes, std::size_t size);

  /// Result of one attempt to read or write. If `bytes` and `wait_for` are both 0, the connection
  /// has ended.
  struct Attempt {
    std::size_t bytes = 0;
    short wait_for = 0;  ///< the attempt can be repeated after these events of poll
  };
  /// These functions read or write what is possible at once. Unlike read() and write(), they do not
  /// wait, and no deadline ends them.
  Attempt try_read(char* bytes, std::size_t size);
  Attempt try_write(const char* bytes, std::size_t size);

  /// Ends the sending direction. With TLS, sends close_notify, because without it the peer cannot
  /// distinguish this end from a connection that somebody has cut.
  void end_sending();
  /// Ends the sending direction and reads what the peer still sends, because closing a socket with
  /// unread bytes would make the system discard the response.
  void finish();

  int socket() const { return socket_; }
  /// Numeric address of the peer; empty: unknown.
  const std::string& remote_address() const { return remote_; }
  /// Returns the port of this end; 0: unknown.
  int local_port() const { return local_port_; }

 private:
  struct FreeSsl {
    void operator()(SSL* ssl) const { SSL_free(ssl); }
  };
  using Clock = std::chrono::steady_clock;

  /// Repeats an attempt until it has moved bytes; returns 0 if it failed or the deadline passed.
  template <class Try>
  std::size_t repeat(Try attempt);
  /// Waits until the socket is ready for `events` of poll; false: the deadline passed.
  bool wait(short events) const;
  /// Returns the events after which an unfinished operation with this result can continue; 0: it
  /// has failed. `plain_events` are the events of an operation without TLS.
  short events_after(int tls_result, short plain_events) const;
  /// Moves the deadline by the time that this many transferred bytes of a body allow.
  void extend(std::size_t bytes);

  const int socket_;
  const bool encrypted_;
  const std::unique_ptr<SSL, FreeSsl> ssl_;
  const std::chrono::milliseconds timeout_;
  bool in_head_ = true;  ///< until begin_body(); the deadline of the head is not extended
  Clock::time_point deadline_;
  std::string remote_;
  int local_port_ = 0;
};

}  // namespace bandsaw::coordinator
