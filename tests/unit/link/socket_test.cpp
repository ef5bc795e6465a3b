// Connections to a name that has several addresses.

#include "proto/link/socket.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <vector>

namespace bandsaw::link {
namespace {

/// A loopback address on which a socket listens. `info` has the form of a result of getaddrinfo.
struct Listener {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  sockaddr_in address{};
  addrinfo info{};

  explicit Listener(int backlog) {
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(fd, any, size), 0);
    EXPECT_EQ(listen(fd, backlog), 0);
    EXPECT_EQ(getsockname(fd, any, &size), 0);
    info.ai_family = AF_INET;
    info.ai_addr = any;
    info.ai_addrlen = size;
  }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() { close(fd); }
};

/// A listener that answers no connection. Its queue has the length 0. While a connection waits in
/// such a queue, Linux answers no further connection.
struct SilentListener : Listener {
  std::vector<int> waiting;

  SilentListener() : Listener(0) {
    for (int i = 0; i < 3; ++i) {
      waiting.push_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
      ::connect(waiting.back(), info.ai_addr, info.ai_addrlen);
    }
  }
  ~SilentListener() {
    for (const int one : waiting) {
      close(one);
    }
  }
};

// The function of the deadline is called again and again. connect() must stop when the function
// returns true.
TEST(Socket, ConnectStopsWhenItIsInterrupted) {
  const SilentListener silent;
  int calls = 0;
  const Deadline deadline{std::chrono::steady_clock::now() + std::chrono::hours(24),
                          [&] { return ++calls == 2; }};
  const absl::Status status = Socket::connect(&silent.info, deadline).status();
  EXPECT_EQ(status.message(), "interrupted");
  EXPECT_EQ(calls, 2);
}

TEST(Socket, AnAddressThatDoesNotAnswerLeavesTimeForTheNext) {
  SilentListener silent;
  Listener answers(1);
  silent.info.ai_next = &answers.info;
  const Deadline deadline{std::chrono::steady_clock::now() + std::chrono::seconds(1)};
  EXPECT_TRUE(Socket::connect(&silent.info, deadline).ok());
  const int accepted = accept(answers.fd, nullptr, nullptr);
  EXPECT_GE(accepted, 0) << "the second address must be reached";
  close(accepted);
}

}  // namespace
}  // namespace bandsaw::link
