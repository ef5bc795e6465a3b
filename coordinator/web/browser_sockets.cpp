// One thread serves all sockets. Messages of a tab are forwarded to the engine; messages of the
// engine are put into a queue for each tab (WorkerSession).

#include "coordinator/web/browser_sockets.h"

#include <signal.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "coordinator/rpc/worker_session.h"
#include "coordinator/web/access.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/socket_stream.h"

namespace bandsaw::coordinator {
namespace {

namespace websocket = boost::beast::websocket;
using ErrorCode = boost::beast::error_code;
using IoContext = boost::asio::io_context;

/// The longest message of a worker, BandFailed with its lines of log, has 28 kB.
constexpr std::size_t kMaxMessageBytes = 64 << 10;
constexpr std::size_t kMaxReasonBytes = 123;  // RFC 6455, section 5.5

/// Returns the code of a session that ends with this status, as in browser_sockets.h.
websocket::close_code close_code_of(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
    case absl::StatusCode::kCancelled:
      return websocket::close_code::normal;
    case absl::StatusCode::kInvalidArgument:
      return websocket::close_code::policy_error;
    case absl::StatusCode::kUnavailable:
      return websocket::close_code::going_away;
    case absl::StatusCode::kUnauthenticated:
      return websocket::close_code{4401};
    case absl::StatusCode::kAborted:
      return websocket::close_code{4409};
    case absl::StatusCode::kResourceExhausted:
      return websocket::close_code::try_again_later;
    default:
      return websocket::close_code::internal_error;
  }
}

/// Shortens a reason to the length that a close frame can hold. Cuts it only at the beginning of a
/// UTF-8 character.
std::string shortened(absl::string_view text) {
  std::size_t size = std::min(text.size(), kMaxReasonBytes);
  while (size < text.size() && size > 0 && (text[size] & 0xC0) == 0x80) {
    --size;
  }
  return std::string(text.substr(0, size));
}

/// Returns the secret in the protocols that the browser offers; empty: there is none, or
/// kJoinProtocol is not offered.
std::string offered_secret(const HttpRequest& request) {
  bool knows_protocol = false;
  std::string secret;
  for (absl::string_view one : absl::StrSplit(request.header("Sec-WebSocket-Protocol"), ',')) {
    one = absl::StripAsciiWhitespace(one);
    knows_protocol = knows_protocol || one == kJoinProtocol;
    if (absl::ConsumePrefix(&one, kJoinSecretPrefix)) {
      secret = std::string(one);
    }
  }
  return knows_protocol ? secret : "";
}

}  // namespace

