// A WebSocket client with Boost.Beast that takes the place of a browser's tab.

#include "tests/unit/join/socket_client.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>

#include "tests/support/http_client.h"

namespace bandsaw::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

namespace {

/// Sends the request of the handshake once more and returns the response, because Beast does not
/// return the response of a refused handshake.
std::optional<HttpAnswer> ask_again(int port, const SocketOffer& offer, const std::string& origin) {
  return http_call(port, {.target = offer.target,
                          .headers = {{"Origin", origin},
                                      {"Connection", "Upgrade"},
                                      {"Upgrade", "websocket"},
                                      {"Sec-WebSocket-Version", "13"},
                                      {"Sec-WebSocket-Key", "MDEyMzQ1Njc4OWFiY2RlZg=="},
                                      {"Sec-WebSocket-Protocol",
                                       offer.protocol + ", bandsaw.secret." + offer.secret}}});
}

}  // namespace

struct SocketClient::Socket {
  asio::io_context context;
  websocket::stream<asio::ip::tcp::socket> stream{context};
};

SocketClient::SocketClient(int port, const SocketOffer& offer, int receive_buffer)
    : socket_(std::make_unique<Socket>()) {
  auto& stream = socket_->stream;
  beast::error_code error;
  stream.next_layer().open(asio::ip::tcp::v4(), error);
  if (receive_buffer > 0) {  // set before connecting, so that the TCP window is small
    stream.next_layer().set_option(asio::socket_base::receive_buffer_size(receive_buffer), error);
  }
  stream.next_layer().connect({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)},
                              error);
  const std::string host = "127.0.0.1:" + std::to_string(port);
  const std::string origin = offer.origin.empty() ? "http://" + host : offer.origin;
  stream.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(beast::http::field::origin, origin);
    request.set(beast::http::field::sec_websocket_protocol,
                offer.protocol + ", bandsaw.secret." + offer.secret);
  }));
  stream.control_callback([this](websocket::frame_type kind, beast::string_view) {
    pings_ += kind == websocket::frame_type::ping ? 1 : 0;
  });
  websocket::response_type response;
  stream.handshake(response, host, offer.target, error);
  if (!error) {
    status_ = static_cast<int>(response.result_int());
    const auto chosen = response[beast::http::field::sec_websocket_protocol];
    protocol_ = std::string(chosen.data(), chosen.size());
  } else if (const auto refusal = ask_again(port, offer, origin)) {
    status_ = refusal->status;
    refusal_ = refusal->body;
  }
}

SocketClient::~SocketClient() = default;

bool SocketClient::send(const farm::FromWorker& message) {
  return send_bytes(message.SerializeAsString());
}

bool SocketClient::send_bytes(const std::string& bytes, bool binary) {
  beast::error_code error;
  socket_->stream.binary(binary);
  socket_->stream.write(asio::buffer(bytes), error);
  return !error;
}

void SocketClient::send_raw(const std::string& bytes) {
  beast::error_code ignored;
  asio::write(socket_->stream.next_layer(), asio::buffer(bytes), ignored);
}

std::optional<farm::ToWorker> SocketClient::read() {
  beast::flat_buffer buffer;
  beast::error_code error;
  socket_->stream.read(buffer, error);
  farm::ToWorker message;
  if (!error && socket_->stream.got_binary() &&
      message.ParseFromArray(buffer.cdata().data(), static_cast<int>(buffer.size()))) {
    return message;
  }
  const auto& reason = socket_->stream.reason();
  code_ = error == websocket::error::closed ? reason.code : 0;
  reason_ = std::string(reason.reason.data(), reason.reason.size());
  return std::nullopt;
}

void SocketClient::read_to_end() {
  while (read()) {
  }
}

void SocketClient::vanish() {
  beast::error_code ignored;
  socket_->stream.next_layer().close(ignored);
}

void SocketClient::close() {
  beast::error_code ignored;
  socket_->stream.close(websocket::close_code::normal, ignored);
}

}  // namespace bandsaw::test
