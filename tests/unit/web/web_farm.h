#pragma once

// A coordinator with a dashboard of its own for each test, and a browser's calls to it.

#include <gtest/gtest.h>
#include <httplib.h>

#include <memory>
#include <string>

#include "coordinator/engine/engine.h"
#include "coordinator/web/dashboard.h"
#include "proto/link/identity.h"
#include "proto/web.pb.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {

/// The architecture that is not this program's.
inline constexpr Machine kOtherMachine =
    kThisMachine == Machine::kX86_64 ? Machine::kAarch64 : Machine::kX86_64;

class WebTest : public ::testing::Test {
 protected:
  /// The gallery holds one scene, "box"; a scene file that holds "broken" cannot be read, and every
  /// other is the Cornell box.
  WebTest();
  ~WebTest() override;

  /// With our header and, after log_in(), the cookie.
  httplib::Result get(const std::string& path);
  httplib::Result post(const std::string& path, const std::string& body = "{}");
  void log_in();
  /// A job that nobody renders.
  std::uint64_t submit_box();
  /// The body as a message; the test fails when it is none.
  template <class Message>
  Message message(const httplib::Result& result) {
    Message out;
    read(result, out);
    return out;
  }
  std::string base() const { return "http://127.0.0.1:" + std::to_string(dashboard_->port()); }

  test::TempDir folder_;
  link::Identity identity_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<Dashboard> dashboard_;
  httplib::Headers headers_ = {{"X-Bandsaw", "1"}};

 private:
  static void read(const httplib::Result& result, google::protobuf::Message& out);
  std::unique_ptr<httplib::Client> client_;
};

}  // namespace bandsaw::coordinator
