// One exchange of HTTP over a socket: the bytes of a request, and the bytes of the response. The
// tests cover the parts of HTTP that browsers and attackers use.

#include "coordinator/web/exchange.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

#include "coordinator/web/reply.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Responds with the method, the path and the whole body.
HttpReply echo(const HttpRequest& request, const HttpBody& body) {
  std::string text = request.method + " " + request.path + " ";
  while (true) {
    const auto bytes = body();
    if (!bytes.ok()) {
      return refuse(bytes.status());
    }
    if (bytes->empty()) {
      return text_reply(text, "text/plain");
    }
    text.append(bytes->data(), bytes->size());
  }
}

class ExchangeTest : public ::testing::Test {
 protected:
  ExchangeTest() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets_.data()), 0); }
  ~ExchangeTest() override {
    close(sockets_[0]);
    close(sockets_[1]);
  }

  void say(const std::string& bytes) const {
    ASSERT_EQ(send(client(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// Returns everything that the server sends until it closes the connection.
  std::string hear() const {
    std::string all;
    std::array<char, 4096> some;
    for (ssize_t got = 0; (got = recv(client(), some.data(), some.size(), 0)) > 0;) {
      all.append(some.data(), static_cast<std::size_t>(got));
    }
    return all;
  }
  /// Serves one request with echo(), and closes the connection.
  void serve(std::chrono::milliseconds timeout = Connection::kTimeout) const {
    Connection connection(sockets_[1], nullptr, timeout);
    exchange(connection, &echo, {{"X-Every", "answer"}});
    shutdown(sockets_[1], SHUT_RDWR);
  }
  /// Sends these bytes, ends the sending direction, and returns the response.
  std::string answer(const std::string& bytes) const {
    std::thread server([this] { serve(); });
    EXPECT_EQ(send(client(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    shutdown(client(), SHUT_WR);
    const std::string all = hear();
    server.join();
    return all;
  }
  int client() const { return sockets_[0]; }
  int serving() const { return sockets_[1]; }

 private:
  std::array<int, 2> sockets_{};
};

TEST_F(ExchangeTest, AGetIsAnsweredAndTheConnectionEnds) {
  const std::string all = answer("GET /a%20b?c=d HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_THAT(all, StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(all, HasSubstr("\r\nConnection: close\r\n"));
  EXPECT_THAT(all, HasSubstr("\r\nContent-Type: text/plain\r\n"));
  EXPECT_THAT(all, HasSubstr("\r\nContent-Length: 9\r\n"));  // of "GET /a b "
  EXPECT_THAT(all, HasSubstr("\r\nX-Every: answer\r\n"));
  EXPECT_THAT(all, ::testing::EndsWith("\r\n\r\nGET /a b "));
}

TEST_F(ExchangeTest, TheResponseToHeadHasNoBody) {
  const std::string all = answer("HEAD / HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_THAT(all, HasSubstr("\r\nContent-Length: 7\r\n"));  // of "HEAD / ", which is not sent
  EXPECT_THAT(all, ::testing::EndsWith("\r\n\r\n"));
}

TEST_F(ExchangeTest, ABodyEndsAfterItsContentLength) {
  EXPECT_THAT(answer("POST / HTTP/1.1\r\nContent-Length: 4\r\n\r\nbodyand more"),
              ::testing::EndsWith("\r\n\r\nPOST / body"));
}

TEST_F(ExchangeTest, ChunksAreJoined) {
  EXPECT_THAT(answer("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"
                     "3;x=y\r\nbod\r\n1\r\ny\r\n0\r\nTrailer: 1\r\n\r\n"),
              ::testing::EndsWith("\r\n\r\nPOST / body"));
}

// The body has exactly twice the size of the buffer, so its end coincides with the end of a read.
TEST_F(ExchangeTest, ABodyOfWholeBuffersEnds) {
  const std::string body(128 << 10, 'b');
  std::thread server([this] { serve(); });
  std::thread sender([&] {
    say("POST / HTTP/1.1\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n");
    say(body);  // the connection stays open, so only the length shows the end of the body
  });
  const std::string all = hear();
  sender.join();
  server.join();
  EXPECT_THAT(all, ::testing::EndsWith("\r\n\r\nPOST / " + body));
}

TEST_F(ExchangeTest, Expect100ContinueIsAnswered) {
  std::thread server([this] { serve(); });
  say("POST / HTTP/1.1\r\nExpect: 100-continue\r\nContent-Length: 4\r\n\r\n");
  const std::string go_on = "HTTP/1.1 100 Continue\r\n\r\n";
  std::string received(go_on.size(), '\0');
  ASSERT_EQ(recv(client(), received.data(), received.size(), MSG_WAITALL),
            static_cast<ssize_t>(received.size()));
  EXPECT_EQ(received, go_on);
  say("body");
  EXPECT_THAT(hear(), ::testing::EndsWith("\r\n\r\nPOST / body"));
  server.join();
}

TEST_F(ExchangeTest, ATruncatedBodyIsAnError) {
  const std::string all = answer("POST / HTTP/1.1\r\nContent-Length: 9\r\n\r\nbody");
  EXPECT_THAT(all, StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(all, HasSubstr("the body is incomplete"));
}

TEST_F(ExchangeTest, MalformedHttpIsRefused) {
  const std::string all = answer("\x16\x03\x01 a TLS hello\r\n\r\n");
  EXPECT_THAT(all, StartsWith("HTTP/1.1 400 "));
  EXPECT_THAT(all, HasSubstr("\r\nX-Every: answer\r\n"));
}

// Two lengths would let a proxy and the server see different requests.
TEST_F(ExchangeTest, TwoLengthsAreRefused) {
  EXPECT_THAT(answer("POST / HTTP/1.1\r\nContent-Length: 4\r\nTransfer-Encoding: chunked\r\n\r\n"
                     "0\r\n\r\n"),
              StartsWith("HTTP/1.1 400 "));
}

TEST_F(ExchangeTest, AHeadThatIsTooLongIsRefused) {
  EXPECT_THAT(answer("GET / HTTP/1.1\r\nX-Long: " + std::string(kMaxHeadBytes, 'x')),
              StartsWith("HTTP/1.1 431 "));
}

TEST_F(ExchangeTest, ATruncatedHeadIsNotAnswered) {
  EXPECT_EQ(answer("GET / HTTP/1.1\r\nHost: a\r\n"), "");
}

TEST_F(ExchangeTest, ASilentClientIsDisconnected) {
  serve(std::chrono::milliseconds(20));
  EXPECT_EQ(hear(), "");
}

// Each byte arrives in time, but the whole request does not. Without an overall deadline the server
// would wait for ever.
TEST_F(ExchangeTest, ASlowSenderIsDisconnected) {
  std::thread client([this] {
    for (char next = 'G'; send(this->client(), &next, 1, MSG_NOSIGNAL) == 1; next = 'x') {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  serve(std::chrono::milliseconds(50));
  client.join();
}

// The response is larger than the system's buffers for a client that does not read.
TEST_F(ExchangeTest, AClientThatDoesNotReadIsDisconnected) {
  say("GET / HTTP/1.1\r\n\r\n");
  // The send buffer is small, because each byte that the system accepts extends the deadline.
  const int small = 1;
  setsockopt(serving(), SOL_SOCKET, SO_SNDBUF, &small, sizeof(small));
  Connection connection(serving(), nullptr, std::chrono::milliseconds(50));
  exchange(connection,
           [](const HttpRequest&, const HttpBody&) {
             return text_reply(std::string(8 << 20, 'x'), "text/plain");
           },
           {});
  SUCCEED() << "the server ended the connection";
}

}  // namespace
}  // namespace bandsaw::coordinator
