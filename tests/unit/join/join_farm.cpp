// A coordinator whose dashboard lets browsers join, and the messages that a browser's tab would
// send.

#include "tests/unit/join/join_farm.h"

#include <cstring>
#include <thread>

#include "coordinator/engine/blocking_call.h"
#include "proto/wire/digest.h"
#include "proto/wire/versions.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the id of the instance (the tab) with this name: 32 hexadecimal digits.
std::string instance_of(const std::string& name) { return wire::sha256(name).hex().substr(0, 32); }

}  // namespace

JoinTest::JoinTest() {
  // The canary, the hash of a small image, is rendered here, so that no session waits for it.
  hello();
  const auto link = access_->make(60);
  EXPECT_TRUE(link.ok()) << link.status();
  secret_ = link->url.substr(link->url.find('#') + 1);
}

farm::FromWorker JoinTest::hello(const std::string& name) {
  farm::FromWorker message;
  farm::Hello* h = message.mutable_hello();
  h->set_protocol(wire::kProtocol);
  h->set_pixel_version(kPixelVersion);
  static const std::uint64_t image = canary();  // rendered once
  h->set_canary(image);
  h->set_instance(instance_of(name));
  h->set_name(name);
  h->set_threads(2);
  h->set_max_bands(1);
  return message;
}

farm::Lease JoinTest::lease_to(test::SocketClient& socket, const std::string& name) const {
  EXPECT_EQ(socket.status(), 101) << socket.refusal();
  EXPECT_TRUE(socket.send(hello(name)));
  while (const auto message = socket.read()) {
    if (message->has_lease()) {
      return message->lease();
    }
  }
  ADD_FAILURE() << "no lease came: " << socket.close_reason();
  return {};
}

std::string JoinTest::band(const farm::Lease& lease, const std::string& name) {
  const std::size_t values = std::size_t{lease.settings().width()} *
                             (lease.band().last_row() - lease.band().first_row()) * 3;
  const std::vector<double> sums(values, 8.0);
  const std::string payload(reinterpret_cast<const char*>(sums.data()),
                            sums.size() * sizeof(double));
  farm::BandHeader header;
  header.set_job(lease.job());
  *header.mutable_band() = lease.band();
  header.set_lease(lease.lease());
  header.set_instance(instance_of(name));
  header.set_size(payload.size());
  header.set_sha256(wire::sha256(payload).raw());
  const std::string head = header.SerializeAsString();
  const auto length = static_cast<std::uint32_t>(head.size());
  std::string body(sizeof(length), '\0');
  std::memcpy(body.data(), &length, sizeof(length));
  return body + head + payload;
}

JoinTest::Answer JoinTest::join_get(const std::string& path) {
  return test::http_call(dashboard_->port(),
                         {.target = path, .headers = {{"Authorization", "Bearer " + secret_}}});
}

JoinTest::Answer JoinTest::join_post(const std::string& path, const std::string& body) {
  return test::http_call(dashboard_->port(),
                         {.method = "POST",
                          .target = path,
                          .headers = {{"Authorization", "Bearer " + secret_}, {"X-Bandsaw", "1"}},
                          .body = body});
}

void JoinTest::send_until_nobody_is_connected() {
  // Each job gives the tab leases, and cancelling the job revokes them.
  int jobs = 0;
  while (!workers().empty()) {
    const std::string job = std::to_string(submit_box());
    ASSERT_EQ(post("/api/jobs/" + job + "/cancel")->status, 200);
    ASSERT_LT(++jobs, 20'000);
  }
}

std::vector<std::string> JoinTest::workers() {
  std::vector<std::string> names;
  for (const WorkerView& worker :
       blocking_call<std::vector<WorkerView>>([&](auto answer) { engine_->workers(answer); })) {
    if (worker.state == "idle" || worker.state == "rendering") {
      names.push_back(worker.name);
    }
  }
  return names;
}

}  // namespace bandsaw::coordinator
