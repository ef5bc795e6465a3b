// A farm of real processes in which one machine sends wrong pixels (liar/main.cpp). Audits, which
// render a band on a second machine and compare the two results, find this machine. Then the
// machine is quarantined: it gets no more bands until a user lifts the quarantine.

#include <gtest/gtest.h>

#include <csignal>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

class AuditedFarm : public testing::Test {
 protected:
  /// Runs a command as a user of the farm.
  Finished say(std::vector<std::string> arguments) {
    return run(farm_.command(std::move(arguments)));
  }

  /// Renders an image on the farm and on this machine. The two files must have the same bytes.
  void expect_the_image_is_right() {
    const std::vector<std::string> settings = {"--width",   "64", "--height", "64",
                                               "--samples", "64", "-o"};
    std::vector<std::string> submit = {"submit", kCornell};
    std::vector<std::string> local = {BANDSAW_BIN, "render", kCornell};
    submit.insert(submit.end(), settings.begin(), settings.end());
    local.insert(local.end(), settings.begin(), settings.end());
    submit.push_back(farm_.path("farm.pfm"));
    local.push_back(farm_.path("local.pfm"));
    const Finished farm = say(submit);
    ASSERT_EQ(farm.code, 0) << farm.err << say({"why", "1"}).out;
    ASSERT_EQ(run(local).code, 0);
    EXPECT_TRUE(file_bytes(farm_.path("farm.pfm")) == file_bytes(farm_.path("local.pfm")));
  }

  FarmProcesses farm_{nullptr, {"--audit", "100%"}};  // every band is rendered twice
};

TEST_F(AuditedFarm, AMachineThatSendsWrongPixelsIsFoundAndTheImageIsRight) {
  farm_.add_worker("liar", 1, BANDSAW_LIAR_BIN);
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  expect_the_image_is_right();
  EXPECT_NE(farm_.coordinator_log().find("quarantined worker=liar returned pixels that differ"),
            std::string::npos);
  const std::string quarantined = say({"workers", "--json"}).out;
  EXPECT_NE(quarantined.find(R"("state":"quarantined")"), std::string::npos) << quarantined;

  farm_.coordinator().signal(SIGKILL);
  farm_.coordinator().wait();
  farm_.restart_coordinator();
  const Finished again = say({"workers"});
  EXPECT_NE(again.out.find("quarantine --lift liar"), std::string::npos)
      << again.code << again.out << again.err << farm_.coordinator_log();
  EXPECT_EQ(say({"quarantine", "--lift", "nobody"}).code, 1);
  EXPECT_EQ(say({"quarantine", "--lift", "liar"}).code, 0);
  farm_.worker("liar").signal(SIGKILL);
  farm_.worker("liar").wait();
  farm_.add_worker("liar", 1);  // repaired: it joins
}

}  // namespace
}  // namespace bandsaw::test
