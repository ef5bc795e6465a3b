// A browser's session over TLS with the farm's certificate. The same rules hold as without TLS
// (session_test.cpp). The number of sessions is limited, and each session takes one place. In
// whatever way the connection of a session breaks, the session must end and free its place.
//
// Close codes of the WebSocket standard are 1001 (going away), 1008 (violation of the rules) and
// 1009 (message too big). The code 4401 is bandsaw's own: the link has ended or was revoked.

#include <gmock/gmock.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

#include "tests/unit/join/join_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

/// A browser that trusts the farm's certificate only.
class SecureTab {
 public:
  /// Connects and sends the handshake. `secret`: secret of the link. `receive_buffer`: size of the
  /// socket's receive buffer in bytes; 0: the system's default.
  SecureTab(int port, const std::string& certificate_pem, const std::string& secret,
            int receive_buffer = 0) {
    tls_.add_certificate_authority(asio::buffer(certificate_pem));
    tls_.set_verify_mode(asio::ssl::verify_peer);
    tcp().open(asio::ip::tcp::v4());
    if (receive_buffer > 0) {
      tcp().set_option(asio::socket_base::receive_buffer_size(receive_buffer));
    }
    tcp().connect({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)});
    stream_.next_layer().handshake(asio::ssl::stream_base::client);
    const std::string host = "127.0.0.1:" + std::to_string(port);
    stream_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(beast::http::field::origin, "https://" + host);
      request.set(beast::http::field::sec_websocket_protocol,
                  "bandsaw.1, bandsaw.secret." + secret);
    }));
    stream_.binary(true);
    beast::error_code error;
    stream_.handshake(host, "/join/session", error);
    is_open_ = !error;
  }

  bool is_open() const { return is_open_; }
  void send(const std::string& bytes) {
    beast::error_code ignored;
    stream_.write(asio::buffer(bytes), ignored);
  }
  void send(const farm::FromWorker& message) { send(message.SerializeAsString()); }
  /// Sends bytes as one record of TLS.
  void send_record(const std::string& bytes) {
    asio::write(stream_.next_layer(), asio::buffer(bytes));
  }
  /// Sends bytes directly to the TCP socket, without TLS.
  void send_below(const std::string& bytes) { asio::write(tcp(), asio::buffer(bytes)); }
  /// Returns the next message; std::nullopt: the session has ended.
  std::optional<farm::ToWorker> read() {
    beast::flat_buffer buffer;
    beast::error_code error;
    stream_.read(buffer, error);
    farm::ToWorker message;
    if (!error && message.ParseFromArray(buffer.cdata().data(), static_cast<int>(buffer.size()))) {
      return message;
    }
    code_ = error == websocket::error::closed ? stream_.reason().code : 0;
    return std::nullopt;
  }
  /// Reads until the session has ended. Returns the code of the server's close frame; 0: the server
  /// sent no close frame.
  int read_to_end() {
    while (read()) {
    }
    return code_;
  }
  void close() {
    beast::error_code ignored;
    stream_.close(websocket::close_code::normal, ignored);
  }
  /// Ends the connection by a message of TLS, without a close frame of the WebSocket.
  void end_tls() {
    beast::error_code ignored;
    stream_.next_layer().shutdown(ignored);
  }
  asio::ip::tcp::socket& tcp() { return stream_.next_layer().next_layer(); }

 private:
  asio::io_context context_;
  asio::ssl::context tls_{asio::ssl::context::tls_client};
  websocket::stream<asio::ssl::stream<asio::ip::tcp::socket>> stream_{context_, tls_};
  bool is_open_ = false;
  int code_ = 0;
};

/// Returns a binary WebSocket frame with a mask of zeros, so that the payload is sent unchanged.
/// The head of the frame announces `size` bytes, at most 65,535; `payload` may be shorter.
std::string frame(const std::string& payload, std::size_t size) {
  std::string head = "\x82";
  if (size < 126) {
    head += static_cast<char>(0x80 | size);
  } else {
    head += {static_cast<char>(0xFE), static_cast<char>(size >> 8), static_cast<char>(size & 255)};
  }
  return head + std::string(4, '\0') + payload;
}

/// Two dashboards of one coordinator: the dashboard of the base class, and `secure_`, which uses
/// TLS and admits one browser at a time.
class JoinTlsTest : public JoinTest {
 protected:
  JoinTlsTest() { log_in(); }
  ~JoinTlsTest() override { secure_.reset(); }