/// One session. The base class has the protocol and the queue of messages; this class has the
/// WebSocket. The members of this class are used by the thread of `io` only, except where the base
/// class says otherwise. The engine may keep the object for a while after the server was destroyed.
class BrowserSocket final : public WorkerSession,
                            public std::enable_shared_from_this<BrowserSocket> {
 public:
  struct Parts {
    std::shared_ptr<IoContext> io;
    Engine& engine;
    BrowserLeases& leases;
    BrowserSocketLimits limits;
    std::unique_ptr<Connection> connection;
    std::string secret;
    std::shared_ptr<const void> place;  ///< counts as one of the allowed sockets while it exists
  };
  /// Called once, when the session has ended.
  using Gone = std::function<void(const std::shared_ptr<BrowserSocket>&)>;

  BrowserSocket(Parts parts, Gone gone)
      : WorkerSession(parts.engine, parts.connection->remote_address(), /*browser=*/true),
        io_(std::move(parts.io)),
        leases_(parts.leases),
        limits_(parts.limits),
        secret_(std::move(parts.secret)),
        place_(std::move(parts.place)),
        gone_(std::move(gone)),
        timer_(*io_),
        stream_(*io_, std::move(parts.connection)) {
    stream_.next_layer().set_send_buffer(limits_.send_buffer);
  }

  /// Answers the WebSocket handshake of `request`, and begins to read messages.
  void begin(const HttpRequest& request) {
    stream_.set_option(websocket::stream_base::timeout{limits_.handshake, limits_.idle,
                                                       /*keep_alive_pings=*/true});
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(boost::beast::http::field::sec_websocket_protocol, kJoinProtocol);
    }));
    stream_.read_message_max(kMaxMessageBytes);
    stream_.binary(true);
    boost::beast::http::request<boost::beast::http::empty_body> head(boost::beast::http::verb::get,
                                                                     request.path, /*version=*/11);
    for (const auto& [name, value] : request.headers) {
      head.insert(name, value);
    }
    stream_.async_accept(head, [self = shared_from_this()](ErrorCode error) {
      if (error) {
        self->end_after_queue(absl::CancelledError("the handshake failed"));
      } else {
        self->read();
      }
    });
  }

  const std::string& secret() const { return secret_; }
  /// Closes the session with the code of `why`.
  void stop(const absl::Status& why) { end_now(why); }
  /// Closes the connection without a message.
  void cut() { stream_.next_layer().close(); }

  void lease(const action::Lease& lease) override {
    leases_.add(instance_, lease);
    WorkerSession::lease(lease);
  }

 private:
  using Clock = boost::asio::steady_timer::clock_type;

  // read_next(), write() and finish() may be called by any thread.
  void read_next() override {
    boost::asio::post(*io_, [self = shared_from_this()] { self->read(); });
  }
  void write(const farm::ToWorker& message) override {
    boost::asio::post(*io_, [self = shared_from_this(), bytes = message.SerializeAsString()] {
      self->write_bytes(bytes);
    });
  }
  void finish(const absl::Status& status) override {
    boost::asio::post(*io_, [self = shared_from_this(), status = unshared_status(status)] {
      self->close_stream(status);
    });
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      self->take_message(error);
    });
  }

  void take_message(ErrorCode error) {
    if (error) {
      end_after_queue(error == boost::beast::error::timeout
                          ? absl::CancelledError("it answers no more")
                          : absl::OkStatus());
      return;
    }
    farm::FromWorker message;
    if (!stream_.got_binary() ||
        !message.ParseFromArray(buffer_.cdata().data(), static_cast<int>(buffer_.size()))) {
      end_after_queue(
          absl::InvalidArgumentError("each message must be binary: a serialised FromWorker"));
      return;
    }
    buffer_.consume(buffer_.size());
    if (message.has_hello() && instance_.empty()) {
      instance_ = message.hello().instance();
    }
    received(message, shared_from_this());
  }

  void write_bytes(const std::string& bytes) {
    bytes_ = bytes;
    cut_after(limits_.write);
    stream_.async_write(boost::asio::buffer(bytes_),
                        [self = shared_from_this()](ErrorCode error, std::size_t) {
                          self->timer_.expires_at(Clock::time_point::max());
                          self->sent(!error);
                        });
  }

  void close_stream(const absl::Status& status) {
    if (!stream_.is_open()) {
      end();
      return;
    }
    cut_after(limits_.handshake);
    const websocket::close_reason reason(close_code_of(status),
                                         shortened(std::string(status.message())));
    stream_.async_close(reason, [self = shared_from_this()](ErrorCode) { self->end(); });
  }

  /// Cuts the connection after this time, unless timer_ is set again before.
  void cut_after(std::chrono::milliseconds time) {
    timer_.expires_after(time);
    timer_.async_wait([self = shared_from_this()](ErrorCode) {
      if (self->timer_.expiry() <= Clock::now()) {  // false: timer_ was set again meanwhile
        self->cut();
      }
    });
  }

  /// Ends the session: cuts the connection, frees its place, and calls gone_.
  void end() {
    timer_.expires_at(Clock::time_point::max());
    cut();
    over();
    place_.reset();
    gone_(shared_from_this());
  }

  // Declared first, so that it is destroyed after the members that use it.
  const std::shared_ptr<IoContext> io_;
  BrowserLeases& leases_;
  const BrowserSocketLimits limits_;
  const std::string secret_;
  std::shared_ptr<const void> place_;
  const Gone gone_;
  /// Set before the engine knows of the session, because lease(), which the engine calls, reads it.
  std::string instance_;
  std::string bytes_;  ///< being written
  boost::beast::flat_buffer buffer_;
  boost::asio::steady_timer timer_;  ///< for a write or for closing, whichever is in progress
  websocket::stream<SocketStream> stream_;
};

class BrowserSockets::Impl {
 public:
  Impl(Engine& engine, BrowserAccess& access, BrowserLeases& leases,
       const BrowserSocketLimits& limits)
      : engine_(engine),
        access_(access),
        leases_(leases),
        limits_(limits),
        io_(std::make_shared<IoContext>(/*concurrency_hint=*/1)),
        work_(io_->get_executor()),
        timer_(*io_) {}

