#pragma once

// A connection as a stream for Boost.Asio and Boost.Beast. The operations of the stream do not
// block a thread: they wait for the socket on an io_context. Only browser_sockets.cpp includes this
// file, because the headers of Boost compile slowly.

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/compose.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/bind_handler.hpp>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/role.hpp>
#include <cerrno>
#include <memory>
#include <utility>

#include "coordinator/web/connection.h"

namespace bandsaw::coordinator {

/// Implements Beast's concepts AsyncReadStream and AsyncWriteStream. Used by one thread. Its
/// destructor closes the socket.
class SocketStream {
 public:
  using executor_type = boost::asio::io_context::executor_type;
  using ErrorCode = boost::beast::error_code;

  SocketStream(boost::asio::io_context& context, std::unique_ptr<Connection> connection)
      : context_(context),
        connection_(std::move(connection)),
        socket_(context, connection_->socket()) {}

  void set_send_buffer(int bytes) {
    setsockopt(socket_.native_handle(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof(bytes));
  }

  executor_type get_executor() { return context_.get_executor(); }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return start(first_filled<boost::asio::mutable_buffer>(buffers), token,
                 [](Connection& connection, const boost::asio::mutable_buffer& buffer) {
                   return connection.try_read(static_cast<char*>(buffer.data()), buffer.size());
                 });
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return start(first_filled<boost::asio::const_buffer>(buffers), token,
                 [](Connection& connection, const boost::asio::const_buffer& buffer) {
                   return connection.try_write(static_cast<const char*>(buffer.data()),
                                               buffer.size());
                 });
  }

  /// Ends the sending direction and reads what the peer still sends, because closing a socket with
  /// unread bytes would make the system discard the last message. Completes when the peer has
  /// closed the connection, or after close().
  template <class Token>
  auto async_finish(Token&& token) {
    if (socket_.is_open()) {
      connection_->end_sending();
    }
    return boost::asio::async_compose<Token, void(ErrorCode)>(
        [this, begun = false](auto& self, ErrorCode error = {}) mutable {
          if (!std::exchange(begun, true)) {
            // An operation must not complete within the call that begins it.
            boost::asio::post(get_executor(),
                              boost::beast::bind_front_handler(std::move(self), ErrorCode()));
            return;
          }
          std::array<char, 16 << 10> unread;
          ssize_t got = 0;
          do {
            got = error || !socket_.is_open()
                      ? 0
                      : recv(socket_.native_handle(), unread.data(), unread.size(), 0);
          } while (got > 0);
          if (got < 0 && errno == EAGAIN) {
            socket_.async_wait(Socket::wait_read, std::move(self));
          } else {
            close();
            self.complete({});
          }
        },
        token, socket_);
  }

  /// Ends every operation in progress and closes the socket.
  void close() {
    ErrorCode ignored;
    socket_.close(ignored);
  }

 private:
  using Socket = boost::asio::posix::stream_descriptor;

  /// Returns the first buffer of the sequence that is not empty; an empty buffer if all are empty.
  template <class Buffer, class Buffers>
  static Buffer first_filled(const Buffers& buffers) {
    for (const Buffer buffer : boost::beast::buffers_range_ref(buffers)) {
      if (buffer.size() > 0) {
        return buffer;
      }
    }
    return {};
  }

  /// Repeats an attempt whenever the socket is ready, until it has moved bytes or failed.
  template <class Buffer, class Token, class Try>
  auto start(Buffer buffer, Token& token, Try attempt) {
    return boost::asio::async_compose<Token, void(ErrorCode, std::size_t)>(
        [this, buffer, attempt, begun = false](auto& self, ErrorCode error = {}) mutable {
          if (!std::exchange(begun, true)) {
            // An operation must not complete within the call that begins it.
            boost::asio::post(get_executor(),
                              boost::beast::bind_front_handler(std::move(self), ErrorCode()));
            return;
          }
          if (error || buffer.size() == 0 || !socket_.is_open()) {
            self.complete(error || buffer.size() == 0
                              ? error
                              : ErrorCode(boost::asio::error::operation_aborted),
                          0);
            return;
          }
          const Connection::Attempt done = attempt(*connection_, buffer);
          if (done.bytes > 0) {
            self.complete({}, done.bytes);
          } else if (done.wait_for == 0) {  // the connection has ended
            self.complete(boost::asio::error::eof, 0);
          } else {
            socket_.async_wait(done.wait_for == POLLIN ? Socket::wait_read : Socket::wait_write,
                               std::move(self));
          }
        },
        token, socket_);
  }

  boost::asio::io_context& context_;
  const std::unique_ptr<Connection> connection_;
  Socket socket_;
};

// Beast calls the following functions when it closes a WebSocket. The compiler finds them by the
// type SocketStream of their argument.

inline void beast_close_socket(SocketStream& stream) { stream.close(); }

inline void teardown(boost::beast::role_type, SocketStream& stream,
                     boost::beast::error_code& error) {
  stream.close();
  error = {};
}

template <class Handler>
void async_teardown(boost::beast::role_type, SocketStream& stream, Handler&& handler) {
  stream.async_finish(std::forward<Handler>(handler));
}

}  // namespace bandsaw::coordinator
