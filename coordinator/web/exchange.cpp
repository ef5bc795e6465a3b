// Reads one request with Boost.Beast, calls the handler, and writes its response.

#include "coordinator/web/exchange.h"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/flat_static_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/system/system_error.hpp>
#include <exception>
#include <limits>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"

namespace bandsaw::coordinator {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::size_t kBufferBytes = 64 << 10;
static_assert(kBufferBytes > kMaxHeadBytes, "a head is parsed from one buffer");

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

/// A connection with Beast's concepts SyncReadStream and SyncWriteStream.
class Stream {
 public:
  explicit Stream(Connection& connection) : connection_(connection) {}

  template <class Buffers>
  std::size_t read_some(const Buffers& buffers, beast::error_code& error) {
    for (const boost::asio::mutable_buffer buffer : beast::buffers_range_ref(buffers)) {
      if (buffer.size() > 0) {
        return moved(connection_.read(static_cast<char*>(buffer.data()), buffer.size()), error);
      }
    }
    error = {};
    return 0;
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers, beast::error_code& error) {
    for (const boost::asio::const_buffer buffer : beast::buffers_range_ref(buffers)) {
      if (buffer.size() > 0) {
        return moved(connection_.write(static_cast<const char*>(buffer.data()), buffer.size()),
                     error);
      }
    }
    error = {};
    return 0;
  }

  // Required by the concepts.
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers) {
    beast::error_code error;
    const std::size_t count = read_some(buffers, error);
    return error ? throw boost::system::system_error(error) : count;
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers) {
    beast::error_code error;
    const std::size_t count = write_some(buffers, error);
    return error ? throw boost::system::system_error(error) : count;
  }

 private:
  /// Returns `count`, the number of bytes that were read or written. Sets `error` to eof if no byte
  /// was moved.
  static std::size_t moved(std::ptrdiff_t count, beast::error_code& error) {
    error = count > 0 ? beast::error_code() : boost::asio::error::eof;
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }

  Connection& connection_;
};

/// Serves one request of a connection.
class Exchange {
 public:
  Exchange(Connection& connection, const std::vector<HttpField>& headers)
      : connection_(connection), stream_(connection), headers_(headers) {
    parser_.header_limit(kMaxHeadBytes);
    // Handlers limit the size of bodies. boost::none ("no limit") is not used, because Boost 1.74
    // treats it as smaller than any number.
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());
  }

  /// Returns HttpReply::take_over of the handler's reply. If this function is set, no response was
  /// written.
  TakeOver run(const HttpHandler& handler) {
    beast::error_code error;
    http::read_header(stream_, buffer_, parser_, error);
    if (error == http::error::end_of_stream || error == http::error::partial_message) {
      return {};
    }
    const HttpRequest request = error ? HttpRequest() : read_request();
    HttpReply reply = error ? refuse_head(error) : answer(request, handler);
    if (!reply.take_over) {
      write(request, with_range(request, reply));
    }
    return std::move(reply.take_over);
  }

 private:
  /// Returns the response to a request whose head is too long or is not HTTP/1.1.
  static HttpReply refuse_head(const beast::error_code& error) {
    HttpReply reply = refuse(absl::InvalidArgumentError(
        error == http::error::header_limit
            ? absl::StrCat("the request line and the headers have more than ", kMaxHeadBytes,
                           " bytes")
            : absl::StrCat("this is no HTTP/1.1 request: ", error.message())));
    reply.status = error == http::error::header_limit ? 431 : 400;
    return reply;
  }

  /// Returns the request whose head the parser has read.
  HttpRequest read_request() const {
    HttpRequest request;
    const auto& head = parser_.get();
    request.method = text_of(head.method_string());
    request.remote_address = connection_.remote_address();
    request.local_port = connection_.local_port();
    parse_target(text_of(head.target()), request);
    for (const auto& field : head) {
      request.headers.emplace_back(text_of(field.name_string()), text_of(field.value()));
    }
    return request;
  }

  /// Returns the handler's reply; if the handler throws an exception, an error.
  HttpReply answer(const HttpRequest& request, const HttpHandler& handler) {
    connection_.begin_body();
    awaits_continue_ = absl::EqualsIgnoreCase(request.header("Expect"), "100-continue");
    try {
      return handler(request, [this] { return read_body(); });
    } catch (const std::exception& error) {  // bad_alloc of a large image, for example
      return refuse(absl::InternalError(absl::StrCat("the request failed: ", error.what())));
    }
  }

  /// Returns the next bytes of the body; no bytes: the body has ended.
  absl::StatusOr<absl::string_view> read_body() {
    beast::error_code error;
    if (std::exchange(awaits_continue_, false)) {
      const http::response<http::empty_body> go_on(http::status::continue_, /*version=*/11);
      http::response_serializer<http::empty_body> serializer(go_on);
      http::write_header(stream_, serializer, error);
    }
    while (!error && !parser_.is_done()) {
      parser_.get().body() = {.data = body_.data(), .size = body_.size(), .more = true};
      http::read_some(stream_, buffer_, parser_, error);
      if (const std::size_t count = body_.size() - parser_.get().body().size; count > 0 && !error) {
        return absl::string_view(body_.data(), count);
      }
    }
    return error ? absl::StatusOr<absl::string_view>(absl::InvalidArgumentError(
                       absl::StrCat("the body is incomplete: ", error.message())))
                 : absl::string_view();
  }

  /// Returns true if one of the headers that every response gets has this name.
  bool is_of_every_reply(const std::string& name) const {
    return std::any_of(headers_.begin(), headers_.end(),
                       [&](const HttpField& field) { return field.first == name; });
  }

  /// Writes the response. A header of the reply replaces the header of the same name in headers_.
  void write(const HttpRequest& request, const HttpReply& reply) {
    using Bytes = http::span_body<const char>;
    http::response<Bytes> response(static_cast<http::status>(reply.status), /*version=*/11);
    response.set(http::field::connection, "close");
    for (const auto& [name, value] : headers_) {
      response.insert(name, value);
    }
    for (const auto& [name, value] : reply.headers) {
      if (is_of_every_reply(name)) {
        response.erase(name);
      }
      response.insert(name, value);
    }
    if (!reply.type.empty()) {
      response.set(http::field::content_type, reply.type);
    }
    // In a 304 response, Content-Length would mean the length of the 200 response (RFC 9110,
    // section 8.6).
    if (reply.status != 304) {
      response.content_length(reply.bytes.size());
    }
    response.body() = Bytes::value_type(reply.bytes.data(), reply.bytes.size());
    http::response_serializer<Bytes> serializer(response);
    beast::error_code ignored;  // an error means that the client has disconnected
    connection_.begin_answer();
    http::write_header(stream_, serializer, ignored);
    if (!ignored && request.method != "HEAD") {
      http::write(stream_, serializer, ignored);
    }
  }

  Connection& connection_;
  Stream stream_;
  const std::vector<HttpField>& headers_;
  http::request_parser<http::buffer_body> parser_;
  beast::flat_static_buffer<kBufferBytes> buffer_;
  // The bytes of the body that were read last. The array is larger than the parser's buffer, so
  // that the array is never full. Otherwise Beast would report need_buffer before the end of the
  // body.
  std::array<char, kBufferBytes + 1> body_;
  bool awaits_continue_ = false;  ///< the client sends the body only after "100 Continue"
};

}  // namespace

TakeOver exchange(Connection& connection, const HttpHandler& handler,
                  const std::vector<HttpField>& headers) {
  return Exchange(connection, headers).run(handler);
}

}  // namespace bandsaw::coordinator
