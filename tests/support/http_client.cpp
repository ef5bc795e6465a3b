// A blocking HTTP client for tests, with Boost.Beast.

#include "tests/support/http_client.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <limits>

namespace bandsaw::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Text = http::string_body;

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

/// A TCP connection to a port of 127.0.0.1.
class Loopback {
 public:
  explicit Loopback(int port) : socket_(context_) {
    beast::error_code error;
    socket_.connect({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)}, error);
    connected_ = !error;
  }
  bool connected() const { return connected_; }
  asio::ip::tcp::socket& socket() { return socket_; }

 private:
  asio::io_context context_;
  asio::ip::tcp::socket socket_;
  bool connected_ = false;
};

}  // namespace

std::string HttpAnswer::header(const std::string& name) const {
  for (const auto& [key, value] : headers) {
    if (beast::iequals(key, name)) {
      return value;
    }
  }
  return "";
}

std::optional<HttpAnswer> http_call(int port, const HttpCall& call) {
  Loopback server(port);
  http::request<Text> request;
  request.method_string(call.method);
  request.target(call.target);
  request.set(http::field::host, "127.0.0.1:" + std::to_string(port));
  request.body() = call.body;
  request.prepare_payload();
  for (const auto& [name, value] : call.headers) {
    request.set(name, value);
  }
  beast::error_code error;
  // A server may respond before it has read the whole request. Then writing may fail, but the
  // response counts.
  if (server.connected()) {
    http::write(server.socket(), request, error);
  }
  beast::flat_buffer buffer;
  http::response_parser<Text> parser;
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  parser.skip(call.method == "HEAD");
  http::read(server.socket(), buffer, parser, error);
  if (error) {
    return std::nullopt;
  }
  HttpAnswer answer;
  answer.status = static_cast<int>(parser.get().result_int());
  answer.body = parser.get().body();
  for (const auto& field : parser.get()) {
    answer.headers.emplace(text_of(field.name_string()), text_of(field.value()));
  }
  return answer;
}

std::string send_bytes_to(int port, const std::string& bytes) {
  Loopback server(port);
  beast::error_code ignored;
  asio::write(server.socket(), asio::buffer(bytes), ignored);
  std::string answer;
  asio::read(server.socket(), asio::dynamic_buffer(answer), ignored);
  return answer;
}

}  // namespace bandsaw::test