  void SetUp() override {
    options_.host = "0.0.0.0";
    options_.browser_limits.sockets = 1;
    auto secure = Dashboard::start(*engine_, identity_, options_);
    ASSERT_TRUE(secure.ok()) << secure.status();
    secure_ = *std::move(secure);
  }
  std::unique_ptr<SecureTab> open_secure(int receive_buffer = 0) const {
    return std::make_unique<SecureTab>(secure_->port(), identity_.certificate_pem, secret_,
                                       receive_buffer);
  }
  /// Opens a session as soon as the place is free, and expects that it is admitted.
  std::unique_ptr<SecureTab> join() {
    auto tab = open_secure();
    wait_until([&] {
      tab = tab->is_open() ? std::move(tab) : open_secure();
      return tab->is_open();
    });
    tab->send(hello());
    const auto welcome = tab->read();
    EXPECT_TRUE(welcome && welcome->has_welcome());
    EXPECT_THAT(workers(), Not(IsEmpty()));
    return tab;
  }
  /// Waits until the farm has no worker and the place is free.
  void expect_ended() {
    wait_until([&] { return workers().empty(); });
    wait_until([&] { return open_secure()->is_open(); });
  }

  std::unique_ptr<Dashboard> secure_;
};

TEST_F(JoinTlsTest, ABrowserGetsItsLeasesAndLeaves) {
  auto tab = join();
  EXPECT_FALSE(open_secure()->is_open()) << "a second session must be refused";
  const std::uint64_t job = submit_box();
  auto message = tab->read();
  while (message && !message->has_lease()) {
    message = tab->read();
  }
  ASSERT_TRUE(message);
  EXPECT_EQ(message->lease().job(), job);
  tab->close();
  tab.reset();
  expect_ended();
}

TEST_F(JoinTlsTest, MessagesOfOneRecordAreAllRead) {
  auto tab = open_secure();
  const std::string bytes = hello().SerializeAsString();
  // The second Hello violates the rules. Both are in one TLS record, so the second one waits inside
  // TLS and not in the socket.
  tab->send_record(frame(bytes, bytes.size()) + frame(bytes, bytes.size()));
  EXPECT_EQ(tab->read_to_end(), 1008);
  tab.reset();
  expect_ended();
}

TEST_F(JoinTlsTest, AMessageAboveTheSizeLimitEndsTheSession) {
  auto tab = join();
  tab->send(std::string(100'000, 'x'));
  EXPECT_EQ(tab->read_to_end(), 1009);
  tab.reset();
  expect_ended();
}

TEST_F(JoinTlsTest, ARevokedLinkEndsTheSession) {
  auto tab = join();
  ASSERT_EQ(post("/api/link/revoke")->status, 200);
  EXPECT_EQ(tab->read_to_end(), 4401);
  tab.reset();
  wait_until([&] { return workers().empty(); });
}

TEST_F(JoinTlsTest, AStallInTheMiddleOfAFrameEndsTheSession) {
  options_.browser_limits.idle = std::chrono::milliseconds(600);
  SetUp();
  const std::string half(1'000, 'x');
  {
    const auto tab = join();
    tab->send_record(frame(half, 2 * half.size()));
    expect_ended();
  }
  // The second stall is in the middle of a TLS record. 0x17 means application data, and the length
  // (0x20 and the first x) is 8,312 bytes.
  const auto tab = join();
  tab->send_below("\x17\x03\x03\x20" + half);
  expect_ended();
}

TEST_F(JoinTlsTest, ACutConnectionEndsTheSession) {
  {
    const auto closed = join();
    closed->tcp().close();
    expect_ended();
  }
  {
    const auto half = join();
    half->send_record(frame("the beginning", 2'000));
    half->tcp().close();
    expect_ended();
  }
  {
    const auto reset = join();
    reset->tcp().set_option(asio::socket_base::linger(true, 0));
    reset->tcp().close();
    expect_ended();
  }
  {
    const auto damaged = join();
    damaged->send_below("\x17\x03\x03\x20" + std::string(0x4000, 'x'));
    expect_ended();
  }
  const auto ended = join();
  ended->end_tls();
  expect_ended();
}

TEST_F(JoinTlsTest, ATabThatDoesNotReadHoldsUpNobody) {
  options_.browser_limits.write = std::chrono::milliseconds(200);
  options_.browser_limits.send_buffer = 4096;
  SetUp();
  const auto tab = open_secure(/*receive_buffer=*/2048);
  farm::FromWorker message = hello();
  message.mutable_hello()->set_max_bands(16);
  tab->send(message);
  wait_until([&] { return !workers().empty(); });
  send_until_nobody_is_connected();
}

TEST_F(JoinTlsTest, AStoppingCoordinatorClosesSessionsAsGoingAway) {
  const auto tab = join();
  std::thread stop([&] { secure_.reset(); });
  EXPECT_EQ(tab->read_to_end(), 1001);
  stop.join();
}

}  // namespace
}  // namespace bandsaw::coordinator
