// Tests a farm with cables that are pulled, drop packets in one direction, are slow or lose
// packets. Nothing is lost if the image has the bytes of a local render and no finished band is
// rendered again. Machines are network namespaces (needs root).

#include <gtest/gtest.h>

#include <regex>

#include "tests/farm/farm_processes.h"
#include "tests/farm/survival.h"

namespace bandsaw::test {
namespace {

class Cables : public testing::Test {
 protected:
  void SetUp() override {
    auto hosts = Hosts::create({"coordinator", "desk", "laptop", "person"});
    if (!hosts.ok()) {
      GTEST_SKIP() << hosts.status().message();
    }
    hosts_ = *std::move(hosts);
    farm_ = std::make_unique<FarmProcesses>(hosts_.get());
    job_ = std::make_unique<Survival>(*farm_);
    farm_->add_worker("desk", 1);
    farm_->add_worker("laptop", 1);
  }

  /// Waits until the coordinator's log says that the worker's connection has ended.
  void wait_until_lost(const std::string& worker) {
    const std::regex lost("worker=" + worker + " .*(closed|disconnected)");
    ASSERT_TRUE(farm_->coordinator().wait_until([&](const std::string&, const std::string& log) {
      return std::regex_search(log, lost);
    })) << farm_->coordinator_log();
  }

  /// Expects that nothing is lost if packets are dropped in the direction from `from` to `to`.
  void expect_nothing_lost_when_deaf(const std::string& from, const std::string& to) {
    Process client = job_->submit("person");
    job_->wait_until_stored("desk", 2);
    hosts_->deafen(from, to);
    job_->expect_the_same_bytes(client);
    job_->expect_nothing_rendered_again("desk");
  }

  // Destroyed in reverse order: the processes before the machines that they run on.
  std::unique_ptr<Hosts> hosts_;
  std::unique_ptr<FarmProcesses> farm_;
  std::unique_ptr<Survival> job_;
};

TEST_F(Cables, NothingIsLostIfAWorkersCableIsPulledAndPutBack) {
  Process client = job_->submit("person");
  job_->wait_until_stored("desk", 2);
  hosts_->unplug("desk");
  job_->expect_the_same_bytes(client);
  job_->expect_nothing_rendered_again("desk");
  hosts_->plug("desk");
  job_->wait_until_joined("desk", 2);
}

TEST_F(Cables, NothingIsLostIfPacketsFromAWorkerAreDropped) {
  expect_nothing_lost_when_deaf("desk", "coordinator");
}

TEST_F(Cables, NothingIsLostIfPacketsToAWorkerAreDropped) {
  expect_nothing_lost_when_deaf("coordinator", "desk");
}

TEST_F(Cables, NothingIsLostIfTheCoordinatorsCableIsPulled) {
  Process client = job_->submit("person");
  job_->wait_until_stored("desk", 2);
  hosts_->unplug("coordinator");
  wait_until_lost("desk");
  wait_until_lost("laptop");
  hosts_->plug("coordinator");
  job_->expect_the_same_bytes(client);
  job_->expect_nothing_rendered_again();
  job_->wait_until_joined("desk", 2);
}

TEST_F(Cables, NothingIsRenderedTwiceOverASlowConnection) {
  ASSERT_TRUE(hosts_->shape("desk", {"tbf", "rate", "1mbit", "burst", "32kbit", "latency", "1s"}));
  Process client = job_->submit("person");
  job_->expect_the_same_bytes(client);
  job_->expect_nothing_rendered_again();
}

TEST_F(Cables, NothingIsRenderedTwiceIfPacketsAreDelayedAndLost) {
  for (const char* host : {"desk", "person"}) {
    if (!hosts_->shape(host, {"netem", "delay", "50ms", "loss", "5%"})) {
      GTEST_SKIP() << "this kernel has no netem";
    }
  }
  Process client = job_->submit("person");
  job_->expect_the_same_bytes(client);
  job_->expect_nothing_rendered_again();
}

}  // namespace
}  // namespace bandsaw::test
