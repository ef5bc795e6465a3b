#pragma once

// The base class of the tests of browsers that render. It starts a coordinator with a dashboard and
// a link for browsers, and makes the messages that the page in a browser's tab sends.

#include <string>
#include <thread>
#include <vector>

#include "tests/unit/join/socket_client.h"
#include "tests/unit/web/web_farm.h"

namespace bandsaw::coordinator {

class JoinTest : public WebTest {
 protected:
  JoinTest();

  /// Opens a session with the present link.
  test::SocketClient open() const { return {dashboard_->port(), {.secret = secret_}}; }
  /// Returns the Hello, the first message of a session, of a browser that is admitted. Different
  /// names stand for different tabs.
  static farm::FromWorker hello(const std::string& name = "tab");
  /// Sends Hello in the open session `socket`, and reads until the first lease, which is an order
  /// to render a band. Returns the lease.
  farm::Lease lease_to(test::SocketClient& socket, const std::string& name = "tab") const;
  /// Returns the body of POST /join/band with all samples of the lease. The sum of the samples
  /// is 8 in each channel of each pixel.
  static std::string band(const farm::Lease& lease, const std::string& name = "tab");

  /// Sends a request with the link's secret and returns the answer.
  Answer join_get(const std::string& path);
  Answer join_post(const std::string& path, const std::string& body);
  /// Returns the names of the workers that are connected.
  std::vector<std::string> workers();
  /// Makes the coordinator send messages to a tab that reads no messages, until the session of the
  /// tab is ended. The tab MUST be the only worker.
  void send_until_nobody_is_connected();
  /// Waits until the condition is true.
  template <class Condition>
  static void wait_until(Condition condition) {
    while (!condition()) {
      std::this_thread::yield();
    }
  }

  std::string secret_;  ///< secret of the link, which ends after a minute
};

}  // namespace bandsaw::coordinator