  void start() {
    check_links();
    thread_ = std::thread([io = io_] {
      sigset_t pipe;
      sigemptyset(&pipe);
      sigaddset(&pipe, SIGPIPE);
      pthread_sigmask(SIG_BLOCK, &pipe, nullptr);  // OpenSSL writes without MSG_NOSIGNAL
      io->run();
    });
  }

  /// Ends all sessions, cuts those that are not closed after limits_.stop, and joins the thread.
  void stop() {
    boost::asio::post(*io_, [this] {
      is_stopping_ = true;
      const auto sockets = sockets_;
      for (const auto& socket : sockets) {
        socket->stop(absl::UnavailableError("the coordinator is being stopped"));
      }
      timer_.expires_after(limits_.stop);
      timer_.async_wait([this](ErrorCode) {
        for (const auto& socket : sockets_) {
          socket->cut();
        }
      });
      work_.reset();
      end_if_empty();
    });
    thread_.join();
  }

  HttpReply answer(const HttpRequest& request) {
    if (request.method != "GET" || !is_of_this_site(request)) {
      return refuse(absl::PermissionDeniedError(
          "a session begins with a WebSocket handshake of the page of this site"));
    }
    const std::string secret = offered_secret(request);
    if (const absl::Status status = access_.check(secret, request.remote_address); !status.ok()) {
      return refuse(status);
    }
    const std::shared_ptr<const void> place = take_place();
    if (place == nullptr) {
      return refuse(absl::UnavailableError(absl::StrCat(
          limits_.sockets, " browsers are connected, and no more are admitted; try again later")));
    }
    HttpReply reply;
    reply.take_over = [this, request, secret, place](std::unique_ptr<Connection> connection) {
      boost::asio::post(
          *io_, [this, request, secret, place, one = std::move(connection)]() mutable {
            add(request, {io_, engine_, leases_, limits_, std::move(one), secret, place});
          });
    };
    return reply;
  }

 private:
  /// Returns an object that counts as one of the allowed sockets until it is destroyed; nullptr:
  /// the number of sockets is at its limit.
  std::shared_ptr<const void> take_place() {
    if (taken_->fetch_add(1) >= limits_.sockets) {
      taken_->fetch_sub(1);
      return nullptr;
    }
    return {this, [taken = taken_](const void*) { taken->fetch_sub(1); }};
  }

  void add(const HttpRequest& request, BrowserSocket::Parts parts) {
    const auto socket = std::make_shared<BrowserSocket>(
        std::move(parts), [this](const std::shared_ptr<BrowserSocket>& gone) {
          sockets_.erase(gone);
          end_if_empty();
        });
    sockets_.insert(socket);
    socket->begin(request);
  }

  /// Ends the sessions whose link is no longer valid. Calls itself again after limits_.link_check.
  void check_links() {
    const auto sockets = sockets_;
    for (const auto& socket : sockets) {
      if (!access_.holds(socket->secret())) {
        socket->stop(absl::UnauthenticatedError("the link has ended or was revoked"));
      }
    }
    timer_.expires_after(limits_.link_check);
    timer_.async_wait([this](ErrorCode error) {
      if (!error && !is_stopping_) {
        check_links();
      }
    });
  }

  /// If the server is being stopped and no session is left, cancels the last timer. Then the thread
  /// ends.
  void end_if_empty() {
    if (is_stopping_ && sockets_.empty()) {
      timer_.cancel();
    }
  }

  Engine& engine_;
  BrowserAccess& access_;
  BrowserLeases& leases_;
  const BrowserSocketLimits limits_;
  const std::shared_ptr<std::atomic<std::size_t>> taken_ =
      std::make_shared<std::atomic<std::size_t>>(0);
  const std::shared_ptr<IoContext> io_;
  boost::asio::executor_work_guard<IoContext::executor_type> work_;
  // After start(), timer_, is_stopping_ and sockets_ are used by thread_ only.
  boost::asio::steady_timer timer_;
  bool is_stopping_ = false;
  std::set<std::shared_ptr<BrowserSocket>> sockets_;
  std::thread thread_;
};

BrowserSockets::BrowserSockets(Engine& engine, BrowserAccess& access, BrowserLeases& leases,
                               const BrowserSocketLimits& limits)
    : impl_(std::make_unique<Impl>(engine, access, leases, limits)) {
  impl_->start();
}

BrowserSockets::~BrowserSockets() { impl_->stop(); }

HttpReply BrowserSockets::answer(const HttpRequest& request) { return impl_->answer(request); }

}  // namespace bandsaw::coordinator
