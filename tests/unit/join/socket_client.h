#pragma once

// A blocking WebSocket client for tests. It takes the place of the page /join in a browser's tab.
// The server is on loopback.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "proto/farm.pb.h"

namespace bandsaw::test {

/// The handshake of a client. The secret is sent as one of the WebSocket's protocols, because a
/// page can set no other header of a WebSocket handshake.
struct SocketOffer {
  std::string secret;  ///< secret of the link for browsers
  std::string protocol = "bandsaw.1";
  std::string origin = {};  ///< empty: the origin of the server
  std::string target = "/join/session";
};

class SocketClient {
 public:
  /// Connects and sends the handshake. `receive_buffer`: size of the socket's receive buffer in
  /// bytes; 0: the system's default.
  SocketClient(int port, const SocketOffer& offer, int receive_buffer = 0);
  ~SocketClient();

  /// HTTP status of the response to the handshake: 101 (accepted) or the status of a refusal. 0: no
  /// response came.
  int status() const { return status_; }
  /// Body of a refusal.
  const std::string& refusal() const { return refusal_; }
  /// Protocol that the server chose.
  const std::string& protocol() const { return protocol_; }

  /// Sends one message. Returns false if the connection has ended.
  bool send(const farm::FromWorker& message);
  /// Sends one message of these bytes, as binary or as text. Returns false if the connection has
  /// ended.
  bool send_bytes(const std::string& bytes, bool binary = true);
  /// Sends these bytes to the TCP socket, without a WebSocket frame around them.
  void send_raw(const std::string& bytes);
  /// Returns the next message; std::nullopt: the session has ended.
  std::optional<farm::ToWorker> read();
  /// Reads until the session has ended.
  void read_to_end();
  /// Code and reason of the server's close frame, after read() has returned std::nullopt. The
  /// code is 0 if the server sent no close frame.
  std::uint16_t close_code() const { return code_; }
  const std::string& close_reason() const { return reason_; }
  /// Number of pings that read() has answered. Thread-safe.
  int pings() const { return pings_; }
  /// Ends the connection without a close frame.
  void vanish();
  /// Ends the session by a close frame, as a browser does.
  void close();

 private:
  struct Socket;
  const std::unique_ptr<Socket> socket_;
  std::atomic<int> pings_ = 0;
  int status_ = 0;
  std::string refusal_, protocol_;
  std::uint16_t code_ = 0;
  std::string reason_;
};

}  // namespace bandsaw::test
