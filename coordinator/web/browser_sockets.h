#pragma once

// The sessions of browsers that render. Each session has one WebSocket (RFC 6455), and one thread
// serves all sessions. A session carries the same messages as the session of a native worker
// (Work.Session).

#include <chrono>
#include <cstddef>
#include <memory>

#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/web/browser_leases.h"
#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

struct BrowserSocketLimits {
  std::size_t sockets = 256;  ///< maximum number; further ones are refused
  /// Maximum time for the handshake, and for closing.
  std::chrono::milliseconds handshake{10'000};
  /// A browser that sends nothing for this long has vanished. The server pings after half of this
  /// time.
  std::chrono::milliseconds idle{12'000};
  /// Maximum time for sending one message to a browser that does not read.
  std::chrono::milliseconds write{10'000};
  /// Bytes that the system keeps for a browser that does not read.
  int send_buffer = 64 << 10;
  /// Interval at which the server checks whether the invitation link by which each browser joined
  /// is still valid.
  std::chrono::milliseconds link_check{500};
  /// Time in which the sessions may close when the server stops.
  std::chrono::milliseconds stop{1'000};
};

/// Name of the protocol in the header Sec-WebSocket-Protocol. A second word of this header begins
/// with kJoinSecretPrefix and has the link's secret, because a page can set no other header of a
/// WebSocket handshake.
inline constexpr char kJoinProtocol[] = "bandsaw.1";
inline constexpr char kJoinSecretPrefix[] = "bandsaw.secret.";

/// Thread-safe. Each message is one serialised farm.FromWorker or farm.ToWorker, with the rules of
/// Work.Session. A session is closed with the code 1008 if the browser broke these rules, 1001 when
/// the coordinator stops, 4401 when the link has ended or was revoked, 4409 when the scheduler
/// ended the session (the browser may join again), 1013 for a browser that does not read.
class BrowserSockets {
 public:
  /// The arguments outlive the object.
  BrowserSockets(Engine& engine, BrowserAccess& access, BrowserLeases& leases,
                 const BrowserSocketLimits& limits);
  /// Closes all sessions with the code 1001.
  ~BrowserSockets();
  BrowserSockets(const BrowserSockets&) = delete;
  BrowserSockets& operator=(const BrowserSockets&) = delete;

  /// Answers GET /join/session: begins a session, or refuses with the reason. The session's
  /// connection belongs to this object, not to the HTTP server.
  HttpReply answer(const HttpRequest& request);

 private:
  class Impl;
  const std::unique_ptr<Impl> impl_;
};

}  // namespace bandsaw::coordinator
