#pragma once

// The base of tests of the dashboard. It starts a coordinator with a dashboard for each test, and
// sends the requests that a browser sends.

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>

#include "coordinator/engine/engine.h"
#include "coordinator/web/dashboard.h"
#include "proto/link/identity.h"
#include "proto/web.pb.h"
#include "renderlib/render/band.h"
#include "tests/support/http_client.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {

/// One of the two architectures that workers have: the one that this program does not have.
inline constexpr Machine kOtherMachine =
    kThisMachine == Machine::kX86_64 ? Machine::kAarch64 : Machine::kX86_64;

class WebTest : public ::testing::Test {
 protected:
  using Answer = std::optional<test::HttpAnswer>;

  /// The gallery has one scene, "box". A scene file that contains "broken" cannot be read; every
  /// other file is the Cornell box.
  WebTest();
  ~WebTest() override;

  /// Sends a request with the required header and, after log_in(), the cookie.
  Answer get(const std::string& path);
  Answer post(const std::string& path, const std::string& body = "{}");
  void log_in();
  /// Submits a job of 24 x 16 pixels, which no worker renders; returns its id. log_in() MUST have
  /// been called.
  std::uint64_t submit_box();
  /// Uploads a band of a job: some samples, at most a block of 8, of all rows. Each pixel's value
  /// is `value`.
  void put(std::uint64_t job, std::uint32_t width, std::uint32_t height, const SampleRange& samples,
           double value);
  /// Uploads the samples [first, samples) of a job and waits until the job is done. `first` MUST be
  /// a multiple of 8. Each pixel's value is 0.5.
  void finish(std::uint64_t job, std::uint32_t width, std::uint32_t height,
              std::uint64_t samples = 64, std::uint64_t first = 0);
  /// Parses the body of an answer, the JSON of a message. Fails the test if the body is no such
  /// JSON.
  template <class Message>
  Message message(const Answer& result) {
    Message out;
    read(result, out);
    return out;
  }
  std::string base() const { return "http://127.0.0.1:" + std::to_string(dashboard_->port()); }

  /// Stops the dashboard if it runs, and starts one with `options_`.
  void start_dashboard();

  test::TempDir folder_;
  link::Identity identity_;
  std::unique_ptr<Engine> engine_;
  std::unique_ptr<BrowserAccess> access_;
  DashboardOptions options_;
  std::unique_ptr<Dashboard> dashboard_;
  test::HttpHeaders headers_ = {{"X-Bandsaw", "1"}};

 private:
  static void read(const Answer& result, google::protobuf::Message& out);
};

}  // namespace bandsaw::coordinator
